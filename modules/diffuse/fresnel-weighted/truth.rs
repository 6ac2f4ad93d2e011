//! The diffuse part of Ashikhmin and Shirley's model.

use std::f64::consts::PI;

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("diffuse", diffuse)];

/// Ashikhmin and Shirley 2000, eq. 5.
fn diffuse(at: &At) -> Vec<f64> {
    let Some(Lit { theta_v, theta_l, .. }) = lit(at) else {
        return vec![0.0; 3];
    };
    let (albedo, f0) = (at.vector("s.diffuse"), at.vector("s.f0"));
    let passed = |theta: f64| 1.0 - (1.0 - theta.cos() / 2.0).powi(5);
    let channel = |i: usize| 28.0 * albedo[i] / (23.0 * PI) * (1.0 - f0[i]) * passed(theta_v) * passed(theta_l);
    (0..3).map(channel).collect()
}
