//! Masking and shadowing in grooves, over the denominator of the microfacet model.

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Cook and Torrance 1982. h is the bisector of v and l.
fn masking(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return vec![0.0];
    }
    let (nv, nl) = (angle(n, v).cos(), angle(n, l).cos());
    let nh = angle(n, v.normalize() + l.normalize()).cos();
    // A f32 direction is known to 6e-8: no two of them are nearer to opposite than that.
    let vh = (0.5 * angle(v, l)).cos().max(0.5e-7);
    let g = (2.0 * nh * nv / vh).min(2.0 * nh * nl / vh).min(1.0);
    vec![g / (4.0 * nv * nl)]
}
