//! What windows take from: the inverse square, without a range.

use crate::oracles::lights::falloff;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("falloff", nature)];

/// Light in empty space has no range.
fn nature(at: &At) -> Vec<f64> {
    vec![falloff(at.number("distance"), 0.0, at.number("size"))]
}
