//! The shifted gamma model, in angles as in the paper.

use std::f64::consts::PI;

use glam::DVec3;

use crate::oracles::lobes::{directions, lit, luminance, mixed, slope_mirror_density};
use crate::oracles::reflection::ggx_d;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// The fitted Fresnel term, kept from below 0.
fn fresnel(at: &At, i: usize, cosine: f64) -> f64 {
    let (f0, f1) = (at.param_vector("f0")[i], at.param_vector("f1")[i]);
    (f0 - f1 * cosine + (1.0 - f0) * (1.0 - cosine).powi(5)).max(0.0)
}

/// Bagher et al. 2012, with the Fresnel term kept from below 0 and G1 within [0, 1].
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let channel = |i: usize| {
        let param = |name: &str| at.param_vector(name)[i];
        let x = param("alpha") + lit.theta_h.tan().powi(2) / param("alpha");
        let d = param("kappa") * (-x).exp() / (PI * x.powf(param("p")) * lit.theta_h.cos().powi(4));
        let g1 = |theta: f64| {
            // Where the power is beyond all numbers, a strength of 0 is still none.
            let grown = (param("c") * (theta - param("theta_0")).max(0.0).powf(param("k"))).min(700.0).exp();
            (1.0 + param("lambda") * (1.0 - grown)).clamp(0.0, 1.0)
        };
        let specular = fresnel(at, i, lit.mirror.cos()) * d * g1(lit.theta_v) * g1(lit.theta_l) / (lit.theta_v.cos() * lit.theta_l.cos());
        (param("rho_d") + param("rho_s") * specular) / PI
    };
    (0..3).map(channel).collect()
}

/// Half the facets by GGX of the width a, half by Beckmann of the width sqrt(a), a the mean of the channels' alpha, mirrored.
fn brdf_pdf(at: &At) -> Vec<f64> {
    let lit = directions(at);
    let width = at.param_vector("alpha").element_sum() / 3.0;
    let theta = lit.theta_h.min(PI - lit.theta_h);
    let core = ggx_d(width, theta) * theta.cos() / (4.0 * lit.mirror.cos());
    let tail = slope_mirror_density(at, DVec3::splat(width.sqrt()));
    let rho_s = at.param_vector("rho_s");
    let reflected = luminance(DVec3::from_array([0, 1, 2].map(|i| rho_s[i] * fresnel(at, i, lit.theta_v.cos()))));
    let share = (reflected / (reflected + luminance(at.param_vector("rho_d"))).max(1e-20)).clamp(0.1, 0.9);
    mixed(at, share, 0.5 * (core + tail))
}
