//! Lafortune et al., the lobe as in the paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::lobes::{cosine_power, diffuse_and_lobe, directions, lit, lobe_share, local, mixed, phong_exponent};
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

fn coefficients(at: &At) -> DVec3 {
    DVec3::new(at.param("cx"), at.param("cy"), at.param("cz"))
}

/// Lafortune et al. 1997, one lobe and the diffuse term; the exponent is that of facets as wide as alpha.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let n = phong_exponent(at.number("s.alpha"));
    let cosine = (coefficients(at) * local(at, lit.v)).dot(local(at, lit.l));
    diffuse_and_lobe(at, (n + 2.0) / (2.0 * PI) * if cosine > 0.0 { cosine.powf(n) } else { 0.0 })
}

/// (n + 1) / (2 pi) cos^n around C v.
fn brdf_pdf(at: &At) -> Vec<f64> {
    let lit = directions(at);
    let n = phong_exponent(at.number("s.alpha"));
    let theta = angle(coefficients(at) * local(at, lit.v), local(at, lit.l));
    mixed(
        at,
        lobe_share(at, at.vector("s.f0")),
        (n + 1.0) / (2.0 * PI) * cosine_power(theta, n),
    )
}
