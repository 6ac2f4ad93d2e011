//! The GPU: its device, linked programs as pipelines, typed values as bytes, and the times of passes.

pub mod cache;
mod device;
mod error;
mod kept;
pub mod layout;
pub mod pack;
pub mod pipeline;
pub mod resources;
#[cfg(test)]
pub(crate) mod testing;
pub(crate) mod timer;
pub(crate) mod value;

pub use device::Gpu;
pub(crate) use device::lock;
pub use error::{DataError, GpuError, RuntimeError};
pub use kept::Counts;
pub(crate) use timer::Timer;
