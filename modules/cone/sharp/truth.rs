//! An edge.

use std::f64::consts::PI;

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("cone", cone), ("cone_solid_angle", solid_angle)];

/// The indicator of the cone.
fn cone(at: &At) -> Vec<f64> {
    vec![f64::from(u8::from(at.number("versine") < at.number("outer")))]
}

/// The solid angle of a cone.
fn solid_angle(at: &At) -> Vec<f64> {
    vec![2.0 * PI * at.number("outer")]
}
