//! A cone of light on white paper.

use std::f64::consts::PI;

use crate::oracles::lights::{Point, Spot, candela, spot_illuminance};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("light", light)];

/// The cosine law, the windowed inverse square and glTF's edge. Alone, a light falls on a white Lambertian surface.
fn light(at: &At) -> Vec<f64> {
    let mut sum = [0.0; 3];
    for index in 0..at.instances.len() {
        let number = |name: &str| at.instance(index, name);
        let intensity = if number("flux") > 0.0 { candela(number("flux")) } else { number("intensity") };
        let light = Spot {
            point: Point {
                position: at.instance_vector(index, "position"),
                intensity,
                range: number("range"),
                size: number("size"),
            },
            direction: at.instance_vector(index, "direction"),
            inner: number("inner"),
            outer: number("outer"),
        };
        let radiance = spot_illuminance(&light, at.vector("s.position"), at.vector("s.normal")) / PI;
        for (sum, color) in sum.iter_mut().zip(at.instance_vector(index, "color").to_array()) {
            *sum += radiance * color;
        }
    }
    sum.to_vec()
}
