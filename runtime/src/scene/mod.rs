//! Scenes: `*.scene.ron` files, and the smallest recipes that draw them.

mod choice;
mod format;
mod path;

pub use choice::{Choice, Choices, Picture};
pub use format::{CameraDecl, GltfDecl, LightDecl, ObjectDecl, Scene};
