//! The user's folder of modules, read with the standard library and read again.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use shadewright_compiler::{Catalog, Library};

use crate::work::{Bench, Job, News, Step};

/// The standard library with a folder's modules before it.
pub fn library_with(folder: &Path) -> Arc<dyn Library> {
    let own = Arc::new(shadewright_modules::Folder::new(folder));
    Arc::new(shadewright_modules::Overlay(vec![own, shadewright_modules::library()]))
}

/// Reads a library, again where there is a catalog of it.
pub enum Reload {
    /// The library of this catalog after an edit.
    Again(Arc<Catalog>),
    /// Another library.
    Other(Arc<dyn Library>),
}

impl Job for Reload {
    fn kind(&self) -> &'static str {
        "library"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let loaded = match self {
            Self::Again(catalog) => catalog.reload(),
            Self::Other(library) => Catalog::load(Arc::clone(library)),
        };
        tell(News::Library(loaded.map(Arc::new)));
        Step::Break(())
    }
}
