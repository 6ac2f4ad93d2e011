//! The formula with the integral of the albedo.

use crate::oracles::albedo::ggx;
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("compensate", compensate)];

/// Turquin 2019, eq. 16: 1 + F0 (1 - E) / E.
fn compensate(at: &At) -> Vec<f64> {
    let cosine = angle(at.vector("s.normal"), at.vector("v")).cos().max(0.0);
    let lost = ggx(at.number("s.alpha"), cosine, 6).lost;
    let (single, f0) = (at.vector("single"), at.vector("s.f0"));
    (0..3).map(|i| single[i] * (1.0 + f0[i] * lost / (1.0 - lost))).collect()
}
