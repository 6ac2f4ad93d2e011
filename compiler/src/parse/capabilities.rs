//! What a text asks of a device, and what the linker does not take.

use std::ops::Range;
use std::sync::Arc;

use naga::valid::Capabilities;
use naga::{Handle, ShaderStage, TypeInner};

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
        found.get_or_insert((what, place_of(module, handle)));
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

/// Where a type without a place of its own is first used: by a variable of the module or of a function.
fn place_of(module: &naga::Module, ty: Handle<naga::Type>) -> naga::Span {
    let globals = module.global_variables.iter().filter(|(_, g)| g.ty == ty);
    let mut places = globals.map(|(handle, _)| module.global_variables.get_span(handle));
    let locals = |f: &naga::Function| {
        let found = f.local_variables.iter().find(|(_, l)| l.ty == ty);
        found.map(|(handle, _)| f.local_variables.get_span(handle))
    };
    let entries = || module.entry_points.iter().find_map(|e| locals(&e.function));
    let local = || module.functions.iter().find_map(|(_, f)| locals(f)).or_else(entries);
    places.next().or_else(local).unwrap_or_else(|| module.types.get_span(ty))
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
