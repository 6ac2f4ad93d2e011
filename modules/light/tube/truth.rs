//! Glowing tubes over white paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::{At, Truth, area};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("light", light)];

/// Alone, with an albedo of 1, a surface has the illuminance over pi.
fn light(at: &At) -> Vec<f64> {
    let mut sum = DVec3::ZERO;
    for i in 0..at.instances.len() {
        let c = at.instance_vector(i, "position") - at.vector("s.position");
        let n = at.vector("s.normal");
        let (length, radius, caps) = (at.instance(i, "length"), at.instance(i, "radius"), at.param("caps") != 0.0);
        let ends = if caps { 2.0 * PI * radius * radius } else { 0.0 };
        let area = (2.0 * PI * radius * length + ends).max(1e-12);
        let factor = area::tube(c, at.instance_vector(i, "along"), length, radius, n.normalize(), caps);
        let radiance = area::luminance(at.instance(i, "luminance"), at.instance(i, "flux"), area);
        sum += at.instance_vector(i, "color") * (radiance * factor);
    }
    sum.to_array().to_vec()
}
