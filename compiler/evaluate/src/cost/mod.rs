//! What a linked program holds, counted in its IR without running it.
//!
//! ```text
//! functions -> own operations, calls, loops (body, trips) -> times how often each is called -> Cost
//! ```
//!
//! Every function counts once for each place that calls it, the call graph multiplied out; of an `if` or `switch` every side; of a loop the body
//! once, and once more apart with its trips where they are constant. What one run executes is less: the evaluator counts that.

mod body;
mod trips;
mod weights;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{AddressSpace, Function, Handle, Module, TypeInner};
use serde::{Deserialize, Serialize};

use crate::kind::{Counts, Kind};
use body::Body;

/// What a linked program holds: counted in its IR, each function once for each of its calls, each loop's body once.
/// Of a vector operation every component counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Cost {
    /// Additions and subtractions.
    pub add: u32,
    /// Multiplications.
    pub multiply: u32,
    /// Divisions and remainders.
    pub divide: u32,
    /// Square roots and their inverses.
    pub root: u32,
    /// `sin`, `exp2`, `log2`, `pow`, `atan2` and their kind.
    pub transcendental: u32,
    /// Comparisons and choices.
    pub select: u32,
    /// What integers do.
    pub integer: u32,
    /// Texture reads.
    pub texture: u32,
    /// Loops.
    pub loops: u32,
    /// Branches; the exit of a `for` or `while` is one.
    pub branches: u32,
    /// Bytes of uniform buffers.
    pub uniform_bytes: u32,
    /// Bindings.
    pub bindings: u32,
    /// Storage buffers among the bindings.
    pub storage_buffers: u32,
    /// Textures among the bindings, storage textures too.
    pub textures: u32,
}

impl Cost {
    /// The operations as [`Counts`]: a loop is a trip.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for (kind, count) in [
            (Kind::Add, self.add),
            (Kind::Multiply, self.multiply),
            (Kind::Divide, self.divide),
            (Kind::Root, self.root),
            (Kind::Transcendental, self.transcendental),
            (Kind::Select, self.select),
            (Kind::Integer, self.integer),
            (Kind::Texture, self.texture),
            (Kind::Branch, self.branches),
            (Kind::Trip, self.loops),
        ] {
            counts[kind] = u64::from(count);
        }
        counts
    }

    /// One number for all operations: see [`Counts::weighted`]. Loops count as one trip; [`Analysis::unrolled`] has them with their trips.
    pub fn weighted(&self) -> f64 {
        self.counts().weighted()
    }

    fn of(counts: &Counts) -> Self {
        let of = |kind| u32::try_from(counts[kind]).unwrap_or(u32::MAX);
        Self {
            add: of(Kind::Add),
            multiply: of(Kind::Multiply),
            divide: of(Kind::Divide),
            root: of(Kind::Root),
            transcendental: of(Kind::Transcendental),
            select: of(Kind::Select),
            integer: of(Kind::Integer),
            texture: of(Kind::Texture),
            loops: of(Kind::Trip),
            branches: of(Kind::Branch),
            ..Self::default()
        }
    }
}

/// A loop of a program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Loop {
    /// The function that it stands in; empty where that has no name.
    pub function: String,
    /// Trips, where they do not hang on the input: the most of them where `leaves` is set.
    pub trips: Option<u32>,
    /// A `break` or `return` inside may end it sooner.
    pub leaves: bool,
    /// Places from which the function is called, and what calls it in turn.
    pub times: u32,
}

/// What is known of a program's cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Analysis {
    /// Loops' bodies once.
    pub cost: Cost,
    /// Operations with loops' bodies as often as they run at most, where that is constant; the others once.
    pub unrolled: Counts,
    /// In the order of functions, callees first, and of their text.
    pub loops: Vec<Loop>,
}

/// What an entry point holds, with everything that it calls. `info` is what validation found out of the module. `None` where there is none of
/// this name.
pub fn cost_of(module: &Module, info: &ModuleInfo, entry: &str) -> Option<Analysis> {
    let index = module.entry_points.iter().position(|e| e.name == entry)?;
    Some(analyse(
        module,
        info,
        &module.entry_points[index].function,
        info.get_entry_point(index),
    ))
}

/// What one function holds, with everything that it calls, as if it were alone: what its caller does around it does not count.
pub fn cost_of_function(module: &Module, info: &ModuleInfo, function: Handle<Function>) -> Analysis {
    analyse(module, info, &module.functions[function], &info[function])
}

fn analyse(module: &Module, info: &ModuleInfo, root: &Function, root_info: &FunctionInfo) -> Analysis {
    let root = Body::of(module, root, root_info);
    let bodies: Vec<Body> = module.functions.iter().map(|(h, f)| Body::of(module, f, &info[h])).collect();
    // How often each function is called: written in its text, and with loops unrolled. Callees stand before their callers.
    let mut times = vec![[0u64; 2]; bodies.len()];
    let call = |times: &mut Vec<[u64; 2]>, body: &Body, by: [u64; 2]| {
        for (callee, trips) in &body.calls {
            let of = &mut times[callee.index()];
            of[0] = of[0].saturating_add(by[0]);
            of[1] = of[1].saturating_add(by[1].saturating_mul(*trips));
        }
    };
    call(&mut times, &root, [1, 1]);
    for (index, body) in bodies.iter().enumerate().rev() {
        let by = times[index];
        call(&mut times, body, by);
    }
    let (mut once, mut unrolled) = (Counts::default(), Counts::default());
    let mut loops = Vec::new();
    for (body, [written, run]) in bodies.iter().zip(times).chain([(&root, [1, 1])]) {
        once += body.once.times(written);
        unrolled += body.unrolled.times(run);
        if written > 0 {
            loops.extend(body.loops.iter().map(|found| Loop {
                times: u32::try_from(written).unwrap_or(u32::MAX),
                ..found.clone()
            }));
        }
    }
    Analysis {
        cost: bound(module, root_info, Cost::of(&once)),
        unrolled,
        loops,
    }
}

/// Adds what is bound: the resources that the function or what it calls uses.
fn bound(module: &Module, info: &FunctionInfo, mut cost: Cost) -> Cost {
    for (handle, global) in module.global_variables.iter() {
        if global.binding.is_none() || info[handle].is_empty() {
            continue;
        }
        cost.bindings = cost.bindings.saturating_add(1);
        let inner = &module.types[global.ty].inner;
        match (global.space, inner) {
            (AddressSpace::Uniform, _) => cost.uniform_bytes = cost.uniform_bytes.saturating_add(inner.size(module.to_ctx())),
            (AddressSpace::Storage { .. }, _) => cost.storage_buffers += 1,
            (_, TypeInner::Image { .. }) => cost.textures += 1,
            _ => {}
        }
    }
    cost
}

#[cfg(test)]
mod tests;
