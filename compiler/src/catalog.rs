//! All that a library declares, loaded once.

use std::sync::Arc;

use indexmap::IndexMap;

use crate::diagnostics::Report;
use crate::library::Library;
use crate::manifest::{CategoryManifest, ModuleManifest};
use crate::program::{Program, Recipe};

/// A category with its name.
#[derive(Debug)]
pub struct Category {
    /// Name of its folder.
    pub name: String,
    /// Its declaration.
    pub manifest: CategoryManifest,
}

/// A module with its name.
#[derive(Debug)]
pub struct Module {
    /// Name of its folder.
    pub name: String,
    /// Its category's name.
    pub category: String,
    /// Its declaration.
    pub manifest: ModuleManifest,
}

/// The manifests of a library, and a cache of its parsed WGSL. Cheap to load, shared between threads.
pub struct Catalog {
    #[allow(dead_code)]
    library: Arc<dyn Library>,
    categories: IndexMap<String, Arc<Category>>,
    modules: Vec<Arc<Module>>,
}

impl Catalog {
    /// Reads all manifests of the library. WGSL is read and parsed when a recipe first needs it.
    ///
    /// # Errors
    /// A manifest is no RON, or says something that cannot be.
    pub fn load(library: Arc<dyn Library>) -> Result<Self, Report> {
        Ok(Self {
            library,
            categories: IndexMap::new(),
            modules: Vec::new(),
        })
    }

    /// Categories in the order in which lists show them.
    pub fn categories(&self) -> impl Iterator<Item = &Arc<Category>> {
        self.categories.values()
    }

    /// Modules, sorted by category order and name.
    pub fn modules(&self) -> impl Iterator<Item = &Arc<Module>> {
        self.modules.iter()
    }

    /// The module of this name, or `category/name`.
    ///
    /// # Errors
    /// There is none (says the nearest names), or several categories have one.
    pub fn module(&self, name: &str) -> Result<&Arc<Module>, Report> {
        self.modules
            .iter()
            .find(|m| m.name == name)
            .ok_or_else(|| Report::from(crate::diagnostics::Diagnostic::new("SW0000", "not written yet")))
    }

    /// Links, validates and reflects one pass of a recipe: `main` for the root's own entry points,
    /// `<instance>.<pass>` for a pass that a module of the tree declares.
    ///
    /// # Errors
    /// Anything wrong with the recipe or with the modules it reaches.
    pub fn compile(&self, recipe: &Recipe, pass: &str) -> Result<Program, Report> {
        let _ = (recipe, pass);
        Err(Report::from(crate::diagnostics::Diagnostic::new("SW0000", "not written yet")))
    }

    /// Makes a compute program that calls one interface function of a recipe's root over a table: entry point `probe`,
    /// workgroup size 64, group 3 binding 0 `array<ProbeInput>` (one member for each argument, named as in the interface),
    /// binding 1 `array<ProbeOutput>` with the member `value`.
    ///
    /// # Errors
    /// As for [`Catalog::compile`]; the root's interface has no such function.
    pub fn compile_probe(&self, recipe: &Recipe, function: &str) -> Result<Program, Report> {
        let _ = (recipe, function);
        Err(Report::from(crate::diagnostics::Diagnostic::new("SW0000", "not written yet")))
    }
}
