//! Executes linked shaders with wgpu, in physical units.

pub mod frame;
pub mod gpu;

pub use naga;
pub use wgpu;
