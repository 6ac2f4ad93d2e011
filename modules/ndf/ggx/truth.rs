//! The distribution itself: the shader computes it in another form.

use crate::oracles::reflection::{angle, ggx_d};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution)];

/// Walter et al. 2007, eq. 33.
fn distribution(at: &At) -> Vec<f64> {
    vec![ggx_d(at.number("s.alpha"), angle(at.vector("s.normal"), at.vector("h")))]
}
