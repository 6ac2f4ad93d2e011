//! A recipe's general form: the same tree with its frozen parameters as uniforms.

use indexmap::IndexMap;
use shadewright_compiler::manifest::{Arity, Filling, Node, ParamMode};

use super::programs::Programs;
use super::{Lights, Material};

/// The material with every parameter that can be a uniform as one, and its frozen value as the setting; `None` where none is frozen.
/// What changes code stays frozen: constants and overrides. So do the lights, which a frame knows by their subtrees.
pub(crate) fn thawed(programs: &Programs, lights: &[Lights], material: &Material) -> Option<Material> {
    let mut thaw = Thaw {
        programs,
        lights,
        params: material.settings.params.clone(),
        seen: Vec::new(),
        any: false,
    };
    let root = thaw.node(&material.recipe, None, "main");
    let mut general = material.clone();
    general.recipe = root.into();
    general.settings.params = thaw.params;
    thaw.any.then_some(general)
}

struct Thaw<'a> {
    programs: &'a Programs,
    lights: &'a [Lights],
    params: IndexMap<String, IndexMap<String, shadewright_compiler::manifest::Value>>,
    /// Nodes as they are now and as they were.
    seen: Vec<(Node, Node)>,
    any: bool,
}

impl Thaw<'_> {
    fn node(&mut self, before: &Node, interface: Option<&str>, place: &str) -> Node {
        if self.lights.iter().any(|light| light.node == *before) {
            return before.clone();
        }
        let mut node = before.clone();
        let Some(manifest) = self.programs.module(before, interface).map(|module| module.manifest.clone()) else {
            return node;
        };
        for (slot, filling) in &mut node.fill {
            let Some(declared) = manifest.slots.get(slot) else { continue };
            let interface = Some(declared.interface.as_str());
            match filling {
                Filling::One(child) if declared.arity == Arity::List => *child = self.node(child, interface, &format!("{place}.{slot}[0]")),
                Filling::One(child) => *child = self.node(child, interface, &format!("{place}.{slot}")),
                Filling::Many(children) => {
                    for (i, child) in children.iter_mut().enumerate() {
                        *child = self.node(child, interface, &format!("{place}.{slot}[{i}]"));
                    }
                }
            }
        }
        let is_uniform = |name: &String| manifest.params.get(name).is_some_and(|p| p.mode == ParamMode::Uniform);
        for (name, value) in before.freeze.iter().filter(|(name, _)| is_uniform(name)) {
            node.freeze.shift_remove(name);
            let params = self.params.entry(place.to_owned()).or_default();
            params.insert(name.clone(), value.clone());
            self.any = true;
        }
        // Subtrees that differed by what was frozen would be taken for one, with one value.
        if node.label.is_none() && self.seen.iter().any(|(now, was)| *now == node && was != before) {
            node.label = Some(place.replace(['.', '['], "_").replace([']', '-'], ""));
        }
        self.seen.push((node.clone(), before.clone()));
        node
    }
}
