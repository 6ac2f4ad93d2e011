//! Glowing disks over white paper.

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
        let (radius, two_sided) = (at.instance(i, "radius"), at.param("two_sided") != 0.0);
        let area = PI * (radius * radius).max(1e-12) * if two_sided { 2.0 } else { 1.0 };
        let axis = at.instance_vector(i, "direction").normalize_or(DVec3::Z);
        let factor = area::disk(c, axis, radius, n.normalize(), two_sided);
        let radiance = area::luminance(at.instance(i, "luminance"), at.instance(i, "flux"), area);
        sum += at.instance_vector(i, "color") * (radiance * factor);
    }
    sum.to_array().to_vec()
}
