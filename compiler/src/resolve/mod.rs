//! A recipe and a catalog to a tree of modules, with every slot filled and every rule kept.

pub mod fill;
mod instances;
mod resources;
pub mod rules;

use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;

use indexmap::IndexMap;

use crate::catalog::{Constants, Module};
use crate::diagnostics::SourceFile;
use crate::manifest::{Arity, Locator, Slot, Step, Typed, Value};

pub use fill::{resolve, resolve_root};
pub use instances::{Instance, Instances};
pub use resources::{check_data, check_resources};

/// A step into a RON text, owned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Way {
    /// Into a field, or a map's value.
    Key(String),
    /// Into a list or tuple.
    Index(usize),
}

/// A place in a RON text: where a node was named. Further places share the way to the nearer ones.
#[derive(Clone, Debug)]
pub struct Place {
    /// The text.
    pub file: Arc<SourceFile>,
    /// The way to the node in it.
    path: Option<Arc<Further>>,
}

/// One more step.
#[derive(Debug)]
struct Further {
    before: Option<Arc<Further>>,
    way: Way,
}

impl Place {
    /// The whole of a text.
    pub fn new(file: &Arc<SourceFile>) -> Self {
        Self {
            file: Arc::clone(file),
            path: None,
        }
    }

    /// The same text, further in.
    #[must_use]
    pub fn then(&self, step: Way) -> Self {
        self.clone().into(step)
    }

    fn into(self, way: Way) -> Self {
        Self {
            file: self.file,
            path: Some(Arc::new(Further { before: self.path, way })),
        }
    }

    /// The same text, further in by keys.
    #[must_use]
    pub fn keys(&self, keys: &[&str]) -> Self {
        keys.iter().fold(self.clone(), |place, key| place.into(Way::Key((*key).to_owned())))
    }

    fn steps(&self) -> Vec<Step<'_>> {
        let mut steps = Vec::new();
        let mut at = self.path.as_deref();
        while let Some(Further { before, way }) = at {
            steps.push(match way {
                &Way::Index(index) => Step::Index(index),
                Way::Key(key) => Step::Key(key),
            });
            at = before.as_deref();
        }
        steps.reverse();
        steps
    }

    /// Bytes of the value, or of the nearest thing around it that can be found.
    pub fn span(&self) -> Range<usize> {
        Locator::new(&self.file.text).find_near(&self.steps())
    }

    /// Bytes of the last step's key, or of the value.
    pub fn key_span(&self) -> Range<usize> {
        Locator::new(&self.file.text).find_key(&self.steps()).unwrap_or_else(|| self.span())
    }

    /// Bytes of a node's module name.
    pub fn name_span(&self) -> Range<usize> {
        self.keys(&["module"]).span()
    }

    /// `file:line:column` for people.
    pub fn text(&self) -> String {
        self.file.place(self.name_span().start)
    }
}

/// A module in its place in the tree.
#[derive(Clone, Debug)]
pub struct TreeNode {
    /// The module.
    pub module: Arc<Module>,
    /// Owner of the slot that it stands in.
    pub parent: Option<usize>,
    /// How it stands there; of no meaning for the root.
    pub standing: Standing,
    /// What stands in its slots, as tree nodes: in the order of the manifest's slots.
    pub fills: Vec<Vec<usize>>,
    /// Parameters that are constants here, with their values: frozen ones and those that are always constants.
    pub constants: IndexMap<String, (Value, Typed)>,
    /// What tells these constants from others.
    pub variant: Constants,
    /// Files by resource, for those that take files of the recipe.
    pub files: IndexMap<String, String>,
    /// Keeps it apart from an equal subtree.
    pub label: Option<String>,
}

/// How a node stands in its parent's slot.
#[derive(Clone, Copy, Debug, Default)]
pub struct Standing {
    /// The slot, by its number in the parent's manifest.
    pub slot: usize,
    /// Whether the node that the parent was made from fills it, and not the slot's default.
    pub given: bool,
    /// Its position in that filling.
    pub position: usize,
    /// Whether the filling is a list.
    pub many: bool,
}

impl TreeNode {
    /// A slot, and what stands in it.
    pub fn slot(&self, name: &str) -> Option<(&Slot, &[usize])> {
        let (index, _, slot) = self.module.manifest.slots.get_full(name)?;
        Some((slot, self.fills.get(index)?))
    }
}

/// A resolved tree; node 0 is the root, parents precede their children.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The nodes.
    pub nodes: Vec<TreeNode>,
    /// Where the root was named.
    root: Place,
}

impl Tree {
    /// Where a node was named.
    pub fn place(&self, node: usize) -> Place {
        let TreeNode { parent, standing, .. } = self.nodes[node];
        match parent {
            Some(parent) => self.standing_place(parent, standing),
            None => self.root.clone(),
        }
    }

    /// Where what stands so in a slot was named.
    fn standing_place(&self, parent: usize, standing: Standing) -> Place {
        let filling = self.filling_place(parent, standing);
        if standing.many {
            filling.into(Way::Index(standing.position))
        } else {
            filling
        }
    }

    /// Where the whole filling of a slot stands.
    fn filling_place(&self, parent: usize, Standing { slot, given, .. }: Standing) -> Place {
        let module = &self.nodes[parent].module;
        let name = module.manifest.slots.get_index(slot).map_or("", |(name, _)| name);
        match given {
            // A module that the compiler made stands around the recipe: what fills it is the recipe's own root.
            true if module.category.is_empty() => self.place(parent),
            true => self.place(parent).keys(&["fill", name]),
            false => Place::new(&module.source).keys(&["slots", name, "default"]),
        }
    }

    /// Where a node stands: `main`, `main.brdf.ndf`, `main.lights[1]`.
    pub fn path(&self, node: usize) -> String {
        let mut path = String::new();
        self.write_path(node, &mut path);
        path
    }

    /// The same, behind other text.
    pub fn write_path(&self, node: usize, into: &mut String) {
        let TreeNode { parent, standing, .. } = self.nodes[node];
        let Some(parent) = parent else {
            into.push_str("main");
            return;
        };
        self.write_path(parent, into);
        let module = &self.nodes[parent].module;
        if let Some((name, slot)) = module.manifest.slots.get_index(standing.slot)
            && !module.category.is_empty()
        {
            into.push('.');
            into.push_str(name);
            if slot.arity == Arity::List {
                // Infallible: writing to a string.
                let _ = write!(into, "[{}]", standing.position);
            }
        }
    }
}
