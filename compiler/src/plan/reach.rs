//! From the entry points to every function that is called, across modules.

use rustc_hash::FxHashMap as HashMap;
use std::collections::BTreeSet;
use std::sync::Arc;

use naga::Handle;
use rayon::prelude::*;

use super::{Body, Calls, Home, ITEMS, Names, Plan, Planned, Structs, bindings, live, names};
use crate::catalog::Catalog;
use crate::contracts::compute_entry;
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::manifest::{Combine, PassDecl};
use crate::parse::{Origin, Unit};
use crate::resolve::{Instance, Instances, Place, Tree, TreeNode};
use crate::upstream::guarded;

/// Which entry points a plan starts from.
#[derive(Clone, Debug)]
pub enum Roots {
    /// All of the root module.
    Main,
    /// One of an instance.
    Entry {
        /// The instance.
        instance: usize,
        /// Its entry point.
        entry: String,
    },
}

/// Deepest nesting of blocks that is linked on the caller's own stack.
const SHALLOW_BLOCKS: usize = 24;
/// Longest possible chain of calls that is followed there.
const SHALLOW_CALLS: usize = 512;

/// Plans a pass of a resolved tree.
///
/// # Errors
/// Units do not parse, do not fit together, or call each other in a circle.
pub fn plan(catalog: &Catalog, tree: Tree, instances: Instances, roots: &Roots) -> Result<Plan, Report> {
    let reach = prepare(catalog, tree, instances)?;
    let units = || reach.homes.iter().map(|h| h.unit.depth);
    let deep = units().any(|(blocks, _)| blocks > SHALLOW_BLOCKS) || units().map(|(_, calls)| calls).sum::<usize>() > SHALLOW_CALLS;
    let mut plan = roomy(deep, || follow(catalog, reach, roots))??;
    plan.deep = deep;
    Ok(plan)
}

/// Does work that recurses as deep as functions are nested or call each other, on a large stack where that is deep.
///
/// # Errors
/// There is no such stack to be had, or the work panics on it.
pub fn roomy<T: Send>(deep: bool, work: impl FnOnce() -> T + Send) -> Result<T, Diagnostic> {
    if deep {
        guarded(codes::UPSTREAM_PANIC, "linking", work)
    } else {
        Ok(work())
    }
}

/// Parses all units of a tree.
fn prepare(catalog: &Catalog, tree: Tree, instances: Instances) -> Result<Reach<'_>, Report> {
    let mut reach = Reach {
        catalog,
        tree,
        instances,
        homes: Vec::new(),
        interfaces: HashMap::default(),
        functions: Vec::new(),
        memo: HashMap::default(),
        stack: Vec::new(),
    };
    reach.instance_homes()?;
    Ok(reach)
}

fn follow(catalog: &Catalog, mut reach: Reach, roots: &Roots) -> Result<Plan, Report> {
    reach.roots(roots)?;
    let Reach {
        tree,
        instances,
        homes,
        interfaces,
        functions,
        ..
    } = reach;
    let mut structs = Structs::default();
    for home in 0..homes.len() {
        structs.add(&homes, home, |category| interfaces.get(category).copied());
    }
    let mut plan = Plan {
        tree,
        instances,
        homes,
        functions,
        structs,
        live_params: Default::default(),
        globals: Vec::new(),
        blocks: Vec::new(),
        deep: false,
        names: Names::default(),
    };
    live::analyse(&mut plan);
    bindings::allocate(catalog, &mut plan)?;
    names::assign(&mut plan);
    Ok(plan)
}

/// A place in the plan where a call leads.
type Target = (usize, Body);

struct Reach<'c> {
    catalog: &'c Catalog,
    tree: Tree,
    instances: Instances,
    homes: Vec<Home>,
    interfaces: HashMap<String, usize>,
    functions: Vec<Planned>,
    /// Finished functions.
    memo: HashMap<Target, usize>,
    /// Functions being visited, outermost first, for finding circles.
    stack: Vec<Target>,
}

impl Reach<'_> {
    fn instance_homes(&mut self) -> Result<(), Report> {
        self.parse_ahead();
        for index in 0..self.instances.list.len() {
            let instance = &self.instances.list[index];
            let node = &self.tree.nodes[instance.node];
            // Equal texts are one unit, whatever the catalog still keeps: linking goes by identity.
            let equal = |before: &Instance| {
                let other = &self.tree.nodes[before.node];
                Arc::ptr_eq(&other.module, &node.module) && other.variant == node.variant
            };
            let unit = match self.instances.list[..index].iter().position(equal) {
                Some(before) => Arc::clone(&self.homes[before].unit),
                None => self.catalog.unit(&node.module, &node.constants, &node.variant)?,
            };
            // What the compiler makes itself needs no telling apart.
            let prefix = if node.module.category.is_empty() {
                String::new()
            } else {
                instance.name.clone()
            };
            self.push_home(unit, Some(index), prefix);
        }
        // Every interface that a unit names.
        let named: BTreeSet<&String> = self.homes.iter().flat_map(|home| &home.unit.interfaces).collect();
        let mut names: Vec<String> = named.into_iter().cloned().collect();
        let mut next = 0;
        while next < names.len() {
            let name = names[next].clone();
            next += 1;
            if self.interfaces.contains_key(&name) {
                continue;
            }
            let unit = self.catalog.interface_unit(&name)?;
            names.extend(unit.needs.uses.iter().cloned());
            let home = self.push_home(unit, None, String::new());
            self.interfaces.insert(name, home);
        }
        Ok(())
    }

    /// Parses what is not parsed yet on all cores. What is wrong is found again, and told, by who asks for it in order.
    fn parse_ahead(&self) {
        let mut missing: Vec<&TreeNode> = Vec::new();
        for instance in &self.instances.list {
            let node = &self.tree.nodes[instance.node];
            let is_known = missing
                .iter()
                .any(|other| Arc::ptr_eq(&other.module, &node.module) && other.variant == node.variant);
            if !is_known && node.module.variants.get(&node.variant).is_none() {
                missing.push(node);
            }
        }
        if missing.len() > 1 {
            let parse = |node: &&TreeNode| drop(self.catalog.unit(&node.module, &node.constants, &node.variant));
            missing.par_iter().for_each(parse);
        }
    }

    fn push_home(&mut self, unit: Arc<Unit>, instance: Option<usize>, prefix: String) -> usize {
        let index = self.homes.len();
        let base = self.homes.last().map_or(ITEMS, |h| h.base + h.unit.composed.text.len() as u32 + 1);
        let first = self.homes.iter().position(|h| Arc::ptr_eq(&h.unit, &unit)).unwrap_or(index);
        self.homes.push(Home {
            unit,
            base,
            instance,
            first,
            prefix,
        });
        index
    }

    fn roots(&mut self, roots: &Roots) -> Result<(), Report> {
        let (home, wanted) = match roots {
            Roots::Main => (0, None),
            Roots::Entry { instance, entry } => (*instance, Some(entry)),
        };
        let unit = Arc::clone(&self.homes[home].unit);
        let mut found = false;
        for (index, entry) in unit.ir.entry_points.iter().enumerate() {
            // The root of a tree runs its stages; a module further in is only asked for one of its passes.
            if wanted.is_none_or(|w| *w == entry.name) {
                found = true;
                self.visit((home, Body::Entry(index)))?;
            }
        }
        if found {
            return Ok(());
        }
        let node = &self.tree.nodes[self.instances.list[home].node];
        if let Some(entry) = wanted {
            let runs = |pass: &PassDecl| matches!(pass, PassDecl::Compute { entry: e, .. } if e == entry);
            let pass = node
                .module
                .manifest
                .passes
                .iter()
                .find(|(_, pass)| runs(pass))
                .map_or("", |(name, _)| name);
            return compute_entry(&node.module, &unit, pass, entry);
        }
        let place = self.tree.place(self.instances.list[home].node);
        Err(
            Diagnostic::new(codes::NOT_A_ROOT, format!("`{}` has no entry points", node.module.name))
                .at(&place.file, place.name_span(), "a pass is needed here")
                .note("a subtree without entry points can be probed, not emitted")
                .into(),
        )
    }

    fn visit(&mut self, target: Target) -> Result<usize, Report> {
        if let Some(&done) = self.memo.get(&target) {
            return Ok(done);
        }
        if self.stack.contains(&target) {
            return Err(self.circle(&target));
        }
        self.stack.push(target.clone());
        let (home, body) = target.clone();
        let mut calls = Calls::default();
        let mut targets = Vec::new();
        let pure;
        if let Body::Combined { slot, function, .. } = &body {
            for next in self.list_targets(home, slot, function)? {
                targets.push(self.visit(next)?);
            }
            pure = targets.iter().all(|&t| self.functions[t].pure);
        } else {
            let unit = Arc::clone(&self.homes[home].unit);
            let facts = match body {
                Body::Entry(index) => &unit.facts[unit.ir.functions.len() + index],
                Body::Function(handle) => &unit.facts[handle.index()],
                Body::Combined { .. } => return Ok(0),
            };
            for &handle in &facts.callees {
                let next = self.call(home, handle)?;
                calls.add(handle, self.visit(next)?);
            }
            pure = facts.writes_only_own && calls.ids().all(|id| self.functions[id].pure);
        }
        self.stack.pop();
        let id = self.functions.len();
        self.functions.push(Planned {
            home,
            body,
            calls,
            targets,
            caller: None,
            live: Vec::new(),
            pure,
            name: String::new(),
        });
        self.memo.insert(target, id);
        Ok(id)
    }

    /// Where a call of a unit's function leads from a home.
    fn call(&mut self, home: usize, handle: Handle<naga::Function>) -> Result<Target, Report> {
        let unit = Arc::clone(&self.homes[home].unit);
        let name = unit.ir.functions[handle].name.clone().unwrap_or_default();
        match unit.origin(&name) {
            Some(Origin::Interface(category)) => self.neutral(category, &name),
            Some(Origin::Slot { slot, function }) => self.slot(home, slot, function, handle),
            Some(Origin::Offered { interface, function }) => self.offered(home, interface, function),
            _ if unit.dependent[handle.index()] => Ok((home, Body::Function(handle))),
            _ => Ok((self.homes[home].first, Body::Function(handle))),
        }
    }

    /// An interface's own body.
    fn neutral(&self, category: &str, function: &str) -> Result<Target, Report> {
        let home = self.interfaces.get(category).copied();
        let found = home.and_then(|h| Some((h, Body::Function(*self.homes[h].unit.functions.get(function)?))));
        found.ok_or_else(|| {
            Diagnostic::new(
                codes::MISSING_FUNCTION,
                format!("the interface `{category}` has no function `{function}`"),
            )
            .into()
        })
    }

    fn slot(&self, home: usize, slot: &str, function: &str, stub: Handle<naga::Function>) -> Result<Target, Report> {
        let node = self.node(home);
        let Some((declared, nodes)) = node.and_then(|n| self.tree.nodes[n].slot(slot)) else {
            return self.neutral(slot, function);
        };
        match nodes[..] {
            [] => self.neutral(&declared.interface, function),
            [one] => self.implementation(one, function),
            _ => {
                let rule = self.rule(home, &declared.interface, slot, function)?;
                Ok((
                    home,
                    Body::Combined {
                        stub,
                        rule,
                        slot: slot.to_owned(),
                        function: function.to_owned(),
                    },
                ))
            }
        }
    }

    fn node(&self, home: usize) -> Option<usize> {
        Some(self.instances.list[self.homes[home].instance?].node)
    }

    fn rule(&self, home: usize, interface: &str, slot: &str, function: &str) -> Result<Combine, Report> {
        let category = self.catalog.category(interface);
        if let Some(rule) = category.and_then(|c| c.manifest.combine.get(function)) {
            return Ok(*rule);
        }
        let mut diagnostic = Diagnostic::new(
            codes::NOT_COMBINABLE,
            format!("`{interface}` does not say how results of `{function}` combine in the slot `{slot}`"),
        );
        let second = self.node(home).and_then(|n| self.tree.nodes[n].slot(slot)?.1.get(1).copied());
        if let Some(second) = second {
            let place = self.tree.place(second);
            diagnostic = diagnostic.at(&place.file, place.name_span(), "a second module stands in that slot here");
        }
        if let Some(category) = category {
            diagnostic = diagnostic.at(
                &category.source,
                Place::new(&category.source).keys(&["combine"]).span(),
                "no rule for it here",
            );
        }
        Err(diagnostic
            .note("`combine` in the interface's category.ron names the rule: Sum, Product or Chain")
            .into())
    }

    fn list_targets(&self, home: usize, slot: &str, function: &str) -> Result<Vec<Target>, Report> {
        let Some(node) = self.node(home) else { return Ok(Vec::new()) };
        let nodes = self.tree.nodes[node].slot(slot).map_or(&[][..], |(_, nodes)| nodes);
        nodes.iter().map(|&n| self.implementation(n, function)).collect()
    }

    fn implementation(&self, node: usize, function: &str) -> Result<Target, Report> {
        let home = self.instances.of_node[node];
        let unit = &self.homes[home].unit;
        match unit.functions.get(function) {
            Some(&handle) if unit.dependent[handle.index()] => Ok((home, Body::Function(handle))),
            Some(&handle) => Ok((self.homes[home].first, Body::Function(handle))),
            None if self.may_leave_out(node, function) => self.neutral(&self.tree.nodes[node].module.category, function),
            None => Err(
                Diagnostic::new(codes::MISSING_FUNCTION, format!("the module does not define `{function}`"))
                    .at(&unit.file, 0..0, "in this file")
                    .into(),
            ),
        }
    }

    fn may_leave_out(&self, node: usize, function: &str) -> bool {
        let category = self.catalog.category(&self.tree.nodes[node].module.category);
        category.is_some_and(|c| c.manifest.optional_with(function).is_some())
    }

    /// A function that the owner of the slot offers: its own, one of its slots', or one that it is offered itself.
    fn offered(&mut self, home: usize, interface: &str, function: &str) -> Result<Target, Report> {
        let parent = self.homes[home].instance.and_then(|i| self.instances.list[i].parent);
        let Some(owner) = parent else {
            return self.neutral(interface, function);
        };
        let unit = Arc::clone(&self.homes[owner].unit);
        let found = unit.functions.get(function).copied();
        match (unit.origin(function), found) {
            (Some(Origin::Own | Origin::Slot { .. } | Origin::Offered { .. }), Some(handle)) => {
                self.same_signature(home, owner, function, handle)?;
                self.call(owner, handle)
            }
            _ if self.tree.nodes[self.instances.list[owner].node].module.category.is_empty() => self.neutral(interface, function),
            _ => {
                let index = self.instances.list[home].node;
                let (node, place) = (&self.tree.nodes[index], self.tree.place(index));
                Err(Diagnostic::new(
                    codes::MISSING_FUNCTION,
                    format!("the module does not define `{function}`, which `{}` calls", node.module.name),
                )
                .at(&unit.file, 0..0, "in this file")
                .at(
                    &place.file,
                    place.span(),
                    format!("`{}` fills one of its slots here", node.module.name),
                )
                .note(format!(
                    "modules of `{}` call functions of the module that they serve",
                    node.module.category
                ))
                .into())
            }
        }
    }

    fn same_signature(&self, home: usize, owner: usize, function: &str, offered: Handle<naga::Function>) -> Result<(), Report> {
        let (caller, unit) = (&self.homes[home].unit, &self.homes[owner].unit);
        let Some(&expected) = caller.functions.get(function) else {
            return Ok(());
        };
        crate::parse::same_signature(unit, offered, caller, expected, function)
    }

    fn circle(&self, target: &Target) -> Report {
        let first = self.stack.iter().position(|t| t == target).unwrap_or(0);
        let mut names: Vec<String> = self.stack[first..].iter().map(|t| self.target_name(t)).collect();
        names.push(self.target_name(target));
        let mut diagnostic = Diagnostic::new(codes::RECURSION, "functions of modules call each other in a circle");
        for (home, body) in &self.stack[first..] {
            let unit = &self.homes[*home].unit;
            if let Body::Function(handle) = body {
                let name = unit.ir.functions[*handle].name.as_deref().unwrap_or_default();
                if let Some(item) = unit.scan.item(name) {
                    diagnostic = diagnostic.at(&unit.file, item.name_span.clone(), "part of the circle");
                }
            }
        }
        diagnostic
            .note(format!("the circle is {}", names.join(" -> ")))
            .note("WGSL has no recursion")
            .into()
    }

    fn target_name(&self, (home, body): &Target) -> String {
        let home = &self.homes[*home];
        let module = home.instance.map_or_else(
            || home.unit.interface.clone().unwrap_or_default(),
            |i| self.tree.nodes[self.instances.list[i].node].module.name.clone(),
        );
        let function = match body {
            Body::Function(handle) => home.unit.ir.functions[*handle].name.clone().unwrap_or_default(),
            Body::Entry(index) => home.unit.ir.entry_points[*index].name.clone(),
            Body::Combined { function, .. } => function.clone(),
        };
        format!("{module}::{function}")
    }
}
