//! The approximation itself: the shader computes it in another form.

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Kelemen and Szirmay-Kalos 2001: G / (n.l n.v) taken for 1 / (l.h)^2, with l.h the cosine of half the angle between v and l.
fn masking(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return vec![0.0];
    }
    // A f32 direction is known to 6e-8: no two of them are nearer to opposite than that.
    let lh = (0.5 * angle(v, l)).cos().max(0.5e-7);
    vec![1.0 / (4.0 * lh * lh)]
}
