//! The modules that stand in a scene, in the places where others could stand: rows of a tree, found from the scene and the manifests.

mod choose;
mod rows;
mod subject;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use shadewright_compiler::manifest::{Arity, Slot};
use shadewright_compiler::{Catalog, Module};

use crate::document::Ancestor;

pub use choose::{choose, element, name_in};
pub use rows::rows;
pub use subject::{Subject, row_of, subjects};

/// One line of the tree.
#[derive(Clone, Debug)]
pub struct Row {
    /// Where it stands in the scene: `materials.copper.brdf`. Unique.
    pub path: String,
    /// How deep it is nested.
    pub depth: usize,
    /// What kind of a line.
    pub kind: Kind,
    /// Name of the slot, of the light, of the material.
    pub label: String,
    /// What stands there.
    pub module: Option<Arc<Module>>,
    /// Whether the scene says so; else it is a default.
    pub is_stated: bool,
    /// Defaults to write out before something is put *here*.
    pub above: Vec<Ancestor>,
    /// Defaults to write out before something is put *below* this: parameters, slots.
    pub through: Vec<Ancestor>,
}

/// Kinds of lines.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A part of the scene: its camera and size, its materials, its lights.
    Heading(Part),
    /// A material; its slots are below.
    Material,
    /// A slot that takes one module, or none.
    Slot {
        /// Category that fits.
        interface: String,
        /// Whether it may be empty.
        may_be_empty: bool,
        /// What it decides.
        doc: String,
    },
    /// A slot that takes any number of modules. They are below.
    List {
        /// Category that fits.
        interface: String,
        /// What it decides.
        doc: String,
    },
    /// A module in a list.
    Element {
        /// Path of the list.
        list: String,
        /// Its place there.
        index: usize,
        /// How many there are.
        of: usize,
        /// Category that fits.
        interface: String,
    },
    /// An element of a list that is switched off.
    Parked {
        /// Which of [`crate::document::State::parked`].
        which: usize,
    },
    /// An object of the scene.
    Object {
        /// Which.
        index: usize,
    },
    /// A glTF file.
    Gltf {
        /// Which.
        index: usize,
    },
}

/// Parts of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Camera, size, background.
    View,
    /// What surfaces are.
    Materials,
    /// What shines.
    Lights,
    /// What is drawn.
    Objects,
    /// From the frame to the picture.
    Display,
}

impl Part {
    /// Its heading.
    pub fn name(self) -> &'static str {
        match self {
            Self::View => "View",
            Self::Materials => "Materials",
            Self::Lights => "Lights",
            Self::Objects => "Objects",
            Self::Display => "Display",
        }
    }
}

impl Row {
    /// The category whose modules fit here; `None` where no module is chosen.
    pub fn interface(&self) -> Option<&str> {
        match &self.kind {
            Kind::Slot { interface, .. } | Kind::List { interface, .. } | Kind::Element { interface, .. } => Some(interface),
            _ => None,
        }
    }

    /// Whether one module is chosen here.
    pub fn is_choice(&self) -> bool {
        matches!(self.kind, Kind::Slot { .. } | Kind::Element { .. })
    }

    /// Whether this is a light of the scene.
    pub fn is_light(&self) -> bool {
        matches!(&self.kind, Kind::Element { list, .. } if list == "lights")
    }
}

/// The modules of a category, in their order.
pub fn options<'c>(catalog: &'c Catalog, interface: &'c str) -> impl Iterator<Item = &'c Arc<Module>> {
    catalog.modules().filter(move |module| module.category == interface)
}

/// The slot that takes modules of a category, with its name.
fn slot_of<'m>(module: &'m Module, interface: &str) -> Option<(&'m String, &'m Slot)> {
    module.manifest.slots.iter().find(|(_, slot)| slot.interface == interface)
}

fn may_be_empty(slot: &Slot) -> bool {
    slot.arity == Arity::Optional
}
