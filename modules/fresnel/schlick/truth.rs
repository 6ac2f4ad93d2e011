//! Schlick's formula itself: how well its f32 form computes it, not how well it approximates.

use crate::oracles::reflection::schlick;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

/// Schlick 1994, eq. 15; a cosine that rounding took out of its range is at the end of the range.
fn fresnel(at: &At) -> Vec<f64> {
    let cosine = at.number("cosine").clamp(0.0, 1.0);
    at.vector("s.f0").to_array().map(|f0| schlick(f0, cosine)).to_vec()
}
