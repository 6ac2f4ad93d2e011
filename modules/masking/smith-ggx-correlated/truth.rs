//! Masking and shadowing correlated by height, over the denominator of the microfacet model.

use crate::oracles::reflection::ggx_v_correlated;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Heitz 2014, eq. 99.
fn masking(at: &At) -> Vec<f64> {
    vec![ggx_v_correlated(
        at.number("s.alpha"),
        at.vector("s.normal"),
        at.vector("v"),
        at.vector("l"),
    )]
}
