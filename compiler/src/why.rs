//! Why something is in a shader: who calls it, whose it is, and which line of RON brought that module in.

use crate::parse::Origin;
use crate::parse::joined;
use crate::parse::lex::lex;
use crate::parse::scan::{Item, ItemKind};
use crate::plan::{Body, GROUPS, Plan};
use crate::reflect::{ParamPlace, Reflection};

/// Why something is in a shader.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Why {
    /// Emitted name that was asked for.
    pub name: String,
    /// `entry point`, `function`, `binding`, `parameter`, `override`, `struct` or `constant`.
    pub kind: String,
    /// Emitted function names from the entry point to the one that needs it.
    pub path: Vec<String>,
    /// Module it belongs to (category for an interface's own).
    pub module: String,
    /// Slot path of the instance in the recipe; empty for an interface's own.
    pub place: String,
    /// `file:line:column` of the RON text that brought the module in: the recipe's line, or the manifest's where it is a default.
    pub because: String,
}

/// Answers for every emitted thing of this name; a parameter is also found by its own name.
pub fn why(plan: &Plan, reflection: &Reflection, wgsl: &str, name: &str) -> Vec<Why> {
    let mut found = Vec::new();
    for (index, planned) in plan.functions.iter().enumerate() {
        if planned.name == name {
            let kind = if matches!(planned.body, Body::Entry(_)) {
                "entry point"
            } else {
                "function"
            };
            found.push(answer(plan, name, kind, planned.home, path_to(plan, index)));
        }
    }
    for param in &reflection.params {
        let emitted = match &param.place {
            ParamPlace::Uniform { member, .. } => member,
            ParamPlace::Override { name } => name,
            ParamPlace::Constant { .. } => &param.name,
        };
        if (emitted == name || param.name == name || format!("{}.{}", param.instance, param.name) == name)
            && let Some(home) = plan.instances.list.iter().position(|i| i.name == param.instance)
        {
            found.push(answer(
                plan,
                name,
                "parameter",
                home,
                user(plan, home, |e, unit| reads_param(e, unit, &param.name)),
            ));
        }
    }
    if let Some(block) = plan.blocks.iter().find(|b| {
        let group = GROUPS[b.group as usize];
        format!("{group}_params") == name || joined(group, "Params") == name
    }) {
        for member in &block.members {
            found.push(answer(
                plan,
                name,
                "binding",
                member.home,
                user(plan, member.home, |e, unit| reads_param(e, unit, &member.param)),
            ));
        }
    }
    for global in &plan.globals {
        let unit = &plan.homes[global.home].unit;
        let own = unit.ir.global_variables[global.handle].name.clone().unwrap_or_default();
        let emitted = plan.name(global.home, &own).unwrap_or(&own);
        if emitted == name {
            let path = (0..plan.functions.len()).find(|&f| reads_global(plan, f, global.home, global.handle));
            found.push(answer(
                plan,
                name,
                "binding",
                global.home,
                path.map_or_else(Vec::new, |f| path_to(plan, f)),
            ));
        }
    }
    if found.is_empty() {
        found.extend(
            plan.names
                .all(&plan.homes)
                .filter(|&(_, _, emitted)| emitted == name)
                .filter_map(|(home, own, _)| item(plan, wgsl, name, home, own)),
        );
    }
    found
}

/// A struct or constant. The plan names more than the shader holds, so it must stand in the text.
fn item(plan: &Plan, wgsl: &str, name: &str, home: usize, own: &str) -> Option<Why> {
    if !lex(wgsl).iter().any(|token| &wgsl[token.range()] == name) {
        return None;
    }
    let unit = &plan.homes[home].unit;
    let kind = match unit.scan.item(own).map(|item| item.kind) {
        Some(ItemKind::Struct) => "struct",
        Some(ItemKind::Constant | ItemKind::Alias) => "constant",
        Some(ItemKind::Override) => "override",
        None if unit.origin(own) == Some(&Origin::Instances) => "struct",
        _ => return None,
    };
    let knows = |h: usize| h == home || matches!(plan.homes[h].unit.origin(own), Some(Origin::Interface(_)));
    let mentions = |h: usize, item: &str| {
        let unit = &plan.homes[h].unit;
        let words = |item: &Item| {
            item.references
                .iter()
                .any(|r| &unit.file.text[unit.scan.tokens[r.token].range()] == own)
        };
        knows(h) && unit.scan.item(item).is_some_and(words)
    };
    // The first function whose text names it; or the function that reads a variable of its type.
    let by_function = plan.functions.iter().position(|p| mentions(p.home, p.source_name(&plan.homes)));
    let by_variable = || {
        let typed = plan.globals.iter().filter(|g| {
            let global = &plan.homes[g.home].unit.ir.global_variables[g.handle];
            let variable = global.name.as_deref().unwrap_or_default();
            mentions(g.home, variable) || (g.home == home && own == "Instance" && variable == "instances")
        });
        typed
            .flat_map(|g| (0..plan.functions.len()).find(|&f| reads_global(plan, f, g.home, g.handle)))
            .next()
    };
    let path = by_function.or_else(by_variable).map_or_else(Vec::new, |user| path_to(plan, user));
    Some(answer(plan, name, kind, home, path))
}

fn answer(plan: &Plan, name: &str, kind: &str, home: usize, path: Vec<String>) -> Why {
    let (module, place, because) = match plan.homes[home].instance {
        Some(instance) => {
            let node = plan.instances.list[instance].node;
            let module = plan.tree.nodes[node].module.name.clone();
            (module, plan.tree.path(node), plan.tree.place(node).text())
        }
        None => {
            let unit = &plan.homes[home].unit;
            (unit.interface.clone().unwrap_or_default(), String::new(), unit.file.name.clone())
        }
    };
    Why {
        name: name.to_owned(),
        kind: kind.to_owned(),
        path,
        module,
        place,
        because,
    }
}

/// Emitted names from the entry point to a function.
fn path_to(plan: &Plan, function: usize) -> Vec<String> {
    let mut path = vec![plan.functions[function].name.clone()];
    let mut at = function;
    while let Some(caller) = plan.functions[at].caller {
        path.insert(0, plan.functions[caller].name.clone());
        at = caller;
    }
    path
}

/// The way to the first function of a home with a living expression that fits.
fn user(plan: &Plan, home: usize, fits: impl Fn(&naga::Function, &crate::parse::Unit) -> bool) -> Vec<String> {
    let found = plan
        .functions
        .iter()
        .position(|p| p.home == home && p.ir(&plan.homes).is_some_and(|f| fits(f, &plan.homes[home].unit)));
    found.map_or_else(Vec::new, |f| path_to(plan, f))
}

fn reads_param(function: &naga::Function, unit: &crate::parse::Unit, param: &str) -> bool {
    let index = unit.needs.uniforms.get_index_of(param).map(|i| i as u32);
    let constant = crate::parse::constant_name(param);
    function.expressions.iter().any(|(_, e)| match *e {
        naga::Expression::AccessIndex { base, index: member } => {
            Some(member) == index && matches!(function.expressions[base], naga::Expression::GlobalVariable(g) if unit.params == Some(g))
        }
        naga::Expression::Constant(c) => unit.ir.constants[c].name.as_ref() == Some(&constant),
        naga::Expression::Override(o) => unit.ir.overrides[o].name.as_ref() == Some(&constant),
        _ => false,
    })
}

fn reads_global(plan: &Plan, function: usize, home: usize, global: naga::Handle<naga::GlobalVariable>) -> bool {
    let planned = &plan.functions[function];
    planned.ir(&plan.homes).is_some_and(|f| {
        f.expressions.iter().any(|(h, e)| match *e {
            naga::Expression::GlobalVariable(g) => {
                planned.live[h.index()] && crate::plan::declaring(plan, planned.home, g) == (home, global)
            }
            _ => false,
        })
    })
}
