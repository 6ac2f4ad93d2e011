//! A cubic in the cosine.

use std::f64::consts::PI;

use crate::oracles::lights::cone_ramp;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("cone", cone), ("cone_solid_angle", solid_angle)];

/// Hermite's cubic of the ramp.
fn cone(at: &At) -> Vec<f64> {
    let ramp = cone_ramp(at.number("versine"), at.number("inner"), at.number("outer"));
    vec![ramp * ramp * (3.0 - 2.0 * ramp)]
}

/// Its integral: the cubic has the mean 1/2.
fn solid_angle(at: &At) -> Vec<f64> {
    let (inner, outer) = (at.number("inner").min(at.number("outer")), at.number("outer"));
    vec![2.0 * PI * (inner + (outer - inner) / 2.0)]
}
