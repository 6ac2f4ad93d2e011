//! Masking times shadowing, over the denominator of the microfacet model.

use crate::oracles::reflection::{angle, ggx_g2_separable};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Walter et al. 2007, eqs. 23 and 34.
fn masking(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return vec![0.0];
    }
    let (tv, tl) = (angle(n, v), angle(n, l));
    vec![ggx_g2_separable(at.number("s.alpha"), tv, tl) / (4.0 * tv.cos() * tl.cos())]
}
