//! What the words of an item's text refer to, as far as linking gives it another name.

use std::ops::Range;

use naga::Handle;

use super::compose::{Origin, param_use};
use super::scan::{Item, ItemKind};
use super::unit::Unit;

/// What a word stands for.
#[derive(Debug)]
pub enum Meaning {
    /// A uniform parameter, by its index; the stretch is all of `params.x`.
    Uniform(usize),
    /// A parameter that is a constant or an override, by its index among the constants and then the overrides; all of `params.x`.
    Constant(usize),
    /// A function of the unit or of a slot.
    Function(Handle<naga::Function>),
    /// An item of the unit, by its index.
    Own {
        /// Its index in the scan.
        item: usize,
        /// Whether each instance has its own: a variable or an override.
        instanced: bool,
    },
    /// An item of another category's interface.
    Interface {
        /// The category.
        category: String,
        /// The item.
        name: String,
    },
    /// The struct `Instance`.
    InstanceType,
    /// The variable `instances`.
    Instances,
    /// Something else that may have a name of its own.
    Other,
}

/// A stretch of an item's text that stands for something.
#[derive(Debug)]
pub struct Mention {
    /// Its bytes.
    pub range: Range<usize>,
    /// For what.
    pub meaning: Meaning,
}

/// The mentions in an item, in the order of the text. Words of the language are not among them.
pub fn mentions(unit: &Unit, item: &Item) -> Vec<Mention> {
    let text = &unit.file.text;
    let mut found = Vec::new();
    for reference in &item.references {
        let token = unit.scan.tokens[reference.token];
        let name = &text[token.range()];
        let mut range = token.range();
        let origin = unit.origin(name);
        let meaning = match (origin, param_use(text, &unit.scan, reference.token)) {
            (Some(Origin::Params) | None, Some((param, whole))) => {
                range = whole;
                match unit.needs.uniforms.get_index_of(param) {
                    Some(index) => Meaning::Uniform(index),
                    None => {
                        let mut params = unit.needs.constants.keys().chain(unit.needs.overrides.keys());
                        let Some(index) = params.position(|p| p == param) else { continue };
                        Meaning::Constant(index)
                    }
                }
            }
            _ => match (unit.functions.get(name), origin) {
                (Some(&function), _) => Meaning::Function(function),
                (None, None) => continue,
                (None, Some(Origin::Own)) => {
                    let Some(item) = unit.scan.item_index(name) else { continue };
                    let kind = unit.scan.items[item].kind;
                    let instanced = matches!(kind, ItemKind::Variable | ItemKind::Override);
                    Meaning::Own { item, instanced }
                }
                (None, Some(Origin::Interface(category))) => Meaning::Interface {
                    category: category.clone(),
                    name: name.to_owned(),
                },
                (None, Some(Origin::Instances)) if name == "Instance" => Meaning::InstanceType,
                (None, Some(Origin::Instances)) => Meaning::Instances,
                (None, Some(_)) => Meaning::Other,
            },
        };
        found.push(Mention { range, meaning });
    }
    found
}
