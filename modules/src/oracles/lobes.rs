//! What the truths of reflectance models share: the geometry of a configuration in angles, the frame of the surface, lobes and the densities
//! by which they are drawn.
//!
//! A direction that was rounded to 32 bits is off unit length by 6e-8, and a tangent off a right angle. The papers know neither. Here angles are
//! taken, which know no length; the half vector is that of the directions as they are, v + l, since where they are nearly opposite it hangs on
//! the rounding of their lengths, which is the inputs' and nobody's error; and a tangent is brought across the normal.

use std::f64::consts::PI;

use glam::DVec3;

use super::At;
use super::reflection::{angle, ggx_g1, schlick};

/// A normal and two directions above its horizon.
#[derive(Clone, Copy, Debug)]
pub struct Lit {
    /// Unit normal.
    pub normal: DVec3,
    /// Direction to the viewer, of unit length but for rounding.
    pub v: DVec3,
    /// Direction to the light, likewise.
    pub l: DVec3,
    /// Angle between normal and viewer, radians.
    pub theta_v: f64,
    /// Angle between normal and light, radians.
    pub theta_l: f64,
    /// Angle between normal and half vector, radians.
    pub theta_h: f64,
    /// Angle between either direction and the half vector, radians.
    pub mirror: f64,
}

/// The directions `v` and `l` over the surface `s` of a configuration, also where one is below the horizon.
pub fn directions(at: &At) -> Lit {
    let (normal, v, l) = (at.vector("s.normal").normalize(), at.vector("v"), at.vector("l"));
    Lit {
        normal,
        v,
        l,
        theta_v: angle(normal, v),
        theta_l: angle(normal, l),
        theta_h: angle(normal, v + l),
        mirror: angle(v, l) / 2.0,
    }
}

/// The directions where both are above the horizon: elsewhere nothing is reflected.
pub fn lit(at: &At) -> Option<Lit> {
    let lit = directions(at);
    (lit.normal.dot(lit.v) > 0.0 && lit.normal.dot(lit.l) > 0.0).then_some(lit)
}

/// Components of a direction along the surface's tangent, across it and along its normal.
pub fn local(at: &At, d: DVec3) -> DVec3 {
    let normal = at.vector("s.normal").normalize();
    let across = normal.cross(at.vector("s.tangent")).normalize();
    DVec3::new(d.dot(across.cross(normal)), d.dot(across), d.dot(normal))
}

/// Angle to the normal and azimuth from the tangent, radians.
pub fn spherical(at: &At, d: DVec3) -> (f64, f64) {
    let d = local(at, d);
    (d.x.hypot(d.y).atan2(d.z), d.y.atan2(d.x))
}

/// tan^2(theta) (cos^2(phi) / ax^2 + sin^2(phi) / ay^2) of a half vector: the square of its slope, in widths. Ward 1992, eq. 5a.
pub fn squared_slope(at: &At, widths: DVec3, h: DVec3) -> f64 {
    let (theta, phi) = spherical(at, h);
    theta.tan().powi(2) * ((phi.cos() / widths.x).powi(2) + (phi.sin() / widths.y).powi(2))
}

/// Beckmann's distribution of slopes of two widths, 1 / (pi ax ay) e^-slope^2. Ward 1992, eq. 5a; Walter 2005.
pub fn slope_density(at: &At, widths: DVec3, h: DVec3) -> f64 {
    (-squared_slope(at, widths, h)).exp() / (PI * widths.x * widths.y)
}

/// Density over solid angle of the mirrored direction, for a half vector drawn by its slopes: 1 / (4 v.h cos^3(theta)). Walter 2005, eq. 9.
pub fn slope_mirror_density(at: &At, widths: DVec3) -> f64 {
    let lit = directions(at);
    slope_density(at, widths, lit.v + lit.l) / (4.0 * lit.mirror.cos() * lit.theta_h.cos().abs().powi(3))
}

/// GGX of two widths, 1/sr. Heitz 2014, eq. 85.
pub fn ggx_d_of_widths(at: &At, widths: DVec3, h: DVec3) -> f64 {
    let (theta, _) = spherical(at, h);
    if theta >= PI / 2.0 {
        return 0.0;
    }
    1.0 / (PI * widths.x * widths.y * theta.cos().powi(4) * (1.0 + squared_slope(at, widths, h)).powi(2))
}

/// The width that the azimuth of a direction sees. Heitz 2014, eq. 80.
pub fn width_toward(at: &At, widths: DVec3, d: DVec3) -> f64 {
    let (_, phi) = spherical(at, d);
    (phi.cos() * widths.x).hypot(phi.sin() * widths.y)
}

/// Density of the direction that a facet seen from v mirrors v into: G1(v) D(h) / (4 n.v). Heitz 2014, eqs. 16 and 18.
pub fn ggx_mirror_density(at: &At, widths: DVec3) -> f64 {
    let lit = directions(at);
    let g1 = ggx_g1(width_toward(at, widths, lit.v), lit.theta_v);
    g1 * ggx_d_of_widths(at, widths, lit.v + lit.l) / (4.0 * lit.theta_v.cos())
}

/// Smith's Lambda of Beckmann facets: (erf(a) - 1) / 2 + exp(-a^2) / (2 a sqrt(pi)), a = 1 / (alpha tan(theta)). Heitz 2014, section 5.3.
pub fn beckmann_lambda(alpha: f64, theta: f64) -> f64 {
    let a = 1.0 / (alpha * theta.tan());
    // exp(-64) is nothing beside 1.
    if a > 8.0 {
        return 0.0;
    }
    (erf(a) - 1.0) / 2.0 + (-a * a).exp() / (2.0 * a * PI.sqrt())
}

/// Abramowitz and Stegun 1964, 7.1.6: a series of positive terms, for x in [0, 8].
fn erf(x: f64) -> f64 {
    let (mut term, mut sum) = (x, x);
    for n in 1..400 {
        term *= 2.0 * x * x / f64::from(2 * n + 1);
        sum += term;
    }
    2.0 / PI.sqrt() * (-x * x).exp() * sum
}

/// Phong's exponent of a lobe as wide as facets of this alpha. Walter et al. 2007, section 5.
pub fn phong_exponent(alpha: f64) -> f64 {
    2.0 / (alpha * alpha) - 2.0
}

/// The n-th power of the cosine of an angle; nothing from a right angle on.
///
/// The logarithm is taken by the half angle: with exponents of 1e8 a cosine near 1 has too few digits in double precision as well.
pub fn cosine_power(theta: f64, n: f64) -> f64 {
    if theta >= PI / 2.0 {
        return 0.0;
    }
    (n * (-2.0 * (0.5 * theta).sin().powi(2)).ln_1p()).exp()
}

/// The n-th power of the cosine of the angle between the viewer and the mirror direction of the light. Phong 1975.
pub fn mirror_power(lit: &Lit, n: f64) -> f64 {
    cosine_power(angle(2.0 * lit.normal.dot(lit.l) * lit.normal - lit.l, lit.v), n)
}

/// Luminance of a linear Rec.709 colour (ITU-R BT.709).
pub fn luminance(c: DVec3) -> f64 {
    c.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// Schlick's reflectance by channel.
pub fn schlick_rgb(f0: DVec3, cosine: f64) -> DVec3 {
    f0.map(|f0| schlick(f0, cosine))
}

/// Share of the samples that a lobe of this reflectance draws beside the diffuse part.
pub fn lobe_share(at: &At, reflected: DVec3) -> f64 {
    let (lobe, diffuse) = (luminance(reflected), luminance(at.vector("s.diffuse")));
    if lobe > 0.0 { lobe / (lobe + diffuse) } else { 0.0 }
}

/// Density of a direction drawn by its cosine.
pub fn cosine_density(at: &At) -> f64 {
    let lit = directions(at);
    lit.normal.dot(lit.l).max(0.0) / PI
}

/// Density of a direction that a lobe drew, else the cosine to the normal.
pub fn mixed(at: &At, share: f64, lobe: f64) -> Vec<f64> {
    vec![share * lobe + (1.0 - share) * cosine_density(at)]
}

/// The result of a BRDF: diffuse / pi and f0 times a lobe, by channel.
pub fn diffuse_and_lobe(at: &At, lobe: f64) -> Vec<f64> {
    (at.vector("s.diffuse") / PI + at.vector("s.f0") * lobe).to_array().to_vec()
}

/// The configuration of a facet, h over a surface, seen from v: the angles of h and v to the normal, and the cosine between them.
pub fn facet(at: &At) -> (f64, f64, f64) {
    let [normal, v, h] = ["s.normal", "v", "h"].map(|name| at.vector(name).normalize());
    (angle(normal, h), angle(normal, v), angle(v, h).cos())
}

/// How often a facet is drawn for once that its angle is, where those that v does not see are turned about the normal by half a turn if it sees
/// them so.
pub fn multiplicity(at: &At) -> f64 {
    let (theta_h, theta_v, here) = facet(at);
    let turned = 2.0 * theta_h.cos() * theta_v.cos() - here;
    match (here > 0.0, turned > 0.0) {
        (false, true) if here < 0.0 => 0.0,
        (true, false) if turned < 0.0 => 2.0,
        _ => 1.0,
    }
}

/// Density of facets that are drawn by D n.h and turned toward the viewer. Walter et al. 2007, eq. 24.
pub fn folded_density(at: &At, distribution: f64) -> Vec<f64> {
    let (theta_h, ..) = facet(at);
    vec![distribution * theta_h.cos().max(0.0) * multiplicity(at)]
}

/// Density of facets that are seen: G1(v) v.h D / n.v. Heitz 2014, eq. 16.
pub fn visible_density(at: &At, g1: f64, distribution: f64) -> Vec<f64> {
    let (_, theta_v, v_dot_h) = facet(at);
    vec![g1 * v_dot_h.max(0.0) * distribution / theta_v.cos()]
}
