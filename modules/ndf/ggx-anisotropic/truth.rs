//! GGX of two widths, in angles as in the paper.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution)];

/// Burley 2012, GTR2 of two widths, by the slope; phi is counted from the tangent.
fn distribution(at: &At) -> Vec<f64> {
    let (normal, tangent, widths, h) = (at.vector("s.normal"), at.vector("s.tangent"), at.vector("s.widths"), at.vector("h"));
    let theta = angle(normal, h);
    if theta >= FRAC_PI_2 {
        return vec![0.0];
    }
    let phi = h.dot(normal.cross(tangent)).atan2(h.dot(tangent));
    let slope = theta.tan().powi(2) * ((phi.cos() / widths.x).powi(2) + (phi.sin() / widths.y).powi(2));
    vec![1.0 / (PI * widths.x * widths.y * theta.cos().powi(4) * (1.0 + slope).powi(2))]
}
