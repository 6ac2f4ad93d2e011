//! Oren and Nayar's qualitative model, in angles.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("diffuse", diffuse)];

/// Oren and Nayar 1994, section 4.4; sigma is the angle whose tangent is the root mean square slope of facets whose width is the square of the roughness.
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
    let (larger, smaller) = (theta_v.max(theta_l), theta_v.min(theta_l));
    // The angle between the planes of n and v, and of n and l; any where one of them is none.
    let phi = angle(n.cross(v), n.cross(l));
    let sigma2 = (at.number("s.diffuse_roughness").powi(2) / 2f64.sqrt()).atan().powi(2);
    let a = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
    let b = 0.45 * sigma2 / (sigma2 + 0.09);
    // The module stops a millionth of a radian above the horizon.
    let smaller = smaller.min(FRAC_PI_2 - 1e-6);
    let factor = a + b * phi.cos().max(0.0) * larger.sin() * smaller.tan();
    at.vector("s.diffuse").to_array().map(|albedo| albedo / PI * factor).to_vec()
}
