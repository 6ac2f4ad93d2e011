//! Filling slots, from the root down.

use std::sync::Arc;

use indexmap::IndexMap;

use super::{Place, Standing, Tree, TreeNode, rules};
use crate::catalog::{Catalog, Module, Variants};
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::limits;
use crate::manifest::{Arity, Filling, ModuleManifest, Node, ParamMode, Slot, Typed, Value, typed};
use crate::program::Recipe;

/// Resolves a recipe.
///
/// # Errors
/// A name, slot, parameter or rule is wrong; the tree is too deep or too large.
pub fn resolve(catalog: &Catalog, recipe: &Recipe) -> Result<Tree, Report> {
    let place = Place::new(&recipe.source);
    let module = catalog.module_at(&recipe.root.module, None, || place.clone())?;
    resolve_root(catalog, module, &recipe.root, place)
}

/// Resolves a tree whose root module is given.
pub fn resolve_root(catalog: &Catalog, module: Arc<Module>, root: &Node, place: Place) -> Result<Tree, Report> {
    let mut resolver = Resolver {
        catalog,
        tree: Tree {
            nodes: Vec::new(),
            root: place,
        },
        defaults: Vec::new(),
    };
    resolver.node(module, root, None, Standing::default(), 0)?;
    rules::check(&resolver.tree)?;
    Ok(resolver.tree)
}

struct Resolver<'a> {
    catalog: &'a Catalog,
    tree: Tree,
    /// Modules whose defaults are being expanded, outermost first.
    defaults: Vec<Arc<Module>>,
}

impl Resolver<'_> {
    fn node(&mut self, module: Arc<Module>, node: &Node, parent: Option<usize>, standing: Standing, depth: usize) -> Result<usize, Report> {
        let index = self.tree.nodes.len();
        let place = |tree: &Tree| match parent {
            Some(parent) => tree.standing_place(parent, standing),
            None => tree.root.clone(),
        };
        if depth > limits::TREE_DEPTH {
            return Err(too_deep(&place(&self.tree)));
        }
        if index >= limits::INSTANCES {
            let place = place(&self.tree);
            return Err(Diagnostic::new(
                codes::TOO_MANY_INSTANCES,
                format!("the tree has more than {} modules", limits::INSTANCES),
            )
            .at(&place.file, place.span(), "with this one")
            .into());
        }
        let constants = constants(&module, node, || place(&self.tree))?;
        if let Some(label) = &node.label
            && !is_identifier(label)
        {
            return Err(bad_label(label, &place(&self.tree)));
        }
        unknown_slots(&module, node.fill.keys(), || place(&self.tree))?;
        unknown_files(&module, node.files.keys(), || place(&self.tree))?;
        self.tree.nodes.push(TreeNode {
            module: Arc::clone(&module),
            parent,
            standing,
            fills: Vec::with_capacity(module.manifest.slots.len()),
            variant: Variants::key(&constants),
            constants,
            files: node.files.clone(),
            label: node.label.clone(),
        });
        for slot in 0..module.manifest.slots.len() {
            let nodes = self.slot(index, &module, node, slot, depth)?;
            self.tree.nodes[index].fills.push(nodes);
        }
        Ok(index)
    }

    fn slot(&mut self, owner: usize, module: &Arc<Module>, node: &Node, index: usize, depth: usize) -> Result<Vec<usize>, Report> {
        let Some((name, slot)) = module.manifest.slots.get_index(index) else {
            return Ok(Vec::new());
        };
        let given = node.fill.get(name);
        let standing = Standing {
            slot: index,
            given: given.is_some(),
            ..Standing::default()
        };
        let filling = match (given, &slot.default) {
            (Some(filling), _) => filling,
            (None, Some(default)) => {
                let at = || self.tree.filling_place(owner, standing);
                if let Some(circle) = circle(&self.defaults, module, at) {
                    return Err(circle);
                }
                default
            }
            (None, None) if slot.arity == Arity::Single => {
                return Err(missing_filling(self.catalog, module, name, slot, &self.tree.place(owner)));
            }
            (None, None) => return Ok(Vec::new()),
        };
        let many = matches!(filling, Filling::Many(_));
        let nodes = match filling {
            Filling::One(node) => std::slice::from_ref(node),
            Filling::Many(nodes) => nodes,
        };
        let takes = match slot.arity {
            Arity::Single => 1..=1,
            Arity::Optional => 0..=1,
            Arity::List => 0..=limits::LIST_LENGTH,
        };
        if !takes.contains(&nodes.len()) {
            let at = self.tree.filling_place(owner, standing);
            return Err(wrong_number(nodes.len(), (name, slot.arity), module, &at));
        }
        if given.is_none() {
            self.defaults.push(Arc::clone(module));
        }
        let mut filled = Vec::with_capacity(nodes.len());
        for (position, child) in nodes.iter().enumerate() {
            let standing = Standing {
                position,
                many,
                ..standing
            };
            let at = || self.tree.standing_place(owner, standing);
            let module = self.catalog.module_at(&child.module, Some((&slot.interface, name)), at)?;
            filled.push(self.node(module, child, Some(owner), standing, depth + 1)?);
        }
        if given.is_none() {
            self.defaults.pop();
        }
        Ok(filled)
    }
}

/// A tree with more slots above one another than there may be.
pub fn too_deep(place: &Place) -> Report {
    Diagnostic::new(
        codes::TREE_TOO_DEEP,
        format!("the tree is deeper than {} slots", limits::TREE_DEPTH),
    )
    .at(&place.file, place.span(), "here it goes too deep")
    .into()
}

/// A label that no name can be made of.
pub fn bad_label(label: &str, place: &Place) -> Report {
    Diagnostic::new(codes::BAD_LABEL, format!("the label `{label}` is no identifier"))
        .at(
            &place.file,
            place.keys(&["label"]).span(),
            "letters, digits and underscores, not a digit first",
        )
        .into()
}

/// Finds names that are no slots of a module.
pub fn unknown_slots<'a>(module: &Module, names: impl IntoIterator<Item = &'a String>, place: impl Fn() -> Place) -> Result<(), Report> {
    for name in names {
        if !module.manifest.slots.contains_key(name) {
            let place = place();
            let known: Vec<&str> = module.manifest.slots.keys().map(String::as_str).collect();
            let span = place.keys(&["fill", name]).key_span();
            return Err(
                Diagnostic::new(codes::UNKNOWN_SLOT, format!("`{}` has no slot `{name}`", module.name))
                    .at(&place.file, span, "no such slot")
                    .suggest(name, "slots", known)
                    .into(),
            );
        }
    }
    Ok(())
}

/// Finds files for what takes none.
fn unknown_files<'a>(module: &Module, names: impl IntoIterator<Item = &'a String>, place: impl Fn() -> Place) -> Result<(), Report> {
    for name in names {
        if module.manifest.format_of(name).is_none() {
            let at = place().keys(&["files", name]);
            let known = module
                .manifest
                .resources
                .keys()
                .filter(|name| module.manifest.format_of(name).is_some());
            return Err(
                Diagnostic::new(codes::UNKNOWN_FILE, format!("`{}` takes no file `{name}`", module.name))
                    .at(&at.file, at.key_span(), "no such resource")
                    .suggest(name, "resources that take a file", known.map(String::as_str))
                    .into(),
            );
        }
    }
    Ok(())
}

/// The error about a module whose default leads back to it, if it does. `defaults` are the modules whose defaults are being expanded.
pub fn circle(defaults: &[Arc<Module>], module: &Module, at: impl Fn() -> Place) -> Option<Report> {
    let first = defaults.iter().position(|m| m.name == module.name)?;
    let at = at();
    let circle = defaults[first..].iter().map(AsRef::as_ref).chain([module]);
    let circle: Vec<&str> = circle.map(|m| m.name.as_str()).collect();
    Some(
        Diagnostic::new(codes::CYCLIC_TREE, format!("the defaults of `{}` lead back to itself", module.name))
            .at(&at.file, at.span(), "this default is part of the circle")
            .note(format!("the circle is {}", circle.join(" -> ")))
            .note("fill the slot in the recipe, or take one of the defaults away")
            .into(),
    )
}

/// A slot that must be filled and is not.
pub fn missing_filling(catalog: &Catalog, module: &Module, name: &str, slot: &Slot, place: &Place) -> Report {
    let fits = catalog.fits(&slot.interface);
    Diagnostic::new(
        codes::MISSING_FILLING,
        format!("nothing fills the slot `{name}` of `{}`", module.name),
    )
    .at(&place.file, place.span(), format!("`{name}` is missing here"))
    .note(format!("modules of `{}` fit: {}", slot.interface, list_or_none(&fits)))
    .into()
}

/// A slot with a number of modules that it does not take.
pub fn wrong_number(number: usize, (name, arity): (&str, Arity), module: &Module, at: &Place) -> Report {
    Diagnostic::new(
        codes::TOO_MANY_FILLINGS,
        format!("{number} modules in the slot `{name}` of `{}`", module.name),
    )
    .at(
        &at.file,
        at.span(),
        match arity {
            Arity::Single => "it takes exactly one".to_owned(),
            Arity::Optional => "it takes at most one".to_owned(),
            Arity::List => format!("it takes at most {}", limits::LIST_LENGTH),
        },
    )
    .into()
}

fn list_or_none(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// Finds names that are no parameters of a module.
pub fn unknown_params<'a>(module: &Module, names: impl IntoIterator<Item = &'a String>, place: impl Fn() -> Place) -> Result<(), Report> {
    let manifest = &module.manifest;
    for name in names {
        if manifest.params.get(name).is_none_or(|param| param.filled_slot().is_some()) {
            let at = place().keys(&["freeze", name]);
            if manifest.instances.contains_key(name) {
                return Err(
                    Diagnostic::new(codes::INSTANCE_FIELD_FROZEN, format!("`{name}` differs from instance to instance"))
                        .at(&at.file, at.key_span(), "a recipe cannot freeze it")
                        .note("a field of `instances` has a value for each thing of a scene: set it there")
                        .into(),
                );
            }
            return Err(
                Diagnostic::new(codes::UNKNOWN_PARAM, format!("`{}` has no parameter `{name}`", module.name))
                    .at(&at.file, at.key_span(), "no such parameter")
                    .suggest(name, "parameters", settable(manifest))
                    .into(),
            );
        }
    }
    Ok(())
}

/// Names of the parameters that a recipe may set.
fn settable(manifest: &ModuleManifest) -> impl Iterator<Item = &str> {
    let params = manifest.params.iter().filter(|(_, param)| param.filled_slot().is_none());
    params.map(|(name, _)| name.as_str())
}

/// Whether anything stands in a slot of the node.
fn is_filled(module: &Module, node: &Node, slot: &str) -> bool {
    let default = || module.manifest.slots.get(slot)?.default.as_ref();
    match node.fill.get(slot).or_else(default) {
        Some(Filling::One(_)) => true,
        Some(Filling::Many(nodes)) => !nodes.is_empty(),
        None => false,
    }
}

/// Parameters that are constants in this node.
fn constants(module: &Module, node: &Node, place: impl Fn() -> Place) -> Result<IndexMap<String, (Value, Typed)>, Report> {
    unknown_params(module, node.freeze.keys(), &place)?;
    let manifest = &module.manifest;
    let mut constants = IndexMap::new();
    for (name, param) in &manifest.params {
        if let Some(slot) = param.filled_slot() {
            let filled = is_filled(module, node, slot);
            constants.insert(name.clone(), (Value::Bool(filled), Typed::Bool(filled)));
            continue;
        }
        let frozen = node.freeze.get(name);
        let value = match frozen {
            Some(value) => value,
            None if param.mode == ParamMode::Constant => &param.default,
            None => continue,
        };
        let typed = typed(param, value).map_err(|error| {
            let at = match frozen {
                Some(_) => place().keys(&["freeze", name]),
                None => Place::new(&module.source).keys(&["params", name, "default"]),
            };
            Report::from(error.diagnostic(name, &at.file, at.span()))
        })?;
        constants.insert(name.clone(), (value.clone(), typed));
    }
    Ok(constants)
}

/// Whether a label can be part of a name.
pub fn is_identifier(text: &str) -> bool {
    let mut letters = text.chars();
    letters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_') && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
