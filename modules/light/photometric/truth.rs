//! The example's intensities, as its formula and its grid give them, on white paper.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::oracles::lights::{Point, point_illuminance};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("light", light)];

/// Steps of the grid in `sample.ies`, degrees.
const POLAR: f64 = 2.5;
const AZIMUTH: f64 = 15.0;

/// What `sample.ies` says at a node of its grid, cd, with three decimals.
fn node(polar: f64, azimuth: f64) -> f64 {
    if polar >= 90.0 {
        return 0.0;
    }
    let (polar, azimuth) = (polar.to_radians(), azimuth.to_radians());
    let candela = 1000.0 * polar.cos().powi(3) * (1.0 + 0.4 * (2.0 * azimuth).cos() * polar.sin().powi(2));
    (candela * 1000.0).round() / 1000.0
}

/// Bilinear in the angles.
fn candela(polar: f64, azimuth: f64) -> f64 {
    if polar > 90.0 {
        return 0.0;
    }
    let (p, a) = ((polar / POLAR).floor().min(35.0), (azimuth / AZIMUTH).floor());
    let (s, t) = (polar / POLAR - p, azimuth / AZIMUTH - a);
    let row = |a: f64| node(p * POLAR, a * AZIMUTH) * (1.0 - s) + node((p + 1.0) * POLAR, a * AZIMUTH) * s;
    row(a) * (1.0 - t) + row(a + 1.0) * t
}

/// Luminous flux of the grid, lm: Simpson's rule within each of its cells, in which the integrand is smooth.
fn flux() -> f64 {
    let step = POLAR.to_radians();
    let mut sum = 0.0;
    for a in 0..24 {
        for p in 0..36 {
            let at = |part: f64| {
                let polar = (f64::from(p) + part) * POLAR;
                let mean = (candela(polar, f64::from(a) * AZIMUTH) + candela(polar, f64::from(a + 1) * AZIMUTH)) / 2.0;
                mean * polar.to_radians().sin()
            };
            sum += (at(0.0) + 4.0 * at(0.5) + at(1.0)) / 6.0 * step * AZIMUTH.to_radians();
        }
    }
    sum
}

/// The cosine law and the windowed inverse square. Alone, a light falls on a white Lambertian surface.
fn light(at: &At) -> Vec<f64> {
    let mut sum = [0.0; 3];
    for index in 0..at.instances.len() {
        let vector = |name: &str| at.instance_vector(index, name);
        let number = |name: &str| at.instance(index, name);
        let (toward, place) = (vector("direction"), at.vector("s.position"));
        let out = place - vector("position");
        let Some(axis) = toward.try_normalize() else { continue };
        let across = vector("across") - vector("across").dot(axis) * axis;
        let across = across.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        let [x, y, z] = [across, across.cross(axis), axis].map(|part: DVec3| out.dot(part));
        let (polar, azimuth) = (x.hypot(y).atan2(z), y.atan2(x).rem_euclid(TAU));
        let mut intensity = candela(polar.to_degrees(), azimuth.to_degrees()) * number("multiplier");
        if number("flux") > 0.0 {
            intensity *= number("flux") / flux();
        }
        let light = Point {
            position: vector("position"),
            intensity,
            range: number("range"),
            size: number("size"),
        };
        let radiance = point_illuminance(&light, place, at.vector("s.normal")) / PI;
        for (sum, color) in sum.iter_mut().zip(vector("color").to_array()) {
            *sum += radiance * color;
        }
    }
    sum.to_vec()
}
