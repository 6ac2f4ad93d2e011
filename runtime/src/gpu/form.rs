//! The two forms in which a program can go to wgpu.

use std::borrow::Cow;

use shadewright_compiler::Validated;
use shadewright_compiler::program::Program;

/// In which of its two written forms a program goes to wgpu. They mean the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// naga's IR, so that nothing is written and parsed again.
    Ir,
    /// WGSL, which is what browsers take: [`Program::wgsl`], as its authors wrote it.
    Source,
}

impl Default for Form {
    /// The source form on the web, elsewhere the IR.
    fn default() -> Self {
        if cfg!(target_arch = "wasm32") { Self::Source } else { Self::Ir }
    }
}

impl Form {
    /// A program in this form.
    pub(super) fn of(self, program: &Program) -> wgpu::ShaderSource<'_> {
        match self {
            Self::Ir => ir(program.validated()),
            Self::Source => wgpu::ShaderSource::Wgsl(Cow::Borrowed(program.wgsl())),
        }
    }
}

/// A module as IR.
pub(super) fn ir(module: &Validated) -> wgpu::ShaderSource<'static> {
    wgpu::ShaderSource::Naga(Cow::Owned(module.module().clone()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a browser that is given what it has to have written as text first, and a driver that is given text to be parsed again.
    #[test]
    fn each_form_is_what_it_says() {
        let program = crate::gpu::testing::pass("@compute @workgroup_size(1) fn main() {}");
        assert!(matches!(Form::Ir.of(&program), wgpu::ShaderSource::Naga(_)));
        assert!(matches!(Form::Source.of(&program), wgpu::ShaderSource::Wgsl(text) if text == program.wgsl()));
        assert_eq!(crate::gpu::testing::gpu().form(), Form::Ir);
    }
}
