//! The model with the modules that its slots have where nothing is chosen.

use crate::oracles::reflection::{Surface, microfacet};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Walter et al. 2007, eq. 20, with GGX, Smith's correlated masking, Schlick's Fresnel term, and a Lambertian base.
fn brdf(at: &At) -> Vec<f64> {
    let (v, l) = (at.vector("v"), at.vector("l"));
    let (diffuse, f0) = (at.vector("s.diffuse"), at.vector("s.f0"));
    let channel = |i: usize| {
        let surface = Surface {
            normal: at.vector("s.normal"),
            diffuse: diffuse[i],
            f0: f0[i],
            alpha: at.number("s.alpha"),
        };
        microfacet(&surface, v, l)
    };
    (0..3).map(channel).collect()
}
