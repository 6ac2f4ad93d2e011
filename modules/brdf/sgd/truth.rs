//! The shifted gamma model, in angles as in the paper.

use std::f64::consts::PI;

use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Bagher et al. 2012, with the Fresnel term kept from below 0 and G1 within [0, 1].
fn brdf(at: &At) -> Vec<f64> {
    let (normal, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    if normal.dot(v) <= 0.0 || normal.dot(l) <= 0.0 {
        return vec![0.0; 3];
    }
    let (theta_v, theta_l, theta_h) = (angle(normal, v), angle(normal, l), angle(normal, v + l));
    let cosine = (angle(v, l) / 2.0).cos();
    let channel = |i: usize| {
        let param = |name: &str| at.param_vector(name)[i];
        let x = param("alpha") + theta_h.tan().powi(2) / param("alpha");
        let d = param("kappa") * (-x).exp() / (PI * x.powf(param("p")) * theta_h.cos().powi(4));
        let f = param("f0") - param("f1") * cosine + (1.0 - param("f0")) * (1.0 - cosine).powi(5);
        let g1 = |theta: f64| {
            // Where the power is beyond all numbers, a strength of 0 is still none.
            let grown = (param("c") * (theta - param("theta_0")).max(0.0).powf(param("k"))).min(700.0).exp();
            (1.0 + param("lambda") * (1.0 - grown)).clamp(0.0, 1.0)
        };
        let specular = f.max(0.0) * d * g1(theta_v) * g1(theta_l) / (theta_v.cos() * theta_l.cos());
        (param("rho_d") + param("rho_s") * specular) / PI
    };
    (0..3).map(channel).collect()
}
