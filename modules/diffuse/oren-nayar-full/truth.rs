//! Oren and Nayar's full model, in angles.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::oracles::lobes::{Lit, lit};
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("diffuse", diffuse)];

/// Oren and Nayar 1994, section 4.3; sigma is the angle whose tangent is the root mean square slope of facets whose width is the square of the roughness.
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
    // The module stops a millionth of a radian above the horizon.
    let limit = FRAC_PI_2 - 1e-6;
    let (alpha, beta) = (theta_v.max(theta_l).min(limit), theta_v.min(theta_l).min(limit));
    // The angle between the planes of n and v, and of n and l; any where one of them is none.
    let cos_phi = angle(n.cross(v), n.cross(l)).cos();
    let sigma2 = (at.number("s.diffuse_roughness").powi(2) / 2f64.sqrt()).atan().powi(2);

    let c1 = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
    let lessened = if cos_phi >= 0.0 { 0.0 } else { (2.0 * beta / PI).powi(3) };
    let c2 = 0.45 * sigma2 / (sigma2 + 0.09) * (alpha.sin() - lessened);
    let c3 = 0.125 * sigma2 / (sigma2 + 0.09) * (4.0 * alpha * beta / (PI * PI)).powi(2);
    let l1 = c1 + cos_phi * c2 * beta.tan() + (1.0 - cos_phi.abs()) * c3 * ((alpha + beta) / 2.0).tan();
    let l2 = 0.17 * sigma2 / (sigma2 + 0.13) * (1.0 - cos_phi * (2.0 * beta / PI).powi(2));
    let albedo = at.vector("s.diffuse").to_array();
    albedo.map(|albedo| albedo / PI * l1 + albedo * albedo / PI * l2).to_vec()
}
