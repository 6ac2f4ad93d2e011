//! Files that a scene names, each read once.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::data::{DecodeError, read};
use crate::frame::Texture;
use crate::image::decode_texture;
use crate::mesh::gltf::{self, Asset, GltfError};

/// Largest picture file, bytes.
pub const MAX_PICTURE: u64 = 256 << 20;

/// What was read so far.
#[derive(Default)]
pub(super) struct Assets {
    folder: PathBuf,
    textures: HashMap<String, Arc<Texture>>,
    data: HashMap<(String, String), Arc<[f32]>>,
    gltf: HashMap<String, Arc<Asset>>,
}

impl Assets {
    /// Files relative to this folder.
    pub(super) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
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
        let path = self.folder.join(file);
        let size = std::fs::metadata(&path).map_err(|e| e.to_string())?.len();
        if size > MAX_PICTURE {
            return Err(format!("{size} bytes, more than the limit of {MAX_PICTURE}"));
        }
        let bytes = std::fs::read(&path).map_err(|e| e.to_string())?;
        let texture = Arc::new(decode_texture(&bytes).map_err(|e| e.to_string())?);
        self.textures.insert(file.to_owned(), Arc::clone(&texture));
        Ok(texture)
    }

    /// Numbers in a file of this format.
    ///
    /// # Errors
    /// As for [`read`].
    pub(super) fn data(&mut self, file: &str, format: &str) -> Result<Arc<[f32]>, DecodeError> {
        let key = (file.to_owned(), format.to_owned());
        if let Some(known) = self.data.get(&key) {
            return Ok(Arc::clone(known));
        }
        let numbers: Arc<[f32]> = read(&self.folder.join(file), format)?.into();
        self.data.insert(key, Arc::clone(&numbers));
        Ok(numbers)
    }

    /// A glTF file.
    ///
    /// # Errors
    /// As for [`gltf::load`].
    pub(super) fn gltf(&mut self, file: &str) -> Result<Arc<Asset>, GltfError> {
        if let Some(known) = self.gltf.get(file) {
            return Ok(Arc::clone(known));
        }
        let asset = Arc::new(gltf::load(&self.folder.join(file))?);
        self.gltf.insert(file.to_owned(), Arc::clone(&asset));
        Ok(asset)
    }
}
