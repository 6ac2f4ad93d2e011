//! What the modules approximate: the reflectance of a smooth dielectric in air.

use crate::oracles::reflection::fresnel_dielectric;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

/// Fresnel 1823, unpolarised, with the index that gives the reflectance at normal incidence.
fn fresnel(at: &At) -> Vec<f64> {
    let theta = at.number("cosine").clamp(0.0, 1.0).acos();
    let f0 = at.vector("s.f0").to_array();
    f0.map(|f0| {
        let root = f0.sqrt();
        fresnel_dielectric(1.0, (1.0 + root) / (1.0 - root), theta)
    })
    .to_vec()
}
