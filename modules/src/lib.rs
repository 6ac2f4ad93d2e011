//! The standard library of shader modules, and the ways to have modules of one's own beside it.
//!
//! The modules are data: each is a folder `<category>/<name>/` of this crate with
//!
//! - `module.ron`: its declaration ([`shadewright_compiler::manifest::ModuleManifest`]),
//! - `<name>.wgsl`: its code, plain WGSL,
//! - `README.md`: formula, source, domain and limits,
//! - `cases.ron`: inputs with the values that they must give ([`cases`]),
//! - if it is compared with something: `<name>.experiment.ron`, and `truth.rs`, its closed form in double precision (feature `oracles`).
//!
//! The build script finds them by looking at the folders, so this crate has no list of modules.
//!
//! ```
//! use std::sync::Arc;
//! use shadewright_modules::{Folder, Overlay, library};
//!
//! // Modules in ./shaders come first, the standard library fills in the rest.
//! let mine = Overlay(vec![Arc::new(Folder::new("./shaders")), library()]);
//! ```

#![forbid(unsafe_code)]

pub mod build;
pub mod cases;
mod embedded;
mod folder;
#[cfg(feature = "oracles")]
pub mod oracles;
mod overlay;
mod recorded;
#[cfg(feature = "wesl")]
mod wesl;

use std::sync::Arc;

use shadewright_compiler::Library;

pub use embedded::Embedded;
pub use folder::Folder;
pub use overlay::Overlay;
pub use recorded::Recorded;
#[cfg(feature = "wesl")]
pub use wesl::Wesl;

/// The standard library.
pub fn library() -> Arc<dyn Library> {
    Arc::new(Embedded)
}

#[cfg(test)]
mod tests {
    use shadewright_compiler::Catalog;

    /// Catches manifests that say something that cannot be, such as a default outside its range or a slot of no category.
    #[test]
    fn the_compiler_takes_every_manifest() {
        let catalog = Catalog::load(super::library()).map_err(|report| report.render());
        let catalog = catalog.unwrap_or_else(|report| panic!("{report}"));
        let folders = super::Embedded.files().filter(|(path, _)| path.ends_with("/module.ron")).count();
        assert_eq!(catalog.modules().count(), folders);
    }
}
