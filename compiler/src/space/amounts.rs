//! What modules declare of the things of which a target has only so many.

use indexmap::IndexMap;
use naga::{AddressSpace, TypeInner};

use crate::catalog::{Catalog, Module, Variants};
use crate::diagnostics::Report;
use crate::limits::INSTANCES;
use crate::manifest::{ParamMode, default_of};
use crate::parse::{Origin, Unit};

use super::format::Limits;

/// Modules, textures, samplers, storage buffers, uniform buffers, bindings.
pub type Amounts = [u32; 6];

const MODULES: usize = 0;
const TEXTURES: usize = 1;
const SAMPLERS: usize = 2;
const STORAGE: usize = 3;
const UNIFORM: usize = 4;
const BINDINGS: usize = 5;

/// What each limited thing is called.
pub const NAMES: [&str; 6] = ["modules", "textures", "samplers", "storage buffers", "uniform buffers", "bindings"];

impl Limits {
    /// The most of each thing; `None` where there is no limit.
    pub(super) fn most(&self) -> [Option<u32>; 6] {
        [
            Some(INSTANCES as u32),
            self.textures,
            self.samplers,
            self.storage_buffers,
            self.uniform_buffers,
            self.bindings,
        ]
    }

    /// Whether bindings must be counted.
    pub(super) fn binds(&self) -> bool {
        self.most()[1..].iter().any(Option::is_some)
    }
}

/// What a module by itself declares.
///
/// # Errors
/// Its WGSL, from which the types of its resources are known, cannot be read.
pub fn of_module(catalog: &Catalog, module: &std::sync::Arc<Module>, limits: &Limits) -> Result<Amounts, Report> {
    let mut amounts = [0; 6];
    amounts[MODULES] = 1;
    if !limits.binds() {
        return Ok(amounts);
    }
    let mut constants = IndexMap::new();
    for (name, param) in module.manifest.params.iter().filter(|(_, p)| p.mode == ParamMode::Constant) {
        // A checked manifest's defaults fit.
        if let Ok(value) = default_of(param) {
            constants.insert(name.clone(), (param.default.clone(), value));
        }
    }
    let unit = catalog.unit(module, &constants, &Variants::key(&constants))?;
    add_resources(&unit, &mut amounts);
    if !module.manifest.instances.is_empty() {
        amounts[STORAGE] += 1;
        amounts[BINDINGS] += 1;
    }
    Ok(amounts)
}

/// What the interfaces' own resources and the parameters' uniform buffers come to, at most, in a tree of these modules.
///
/// # Errors
/// An interface's WGSL cannot be read.
pub fn shared<'m>(catalog: &Catalog, modules: impl Iterator<Item = &'m Module>, limits: &Limits) -> Result<Amounts, Report> {
    let mut amounts = [0; 6];
    if !limits.binds() {
        return Ok(amounts);
    }
    let mut queue = Vec::new();
    let mut groups = Vec::new();
    for module in modules {
        queue.push(module.category.clone());
        queue.extend(module.manifest.uses.iter().cloned());
        queue.extend(module.manifest.slots.values().map(|slot| slot.interface.clone()));
        let group = catalog.category(&module.category).map_or(3, |category| category.manifest.group);
        if module.manifest.params.values().any(|param| param.mode == ParamMode::Uniform) && !groups.contains(&group) {
            groups.push(group);
        }
    }
    amounts[UNIFORM] += groups.len() as u32;
    amounts[BINDINGS] += groups.len() as u32;
    let mut known: Vec<String> = Vec::new();
    while let Some(category) = queue.pop() {
        if known.contains(&category) {
            continue;
        }
        let unit = catalog.interface_unit(&category)?;
        add_resources(&unit, &mut amounts);
        queue.extend(catalog.category(&category).iter().flat_map(|c| c.manifest.uses.iter().cloned()));
        known.push(category);
    }
    Ok(amounts)
}

/// Adds the resources that a text declares itself.
fn add_resources(unit: &Unit, amounts: &mut Amounts) {
    for (_, global) in unit.ir.global_variables.iter() {
        let name = global.name.as_deref().unwrap_or_default();
        if unit.origin(name) != Some(&Origin::Own) {
            continue;
        }
        let mut inner = &unit.ir.types[global.ty].inner;
        let mut number = 1;
        if let TypeInner::BindingArray { base, size } = inner {
            inner = &unit.ir.types[*base].inner;
            if let naga::ArraySize::Constant(size) = size {
                number = size.get();
            }
        }
        let kind = match (global.space, inner) {
            (AddressSpace::Uniform, _) => Some(UNIFORM),
            (AddressSpace::Storage { .. }, _) => Some(STORAGE),
            (AddressSpace::Handle, TypeInner::Sampler { .. }) => Some(SAMPLERS),
            (
                AddressSpace::Handle,
                TypeInner::Image {
                    class: naga::ImageClass::Storage { .. },
                    ..
                },
            ) => None,
            (AddressSpace::Handle, _) => Some(TEXTURES),
            _ => continue,
        };
        if let Some(kind) = kind {
            amounts[kind] += number;
        }
        amounts[BINDINGS] += 1;
    }
}
