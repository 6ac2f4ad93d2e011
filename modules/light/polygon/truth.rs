//! Glowing polygons over white paper.

use glam::DVec3;

use crate::oracles::{At, Truth, area};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("light", light)];

/// Alone, with an albedo of 1, a surface has the illuminance over pi.
fn light(at: &At) -> Vec<f64> {
    let mut sum = DVec3::ZERO;
    for i in 0..at.instances.len() {
        let c = at.instance_vector(i, "position") - at.vector("s.position");
        let n = at.vector("s.normal");
        let two_sided = at.param("two_sided") != 0.0;
        let count = at.instance(i, "corners").clamp(3.0, 16.0);
        let corner = |k: usize| {
            let p = at.instance_vector(i, &format!("p{k}"));
            (p.x, p.y)
        };
        let corners: Vec<_> = (0..16).take_while(|k| (*k as f64) < count).map(corner).collect();
        let edges = corners.iter().zip(corners.iter().cycle().skip(1));
        let twice: f64 = edges.map(|(p, q)| p.0 * q.1 - q.0 * p.1).sum();
        let area = (twice.abs() / 2.0).max(1e-12) * if two_sided { 2.0 } else { 1.0 };
        let axes = area::plane_axes(at.instance_vector(i, "direction"), at.instance_vector(i, "right"));
        let factor = area::flat(c, axes, &corners, n.normalize(), two_sided);
        let radiance = area::luminance(at.instance(i, "luminance"), at.instance(i, "flux"), area);
        sum += at.instance_vector(i, "color") * (radiance * factor);
    }
    sum.to_array().to_vec()
}
