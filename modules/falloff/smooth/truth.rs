//! The inverse square with a window of the sixth degree.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("falloff", smooth)];

/// (1 - x^2)^3 over the squared distance to the rim of the light.
fn smooth(at: &At) -> Vec<f64> {
    let (distance, range, size) = (at.number("distance"), at.number("range"), at.number("size"));
    let x = if range == 0.0 { 0.0 } else { (distance / range).min(1.0) };
    vec![(1.0 - x * x).powi(3) / (distance.powi(2) + size.powi(2))]
}
