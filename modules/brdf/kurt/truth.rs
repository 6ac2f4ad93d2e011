//! Kurt et al., in angles as in the paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::reflection::{angle, schlick};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Kurt et al. 2010, one lobe and the diffuse term.
fn brdf(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let widths = at.vector("s.widths");
    let h = v + l;
    let theta = angle(normal, h);
    let d = (-squared_slope(at, h)).exp() / (PI * widths.x * widths.y * theta.cos().powi(4));
    let mirror = (angle(v, l) / 2.0).cos();
    let attenuation = (angle(normal, v).cos() * angle(normal, l).cos()).powf(at.param("alpha_k"));
    let f = at.vector("s.f0").to_array().map(|f0| schlick(f0, mirror));
    (at.vector("s.diffuse") / PI + DVec3::from_array(f) * (d / (4.0 * mirror * attenuation)))
        .to_array()
        .to_vec()
}

/// tan^2(theta) (cos^2(phi) / ax^2 + sin^2(phi) / ay^2) of a half vector; phi is counted from the tangent.
fn squared_slope(at: &At, h: DVec3) -> f64 {
    let (normal, tangent, widths) = (at.vector("s.normal"), at.vector("s.tangent"), at.vector("s.widths"));
    let phi = h.dot(normal.cross(tangent)).atan2(h.dot(tangent));
    angle(normal, h).tan().powi(2) * ((phi.cos() / widths.x).powi(2) + (phi.sin() / widths.y).powi(2))
}
