//! `*.scene.ron` as written: `spec/scenes.md` has it with examples.

use indexmap::IndexMap;
use serde::Deserialize;
use shadewright_compiler::manifest::Value;

use super::{Choice, Choices};
use crate::mesh::Shape;

/// A scene's declaration. Lengths are in metres, angles in degrees, light in photometric units.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// From where it is seen; the first camera of the first glTF file where nothing is said.
    #[serde(default)]
    pub camera: Option<CameraDecl>,
    /// Width and height of the picture in pixels.
    #[serde(default = "size")]
    pub size: [u32; 2],
    /// Radiance where nothing is drawn, cd/m2 per channel.
    #[serde(default)]
    pub background: [f32; 3],
    /// The pass that draws the objects: root of their recipes.
    pub pass: Choice,
    /// The pass that makes the display image from the HDR frame. None: only the HDR frame is made.
    #[serde(default)]
    pub display: Option<Choice>,
    /// What happens to the frame before it is displayed, in order; fills the display pass's slot for this.
    #[serde(default)]
    pub post: Option<Vec<Choice>>,
    /// Triangles by name.
    #[serde(default)]
    pub meshes: IndexMap<String, Shape>,
    /// What fills the pass's slots, by name: `{"copper": {"material": (...), "brdf": "microfacet"}}`.
    #[serde(default)]
    pub materials: IndexMap<String, IndexMap<String, Choices>>,
    /// Sources of light.
    #[serde(default)]
    pub lights: Vec<LightDecl>,
    /// What is drawn.
    #[serde(default)]
    pub objects: Vec<ObjectDecl>,
    /// Whole glTF files: objects, materials, lights.
    #[serde(default)]
    pub gltf: Vec<GltfDecl>,
}

fn size() -> [u32; 2] {
    [960, 540]
}

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraDecl {
    /// Where it is, m.
    pub eye: [f32; 3],
    /// Where it looks, m.
    pub target: [f32; 3],
    /// What is up in the picture.
    #[serde(default = "up")]
    pub up: [f32; 3],
    /// Vertical field of view, degrees.
    #[serde(default = "fov")]
    pub fov: f32,
    /// Nearest distance that is drawn, m.
    #[serde(default = "near")]
    pub near: f32,
    /// Farthest distance that is drawn, m.
    #[serde(default = "far")]
    pub far: f32,
}

fn up() -> [f32; 3] {
    [0.0, 1.0, 0.0]
}
fn fov() -> f32 {
    40.0
}
fn near() -> f32 {
    0.05
}
fn far() -> f32 {
    100.0
}

/// A light.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightDecl {
    /// For people and for `--set`.
    #[serde(default)]
    pub name: Option<String>,
    /// Its kind: a module of the category `light`.
    pub module: String,
    /// What this light's fields are: intensity, position and what else the module declares under `instances`.
    #[serde(default)]
    pub fields: IndexMap<String, Value>,
    /// Modules in the kind's other slots.
    #[serde(default)]
    pub fill: IndexMap<String, Choices>,
    /// Parameters of the kind that become constants.
    #[serde(default)]
    pub freeze: IndexMap<String, Value>,
    /// Parameters of the kind.
    #[serde(default)]
    pub params: IndexMap<String, Value>,
    /// Files of data of the kind by the name of its resource, relative to the scene's folder.
    #[serde(default)]
    pub files: IndexMap<String, String>,
    /// How its shadows are found. None: it casts none.
    #[serde(default)]
    pub visibility: Option<Choice>,
    /// `false` leaves `visibility` out.
    #[serde(default = "yes")]
    pub casts_shadow: bool,
}

/// An object.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectDecl {
    /// For people and for `--set`.
    #[serde(default)]
    pub name: Option<String>,
    /// Name among the scene's meshes.
    pub mesh: String,
    /// Name among the scene's materials.
    pub material: String,
    /// m; after rotation and scale.
    #[serde(default)]
    pub translate: [f32; 3],
    /// Degrees about the x axis, then the y axis, then the z axis of the world.
    #[serde(default)]
    pub rotate: [f32; 3],
    /// Factors along the object's own axes; negative ones mirror.
    #[serde(default = "ones")]
    pub scale: [f32; 3],
    /// Drawn by the camera; an invisible object still casts its shadow.
    #[serde(default = "yes")]
    pub visible: bool,
    /// Drawn after the opaque ones, over what is there by its opacity.
    #[serde(default)]
    pub alpha_blend: bool,
    /// Both sides are drawn.
    #[serde(default)]
    pub double_sided: bool,
    /// Drawn into shadow maps.
    #[serde(default = "yes")]
    pub casts_shadow: bool,
    /// Lit by the scene's lights.
    #[serde(default = "yes")]
    pub receives_light: bool,
}

/// A glTF file that is drawn as it is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GltfDecl {
    /// Path, relative to the scene's folder.
    pub file: String,
    /// As for objects.
    #[serde(default)]
    pub translate: [f32; 3],
    /// As for objects.
    #[serde(default)]
    pub rotate: [f32; 3],
    /// As for objects.
    #[serde(default = "ones")]
    pub scale: [f32; 3],
    /// What fills the pass's other slots, beside that of the material.
    #[serde(default)]
    pub fill: IndexMap<String, Choices>,
    /// Modules that stand for glTF's things (`"gltf:material"`) where several could.
    #[serde(default)]
    pub modules: IndexMap<String, String>,
    /// How shadows are found, by glTF's kind of light (`"gltf:light/point"`). A kind that is not named casts none.
    #[serde(default)]
    pub visibility: IndexMap<String, Choice>,
    /// Whether the file's lights shine.
    #[serde(default = "yes")]
    pub lights: bool,
}

fn yes() -> bool {
    true
}
fn ones() -> [f32; 3] {
    [1.0; 3]
}
