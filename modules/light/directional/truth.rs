//! Parallel light on white paper.

use std::f64::consts::PI;

use crate::oracles::lights::directional_illuminance;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("light", light)];

/// The cosine law. Alone, a light falls on a white Lambertian surface.
fn light(at: &At) -> Vec<f64> {
    let mut sum = [0.0; 3];
    for index in 0..at.instances.len() {
        let direction = at.instance_vector(index, "direction");
        let radiance = directional_illuminance(direction, at.instance(index, "illuminance"), at.vector("s.normal")) / PI;
        for (sum, color) in sum.iter_mut().zip(at.instance_vector(index, "color").to_array()) {
            *sum += radiance * color;
        }
    }
    sum.to_vec()
}
