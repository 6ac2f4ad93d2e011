//! Fuzz over the module that its slot has where nothing is chosen.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use crate::oracles::reflection::{Surface, microfacet};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Zeltner, Burley and Chiang 2022, with the density of the transformed cosine as in Heitz et al. 2016, eq. 1.
fn brdf(at: &At) -> Vec<f64> {
    let (v, l, normal) = (at.vector("v"), at.vector("l"), at.vector("s.normal"));
    let (diffuse, f0, color) = (at.vector("s.diffuse"), at.vector("s.f0"), at.vector("s.fuzz_color"));
    let roughness = at.number("s.fuzz_roughness").clamp(0.01, 1.0);
    let (n_dot_v, n_dot_l) = (normal.dot(v), normal.dot(l));
    let caught = at.number("s.fuzz") * albedo(n_dot_v.max(0.0), roughness);
    let lobe = if n_dot_v > 0.0 && n_dot_l > 0.0 {
        density(normal, v, l, roughness) / n_dot_l
    } else {
        0.0
    };
    let channel = |i: usize| {
        let below = Surface {
            normal,
            diffuse: diffuse[i],
            f0: f0[i],
            alpha: at.number("s.alpha"),
        };
        microfacet(&below, v, l) * (1.0 - caught) + color[i] * caught * lobe
    };
    (0..3).map(channel).collect()
}

/// Hill's fit of the table of albedos: a Gaussian of the cosine over a floor.
fn albedo(x: f64, y: f64) -> f64 {
    let sigma = y * (0.0206607 + 1.58491 * y) / (0.0379424 + 1.32227 * y + y.powi(2));
    let mean = y * (-0.193854 - 1.14885 * y + 1.7932 * y.powi(2) - 0.95943 * y.powi(4)) / (0.046391 + y);
    let floor = y * (0.000654023 - 0.0207818 * y + 0.119681 * y.powi(2)) / (1.26264 - 1.92021 * y + y.powi(2));
    let gauss = (-(x - mean).powi(2) / (2.0 * sigma.powi(2))).exp() / (sigma * (2.0 * PI).sqrt());
    (gauss + floor).clamp(0.0, 1.0)
}

/// Density over solid angle of the direction l: the cosine's at M l, by the change of solid angle |M| / |M l|^3, with Hill's fits of M.
fn density(normal: DVec3, v: DVec3, l: DVec3, y: f64) -> f64 {
    let x = normal.dot(v).clamp(0.0, 1.0);
    let a = y * (2.58126 * x + 0.813703 * y) / (1.0 + 0.310327 * x * x + 2.60994 * x * y);
    let b = (1.0 - x).sqrt() * (y - 1.0) * y.powi(3) / (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
    // Along the normal there is no direction to lean to; M is round there.
    let across = normal.cross(v - normal).try_normalize().unwrap_or(normal.any_orthonormal_vector());
    let toward = across.cross(normal).normalize();
    let frame = DMat3::from_cols(toward, normal.cross(toward), normal);
    let matrix = DMat3::from_cols(DVec3::new(a, 0.0, 0.0), DVec3::new(0.0, a, 0.0), DVec3::new(b, 0.0, 1.0));
    let moved = matrix * (frame.transpose() * l);
    moved.normalize().z.max(0.0) / PI * matrix.determinant() / moved.length().powi(3)
}
