//! What a frame takes from the files that its scene names: each is one and the same wherever the scene names it.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Files;
use crate::data::DecodeError;
use crate::frame::{Mesh, Texture};
use crate::mesh::gltf::{Asset, GltfError};
use crate::mesh::{MeshError, Shape};

/// What was taken so far.
#[derive(Default)]
pub(super) struct Assets {
    folder: PathBuf,
    files: Files,
    textures: HashMap<String, Arc<Texture>>,
    data: HashMap<(String, String), Arc<[f32]>>,
    gltf: HashMap<String, Arc<Asset>>,
}

impl Assets {
    /// Files relative to this folder. A frame begins.
    pub(super) fn new(folder: &Path, files: &Files) -> Self {
        files.begin();
        Self {
            folder: folder.to_owned(),
            files: files.clone(),
            ..Self::default()
        }
    }

    /// A picture.
    ///
    /// # Errors
    /// Says why the file cannot be read.
    pub(super) fn texture(&mut self, file: &str) -> Result<Arc<Texture>, String> {
        if let Some(known) = self.textures.get(file) {
            return Ok(Arc::clone(known));
        }
        let texture = self.files.texture(&self.folder.join(file))?;
        self.textures.insert(file.to_owned(), Arc::clone(&texture));
        Ok(texture)
    }

    /// Numbers in a file of this format.
    ///
    /// # Errors
    /// There is no such format, or the file cannot be read or is not of it.
    pub(super) fn data(&mut self, file: &str, format: &str) -> Result<Arc<[f32]>, DecodeError> {
        let key = (file.to_owned(), format.to_owned());
        if let Some(known) = self.data.get(&key) {
            return Ok(Arc::clone(known));
        }
        let numbers = self.files.data(&self.folder.join(file), format)?;
        self.data.insert(key, Arc::clone(&numbers));
        Ok(numbers)
    }

    /// A glTF file.
    ///
    /// # Errors
    /// As for [`gltf::load`](crate::mesh::gltf::load).
    pub(super) fn gltf(&mut self, file: &str) -> Result<Arc<Asset>, GltfError> {
        if let Some(known) = self.gltf.get(file) {
            return Ok(Arc::clone(known));
        }
        let asset = self.files.gltf(&self.folder.join(file))?;
        self.gltf.insert(file.to_owned(), Arc::clone(&asset));
        Ok(asset)
    }

    /// The mesh of a shape. Equal shapes have one.
    ///
    /// # Errors
    /// As for [`Shape::build`].
    pub(super) fn mesh(&mut self, shape: &Shape) -> Result<Arc<Mesh>, MeshError> {
        let asset = match shape {
            Shape::Gltf { file, .. } => Some(self.gltf(file)?),
            _ => None,
        };
        let files = self.files.clone();
        files.mesh(shape, asset, |file| self.gltf(file))
    }

    /// The mesh for a model matrix that mirrors.
    pub(super) fn mirrored(&self, mesh: &Arc<Mesh>) -> Arc<Mesh> {
        self.files.mirrored(mesh)
    }
}
