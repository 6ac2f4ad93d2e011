//! G over the denominator of the microfacet model.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Hoffman 2013: G = n.l n.v.
fn masking(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return vec![0.0];
    }
    let g = n.dot(v) * n.dot(l);
    vec![g / (4.0 * n.dot(v) * n.dot(l))]
}
