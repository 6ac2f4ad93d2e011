//! Burley's diffuse model.

use std::f64::consts::PI;

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("diffuse", diffuse)];

/// Burley 2012, section 5.3.
fn diffuse(at: &At) -> Vec<f64> {
    let Some(Lit {
        theta_v, theta_l, mirror, ..
    }) = lit(at)
    else {
        return vec![0.0; 3];
    };
    let fd90 = 0.5 + 2.0 * mirror.cos().powi(2) * at.number("s.diffuse_roughness");
    let factor = |theta: f64| 1.0 + (fd90 - 1.0) * (1.0 - theta.cos()).powi(5);
    let albedo = at.vector("s.diffuse").to_array();
    albedo.map(|albedo| albedo / PI * factor(theta_l) * factor(theta_v)).to_vec()
}
