//! The GPU: its device, linked programs as pipelines, and typed values as bytes.

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
pub(crate) mod value;

pub use device::Gpu;
pub(crate) use device::lock;
pub use error::{DataError, GpuError, RuntimeError};
pub use kept::Counts;
