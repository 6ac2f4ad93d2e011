//! Cook and Torrance, in angles and with the index of refraction as in the paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Cook and Torrance 1982 with 1 / 4 in place of 1 / pi and a normalised D.
fn brdf(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let (m, theta) = (at.number("s.alpha"), angle(normal, v + l));
    let d = (-(theta.tan() / m).powi(2)).exp() / (PI * m * m * theta.cos().powi(4));
    // The angle between v and the half vector.
    let mirror = angle(v, l) / 2.0;
    let (cos_v, cos_l) = (angle(normal, v).cos(), angle(normal, l).cos());
    let g = (2.0 * theta.cos() * cos_v.min(cos_l) / mirror.cos()).min(1.0);
    let f = at.vector("s.f0").to_array().map(|f0| fresnel(f0, mirror.cos()));
    let specular = DVec3::from_array(f) * (d * g / (4.0 * cos_v * cos_l));
    (at.vector("s.diffuse") / PI + specular).to_array().to_vec()
}

/// Reflectance at an angle with this cosine, the index of refraction being that of the reflectance at normal incidence.
fn fresnel(f0: f64, c: f64) -> f64 {
    if f0 <= 0.0 || f0 >= 1.0 {
        return f0;
    }
    let n = (1.0 + f0.sqrt()) / (1.0 - f0.sqrt());
    let g = (n * n + c * c - 1.0).sqrt();
    let parallel = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    0.5 * ((g - c) / (g + c)).powi(2) * (1.0 + parallel * parallel)
}
