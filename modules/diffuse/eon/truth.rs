//! Energy-preserving Oren-Nayar reflection.

use std::f64::consts::PI;

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("diffuse", diffuse)];

/// Albedo of Fujii's model for a white surface, by the angle to the normal. Portsmouth, Kutz and Hill 2025, section 2.
fn albedo_once(r: f64, theta: f64) -> f64 {
    let a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
    let (sin, cos, tan) = (theta.sin(), theta.cos(), theta.tan());
    let g = sin * (theta - sin * cos) + 2.0 / 3.0 * tan * (1.0 - sin.powi(3)) - 2.0 / 3.0 * sin;
    a + r * a / PI * g
}

/// Portsmouth, Kutz and Hill 2025, listing 1, in angles.
fn diffuse(at: &At) -> Vec<f64> {
    let Some(Lit {
        normal: n,
        v,
        l,
        theta_v,
        theta_l,
        ..
    }) = lit(at)
    else {
        return vec![0.0; 3];
    };
    let r = at.number("s.diffuse_roughness");
    let a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
    let s = theta_v.sin() * theta_l.sin() * angle(n.cross(v), n.cross(l)).cos();
    // The module stops a millionth of a radian above the horizon.
    let t = if s > 0.0 { theta_v.min(theta_l).cos().max(1e-6) } else { 1.0 };
    let once = a * (1.0 + r * s / t);
    let mean = a * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * r);
    // A smooth surface loses nothing.
    let many = if r > 0.0 {
        (1.0 - albedo_once(r, theta_v)) * (1.0 - albedo_once(r, theta_l)) / (1.0 - mean)
    } else {
        0.0
    };
    let channel = |rho: f64| rho / PI * once + rho * rho * mean / (1.0 - rho * (1.0 - mean)) / PI * many;
    at.vector("s.diffuse").to_array().map(channel).to_vec()
}
