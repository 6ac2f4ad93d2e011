//! The gate: nothing that has not passed naga's validator reaches emission or a GPU.

/// A linked module that naga's validator accepted, with all its checks on.
#[derive(Debug)]
pub struct Validated {
    module: naga::Module,
    info: naga::valid::ModuleInfo,
}

impl Validated {
    /// Validates a module that was not linked, for tests of the crates that execute them.
    ///
    /// # Errors
    /// The validator's words.
    #[doc(hidden)]
    pub fn of(module: naga::Module) -> Result<Self, String> {
        let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
        let info = validator.validate(&module).map_err(|error| error.into_inner().to_string())?;
        Ok(Self { module, info })
    }

    /// The IR, ready for `wgpu::ShaderSource::Naga`.
    pub fn module(&self) -> &naga::Module {
        &self.module
    }

    /// What the validator found out about it.
    pub fn info(&self) -> &naga::valid::ModuleInfo {
        &self.info
    }
}
