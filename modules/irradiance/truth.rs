//! The neutral shape, a sphere of 0.5 m around (0, 0, 2) with 1 cd/m2, over white paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::{At, Truth, area};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("irradiance", irradiance)];

/// pi times luminance times form factor.
fn irradiance(at: &At) -> Vec<f64> {
    let c = DVec3::new(0.0, 0.0, 2.0) - at.vector("s.position");
    vec![PI * area::sphere(c, 0.5, at.vector("s.normal").normalize()); 3]
}
