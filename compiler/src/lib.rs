//! Links WGSL modules declared in RON into one validated naga module.

pub mod canonical;
pub mod catalog;
mod contracts;
pub mod diagnostics;
pub mod emit;
pub mod hash;
pub mod library;
pub mod limits;
mod link;
pub mod manifest;
mod parse;
mod plan;
mod probe;
pub mod program;
pub mod reflect;
mod resolve;
pub mod upstream;
pub mod validate;
pub(crate) mod why;

pub use catalog::{Catalog, Category, Module};
pub use diagnostics::{Diagnostic, Report};
pub use emit::{Target, emit};
pub use library::Library;
pub use naga;
pub use program::{Program, Recipe, Why};
pub use reflect::Reflection;
pub use validate::Validated;
