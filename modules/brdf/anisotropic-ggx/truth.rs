//! GGX of two widths, in angles as in the papers.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::lobes::{directions, ggx_d_of_widths, ggx_mirror_density, lit, lobe_share, mixed, schlick_rgb, width_toward};
use crate::oracles::reflection::ggx_g2_of_widths;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// Walter et al. 2007, eq. 20, with D, G2 and Lambda of Heitz 2014, eqs. 85, 99 and 72, at the width that the azimuth sees.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let widths = at.vector("s.widths");
    let width = |d: DVec3| width_toward(at, widths, d);
    let g = ggx_g2_of_widths([width(lit.v), width(lit.l)], [lit.theta_v, lit.theta_l]);
    let facets = ggx_d_of_widths(at, widths, lit.v + lit.l) * g / (4.0 * lit.theta_v.cos() * lit.theta_l.cos());
    let f = schlick_rgb(at.vector("s.f0"), lit.mirror.cos());
    (at.vector("s.diffuse") / PI + f * facets).to_array().to_vec()
}

/// Facets that v sees (Heitz 2014, eqs. 16 and 18), by their reflectance toward v.
fn brdf_pdf(at: &At) -> Vec<f64> {
    let share = lobe_share(at, schlick_rgb(at.vector("s.f0"), directions(at).theta_v.cos()));
    mixed(at, share, ggx_mirror_density(at, at.vector("s.widths")))
}
