//! Links WGSL modules declared in RON into one validated naga module.

pub mod canonical;
pub mod catalog;
mod link;
mod parse;
mod plan;
mod probe;
mod resolve;
pub mod diagnostics;
pub mod emit;
pub mod hash;
pub mod library;
pub mod limits;
pub mod manifest;
pub mod program;
pub(crate) mod why;
pub mod reflect;
pub mod upstream;
pub mod validate;

pub use catalog::{Catalog, Category, Module};
pub use diagnostics::{Diagnostic, Report};
pub use emit::{Target, emit};
pub use library::Library;
pub use naga;
pub use program::{Program, Recipe, Why};
pub use reflect::Reflection;
pub use validate::Validated;
