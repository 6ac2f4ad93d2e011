//! Executes linked shaders with wgpu, in physical units.
//!
//! ```text
//! scene file -> the smallest recipes that draw it -> programs -> pipelines -> passes -> HDR frame -> display image
//! (scene)       (scene)                              (frame)     (gpu)        (frame)   (frame)      (image)
//! ```
//!
//! - [`gpu`]: a device of its own or the caller's, typed errors, pipelines by canonical hash, buffers packed by reflection.
//! - [`probe`]: one function of a recipe evaluated over a table of inputs.
//! - [`frame`]: a frame described by meshes, materials and lights, drawn. Shadow maps and compute passes come from what the
//!   modules declare.
//! - [`scene`]: scene files and glTF, and the recipes derived from them.
//! - [`mesh`], [`image`], [`data`]: triangles, pictures and tables of numbers.
//! - [`measured`]: tables of reflectance from files.
//!
//! Colours are linear Rec.709 in cd/m2 per channel, lengths in metres, right-handed with y up. The runtime knows no module by
//! name, owns no window and prints nothing.

#![forbid(unsafe_code)]

pub mod data;
pub mod frame;
pub mod gpu;
pub mod image;
pub mod measured;
pub mod mesh;
pub mod probe;
pub mod scene;

pub use naga;
pub use wgpu;
