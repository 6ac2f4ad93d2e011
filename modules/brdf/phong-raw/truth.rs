//! Phong without a factor: angles as in the paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Phong 1975, both terms over pi; the exponent is that of facets as wide as alpha.
fn brdf(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let n = 2.0 / at.number("s.alpha").powi(2) - 2.0;
    (at.vector("s.diffuse") / PI + at.vector("s.f0") / PI * lobe(normal, v, l, n))
        .to_array()
        .to_vec()
}

/// The n-th power of the cosine of the angle between the eye and the mirror direction; nothing behind the lobe.
fn lobe(normal: DVec3, v: DVec3, l: DVec3, n: f64) -> f64 {
    let mirror = 2.0 * normal.dot(l) * normal - l;
    if mirror.dot(v) < 0.0 {
        return 0.0;
    }
    angle(mirror, v).cos().powf(n)
}
