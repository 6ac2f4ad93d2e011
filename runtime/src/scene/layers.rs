//! Layers of a glTF file's material, such as a clear coat: modules that represent an extension, brought into the look of the objects that have it.
//!
//! A module of the category of one of the pass's slots, with a slot of its own category, is laid over what stands there (a coat over a BRDF). Any
//! other takes the place of what stands in slots of its category further down (a Fresnel term within a BRDF). What the scene itself says
//! about a slot of the pass stays as it is, and all below it.

#[cfg(test)]
mod tests;

use std::sync::Arc;

use shadewright_compiler::manifest::{Slot, Step};
use shadewright_compiler::{Catalog, Module};

use super::check::Examiner;
use super::gather::{Look, slot_of};
use super::include::representing;
use super::{Choice, Choices, GltfDecl};
use crate::mesh::gltf::Material;

/// Deepest slot that is looked into.
const DEPTH: usize = 8;

/// Brings the layers of a material into its look.
pub(super) fn lay(examiner: &mut Examiner, decl: &GltfDecl, material: &Material, pass: &Module, look: &mut Look, path: &[Step]) {
    let said = &examiner.parsed.value.pass.fill;
    for layer in &material.layers {
        for module in modules(examiner, decl, material, layer, path) {
            let category = &module.category;
            if let (Some(slot), Some(own)) = (slot_of(pass, category), slot_of(&module, category)) {
                if !decl.fill.contains_key(&slot) {
                    let below = standing(&slot, &pass.manifest.slots[&slot], look, said);
                    let mut over = Choice::new(full_name(&module));
                    over.fill.extend(below.map(|below| (own, below)));
                    look.insert(slot, Choices::One(Box::new(over)));
                }
                continue;
            }
            for (slot, declared) in &pass.manifest.slots {
                if decl.fill.contains_key(slot) {
                    continue;
                }
                let Some(mut standing) = standing(slot, declared, look, said) else {
                    continue;
                };
                if replace(&mut standing, &declared.interface, &module, examiner.catalog, DEPTH) {
                    look.insert(slot.clone(), standing);
                }
            }
        }
    }
}

/// The modules that represent a layer, one of each category; of several, the scene names one.
fn modules(examiner: &mut Examiner, decl: &GltfDecl, material: &Material, layer: &str, path: &[Step]) -> Vec<Arc<Module>> {
    let fitting = examiner
        .catalog
        .modules()
        .filter(|m| m.manifest.represents.iter().any(|r| r == layer));
    let fitting: Vec<Arc<Module>> = fitting.cloned().collect();
    let mut categories: Vec<&str> = fitting.iter().map(|m| m.category.as_str()).collect();
    categories.sort_unstable();
    if !decl.modules.contains_key(layer) && !fitting.is_empty() && categories.windows(2).all(|pair| pair[0] != pair[1]) {
        return fitting;
    }
    let place = format!("the material `{}`", material.name);
    representing(examiner, decl, layer, &place, path).into_iter().collect()
}

/// A name that no module of another category has.
fn full_name(module: &Module) -> String {
    format!("{}/{}", module.category, module.name)
}

/// What stands in a slot of the pass: by the look so far, by the scene's pass, by default.
fn standing(name: &str, slot: &Slot, look: &Look, said: &Look) -> Option<Choices> {
    let chosen = look.get(name).or_else(|| said.get(name)).cloned();
    chosen.or_else(|| slot.default.as_ref().map(Choices::from))
}

/// Puts the module into all slots of its category below these choices for a slot of the interface; whether there are any.
fn replace(choices: &mut Choices, interface: &str, module: &Module, catalog: &Catalog, depth: usize) -> bool {
    let all = match choices {
        Choices::One(one) => std::slice::from_mut(&mut **one),
        Choices::Many(many) => many.as_mut_slice(),
    };
    let mut found = false;
    for choice in all {
        let Ok(known) = catalog.module_for(interface, &choice.module) else {
            continue;
        };
        for (name, slot) in &known.manifest.slots {
            if slot.interface == module.category {
                let replacement = Choices::One(Box::new(Choice::new(full_name(module))));
                choice.fill.insert(name.clone(), replacement);
                found = true;
            } else if depth > 0 {
                let below = choice.fill.get(name).cloned().or_else(|| slot.default.as_ref().map(Choices::from));
                let Some(mut below) = below else { continue };
                if replace(&mut below, &slot.interface, module, catalog, depth - 1) {
                    choice.fill.insert(name.clone(), below);
                    found = true;
                }
            }
        }
    }
    found
}
