//! What a scene and its glTF files hold, checked and brought together.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Mat4;
use indexmap::IndexMap;
use shadewright_compiler::Module;
use shadewright_compiler::diagnostics::{Diagnostic, codes};
use shadewright_compiler::manifest::{Step, Value, typed};

use super::check::{Examiner, join};
use super::{Choice, Choices, LightDecl, include, layers, view};
use crate::frame::Mesh;
use crate::mesh::gltf::Alpha;

/// What is said of an object beside its triangles.
pub(super) struct Item {
    pub mesh: Arc<Mesh>,
    /// Index into the looks.
    pub look: usize,
    pub model: Mat4,
    pub visible: bool,
    pub alpha_blend: bool,
    pub double_sided: bool,
    pub casts_shadow: bool,
    pub receives_light: bool,
}

/// What fills the pass's slots for a material.
pub(super) type Look = IndexMap<String, Choices>;

/// The slot of a module that takes modules of this category.
pub(super) fn slot_of(module: &Module, interface: &str) -> Option<String> {
    let found = module.manifest.slots.iter().find(|(_, slot)| slot.interface == interface);
    found.map(|(name, _)| name.clone())
}

/// Checks and collects what the scene and its glTF files hold.
pub(super) fn gather(examiner: &mut Examiner, pass: &Module) -> (Vec<Item>, Vec<Look>, Vec<LightDecl>) {
    let scene = &examiner.parsed.value;
    let slots = &pass.manifest.slots;
    let mut meshes: HashMap<&str, Arc<Mesh>> = HashMap::new();
    for (name, shape) in &scene.meshes {
        match examiner.assets.mesh(shape) {
            Ok(mesh) => {
                meshes.insert(name, mesh);
            }
            Err(error) => {
                let code = super::code_of(&error);
                let path = [Step::Key("meshes"), Step::Key(name)];
                examiner.error(&path, code, format!("the mesh `{name}` cannot be made"), error.to_string());
            }
        }
    }
    let mut looks: Vec<Look> = Vec::new();
    for (name, look) in &scene.materials {
        examiner.fill(look, pass, slots, &[Step::Key("materials"), Step::Key(name)]);
        looks.push(look.clone());
    }
    let mut items = Vec::new();
    for (i, object) in scene.objects.iter().enumerate() {
        let path = [Step::Key("objects"), Step::Index(i)];
        let model = view::transform(examiner, &path, object.translate, object.rotate, object.scale);
        let mesh = meshes.get(object.mesh.as_str()).cloned();
        if mesh.is_none() && !scene.meshes.contains_key(&object.mesh) {
            unknown(
                examiner,
                &join(&path, &[Step::Key("mesh")]),
                "mesh",
                &object.mesh,
                scene.meshes.keys(),
            );
        }
        let look = scene.materials.get_index_of(&object.material);
        if look.is_none() {
            let at = join(&path, &[Step::Key("material")]);
            unknown(examiner, &at, "material", &object.material, scene.materials.keys());
        }
        if let (Some(mesh), Some(look)) = (mesh, look) {
            items.push(Item {
                mesh,
                look,
                model,
                visible: object.visible,
                alpha_blend: object.alpha_blend,
                double_sided: object.double_sided,
                casts_shadow: object.casts_shadow,
                receives_light: object.receives_light,
            });
        }
    }
    for (i, light) in scene.lights.iter().enumerate() {
        check_light(examiner, light, &[Step::Key("lights"), Step::Index(i)]);
    }
    let mut lights = scene.lights.clone();
    for i in 0..scene.gltf.len() {
        include_file(examiner, pass, i, &mut items, &mut looks, &mut lights);
    }
    (items, looks, lights)
}

fn include_file(
    examiner: &mut Examiner,
    pass: &Module,
    index: usize,
    items: &mut Vec<Item>,
    looks: &mut Vec<Look>,
    lights: &mut Vec<LightDecl>,
) {
    let decl = &examiner.parsed.value.gltf[index];
    let path = [Step::Key("gltf"), Step::Index(index)];
    examiner.fill(&decl.fill, pass, &pass.manifest.slots, &join(&path, &[Step::Key("fill")]));
    for (kind, choice) in &decl.visibility {
        examiner.choice(
            choice,
            Some("visibility"),
            &join(&path, &[Step::Key("visibility"), Step::Key(kind)]),
        );
    }
    let world = view::transform(examiner, &path, decl.translate, decl.rotate, decl.scale);
    let asset = match examiner.assets.gltf(&decl.file) {
        Ok(asset) => asset,
        Err(error) => {
            let code = super::code_of_gltf(&error);
            let at = join(&path, &[Step::Key("file")]);
            examiner.error(&at, code, format!("`{}` cannot be drawn", decl.file), error.to_string());
            return;
        }
    };
    let first = looks.len();
    for material in &asset.materials {
        let mut look = decl.fill.clone();
        if let Some((module, choice)) = include::material(examiner, decl, material, &path) {
            examiner.choice(&choice, Some(&module.category), &path);
            if let Some(slot) = slot_of(pass, &module.category) {
                look.insert(slot, Choices::One(Box::new(choice)));
            }
            layers::lay(examiner, decl, material, pass, &mut look, &path);
        }
        looks.push(look);
    }
    for object in &asset.objects {
        let model = world * object.model;
        // A file hides things by shrinking them to nothing.
        if !model.inverse().is_finite() {
            continue;
        }
        let material = &asset.materials[object.material];
        items.push(Item {
            mesh: Arc::clone(&object.mesh),
            look: first + object.material,
            model,
            visible: true,
            alpha_blend: material.alpha == Alpha::Blend,
            double_sided: material.double_sided,
            casts_shadow: true,
            receives_light: true,
        });
    }
    if decl.lights {
        for light in &asset.lights {
            let made = include::light(examiner, decl, light, &world, &path);
            if let Some(made) = &made {
                check_light(examiner, made, &path);
            }
            lights.extend(made);
        }
    }
}

fn unknown<'n>(examiner: &mut Examiner, path: &[Step], what: &str, name: &str, known: impl Iterator<Item = &'n String>) {
    let span = examiner.parsed.places.find_near(path);
    examiner.errors.push(
        Diagnostic::new(codes::UNKNOWN_SCENE_NAME, format!("the scene has no {what} `{name}`"))
            .at(&examiner.parsed.file, span, format!("no such {what}"))
            .suggest(name, what, known.map(String::as_str)),
    );
}

fn check_light(examiner: &mut Examiner, light: &LightDecl, path: &[Step]) {
    // The declaration is a choice with fields: it is checked as one.
    examiner.choice(&as_choice(light), Some("light"), path);
    let Ok(module) = examiner.catalog.module(&light.module).cloned() else {
        return;
    };
    let fields = join(path, &[Step::Key("fields")]);
    examiner.values(&light.fields, &module, &module.manifest.instances, &fields);
    for (name, param) in &module.manifest.instances {
        let value = light.fields.get(name).unwrap_or(&param.default);
        let zero = |v: &Value| matches!(v, Value::List(v) if v.iter().all(|&x| x == 0.0));
        if param.role.as_deref() == Some("direction") && typed(param, value).is_ok() && zero(value) {
            let at = join(&fields, &[Step::Key(name)]);
            examiner.error(&at, codes::SCENE_INVALID, "the light has no direction", "all components are 0");
        }
    }
    let at = join(path, &[Step::Key("visibility")]);
    if let Some(visibility) = &light.visibility {
        if slot_of(&module, "visibility").is_none() {
            let message = format!("`{}` has no slot for visibility", module.name);
            examiner.error(&at, codes::UNKNOWN_SLOT, message, "cannot stand anywhere");
        }
        examiner.choice(visibility, Some("visibility"), &at);
    }
}

/// A light's kind without what fills its slot for visibility.
pub(super) fn as_choice(light: &LightDecl) -> Choice {
    Choice {
        module: light.module.clone(),
        fill: light.fill.clone(),
        freeze: light.freeze.clone(),
        params: light.params.clone(),
        files: light.files.clone(),
        ..Choice::default()
    }
}
