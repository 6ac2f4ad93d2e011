//! Inverse square with a window, on white paper.

use std::f64::consts::PI;

use crate::oracles::lights::{Point, point_illuminance};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("light", light)];

/// The cosine law and the inverse square, with Karis 2013's window. Alone, a light falls on a white Lambertian surface.
fn light(at: &At) -> Vec<f64> {
    let mut sum = [0.0; 3];
    for index in 0..at.instances.len() {
        let light = Point {
            position: at.instance_vector(index, "position"),
            intensity: at.instance(index, "intensity"),
            range: at.instance(index, "range"),
            size: at.instance(index, "size"),
        };
        let radiance = point_illuminance(&light, at.vector("s.position"), at.vector("s.normal")) / PI;
        for (sum, color) in sum.iter_mut().zip(at.instance_vector(index, "color").to_array()) {
            *sum += radiance * color;
        }
    }
    sum.to_vec()
}
