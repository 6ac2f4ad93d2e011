//! The distribution itself: the shader computes it in another form.

use std::f64::consts::PI;

use crate::oracles::lobes::{beckmann_lambda, facet, visible_density};
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution), ("facet_pdf", facet_pdf)];

/// Walter et al. 2007, eq. 25.
fn distribution(at: &At) -> Vec<f64> {
    let (n, h) = (at.vector("s.normal"), at.vector("h"));
    if n.dot(h) <= 0.0 {
        return vec![0.0];
    }
    let (alpha, theta) = (at.number("s.alpha"), angle(n, h));
    let exponent = (theta.tan() / alpha).powi(2);
    vec![(-exponent).exp() / (PI * alpha.powi(2) * theta.cos().powi(4))]
}

/// Facets that v sees.
fn facet_pdf(at: &At) -> Vec<f64> {
    let (_, theta_v, _) = facet(at);
    visible_density(
        at,
        1.0 / (1.0 + beckmann_lambda(at.number("s.alpha"), theta_v)),
        distribution(at)[0],
    )
}
