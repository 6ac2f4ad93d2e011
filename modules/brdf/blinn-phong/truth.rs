//! Blinn-Phong, normalised: angles as in the paper.

use std::f64::consts::PI;

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Blinn 1977, D1, with Giesen's factor; the exponent is that of facets as wide as alpha.
fn brdf(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let n = 2.0 / at.number("s.alpha").powi(2) - 2.0;
    let factor = (n + 2.0) * (n + 4.0) / (8.0 * PI * ((-n / 2.0).exp2() + n));
    (at.vector("s.diffuse") / PI + at.vector("s.f0") * (factor * angle(normal, v + l).cos().powf(n)))
        .to_array()
        .to_vec()
}
