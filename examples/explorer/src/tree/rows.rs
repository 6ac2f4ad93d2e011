//! A scene's rows.

use std::sync::Arc;

use indexmap::IndexMap;
use shadewright_compiler::manifest::{Arity, Filling, Node, Slot};
use shadewright_compiler::{Catalog, Module};
use shadewright_runtime::scene::{Choice, Choices, LightDecl, Scene, SceneFile};

use super::{Kind, Part, Row, may_be_empty, slot_of};
use crate::document::{Ancestor, Parked, ron_of, step_path};

/// Deeper trees are cut off: only defaults that go round in a circle get there.
const MOST_DEPTH: usize = 64;

/// All rows of a scene, parents first. Modules that do not exist have none below them.
pub fn rows(scene: &SceneFile, catalog: &Catalog, parked: &[Parked]) -> Vec<Row> {
    let mut maker = Maker {
        scene: scene.scene(),
        catalog,
        parked,
        rows: Vec::new(),
    };
    maker.view();
    maker.materials();
    maker.lights();
    maker.objects();
    maker.display();
    maker.rows
}

struct Maker<'s> {
    scene: &'s Scene,
    catalog: &'s Catalog,
    parked: &'s [Parked],
    rows: Vec<Row>,
}

/// Where slots are filled.
struct Holder<'h> {
    fill: &'h IndexMap<String, Choices>,
    /// Path of the filling of a slot.
    path: &'h dyn Fn(&str) -> String,
    /// Defaults on the way.
    above: Vec<Ancestor>,
    depth: usize,
    /// Whose slots are shown elsewhere.
    skip: Option<String>,
}

impl Maker<'_> {
    fn push(&mut self, path: impl Into<String>, depth: usize, kind: Kind, label: impl Into<String>) -> &mut Row {
        self.rows.push(Row {
            path: path.into(),
            depth,
            kind,
            label: label.into(),
            module: None,
            is_stated: true,
            above: Vec::new(),
            through: Vec::new(),
        });
        let last = self.rows.len() - 1;
        &mut self.rows[last]
    }

    fn heading(&mut self, path: &str, part: Part) {
        self.push(path, 0, Kind::Heading(part), part.name());
    }

    /// The module that a name means in a slot.
    fn module(&self, interface: &str, name: &str) -> Option<Arc<Module>> {
        self.catalog.module_for(interface, name).ok().cloned()
    }

    fn pass(&self) -> Option<Arc<Module>> {
        self.module("pass", &self.scene.pass.module)
    }

    fn view(&mut self) {
        self.heading("camera", Part::View);
        let module = self.pass();
        let kind = Kind::Slot {
            interface: "pass".into(),
            may_be_empty: false,
            doc: "The pass that draws the objects".into(),
        };
        self.push("pass", 1, kind, "pass").module = module;
    }

    fn materials(&mut self) {
        self.heading("materials", Part::Materials);
        let Some(pass) = self.pass() else { return };
        let skip = slot_of(&pass, "light").map(|(name, _)| name.clone());
        let scene = self.scene;
        for (name, fill) in &scene.materials {
            let path = format!("materials{}", step_path(name));
            self.push(&path, 1, Kind::Material, name);
            self.of_pass(&pass, fill, &path, skip.clone());
        }
    }

    /// The pass's slots as a material or a glTF file fills them.
    fn of_pass(&mut self, pass: &Arc<Module>, fill: &IndexMap<String, Choices>, path: &str, skip: Option<String>) {
        let holder = Holder {
            fill,
            path: &|slot| format!("{path}{}", step_path(slot)),
            above: Vec::new(),
            depth: 2,
            skip,
        };
        let inherited = self.scene.pass.fill.clone();
        self.slots(pass, &holder, &inherited);
    }

    fn lights(&mut self) {
        self.heading("lights", Part::Lights);
        let scene = self.scene;
        for (index, light) in scene.lights.iter().enumerate() {
            self.light(light, index, scene.lights.len());
        }
        self.parked("lights", 1);
    }

    fn light(&mut self, light: &LightDecl, index: usize, of: usize) {
        let path = format!("lights[{index}]");
        let module = self.module("light", &light.module);
        let kind = Kind::Element {
            list: "lights".into(),
            index,
            of,
            interface: "light".into(),
        };
        let label = light.name.clone().unwrap_or_else(|| format!("light {}", index + 1));
        self.push(&path, 1, kind, label).module.clone_from(&module);
        let Some(module) = module else { return };
        // Visibility stands beside the fill.
        let seen = slot_of(&module, "visibility").map(|(name, _)| name.clone());
        let mut fill = light.fill.clone();
        if let (Some(slot), Some(visibility)) = (&seen, &light.visibility) {
            fill.insert(slot.clone(), Choices::One(Box::new(visibility.clone())));
        }
        let holder = Holder {
            fill: &fill,
            path: &|slot| match &seen {
                Some(seen) if seen == slot => format!("{path}.visibility"),
                _ => format!("{path}.fill{}", step_path(slot)),
            },
            above: Vec::new(),
            depth: 2,
            skip: None,
        };
        self.slots(&module, &holder, &IndexMap::new());
    }

    fn objects(&mut self) {
        self.heading("objects", Part::Objects);
        let scene = self.scene;
        for (index, object) in scene.objects.iter().enumerate() {
            let label = object.name.clone().unwrap_or_else(|| format!("{} {}", object.mesh, index + 1));
            self.push(format!("objects[{index}]"), 1, Kind::Object { index }, label);
        }
        for (index, gltf) in scene.gltf.iter().enumerate() {
            let path = format!("gltf[{index}]");
            self.push(&path, 1, Kind::Gltf { index }, gltf.file.clone());
            if let Some(pass) = self.pass() {
                let skip = slot_of(&pass, "light").map(|(name, _)| name.clone());
                self.of_pass(&pass, &gltf.fill, &format!("{path}.fill"), skip);
            }
        }
    }

    fn display(&mut self) {
        self.heading("display", Part::Display);
        let Some(display) = &self.scene.display else { return };
        let Some(module) = self.module("pass", &display.module) else {
            return;
        };
        let scene = self.scene;
        let post = slot_of(&module, "post").map(|(name, _)| name.clone());
        let holder = Holder {
            fill: &display.fill,
            path: &|slot| format!("display.fill{}", step_path(slot)),
            above: Vec::new(),
            depth: 1,
            skip: post.clone(),
        };
        self.slots(&module, &holder, &IndexMap::new());
        if post.is_some() {
            let effects = scene.post.as_deref().unwrap_or_default();
            let kind = Kind::List {
                interface: "post".into(),
                doc: "What happens to the frame before it is displayed, in order".into(),
            };
            let none = Ancestor {
                path: "post".into(),
                text: "[]".into(),
            };
            let row = self.push("post", 1, kind, "post");
            row.through = vec![none];
            self.list("post", "post", effects, true, &[], 2);
        }
    }

    /// The rows of a module's slots. `inherited` fills what the holder does not.
    fn slots(&mut self, module: &Module, holder: &Holder, inherited: &IndexMap<String, Choices>) {
        if holder.depth > MOST_DEPTH {
            return;
        }
        for (name, slot) in &module.manifest.slots {
            if holder.skip.as_ref() == Some(name) {
                continue;
            }
            let path = (holder.path)(name);
            let stated = holder.fill.get(name);
            let default = || inherited.get(name).cloned().or_else(|| slot.default.as_ref().map(Choices::from));
            let choices = stated.cloned().or_else(default);
            if slot.arity == Arity::List {
                let kind = Kind::List {
                    interface: slot.interface.clone(),
                    doc: slot.doc.clone(),
                };
                let above = holder.above.clone();
                let elements = choices.as_ref().map(Choices::all).unwrap_or_default().to_vec();
                let mut through = above.clone();
                if stated.is_none() {
                    let texts: Vec<String> = elements.iter().map(|element| ron_of(&node_of(element))).collect();
                    through.push(Ancestor {
                        path: path.clone(),
                        text: format!("[{}]", texts.join(", ")),
                    });
                }
                let row = self.push(&path, holder.depth, kind, name);
                (row.is_stated, row.above, row.through) = (stated.is_some(), above, through.clone());
                self.list(&path, &slot.interface, &elements, stated.is_some(), &through, holder.depth + 1);
            } else {
                self.single(name, slot, path, choices, stated.is_some(), holder);
            }
        }
    }

    fn single(&mut self, name: &str, slot: &Slot, path: String, choices: Option<Choices>, is_stated: bool, holder: &Holder) {
        let kind = Kind::Slot {
            interface: slot.interface.clone(),
            may_be_empty: may_be_empty(slot),
            doc: slot.doc.clone(),
        };
        let choice = choices.as_ref().and_then(|choices| choices.all().first());
        let module = choice.and_then(|choice| self.module(&slot.interface, &choice.module));
        let above = holder.above.clone();
        let mut through = above.clone();
        if let (false, Some(choice)) = (is_stated, choice) {
            through.push(Ancestor {
                path: path.clone(),
                text: ron_of(&node_of(choice)),
            });
        }
        let row = self.push(&path, holder.depth, kind, name);
        (row.is_stated, row.above) = (is_stated, above);
        (row.module, row.through) = (module.clone(), through.clone());
        if let (Some(choice), Some(module)) = (choice, module) {
            self.below(choice, &module, &path, through, holder.depth + 1);
        }
    }

    /// What fills the slots of a chosen module.
    fn below(&mut self, choice: &Choice, module: &Module, path: &str, above: Vec<Ancestor>, depth: usize) {
        let holder = Holder {
            fill: &choice.fill,
            path: &|slot| format!("{path}.fill{}", step_path(slot)),
            above,
            depth,
            skip: None,
        };
        self.slots(module, &holder, &IndexMap::new());
    }

    fn list(&mut self, list: &str, interface: &str, elements: &[Choice], is_stated: bool, through: &[Ancestor], depth: usize) {
        for (index, choice) in elements.iter().enumerate() {
            let path = format!("{list}[{index}]");
            let module = self.module(interface, &choice.module);
            let kind = Kind::Element {
                list: list.to_owned(),
                index,
                of: elements.len(),
                interface: interface.to_owned(),
            };
            let row = self.push(&path, depth, kind, (index + 1).to_string());
            (row.is_stated, row.above, row.through) = (is_stated, through.to_vec(), through.to_vec());
            row.module.clone_from(&module);
            if let Some(module) = module {
                self.below(choice, &module, &path, through.to_vec(), depth + 1);
            }
        }
        self.parked(list, depth);
    }

    /// What of a list is switched off.
    fn parked(&mut self, list: &str, depth: usize) {
        let parked = self.parked;
        for (which, element) in parked.iter().enumerate().filter(|(_, parked)| parked.list == list) {
            let label = label_of(&element.text).unwrap_or_else(|| "switched off".to_owned());
            // Where the list itself is gone it is made again.
            let list = Ancestor {
                path: list.to_owned(),
                text: "[]".into(),
            };
            let row = self.push(format!("{}(off {which})", list.path), depth, Kind::Parked { which }, label);
            row.above = vec![list];
        }
    }
}

/// What an element is called: by its name, else by its module.
fn label_of(text: &str) -> Option<String> {
    #[derive(serde::Deserialize)]
    struct Named {
        name: Option<String>,
        module: Option<String>,
    }
    let of = |named: Named| named.name.or(named.module);
    let options = shadewright_compiler::manifest::ron_options();
    let bare = || options.from_str::<String>(text).ok();
    options.from_str::<Named>(text).ok().and_then(of).or_else(bare)
}

/// The part of a choice that a recipe has, which is all that a default says.
fn node_of(choice: &Choice) -> Node {
    let filling = |choices: &Choices| match choices {
        Choices::One(one) => Filling::One(node_of(one)),
        Choices::Many(many) => Filling::Many(many.iter().map(node_of).collect()),
    };
    Node {
        fill: choice.fill.iter().map(|(slot, choices)| (slot.clone(), filling(choices))).collect(),
        freeze: choice.freeze.clone(),
        files: choice.files.clone(),
        label: choice.label.clone(),
        ..Node::new(choice.module.clone())
    }
}
