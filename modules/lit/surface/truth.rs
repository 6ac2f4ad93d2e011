//! Without a light it is dark.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("lit", lit)];

/// Alone, the list of lights is empty.
fn lit(_at: &At) -> Vec<f64> {
    vec![0.0; 3]
}
