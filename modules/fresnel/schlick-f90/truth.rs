//! Schlick's formula between two colours.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

/// Khronos Group 2021, KHR_materials_specular: f0 mixed with f90 by the fifth power of 1 - cos.
fn fresnel(at: &At) -> Vec<f64> {
    let weight = (1.0 - at.number("cosine").clamp(0.0, 1.0)).powi(5);
    at.vector("s.f0").lerp(at.vector("s.f90"), weight).to_array().to_vec()
}
