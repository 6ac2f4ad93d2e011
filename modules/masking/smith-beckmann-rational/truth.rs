//! The fit itself: Smith's integral is the truth of what it approximates.

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Heitz 2014, eq. 99, with the masking of one direction by Walter et al. 2007, eq. 27.
fn masking(at: &At) -> Vec<f64> {
    let Some(Lit { theta_v, theta_l, .. }) = lit(at) else {
        return vec![0.0];
    };
    let alpha = at.number("s.alpha");
    let g2 = 1.0 / (1.0 / g1(alpha, theta_v) + 1.0 / g1(alpha, theta_l) - 1.0);
    vec![g2 / (4.0 * theta_v.cos() * theta_l.cos())]
}

/// Walter et al. 2007, eq. 27.
fn g1(alpha: f64, theta: f64) -> f64 {
    let a = 1.0 / (alpha * theta.tan());
    if a >= 1.6 {
        return 1.0;
    }
    (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a)
}
