//! The neutral shape, a sphere of 0.5 m around (0, 0, 2) with 1 cd/m2, over white paper.

use glam::DVec3;

use crate::oracles::{At, Truth, area};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("illuminate", illuminate)];

/// Alone the BRDF is white paper's, so this is the illuminance over pi.
fn illuminate(at: &At) -> Vec<f64> {
    let c = DVec3::new(0.0, 0.0, 2.0) - at.vector("s.position");
    vec![area::sphere(c, 0.5, at.vector("s.normal").normalize()); 3]
}
