//! Solid angles.

use std::f64::consts::PI;

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("spread", spread)];

/// Alone, without a cone, all directions.
fn spread(_at: &At) -> Vec<f64> {
    vec![4.0 * PI]
}
