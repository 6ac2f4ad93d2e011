//! For build scripts: recipes become Rust that a program includes, so that nothing of ours is in the program when it runs.
//!
//! ```no_run
//! // build.rs
//! shadewright_modules::build::Build::new()
//!     .modules("shaders/modules")
//!     .recipe("shaders/matte.recipe.ron")
//!     .write();
//! ```
//!
//! ```text
//! // src/main.rs
//! include!(concat!(env!("OUT_DIR"), "/matte.rs"));
//! ```
//!
//! What is then in `matte.rs` is told by [`shadewright_compiler::host`]: a module `matte` for the recipe's own pass, and one for each
//! pass that must run before it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use shadewright_compiler::host::{Pass, module_name, rust};
use shadewright_compiler::{Catalog, Library, Recipe, Report};
use thiserror::Error;

use crate::{Folder, Overlay, Recorded, library};

/// What a build script wants written.
#[derive(Clone, Debug, Default)]
pub struct Build {
    folders: Vec<PathBuf>,
    recipes: Vec<PathBuf>,
    out: Option<PathBuf>,
}

/// What was written, and of what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Rust files, in the order of the recipes.
    pub files: Vec<PathBuf>,
    /// Files that were read, sorted, and the folders of modules: a module that is put there may stand before one that was read.
    pub read: Vec<PathBuf>,
}

/// Why nothing was written.
#[derive(Debug, Error)]
pub enum BuildError {
    /// A recipe or a module is wrong; the report says where.
    #[error("{0}")]
    Shader(#[from] Report),
    /// A file or folder cannot be read or written.
    #[error("error: {}: {why}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why not.
        why: String,
    },
    /// Two recipes would be written into one file.
    #[error("error: two recipes would be `{0}`: give their files different names")]
    Twice(String),
    /// This runs outside a build script, and no folder was said.
    #[error("error: OUT_DIR is not set: this is for build scripts, elsewhere say `out_dir`")]
    NoFolder,
}

impl Build {
    /// Nothing yet; the standard library is there.
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts a folder of modules (`CATEGORY/NAME/module.ron`) over the standard library. Of several the last stands before the others.
    #[must_use]
    pub fn modules(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folders.push(folder.into());
        self
    }

    /// Adds a recipe's file. `NAME.recipe.ron` becomes `NAME.rs`, spelled as Rust spells modules.
    #[must_use]
    pub fn recipe(mut self, file: impl Into<PathBuf>) -> Self {
        self.recipes.push(file.into());
        self
    }

    /// Writes into this folder instead of `OUT_DIR`.
    #[must_use]
    pub fn out_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.out = Some(folder.into());
        self
    }

    /// Writes, tells cargo which files the result depends on, and ends the build script with status 1 where something is wrong, with
    /// errors that point into the author's file.
    pub fn write(&self) {
        match self.run() {
            Ok(written) => {
                for path in &written.read {
                    say(&mut std::io::stdout(), &format!("cargo::rerun-if-changed={}", path.display()));
                }
            }
            Err(error) => {
                say(&mut std::io::stderr(), &error.to_string());
                std::process::exit(1);
            }
        }
    }

    /// Writes. All files are made before the first is written; a file that would not change is left alone.
    ///
    /// # Errors
    /// See [`BuildError`]; nothing has been written then, but where a file of several cannot be.
    pub fn run(&self) -> Result<Written, BuildError> {
        let out = self.out.clone().or_else(|| std::env::var_os("OUT_DIR").map(PathBuf::from));
        let out = out.ok_or(BuildError::NoFolder)?;
        let mut read = BTreeSet::new();
        let mut layers: Vec<(PathBuf, Arc<Recorded>)> = Vec::new();
        for folder in self.folders.iter().rev() {
            let real = fs::canonicalize(folder).map_err(|error| file(folder, error))?;
            read.insert(real.clone());
            layers.push((real, Arc::new(Recorded::new(Arc::new(Folder::new(folder))))));
        }
        let mut overlay: Vec<Arc<dyn Library>> = Vec::new();
        overlay.extend(layers.iter().map(|(_, layer)| Arc::clone(layer) as Arc<dyn Library>));
        overlay.push(library());
        let catalog = Catalog::load(Arc::new(Overlay(overlay)))?;
        let mut texts: Vec<(PathBuf, String)> = Vec::new();
        for path in &self.recipes {
            let text = fs::read_to_string(path).map_err(|error| file(path, error))?;
            read.insert(fs::canonicalize(path).map_err(|error| file(path, error))?);
            let recipe = Recipe::parse(&path.display().to_string(), &text)?;
            let stem = path
                .file_name()
                .and_then(|name| name.to_str())
                .and_then(|name| name.split('.').next());
            let stem = stem.unwrap_or(&recipe.root.module).to_owned();
            let target = out.join(format!("{}.rs", module_name(&stem, "main")));
            if texts.iter().any(|(other, _)| *other == target) {
                return Err(BuildError::Twice(target.display().to_string()));
            }
            let programs: Vec<_> = catalog.compile_all(&recipe)?;
            let names: Vec<String> = programs
                .iter()
                .map(|program| module_name(&stem, &program.reflection().pass))
                .collect();
            let passes: Vec<Pass> = names
                .iter()
                .zip(&programs)
                .map(|(name, program)| Pass::new(name, program))
                .collect();
            texts.push((target, rust(&passes)?));
        }
        for (target, text) in &texts {
            replace(target, text).map_err(|error| file(target, error))?;
        }
        for (folder, layer) in layers {
            read.extend(layer.paths().iter().map(|path| folder.join(path)));
        }
        Ok(Written {
            files: texts.into_iter().map(|(target, _)| target).collect(),
            read: read.into_iter().collect(),
        })
    }
}

fn file(path: &Path, error: std::io::Error) -> BuildError {
    BuildError::File {
        path: path.to_owned(),
        why: error.to_string(),
    }
}

/// Writes a whole file, or none.
fn replace(target: &Path, text: &str) -> std::io::Result<()> {
    if fs::read(target).is_ok_and(|there| there == text.as_bytes()) {
        return Ok(());
    }
    let temporary = target.with_extension("rs.new");
    fs::write(&temporary, text)?;
    fs::rename(&temporary, target)
}

/// A line; where nobody listens there is nobody to tell.
fn say(to: &mut impl std::io::Write, line: &str) {
    let _ = writeln!(to, "{line}");
}
