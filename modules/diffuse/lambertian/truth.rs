//! Light scattered alike in all directions.

use crate::oracles::reflection::lambert;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("diffuse", diffuse)];

/// Lambert 1760.
fn diffuse(at: &At) -> Vec<f64> {
    at.vector("s.diffuse").to_array().map(lambert).to_vec()
}
