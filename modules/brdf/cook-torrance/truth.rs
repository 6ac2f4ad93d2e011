//! Cook and Torrance, in angles and with the index of refraction as in the paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::lobes::{directions, lit, lobe_share, mixed, slope_density, slope_mirror_density};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// Cook and Torrance 1982 with 1 / 4 in place of 1 / pi and a normalised D.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let d = slope_density(at, DVec3::splat(at.number("s.alpha")), lit.v + lit.l) / lit.theta_h.cos().powi(4);
    let (cos_v, cos_l) = (lit.theta_v.cos(), lit.theta_l.cos());
    let g = (2.0 * lit.theta_h.cos() * cos_v.min(cos_l) / lit.mirror.cos()).min(1.0);
    let f = at.vector("s.f0").map(|f0| fresnel(f0, lit.mirror.cos()));
    (at.vector("s.diffuse") / PI + f * (d * g / (4.0 * cos_v * cos_l)))
        .to_array()
        .to_vec()
}

/// A facet by D n.h (Walter et al. 2007, eq. 24), mirrored, by its reflectance toward v.
fn brdf_pdf(at: &At) -> Vec<f64> {
    let cosine = directions(at).theta_v.cos();
    let share = lobe_share(at, at.vector("s.f0").map(|f0| fresnel(f0, cosine)));
    mixed(at, share, slope_mirror_density(at, DVec3::splat(at.number("s.alpha"))))
}

/// Reflectance at an angle with this cosine, the index of refraction being that of the reflectance at normal incidence.
fn fresnel(f0: f64, c: f64) -> f64 {
    if f0 <= 0.0 || f0 >= 1.0 {
        return f0;
    }
    let n = (1.0 + f0.sqrt()) / (1.0 - f0.sqrt());
    let g = (n * n + c * c - 1.0).sqrt();
    let parallel = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    0.5 * ((g - c) / (g + c)).powi(2) * (1.0 + parallel * parallel)
}
