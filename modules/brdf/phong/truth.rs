//! Phong, normalised: angles as in the paper.

use std::f64::consts::PI;

use crate::oracles::lobes::{diffuse_and_lobe, directions, lit, lobe_share, mirror_power, mixed, phong_exponent};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// Phong 1975 with Lewis' factor; the exponent is that of facets as wide as alpha.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let n = phong_exponent(at.number("s.alpha"));
    diffuse_and_lobe(at, (n + 2.0) / (2.0 * PI) * mirror_power(&lit, n))
}

/// (n + 1) / (2 pi) cos^n around the mirror direction. Lafortune and Willems 1994.
fn brdf_pdf(at: &At) -> Vec<f64> {
    let n = phong_exponent(at.number("s.alpha"));
    let lobe = (n + 1.0) / (2.0 * PI) * mirror_power(&directions(at), n);
    mixed(at, lobe_share(at, at.vector("s.f0")), lobe)
}
