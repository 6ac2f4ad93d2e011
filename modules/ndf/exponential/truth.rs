//! The distribution itself: the shader computes it in another form.

use std::f64::consts::PI;

use crate::oracles::lobes::folded_density;
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution), ("facet_pdf", facet_pdf)];

/// Density of slopes of the root mean square alpha, over cos^4.
fn distribution(at: &At) -> Vec<f64> {
    let (n, h) = (at.vector("s.normal"), at.vector("h"));
    if n.dot(h) <= 0.0 {
        return vec![0.0];
    }
    let (alpha, theta) = (at.number("s.alpha"), angle(n, h));
    let slopes = 3.0 / (PI * alpha * alpha) * (-6f64.sqrt() * theta.tan() / alpha).exp();
    vec![slopes / theta.cos().powi(4)]
}

/// By D n.h, turned toward the viewer.
fn facet_pdf(at: &At) -> Vec<f64> {
    folded_density(at, distribution(at)[0])
}
