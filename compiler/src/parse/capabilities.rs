//! What a text asks of a device, and what the linker does not take.

use std::ops::Range;
use std::sync::Arc;

use naga::valid::Capabilities;
use naga::{ShaderStage, TypeInner};

use crate::diagnostics::{Diagnostic, SourceFile, codes};
use crate::manifest::{Locator, Step};

/// What every WebGPU device has, so that no module need declare it.
pub const CORE: Capabilities = Capabilities::MULTISAMPLED_SHADING
    .union(Capabilities::CUBE_ARRAY_TEXTURES)
    .union(Capabilities::SHADER_FLOAT16_IN_FLOAT32);

/// Place of a span of the composed text in its author's file.
pub type Locate<'a> = dyn Fn(Range<usize>) -> Option<(&'a Arc<SourceFile>, Range<usize>)> + 'a;

/// Refuses what the linker does not carry over: ray tracing, cooperative matrices, mesh and task stages.
///
/// # Errors
/// The module has one of these.
pub fn linkable(module: &naga::Module, file: &Arc<SourceFile>, locate: &Locate) -> Result<(), Diagnostic> {
    let mut found = None;
    for (handle, ty) in module.types.iter() {
        let what = match ty.inner {
            TypeInner::AccelerationStructure { .. } | TypeInner::RayQuery { .. } => "ray tracing",
            TypeInner::CooperativeMatrix { .. } => "a cooperative matrix",
            _ => continue,
        };
        // The type's own place is where it is first written; a global's says more where it has none.
        let user = module
            .global_variables
            .iter()
            .find(|(_, g)| g.ty == handle)
            .map(|(h, _)| module.global_variables.get_span(h));
        found.get_or_insert((what, user.unwrap_or_else(|| module.types.get_span(handle))));
    }
    for entry in &module.entry_points {
        if !matches!(entry.stage, ShaderStage::Vertex | ShaderStage::Fragment | ShaderStage::Compute) {
            found.get_or_insert(("a stage other than vertex, fragment and compute", naga::Span::UNDEFINED));
        }
    }
    let Some((what, span)) = found else { return Ok(()) };
    let place = span.to_range().and_then(locate);
    let (file, span) = place.unwrap_or((file, 0..0));
    Err(Diagnostic::new(codes::NOT_LINKABLE, format!("{what} cannot be linked"))
        .at(file, span, "used here")
        .note("modules may use vertex, fragment and compute stages without ray tracing and cooperative matrices"))
}

/// Capabilities beyond the allowed ones without which a module does not pass.
pub fn missing(allowed: Capabilities, passes: impl Fn(Capabilities) -> bool) -> Capabilities {
    let others = Capabilities::all() - allowed;
    others.iter().filter(|&one| !passes(Capabilities::all() - one)).collect()
}

/// The error about them, without its place yet.
pub fn undeclared(missing: Capabilities, manifest: Option<&Arc<SourceFile>>) -> Diagnostic {
    let names: Vec<&str> = missing.iter_names().map(|(name, _)| name).collect();
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    let what = if names.len() == 1 { "capability" } else { "capabilities" };
    let diagnostic = Diagnostic::new(
        codes::CAPABILITY_UNDECLARED,
        format!("this needs the {what} {}, which nothing declares", quoted.join(", ")),
    );
    let Some(manifest) = manifest else {
        return diagnostic.note("an interface has to work on every device: leave this to the modules");
    };
    let places = Locator::new(&manifest.text);
    match places.find(&[Step::Key("capabilities")]) {
        Some(_) => diagnostic.note(format!("add {} to `capabilities` of `{}`", quoted.join(", "), manifest.name)),
        None => {
            let list: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
            diagnostic.note(format!("write `capabilities: [{}]` into `{}`", list.join(", "), manifest.name))
        }
    }
}
