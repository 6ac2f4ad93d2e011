//! Burley's diffuse model.

use std::f64::consts::PI;

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("diffuse", diffuse)];

/// Burley 2012, section 5.3.
fn diffuse(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    let (theta_v, theta_l, theta_d) = (angle(n, v), angle(n, l), angle(v, l) / 2.0);
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let fd90 = 0.5 + 2.0 * theta_d.cos().powi(2) * at.number("s.diffuse_roughness");
    let factor = |theta: f64| 1.0 + (fd90 - 1.0) * (1.0 - theta.cos()).powi(5);
    let albedo = at.vector("s.diffuse").to_array();
    albedo.map(|albedo| albedo / PI * factor(theta_l) * factor(theta_v)).to_vec()
}
