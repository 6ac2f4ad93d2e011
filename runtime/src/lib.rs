//! Executes linked shaders with wgpu, in physical units.

pub mod frame;
pub mod image;
pub mod mesh;
