//! The distribution itself: the shader computes it in another form.

use crate::oracles::lobes::{facet, visible_density};
use crate::oracles::reflection::{angle, ggx_d, ggx_g1};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution), ("facet_pdf", facet_pdf)];

/// Walter et al. 2007, eq. 33.
fn distribution(at: &At) -> Vec<f64> {
    let (n, h) = (at.vector("s.normal"), at.vector("h"));
    if n.dot(h) <= 0.0 {
        return vec![0.0];
    }
    vec![ggx_d(at.number("s.alpha"), angle(n, h))]
}

/// Facets that v sees.
fn facet_pdf(at: &At) -> Vec<f64> {
    let (_, theta_v, _) = facet(at);
    visible_density(at, ggx_g1(at.number("s.alpha"), theta_v), distribution(at)[0])
}
