//! What a manifest can say wrong all by itself, without its WGSL and without the rest of the library.

use std::collections::HashMap;

use indexmap::IndexMap;
use naga::valid::Capabilities;

use super::Step::{self, Index, Key};
use super::{
    Arity, CategoryManifest, ModuleManifest, Param, ParamMode, ParamType, Parsed, PassDecl, Resource, ResourceKind, Typed, ValueError,
    typed,
};
use crate::diagnostics::{Diagnostic, Report, codes};

/// Highest bind group: 0 frame, 1 lights and shadows, 2 material, 3 pass.
pub const LAST_GROUP: u32 = 3;

/// Names that the linker gives to what it generates in a module's scope.
pub const GENERATED: [&str; 2] = ["params", "instances"];

/// Checks a category's declaration.
///
/// # Errors
/// All that is wrong, each at its place.
pub fn check_category(parsed: &Parsed<CategoryManifest>) -> Result<(), Report> {
    let mut found = Vec::new();
    group(parsed, &[Key("group")], parsed.value.group, &mut found);
    resources(parsed, &parsed.value.resources, &IndexMap::new(), &mut found);
    for (name, resource) in &parsed.value.resources {
        if matches!(resource.kind, ResourceKind::Data { .. }) {
            let path = [Key("resources"), Key(name), Key("kind")];
            let message = format!("`{name}` cannot be `Data`");
            found.push(
                parsed
                    .error_at(&path, codes::BAD_DATA_KIND, message, "in a category")
                    .note("a module has files in its folder; a category's resources are its modules' and the host's"),
            );
        }
    }
    Report::unless_empty(found)
}

/// Checks a module's declaration: names, parameters with their ranges and defaults, passes and the resources made from them.
///
/// # Errors
/// All that is wrong, each at its place.
pub fn check_module(parsed: &Parsed<ModuleManifest>) -> Result<(), Report> {
    let module = &parsed.value;
    let mut found = Vec::new();
    for (table, fields) in [("params", &module.params), ("instances", &module.instances)] {
        for (name, declared) in fields {
            identifier(parsed, &[Key(table), Key(name)], name, &mut found);
            param(parsed, [Key(table), Key(name)], declared, &mut found);
            // Fields of instances are always in a buffer, whatever their mode.
            if table == "params" {
                mode(parsed, [Key(table), Key(name)], declared, &mut found);
            } else if declared.ty == ParamType::Bool {
                let path = [Key(table), Key(name), Key("type")];
                found.push(
                    parsed
                        .error_at(
                            &path,
                            codes::BAD_MODE,
                            format!("`{name}` cannot be in a buffer"),
                            "WGSL has no `bool` there",
                        )
                        .note("make it a `U32`"),
                );
            }
        }
    }
    slots(parsed, &mut found);
    resources(parsed, &module.resources, &module.passes, &mut found);
    passes(parsed, &mut found);
    for (index, name) in module.capabilities.iter().enumerate() {
        if Capabilities::from_name(name).is_none() {
            let known = Capabilities::all().iter_names().map(|(name, _)| name);
            found.push(
                parsed
                    .error_at(
                        &[Key("capabilities"), Index(index)],
                        codes::UNKNOWN_CAPABILITY,
                        format!("there is no capability `{name}`"),
                        "unknown",
                    )
                    .suggest(name, "capabilities", known),
            );
        }
    }
    Report::unless_empty(found)
}

/// Whether WGSL takes a name as an identifier and it stays readable in the other languages: ASCII letters, digits and
/// underscores, no digit first, no two underscores first, and no word that WGSL reserves.
pub fn is_identifier(name: &str) -> bool {
    let first = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let rest = name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    first && rest && name != "_" && !name.starts_with("__") && !naga::keywords::wgsl::RESERVED.contains(&name)
}

/// Checks the name at the path's last key.
fn identifier<T>(parsed: &Parsed<T>, path: &[Step], name: &str, found: &mut Vec<Diagnostic>) {
    if is_identifier(name) {
        return;
    }
    let span = parsed.places.find_key(path).unwrap_or_else(|| parsed.places.find_near(path));
    let reserved = naga::keywords::wgsl::RESERVED.contains(&name);
    let label = if reserved {
        "a word that WGSL reserves"
    } else {
        "no WGSL identifier"
    };
    found.push(
        Diagnostic::new(codes::BAD_NAME, format!("`{name}` cannot be a name here"))
            .at(&parsed.file, span, label)
            .note("ASCII letters, digits and underscores, not a digit or two underscores first"),
    );
}

fn param<T>(parsed: &Parsed<T>, [table, name]: [Step; 2], declared: &Param, found: &mut Vec<Diagnostic>) {
    let Key(shown) = name else { return };
    if let Some((lo, hi)) = declared.range
        && !(lo < hi && lo.is_finite() && hi.is_finite())
    {
        let message = format!("the range of `{shown}` is empty");
        found.push(parsed.error_at(
            &[table, name, Key("range")],
            codes::BAD_RANGE,
            message,
            "the first number must be below the second",
        ));
        return;
    }
    for (unit, factor) in &declared.also {
        if !(factor.is_finite() && *factor > 0.0) || *unit == declared.unit {
            let label = if *unit == declared.unit {
                "this is the parameter's own unit"
            } else {
                "not a positive finite factor"
            };
            let message = format!("`{shown}` cannot be written in `{unit}`");
            found.push(parsed.error_at(&[table, name, Key("also"), Key(unit)], codes::BAD_UNIT, message, label));
            return;
        }
    }
    if let Err(error) = typed(declared, &declared.default) {
        let span = parsed.places.find_near(&[table, name, Key("default")]);
        let message = format!("the default of `{shown}` does not fit");
        found.push(error.diagnostic_as(codes::BAD_DEFAULT, message, &parsed.file, span));
    }
}

fn mode(parsed: &Parsed<ModuleManifest>, [table, name]: [Step; 2], declared: &Param, found: &mut Vec<Diagnostic>) {
    let Key(shown) = name else { return };
    if let Some(slot) = declared.filled_slot() {
        let known = parsed.value.slots.get(slot).is_some_and(|slot| slot.arity != Arity::Single);
        if !known || declared.mode != ParamMode::Constant || declared.ty != ParamType::Bool {
            found.push(
                parsed
                    .error_at(
                        &[table, name, Key("role")],
                        codes::BAD_MODE,
                        format!("`{shown}` cannot say whether `{slot}` is filled"),
                        "no such optional or list slot, or no constant `Bool`",
                    )
                    .note("declare it `type: Bool, default: false, mode: Constant`"),
            );
        }
        return;
    }
    let scalar = matches!(declared.ty, ParamType::F32 | ParamType::U32 | ParamType::I32 | ParamType::Bool);
    let (label, note) = match (declared.mode, declared.ty) {
        (ParamMode::Uniform, ParamType::Bool) => ("WGSL has no `bool` in uniform buffers", "add `mode: Override` or `mode: Constant`"),
        (ParamMode::Override, _) if !scalar => ("only scalars can be `Override`", "use `mode: Uniform` or `mode: Constant`"),
        _ => return,
    };
    let place = if declared.mode == ParamMode::Uniform { "type" } else { "mode" };
    let path = [table, name, Key(place)];
    found.push(
        parsed
            .error_at(&path, codes::BAD_MODE, format!("`{shown}` cannot reach the shader this way"), label)
            .note(note),
    );
}

fn slots(parsed: &Parsed<ModuleManifest>, found: &mut Vec<Diagnostic>) {
    let mut callers: HashMap<(&str, &str), &str> = HashMap::new();
    for (name, slot) in &parsed.value.slots {
        identifier(parsed, &[Key("slots"), Key(name)], name, found);
        if !slot.prefix.is_empty() && !is_identifier(&slot.prefix) {
            found.push(
                parsed
                    .error_at(
                        &[Key("slots"), Key(name), Key("prefix")],
                        codes::BAD_NAME,
                        format!("`{}` cannot begin a name", slot.prefix),
                        "no WGSL identifier",
                    )
                    .note("ASCII letters, digits and underscores, not a digit or two underscores first"),
            );
        }
        if let Some(other) = callers.insert((&slot.interface, &slot.prefix), name) {
            let at = |slot| parsed.places.find_key(&[Key("slots"), Key(slot)]).unwrap_or_default();
            found.push(
                Diagnostic::new(
                    codes::NAME_CLASH,
                    format!("calls to the slots `{other}` and `{name}` look the same"),
                )
                .at(&parsed.file, at(name), format!("functions of `{}`", slot.interface))
                .at(&parsed.file, at(other), "and here")
                .note("give one of them a `prefix`"),
            );
        }
    }
}

fn group<T>(parsed: &Parsed<T>, path: &[Step], number: u32, found: &mut Vec<Diagnostic>) {
    if number > LAST_GROUP {
        found.push(
            parsed
                .error_at(path, codes::BAD_GROUP, format!("there is no bind group {number}"), "too large")
                .note("groups: 0 frame, 1 lights and shadows, 2 material, 3 pass"),
        );
    }
}

fn resources<T>(
    parsed: &Parsed<T>,
    resources: &IndexMap<String, Resource>,
    passes: &IndexMap<String, PassDecl>,
    found: &mut Vec<Diagnostic>,
) {
    for (name, resource) in resources {
        let path = [Key("resources"), Key(name)];
        identifier(parsed, &path, name, found);
        if GENERATED.contains(&name.as_str()) {
            let span = parsed.places.find_key(&path).unwrap_or_default();
            found.push(
                Diagnostic::new(codes::NAME_CLASH, format!("a resource cannot be called `{name}`"))
                    .at(&parsed.file, span, "the linker declares this name")
                    .note("choose another name"),
            );
        }
        if let Some(number) = resource.group {
            group(parsed, &[path[0], path[1], Key("group")], number, found);
        }
        if let ResourceKind::Data { file, format } = &resource.kind {
            data(parsed, path, (file.as_deref(), format.is_some()), found);
        }
        if let ResourceKind::Depth { pass } | ResourceKind::Views { pass } = &resource.kind
            && !matches!(passes.get(pass), Some(PassDecl::Draw { .. }))
        {
            let draws = passes
                .iter()
                .filter(|(_, pass)| matches!(pass, PassDecl::Draw { .. }))
                .map(|(name, _)| name.as_str());
            let label = if passes.contains_key(pass) {
                "draws nothing"
            } else {
                "not declared"
            };
            found.push(
                parsed
                    .error_at(
                        &[path[0], path[1], Key("kind"), Key("pass")],
                        codes::UNKNOWN_PASS,
                        format!("there is no `Draw` pass `{pass}`"),
                        label,
                    )
                    .suggest(pass, "passes that draw", draws),
            );
        }
    }
}

fn data<T>(parsed: &Parsed<T>, [resources, name]: [Step; 2], (file, has_format): (Option<&str>, bool), found: &mut Vec<Diagnostic>) {
    let Key(shown) = name else { return };
    let kind = [resources, name, Key("kind")];
    match file {
        None if !has_format => found.push(
            parsed
                .error_at(
                    &kind,
                    codes::BAD_DATA_KIND,
                    format!("nothing fills `{shown}`"),
                    "neither `file` nor `format`",
                )
                .note("`Data(file: \"NAME.f32\")` is the module's own table, `Data(format: \"NAME\")` a file that a recipe names"),
        ),
        Some(file) if file.is_empty() || file == "." || file == ".." || file.contains(['/', '\\']) => found.push(
            parsed
                .error_at(
                    &[resources, name, Key("kind"), Key("file")],
                    codes::BAD_DATA_KIND,
                    format!("`{file}` is no file of the module's folder"),
                    "not a file's bare name",
                )
                .note("put the file beside `module.ron`"),
        ),
        _ => {}
    }
}

fn passes(parsed: &Parsed<ModuleManifest>, found: &mut Vec<Diagnostic>) {
    let params = &parsed.value.params;
    for (name, pass) in &parsed.value.passes {
        let path = [Key("passes"), Key(name)];
        identifier(parsed, &path, name, found);
        match pass {
            PassDecl::Draw { resolution, .. } => {
                if params.get(resolution).is_none_or(|param| param.ty != ParamType::U32) {
                    let wide = params
                        .iter()
                        .filter(|(_, param)| param.ty == ParamType::U32)
                        .map(|(name, _)| name.as_str());
                    let label = if params.contains_key(resolution) {
                        "not a `U32`"
                    } else {
                        "not declared"
                    };
                    found.push(
                        parsed
                            .error_at(
                                &[path[0], path[1], Key("resolution")],
                                codes::BAD_RESOLUTION,
                                format!("the pass `{name}` needs a `U32` parameter for its resolution"),
                                label,
                            )
                            .suggest(resolution, "`U32` parameters", wide),
                    );
                }
            }
            PassDecl::Compute { entry, .. } => {
                if !is_identifier(entry) {
                    found.push(parsed.error_at(
                        &[path[0], path[1], Key("entry")],
                        codes::BAD_NAME,
                        format!("`{entry}` cannot be an entry point"),
                        "no WGSL identifier",
                    ));
                }
            }
        }
    }
}

/// The constant that a parameter has where nothing is said.
///
/// # Errors
/// The manifest was not checked, and the default does not fit.
pub fn default_of(param: &Param) -> Result<Typed, ValueError> {
    typed(param, &param.default)
}

#[cfg(test)]
mod tests;
