//! A frame: from its description to a linear HDR image and a display image.

mod description;
mod fill;
mod list;
mod maps;
mod programs;
mod render;
mod target;
mod upload;
mod view;

pub use description::{Bounds, Camera, Draw, Frame, Lights, Material, Mesh, Settings, Texture};
pub use render::Renderer;
pub use target::Targets;
