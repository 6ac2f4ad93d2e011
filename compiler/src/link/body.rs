//! Writing a function: its form is cloned, and whatever refers outward is patched.

use std::sync::Arc;

use naga::{Block, Expression, Function, Handle, Statement};

use super::ir::Linker;
use super::trim::{alive, trim};
use crate::parse::{Template, Templates};
use crate::plan::Planned;

impl Linker<'_> {
    pub fn body(&mut self, planned: &Planned, source: &Function, kept: &Templates) -> Function {
        let home = planned.home;
        let template = self.template(planned, source, kept);
        let mut function = template.function.clone();
        function.name = Some(planned.name.clone());
        for argument in &mut function.arguments {
            argument.ty = self.ty(home, argument.ty);
        }
        if let Some(result) = &mut function.result {
            result.ty = self.ty(home, result.ty);
        }
        for &handle in &template.outward {
            self.outward(planned, &mut function, handle);
        }
        function.diagnostic_filter_leaf = self.filter(home, function.diagnostic_filter_leaf);
        self.statements(planned, &mut function.body);
        function
    }

    /// The function's form: mostly another permutation has needed the same one.
    fn template(&mut self, planned: &Planned, source: &Function, kept: &Templates) -> Arc<Template> {
        alive(self.plan, planned, &mut self.alive);
        kept.get(&self.alive)
            .unwrap_or_else(|| kept.keep(trim(self.plan, planned, source, self.alive.clone())))
    }

    /// Patches an expression that depends on something outside.
    fn outward(&mut self, planned: &Planned, function: &mut Function, handle: Handle<Expression>) {
        let home = planned.home;
        match &mut function.expressions[handle] {
            Expression::Constant(constant) => *constant = self.constant(home, *constant),
            Expression::Override(o) => *o = self.override_(home, *o),
            Expression::ZeroValue(ty)
            | Expression::Compose { ty, .. }
            | Expression::AtomicResult { ty, .. }
            | Expression::WorkGroupUniformLoadResult { ty }
            | Expression::SubgroupOperationResult { ty } => *ty = self.ty(home, *ty),
            Expression::GlobalVariable(global) => {
                *global = if self.plan.homes[home].unit.params == Some(*global) {
                    self.params_block(home, *global)
                } else {
                    self.global(home, *global)
                };
            }
            Expression::LocalVariable(local) => {
                let variable = &mut function.local_variables[*local];
                variable.ty = self.ty(home, variable.ty);
            }
            Expression::CallResult(function) => *function = self.callee(planned, *function),
            // Of `params`: members of other structs have their place in the form already.
            Expression::AccessIndex { index, .. } => {
                if let Some((_, member)) = self.block_member(home, *index) {
                    *index = member;
                }
            }
            // `modf` and `frexp` name their result's type only through the module's list of predeclared types.
            _ => self.result_types(home),
        }
    }

    fn result_types(&mut self, home: usize) {
        for &ty in self.plan.homes[home].unit.ir.special_types.predeclared_types.values() {
            self.ty(home, ty);
        }
    }

    fn callee(&self, planned: &Planned, function: Handle<Function>) -> Handle<Function> {
        // Every call of a live branch was planned, and callees are linked before their callers.
        planned
            .calls
            .get(function)
            .and_then(|index| self.functions[index])
            .unwrap_or(function)
    }

    /// The block for a use of `params`: all parameters of one home are in one group.
    fn params_block(&mut self, home: usize, global: Handle<naga::GlobalVariable>) -> Handle<naga::GlobalVariable> {
        let live = self.plan.live_params.iter().filter(|(of, _)| *of == home);
        let member = live.map(|&(_, index)| index).min();
        member
            .and_then(|index| self.block_member(home, index))
            .map_or(global, |(block, _)| block)
    }

    /// Patches the statements of a block and of the blocks in it.
    fn statements(&self, planned: &Planned, block: &mut Block) {
        for statement in block.iter_mut() {
            match statement {
                Statement::Call { function, .. } => *function = self.callee(planned, *function),
                Statement::Block(inner) => self.statements(planned, inner),
                Statement::If { accept, reject, .. } => {
                    self.statements(planned, accept);
                    self.statements(planned, reject);
                }
                Statement::Switch { cases, .. } => cases.iter_mut().for_each(|case| self.statements(planned, &mut case.body)),
                Statement::Loop { body, continuing, .. } => {
                    self.statements(planned, body);
                    self.statements(planned, continuing);
                }
                _ => {}
            }
        }
    }
}
