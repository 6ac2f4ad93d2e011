//! The link plan: which functions of which instances, what of them is alive, under which names and bindings.
//!
//! Both writers follow it: one writes IR, the other the authors' own text.

mod bindings;
mod branches;
mod live;
mod names;
mod operands;
mod pure;
mod reach;
mod stores;
mod structs;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use std::sync::Arc;

use naga::Handle;

use crate::manifest::Combine;
use crate::parse::Unit;
use crate::resolve::{Instances, Tree};

pub use bindings::{Block, GROUPS, PlannedGlobal, declared, declaring, is_instances, is_params};
pub use branches::{Choice, choice, leaves, reachable};
pub use names::joined;
pub use operands::{expression_operands_mut, statement_operands_mut};
pub use pure::can_go;
pub use reach::{Roots, plan, roomy};
pub use stores::{is_dead_store, struct_of};
pub use structs::Structs;

/// A unit in the plan: a module instance, or an interface.
#[derive(Debug)]
pub struct Home {
    /// Its parsed text.
    pub unit: Arc<Unit>,
    /// Added to its spans, so that a span tells the unit.
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

/// A function that is reached.
#[derive(Debug)]
pub struct Planned {
    /// Index into [`Plan::homes`].
    pub home: usize,
    /// Its body.
    pub body: Body,
    /// What its calls lead to: by handle in the home's unit; for combined functions in order.
    pub calls: HashMap<Handle<naga::Function>, usize>,
    /// What a combined function calls, in order.
    pub targets: Vec<usize>,
    /// The function that reached it first; `None` for entry points.
    pub caller: Option<usize>,
    /// Which expressions are alive.
    pub live: Vec<bool>,
    /// Whether it does nothing but give a value, so that a call without readers can go.
    pub pure: bool,
    /// Whether an entry point still reaches it when calls without readers are gone.
    pub needed: bool,
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
    /// Emitted names of constants, overrides, structs, aliases and variables: home, name in the unit.
    pub names: HashMap<(usize, String), String>,
}

impl Plan {
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

    /// Results of its calls and other statements, with their places.
    pub fn results<'p>(&self, homes: &'p [Home]) -> &'p [(Handle<naga::Expression>, std::ops::Range<usize>)] {
        let unit = &homes[self.home].unit;
        let index = match self.body {
            Body::Function(handle) => handle.index(),
            Body::Entry(index) => unit.ir.functions.len() + index,
            Body::Combined { .. } => return &[],
        };
        &unit.results[index]
    }

    /// Types of its expressions.
    pub fn info<'p>(&self, homes: &'p [Home]) -> Option<&'p naga::valid::FunctionInfo> {
        let info = &homes[self.home].unit.info;
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
