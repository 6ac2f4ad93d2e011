//! The programs of a frame: each recipe and pass is compiled once, many at a time.

use std::sync::{Arc, Mutex};

use rayon::prelude::*;
use shadewright_compiler::catalog::{Catalog, Module};
use shadewright_compiler::manifest::{Filling, Node};
use shadewright_compiler::program::{Program, Recipe};
use shadewright_compiler::{Report, reflect};

use crate::gpu::{Recent, lock};

/// A recipe and a pass of it, as a key.
type Key = (String, String);

/// Compiled programs by recipe and pass.
pub(crate) struct Programs {
    catalog: Arc<Catalog>,
    made: Mutex<Recent<Key, Arc<Program>>>,
}

/// The recipe as text: equal for equal trees.
pub(crate) fn text_of(node: &Node) -> String {
    // A tree of strings, numbers and booleans with string keys always has a JSON form.
    serde_json::to_string(node).unwrap_or_default()
}

impl Programs {
    pub fn new(catalog: Arc<Catalog>) -> Self {
        Self {
            catalog,
            made: Mutex::default(),
        }
    }

    pub fn catalog(&self) -> &Catalog {
        &self.catalog
    }

    /// The program of a pass, compiled if it is new.
    pub fn get(&self, root: &Node, pass: &str) -> Result<Arc<Program>, Report> {
        let key = (text_of(root), pass.to_owned());
        if let Some(made) = lock(&self.made).get(&key) {
            return Ok(Arc::clone(made));
        }
        let program = Arc::new(self.catalog.compile(&Recipe::from(root.clone()), pass)?);
        // Found out when first asked for: here, on all cores or in the background, and not while a frame is drawn.
        program.hash();
        program.reflection();
        Ok(Arc::clone(lock(&self.made).get_or_insert(key, || program)))
    }

    /// The program of a pass, if it has been compiled.
    pub fn find(&self, root: &Node, pass: &str) -> Option<Arc<Program>> {
        lock(&self.made).get(&(text_of(root), pass.to_owned())).map(Arc::clone)
    }

    /// A frame begins: what it asks for is not forgotten at its end.
    pub fn begin(&self) {
        lock(&self.made).begin();
    }

    /// Forgets what was asked for longest ago, until so many are left or only those of the present frame.
    pub fn trim(&self, most: usize) {
        lock(&self.made).trim(most);
    }

    /// Compiles many on all cores, equal ones once.
    ///
    /// The error is that of the first wanted, whichever thread was first.
    pub fn get_many(&self, wanted: impl Iterator<Item = (Node, String)>) -> Result<(), Report> {
        let mut distinct: Vec<(Node, String)> = Vec::new();
        for item in wanted {
            if !distinct.contains(&item) && self.find(&item.0, &item.1).is_none() {
                distinct.push(item);
            }
        }
        let made: Vec<_> = distinct.par_iter().map(|(root, pass)| self.get(root, pass).map(drop)).collect();
        made.into_iter().collect()
    }

    /// The module that a node names, in a slot of this interface.
    pub fn module(&self, node: &Node, interface: Option<&str>) -> Option<&Arc<Module>> {
        interface
            .and_then(|category| self.catalog.module(&format!("{category}/{}", node.module)).ok())
            .or_else(|| self.catalog.module(&node.module).ok())
    }

    /// What stands in a slot of a node: what the recipe says, else the module's default.
    pub fn filling(&self, node: &Node, interface: Option<&str>, slot: &str) -> Option<Filling> {
        node.fill.get(slot).cloned().or_else(|| {
            let module = self.module(node, interface)?;
            module.manifest.slots.get(slot)?.default.clone()
        })
    }

    /// The subtree at a slot path (`main.lights[0].visibility`) of a recipe, and the interface of its slot.
    pub fn node_at(&self, root: &Node, path: &str) -> Option<(Node, Option<String>)> {
        let mut at = (root.clone(), None);
        for segment in path.split('.').skip(1) {
            let (slot, index) = match segment.strip_suffix(']').and_then(|s| s.split_once('[')) {
                Some((slot, index)) => (slot, index.parse().ok()?),
                None => (segment, 0),
            };
            let (node, interface) = &at;
            let next = match self.filling(node, interface.as_deref(), slot)? {
                Filling::One(node) if index == 0 => node,
                Filling::One(_) => return None,
                Filling::Many(nodes) => nodes.into_iter().nth(index)?,
            };
            let module = self.module(node, interface.as_deref());
            let interface = module.and_then(|m| m.manifest.slots.get(slot)).map(|s| s.interface.clone());
            at = (next, interface);
        }
        Some(at)
    }
}

/// The instance of this name.
pub(crate) fn instance<'a>(reflection: &'a reflect::Reflection, name: &str) -> Option<&'a reflect::Instance> {
    reflection.instances.iter().find(|i| i.name == name)
}
