//! The gate: nothing that has not passed naga's validator reaches emission or a GPU.

mod located;

use naga::WithSpan;
use naga::valid::{Capabilities, ModuleInfo, ValidationError, ValidationFlags, Validator};

pub(crate) use located::located;

/// A linked module that naga's validator accepted, with all its checks on.
#[derive(Debug)]
pub struct Validated {
    module: naga::Module,
    info: ModuleInfo,
}

/// Validates a module with all of naga's checks, allowing all capabilities: which ones a target or device has is asked there.
///
/// # Errors
/// naga's validator refuses the module. The spans are those of the module's own expressions.
#[allow(clippy::result_large_err, reason = "it is returned once a link, and only when that fails")]
pub fn validate(module: naga::Module) -> Result<Validated, WithSpan<ValidationError>> {
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module)?;
    Ok(Validated { module, info })
}

impl Validated {
    /// The IR, ready for `wgpu::ShaderSource::Naga`.
    pub fn module(&self) -> &naga::Module {
        &self.module
    }

    /// What the validator found out about it.
    pub fn info(&self) -> &ModuleInfo {
        &self.info
    }
}
