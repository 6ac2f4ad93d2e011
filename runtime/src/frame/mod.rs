//! A frame: from its description to a linear HDR image and a display image.

mod description;
mod draw;
mod fill;
mod jobs;
mod late;
mod list;
mod maps;
mod needs;
mod plan;
mod prepare;
mod programs;
mod reading;
mod render;
mod target;
#[cfg(test)]
mod tests;
mod thaw;
mod times;
mod upload;
mod view;
mod warm;

pub use description::{Bounds, Camera, Draw, Frame, Lights, Material, Mesh, Settings, Texture};
pub use late::{Fallback, Fallbacks, Late, Part};
pub use needs::{Need, PipelineState, Stage, needs};
pub use prepare::{Prepared, Progress};
pub use reading::{DisplayReading, HdrReading};
pub use render::Renderer;
pub use target::Targets;
pub use times::{CpuTimes, FrameTimes, PassTime};
