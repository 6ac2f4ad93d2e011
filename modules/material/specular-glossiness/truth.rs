//! The specular workflow's parameters as albedo, reflectance and width of the lobe.

use glam::DVec2;

use crate::oracles::appearance::{Appearance, alpha};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("surface", surface)];

/// Khronos Group 2017, KHR_materials_pbrSpecularGlossiness, without maps.
fn surface(at: &At) -> Vec<f64> {
    let (specular, roughness) = (at.param_vector("specular"), 1.0 - at.param("glossiness"));
    Appearance {
        diffuse: at.param_vector("diffuse") * (1.0 - specular.max_element()),
        diffuse_roughness: roughness,
        f0: specular,
        alpha: alpha(roughness),
        widths: DVec2::splat(alpha(roughness)),
        emission: at.param_vector("emission_color") * at.param("emission"),
        opacity: at.param("opacity"),
        ..Appearance::bare(at)
    }
    .numbers()
}
