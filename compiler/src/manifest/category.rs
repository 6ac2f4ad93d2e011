//! `category.ron`: the declaration of a category and of the interface that its modules implement.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::{Resource, Value};

/// A category's declaration. The interface's structs and functions are in `interface.wgsl` beside it; the bodies
/// there are the neutral ones that run where an optional slot is empty.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CategoryManifest {
    /// One line: what modules of this category decide.
    pub summary: String,
    /// Where lists show it; small first.
    pub order: i32,
    /// Bind group of the resources and uniform parameters of its modules: 0 frame, 1 lights and shadows, 2 material, 3 pass.
    #[serde(default = "pass_group")]
    pub group: u32,
    /// Interfaces whose structs, constants, resources and functions this interface's text names.
    #[serde(default)]
    pub uses: Vec<String>,
    /// How the results of a list slot become one, by function. A function that is not named here cannot stand in a list slot.
    #[serde(default)]
    pub combine: IndexMap<String, Combine>,
    /// Functions of `interface.wgsl` that go the other way: the module with the slot defines them, the module in the slot calls them.
    #[serde(default)]
    pub offers: Vec<String>,
    /// Groups of functions that a module may leave out, a group as a whole: then the interface's own bodies run.
    #[serde(default)]
    pub optional: Vec<Vec<String>>,
    /// Values of struct members where `probe` is given none: struct, then member.
    #[serde(default)]
    pub defaults: IndexMap<String, IndexMap<String, Value>>,
    /// Module-scope resource variables of `interface.wgsl`.
    #[serde(default)]
    pub resources: IndexMap<String, Resource>,
}

impl CategoryManifest {
    /// The group that a function may be left out with; none for one that every module defines.
    pub fn optional_with(&self, function: &str) -> Option<&[String]> {
        let mut groups = self.optional.iter();
        groups.find(|group| group.iter().any(|name| name == function)).map(Vec::as_slice)
    }
}

fn pass_group() -> u32 {
    3
}

/// How a list slot's results become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
pub enum Combine {
    /// Every module is called with the same arguments, the results are added.
    Sum,
    /// Every module is called with the same arguments, the results are multiplied.
    Product,
    /// The first argument goes through the modules in their order; the others are the same for all.
    Chain,
}
