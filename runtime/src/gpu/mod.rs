//! The GPU: its device, linked programs as pipelines, typed values as bytes, and `probe`.

mod device;
mod error;
pub mod layout;
pub mod pack;
pub mod pipeline;
#[cfg(test)]
pub(crate) mod testing;

pub use device::Gpu;
pub use error::{DataError, GpuError, RuntimeError};
