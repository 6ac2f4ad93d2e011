//! The formula with the integrals of the albedo.

use std::f64::consts::PI;

use crate::oracles::albedo::{ggx, ggx_mean};
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("compensate", compensate)];

const PANELS: usize = 4;

/// Kulla and Conty 2017. Probed alone the module has the neutral Fresnel term, F0 at all angles, which is its own mean.
fn compensate(at: &At) -> Vec<f64> {
    let (alpha, normal) = (at.number("s.alpha"), at.vector("s.normal"));
    let lost = |toward: &str| ggx(alpha, angle(normal, at.vector(toward)).cos().max(0.0), PANELS).lost;
    let mean = ggx_mean(alpha, 2).lost;
    let lobe = lost("v") * lost("l") / (PI * mean);
    let (single, f0) = (at.vector("single"), at.vector("s.f0"));
    let channel = |i: usize| single[i] + f0[i] * f0[i] * (1.0 - mean) / (1.0 - f0[i] * mean) * lobe;
    (0..3).map(channel).collect()
}
