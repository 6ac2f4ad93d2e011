//! A recipe's tree with the defaults of its slots written out, and the slot paths that lead into it.

use std::sync::Arc;

use indexmap::IndexMap;
use serde::Serialize;
use shadewright::compiler::manifest::{Arity, Filling, Node, Value};
use shadewright::compiler::{Catalog, Module, Report};

use super::failure::Failure;
use super::text::nearest;

/// Name of the root in slot paths, as in reflection.
pub const ROOT: &str = "main";

/// Deepest tree that is shown; the compiler's own limit is below it, so only a cycle of defaults gets here.
const MAX_DEPTH: usize = 128;

/// One module of a tree.
#[derive(Debug, Serialize)]
pub struct Tree {
    /// Slot path, `main.brdf.ndf`.
    pub path: String,
    /// Module's name.
    pub module: String,
    /// Its category.
    pub category: String,
    /// It stands there because the recipe says nothing.
    pub by_default: bool,
    /// Keeps it apart from an equal subtree.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Frozen parameters.
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    pub freeze: IndexMap<String, Value>,
    /// Slots in the order of their declaration.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub slots: Vec<SlotTree>,
}

/// One slot and what fills it.
#[derive(Debug, Serialize)]
pub struct SlotTree {
    /// Its name.
    pub name: String,
    /// Category whose modules fit.
    pub interface: String,
    /// What fills it, in order; empty where an optional or list slot is.
    pub filled: Vec<Tree>,
}

impl Tree {
    /// Writes out a recipe's tree.
    ///
    /// # Errors
    /// A module is unknown, or the defaults go round in a circle.
    pub fn of(catalog: &Catalog, root: &Node) -> Result<Self, Failure> {
        grow(catalog, root, None, ROOT.to_owned(), false, 0)
    }

    /// This node and everything below it, parents first.
    pub fn walk(&self) -> Vec<&Self> {
        let mut all = vec![self];
        for child in self.slots.iter().flat_map(|slot| &slot.filled) {
            all.extend(child.walk());
        }
        all
    }
}

/// The module that a node names: of a slot's own category, where there is one of that name.
fn module_of<'a>(catalog: &'a Catalog, node: &Node, interface: Option<&str>) -> Result<&'a Arc<Module>, Report> {
    let full = interface.map(|interface| format!("{interface}/{}", node.module));
    match full.map(|full| catalog.module(&full)) {
        Some(Ok(module)) => Ok(module),
        _ => catalog.module(&node.module),
    }
}

fn grow(catalog: &Catalog, node: &Node, interface: Option<&str>, path: String, by_default: bool, depth: usize) -> Result<Tree, Failure> {
    if depth > MAX_DEPTH {
        return Err(Failure::message(format!("{path}: the defaults of the slots go round in a circle")));
    }
    let module = Arc::clone(module_of(catalog, node, interface)?);
    if let Some(unknown) = node.fill.keys().find(|name| !module.manifest.slots.contains_key(*name)) {
        return Err(Failure::message(format!("{path}: {}", no_slot(&module, unknown))));
    }
    let mut slots = Vec::new();
    for (name, slot) in &module.manifest.slots {
        let (filling, by_default) = match node.fill.get(name) {
            Some(filling) => (Some(filling), false),
            None => (slot.default.as_ref(), true),
        };
        let mut filled = Vec::new();
        for (index, child) in nodes(filling).iter().enumerate() {
            let path = match slot.arity {
                Arity::List => format!("{path}.{name}[{index}]"),
                Arity::Single | Arity::Optional => format!("{path}.{name}"),
            };
            filled.push(grow(catalog, child, Some(&slot.interface), path, by_default, depth + 1)?);
        }
        slots.push(SlotTree {
            name: name.clone(),
            interface: slot.interface.clone(),
            filled,
        });
    }
    Ok(Tree {
        path,
        module: module.name.clone(),
        category: module.category.clone(),
        by_default,
        label: node.label.clone(),
        freeze: node.freeze.clone(),
        slots,
    })
}

fn nodes(filling: Option<&Filling>) -> &[Node] {
    match filling {
        None => &[],
        Some(Filling::One(node)) => std::slice::from_ref(node),
        Some(Filling::Many(nodes)) => nodes,
    }
}

/// Freezes a parameter given as `[main.]slot.slot[i].param=value`.
///
/// # Errors
/// The text has another form, or there is no such slot or parameter.
pub fn freeze(catalog: &Catalog, root: &mut Node, typed: &str) -> Result<(), Failure> {
    let Some((path, value)) = typed.split_once('=') else {
        return Err(Failure::Usage(format!(
            "--freeze {typed}: should be PARAM=VALUE, or SLOT.PARAM=VALUE"
        )));
    };
    let mut steps: Vec<&str> = path.trim().split('.').collect();
    if steps.len() > 1 && steps[0] == ROOT {
        steps.remove(0);
    }
    let param = steps.pop().unwrap_or_default();
    let mut node = root;
    let mut interface = None;
    for step in steps {
        let wrong = |why| Failure::message(format!("--freeze {typed}: {why}"));
        let (next, of) = child(catalog, node, interface.as_deref(), step).map_err(wrong)?;
        (node, interface) = (next, Some(of));
    }
    let module = module_of(catalog, node, interface.as_deref())?;
    if !module.manifest.params.contains_key(param) {
        let near = nearest(param, module.manifest.params.keys().map(String::as_str));
        let name = &module.name;
        return Err(Failure::message(format!(
            "--freeze {typed}: `{name}` has no parameter `{param}`{near}"
        )));
    }
    node.freeze.insert(param.to_owned(), parse_value(value.trim()));
    Ok(())
}

/// A value as typed: RON, or text as it stands (`2700 K`).
pub fn parse_value(typed: &str) -> Value {
    ron::from_str(typed).unwrap_or_else(|_| Value::Text(typed.to_owned()))
}

fn no_slot(module: &Module, name: &str) -> String {
    let near = nearest(name, module.manifest.slots.keys().map(String::as_str));
    format!("`{}` has no slot `{name}`{near}", module.name)
}

/// The node in a slot, which is filled with its default first where the recipe says nothing, and the slot's interface.
fn child<'a>(catalog: &Catalog, node: &'a mut Node, interface: Option<&str>, step: &str) -> Result<(&'a mut Node, String), String> {
    let (name, index) = match step.split_once('[') {
        None => (step, 0),
        Some((name, rest)) => {
            let index = rest.strip_suffix(']').and_then(|digits| digits.parse().ok());
            (name, index.ok_or_else(|| format!("`{step}` should be `slot[number]`"))?)
        }
    };
    let module = module_of(catalog, node, interface).map_err(|report| report.to_string())?;
    let Some(slot) = module.manifest.slots.get(name) else {
        return Err(no_slot(module, name));
    };
    if !node.fill.contains_key(name)
        && let Some(default) = &slot.default
    {
        node.fill.insert(name.to_owned(), default.clone());
    }
    let found = match node.fill.get_mut(name) {
        None => None,
        Some(Filling::One(node)) => (index == 0).then_some(node),
        Some(Filling::Many(nodes)) => nodes.get_mut(index),
    };
    let found = found.ok_or_else(|| format!("nothing stands in `{step}`"))?;
    Ok((found, slot.interface.clone()))
}
