//! The parameters of glTF and of its extensions as albedo, reflectances, widths and layers.

use glam::{DQuat, DVec2, DVec3};

use crate::oracles::appearance::{Appearance, alpha, normal_reflectance};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("surface", surface)];

/// Khronos Group 2021, glTF 2.0, appendix B.2, and the implementation sections of the extensions, without maps.
fn surface(at: &At) -> Vec<f64> {
    let bare = Appearance::bare(at);
    let (base, metalness, roughness) = (at.param_vector("base_color"), at.param("metalness"), at.param("roughness"));
    let specular = at.param("specular");
    // KHR_materials_ior, KHR_materials_specular.
    let f0 = (normal_reflectance(at.param("ior")) * at.param_vector("specular_color")).min(DVec3::ONE) * specular;
    // KHR_materials_anisotropy.
    let (strength, narrow) = (at.param("anisotropy"), alpha(roughness));
    let turn = DQuat::from_axis_angle(bare.normal, at.param("anisotropy_rotation"));
    // KHR_materials_sheen: the weight is the largest channel.
    let fuzz = at.param_vector("fuzz_color");
    let weight = fuzz.max_element();
    Appearance {
        diffuse: base * (1.0 - metalness),
        diffuse_roughness: roughness,
        f0: f0.lerp(base, metalness),
        f90: DVec3::splat(specular * (1.0 - metalness) + metalness),
        alpha: narrow,
        tangent: turn * bare.tangent,
        widths: DVec2::new(narrow + (1.0 - narrow) * strength.powi(2), narrow),
        emission: at.param_vector("emission_color") * at.param("emission"),
        opacity: at.param("opacity"),
        coat: at.param("coat"),
        coat_alpha: alpha(at.param("coat_roughness")),
        fuzz: weight,
        fuzz_color: if weight > 0.0 { fuzz / weight } else { DVec3::ZERO },
        fuzz_roughness: at.param("fuzz_roughness"),
        ..bare
    }
    .numbers()
}
