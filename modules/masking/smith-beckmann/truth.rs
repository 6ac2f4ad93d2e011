//! Masking and shadowing correlated by height, over the denominator of the microfacet model.

use crate::oracles::lobes::{Lit, beckmann_lambda as lambda, lit};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Heitz 2014, eq. 99.
fn masking(at: &At) -> Vec<f64> {
    let Some(Lit { theta_v, theta_l, .. }) = lit(at) else {
        return vec![0.0];
    };
    let alpha = at.number("s.alpha");
    let g2 = 1.0 / (1.0 + lambda(alpha, theta_v) + lambda(alpha, theta_l));
    vec![g2 / (4.0 * theta_v.cos() * theta_l.cos())]
}
