//! The model with the module that its slot has where nothing is chosen.

use std::f64::consts::FRAC_PI_2;

use crate::oracles::reflection::{angle, lambert};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Lambert 1760, above the horizon.
fn brdf(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if angle(n, v) >= FRAC_PI_2 || angle(n, l) >= FRAC_PI_2 {
        return vec![0.0; 3];
    }
    at.vector("s.diffuse").to_array().map(lambert).to_vec()
}
