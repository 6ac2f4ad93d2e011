//! Fresnel's equations at a boundary between two dielectrics.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

/// Born and Wolf 1999, section 1.5.2: the amplitudes of both polarisations, by the cosines of incidence and refraction.
fn fresnel(at: &At) -> Vec<f64> {
    let n = at.param("ior");
    let incidence = at.number("cosine").clamp(0.0, 1.0);
    let square = 1.0 - 1.0 / (n * n) + (incidence / n).powi(2);
    if square <= 0.0 {
        return vec![1.0; 3];
    }
    let refraction = square.sqrt();
    let s = (incidence - n * refraction) / (incidence + n * refraction);
    let p = (n * incidence - refraction) / (n * incidence + refraction);
    vec![(s * s + p * p) / 2.0; 3]
}
