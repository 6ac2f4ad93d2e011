//! A frame: from its description to a linear HDR image and a display image.

mod description;
mod draw;
mod fill;
mod list;
mod maps;
mod plan;
mod programs;
mod render;
mod target;
#[cfg(test)]
mod tests;
mod upload;
mod view;

pub use description::{Bounds, Camera, Draw, Frame, Lights, Material, Mesh, Settings, Texture};
pub use render::Renderer;
pub use target::Targets;
