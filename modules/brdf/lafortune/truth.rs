//! Lafortune et al., the lobe as in the paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Lafortune et al. 1997, one lobe and the diffuse term; the exponent is that of facets as wide as alpha.
fn brdf(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let n = 2.0 / at.number("s.alpha").powi(2) - 2.0;
    let tangent = at.vector("s.tangent");
    let local = |d: DVec3| DVec3::new(d.dot(tangent), d.dot(normal.cross(tangent)), d.dot(normal)) / d.length();
    let c = DVec3::new(at.param("cx"), at.param("cy"), at.param("cz"));
    let cosine = (c * local(v)).dot(local(l));
    let lobe = if cosine <= 0.0 {
        0.0
    } else {
        (n + 2.0) / (2.0 * PI) * cosine.powf(n)
    };
    (at.vector("s.diffuse") / PI + at.vector("s.f0") * lobe).to_array().to_vec()
}
