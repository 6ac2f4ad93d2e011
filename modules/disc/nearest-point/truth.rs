//! White paper has no highlight: a point over white paper.

use std::f64::consts::PI;

use crate::oracles::lights::directional_illuminance;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("disc", disc)];

/// The cosine law for the disc's centre.
fn disc(at: &At) -> Vec<f64> {
    vec![directional_illuminance(-at.vector("l"), 1.0, at.vector("s.normal")) / PI; 3]
}
