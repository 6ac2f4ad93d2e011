//! A disc infinitely far away, over white paper.

use std::f64::consts::PI;

use crate::oracles::lights::{SUN_DIAMETER, disc_cosine};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("light", light)];

/// The cosine law over the disc, its part below the horizon left out. Lights that say nothing of their size are as large as the sun.
fn light(at: &At) -> Vec<f64> {
    let mut sum = [0.0; 3];
    for index in 0..at.instances.len() {
        let toward = -at.instance_vector(index, "direction");
        let said = at.instance(index, "angular_diameter");
        let diameter = if said.is_nan() { SUN_DIAMETER } else { said };
        let illuminance = if toward.length() > 0.0 {
            at.instance(index, "illuminance") * disc_cosine(at.vector("s.normal"), toward, diameter / 2.0)
        } else {
            0.0
        };
        for (sum, color) in sum.iter_mut().zip(at.instance_vector(index, "color").to_array()) {
            *sum += illuminance / PI * color;
        }
    }
    sum.to_vec()
}
