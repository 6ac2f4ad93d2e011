//! What glTF's extensions of materials say, in their own words. What an extension says without effect (a coat of factor 0) is as if it were
//! not there.

use gltf::Material;
use indexmap::IndexMap;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use shadewright_compiler::manifest::Value;

use super::{GltfError, damaged};

/// Extensions of materials that are read here.
pub(super) const READ: [&str; 5] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
];

/// A texture that an extension names.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Use {
    pub index: usize,
    #[serde(default)]
    pub tex_coord: u32,
    /// Of normal maps only.
    #[serde(default)]
    pub scale: Option<f32>,
}

/// What the extensions add to a material.
#[derive(Default)]
pub(super) struct Extra {
    pub factors: IndexMap<&'static str, Value>,
    pub textures: Vec<(&'static str, Use)>,
    /// `gltf:KHR_materials_sheen` and so on, what lies above after what lies below.
    pub layers: Vec<&'static str>,
}

impl Extra {
    fn number(&mut self, name: &'static str, value: f32) {
        self.factors.insert(name, Value::Number(value.into()));
    }

    fn color(&mut self, name: &'static str, value: [f32; 3]) {
        self.factors.insert(name, Value::List(value.map(f64::from).to_vec()));
    }

    fn texture(&mut self, name: &'static str, used: Option<Use>) {
        self.textures.extend(used.map(|used| (name, used)));
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Specular {
    specular_factor: f32,
    specular_texture: Option<Use>,
    specular_color_factor: [f32; 3],
    specular_color_texture: Option<Use>,
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            specular_factor: 1.0,
            specular_texture: None,
            specular_color_factor: [1.0; 3],
            specular_color_texture: None,
        }
    }
}

#[derive(Deserialize)]
struct Ior {
    #[serde(default = "glass")]
    ior: f32,
}

fn glass() -> f32 {
    1.5
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Anisotropy {
    anisotropy_strength: f32,
    anisotropy_rotation: f32,
    anisotropy_texture: Option<Use>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Sheen {
    sheen_color_factor: [f32; 3],
    sheen_color_texture: Option<Use>,
    sheen_roughness_factor: f32,
    sheen_roughness_texture: Option<Use>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Clearcoat {
    clearcoat_factor: f32,
    clearcoat_texture: Option<Use>,
    clearcoat_roughness_factor: f32,
    clearcoat_roughness_texture: Option<Use>,
    clearcoat_normal_texture: Option<Use>,
}

fn extension<T: DeserializeOwned>(material: &Material, name: &str, place: &str) -> Result<Option<T>, GltfError> {
    let value = material.extension_value(name);
    value
        .map(|value| T::deserialize(value).map_err(|e| damaged(format!("{place}.extensions.{name}"), e)))
        .transpose()
}

/// Reads the extensions of a material.
///
/// # Errors
/// One is not what its specification says.
pub(super) fn read(material: &Material, place: &str) -> Result<Extra, GltfError> {
    let mut extra = Extra::default();
    if let Some(Ior { ior }) = extension(material, "KHR_materials_ior", place)?
        && ior != 1.5
    {
        extra.number("gltf:ior", ior);
    }
    if let Some(Specular {
        specular_factor,
        specular_texture,
        specular_color_factor,
        specular_color_texture,
    }) = extension(material, "KHR_materials_specular", place)?
        && (specular_factor != 1.0 || specular_color_factor != [1.0; 3] || specular_texture.is_some() || specular_color_texture.is_some())
    {
        extra.number("gltf:specularFactor", specular_factor);
        extra.color("gltf:specularColorFactor", specular_color_factor);
        extra.texture("gltf:specularTexture", specular_texture);
        extra.texture("gltf:specularColorTexture", specular_color_texture);
        extra.layers.push("gltf:KHR_materials_specular");
    }
    if let Some(anisotropy) = extension::<Anisotropy>(material, "KHR_materials_anisotropy", place)?
        && anisotropy.anisotropy_strength != 0.0
    {
        extra.number("gltf:anisotropyStrength", anisotropy.anisotropy_strength);
        extra.number("gltf:anisotropyRotation", anisotropy.anisotropy_rotation);
        extra.texture("gltf:anisotropyTexture", anisotropy.anisotropy_texture);
        extra.layers.push("gltf:KHR_materials_anisotropy");
    }
    if let Some(sheen) = extension::<Sheen>(material, "KHR_materials_sheen", place)?
        && sheen.sheen_color_factor != [0.0; 3]
    {
        extra.color("gltf:sheenColorFactor", sheen.sheen_color_factor);
        extra.number("gltf:sheenRoughnessFactor", sheen.sheen_roughness_factor);
        extra.texture("gltf:sheenColorTexture", sheen.sheen_color_texture);
        extra.texture("gltf:sheenRoughnessTexture", sheen.sheen_roughness_texture);
        extra.layers.push("gltf:KHR_materials_sheen");
    }
    if let Some(coat) = extension::<Clearcoat>(material, "KHR_materials_clearcoat", place)?
        && coat.clearcoat_factor != 0.0
    {
        extra.number("gltf:clearcoatFactor", coat.clearcoat_factor);
        extra.number("gltf:clearcoatRoughnessFactor", coat.clearcoat_roughness_factor);
        extra.texture("gltf:clearcoatTexture", coat.clearcoat_texture);
        extra.texture("gltf:clearcoatRoughnessTexture", coat.clearcoat_roughness_texture);
        extra.texture("gltf:clearcoatNormalTexture", coat.clearcoat_normal_texture);
        extra.layers.push("gltf:KHR_materials_clearcoat");
    }
    Ok(extra)
}
