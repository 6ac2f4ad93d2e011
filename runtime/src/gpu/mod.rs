//! The GPU: its device, linked programs as pipelines, typed values as bytes, and the times of passes.

#[cfg(not(target_arch = "wasm32"))]
pub mod cache;
mod device;
mod error;
mod form;
#[cfg(not(target_arch = "wasm32"))]
mod headless;
mod kept;
pub mod layout;
pub mod pack;
pub mod pipeline;
mod reading;
mod recent;
pub mod resources;
#[cfg(test)]
pub(crate) mod testing;
pub(crate) mod timer;
pub(crate) mod value;

pub use device::Gpu;
pub(crate) use device::lock;
pub use error::{DataError, GpuError, RuntimeError};
pub use form::Form;
pub use kept::Counts;
pub use reading::Reading;
pub(crate) use recent::Recent;
pub(crate) use timer::Timer;
