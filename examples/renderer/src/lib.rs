//! A small renderer of somebody else's, which takes its shaders from Shadewright.
//!
//! Device, mesh, camera, loop and tone mapping are its own. It has its shaders in either of two ways:
//!
//! - [`built`]: the build script wrote them as Rust. Nothing of Shadewright is in the program.
//! - `live`: the program links them itself while it runs, from a folder of modules, and fills buffers by reflection. Of Shadewright
//!   it has the compiler alone.
//!
//! Both draw the same picture.

#![deny(warnings, missing_docs)]

pub mod built;
pub mod gpu;
#[cfg(feature = "live")]
pub mod live;
pub mod mesh;
pub mod picture;
pub mod recipes;
pub mod world;
