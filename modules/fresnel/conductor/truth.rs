//! Fresnel's equations with a complex index of refraction.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("fresnel", fresnel)];

type Complex = (f64, f64);

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// The root in the first quadrant, by modulus and argument.
fn root(a: Complex) -> Complex {
    let (modulus, argument) = (a.0.hypot(a.1).sqrt(), a.1.atan2(a.0) / 2.0);
    (modulus * argument.cos(), modulus * argument.sin())
}

/// |a - b|^2 / |a + b|^2; 0 where neither medium differs from the other.
fn reflectance(a: Complex, b: Complex) -> f64 {
    let sum = (a.0 + b.0).hypot(a.1 + b.1);
    if sum == 0.0 {
        0.0
    } else {
        ((a.0 - b.0).hypot(a.1 - b.1) / sum).powi(2)
    }
}

/// Born and Wolf 1999, section 14.2: the dielectric's amplitudes, with n + i k for the index.
fn fresnel(at: &At) -> Vec<f64> {
    let theta = at.number("cosine").clamp(0.0, 1.0).acos();
    let (eta, k) = (at.param_vector("eta"), at.param_vector("k"));
    let channel = |i: usize| {
        let index2 = times((eta[i], k[i]), (eta[i], k[i]));
        // The index times the cosine of the complex angle of refraction.
        let refracted = root((index2.0 - theta.sin().powi(2), index2.1));
        let s = reflectance((theta.cos(), 0.0), refracted);
        let p = reflectance(times(index2, (theta.cos(), 0.0)), refracted);
        (s + p) / 2.0
    };
    (0..3).map(channel).collect()
}
