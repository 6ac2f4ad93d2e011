//! Schlick's term with the correction for metals.

use crate::oracles::reflection::schlick;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

/// Kutz, Hasan and Edmondson 2021: F = S(c) - a c (1 - c)^6 with a such that F is tint S at c = 1/7; not below 0.
fn fresnel(at: &At) -> Vec<f64> {
    let cosine = at.number("cosine").clamp(0.0, 1.0);
    let (f0, tint) = (at.vector("s.f0"), at.param_vector("tint"));
    let bump = |c: f64| c * (1.0 - c).powi(6);
    let channel = |i: usize| {
        let edge = 1.0 / 7.0;
        let a = schlick(f0[i], edge) * (1.0 - tint[i]) / bump(edge);
        (schlick(f0[i], cosine) - a * bump(cosine)).max(0.0)
    };
    (0..3).map(channel).collect()
}
