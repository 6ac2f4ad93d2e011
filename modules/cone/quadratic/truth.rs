//! The square of a ramp in the cosine.

use std::f64::consts::PI;

use crate::oracles::lights::cone_ramp;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("cone", cone), ("cone_solid_angle", solid_angle)];

/// KHR_lights_punctual: the square of the ramp.
fn cone(at: &At) -> Vec<f64> {
    let ramp = cone_ramp(at.number("versine"), at.number("inner"), at.number("outer"));
    vec![ramp * ramp]
}

/// Its integral: the ramp's square has the mean 1/3.
fn solid_angle(at: &At) -> Vec<f64> {
    let (inner, outer) = (at.number("inner").min(at.number("outer")), at.number("outer"));
    vec![2.0 * PI * (inner + (outer - inner) / 3.0)]
}
