//! Kurt et al., in angles as in the paper.

use std::f64::consts::PI;

use crate::oracles::lobes::{directions, lit, lobe_share, mixed, schlick_rgb, slope_density, slope_mirror_density};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// Kurt et al. 2010, one lobe and the diffuse term.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let d = slope_density(at, at.vector("s.widths"), lit.v + lit.l) / lit.theta_h.cos().powi(4);
    let attenuation = (lit.theta_v.cos() * lit.theta_l.cos()).powf(at.param("alpha_k"));
    let f = schlick_rgb(at.vector("s.f0"), lit.mirror.cos());
    (at.vector("s.diffuse") / PI + f * (d / (4.0 * lit.mirror.cos() * attenuation)))
        .to_array()
        .to_vec()
}

/// A half vector by D n.h, mirrored, by its reflectance toward v.
fn brdf_pdf(at: &At) -> Vec<f64> {
    let share = lobe_share(at, schlick_rgb(at.vector("s.f0"), directions(at).theta_v.cos()));
    mixed(at, share, slope_mirror_density(at, at.vector("s.widths")))
}
