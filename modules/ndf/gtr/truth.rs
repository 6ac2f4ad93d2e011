//! The distribution itself: the shader computes it in another form.

use std::f64::consts::PI;

use crate::oracles::lobes::folded_density;
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution), ("facet_pdf", facet_pdf)];

/// Burley 2012, appendix B.2: c / (alpha^2 cos^2 + sin^2)^gamma and its three cases of c.
fn distribution(at: &At) -> Vec<f64> {
    let (alpha, gamma) = (at.number("s.alpha"), at.param("gamma"));
    let (n, h) = (at.vector("s.normal"), at.vector("h"));
    if n.dot(h) <= 0.0 {
        return vec![0.0];
    }
    let theta = angle(n, h);
    let a2 = alpha * alpha;
    let (ln_a2, gap) = (a2.ln(), (1.0 - alpha) * (1.0 + alpha));
    // 1 / (pi c): the mean of q^-gamma for q from alpha^2 to 1.
    let mean = if gap == 0.0 {
        1.0
    } else if (1.0 - gamma).abs() * ln_a2.abs() < 1e-12 {
        -ln_a2 / gap
    } else {
        -((1.0 - gamma) * ln_a2).exp_m1() / ((1.0 - gamma) * gap)
    };
    let q = a2 * theta.cos().powi(2) + theta.sin().powi(2);
    vec![q.powf(-gamma) / (PI * mean)]
}

/// By D n.h, turned toward the viewer.
fn facet_pdf(at: &At) -> Vec<f64> {
    folded_density(at, distribution(at)[0])
}
