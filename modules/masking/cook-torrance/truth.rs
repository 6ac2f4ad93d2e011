//! Masking and shadowing in grooves, over the denominator of the microfacet model.

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Cook and Torrance 1982. h is the bisector of v and l.
fn masking(at: &At) -> Vec<f64> {
    let Some(Lit {
        theta_v,
        theta_l,
        theta_h,
        mirror,
        ..
    }) = lit(at)
    else {
        return vec![0.0];
    };
    let (nv, nl) = (theta_v.cos(), theta_l.cos());
    let nh = theta_h.cos();
    // A f32 direction is known to 6e-8: no two of them are nearer to opposite than that.
    let vh = mirror.cos().max(0.5e-7);
    let g = (2.0 * nh * nv / vh).min(2.0 * nh * nl / vh).min(1.0);
    vec![g / (4.0 * nv * nl)]
}
