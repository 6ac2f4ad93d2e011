//! The model with the module that its slot has where nothing is chosen.

use crate::oracles::reflection::lambert;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Lambert 1760, above the horizon.
fn brdf(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    at.vector("s.diffuse").to_array().map(lambert).to_vec()
}
