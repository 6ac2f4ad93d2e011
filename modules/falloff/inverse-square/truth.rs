//! The inverse square.

use crate::oracles::lights::falloff;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("falloff", inverse_square)];

/// Without a window.
fn inverse_square(at: &At) -> Vec<f64> {
    vec![falloff(at.number("distance"), 0.0, at.number("size"))]
}
