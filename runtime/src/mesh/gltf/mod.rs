//! glTF 2.0 files (Khronos 2021): `.gltf` with its buffers and pictures beside it or in data URIs, and `.glb`.
//!
//! What is read is neutral: factors and textures under the names that glTF gives them, lights by kind. Which modules stand for them is
//! said by the modules' manifests and decided by the scene. What changes the picture and is not taken is an error that names it.

mod accessor;
mod document;
mod extensions;
mod files;
mod geometry;
#[cfg(test)]
pub(crate) mod tests;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Mat4;
use indexmap::IndexMap;
use shadewright_compiler::manifest::Value;

use super::MeshError;
use crate::data::read_bytes;
use crate::frame::{Mesh, Texture};

/// Largest file that is read, bytes.
pub const MAX_FILE: u64 = 1 << 30;
/// Most nodes of a file's scene.
pub const MAX_NODES: usize = 1 << 16;

/// A file's default scene, flattened.
#[derive(Clone, Debug, Default)]
pub struct Asset {
    /// Drawn things in the order of the nodes.
    pub objects: Vec<Object>,
    /// Materials, by the file's numbers; the last one is glTF's default material, if anything uses it.
    pub materials: Vec<Material>,
    /// Cameras, in the order of the nodes.
    pub cameras: Vec<Camera>,
    /// Lights, in the order of the nodes.
    pub lights: Vec<Light>,
}

/// A mesh primitive at a node.
#[derive(Clone, Debug)]
pub struct Object {
    /// Name of the node or of the mesh, else `node 3`.
    pub name: String,
    /// Name of the mesh, where it has one.
    pub mesh_name: Option<String>,
    /// Shared by all nodes that show it.
    pub mesh: Arc<Mesh>,
    /// Index into [`Asset::materials`].
    pub material: usize,
    /// Object space to world space.
    pub model: Mat4,
}

/// A material in glTF's own words.
#[derive(Clone, Debug, Default)]
pub struct Material {
    /// Its name, else `material 3`.
    pub name: String,
    /// By glTF's name of the factor (`gltf:baseColorFactor`, its alpha under `gltf:baseColorFactor.a`); `gltf:emissiveStrength` is
    /// in cd/m2 and 1 where the file says nothing.
    pub factors: IndexMap<&'static str, Value>,
    /// By glTF's name (`gltf:baseColorTexture`).
    pub maps: IndexMap<&'static str, Map>,
    /// Extensions with effect that are more than numbers, by name (`gltf:KHR_materials_sheen`): what lies above after what lies below.
    pub layers: Vec<&'static str>,
    /// Both sides are drawn.
    pub double_sided: bool,
    /// What alpha means.
    pub alpha: Alpha,
}

/// A texture of a material.
#[derive(Clone, Debug)]
pub struct Map {
    /// The picture.
    pub texture: Arc<Texture>,
    /// What is said of this use of it: `gltf:normalScale` of normal maps, `gltf:occlusionStrength`.
    pub factors: IndexMap<&'static str, Value>,
}

/// What a material's alpha means.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Alpha {
    /// Nothing.
    #[default]
    Opaque,
    /// Below this value there is a hole.
    Mask(f32),
    /// Coverage.
    Blend,
}

/// A camera at a node.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Name of the camera or of the node, else `camera 3`.
    pub name: String,
    /// Camera space (looking along -z, y up) to world space.
    pub world: Mat4,
    /// `None` for an orthographic camera, which scenes do not take.
    pub perspective: Option<Perspective>,
}

/// A perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    /// Vertical field of view, radians.
    pub fov: f32,
    /// m
    pub near: f32,
    /// m; `None` reaches to infinity.
    pub far: Option<f32>,
}

/// A light of `KHR_lights_punctual` at a node.
#[derive(Clone, Debug)]
pub struct Light {
    /// Name of the light or of the node, else `light 3`.
    pub name: String,
    /// What modules say they represent: `gltf:light/point`, `gltf:light/directional`, `gltf:light/spot`.
    pub kind: &'static str,
    /// By role: `position` (m), `direction` (of the light's travel), `range` (m), `gltf:color` (linear), `gltf:intensity` with its unit
    /// (`"5 cd"`, `"9 lx"`), and for spots `gltf:innerConeAngle` and, of the outer cone, `half_angle` (radians).
    pub fields: IndexMap<&'static str, Value>,
}

/// Why a file cannot be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GltfError {
    /// A file is not there, cannot be read, or is too large.
    #[error("cannot read {}: {why}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        why: String,
    },
    /// The file is damaged or breaks the specification.
    #[error("{place}: {why}")]
    Damaged {
        /// Where, in the specification's words: `accessors[3]`.
        place: String,
        /// What is wrong.
        why: String,
    },
    /// The file is right, but uses something that is not taken.
    #[error("{place}: {thing} cannot be drawn")]
    Unsupported {
        /// Where.
        place: String,
        /// What.
        thing: String,
    },
}

impl Asset {
    /// All triangles as they stand in the scene, in one mesh; only of meshes of this name, if one is given.
    ///
    /// # Errors
    /// There is none, or there are too many vertices.
    pub fn joined(&self, name: Option<&str>) -> Result<Mesh, MeshError> {
        let mut whole = Mesh::default();
        for object in &self.objects {
            if name.is_none_or(|name| object.mesh_name.as_deref() == Some(name)) {
                whole.append(&object.mesh.transformed(&object.model))?;
            }
        }
        if let (Some(name), true) = (name, whole.positions.is_empty()) {
            return Err(MeshError::NoSuchMesh(name.to_owned()));
        }
        Ok(whole)
    }
}

/// Gives the bytes of a file, or says why it cannot.
pub type Read<'r> = dyn FnMut(&Path) -> Result<Vec<u8>, String> + 'r;

/// Reads a file and what it refers to from disk.
///
/// # Errors
/// A file cannot be read, is damaged, or uses something that is not taken.
pub fn load(path: &Path) -> Result<Asset, GltfError> {
    load_with(path, &mut on_disk)
}

/// Reads a file and what it refers to, wherever they are: `by` is asked for each by its path, which begins as `path` does.
///
/// # Errors
/// As for [`load`].
pub fn load_with(path: &Path, by: &mut Read) -> Result<Asset, GltfError> {
    let bytes = files::read(path, by)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    document::read(&bytes, folder, by)
}

/// Reads a file from memory; relative references start at `folder`, on disk.
///
/// # Errors
/// As for [`load`].
pub fn parse(bytes: &[u8], folder: &Path) -> Result<Asset, GltfError> {
    document::read(bytes, folder, &mut on_disk)
}

fn on_disk(path: &Path) -> Result<Vec<u8>, String> {
    read_bytes(path, MAX_FILE)
}

fn damaged(place: impl Into<String>, why: impl ToString) -> GltfError {
    GltfError::Damaged {
        place: place.into(),
        why: why.to_string(),
    }
}

fn unsupported(place: impl Into<String>, thing: impl Into<String>) -> GltfError {
    GltfError::Unsupported {
        place: place.into(),
        thing: thing.into(),
    }
}
