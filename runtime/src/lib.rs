//! Executes linked shaders with wgpu, in physical units.

pub mod frame;
pub mod gpu;
pub mod image;
pub mod mesh;
pub mod scene;

pub use naga;
pub use wgpu;
