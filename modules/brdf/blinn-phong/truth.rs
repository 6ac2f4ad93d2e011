//! Blinn-Phong, normalised: angles as in the paper.

use std::f64::consts::PI;

use crate::oracles::lobes::{cosine_power, diffuse_and_lobe, directions, lit, lobe_share, mixed, phong_exponent};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// Blinn 1977, D1, with Giesen's factor; the exponent is that of facets as wide as alpha.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let n = phong_exponent(at.number("s.alpha"));
    let factor = (n + 2.0) * (n + 4.0) / (8.0 * PI * ((-n / 2.0).exp2() + n));
    diffuse_and_lobe(at, factor * cosine_power(lit.theta_h, n))
}

/// A half vector by (n + 1) / (2 pi) cos^n, mirrored: over 4 v.h. One into the surface gives light from below it.
fn brdf_pdf(at: &At) -> Vec<f64> {
    let lit = directions(at);
    let n = phong_exponent(at.number("s.alpha"));
    let theta = lit.theta_h.min(PI - lit.theta_h);
    let lobe = (n + 1.0) / (2.0 * PI) * cosine_power(theta, n) / (4.0 * lit.mirror.cos());
    mixed(at, lobe_share(at, at.vector("s.f0")), lobe)
}
