//! The model with the modules that its slots have where nothing is chosen.

use glam::DVec3;

use crate::oracles::lobes::{directions, ggx_mirror_density, lit, lobe_share, mixed, schlick_rgb};
use crate::oracles::reflection::{Surface, microfacet};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// Walter et al. 2007, eq. 20, with GGX, Smith's correlated masking, Schlick's Fresnel term, and a Lambertian base.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let (diffuse, f0) = (at.vector("s.diffuse"), at.vector("s.f0"));
    let channel = |i: usize| {
        let surface = Surface {
            normal: lit.normal,
            diffuse: diffuse[i],
            f0: f0[i],
            alpha: at.number("s.alpha"),
        };
        microfacet(&surface, lit.v, lit.l)
    };
    (0..3).map(channel).collect()
}

/// Facets that v sees (Heitz 2014, eqs. 16 and 18), by their reflectance toward v.
fn brdf_pdf(at: &At) -> Vec<f64> {
    let share = lobe_share(at, schlick_rgb(at.vector("s.f0"), directions(at).theta_v.cos()));
    mixed(at, share, ggx_mirror_density(at, DVec3::splat(at.number("s.alpha"))))
}
