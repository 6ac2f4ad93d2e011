//! OpenPBR's parameters as albedo, reflectances, widths and layers.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use crate::oracles::appearance::{Appearance, alpha, normal_reflectance, smallest_alpha};
use crate::oracles::quadrature::nodes;
use crate::oracles::reflection::fresnel_dielectric;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("surface", surface)];

/// Academy Software Foundation 2024, OpenPBR Surface 1.1, the sections Base, Coat and Fuzz, without maps; the reflectance at the horizon is that of
/// Lagarde and de Rousiers 2014.
fn surface(at: &At) -> Vec<f64> {
    let color = at.param_vector("base_color") * at.param("base_weight");
    let (metalness, specular) = (at.param("base_metalness"), at.param("specular_weight"));
    let (coat, coat_roughness) = (at.param("coat_weight"), at.param("coat_roughness"));
    let above = 1.0 + (at.param("coat_ior") - 1.0) * coat;
    let reflectance = (specular * normal_reflectance(at.param("specular_ior") / above)).min(1.0);
    let metal = specular.min(1.0);
    // The coat's facets widen the lobe below: variances add, of a way in and a way out.
    let bare = at.param("specular_roughness");
    let widened = (bare.powi(4) + 2.0 * coat_roughness.powi(4)).min(1.0).powf(0.25);
    let roughness = bare + (widened - bare) * coat;
    // Of widths with the ratio q whose squares have the mean alpha^2.
    let q = 1.0 - at.param("specular_roughness_anisotropy");
    let along = (2.0 * roughness.powi(4) / (1.0 + q * q)).sqrt();
    let tint = at.param_vector("specular_color");
    // Saunderson 1942: of what is scattered below the coat a share K is reflected back down, so that 1 - K of each pass leaves.
    let inner = inner_reflectance(at.param("coat_ior"));
    let darkened = (1.0 - inner) / (DVec3::ONE - color * inner);
    Appearance {
        diffuse: color * (1.0 - metalness) * DVec3::ONE.lerp(darkened, coat * at.param("coat_darkening")),
        diffuse_roughness: at.param("base_diffuse_roughness"),
        f0: (tint * reflectance).lerp(color * metal, metalness),
        f90: (tint * (50.0 * reflectance).min(1.0)).lerp(DVec3::splat(metal), metalness),
        f82: DVec3::ONE.lerp(tint, metalness),
        alpha: alpha(roughness),
        widths: DVec2::new(along, q * along).max(DVec2::splat(smallest_alpha())),
        emission: at.param_vector("emission_color") * at.param("emission_luminance"),
        opacity: at.param("geometry_opacity"),
        coat,
        coat_alpha: alpha(coat_roughness),
        coat_ior: at.param("coat_ior"),
        coat_color: at.param_vector("coat_color"),
        fuzz: at.param("fuzz_weight"),
        fuzz_color: at.param_vector("fuzz_color"),
        fuzz_roughness: at.param("fuzz_roughness"),
        ..Appearance::bare(at)
    }
    .numbers()
}

/// Share of light from all sides that a boundary reflects from within: the mean of Fresnel's equations from outside, by the conservation of
/// radiance over the square of the index.
fn inner_reflectance(ior: f64) -> f64 {
    let mean: f64 = nodes(0.0, FRAC_PI_2, 8)
        .iter()
        .map(|&(theta, w)| w * fresnel_dielectric(1.0, ior, theta) * (2.0 * theta).sin())
        .sum();
    1.0 - (1.0 - mean) / (ior * ior)
}
