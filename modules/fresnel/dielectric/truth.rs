//! Fresnel's equations in angles, with the index that gives the reflectance at normal incidence.

use crate::oracles::reflection::fresnel_dielectric;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

/// Fresnel 1823, unpolarised. No reflectance is no boundary; full reflectance has no finite index.
fn fresnel(at: &At) -> Vec<f64> {
    let theta = at.number("cosine").clamp(0.0, 1.0).acos();
    let channel = |f0: f64| {
        if f0 <= 0.0 {
            return 0.0;
        }
        if f0 >= 1.0 {
            return 1.0;
        }
        let root = f0.sqrt();
        fresnel_dielectric(1.0, (1.0 + root) / (1.0 - root), theta)
    };
    at.vector("s.f0").to_array().map(channel).to_vec()
}
