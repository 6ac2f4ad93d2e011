//! Ward, in angles as in the paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Ward 1992, eq. 5a.
fn brdf(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let widths = at.vector("s.widths");
    let (cos_v, cos_l) = (angle(normal, v).cos(), angle(normal, l).cos());
    let lobe = (-squared_slope(at, v + l)).exp() / (4.0 * PI * widths.x * widths.y * (cos_v * cos_l).sqrt());
    (at.vector("s.diffuse") / PI + at.vector("s.f0") * lobe).to_array().to_vec()
}

/// tan^2(theta) (cos^2(phi) / ax^2 + sin^2(phi) / ay^2) of a half vector; phi is counted from the tangent.
fn squared_slope(at: &At, h: DVec3) -> f64 {
    let (normal, tangent, widths) = (at.vector("s.normal"), at.vector("s.tangent"), at.vector("s.widths"));
    let phi = h.dot(normal.cross(tangent)).atan2(h.dot(tangent));
    angle(normal, h).tan().powi(2) * ((phi.cos() / widths.x).powi(2) + (phi.sin() / widths.y).powi(2))
}
