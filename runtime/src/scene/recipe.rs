//! From a scene's choices to a recipe's nodes and the settings beside them.

use std::sync::Arc;

use indexmap::IndexMap;
use shadewright_compiler::manifest::{Arity, Filling, Node, ParamMode};
use shadewright_compiler::{Catalog, Module};

use super::assets::Assets;
use super::{Choice, Choices, Picture};
use crate::frame::Settings;

/// Makes the nodes of one recipe.
///
/// The linker takes equal subtrees for one. Where a scene gives two equal subtrees different parameters or files, the later one gets a
/// label, so that each keeps its own.
#[derive(Clone, Default)]
pub(super) struct Planter {
    seen: Vec<(Node, Choice)>,
    /// Of all nodes so far.
    pub settings: Settings,
}

impl Planter {
    /// The node of a choice that stands at `place`. Choices were checked before: what does not exist is left out here.
    pub(super) fn plant(&mut self, choice: &Choice, place: &str, catalog: &Catalog, assets: &mut Assets) -> Node {
        self.plant_as(catalog.module(&choice.module).ok(), choice, place, catalog, assets)
    }

    fn plant_as(&mut self, module: Option<&Arc<Module>>, choice: &Choice, place: &str, catalog: &Catalog, assets: &mut Assets) -> Node {
        let mut node = Node::new(choice.module.clone());
        for (slot, choices) in &choice.fill {
            let declared = module.and_then(|m| m.manifest.slots.get(slot));
            let list = declared.is_some_and(|s| s.arity == Arity::List);
            let mut nodes = Vec::new();
            for (i, child) in choices.all().iter().enumerate() {
                let place = if list {
                    format!("{place}.{slot}[{i}]")
                } else {
                    format!("{place}.{slot}")
                };
                let module = declared.and_then(|slot| catalog.module_for(&slot.interface, &child.module).ok());
                nodes.push(self.plant_as(module, child, &place, catalog, assets));
            }
            let filling = match (list, nodes.pop()) {
                (false, Some(last)) => Filling::One(last),
                (_, last) => {
                    nodes.extend(last);
                    Filling::Many(nodes)
                }
            };
            node.fill.insert(slot.clone(), filling);
        }
        node.freeze.clone_from(&choice.freeze);
        node.label.clone_from(&choice.label);
        let mut params = IndexMap::new();
        for (name, value) in &choice.params {
            let mode = module.and_then(|m| m.manifest.params.get(name)).map(|p| p.mode);
            // A constant is fixed before parsing: to set it is to freeze it.
            if mode == Some(ParamMode::Constant) {
                node.freeze.insert(name.clone(), value.clone());
            } else {
                params.insert(name.clone(), value.clone());
            }
        }
        if !params.is_empty() {
            self.settings.params.insert(place.to_owned(), params);
        }
        let mut textures = IndexMap::new();
        for (name, picture) in &choice.textures {
            let texture = match picture {
                Picture::Loaded(texture) => Some(texture.clone()),
                Picture::File(file) => assets.texture(file).ok(),
            };
            textures.extend(texture.map(|t| (name.clone(), t)));
        }
        if !textures.is_empty() {
            self.settings.textures.insert(place.to_owned(), textures);
        }
        let mut data = IndexMap::new();
        for (name, file) in &choice.files {
            if let Some(format) = module.and_then(|m| m.manifest.format_of(name)) {
                data.extend(assets.data(file, format).ok().map(|numbers| (name.clone(), numbers)));
            }
        }
        if !data.is_empty() {
            self.settings.data.insert(place.to_owned(), data);
        }
        self.keep_apart(&mut node, choice, place);
        node
    }

    fn keep_apart(&mut self, node: &mut Node, choice: &Choice, place: &str) {
        let same_but_label = |a: &Node, b: &Node| {
            let mut a = a.clone();
            a.label.clone_from(&b.label);
            a == *b
        };
        if let Some((known, _)) = self.seen.iter().find(|(n, c)| c == choice && same_but_label(n, node)) {
            node.label.clone_from(&known.label);
            return;
        }
        if node.label.is_none() && self.seen.iter().any(|(n, _)| n == node) {
            node.label = Some(place.replace(['.', '['], "_").replace([']', '-'], ""));
        }
        self.seen.push((node.clone(), choice.clone()));
    }

    /// Nodes of a list slot.
    pub(super) fn plant_list(&mut self, choices: &Choices, place: &str, catalog: &Catalog, assets: &mut Assets) -> Vec<Node> {
        let each = choices.all().iter().enumerate();
        each.map(|(i, c)| self.plant(c, &format!("{place}[{i}]"), catalog, assets))
            .collect()
    }
}
