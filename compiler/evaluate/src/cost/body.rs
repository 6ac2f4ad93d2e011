//! What one function's own text holds.

use naga::valid::FunctionInfo;
use naga::{Block, Expression, Function, Handle, Module, Statement};

use super::Loop;
use super::trips::{Trips, leaves};
use crate::kind::{Counts, Kind, operations};

/// A function without what it calls.
pub(super) struct Body {
    /// Operations, loops' bodies once.
    pub once: Counts,
    /// The same, loops' bodies as often as they run.
    pub unrolled: Counts,
    /// Functions in the order of their calls, with how often loops run the call.
    pub calls: Vec<(Handle<Function>, u64)>,
    /// `times` is left to the caller.
    pub loops: Vec<Loop>,
}

impl Body {
    pub fn of(module: &Module, function: &Function, info: &FunctionInfo) -> Self {
        let mut walk = Walk {
            module,
            function,
            info,
            body: Self {
                once: Counts::default(),
                unrolled: Counts::default(),
                calls: Vec::new(),
                loops: Vec::new(),
            },
        };
        walk.block(&function.body, 1);
        walk.body
    }
}

struct Walk<'m> {
    module: &'m Module,
    function: &'m Function,
    info: &'m FunctionInfo,
    body: Body,
}

impl Walk<'_> {
    fn add(&mut self, counts: Counts, runs: u64) {
        self.body.once += counts;
        self.body.unrolled += counts.times(runs);
    }

    /// Counts a block that runs so often each time the function is called.
    fn block(&mut self, block: &Block, runs: u64) {
        for (index, statement) in block.iter().enumerate() {
            match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        let inner = |handle: Handle<Expression>| self.info[handle].ty.inner_with(&self.module.types);
                        let counts = operations(&self.function.expressions[handle], inner(handle), inner);
                        self.add(counts, runs);
                    }
                }
                Statement::Block(inner) => self.block(inner, runs),
                Statement::If { accept, reject, .. } => {
                    self.add(Counts::of(Kind::Branch, 1), runs);
                    self.block(accept, runs);
                    self.block(reject, runs);
                }
                Statement::Switch { cases, .. } => {
                    self.add(Counts::of(Kind::Branch, 1), runs);
                    cases.iter().for_each(|case| self.block(&case.body, runs));
                }
                Statement::Loop { body, continuing, .. } => {
                    let trips = Trips::of(self.module, self.function, &block[..index], statement);
                    self.body.loops.push(Loop {
                        function: self.function.name.clone().unwrap_or_default(),
                        trips,
                        leaves: leaves(statement),
                        times: 1,
                    });
                    let runs = runs.saturating_mul(trips.map_or(1, u64::from));
                    self.add(Counts::of(Kind::Trip, 1), runs);
                    self.block(body, runs);
                    self.block(continuing, runs);
                }
                Statement::Call { function, .. } => self.body.calls.push((*function, runs)),
                Statement::ImageStore { .. } | Statement::ImageAtomic { .. } => self.add(Counts::of(Kind::Texture, 1), runs),
                Statement::Atomic { .. } => self.add(Counts::of(Kind::Integer, 1), runs),
                Statement::Break
                | Statement::Continue
                | Statement::Return { .. }
                | Statement::Kill
                | Statement::ControlBarrier(_)
                | Statement::MemoryBarrier(_)
                | Statement::Store { .. }
                | Statement::WorkGroupUniformLoad { .. }
                | Statement::RayQuery { .. }
                | Statement::RayPipelineFunction(_)
                | Statement::SubgroupBallot { .. }
                | Statement::SubgroupGather { .. }
                | Statement::SubgroupCollectiveOperation { .. }
                | Statement::CooperativeStore { .. } => {}
            }
        }
    }
}
