//! A recipe and a catalog to a tree of modules, with every slot filled and every rule kept.

mod fill;
mod instances;
mod rules;

use std::ops::Range;
use std::sync::Arc;

use indexmap::IndexMap;

use crate::catalog::Module;
use crate::diagnostics::SourceFile;
use crate::manifest::spans::{Locator, Step};
use crate::manifest::{Arity, Typed, Value};

pub use fill::resolve;
pub use instances::{Instance, Instances};

/// A place in a RON text: where a node was named.
#[derive(Clone, Debug)]
pub struct Place {
    /// The text.
    pub file: Arc<SourceFile>,
    /// The way to the node in it.
    pub path: Vec<Step>,
}

impl Place {
    /// The same text, further in.
    pub fn then(&self, steps: &[Step]) -> Self {
        let mut path = self.path.clone();
        path.extend_from_slice(steps);
        Self { file: Arc::clone(&self.file), path }
    }

    /// Bytes of the value, or of the nearest thing around it that can be found.
    pub fn span(&self) -> Range<usize> {
        let locator = Locator::new(&self.file.text);
        for length in (0..=self.path.len()).rev() {
            if let Some(span) = locator.find(&self.path[..length]) {
                return span;
            }
        }
        0..self.file.text.len()
    }

    /// Bytes of the last step's key, or of the value.
    pub fn key_span(&self) -> Range<usize> {
        Locator::new(&self.file.text).find_key(&self.path).unwrap_or_else(|| self.span())
    }

    /// `file:line:column` for people.
    pub fn text(&self) -> String {
        let start = self.span().start;
        let before = &self.file.text.as_bytes()[..start.min(self.file.text.len())];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let column = before.iter().rev().take_while(|&&b| b != b'\n').count() + 1;
        format!("{}:{line}:{column}", self.file.name)
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
