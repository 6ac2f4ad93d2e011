//! The smallest recipes that draw a scene, and the frame that shows it.
//!
//! An object's recipe holds its own material with the maps it uses, and of the lights only the kinds that there are: lights of one module
//! that find their shadows alike are one kind. Where nothing casts a shadow, or a light casts none, no visibility module is named and the
//! light's own default (none) stands. Objects with equal recipes share one.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use indexmap::IndexMap;
use shadewright_compiler::diagnostics::{Diagnostic, codes};
use shadewright_compiler::manifest::{Filling, Node, ParamType, Step, Value};
use shadewright_compiler::{Catalog, Report};

use super::check::Examiner;
use super::gather::{Item, Look, as_choice, gather, slot_of};
use super::recipe::Planter;
use super::{Choice, Choices, LightDecl, SceneFile, view};
use crate::frame::{Draw, Frame, Lights, Material, Settings};

/// Most lights of a scene, those of glTF files included.
pub const MAX_LIGHTS: usize = 1024;
/// Longest side of a picture, pixels.
pub const MAX_SIZE: u32 = 16_384;

/// Lights of one kind.
struct Kind {
    choice: Choice,
    instances: Vec<IndexMap<String, Value>>,
}

/// Makes the frame; `size` instead of the scene's own, if given.
pub(super) fn derive(file: &SceneFile, catalog: &Catalog, size: Option<[u32; 2]>) -> Result<Frame, Report> {
    let scene = &file.parsed.value;
    let mut examiner = Examiner {
        parsed: &file.parsed,
        catalog,
        assets: super::assets::Assets::new(&file.folder, &file.files),
        errors: Vec::new(),
    };
    let size = size.unwrap_or(scene.size);
    if size.iter().any(|&side| side == 0 || side > MAX_SIZE) {
        let label = format!("both sides are between 1 and {MAX_SIZE}");
        examiner.error(
            &[Step::Key("size")],
            codes::SCENE_INVALID,
            "a picture of this size cannot be made",
            label,
        );
    }
    let background = Vec3::from(scene.background);
    if !background.is_finite() || background.min_element() < 0.0 {
        examiner.error(
            &[Step::Key("background")],
            codes::SCENE_INVALID,
            "the background is no light",
            "cd/m2, not negative",
        );
    }
    let pass_path = [Step::Key("pass")];
    examiner.choice(&scene.pass, Some("pass"), &pass_path);
    let Some(pass) = catalog.module(&scene.pass.module).ok().cloned() else {
        examiner.finish()?;
        return Err(Diagnostic::new(codes::UNKNOWN_MODULE, "the scene's pass does not exist").into());
    };

    let (items, looks, mut lights) = gather(&mut examiner, &pass);
    let camera = camera(&mut examiner, size);
    if lights.len() > MAX_LIGHTS {
        examiner.error(
            &[Step::Key("lights")],
            codes::SCENE_INVALID,
            format!("more than {MAX_LIGHTS} lights"),
            "too many",
        );
    }
    if !items.iter().any(|i| i.casts_shadow) {
        lights.iter_mut().for_each(|l| l.casts_shadow = false);
    }
    let kinds = kinds(&mut examiner, &lights);
    let display = display(&mut examiner);
    examiner.finish()?;

    let mut maker = Maker {
        catalog,
        pass: &scene.pass,
        lights_slot: slot_of(&pass, "light"),
        double_sided: pass.manifest.params.get("double_sided").is_some_and(|p| p.ty == ParamType::Bool),
        assets: examiner.assets,
        planter: Planter::default(),
        nodes: Vec::new(),
        recipes: Vec::new(),
        made: HashMap::new(),
        materials: Vec::new(),
    };
    maker.plant_lights(&kinds);
    let mut draws = Vec::new();
    for item in &items {
        let Some(bounds) = item.mesh.bounds().filter(|_| item.visible || item.casts_shadow) else {
            continue;
        };
        let mesh = if item.model.determinant() < 0.0 {
            maker.assets.mirrored(&item.mesh)
        } else {
            Arc::clone(&item.mesh)
        };
        draws.push(Draw {
            mesh,
            material: maker.material(&looks, item),
            model: item.model,
            bounds,
            visible: item.visible,
            alpha_blend: item.alpha_blend,
            double_sided: item.double_sided,
            casts_shadow: item.casts_shadow,
        });
    }
    let display = display.map(|choice| {
        let mut planter = Planter::default();
        let node = planter.plant(&choice, "main", catalog, &mut maker.assets);
        Material {
            recipe: Arc::new(node),
            settings: planter.settings,
        }
    });
    let lights = maker.nodes.iter().zip(kinds);
    Ok(Frame {
        camera: camera.ok_or_else(|| Diagnostic::new(codes::SCENE_INVALID, "the scene has no camera"))?,
        size,
        time: 0.0,
        background,
        lights: lights
            .map(|(node, kind)| Lights {
                node: node.clone(),
                instances: kind.instances,
            })
            .collect(),
        materials: maker.materials,
        draws,
        display,
    })
}

/// Groups lights by module and visibility, in the order of the first of each.
fn kinds(examiner: &mut Examiner, lights: &[LightDecl]) -> Vec<Kind> {
    let mut kinds: Vec<Kind> = Vec::new();
    for light in lights {
        let Ok(module) = examiner.catalog.module(&light.module) else {
            continue;
        };
        let mut choice = as_choice(light);
        if let (Some(visibility), Some(slot), true) = (&light.visibility, slot_of(module, "visibility"), light.casts_shadow) {
            choice.fill.insert(slot, Choices::One(Box::new(visibility.clone())));
        }
        match kinds.iter_mut().find(|kind| kind.choice == choice) {
            Some(kind) => kind.instances.push(light.fields.clone()),
            None => kinds.push(Kind {
                choice,
                instances: vec![light.fields.clone()],
            }),
        }
    }
    kinds
}

/// The camera that is declared, or the first of the first glTF file that has one.
fn camera(examiner: &mut Examiner, size: [u32; 2]) -> Option<crate::frame::Camera> {
    let scene = &examiner.parsed.value;
    if let Some(decl) = &scene.camera {
        return Some(view::camera(examiner, decl, size));
    }
    for (i, decl) in scene.gltf.iter().enumerate() {
        let Ok(asset) = examiner.assets.gltf(&decl.file) else { continue };
        let Some(camera) = asset.cameras.first() else { continue };
        let mut camera = camera.clone();
        camera.world = view::placed(decl.translate, decl.rotate, decl.scale) * camera.world;
        let made = view::gltf_camera(&camera, size);
        if made.is_none() {
            let path = [Step::Key("gltf"), Step::Index(i)];
            let message = format!("`{}`: the camera `{}` cannot be used", decl.file, camera.name);
            examiner.error(&path, codes::ASSET_UNSUPPORTED, message, "it is orthographic or not finite");
        }
        return made;
    }
    examiner.error(
        &[],
        codes::SCENE_INVALID,
        "the scene has no camera",
        "neither `camera` nor a glTF file with one",
    );
    None
}

/// The display pass with the post effects in its slot.
fn display(examiner: &mut Examiner) -> Option<Choice> {
    let scene = &examiner.parsed.value;
    let path = [Step::Key("display")];
    let Some(declared) = &scene.display else {
        if scene.post.is_some() {
            let message = "post effects without a display pass";
            examiner.error(&[Step::Key("post")], codes::SCENE_INVALID, message, "nothing would show them");
        }
        return None;
    };
    let mut choice = declared.clone();
    examiner.choice(declared, Some("pass"), &path);
    if let (Some(post), Ok(module)) = (&scene.post, examiner.catalog.module(&choice.module)) {
        let Some(slot) = slot_of(module, "post") else {
            let message = format!("`{}` has no slot for post effects", module.name);
            examiner.error(&[Step::Key("post")], codes::UNKNOWN_SLOT, message, "cannot stand anywhere");
            return None;
        };
        for (i, effect) in post.iter().enumerate() {
            examiner.choice(effect, Some("post"), &[Step::Key("post"), Step::Index(i)]);
        }
        choice.fill.insert(slot, Choices::Many(post.clone()));
    }
    Some(choice)
}

/// Makes each recipe once.
struct Maker<'a> {
    catalog: &'a Catalog,
    pass: &'a Choice,
    lights_slot: Option<String>,
    double_sided: bool,
    assets: super::assets::Assets,
    /// With the lights planted.
    planter: Planter,
    /// The lights' nodes, one for each kind.
    nodes: Vec<Node>,
    recipes: Vec<Arc<Node>>,
    made: HashMap<(usize, bool, bool), usize>,
    materials: Vec<Material>,
}

impl Maker<'_> {
    fn plant_lights(&mut self, kinds: &[Kind]) {
        if let Some(slot) = &self.lights_slot {
            let choices = Choices::Many(kinds.iter().map(|k| k.choice.clone()).collect());
            let place = format!("main.{slot}");
            self.nodes = self.planter.plant_list(&choices, &place, self.catalog, &mut self.assets);
        }
    }

    /// Index of the material for an object.
    fn material(&mut self, looks: &[Look], item: &Item) -> usize {
        let key = (item.look, item.receives_light, item.double_sided && self.double_sided);
        if let Some(&known) = self.made.get(&key) {
            return known;
        }
        let (mut planter, lights) = if item.receives_light {
            (self.planter.clone(), self.nodes.clone())
        } else {
            (Planter::default(), Vec::new())
        };
        let mut root = self.pass.clone();
        for (slot, choices) in &looks[item.look] {
            root.fill.insert(slot.clone(), choices.clone());
        }
        if key.2 {
            root.freeze.insert("double_sided".to_owned(), Value::Bool(true));
        }
        let mut node = planter.plant(&root, "main", self.catalog, &mut self.assets);
        if let Some(slot) = &self.lights_slot {
            node.fill.insert(slot.clone(), Filling::Many(lights));
        }
        let recipe = match self.recipes.iter().find(|known| ***known == node) {
            Some(known) => Arc::clone(known),
            None => {
                self.recipes.push(Arc::new(node));
                Arc::clone(&self.recipes[self.recipes.len() - 1])
            }
        };
        self.materials.push(Material {
            recipe,
            settings: Settings {
                params: planter.settings.params,
                textures: planter.settings.textures,
                data: planter.settings.data,
            },
        });
        self.made.insert(key, self.materials.len() - 1);
        self.materials.len() - 1
    }
}
