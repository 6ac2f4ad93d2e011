//! Another module in a row's place. What the old one was told and the new one understands as well is kept.

use shadewright_compiler::manifest::Param;
use shadewright_compiler::{Catalog, Module, Report};

use super::{Kind, Row};
use crate::document::{Draft, quoted, step_path};

/// The name by which a slot takes a module.
pub fn name_in(catalog: &Catalog, module: &Module) -> String {
    let alone = catalog.module(&module.name).is_ok_and(|found| found.category == module.category);
    if alone {
        module.name.clone()
    } else {
        format!("{}/{}", module.category, module.name)
    }
}

/// Chooses a module for a row; `None` empties the slot, or goes back to its default.
///
/// # Errors
/// What comes out is no scene.
pub fn choose(draft: &mut Draft, catalog: &Catalog, row: &Row, module: Option<&Module>) -> Result<(), Report> {
    let Some(module) = module else {
        return draft.unset(&row.path);
    };
    let text = if row.is_light() {
        light(draft, catalog, row, module)
    } else {
        let mut fields = vec![format!("module: {}", quoted(&name_in(catalog, module)))];
        fields.extend(kept(draft, row, module));
        match fields.as_slice() {
            [_] => quoted(&name_in(catalog, module)),
            fields => format!("({})", fields.join(", ")),
        }
    };
    draft.set(&row.above, &row.path, &text)
}

/// A new element for a list: the module, and for a light a name and a place above the scene.
pub fn element(catalog: &Catalog, list: &str, module: &Module) -> String {
    let name = quoted(&name_in(catalog, module));
    if list == "lights" {
        format!("(name: {}, module: {name})", quoted(&module.name))
    } else {
        name
    }
}

/// The fields of the old module's choice that the new one understands.
fn kept(draft: &Draft, row: &Row, module: &Module) -> Vec<String> {
    let Some(old) = &row.module else { return Vec::new() };
    let mut fields = Vec::new();
    let same = |a: Option<&Param>, b: Option<&Param>| matches!((a, b), (Some(a), Some(b)) if a.ty == b.ty && a.unit == b.unit && a.range == b.range);
    for part in ["params", "freeze"] {
        let names = old.manifest.params.keys();
        let names = names.filter(|name| same(old.manifest.params.get(*name), module.manifest.params.get(*name)));
        fields.extend(map(draft, &row.path, part, names));
    }
    let fits = |slot: &&String| {
        module.manifest.slots.get(*slot).map(|s| (&s.interface, s.arity)) == old.manifest.slots.get(*slot).map(|s| (&s.interface, s.arity))
    };
    fields.extend(map(draft, &row.path, "fill", old.manifest.slots.keys().filter(fits)));
    let resource =
        |name: &&String| module.manifest.resources.get(*name).map(|r| &r.kind) == old.manifest.resources.get(*name).map(|r| &r.kind);
    for part in ["textures", "files"] {
        fields.extend(map(draft, &row.path, part, old.manifest.resources.keys().filter(resource)));
    }
    fields
}

/// `params: {"a": 1, "b": 2}` of what the scene says under these names; `None` where it says nothing.
fn map<'n>(draft: &Draft, path: &str, part: &str, names: impl Iterator<Item = &'n String>) -> Option<String> {
    let said = names.filter_map(|name| {
        let value = draft.scene.get(&format!("{path}.{part}{}", step_path(name)))?;
        Some(format!("{}: {value}", quoted(name)))
    });
    let said: Vec<String> = said.collect();
    (!said.is_empty()).then(|| format!("{part}: {{{}}}", said.join(", ")))
}

/// A light's declaration with another module.
fn light(draft: &Draft, catalog: &Catalog, row: &Row, module: &Module) -> String {
    let said = |field: &str| {
        let value = draft.scene.get(&format!("{}.{field}", row.path))?;
        Some(format!("{field}: {value}"))
    };
    let mut fields: Vec<String> = said("name").into_iter().collect();
    fields.push(format!("module: {}", quoted(&name_in(catalog, module))));
    if let Some(old) = &row.module {
        let (old, new) = (&old.manifest.instances, &module.manifest.instances);
        let understood = |name: &&String| {
            let (a, b) = (old.get(*name), new.get(*name));
            // Units may differ in name and be taken all the same.
            matches!((a, b), (Some(a), Some(b)) if a.ty == b.ty && a.unit == b.unit && a.range == b.range)
        };
        fields.extend(map(draft, &row.path, "fields", old.keys().filter(understood)));
    }
    fields.extend(kept(draft, row, module));
    if module.manifest.slots.values().any(|slot| slot.interface == "visibility") {
        fields.extend(said("visibility"));
    }
    fields.extend(said("casts_shadow"));
    format!("({})", fields.join(", "))
}

impl Row {
    /// Path of the list that an element can be added to.
    pub fn list(&self) -> Option<&str> {
        match &self.kind {
            Kind::List { .. } => Some(&self.path),
            Kind::Heading(super::Part::Lights) => Some("lights"),
            _ => None,
        }
    }
}
