//! The distribution itself: the shader computes it in another form.

use std::f64::consts::PI;

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution)];

/// Walter et al. 2007, eq. 30, with the exponent of a width.
fn distribution(at: &At) -> Vec<f64> {
    let (n, h) = (at.vector("s.normal"), at.vector("h"));
    if n.dot(h) <= 0.0 {
        return vec![0.0];
    }
    let (alpha, theta) = (at.number("s.alpha"), angle(n, h));
    let m = 2.0 / (alpha * alpha) - 2.0;
    // ln(cos) from the half angle: a cosine near 1 has too few digits for a power of 2e8, in double precision as well.
    let log_cos = (-2.0 * (0.5 * theta).sin().powi(2)).ln_1p();
    vec![(m + 2.0) / (2.0 * PI) * (m * log_cos).exp()]
}
