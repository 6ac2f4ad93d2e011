//! An ideal matte surface.

use crate::oracles::reflection::lambert;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Lambert 1760.
fn brdf(at: &At) -> Vec<f64> {
    at.vector("s.diffuse").to_array().map(lambert).to_vec()
}
