//! Whole glTF files: their words, by way of the manifests, to choices of modules.

use std::sync::Arc;

use glam::{Mat4, Vec3};
use indexmap::IndexMap;
use shadewright_compiler::Module;
use shadewright_compiler::diagnostics::{Diagnostic, codes};
use shadewright_compiler::manifest::{ResourceKind, Step, Value};

use super::check::Examiner;
use super::{Choice, Choices, GltfDecl, LightDecl, Picture};
use crate::mesh::gltf::{Alpha, Light, Material};

/// The texture whose light from all sides no module here has.
const OCCLUSION: &str = "gltf:occlusionTexture";

/// The module that represents a thing of glTF.
pub(super) fn representing(examiner: &mut Examiner, decl: &GltfDecl, thing: &str, place: &str, path: &[Step]) -> Option<Arc<Module>> {
    if let Some(named) = decl.modules.get(thing) {
        return examiner.module(named, &super::check::join(path, &[Step::Key("modules")]));
    }
    let fitting: Vec<Arc<Module>> = examiner
        .catalog
        .modules()
        .filter(|m| m.manifest.represents.iter().any(|r| r == thing))
        .cloned()
        .collect();
    if let [only] = fitting.as_slice() {
        return Some(Arc::clone(only));
    }
    let span = examiner.parsed.places.find_near(path);
    let error = Diagnostic::new(
        codes::ASSET_UNSUPPORTED,
        format!("`{}`: no single module stands for `{thing}`", decl.file),
    )
    .at(&examiner.parsed.file, span, place.to_owned());
    examiner.errors.push(if fitting.is_empty() {
        error.note(format!("a module whose manifest says `represents: [\"{thing}\"]` would draw it"))
    } else {
        let names: Vec<&str> = fitting.iter().map(|m| m.name.as_str()).collect();
        error.note(format!(
            "name one of {} under `modules`: {{\"{thing}\": \"{}\"}}",
            names.join(", "),
            names[0]
        ))
    });
    None
}

/// What keeps a module from standing for a material: the names of factors and textures that it has nothing for.
fn lacking<'m>(module: &Module, material: &'m Material) -> Vec<&'m str> {
    let has_param = |role: &str| module.manifest.params.values().any(|p| p.role.as_deref() == Some(role));
    let has_slot = |thing: &str| module.manifest.slots.values().any(|s| s.represents.contains_key(thing));
    let factors = material
        .factors
        .iter()
        .filter(|(name, value)| !has_param(name) && !is_neutral(name, value));
    let maps = material.maps.keys().filter(|name| !has_slot(name) && **name != OCCLUSION);
    factors.map(|(name, _)| *name).chain(maps.copied()).collect()
}

/// The module for a material: the one that is named; else, of those that represent materials, the one that lacks least of what this one has, and of
/// such the one with the fewest parameters.
fn material_module(examiner: &mut Examiner, decl: &GltfDecl, material: &Material, place: &str, path: &[Step]) -> Option<Arc<Module>> {
    const THING: &str = "gltf:material";
    if decl.modules.contains_key(THING) {
        return representing(examiner, decl, THING, place, path);
    }
    let cost = |m: &Module| (lacking(m, material).len(), m.manifest.params.len());
    let fitting = examiner
        .catalog
        .modules()
        .filter(|m| m.manifest.represents.iter().any(|r| r == THING));
    let mut fitting: Vec<(_, &Arc<Module>)> = fitting.map(|m| (cost(m), m)).collect();
    fitting.sort_by_key(|(cost, _)| *cost);
    match fitting.as_slice() {
        [(best, module), (next, _), ..] if best < next => Some(Arc::clone(module)),
        // None, one, or several that are alike.
        _ => representing(examiner, decl, THING, place, path),
    }
}

/// A file's material as a choice of the module that represents materials.
pub(super) fn material(examiner: &mut Examiner, decl: &GltfDecl, material: &Material, path: &[Step]) -> Option<(Arc<Module>, Choice)> {
    let place = format!("the material `{}`", material.name);
    let module = material_module(examiner, decl, material, &place, path)?;
    let mut choice = Choice::new(module.name.clone());
    let used: Vec<&str> = by_role(&mut choice, &module, &material.factors);
    let unread = |examiner: &mut Examiner, module: &Module, name: &str| {
        let message = format!("`{}`: `{}` has no parameter for {name}", decl.file, module.name);
        examiner.error(path, codes::ASSET_UNSUPPORTED, message, place.clone());
    };
    for (name, used_map) in &material.maps {
        let slot = module
            .manifest
            .slots
            .iter()
            .find_map(|(slot, s)| Some((slot, s.represents.get(*name)?)));
        let Some((slot, filler)) = slot else {
            if *name == OCCLUSION {
                // It darkens only what comes from all sides; light from lamps and the sun is not its business.
                log::warn!("`{}`: {place}: {name} has no module and is left out", decl.file);
                continue;
            }
            let message = format!("`{}`: `{}` has no slot for {name}", decl.file, module.name);
            examiner.error(path, codes::ASSET_UNSUPPORTED, message, place.clone());
            continue;
        };
        let Some(filler) = examiner.module(filler, path) else {
            continue;
        };
        let mut map = Choice::new(filler.name.clone());
        let used = by_role(&mut map, &filler, &used_map.factors);
        for (name, value) in &used_map.factors {
            if !used.contains(name) && !is_neutral(name, value) {
                unread(examiner, &filler, name);
            }
        }
        let texture_of = filler
            .manifest
            .resources
            .iter()
            .find(|(_, r)| matches!(r.kind, ResourceKind::Texture { .. }));
        if let Some((resource, _)) = texture_of {
            map.textures
                .insert(resource.clone(), Picture::Loaded(Arc::clone(&used_map.texture)));
        }
        choice.fill.insert(slot.clone(), Choices::One(Box::new(map)));
    }
    for (name, value) in &material.factors {
        if !used.contains(name) && !is_neutral(name, value) {
            unread(examiner, &module, name);
        }
    }
    if let Alpha::Blend = material.alpha {
        log::debug!("`{}`: {place} is blended", decl.file);
    } else if choice
        .params
        .iter()
        .any(|(name, _)| role_of(&module, name) == Some("gltf:baseColorFactor.a"))
    {
        // Without blending alpha means nothing.
        choice
            .params
            .retain(|name, _| role_of(&module, name) != Some("gltf:baseColorFactor.a"));
    }
    Some((module, choice))
}

fn role_of<'m>(module: &'m Module, param: &str) -> Option<&'m str> {
    module.manifest.params.get(param)?.role.as_deref()
}

/// Values that leave the picture as it is, so that a module needs no parameter for them.
fn is_neutral(name: &str, value: &Value) -> bool {
    match (name, value) {
        ("gltf:emissiveFactor", Value::List(rgb)) => rgb.iter().all(|&x| x == 0.0),
        ("gltf:baseColorFactor", Value::List(rgb)) => rgb.iter().all(|&x| x == 1.0),
        (_, Value::Number(x)) => *x == 1.0,
        _ => false,
    }
}

/// Sets the parameters whose roles are among the factors; the roles that were found.
fn by_role<'f>(choice: &mut Choice, module: &Module, factors: &IndexMap<&'f str, Value>) -> Vec<&'f str> {
    let mut used = Vec::new();
    for (name, param) in &module.manifest.params {
        let found = param.role.as_deref().and_then(|role| factors.get_key_value(role));
        if let Some((role, value)) = found {
            choice.params.insert(name.clone(), value.clone());
            used.push(*role);
        }
    }
    used
}

/// A file's light as a declaration. `world` is where the file is placed.
pub(super) fn light(examiner: &mut Examiner, decl: &GltfDecl, light: &Light, world: &Mat4, path: &[Step]) -> Option<LightDecl> {
    let place = format!("the light `{}`", light.name);
    let module = representing(examiner, decl, light.kind, &place, path)?;
    let moved = |value: &Value, how: &dyn Fn(Vec3) -> Vec3| match value {
        Value::List(v) if v.len() == 3 => {
            let p = how(Vec3::new(v[0] as f32, v[1] as f32, v[2] as f32));
            Value::List(p.to_array().map(f64::from).to_vec())
        }
        other => other.clone(),
    };
    let mut fields = IndexMap::new();
    for (role, value) in &light.fields {
        let field = module.manifest.instances.iter().find(|(_, p)| p.role.as_deref() == Some(role));
        let Some((field, _)) = field else {
            let message = format!("`{}`: `{}` has no field for {role}", decl.file, module.name);
            examiner.error(path, codes::ASSET_UNSUPPORTED, message, place.clone());
            continue;
        };
        let value = match *role {
            "position" => moved(value, &|p| world.transform_point3(p)),
            "direction" => moved(value, &|d| world.transform_vector3(d).normalize_or(Vec3::NEG_Y)),
            _ => value.clone(),
        };
        fields.insert(field.clone(), value);
    }
    Some(LightDecl {
        name: Some(light.name.clone()),
        module: module.name.clone(),
        fields,
        fill: IndexMap::new(),
        freeze: IndexMap::new(),
        params: IndexMap::new(),
        files: IndexMap::new(),
        visibility: decl.visibility.get(light.kind).cloned(),
        casts_shadow: true,
    })
}
