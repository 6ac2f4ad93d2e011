//! A validated module written in the languages that naga writes.
//!
//! Bindings keep their WGSL group and number where the language has both (SPIR-V: set and binding; HLSL: space and register).
//! The others number resources of one kind from 0, in the order of group and binding.

mod slots;

use std::collections::BTreeMap;
use std::error::Error;

use naga::back::{self, glsl, hlsl, msl, spv, wgsl};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ResourceBinding, ShaderStage};

use crate::diagnostics::{Diagnostic, Report, codes};
use crate::parse::{missing, readable};
use crate::upstream::guarded;
use crate::validate::{Validated, validate};

/// A language to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// WGSL as written by naga from the IR.
    WgslFromIr,
    /// SPIR-V 1.3 binary for Vulkan, with debug names.
    SpirV,
    /// GLSL 4.50, one entry point at a time.
    Glsl,
    /// HLSL, shader model 6.0.
    Hlsl,
    /// Metal Shading Language 2.4.
    Msl,
}

impl Target {
    /// All targets.
    pub const ALL: [Self; 5] = [Self::WgslFromIr, Self::SpirV, Self::Glsl, Self::Hlsl, Self::Msl];

    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::WgslFromIr => "WGSL",
            Self::SpirV => "SPIR-V",
            Self::Glsl => "GLSL",
            Self::Hlsl => "HLSL",
            Self::Msl => "MSL",
        }
    }

    /// What the target can express, as naga's writer for it says.
    pub fn capabilities(self) -> Capabilities {
        match self {
            Self::WgslFromIr => wgsl::supported_capabilities(),
            Self::SpirV => spv::supported_capabilities(),
            Self::Glsl => glsl::supported_capabilities(),
            Self::Hlsl => hlsl::supported_capabilities(),
            Self::Msl => msl::supported_capabilities(),
        }
    }
}

/// An index outside an array is moved inside, as WGSL promises; a texel outside a texture is some texel or zero.
const BOUNDS: BoundsCheckPolicies = BoundsCheckPolicies {
    index: BoundsCheckPolicy::Restrict,
    buffer: BoundsCheckPolicy::Restrict,
    image_load: BoundsCheckPolicy::Restrict,
    binding_array: BoundsCheckPolicy::Unchecked,
};

/// Writes the module. SPIR-V is binary (little-endian words), the others are UTF-8. Where `entry_point` names one, only it and
/// what it needs is written; else all. GLSL holds one entry point a file: `None` is taken there where the module has only one.
/// Pipeline-overridable constants take their defaults, but in WGSL, which keeps them.
///
/// # Errors
/// The target lacks something that the module needs, the entry point does not exist, or naga's writer fails.
pub fn emit(module: &Validated, target: Target, entry_point: Option<&str>) -> Result<Vec<u8>, Report> {
    let chosen = choose(module.module(), target, entry_point)?;
    let what = format!("writing {}", target.name());
    let written = guarded(codes::BACKEND_FAILURE, &what, || {
        supported(module.module(), target)?;
        write(module, target, chosen)
    });
    Ok(written??)
}

/// The entry point of this name.
fn choose<'a>(module: &'a Module, target: Target, name: Option<&str>) -> Result<Option<(ShaderStage, &'a str)>, Diagnostic> {
    let names = || module.entry_points.iter().map(|entry| entry.name.as_str());
    let Some(name) = name else {
        return match module.entry_points.as_slice() {
            [only] => Ok(Some((only.stage, &only.name))),
            _ if target != Target::Glsl => Ok(None),
            [] => Err(Diagnostic::new(codes::UNKNOWN_ENTRY_POINT, "the shader has no entry point")),
            _ => Err(
                Diagnostic::new(codes::UNKNOWN_ENTRY_POINT, "a file of GLSL holds one entry point: name it")
                    .note(format!("entry points: {}", names().collect::<Vec<_>>().join(", "))),
            ),
        };
    };
    let found = module.entry_points.iter().find(|entry| entry.name == name);
    found.map(|entry| Some((entry.stage, entry.name.as_str()))).ok_or_else(|| {
        Diagnostic::new(codes::UNKNOWN_ENTRY_POINT, format!("there is no entry point `{name}`")).suggest(name, "entry points", names())
    })
}

/// Whether the target can express what the module needs.
fn supported(module: &Module, target: Target) -> Result<(), Diagnostic> {
    let validator = |capabilities| Validator::new(ValidationFlags::all(), capabilities);
    let Err(error) = validator(target.capabilities()).validate(module) else {
        return Ok(());
    };
    let missing = missing(target.capabilities(), |set| validator(set).validate(module).is_ok());
    let names: Vec<String> = missing.iter_names().map(|(name, _)| format!("`{name}`")).collect();
    let mut diagnostic = unsupported(target, &readable(&causes(&error.into_inner()), module));
    if !names.is_empty() {
        diagnostic = diagnostic.note(format!("it lacks {}: leave out the modules that declare this", names.join(", ")));
    }
    Err(diagnostic)
}

fn unsupported(target: Target, reason: &str) -> Diagnostic {
    Diagnostic::new(
        codes::UNSUPPORTED_BY_TARGET,
        format!("{} cannot express this shader", target.name()),
    )
    .note(reason)
}

/// What a language says of a number type that it does not have.
fn no_scalar(scalar: naga::Scalar) -> String {
    let kind = match scalar.kind {
        naga::ScalarKind::Sint => "signed integer",
        naga::ScalarKind::Uint => "unsigned integer",
        naga::ScalarKind::Float => "floating-point",
        _ => "other",
    };
    format!("it has no {kind} numbers of {} bits", 8 * u32::from(scalar.width))
}

fn failed(target: Target, error: &dyn Error) -> Diagnostic {
    Diagnostic::new(codes::BACKEND_FAILURE, format!("the shader cannot be written as {}", target.name())).note(causes(error))
}

/// An error and what it says of its cause, and so on.
fn causes(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        // A transparent error repeats what it wraps.
        let next = cause.to_string();
        if !text.ends_with(&next) {
            text = format!("{text}: {next}");
        }
        source = cause.source();
    }
    text
}

fn write(validated: &Validated, target: Target, chosen: Option<(ShaderStage, &str)>) -> Result<Vec<u8>, Diagnostic> {
    if target == Target::WgslFromIr {
        return write_wgsl(validated, chosen);
    }
    let resolved =
        back::pipeline_constants::process_overrides(validated.module(), validated.info(), chosen, &back::PipelineConstants::default());
    let (module, info) = resolved.map_err(|error| failed(target, &error))?;
    match target {
        Target::WgslFromIr => write_wgsl(validated, chosen),
        Target::SpirV => write_spirv(&module, &info),
        // Slots are those of the whole module, so that stages written apart fit together.
        Target::Glsl => write_glsl(&module, &info, chosen, slots::glsl(validated.module())),
        Target::Hlsl => write_hlsl(&module, &info),
        Target::Msl => write_msl(&module, &info, slots::msl(validated.module())),
    }
}

fn write_wgsl(validated: &Validated, chosen: Option<(ShaderStage, &str)>) -> Result<Vec<u8>, Diagnostic> {
    let target = Target::WgslFromIr;
    let narrowed;
    let validated = match chosen {
        Some((stage, name)) if validated.module().entry_points.len() > 1 => {
            let mut module = validated.module().clone();
            module.entry_points.retain(|entry| entry.stage == stage && entry.name == name);
            naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
            narrowed = validate(module).map_err(|error| failed(target, error.as_inner()))?;
            &narrowed
        }
        _ => validated,
    };
    let text = wgsl::write_string(validated.module(), validated.info(), wgsl::WriterFlags::empty());
    text.map(String::into_bytes).map_err(|error| failed(target, &error))
}

fn write_spirv(module: &Module, info: &ModuleInfo) -> Result<Vec<u8>, Diagnostic> {
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::ADJUST_COORDINATE_SPACE
            | spv::WriterFlags::LABEL_VARYINGS
            | spv::WriterFlags::CLAMP_FRAG_DEPTH
            | spv::WriterFlags::DEBUG,
        bounds_check_policies: BOUNDS,
        ..spv::Options::default()
    };
    let words = spv::write_vec(module, info, &options, None).map_err(|error| match error {
        spv::Error::MissingCapabilities(..) | spv::Error::FeatureNotImplemented(_) | spv::Error::SpirvVersionTooLow(..) => {
            unsupported(Target::SpirV, &error.to_string())
        }
        _ => failed(Target::SpirV, &error),
    })?;
    Ok(words.into_iter().flat_map(u32::to_le_bytes).collect())
}

fn write_glsl(
    module: &Module,
    info: &ModuleInfo,
    chosen: Option<(ShaderStage, &str)>,
    slots: Option<BTreeMap<ResourceBinding, u8>>,
) -> Result<Vec<u8>, Diagnostic> {
    // `choose` leaves no GLSL without an entry point.
    let (shader_stage, name) = chosen.ok_or_else(|| Diagnostic::new(codes::UNKNOWN_ENTRY_POINT, "the shader has no entry point"))?;
    let options = glsl::Options {
        version: glsl::Version::Desktop(450),
        binding_map: slots.ok_or_else(|| unsupported(Target::Glsl, "more than 256 resources of one kind"))?,
        ..glsl::Options::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage,
        entry_point: name.to_owned(),
        multiview: None,
    };
    let explain = |error: glsl::Error| match error {
        glsl::Error::UnsupportedScalar(scalar) => unsupported(Target::Glsl, &no_scalar(scalar)),
        glsl::Error::MissingFeatures(_) | glsl::Error::ImageMultipleSamplers => unsupported(Target::Glsl, &error.to_string()),
        _ => failed(Target::Glsl, &error),
    };
    let mut text = String::new();
    let mut writer = glsl::Writer::new(&mut text, module, info, &options, &pipeline, BOUNDS).map_err(explain)?;
    writer.write().map_err(explain)?;
    Ok(text.into_bytes())
}

fn write_hlsl(module: &Module, info: &ModuleInfo) -> Result<Vec<u8>, Diagnostic> {
    // Bindings that the map lacks get the space of their group and the register of their number, which is what we want.
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V6_0,
        fake_missing_bindings: true,
        ..hlsl::Options::default()
    };
    let mut text = String::new();
    let pipeline = hlsl::PipelineOptions::default();
    let written = hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None);
    let names = written.map_err(|error| match error {
        hlsl::Error::UnsupportedScalar(scalar) => unsupported(Target::Hlsl, &no_scalar(scalar)),
        hlsl::Error::ShaderModelTooLow(..) | hlsl::Error::Unimplemented(_) => unsupported(Target::Hlsl, &error.to_string()),
        _ => failed(Target::Hlsl, &error),
    })?;
    for name in names.entry_point_names {
        name.map_err(|error| failed(Target::Hlsl, &error))?;
    }
    Ok(text.into_bytes())
}

fn write_msl(module: &Module, info: &ModuleInfo, slots: Option<msl::EntryPointResourceMap>) -> Result<Vec<u8>, Diagnostic> {
    let options = msl::Options {
        lang_version: (2, 4),
        per_entry_point_map: slots.ok_or_else(|| unsupported(Target::Msl, "more than 256 resources of one kind"))?,
        fake_missing_bindings: false,
        bounds_check_policies: BOUNDS,
        ..msl::Options::default()
    };
    let written = msl::write_string(module, info, &options, &msl::PipelineOptions::default());
    let (text, names) = written.map_err(|error| match error {
        msl::Error::CapabilityNotSupported(_) | msl::Error::UnsupportedBuiltIn(_) | msl::Error::UnsupportedAttribute(_) => {
            unsupported(Target::Msl, &error.to_string())
        }
        _ => failed(Target::Msl, &error),
    })?;
    for name in names.entry_point_names {
        name.map_err(|error| failed(Target::Msl, &error))?;
    }
    Ok(text.into_bytes())
}

#[cfg(test)]
mod tests;
