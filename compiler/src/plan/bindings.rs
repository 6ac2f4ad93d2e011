//! Bindings and uniform blocks, numbered over the whole tree.

use std::sync::Arc;

use rustc_hash::FxHashSet as HashSet;

use naga::{AddressSpace, GlobalVariable, Handle};

use super::Plan;
use crate::catalog::{Catalog, Category, Module};
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::manifest::Resource;
use crate::parse::Origin;
use crate::resolve::check_data;

/// Names of the bind groups' parameter blocks, by group: frame, lights and shadows, material, pass.
pub const GROUPS: [&str; 4] = ["frame", "light", "material", "pass"];

/// A module-scope variable that is reached.
#[derive(Clone, Debug)]
pub struct PlannedGlobal {
    /// Home that declares it.
    pub home: usize,
    /// In its unit.
    pub handle: Handle<GlobalVariable>,
    /// Group and binding; `None` for private and workgroup variables.
    pub binding: Option<(u32, u32)>,
    /// What its manifest says of it; nothing for `instances` and for private and workgroup variables.
    pub declared: Option<Declared>,
}

/// A resource where it is declared.
#[derive(Clone, Debug)]
pub enum Declared {
    /// In a module's manifest, by its number there.
    Module(Arc<Module>, usize),
    /// In a category's manifest.
    Category(Arc<Category>, usize),
}

impl Declared {
    /// The declaration.
    pub fn resource(&self) -> Option<&Resource> {
        let (resources, index) = match self {
            Self::Module(module, index) => (&module.manifest.resources, *index),
            Self::Category(category, index) => (&category.manifest.resources, *index),
        };
        resources.get_index(index).map(|(_, resource)| resource)
    }
}

/// The uniform parameters of one group.
#[derive(Clone, Debug)]
pub struct Block {
    /// Bind group.
    pub group: u32,
    /// Binding.
    pub binding: u32,
    /// Members in order.
    pub members: Vec<BlockMember>,
}

/// A parameter in a block.
#[derive(Clone, Debug)]
pub struct BlockMember {
    /// Home whose parameter it is.
    pub home: usize,
    /// Index in the unit's `Params`.
    pub index: u32,
    /// The parameter.
    pub param: String,
    /// Name in the block.
    pub name: String,
}

/// Numbers what is reached: in each group the parameters first, then the interfaces' resources, then those of the
/// instances in tree order, each in the order of its text.
pub fn allocate(catalog: &Catalog, plan: &mut Plan) -> Result<(), Report> {
    let reached = reached(plan);
    let mut next = [0u32; GROUPS.len()];
    let mut members: [Vec<BlockMember>; GROUPS.len()] = Default::default();
    block_members(catalog, plan, &mut members);
    for (group, members) in members.into_iter().enumerate().filter(|(_, members)| !members.is_empty()) {
        plan.blocks.push(Block {
            group: group as u32,
            binding: 0,
            members,
        });
        next[group] = 1;
    }
    let interfaces = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_none());
    let instances = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_some());
    let order: Vec<usize> = interfaces.chain(instances).collect();
    for home in order {
        let unit = &plan.homes[home].unit;
        for (handle, global) in unit.ir.global_variables.iter() {
            if !reached.contains(&(home, handle)) || unit.params == Some(handle) {
                continue;
            }
            let bound = matches!(
                global.space,
                AddressSpace::Uniform | AddressSpace::Storage { .. } | AddressSpace::Handle
            );
            let mut declared = None;
            // Only a text that is complete in itself brings bindings.
            let mut binding = global.binding.as_ref().map(|b| (b.group, b.binding));
            if bound && binding.is_none() {
                let group;
                (group, declared) = place(catalog, plan, home, handle)?;
                if let Some(Declared::Module(module, index)) = &declared {
                    check_data(module, *index, unit, handle)?;
                }
                let number = &mut next[group as usize];
                binding = Some((group, *number));
                *number += 1;
            }
            plan.globals.push(PlannedGlobal {
                home,
                handle,
                binding,
                declared,
            });
        }
    }
    Ok(())
}

/// Variables that live expressions name, by the home that declares them.
fn reached(plan: &Plan) -> HashSet<(usize, Handle<GlobalVariable>)> {
    let mut named = HashSet::default();
    let mut reached = HashSet::default();
    for planned in &plan.functions {
        let Some(facts) = planned.facts(&plan.homes) else { continue };
        for &(handle, global) in &facts.globals {
            if planned.live[handle.index()] && named.insert((planned.home, global)) {
                reached.insert(declaring(plan, planned.home, global));
            }
        }
    }
    reached
}

/// The home and handle that a variable really is: a unit also holds copies of its interfaces' variables.
pub fn declaring(plan: &Plan, home: usize, global: Handle<GlobalVariable>) -> (usize, Handle<GlobalVariable>) {
    let unit = &plan.homes[home].unit;
    let name = unit.ir.global_variables[global].name.as_deref().unwrap_or_default();
    if let Some(Origin::Interface(category)) = unit.origin(name) {
        let declared = plan.homes.iter().position(|h| h.unit.interface.as_ref() == Some(category));
        if let Some(interface) = declared {
            let found = plan.homes[interface]
                .unit
                .ir
                .global_variables
                .iter()
                .find(|(_, g)| g.name.as_deref() == Some(name));
            if let Some((handle, _)) = found {
                return (interface, handle);
            }
        }
    }
    (home, global)
}

/// The members of each group's block.
fn block_members(catalog: &Catalog, plan: &Plan, members: &mut [Vec<BlockMember>]) {
    for (index, instance) in plan.instances.list.iter().enumerate() {
        let uniforms = &plan.homes[index].unit.needs.uniforms;
        if uniforms.is_empty() {
            continue;
        }
        let module = &plan.tree.nodes[instance.node].module;
        let group = catalog.category(&module.category).map_or(3, |c| c.manifest.group);
        for (position, param) in uniforms.keys().enumerate() {
            if plan.live_params.contains(&(index, position as u32)) {
                members[group as usize].push(BlockMember {
                    home: index,
                    index: position as u32,
                    param: param.clone(),
                    name: [&instance.name, "_", param].concat(),
                });
            }
        }
    }
}

/// What a home's manifest says of a variable.
fn declared(catalog: &Catalog, plan: &Plan, home: usize, name: &str) -> Option<Declared> {
    Some(match plan.homes[home].instance {
        Some(instance) => {
            let module = &plan.tree.nodes[plan.instances.list[instance].node].module;
            Declared::Module(Arc::clone(module), module.manifest.resources.get_index_of(name)?)
        }
        None => {
            let category = catalog.category(plan.homes[home].unit.interface.as_deref()?)?;
            Declared::Category(Arc::clone(category), category.manifest.resources.get_index_of(name)?)
        }
    })
}

/// The bind group of a resource, and what its manifest says of it.
fn place(catalog: &Catalog, plan: &Plan, home: usize, handle: Handle<GlobalVariable>) -> Result<(u32, Option<Declared>), Report> {
    let unit = &plan.homes[home].unit;
    let name = unit.ir.global_variables[handle].name.as_deref().unwrap_or_default();
    let category = match plan.homes[home].instance {
        Some(instance) => Some(plan.tree.nodes[plan.instances.list[instance].node].module.category.as_str()),
        None => unit.interface.as_deref(),
    };
    let group = category.and_then(|c| catalog.category(c)).map_or(3, |c| c.manifest.group);
    if unit.instances == Some(handle) {
        return Ok((group, None));
    }
    let declared = declared(catalog, plan, home, name);
    let Some(resource) = declared.as_ref().and_then(Declared::resource) else {
        let span = unit.scan.item(name).map_or(0..0, |i| i.name_span.clone());
        return Err(Diagnostic::new(
            codes::UNDECLARED_RESOURCE,
            format!("the manifest does not declare the resource `{name}`"),
        )
        .at(&unit.file, span, "declared here, but not under `resources`")
        .note("the host must know how to fill it: add it to `resources` of the manifest beside this file")
        .into());
    };
    Ok((resource.group.unwrap_or(group), declared))
}
