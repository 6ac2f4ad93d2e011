//! The model with the module that its slot has where nothing is chosen.

use crate::oracles::lobes::{cosine_density, lit};
use crate::oracles::reflection::lambert;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// Lambert 1760, above the horizon.
fn brdf(at: &At) -> Vec<f64> {
    lit(at).map_or(vec![0.0; 3], |_| at.vector("s.diffuse").to_array().map(lambert).to_vec())
}

/// By the cosine.
fn brdf_pdf(at: &At) -> Vec<f64> {
    vec![cosine_density(at)]
}
