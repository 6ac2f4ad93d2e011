//! GGX of two widths, in angles as in the papers.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::reflection::{angle, schlick};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Walter et al. 2007, eq. 20, with D, G2 and Lambda of Heitz 2014, eqs. 85, 99 and 72, at the width that the azimuth sees.
fn brdf(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let widths = at.vector("s.widths");
    let h = v + l;
    let theta = angle(normal, h);
    let d = 1.0 / (PI * widths.x * widths.y * theta.cos().powi(4) * (1.0 + squared_slope(at, h)).powi(2));
    let lambda = |d: DVec3| {
        let tangent = at.vector("s.tangent");
        let phi = d.dot(normal.cross(tangent)).atan2(d.dot(tangent));
        let width = (phi.cos() * widths.x).hypot(phi.sin() * widths.y);
        0.5 * ((1.0 + (width * angle(normal, d).tan()).powi(2)).sqrt() - 1.0)
    };
    let g = 1.0 / (1.0 + lambda(v) + lambda(l));
    let facets = d * g / (4.0 * angle(normal, v).cos() * angle(normal, l).cos());
    let mirror = (angle(v, l) / 2.0).cos();
    let f = at.vector("s.f0").to_array().map(|f0| schlick(f0, mirror));
    (at.vector("s.diffuse") / PI + DVec3::from_array(f) * facets).to_array().to_vec()
}

/// tan^2(theta) (cos^2(phi) / ax^2 + sin^2(phi) / ay^2) of a half vector; phi is counted from the tangent.
fn squared_slope(at: &At, h: DVec3) -> f64 {
    let (normal, tangent, widths) = (at.vector("s.normal"), at.vector("s.tangent"), at.vector("s.widths"));
    let phi = h.dot(normal.cross(tangent)).atan2(h.dot(tangent));
    angle(normal, h).tan().powi(2) * ((phi.cos() / widths.x).powi(2) + (phi.sin() / widths.y).powi(2))
}
