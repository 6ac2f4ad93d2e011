//! A recipe and a catalog to a tree of modules, with every slot filled and every rule kept.

pub mod fill;
mod instances;
mod resources;
pub mod rules;

use std::ops::Range;
use std::sync::Arc;

use indexmap::IndexMap;

use crate::catalog::Module;
use crate::diagnostics::SourceFile;
use crate::manifest::{Arity, Locator, Step, Typed, Value};

pub use fill::{resolve, resolve_root};
pub use instances::{Instance, Instances};
pub use resources::check_resources;

/// A step into a RON text, owned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Way {
    /// Into a field, or a map's value.
    Key(String),
    /// Into a list or tuple.
    Index(usize),
}

/// A place in a RON text: where a node was named. Cheap to make, since most are never looked up: further places share the
/// way to the nearer ones.
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

/// A slot with what stands in it.
#[derive(Clone, Debug)]
pub struct Filled {
    /// How many the slot takes.
    pub arity: Arity,
    /// Category of what fills it.
    pub interface: String,
    /// Tree nodes, in order.
    pub nodes: Vec<usize>,
}

/// A module in its place in the tree.
#[derive(Clone, Debug)]
pub struct TreeNode {
    /// The module.
    pub module: Arc<Module>,
    /// Owner of the slot that it stands in.
    pub parent: Option<usize>,
    /// Where it stands: `main`, `main.brdf.ndf`, `main.lights[1]`.
    pub path: String,
    /// Its slots.
    pub fills: IndexMap<String, Filled>,
    /// Parameters that are constants here, with their values: frozen ones and those that are always constants.
    pub constants: IndexMap<String, (Value, Typed)>,
    /// Keeps it apart from an equal subtree.
    pub label: Option<String>,
    /// Where it was named.
    pub place: Place,
}

/// A resolved tree; node 0 is the root, parents precede their children.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The nodes.
    pub nodes: Vec<TreeNode>,
}
