//! What can go wrong between a host and its GPU.

use shadewright_compiler::Report;
use shadewright_evaluate::EvaluateError;

/// Errors of the GPU itself and of its driver.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// There is no GPU and no software driver that can do what is needed.
    #[error("no usable GPU: {reason}\n{advice}")]
    NoAdapter {
        /// What was looked for.
        reason: String,
        /// What to install.
        advice: String,
    },
    /// There is an adapter, but it gives no device.
    #[error("{adapter} gives no device: {message}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// What the driver said.
        message: String,
    },
    /// The device went away; make a new [`crate::gpu::Gpu`] and everything on it.
    #[error("the GPU was lost: {0}")]
    Lost(String),
    /// wgpu found the request invalid. For a linked program this is a bug of ours.
    #[error("{what}: {message}")]
    Invalid {
        /// What was being done.
        what: String,
        /// wgpu's own words.
        message: String,
    },
    /// No memory left.
    #[error("{what}: out of GPU memory")]
    OutOfMemory {
        /// What was being done.
        what: String,
    },
    /// The driver failed.
    #[error("{what}: the driver failed: {message}")]
    Driver {
        /// What was being done.
        what: String,
        /// What the driver said.
        message: String,
    },
    /// The device, or the runtime, lacks something.
    #[error("{what} needs {needs}, which is not there")]
    Unsupported {
        /// What needs it.
        what: String,
        /// What is missing.
        needs: String,
    },
}

/// A value that does not fit where it should go.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {message}")]
pub struct DataError {
    /// Where in the input, `[3].s.normal`.
    pub path: String,
    /// What was expected, and found.
    pub message: String,
}

impl DataError {
    /// An error at a place.
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            message: message.into(),
        }
    }
}

/// Any error of the runtime's GPU side.
#[derive(Debug, thiserror::Error)]
pub enum RuntimeError {
    /// The GPU.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The recipe or a module.
    #[error(transparent)]
    Compile(#[from] Report),
    /// The caller's values.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The evaluator on the CPU.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
}
