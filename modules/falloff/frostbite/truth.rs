//! The windowed inverse square with a floor.

use crate::oracles::lights::falloff;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("falloff", frostbite)];

/// Lagarde and de Rousiers 2014, with the light's size as the smallest distance.
fn frostbite(at: &At) -> Vec<f64> {
    vec![falloff(at.number("distance"), at.number("range"), at.number("size"))]
}
