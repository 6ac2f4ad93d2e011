//! Light scattered alike in all directions.

use crate::oracles::lobes::lit;
use crate::oracles::reflection::lambert;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("diffuse", diffuse)];

/// Lambert 1760, above the horizon.
fn diffuse(at: &At) -> Vec<f64> {
    lit(at).map_or(vec![0.0; 3], |_| at.vector("s.diffuse").to_array().map(lambert).to_vec())
}
