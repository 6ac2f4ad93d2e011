//! Integrals over facets: that a distribution covers the surface, and that what is seen of it covers what is seen of the surface.

use std::f64::consts::TAU;

use glam::DVec3;
use serde_json::json;
use shadewright_compiler::Module;
use shadewright_compiler::manifest::Node;
use shadewright_modules::oracles::quadrature::{direction, nodes};

use super::bench::{Bench, Rows, surface, variants};
use super::format::{Area, Draws};
use super::pairs::{EQUAL, fraction};
use super::{Proof, Property};
use crate::measure::MeasureError;

const ALPHAS: [f64; 7] = [1e-4, 1e-3, 0.01, 0.1, 0.3, 0.5, 1.0];
/// Degrees of the eye to the normal.
const ANGLES: [f64; 8] = [0.0, 30.0, 60.0, 80.0, 85.0, 89.0, 89.9, 89.99];
/// What an integral may be off by: the functions' rounding, and of a lobe that is as narrow as 1e-4.
pub const NORMALISED: f64 = 1e-4;
/// Turns of a facet where its turn matters.
const TURNS: usize = 128;
/// Facets that are drawn for the largest weight, for each surface and eye.
const DRAWN: usize = 4096;
/// A weight that is 1 may come out a little larger: the facet of two rounded directions is not the one that was drawn.
pub const WEIGHT: f64 = 1.0 + 1e-3;

/// Facets by the logarithm of the tangent of their angle to the normal, and by their turn: the density is the same smooth bump for any alpha.
struct Facets {
    /// Tangents with their weights in the logarithm.
    tangents: Vec<(f64, f64)>,
    turns: usize,
}

impl Facets {
    /// From where a disk of 1e-5 alpha is 1e-10 of the facets up to the horizon.
    fn new(alpha: f64, is_isotropic: bool) -> Self {
        let (low, high) = (f64::ln(1e-5 * alpha), f64::ln(1e5));
        let logarithms = nodes(low, high, (2.0 * (high - low)).ceil() as usize);
        Self {
            tangents: logarithms.into_iter().map(|(x, weight)| (x.exp(), weight)).collect(),
            turns: if is_isotropic { 1 } else { TURNS },
        }
    }

    fn normals(&self) -> impl Iterator<Item = DVec3> + Clone + '_ {
        let turn = |index: usize| TAU * index as f64 / self.turns as f64;
        self.tangents
            .iter()
            .flat_map(move |(tangent, _)| (0..self.turns).map(move |index| direction(tangent.atan(), turn(index))))
    }

    /// The integral over solid angle of a density times a factor that depends on the facet; `around` is the factor's integral over a turn.
    fn integral(&self, densities: &[f64], factor: impl Fn(DVec3) -> f64, around: impl Fn(f64, f64) -> f64) -> f64 {
        let ring = |(index, (tangent, weight)): (usize, &(f64, f64))| {
            let (sine, cosine) = tangent.atan().sin_cos();
            let ring = &densities[index * self.turns..(index + 1) * self.turns];
            let sum = if self.turns == 1 {
                ring[0] * around(sine, cosine)
            } else {
                let each = |(index, d): (usize, &f64)| d * factor(direction(tangent.atan(), TAU * index as f64 / self.turns as f64));
                ring.iter().enumerate().map(each).sum::<f64>() * TAU / self.turns as f64
            };
            // sin d(angle), the angle from the logarithm of its tangent.
            weight * sum * sine * tangent / (1.0 + tangent * tangent)
        };
        self.tangents.iter().enumerate().map(ring).sum()
    }
}

/// Integral of max(v.h, 0) over the turn of h, for angles to the normal with these sines and cosines.
fn seen_around(of_v: (f64, f64), sine: f64, cosine: f64) -> f64 {
    let (across, along) = (of_v.0 * sine, of_v.1 * cosine);
    if along >= across {
        return TAU * along;
    }
    let end = (-along / across).acos();
    2.0 * (across * end.sin() + along * end)
}

fn is_isotropic(module: &Module) -> bool {
    module.manifest.properties.iter().any(|p| p == Property::Isotropic.claim())
}

/// Surfaces of one alpha; brushed where the distribution knows that.
fn smooth(alpha: f64, is_isotropic: bool) -> serde_json::Value {
    let across = if is_isotropic { alpha } else { 0.5 * alpha };
    surface(alpha, [alpha, across], [1.0; 3], [0.0; 3])
}

/// Furthest from 1 of the integral of D n.h; its sign, finiteness and isotropy.
///
/// # Errors
/// The module cannot be linked, or the device fails.
pub fn prove(bench: &Bench, module: &Module, function: &str) -> Result<Vec<Proof>, MeasureError> {
    let isotropic = is_isotropic(module);
    let mut worst = (-1.0, String::new());
    let mut faults = (0.0, String::new());
    let mut least = (f64::INFINITY, String::new());
    let mut turned = (0.0, String::new());
    for (variant, node) in variants(module) {
        for alpha in ALPHAS {
            let facets = Facets::new(alpha, isotropic);
            let rows = Rows::new(&smooth(alpha, isotropic)).vectors("h", facets.normals());
            let densities = bench.numbers(&node, function, &rows)?;
            let at = |what: String| format!("alpha {alpha}{}{variant}{what}", if variant.is_empty() { "" } else { ", " });
            for (h, d) in facets.normals().zip(&densities) {
                let angle = || at(format!(", h {:.3e}°", h.x.hypot(h.y).atan2(h.z).to_degrees()));
                if !d.is_finite() {
                    faults = (faults.0 + 1.0, angle());
                } else if *d < least.0 {
                    least = (*d, angle());
                }
            }
            // Who claims that turning does not matter is held to that on a brushed surface.
            let brushed = surface(alpha, [alpha, (0.5 * alpha).max(1e-4)], [1.0; 3], [0.0; 3]);
            let along = bench.numbers(&node, function, &Rows::new(&brushed).vectors("h", facets.normals()))?;
            let quarter = facets.normals().map(|h| DVec3::new(-h.y, h.x, h.z));
            let across = bench.numbers(&node, function, &Rows::new(&brushed).vectors("h", quarter))?;
            for (a, b) in along.iter().zip(across) {
                let difference = (a - b).abs() / a.abs().max(b.abs()).max(1e-9);
                if difference > turned.0 {
                    turned = (difference, at(String::new()));
                }
            }
            let error = (facets.integral(&densities, |h| h.z, |_, cosine| TAU * cosine) - 1.0).abs();
            if error > worst.0 || error.is_nan() {
                worst = (error, at(String::new()));
            }
        }
    }
    Ok(vec![
        Proof::new(module, Property::Isotropic, turned.0, turned.1, EQUAL),
        Proof::new(module, Property::Normalised, worst.0, worst.1, NORMALISED),
        Proof::new(module, Property::NotNegative, least.0, least.1, 0.0),
        Proof::new(module, Property::Finite, faults.0, faults.1, 0.0),
    ])
}

/// Furthest from 1 of G1(v) / n.v times the area of the facets that v sees (Heitz 2014, eq. 16); with the functions' names in their categories.
///
/// Smith's masking alone of v is that of v and l = n: along the normal nothing is hidden, so G1(v) is 4 n.v V(v, n).
///
/// # Errors
/// A module cannot be linked, or the device fails.
pub fn prove_area(bench: &Bench, area: &Area, distribution: &str, masking: &str) -> Result<Proof, MeasureError> {
    let (of_facets, of_masking) = (Node::new(&area.distribution), Node::new(&area.masking));
    let isotropic = is_isotropic(bench.catalog.module(&area.distribution)?);
    let mut worst = (-1.0, String::new());
    for alpha in ALPHAS {
        let surface = smooth(alpha, isotropic);
        let facets = Facets::new(alpha, isotropic);
        let densities = bench.numbers(&of_facets, distribution, &Rows::new(&surface).vectors("h", facets.normals()))?;
        let eyes = ANGLES.map(|angle| direction(angle.to_radians(), 0.0));
        let halves = eyes.map(|v| (v + DVec3::Z).normalize());
        let rows = Rows::new(&surface)
            .sharing("l", json!([0, 0, 1]))
            .vectors("v", eyes.into_iter())
            .vectors("h", halves.into_iter());
        let masked = bench.numbers(&of_masking, masking, &rows)?;
        for ((angle, v), masked) in ANGLES.into_iter().zip(eyes).zip(masked) {
            let of_v = angle.to_radians().sin_cos();
            let seen = facets.integral(&densities, |h| v.dot(h).max(0.0), |sine, cosine| seen_around(of_v, sine, cosine));
            let error = (4.0 * masked * seen - 1.0).abs();
            if error > worst.0 || error.is_nan() {
                worst = (error, format!("alpha {alpha}, v {angle}°"));
            }
        }
    }
    Ok(Proof::of_pair(area, Property::ProjectedArea, worst.0, worst.1, area.within))
}

/// Largest weight D V 4 n.l v.h / p of a mirrored direction l, for white facets (the Jacobian of the mirror is 1 / (4 v.h)).
///
/// # Errors
/// As for [`prove_area`].
pub fn prove_weight(bench: &Bench, area: &Area, distribution: &str, masking: &str, draws: &Draws) -> Result<Proof, MeasureError> {
    let (of_facets, of_masking) = (Node::new(&area.distribution), Node::new(&area.masking));
    let isotropic = is_isotropic(bench.catalog.module(&area.distribution)?);
    let mut worst = (0.0, String::new());
    let numbers: Vec<[f32; 2]> = (0..DRAWN)
        .map(|step| [fraction(step, 0.754_877_666) as f32, fraction(step, 0.569_840_291) as f32])
        .collect();
    // Smoother surfaces have lobes in which the rounding of a direction is a step.
    for alpha in [0.05, 0.3, 1.0] {
        for angle in ANGLES {
            let v = direction(angle.to_radians(), 0.3);
            let shared = || Rows::new(&smooth(alpha, isotropic)).sharing("v", json!(v.to_array()));
            let drawn = bench.vectors(&of_facets, &draws.sample, &shared().pairs("u", &numbers))?;
            let facets: Vec<(DVec3, DVec3)> = drawn
                .into_iter()
                .map(|h| (h, 2.0 * v.dot(h) * h - v))
                .filter(|(h, l)| l.z > 0.0 && v.dot(*h) > 0.0)
                .collect();
            let normals = || facets.iter().map(|(h, _)| *h);
            let density = bench.numbers(&of_facets, &draws.density, &shared().vectors(&draws.drawn, normals()))?;
            let d = bench.numbers(
                &of_facets,
                distribution,
                &Rows::new(&smooth(alpha, isotropic)).vectors("h", normals()),
            )?;
            let mirrored = shared().vectors("l", facets.iter().map(|(_, l)| *l)).vectors("h", normals());
            let masked = bench.numbers(&of_masking, masking, &mirrored)?;
            for ((((h, l), p), d), masked) in facets.iter().zip(density).zip(d).zip(masked) {
                let weight = d * masked * 4.0 * l.z * v.dot(*h) / p;
                // A facet that has no density is not drawn, but for rounding.
                if d * masked > 0.0 && (weight > worst.0 || weight.is_nan()) {
                    worst = (weight, format!("alpha {alpha}, v {angle}°"));
                }
            }
        }
    }
    Ok(Proof::of_pair(area, Property::Weight, worst.0, worst.1, WEIGHT))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Catches a weight of the quadrature, or of the turn, that is wrong: a uniform density seen from any side, and GGX of any width.
    #[test]
    fn known_integrals() {
        for alpha in [1e-4, 0.01, 1.0] {
            let ggx = |h: DVec3| {
                let k = alpha / (alpha * alpha * h.z * h.z + h.x * h.x + h.y * h.y);
                k * k / PI
            };
            for isotropic in [true, false] {
                let facets = Facets::new(alpha, isotropic);
                let densities: Vec<f64> = facets.normals().map(ggx).collect();
                let whole = facets.integral(&densities, |h| h.z, |_, cosine| TAU * cosine);
                assert!((whole - 1.0).abs() < 1e-8, "{alpha} {isotropic}: {whole}");
                for angle in ANGLES {
                    let of_v = angle.to_radians().sin_cos();
                    let v = direction(angle.to_radians(), 0.0);
                    let seen = facets.integral(&densities, |h| v.dot(h).max(0.0), |s, c| seen_around(of_v, s, c));
                    let root = (alpha * alpha + (1.0 - alpha * alpha) * v.z * v.z).sqrt();
                    // n.v / G1.
                    let expected = 0.5 * (v.z + root);
                    // Turns of 3 degrees find the end of what is seen to a thousandth; rings, to a hundred-thousandth.
                    let tolerance = if isotropic { 2e-5 } else { 2e-3 };
                    assert!((seen / expected - 1.0).abs() < tolerance, "{alpha} {angle}: {seen} {expected}");
                }
            }
        }
    }
}
