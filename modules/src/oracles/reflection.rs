//! Microfacet reflection: D, G, F, the diffuse part and their composition. `alpha` is the GGX width, angles are radians.

use std::f64::consts::PI;

use glam::DVec3;

/// Angle between two vectors of any length, accurate for small angles too.
pub fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// GGX distribution of the angle between facet and surface normal, 1/sr. Walter et al. 2007, eq. 33.
pub fn ggx_d(alpha: f64, theta: f64) -> f64 {
    if theta >= PI / 2.0 {
        return 0.0;
    }
    let a2 = alpha * alpha;
    a2 / (PI * theta.cos().powi(4) * (a2 + theta.tan().powi(2)).powi(2))
}

/// Smith's Lambda of GGX. Heitz 2014, eq. 72.
pub fn ggx_lambda(alpha: f64, theta: f64) -> f64 {
    let s = alpha * theta.tan();
    // (sqrt(1 + s^2) - 1) / 2 without cancellation for small s.
    0.5 * s * s / ((1.0 + s * s).sqrt() + 1.0)
}

/// Smith masking of one direction. Walter et al. 2007, eq. 34.
pub fn ggx_g1(alpha: f64, theta: f64) -> f64 {
    2.0 / (1.0 + (1.0 + (alpha * theta.tan()).powi(2)).sqrt())
}

/// Masking and shadowing of independent heights: the product.
pub fn ggx_g2_separable(alpha: f64, theta_v: f64, theta_l: f64) -> f64 {
    ggx_g1(alpha, theta_v) * ggx_g1(alpha, theta_l)
}

/// Masking and shadowing correlated by height. Heitz 2014, eq. 99.
pub fn ggx_g2_correlated(alpha: f64, theta_v: f64, theta_l: f64) -> f64 {
    ggx_g2_of_widths([alpha; 2], [theta_v, theta_l])
}

/// The same where the two directions see facets of different widths.
pub fn ggx_g2_of_widths(alpha: [f64; 2], theta: [f64; 2]) -> f64 {
    1.0 / (1.0 + ggx_lambda(alpha[0], theta[0]) + ggx_lambda(alpha[1], theta[1]))
}

/// G2 / (4 cos cos), 0 at and below the horizon.
pub fn ggx_v_correlated(alpha: f64, n: DVec3, v: DVec3, l: DVec3) -> f64 {
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return 0.0;
    }
    let (tv, tl) = (angle(n, v), angle(n, l));
    ggx_g2_correlated(alpha, tv, tl) / (4.0 * tv.cos() * tl.cos())
}

/// Reflectance of unpolarised light that comes from a medium of index `n1` to one of index `n2`. Fresnel 1823.
pub fn fresnel_dielectric(n1: f64, n2: f64, theta: f64) -> f64 {
    let sin_t = n1 / n2 * theta.sin();
    if sin_t >= 1.0 {
        return 1.0;
    }
    let (ci, ct) = (theta.cos(), sin_t.asin().cos());
    let s = (n1 * ci - n2 * ct) / (n1 * ci + n2 * ct);
    let p = (n1 * ct - n2 * ci) / (n1 * ct + n2 * ci);
    (s * s + p * p) / 2.0
}

/// Schlick 1994, eq. 15.
pub fn schlick(f0: f64, cosine: f64) -> f64 {
    f0 + (1.0 - f0) * (1.0 - cosine).powi(5)
}

/// Ideal matte surface, 1/sr. Lambert 1760.
pub fn lambert(albedo: f64) -> f64 {
    albedo / PI
}

/// What a BRDF looks at, for one colour channel.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Unit normal.
    pub normal: DVec3,
    /// Albedo of the diffuse part.
    pub diffuse: f64,
    /// Reflectance at normal incidence.
    pub f0: f64,
    /// GGX width.
    pub alpha: f64,
}

/// F D G / (4 n.l n.v) + diffuse, 1/sr, with GGX, Smith correlated, Schlick and Lambert. Walter et al. 2007, eq. 20.
/// `v` and `l` are unit vectors, as good as that.
pub fn microfacet(s: &Surface, v: DVec3, l: DVec3) -> f64 {
    if s.normal.dot(v) <= 0.0 || s.normal.dot(l) <= 0.0 {
        return 0.0;
    }
    let h = v + l;
    let d = ggx_d(s.alpha, angle(s.normal, h));
    // Half the angle between the directions, the same from either, whatever their rounding makes of h.
    schlick(s.f0, (angle(v, l) / 2.0).cos()) * d * ggx_v_correlated(s.alpha, s.normal, v, l) + lambert(s.diffuse)
}
