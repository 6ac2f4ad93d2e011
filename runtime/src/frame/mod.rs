//! A frame: from its description to a linear HDR image and a display image.

mod description;

pub use description::{Bounds, Camera, Draw, Frame, Lights, Material, Mesh, Settings, Texture};
