//! Scenes that come with the explorer.

use std::path::Path;
use std::sync::Arc;

use shadewright_compiler::Report;
use shadewright_runtime::scene::{Files, SceneFile};

/// A scene with its name and text.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Its name, by which a link or the command line asks for it.
    pub name: &'static str,
    /// One line.
    pub summary: &'static str,
    /// RON.
    pub text: &'static str,
}

macro_rules! example {
    ($name:literal, $summary:literal) => {
        Example {
            name: $name,
            summary: $summary,
            text: include_str!(concat!("../../scenes/", $name, ".scene.ron")),
        }
    };
}

/// All of them; the first is opened where nothing else is asked for.
pub const ALL: &[Example] = &[
    example!("first", "A copper teapot among glazed and painted things"),
    example!("sphere", "One sphere under a few lights"),
    example!("materials", "A sphere for each kind of material"),
    example!("area", "A glossy floor under one area light of each shape"),
    example!("spots", "Downlights, a wall washer and spots, from photometric files"),
    example!("sun", "Spheres in the sun"),
    example!("screen", "A picture that shines on a floor"),
];

/// The files that they name.
const FILES: [(&str, &[u8]); 3] = [
    ("downlight.ies", include_bytes!("../../scenes/downlight.ies")),
    ("washer.ldt", include_bytes!("../../scenes/washer.ldt")),
    ("screen.png", include_bytes!("../../scenes/screen.png")),
];

/// The files of the examples and, where there is one, of the disk.
pub fn files() -> Files {
    let named = FILES.map(|(name, bytes)| (name.to_owned(), Arc::from(bytes)));
    let files = Files::memory(named.into_iter().collect());
    if cfg!(target_arch = "wasm32") { files } else { files.or_disk() }
}

impl Example {
    /// It, with its files.
    ///
    /// # Errors
    /// The text is no scene, which a test rules out.
    pub fn scene(&self) -> Result<SceneFile, Report> {
        Ok(SceneFile::parse(self.name, self.text, Path::new(""))?.with_files(files()))
    }
}

/// The example of this name.
pub fn find(name: &str) -> Option<&'static Example> {
    ALL.iter().find(|example| example.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches an example that cannot be drawn where there is no disk, or that names a module that is gone.
    #[test]
    fn every_example_has_its_files() {
        let catalog = shadewright_compiler::Catalog::load(shadewright_modules::library()).unwrap();
        for example in ALL {
            let scene = example.scene().unwrap();
            crate::work::links(&catalog, &scene).unwrap_or_else(|report| panic!("{}: {}", example.name, report.render()));
        }
        assert!(find("first").is_some() && find("none").is_none());
    }
}
