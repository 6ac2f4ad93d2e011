//! The gate: nothing that has not passed naga's validator reaches emission or a GPU.

/// A linked module that naga's validator accepted, with all its checks on.
#[derive(Debug)]
pub struct Validated {
    module: naga::Module,
    info: naga::valid::ModuleInfo,
}

impl Validated {
    /// The IR, ready for `wgpu::ShaderSource::Naga`.
    pub fn module(&self) -> &naga::Module {
        &self.module
    }

    /// What the validator found out about it.
    pub fn info(&self) -> &naga::valid::ModuleInfo {
        &self.info
    }
}
