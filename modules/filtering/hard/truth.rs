//! One comparison with the interface's edge, which lights everything left of its place.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("filter_shadow", filter_shadow)];

/// Williams 1978: lit or not.
fn filter_shadow(at: &At) -> Vec<f64> {
    vec![if at.vector("at.place").x > 0.0 { 1.0 } else { 0.0 }]
}
