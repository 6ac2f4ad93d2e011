//! The distribution itself: the shader computes it in another form.

use std::f64::consts::PI;

use crate::oracles::lobes::{cosine_power, folded_density, phong_exponent};
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution), ("facet_pdf", facet_pdf)];

/// Walter et al. 2007, eq. 30, with the exponent of a width.
fn distribution(at: &At) -> Vec<f64> {
    let (n, h) = (at.vector("s.normal"), at.vector("h"));
    if n.dot(h) <= 0.0 {
        return vec![0.0];
    }
    let (alpha, theta) = (at.number("s.alpha"), angle(n, h));
    let m = phong_exponent(alpha);
    vec![(m + 2.0) / (2.0 * PI) * cosine_power(theta, m)]
}

/// By D n.h, turned toward the viewer.
fn facet_pdf(at: &At) -> Vec<f64> {
    folded_density(at, distribution(at)[0])
}
