//! Masking and shadowing correlated by height, over the denominator of the microfacet model.

use crate::oracles::lobes::beckmann_lambda as lambda;
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Heitz 2014, eq. 99.
fn masking(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return vec![0.0];
    }
    let (tv, tl, alpha) = (angle(n, v), angle(n, l), at.number("s.alpha"));
    let g2 = 1.0 / (1.0 + lambda(alpha, tv) + lambda(alpha, tl));
    vec![g2 / (4.0 * tv.cos() * tl.cos())]
}
