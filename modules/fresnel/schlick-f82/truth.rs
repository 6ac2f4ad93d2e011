//! Schlick's formula with a tint at 82 degrees.

use glam::DVec3;

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

/// Kutz, Hasan and Edmondson 2021, with the colour at the horizon in the place of 1; at the angle with the cosine 1/7 the term is the tint times
/// Schlick's.
fn fresnel(at: &At) -> Vec<f64> {
    let (f0, f90, tint) = (at.vector("s.f0"), at.vector("s.f90"), at.vector("s.f82"));
    let schlick = |cosine: f64| f0.lerp(f90, (1.0 - cosine).powi(5));
    let lazanyi = |cosine: f64| cosine * (1.0 - cosine).powi(6);
    let cosine = at.number("cosine").clamp(0.0, 1.0);
    let peak = 1.0 / 7.0;
    let bump = schlick(peak) * (DVec3::ONE - tint) / lazanyi(peak);
    (schlick(cosine) - bump * lazanyi(cosine)).max(DVec3::ZERO).to_array().to_vec()
}
