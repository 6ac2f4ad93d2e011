//! Masking and shadowing correlated by height, over the denominator of the microfacet model.

use std::f64::consts::PI;

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("masking", masking)];

/// Heitz 2014, eq. 99.
fn masking(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if n.dot(v) <= 0.0 || n.dot(l) <= 0.0 {
        return vec![0.0];
    }
    let (tv, tl, alpha) = (angle(n, v), angle(n, l), at.number("s.alpha"));
    let g2 = 1.0 / (1.0 + lambda(alpha, tv) + lambda(alpha, tl));
    vec![g2 / (4.0 * tv.cos() * tl.cos())]
}

/// Heitz 2014, section 5.3: (erf(a) - 1) / 2 + exp(-a^2) / (2 a sqrt(pi)), a = 1 / (alpha tan(theta)).
fn lambda(alpha: f64, theta: f64) -> f64 {
    let a = 1.0 / (alpha * theta.tan());
    // exp(-64) is nothing beside 1.
    if a > 8.0 {
        return 0.0;
    }
    (erf(a) - 1.0) / 2.0 + (-a * a).exp() / (2.0 * a * PI.sqrt())
}

/// Abramowitz and Stegun 1964, 7.1.6: a series of positive terms, for x in [0, 8].
fn erf(x: f64) -> f64 {
    let (mut term, mut sum) = (x, x);
    for n in 1..400 {
        term *= 2.0 * x * x / f64::from(2 * n + 1);
        sum += term;
    }
    2.0 / PI.sqrt() * (-x * x).exp() * sum
}
