//! Files that are opened or dropped on the window, each by what it holds.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use glam::Vec3;
use shadewright_compiler::manifest::ResourceKind;
use shadewright_compiler::{Catalog, Module, limits};
use shadewright_runtime::data::{self, FORMATS, PLAIN};
use shadewright_runtime::mesh::gltf;
use shadewright_runtime::scene::{Files, SceneFile};

use crate::App;
use crate::document::{quoted, ron_of, step_path};
use crate::tree::{Row, name_in};
use crate::work::{Bench, Job, News, Step};

/// Looks at a file.
pub struct Look {
    /// The file.
    pub path: PathBuf,
    /// Where it is, and what it names.
    pub files: Files,
}

/// What a file holds.
#[derive(Debug)]
pub enum Found {
    /// A scene, or a model that became one.
    Scene {
        /// It.
        scene: Box<SceneFile>,
        /// The file, where that is the scene's own.
        path: Option<PathBuf>,
    },
    /// A table of a format, or (where there is no format) a picture that is a texture.
    Data {
        /// The file.
        path: PathBuf,
        /// Its format, as modules name it.
        format: Option<String>,
    },
    /// Folder of modules.
    Folder(PathBuf),
}

impl Job for Look {
    fn kind(&self) -> &'static str {
        "open"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        tell(match look(&self.path, &self.files) {
            Ok(found) => News::Found(found),
            Err(why) => News::Failed {
                what: "opening",
                message: format!("{}: {why}", self.path.display()),
            },
        });
        Step::Break(())
    }
}

/// Finds out what a file holds, by its name's end and, where that says nothing, by its bytes.
fn look(path: &Path, files: &Files) -> Result<Found, String> {
    let name = path
        .file_name()
        .map(|name| name.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    // A page has no folder that it is in.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    if path.is_dir() {
        return Ok(Found::Folder(path));
    }
    if name.ends_with(".ron") {
        let text = files.bytes(&path, limits::FILE_SIZE as u64)?;
        let text = String::from_utf8(text).map_err(|error| error.to_string())?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let scene = SceneFile::parse(&path.display().to_string(), &text, folder).map_err(|report| report.render())?;
        return Ok(Found::Scene {
            scene: Box::new(scene.with_files(files.clone())),
            path: Some(path),
        });
    }
    if name.ends_with(".gltf") || name.ends_with(".glb") {
        let scene = Box::new(around(&path, files)?);
        return Ok(Found::Scene { scene, path: None });
    }
    let format = format_of(&path, files)?;
    Ok(Found::Data { path, format })
}

impl App {
    /// Opens a file by what it is: a scene, glTF, data for what is selected, or a folder of modules.
    pub fn open_file(&mut self, path: PathBuf) {
        let files = self.document.scene().files().clone();
        self.lanes.desk.ask(Look { path, files });
    }

    /// Takes what a file held.
    pub(crate) fn take_found(&mut self, found: Found) {
        match found {
            Found::Scene { scene, path } => {
                self.open(*scene);
                if let Some(path) = path {
                    self.kept.remember(&path);
                }
            }
            Found::Folder(folder) => self.use_modules(Some(folder)),
            Found::Data { path, format } => {
                if let Err(why) = self.take_data(&path, format.as_deref()) {
                    self.message = format!("{}: {why}", path.display());
                }
            }
        }
    }

    /// Gives a file of data or a picture to what is selected, or to a new light that takes such files.
    fn take_data(&mut self, path: &Path, format: Option<&str>) -> Result<(), String> {
        let file = quoted(&path.display().to_string());
        let fits = |row: Row| {
            let (part, resource) = resource_for(row.module.as_ref()?, format)?;
            Some((row, part, resource))
        };
        if let Some((row, part, resource)) = self.selected_row().cloned().and_then(fits) {
            let at = format!("{}.{part}{}", row.path, step_path(&resource));
            self.edit(&format!("Use {}", path.display()), |draft| draft.set(&row.through, &at, &file));
            return Ok(());
        }
        let Some((module, resource)) = light_for(&self.catalog, format) else {
            return Err("nothing that is selected takes such a file".to_owned());
        };
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let element = format!(
            "(name: {}, module: {}, fields: {{\"position\": (0.0, 2.5, 0.0)}}, files: {{{}: {file}}})",
            quoted(&name),
            quoted(&module),
            quoted(&resource)
        );
        self.edit(&format!("Add the light {name}"), |draft| draft.add(&[], "lights", &element));
        Ok(())
    }
}

/// The format of a file of data; `None` for a picture that is a texture.
fn format_of(path: &Path, files: &Files) -> Result<Option<String>, String> {
    let bytes = files.bytes(path, data::MAX_DATA)?;
    // Any bytes may be plain numbers, so nothing is known by that.
    let found = FORMATS.iter().find(|(name, decode)| *name != PLAIN && decode(&bytes).is_ok());
    match found {
        Some((name, _)) => Ok(Some((*name).to_owned())),
        None if shadewright_runtime::image::decode_texture(&bytes).is_ok() => Ok(None),
        None => Err("is no scene, no glTF, no picture and no table that is known".to_owned()),
    }
}

/// The resource of a module that takes files of a format, and where a scene names them.
fn resource_for(module: &Module, format: Option<&str>) -> Option<(&'static str, String)> {
    module.manifest.resources.iter().find_map(|(name, resource)| match &resource.kind {
        ResourceKind::Data { format: Some(taken), .. } if Some(taken.as_str()) == format => Some(("files", name.clone())),
        // What is a picture for a table is one for a texture.
        ResourceKind::Texture { .. } if format.is_none_or(|format| format == "picture") => Some(("textures", name.clone())),
        _ => None,
    })
}

/// The light that takes files of a format, and the resource.
fn light_for(catalog: &Catalog, format: Option<&str>) -> Option<(String, String)> {
    let lights = catalog.modules().filter(|module| module.category == "light");
    lights
        .filter_map(|module| Some((name_in(catalog, module), resource_for(module, format)?)))
        .find(|(_, (part, _))| *part == "files")
        .map(|(module, (_, resource))| (module, resource))
}

/// A scene around a glTF file: seen by its own camera, or from where all of it is seen; lit by its own lights, or by a sun.
fn around(path: &Path, files: &Files) -> Result<SceneFile, String> {
    let asset = gltf::load_with(path, &mut |path| files.bytes(path, gltf::MAX_FILE)).map_err(|error| error.to_string())?;
    let boxes = asset
        .objects
        .iter()
        .filter_map(|object| Some(object.mesh.bounds()?.transformed(&object.model)));
    let whole = boxes.reduce(|a, b| a.union(&b)).ok_or("holds no triangles")?;
    let mut text = "(\n    pass: \"forward\", display: \"display\",\n".to_owned();
    let fov: f32 = 35.0;
    if asset.cameras.is_empty() {
        let target = whole.center();
        let radius = whole.radius().max(1e-6);
        let away = radius / (fov.to_radians() * 0.5).sin();
        let eye = target + Vec3::new(0.5, 0.35, 0.8).normalize() * away;
        let triple = |v: Vec3| ron_of(&<(f32, f32, f32)>::from(v));
        text += &format!(
            "    camera: (eye: {}, target: {}, fov: {fov:?}, near: {:?}, far: {:?}),\n",
            triple(eye),
            triple(target),
            away * 0.01,
            away * 10.0
        );
    }
    // Exposure 9 suits the sun below, and candelas that a file means for a room.
    text += "    post: [(module: \"tonemap\", fill: {\"exposure\": (module: \"manual\", params: {\"ev100\": 9.0})})],\n    background: (20.0, 22.0, 25.0),\n";
    if asset.lights.is_empty() {
        text += "    lights: [\n        (name: \"sun\", module: \"directional\", fields: {\"direction\": (-0.5, -1.0, -0.6), \"illuminance\": 4000.0}, visibility: \"perspective\"),\n        \
                 (name: \"sky\", module: \"directional\", fields: {\"direction\": (0.6, -0.4, 0.7), \"illuminance\": 800.0, \"color\": \"9000 K\"}),\n    ],\n";
    }
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let file = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    text += &format!("    gltf: [(file: {})],\n)\n", quoted(&file));
    let scene = SceneFile::parse(&format!("{}.scene.ron", path.display()), &text, &folder);
    scene
        .map(|scene| scene.with_files(files.clone()))
        .map_err(|report| crate::work::reason(&report))
}
