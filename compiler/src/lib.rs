//! Links WGSL modules declared in RON into one validated naga module.
//!
//! A *module* is a folder: `module.ron` declares it, one `.wgsl` file implements the interface of its category. A module has
//! *slots*, holes that other modules fill; it calls what fills them by the interface's names and never sees who it is. A
//! *recipe* is a tree of chosen modules. This crate turns a recipe into one shader that holds what its entry points reach and
//! nothing else, and can say why each thing in it is there.
//!
//! ```text
//! RON text -> manifests, recipe -> parsed units -> resolved tree -> plan -> linked -> validated -> text | reflection | Rust
//!             (manifest)           (parse)         (resolve)        (plan)  (link)    (validate)   (emit)  (reflect)   (host)
//! ```
//!
//! Each arrow is a folder, each thing between two arrows an owned type. Linking is done on naga's IR: every module is parsed
//! once, alone, with stubs in place of what it calls; a permutation costs cloning and patching the functions it reaches, about
//! as much as validating the result. The same plan is also written as source, the authors' own text with their comments, and
//! the two forms are held against each other: the source form, parsed again, has the hash of the IR.
//!
//! A [`space`] is a recipe with alternatives: its legal permutations are counted, walked through, covered or sampled without building
//! those that a rule forbids, and compiled on many threads.
//!
//! The compiler reaches the outside world through [`Library`] alone, knows no category or module by name, and answers any input
//! with a program or with a [`Report`] whose errors point into the author's file.
//!
//! ```
//! use std::sync::Arc;
//! use shadewright_compiler::{Catalog, Library, Recipe};
//!
//! /// A library in memory: one category, whose only module is a pass.
//! struct One;
//!
//! impl Library for One {
//!     fn folders(&self, folder: &str) -> Vec<String> {
//!         match folder {
//!             "" => vec!["pass".to_owned()],
//!             "pass" => vec!["clear".to_owned()],
//!             _ => Vec::new(),
//!         }
//!     }
//!     fn read(&self, path: &str) -> Result<Option<String>, String> {
//!         Ok(match path {
//!             "pass/category.ron" => Some(r#"(summary: "Entry points", order: 1)"#.to_owned()),
//!             "pass/interface.wgsl" => Some(String::new()),
//!             "pass/clear/module.ron" => Some(r#"(
//!                 summary: "Fills a buffer",
//!                 params: {"value": (type: F32, default: 1.0)},
//!                 resources: {"cells": (kind: Host("cells"))},
//!             )"#.to_owned()),
//!             "pass/clear/clear.wgsl" => Some("
//!                 var<storage, read_write> cells: array<f32>;
//!                 @compute @workgroup_size(64)
//!                 fn clear(@builtin(global_invocation_id) id: vec3u) { cells[id.x] = params.value; }
//!             ".to_owned()),
//!             _ => None,
//!         })
//!     }
//! }
//!
//! let catalog = Catalog::load(Arc::new(One))?;
//! let frozen = Recipe::parse("frozen", r#"(module: "clear", freeze: {"value": 0.5})"#)?;
//! let program = catalog.compile(&frozen, "main")?;
//! assert!(program.wgsl().contains("const clear_value: f32 = 0.5f;"));
//! assert_eq!(program.reflection().bindings.len(), 1); // no uniform buffer is left
//! # Ok::<(), shadewright_compiler::Report>(())
//! ```

#![forbid(unsafe_code)]

pub mod canonical;
pub mod catalog;
mod contracts;
pub mod data;
pub mod diagnostics;
pub mod emit;
pub mod hash;
pub mod host;
mod key;
pub mod library;
pub mod limits;
mod link;
pub mod manifest;
mod origins;
mod parse;
mod plan;
mod probe;
pub mod program;
pub mod reflect;
mod resolve;
pub mod space;
pub mod upstream;
pub mod validate;
mod why;

pub use catalog::{Catalog, Category, Module};
pub use diagnostics::{Diagnostic, Report};
pub use emit::{Target, emit};
pub use key::NAGA;
pub use library::Library;
pub use naga;
pub use program::{ItemOrigin, LineOrigin, LinkPlan, Program, Recipe, Why};
pub use reflect::Reflection;
pub use space::Space;
pub use validate::Validated;
