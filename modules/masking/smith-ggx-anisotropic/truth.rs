//! Masking and shadowing of facets of two widths, correlated by height, over the denominator of the microfacet model.

use glam::DVec3;

use crate::oracles::reflection::{angle, ggx_lambda};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Heitz 2014, eq. 99, with the width that the azimuth sees (eq. 80).
fn masking(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0];
    }
    let (tangent, widths) = (at.vector("s.tangent"), at.vector("s.widths"));
    let lambda = |d: DVec3| {
        let phi = d.dot(normal.cross(tangent)).atan2(d.dot(tangent));
        ggx_lambda((phi.cos() * widths.x).hypot(phi.sin() * widths.y), angle(normal, d))
    };
    let g = 1.0 / (1.0 + lambda(v) + lambda(l));
    vec![g / (4.0 * angle(normal, v).cos() * angle(normal, l).cos())]
}
