//! glTF's parameters as albedo, reflectance and width of the lobe.

use glam::{DVec2, DVec3};

use crate::oracles::appearance::{Appearance, alpha};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("surface", surface)];

/// Khronos Group 2021, glTF 2.0, appendix B.2, without maps.
fn surface(at: &At) -> Vec<f64> {
    let (base, metalness, roughness) = (at.param_vector("base_color"), at.param("metalness"), at.param("roughness"));
    Appearance {
        diffuse: base * (1.0 - metalness),
        diffuse_roughness: roughness,
        f0: base * metalness + DVec3::splat(at.param("reflectance") * (1.0 - metalness)),
        alpha: alpha(roughness),
        widths: DVec2::splat(alpha(roughness)),
        emission: at.param_vector("emission_color") * at.param("emission"),
        opacity: at.param("opacity"),
        ..Appearance::bare(at)
    }
    .numbers()
}
