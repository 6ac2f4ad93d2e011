//! Scenes: `*.scene.ron` files, and the smallest recipes that draw them.
//!
//! A scene names modules, fills their slots and sets their parameters. Nothing here knows a module by name: what a module has is asked of
//! its manifest, and slots are found by the category that they take (`light`, `visibility`, `post`).

mod assets;
mod check;
mod choice;
mod derive;
mod files;
mod format;
mod gather;
mod include;
mod layers;
mod path;
mod recipe;
#[cfg(test)]
mod tests;
mod view;

pub use choice::{Choice, Choices, Picture};
pub use derive::{MAX_LIGHTS, MAX_SIZE};
pub use files::{Files, MAX_PICTURE};
pub use format::{CameraDecl, GltfDecl, LightDecl, ObjectDecl, Scene};

use std::path::{Path, PathBuf};
use std::sync::Arc;

use shadewright_compiler::diagnostics::{Diagnostic, SourceFile, codes};
use shadewright_compiler::manifest::{Parsed, parse};
use shadewright_compiler::{Catalog, Report, limits};

use crate::frame::Frame;
use crate::mesh::MeshError;
use crate::mesh::gltf::GltfError;

/// A scene with the text it was read from.
#[derive(Clone, Debug)]
pub struct SceneFile {
    parsed: Parsed<Scene>,
    folder: PathBuf,
    files: Files,
}

impl SceneFile {
    /// Reads a `*.scene.ron` file.
    ///
    /// # Errors
    /// The file cannot be read, is no RON, or no scene.
    pub fn read(path: &Path) -> Result<Self, Report> {
        let name = path.display().to_string();
        let unreadable = |why: String| Report::from(Diagnostic::new(codes::UNREADABLE_FILE, format!("cannot read `{name}`: {why}")));
        let size = std::fs::metadata(path).map_err(|e| unreadable(e.to_string()))?.len();
        if size > limits::FILE_SIZE as u64 {
            return Err(
                Diagnostic::new(codes::FILE_TOO_LARGE, format!("`{name}` is too large: {size} bytes"))
                    .note(format!("at most {} bytes are read", limits::FILE_SIZE))
                    .into(),
            );
        }
        let text = std::fs::read_to_string(path).map_err(|e| unreadable(e.to_string()))?;
        Self::parse(&name, &text, path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a scene from its text. `name` is what errors call it; files that it names are relative to `folder`, on disk unless
    /// [`SceneFile::with_files`] says otherwise.
    ///
    /// # Errors
    /// The text is no RON, or no scene.
    pub fn parse(name: &str, text: &str, folder: &Path) -> Result<Self, Report> {
        Ok(Self {
            parsed: parse(name, text)?,
            folder: folder.to_owned(),
            files: Files::default(),
        })
    }

    /// The scene with its files taken from there. Scenes that are given the same share what is made of them: see [`Files`].
    #[must_use]
    pub fn with_files(mut self, files: Files) -> Self {
        self.files = files;
        self
    }

    /// Where its files come from.
    pub fn files(&self) -> &Files {
        &self.files
    }

    /// What is declared.
    pub fn scene(&self) -> &Scene {
        &self.parsed.value
    }

    /// The text that it was read from.
    pub fn source(&self) -> &Arc<SourceFile> {
        &self.parsed.file
    }

    /// The folder that files are named from.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What stands at a path, as it is written; `None` where nothing does.
    pub fn get(&self, path: &str) -> Option<&str> {
        let text = &self.parsed.file.text;
        text.get(path::find(text, path)?)
    }

    /// Where in the file a value begins: `first.scene.ron:12:5`. `None` where the text does not say it.
    pub fn place(&self, path: &str) -> Option<String> {
        let file = &self.parsed.file;
        Some(file.place(path::find(&file.text, path)?.start))
    }

    /// The scene without the field, entry or element at a path.
    ///
    /// # Errors
    /// Nothing stands there, or what is left is no scene.
    pub fn unset(&self, path: &str) -> Result<Self, Report> {
        let file = &self.parsed.file;
        let text = path::unset(&file.name, &file.text, path)?;
        Ok(Self::parse(&file.name, &text, &self.folder)?.with_files(self.files.clone()))
    }

    /// The scene with one value changed: `lights[0].fields.intensity`, `objects[pot].translate`, `post[0].fill.exposure.params.ev100`.
    /// The value is RON; a text that is none is taken as a string (`900 lm`). A field or an entry of a map that is not there is added.
    ///
    /// # Errors
    /// The path leads nowhere, or what comes out is no scene.
    pub fn set(&self, path: &str, value: &str) -> Result<Self, Report> {
        let file = &self.parsed.file;
        let text = path::set(&file.name, &file.text, path, value)?;
        Ok(Self::parse(&file.name, &text, &self.folder)?.with_files(self.files.clone()))
    }

    /// What a renderer draws: camera, objects, lights, and the recipes that are derived from them. `size` (width, height) is instead of
    /// the scene's own. Files that the scene names are read, unless they are known from an earlier frame: see [`Files`].
    ///
    /// # Errors
    /// All that the scene says of modules, names, numbers and files that cannot be, located in its text.
    pub fn frame(&self, catalog: &Catalog, size: Option<[u32; 2]>) -> Result<Frame, Report> {
        derive::derive(self, catalog, size)
    }
}

fn code_of_gltf(error: &GltfError) -> &'static str {
    match error {
        GltfError::Unsupported { .. } => codes::ASSET_UNSUPPORTED,
        GltfError::Unreadable { .. } | GltfError::Damaged { .. } => codes::ASSET_UNREADABLE,
    }
}

fn code_of(error: &MeshError) -> &'static str {
    match error {
        MeshError::Gltf(error) => code_of_gltf(error),
        MeshError::NoSuchMesh(_) => codes::UNKNOWN_SCENE_NAME,
        MeshError::Length { .. } | MeshError::Segments { .. } | MeshError::Inconsistent(_) => codes::SCENE_INVALID,
    }
}
