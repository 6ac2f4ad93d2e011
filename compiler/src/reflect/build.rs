//! Reflection of a linked pass, from the plan and the linked module.

use std::collections::HashMap;

use super::{
    Binding, BindingType, Fill, FunctionOrigin, Instance, Layouts, Override, ParamPlace, ParamUse, Pass, Reflection, SCHEMA_VERSION,
    binding_type, entry_point, stages_using, wgsl_type_name,
};
use crate::parse::constant_name;
use crate::plan::{Body, Declared, Plan};
use crate::validate::Validated;

/// Reflects a pass.
pub fn reflect(plan: &Plan, validated: &Validated, hash: u128, pass: &str) -> Reflection {
    let module = validated.module();
    let bindings = bindings(plan, validated);
    let reached: Vec<bool> = (0..plan.instances.list.len())
        .map(|i| plan.functions.iter().any(|f| f.home == i))
        .collect();
    let mut capabilities: Vec<String> = Vec::new();
    let mut passes = Vec::new();
    for (index, instance) in plan.instances.list.iter().enumerate() {
        let manifest = &plan.tree.nodes[instance.node].module.manifest;
        if reached[index] {
            capabilities.extend(manifest.capabilities.iter().cloned());
            // A pass of the tree's own modules does not run before itself.
            let own = manifest
                .passes
                .iter()
                .filter(|(name, _)| pass == "main" && format!("{}.{name}", instance.name) != pass);
            passes.extend(own.map(|(name, declared)| Pass {
                instance: instance.name.clone(),
                name: name.clone(),
                declared: declared.clone(),
            }));
        }
    }
    capabilities.sort();
    capabilities.dedup();
    Reflection {
        version: SCHEMA_VERSION,
        hash: format!("{hash:032x}"),
        pass: pass.to_owned(),
        entry_points: module.entry_points.iter().filter_map(|e| entry_point(module, e)).collect(),
        overrides: overrides(plan, validated),
        params: params(plan, validated, &bindings),
        bindings,
        functions: functions(plan),
        instances: instances(plan),
        capabilities,
        passes,
    }
}

fn bindings(plan: &Plan, validated: &Validated) -> Vec<Binding> {
    let (module, info) = (validated.module(), validated.info());
    // Fails only for types that validation has already refused.
    let Ok(layouts) = Layouts::new(module) else { return Vec::new() };
    let mut by_place = HashMap::new();
    for block in &plan.blocks {
        by_place.insert((block.group, block.binding), (Fill::Params, String::new()));
    }
    for global in &plan.globals {
        let Some(place) = global.binding else { continue };
        let unit = &plan.homes[global.home].unit;
        let name = unit.ir.global_variables[global.handle].name.clone().unwrap_or_default();
        let instance = plan.homes[global.home].instance.map(|i| plan.instances.list[i].name.clone());
        let fill = match (&instance, global.declared.as_ref().and_then(Declared::resource)) {
            (Some(instance), _) if unit.instances == Some(global.handle) => {
                let instance = instance.clone();
                (Fill::Instances { instance }, String::new())
            }
            (_, Some(resource)) => {
                let fill = Fill::Resource {
                    instance,
                    resource: name,
                    declared: resource.kind.clone(),
                };
                (fill, resource.doc.clone())
            }
            (_, None) => continue,
        };
        by_place.insert(place, fill);
    }
    let mut bindings: Vec<Binding> = module
        .global_variables
        .iter()
        .filter_map(|(handle, global)| {
            let place = global.binding.as_ref()?;
            let (fill, doc) = by_place.get(&(place.group, place.binding))?.clone();
            Some(Binding {
                group: place.group,
                binding: place.binding,
                name: global.name.clone().unwrap_or_default(),
                stages: stages_using(module, info, handle),
                ty: binding_type(module, info, &layouts, handle)?,
                fill,
                doc,
            })
        })
        .collect();
    bindings.sort_by_key(|b| (b.group, b.binding));
    bindings
}

fn overrides(plan: &Plan, validated: &Validated) -> Vec<Override> {
    let module = validated.module();
    let mut found = Vec::new();
    for (index, instance) in plan.instances.list.iter().enumerate() {
        for (name, (_, default)) in &plan.homes[index].unit.needs.overrides {
            let Some(emitted) = plan.name(index, &constant_name(name)) else {
                continue;
            };
            let linked = module.overrides.iter().find(|(_, o)| o.name.as_deref() == Some(emitted));
            if let (Some((_, linked)), Some(default)) = (linked, default.number()) {
                found.push(Override {
                    name: emitted.to_owned(),
                    ty: wgsl_type_name(module, linked.ty),
                    instance: instance.name.clone(),
                    param: name.clone(),
                    default,
                });
            }
        }
    }
    found
}

fn params(plan: &Plan, validated: &Validated, bindings: &[Binding]) -> Vec<ParamUse> {
    let module = validated.module();
    let mut found = Vec::new();
    for (index, instance) in plan.instances.list.iter().enumerate() {
        let node = &plan.tree.nodes[instance.node];
        // What says whether a slot is filled is nobody's to set.
        let params = node.module.manifest.params.iter();
        for (name, declared) in params.filter(|(_, declared)| declared.filled_slot().is_none()) {
            if let Some(place) = place(plan, module, bindings, index, name) {
                found.push(ParamUse {
                    instance: instance.name.clone(),
                    module: node.module.name.clone(),
                    name: name.clone(),
                    ty: declared.ty,
                    declared: declared.clone(),
                    place,
                });
            }
        }
    }
    found
}

/// Where a parameter is in the linked module; `None` where nothing reads it.
fn place(plan: &Plan, module: &naga::Module, bindings: &[Binding], home: usize, name: &str) -> Option<ParamPlace> {
    let node = &plan.tree.nodes[plan.instances.list[home].node];
    let shared = plan.shared_home(home);
    if let Some((value, _)) = node.constants.get(name) {
        let emitted = plan.name(shared, &constant_name(name))?;
        let there = module.constants.iter().any(|(_, c)| c.name.as_deref() == Some(emitted));
        return (there || folded(plan, home, name)).then(|| ParamPlace::Constant { value: value.clone() });
    }
    if let Some(emitted) = plan.name(home, &constant_name(name)) {
        let there = module.overrides.iter().any(|(_, o)| o.name.as_deref() == Some(emitted));
        return there.then(|| ParamPlace::Override { name: emitted.to_owned() });
    }
    for block in &plan.blocks {
        let Some(position) = block.members.iter().position(|m| m.home == home && m.param == name) else {
            continue;
        };
        let binding = bindings.iter().find(|b| (b.group, b.binding) == (block.group, block.binding))?;
        let BindingType::Uniform { layout } = &binding.ty else {
            return None;
        };
        let member = layout.members.get(position)?;
        return Some(ParamPlace::Uniform {
            group: block.group,
            binding: block.binding,
            offset: member.offset,
            member: member.name.clone(),
        });
    }
    None
}

/// A constant that the parser folded into other expressions, or that decided a branch, leaves no trace in the IR. It counts
/// as used if the home has any function in the shader.
fn folded(plan: &Plan, home: usize, name: &str) -> bool {
    let unit = &plan.homes[home].unit;
    let mentions = crate::parse::param_uses(&unit.file.text, &unit.scan)
        .iter()
        .any(|(used, _)| *used == name);
    mentions && plan.functions.iter().any(|f| f.home == home)
}

fn functions(plan: &Plan) -> Vec<FunctionOrigin> {
    plan.functions
        .iter()
        .map(|planned| {
            let home = &plan.homes[planned.home];
            let source = planned.source_name(&plan.homes).to_owned();
            let combined = matches!(planned.body, Body::Combined { .. });
            let item = home.unit.scan.item(&source).filter(|_| !combined);
            let node = home.instance.map(|i| &plan.tree.nodes[plan.instances.list[i].node]);
            let file = &home.unit.file;
            let (file, line) = item.map_or((file.name.as_str(), 0), |i| file.line_of(i.span.start, i.line));
            FunctionOrigin {
                name: planned.name.clone(),
                source,
                instance: home.instance.map(|i| plan.instances.list[i].name.clone()),
                module: node.map_or_else(|| home.unit.interface.clone().unwrap_or_default(), |n| n.module.name.clone()),
                file: file.to_owned(),
                line: line as u32,
            }
        })
        .collect()
}

fn instances(plan: &Plan) -> Vec<Instance> {
    plan.instances
        .list
        .iter()
        .map(|instance| {
            let node = &plan.tree.nodes[instance.node];
            Instance {
                name: instance.name.clone(),
                module: node.module.name.clone(),
                category: node.module.category.clone(),
                paths: instance.nodes.iter().map(|&n| plan.tree.path(n)).collect(),
                fields: node.module.manifest.instances.clone(),
                files: node.files.clone(),
            }
        })
        .collect()
}
