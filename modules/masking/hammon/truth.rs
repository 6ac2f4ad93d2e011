//! The fit itself: the correlated closed form is the truth of what it approximates.

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Hammon 2017: G2 = 2 n.l n.v / lerp(2 n.l n.v, n.l + n.v, alpha).
fn masking(at: &At) -> Vec<f64> {
    let Some(Lit { theta_v, theta_l, .. }) = lit(at) else {
        return vec![0.0];
    };
    let (nv, nl, alpha) = (theta_v.cos(), theta_l.cos(), at.number("s.alpha"));
    let g = 2.0 * nl * nv / (2.0 * nl * nv * (1.0 - alpha) + (nl + nv) * alpha);
    vec![g / (4.0 * nl * nv)]
}
