//! Shadewright composes shaders.
//!
//! A shading model is a tree of small WGSL modules: a pass with a material, a BRDF, lights; the BRDF with a distribution of
//! normals, a masking function, a Fresnel term. Each module is one folder: `module.ron` declares it (slots, parameters with
//! units, resources, passes it needs), one file of plain WGSL implements the interface of its category. A *recipe* names the
//! modules of a tree and freezes some of their parameters. From there
//!
//! ```text
//! RON -> Recipe -> parsed modules -> resolved tree -> link plan -> one naga module -> validated -> WGSL, SPIR-V, GLSL, HLSL, MSL
//!                                                                                              -> reflection (JSON)
//!                                                                                              -> a pipeline, a frame
//! ```
//!
//! A choice is made by linking another function, never by an `if`: what a shader doesn't need is not in it. No function, type,
//! binding, interpolant or parameter is there that the entry points don't reach.
//!
//! This crate is the facade over five; the compiler and the evaluator know none of the others, the rest those before them:
//!
//! - [`compiler`]: declarations and WGSL to a validated module, its reflection and its text. No GPU, no files.
//! - [`evaluate`]: a validated module on the CPU, in f32, f64, or with all that WGSL allows a driver; and what it costs.
//! - [`modules`]: the standard library, embedded.
//! - [`runtime`]: wgpu. Scenes to recipes, pipelines, passes, and an HDR frame in physical units.
//! - [`report`]: experiments on modules, speed against error.
//!
//! ```
//! use shadewright::compiler::{Catalog, Recipe};
//!
//! let catalog = Catalog::load(shadewright::modules::library())?;
//! // A BRDF by itself has no entry points; a probe calls it over a table of inputs.
//! let recipe = Recipe::parse("example", r#"(module: "microfacet", fill: {"ndf": "ggx"})"#)?;
//! let program = catalog.compile_probe(&recipe, "brdf")?;
//! assert!(program.wgsl().contains("fn microfacet_brdf("));
//! assert!(program.reflection().functions.iter().any(|function| function.module == "ggx"));
//! # Ok::<(), shadewright::compiler::Report>(())
//! ```

#![forbid(unsafe_code)]

pub use shadewright_compiler as compiler;
pub use shadewright_evaluate as evaluate;
pub use shadewright_modules as modules;
pub use shadewright_report as report;
pub use shadewright_runtime as runtime;
