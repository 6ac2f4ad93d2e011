//! Holds Shadewright against other ways to compose the same shader: naga_oil's composer, wesl, and plain concatenation.
//!
//! ```text
//! recipe -> linked text -> pieces -> the same functions as each peer's modules -> candidates -> rounds -> tables
//!           (compiler)     (pieces)  (peers)                                     (measure)     (measure) (table)
//! ```
//!
//! Nobody's shader is written by hand: the peers' modules are cut out of the text that the compiler links, item by item, so that the
//! sets of functions cannot drift apart. `tests/meaning.rs` draws the first scene with every candidate's output, and compares.
//!
//! `cargo bench -p shadewright-benchmark` measures and prints; `-- --write spec/performance.md` also puts the tables there.

pub mod edited;
pub mod measure;
pub mod peers;
pub mod permutations;
pub mod pieces;
pub mod process;
pub mod table;

use std::sync::Arc;

use shadewright_compiler::{Catalog, Program, Recipe};

/// The recipe that is measured: what the first scene draws its opaque, one-sided objects with.
pub const RECIPE: &str = include_str!("../../../examples/recipes/forward.recipe.ron");

/// The shader of [`RECIPE`], linked, with what it was linked from.
#[derive(Debug)]
pub struct Subject {
    /// The standard library.
    pub catalog: Arc<Catalog>,
    /// The recipe.
    pub recipe: Recipe,
    /// The program.
    pub program: Program,
}

impl Subject {
    /// From nothing: manifests, parsing what the recipe reaches, linking.
    ///
    /// # Errors
    /// The library or the recipe is broken; the text says how.
    pub fn load() -> Result<Self, String> {
        let catalog = Catalog::load(shadewright_modules::library()).map_err(|report| report.render())?;
        let recipe = Recipe::parse("forward.recipe.ron", RECIPE).map_err(|report| report.render())?;
        let program = catalog.compile(&recipe, "main").map_err(|report| report.render())?;
        Ok(Self {
            catalog: Arc::new(catalog),
            recipe,
            program,
        })
    }
}

/// The version of a package in this workspace's lock file.
pub fn version(package: &str) -> &'static str {
    let lock = include_str!("../../../Cargo.lock");
    let entry = format!("name = \"{package}\"\nversion = \"");
    let rest = lock.split_once(entry.as_str()).map_or("", |(_, rest)| rest);
    rest.split('"').next().unwrap_or_default()
}
