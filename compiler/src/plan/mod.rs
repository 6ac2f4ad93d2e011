//! The link plan: which functions of which instances, what of them is alive, under which names and bindings.
//!
//! Both writers follow it: one writes IR, the other the authors' own text.

mod bindings;
mod live;
mod names;
mod reach;
mod stages;
mod stores;
mod structs;

use rustc_hash::FxHashSet as HashSet;
use std::sync::Arc;

use naga::Handle;

use crate::manifest::Combine;
use crate::parse::{Cuts, Facts, Unit};
use crate::resolve::{Instances, Tree};

pub use bindings::{Block, Declared, GROUPS, PlannedGlobal, declaring};
pub use names::Names;
pub use reach::{Roots, plan, roomy};
pub use stores::{is_dead_store, struct_of};
pub use structs::Structs;

/// Linked spans below this one stand in a function, and count from the start of the text of that function's unit.
pub const ITEMS: u32 = 1 << 31;

/// A unit in the plan: a module instance, or an interface.
#[derive(Debug)]
pub struct Home {
    /// Its parsed text.
    pub unit: Arc<Unit>,
    /// Added to the spans of its items, so that a span tells the unit: [`ITEMS`] or more. Spans within functions are as the unit has
    /// them.
    pub base: u32,
    /// The instance, if it is one.
    pub instance: Option<usize>,
    /// The first home with the same unit: functions that depend on nothing else are linked there once.
    pub first: usize,
    /// Before the names of its items; empty for interfaces.
    pub prefix: String,
}

/// Where a planned function's body is.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Body {
    /// A function of the home's unit.
    Function(Handle<naga::Function>),
    /// An entry point of the home's unit, by index.
    Entry(usize),
    /// Made by the linker: the modules of a list slot, combined.
    Combined {
        /// The stub with the signature, in the home's unit.
        stub: Handle<naga::Function>,
        /// How.
        rule: Combine,
        /// The slot.
        slot: String,
        /// The function.
        function: String,
    },
}

/// Where the calls of a function lead.
#[derive(Debug, Default)]
pub struct Calls(Vec<(Handle<naga::Function>, usize)>);

impl Calls {
    /// Notes where calls of a function lead.
    pub fn add(&mut self, callee: Handle<naga::Function>, id: usize) {
        self.0.push((callee, id));
    }

    /// The planned function that is called.
    pub fn get(&self, callee: Handle<naga::Function>) -> Option<usize> {
        // A function calls a handful of others.
        self.0.iter().find(|(c, _)| *c == callee).map(|&(_, id)| id)
    }

    /// All planned functions that are called.
    pub fn ids(&self) -> impl Iterator<Item = usize> {
        self.0.iter().map(|&(_, id)| id)
    }

    /// Renumbers the planned functions, and forgets calls of those that are gone.
    pub fn renumber(&mut self, new: &[Option<usize>]) {
        self.0.retain_mut(|(_, id)| new[*id].inspect(|&n| *id = n).is_some());
    }
}

/// A function that is reached.
#[derive(Debug)]
pub struct Planned {
    /// Index into [`Plan::homes`].
    pub home: usize,
    /// Its body.
    pub body: Body,
    /// What its calls lead to, by handle in the home's unit; none for combined functions.
    pub calls: Calls,
    /// What a combined function calls, in order.
    pub targets: Vec<usize>,
    /// The function that reached it first; `None` for entry points.
    pub caller: Option<usize>,
    /// Which expressions are alive.
    pub live: Vec<bool>,
    /// Whether it does nothing but give a value, so that a call without readers can go.
    pub pure: bool,
    /// Name in the emitted text.
    pub name: String,
}

/// The plan of one pass.
#[derive(Debug)]
pub struct Plan {
    /// The tree.
    pub tree: Tree,
    /// Its instances; instance i is home i.
    pub instances: Instances,
    /// Instances, then interfaces.
    pub homes: Vec<Home>,
    /// Reached functions, callees before callers; entry points are among them.
    pub functions: Vec<Planned>,
    /// Structs and which of their members are alive.
    pub structs: Structs,
    /// Live members of `params`: home, index of the member.
    pub live_params: HashSet<(usize, u32)>,
    /// Reached resources and variables.
    pub globals: Vec<PlannedGlobal>,
    /// Uniform blocks by group.
    pub blocks: Vec<Block>,
    /// Whether functions are nested or chained so deep that walks over them want a large stack: see [`roomy`].
    pub deep: bool,
    /// Emitted names of the units' items.
    pub names: Names,
}

impl Plan {
    /// The emitted name of an item of a home.
    pub fn name(&self, home: usize, name: &str) -> Option<&str> {
        self.names.get(&self.homes, home, name)
    }

    /// The home of a linked function.
    pub fn home_of(&self, function: Handle<naga::Function>) -> Option<usize> {
        let linked = self.functions.iter().filter(|f| !matches!(f.body, Body::Entry(_)));
        linked.map(|f| f.home).nth(function.index())
    }

    /// The home of a linked entry point.
    pub fn home_of_entry(&self, name: &str, stage: naga::ShaderStage) -> Option<usize> {
        let is_meant = |f: &&Planned| match f.body {
            Body::Entry(index) => f.name == name && self.homes[f.home].unit.ir.entry_points[index].stage == stage,
            _ => false,
        };
        self.functions.iter().find(is_meant).map(|f| f.home)
    }

    /// The home of a category's interface.
    pub fn interface_home(&self, category: &str) -> Option<usize> {
        self.homes.iter().position(|h| h.unit.interface.as_deref() == Some(category))
    }

    /// The home whose copy of a constant or type is linked: equal units share theirs.
    pub fn shared_home(&self, home: usize) -> usize {
        let home_ = &self.homes[home];
        if home_.unit.needs.overrides.is_empty() { home_.first } else { home }
    }
}

impl Planned {
    /// The IR of its body; a combined function has none.
    pub fn ir<'p>(&self, homes: &'p [Home]) -> Option<&'p naga::Function> {
        let ir = &homes[self.home].unit.ir;
        match self.body {
            Body::Function(handle) => Some(&ir.functions[handle]),
            Body::Entry(index) => Some(&ir.entry_points[index].function),
            Body::Combined { .. } => None,
        }
    }

    /// Its number among its unit's functions and, behind them, entry points; none for a combined function.
    fn index(&self, unit: &Unit) -> Option<usize> {
        match self.body {
            Body::Function(handle) => Some(handle.index()),
            Body::Entry(index) => Some(unit.ir.functions.len() + index),
            Body::Combined { .. } => None,
        }
    }

    /// What is known of its body whatever it is linked to; nothing for a combined function.
    pub fn facts<'p>(&self, homes: &'p [Home]) -> Option<&'p Facts> {
        let unit = &homes[self.home].unit;
        unit.facts.get(self.index(unit)?)
    }

    /// The stretches of its text that may go; none for a combined function.
    pub fn cuts<'p>(&self, homes: &'p [Home]) -> Option<&'p Cuts> {
        let unit = &homes[self.home].unit;
        unit.cuts.get(self.index(unit)?)
    }

    /// Whether a call stays although nobody reads its result.
    pub fn is_kept(&self, functions: &[Planned], unit: &Unit, callee: Handle<naga::Function>) -> bool {
        let planned = self.calls.get(callee);
        planned.is_some_and(|id| !(unit.droppable[callee.index()] && functions[id].pure))
    }

    /// Types of its expressions; `unit` is its home's.
    pub fn info_of<'p>(&self, unit: &'p Unit) -> Option<&'p naga::valid::FunctionInfo> {
        let info = &unit.info;
        match self.body {
            Body::Function(handle) => Some(&info[handle]),
            Body::Entry(index) => Some(info.get_entry_point(index)),
            Body::Combined { .. } => None,
        }
    }

    /// Its name in the author's text.
    pub fn source_name<'p>(&'p self, homes: &'p [Home]) -> &'p str {
        let ir = &homes[self.home].unit.ir;
        match &self.body {
            Body::Function(handle) => ir.functions[*handle].name.as_deref().unwrap_or_default(),
            Body::Entry(index) => &ir.entry_points[*index].name,
            Body::Combined { function, .. } => function,
        }
    }
}
