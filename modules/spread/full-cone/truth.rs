//! Solid angles.

use std::f64::consts::PI;

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("spread", spread)];

/// The solid angle of the outer cone.
fn spread(at: &At) -> Vec<f64> {
    vec![(2.0 * PI * at.number("outer")).max(1e-6)]
}
