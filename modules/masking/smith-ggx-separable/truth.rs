//! Masking times shadowing, over the denominator of the microfacet model.

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::reflection::ggx_g2_separable;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Walter et al. 2007, eqs. 23 and 34.
fn masking(at: &At) -> Vec<f64> {
    let Some(Lit { theta_v, theta_l, .. }) = lit(at) else {
        return vec![0.0];
    };
    vec![ggx_g2_separable(at.number("s.alpha"), theta_v, theta_l) / (4.0 * theta_v.cos() * theta_l.cos())]
}
