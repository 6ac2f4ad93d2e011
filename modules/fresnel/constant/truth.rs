//! No dependence on the angle.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

fn fresnel(at: &At) -> Vec<f64> {
    at.vector("s.f0").to_array().to_vec()
}
