//! A validated module written in the languages that naga writes.

use crate::diagnostics::Report;
use crate::validate::Validated;

/// A language to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// WGSL as written by naga from the IR.
    WgslFromIr,
    /// SPIR-V 1.3 binary for Vulkan.
    SpirV,
    /// GLSL ES 3.20 / 4.50, one entry point at a time.
    Glsl,
    /// HLSL, shader model 6.0.
    Hlsl,
    /// Metal Shading Language 2.4.
    Msl,
}

/// Writes the module. SPIR-V is binary, the others are UTF-8. GLSL holds one entry point a file:
/// `entry_point` names it and may be `None` where the module has only one.
///
/// # Errors
/// The target lacks something that the module needs, or the entry point does not exist.
pub fn emit(module: &Validated, target: Target, entry_point: Option<&str>) -> Result<Vec<u8>, Report> {
    let _ = (module, target, entry_point);
    Err(Report::from(crate::diagnostics::Diagnostic::new("SW0000", "not written yet")))
}
