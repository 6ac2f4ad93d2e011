//! Cloning a function: the living expressions, in their order, with every reference outward patched.

use naga::{
    Block, Expression, Function, FunctionArgument, FunctionResult, Handle, LocalVariable, MathFunction, Range, Span, Statement, SwitchCase,
};

use super::ir::Linker;
use crate::parse::{Choice, choice, expression_operands_mut, reachable, statement_operands_mut};
use crate::plan::{Planned, is_dead_store, struct_of};

type Exprs = Vec<Option<Handle<Expression>>>;

/// First and last expression of a range to emit, and its place.
type Emitted = (Handle<Expression>, Handle<Expression>, Span);

/// A function on its way from its unit to the output.
struct Copying<'f> {
    home: usize,
    planned: &'f Planned,
    source: &'f Function,
    exprs: Exprs,
    locals: Vec<Option<Handle<LocalVariable>>>,
}

impl Linker<'_> {
    pub fn body(&mut self, planned: &Planned, source: &Function) -> Function {
        let home = planned.home;
        let mut out = Function {
            name: Some(planned.name.clone()),
            ..Function::default()
        };
        for argument in &source.arguments {
            let ty = self.ty(home, argument.ty);
            out.arguments.push(FunctionArgument {
                name: argument.name.clone(),
                ty,
                binding: argument.binding.clone(),
            });
        }
        out.result = source.result.as_ref().map(|r| FunctionResult {
            ty: self.ty(home, r.ty),
            binding: r.binding.clone(),
        });
        let mut copying = Copying {
            home,
            planned,
            source,
            exprs: vec![None; source.expressions.len()],
            locals: vec![None; source.local_variables.len()],
        };
        for (handle, expression) in source.expressions.iter() {
            if planned.live[handle.index()] {
                let patched = self.expression(&mut copying, &mut out, expression);
                let span = self.span(home, source.expressions.get_span(handle));
                copying.exprs[handle.index()] = Some(out.expressions.append(patched, span));
            }
        }
        out.named_expressions.reserve(source.named_expressions.len());
        for (&handle, name) in &source.named_expressions {
            if let Some(done) = copying.exprs[handle.index()] {
                out.named_expressions.insert(done, name.clone());
            }
        }
        out.diagnostic_filter_leaf = self.filter(home, source.diagnostic_filter_leaf);
        out.body = self.block(&copying, &out, &source.body);
        out
    }

    fn local(&mut self, copying: &mut Copying, out: &mut Function, handle: Handle<LocalVariable>) -> Handle<LocalVariable> {
        if let Some(done) = copying.locals[handle.index()] {
            return done;
        }
        let declared = &copying.source.local_variables[handle];
        let ty = self.ty(copying.home, declared.ty);
        // Initialisers are constant expressions that precede every use.
        let init = declared.init.and_then(|e| copying.exprs[e.index()]);
        let span = self.span(copying.home, copying.source.local_variables.get_span(handle));
        let done = out.local_variables.append(
            LocalVariable {
                name: declared.name.clone(),
                ty,
                init,
            },
            span,
        );
        copying.locals[handle.index()] = Some(done);
        done
    }

    /// An expression with its operands and references in the output.
    fn expression(&mut self, copying: &mut Copying, out: &mut Function, expression: &Expression) -> Expression {
        let home = copying.home;
        let mut patched = expression.clone();
        match &mut patched {
            Expression::Constant(constant) => *constant = self.constant(home, *constant),
            Expression::Override(o) => *o = self.override_(home, *o),
            Expression::ZeroValue(ty) => *ty = self.ty(home, *ty),
            Expression::AtomicResult { ty, .. }
            | Expression::WorkGroupUniformLoadResult { ty }
            | Expression::SubgroupOperationResult { ty } => *ty = self.ty(home, *ty),
            Expression::Compose { ty, components } => {
                if let Some(id) = self.plan.structs.id(home, *ty) {
                    let mut index = 0;
                    components.retain(|_| {
                        index += 1;
                        self.plan.structs.is_live(id, index - 1)
                    });
                }
                *ty = self.ty(home, *ty);
            }
            Expression::GlobalVariable(global) => {
                let unit = &self.plan.homes[home].unit;
                *global = if unit.params == Some(*global) {
                    self.params_block(copying, *global)
                } else {
                    self.global(home, *global)
                };
            }
            Expression::LocalVariable(local) => *local = self.local(copying, out, *local),
            Expression::CallResult(function) => *function = self.callee(copying, *function),
            Expression::AccessIndex { base, index } => *index = self.member_index(copying, *base, *index),
            Expression::Math {
                fun: MathFunction::Modf | MathFunction::Frexp,
                ..
            } => self.result_types(home),
            // Nothing but operands. A kind that naga adds stops the compiler at the visitor below.
            _ => {}
        }
        expression_operands_mut(&mut patched, &mut |h| *h = copying.get(*h));
        patched
    }

    /// `modf` and `frexp` name their result's type only through the module's list of predeclared types.
    fn result_types(&mut self, home: usize) {
        let types: Vec<_> = self.plan.homes[home]
            .unit
            .ir
            .special_types
            .predeclared_types
            .values()
            .copied()
            .collect();
        for ty in types {
            self.ty(home, ty);
        }
    }

    fn callee(&self, copying: &Copying, function: Handle<Function>) -> Handle<Function> {
        // Every call of a live branch was planned, and callees are linked before their callers.
        copying
            .planned
            .calls
            .get(function)
            .and_then(|index| self.functions[index])
            .unwrap_or(function)
    }

    /// Whether a call stays although nobody reads its result.
    fn is_kept(&self, copying: &Copying, callee: Handle<Function>) -> bool {
        let unit = &self.plan.homes[copying.home].unit;
        copying.planned.is_kept(&self.plan.functions, unit, callee)
    }

    /// The block for a use of `params`: all parameters of one home are in one group.
    fn params_block(&mut self, copying: &Copying, global: Handle<naga::GlobalVariable>) -> Handle<naga::GlobalVariable> {
        let plan = self.plan;
        let member = plan
            .live_params
            .iter()
            .filter(|(home, _)| *home == copying.home)
            .map(|&(_, index)| index)
            .min();
        member
            .and_then(|index| self.block_member(copying.home, index))
            .map_or(global, |(block, _)| block)
    }

    fn member_index(&mut self, copying: &Copying, base: Handle<Expression>, index: u32) -> u32 {
        let plan = self.plan;
        let unit = &plan.homes[copying.home].unit;
        if let Expression::GlobalVariable(global) = copying.source.expressions[base]
            && unit.params == Some(global)
        {
            return self.block_member(copying.home, index).map_or(index, |(_, member)| member);
        }
        match struct_of(copying.planned, &plan.structs, unit, base) {
            Some(id) if !plan.structs.list[id].fixed => plan.structs.new_index(id, index),
            _ => index,
        }
    }

    fn block(&self, copying: &Copying, out: &Function, source: &Block) -> Block {
        let mut block = Block::with_capacity(source.len());
        let mut emitted = None;
        self.statements(copying, out, source, &mut block, &mut emitted);
        flush(&mut emitted, &mut block);
        block
    }

    /// Adds statements; inner blocks and branches that are always taken are laid open, since IR has no scopes to keep.
    fn statements(&self, copying: &Copying, out: &Function, source: &Block, block: &mut Block, emitted: &mut Option<Emitted>) {
        for (statement, &span) in reachable(&self.plan.homes[copying.home].unit.ir, copying.source, source) {
            let span = self.span(copying.home, span);
            if let Statement::Emit(range) = statement {
                // Ranges that the dead expressions between them kept apart become one, as the parser would make them.
                for handle in range.clone().filter_map(|h| copying.exprs[h.index()]) {
                    if needs_no_emit(&out.expressions[handle]) {
                        continue;
                    }
                    match emitted {
                        Some((_, last, _)) if last.index() + 1 == handle.index() => *last = handle,
                        _ => {
                            flush(emitted, block);
                            *emitted = Some((handle, handle, span));
                        }
                    }
                }
                continue;
            }
            let ir = &self.plan.homes[copying.home].unit.ir;
            let laid_open = match statement {
                Statement::Block(inner) => Some(inner),
                Statement::If { condition, accept, reject } => match choice(ir, copying.source, *condition, accept, reject) {
                    Choice::Accept => Some(accept),
                    Choice::Reject => Some(reject),
                    Choice::Open => None,
                },
                _ => None,
            };
            if let Some(inner) = laid_open {
                self.statements(copying, out, inner, block, emitted);
            } else if let Some(statement) = self.statement(copying, out, statement) {
                flush(emitted, block);
                block.push(statement, span);
            }
        }
    }

    fn statement(&self, copying: &Copying, out: &Function, statement: &Statement) -> Option<Statement> {
        let plan = self.plan;
        let unit = &plan.homes[copying.home].unit;
        let mut patched = match statement {
            Statement::If { condition, accept, reject } => {
                let (accept, reject) = (self.block(copying, out, accept), self.block(copying, out, reject));
                return Some(Statement::If {
                    condition: copying.get(*condition),
                    accept,
                    reject,
                });
            }
            Statement::Switch { selector, cases } => {
                let case = |c: &SwitchCase| SwitchCase {
                    value: c.value,
                    body: self.block(copying, out, &c.body),
                    fall_through: c.fall_through,
                };
                return Some(Statement::Switch {
                    selector: copying.get(*selector),
                    cases: cases.iter().map(case).collect(),
                });
            }
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => {
                return Some(Statement::Loop {
                    body: self.block(copying, out, body),
                    continuing: self.block(copying, out, continuing),
                    break_if: break_if.map(|b| copying.get(b)),
                });
            }
            Statement::Store { pointer, .. } if is_dead_store(copying.planned, &plan.structs, unit, copying.source, *pointer) => {
                return None;
            }
            // A call that can go, and whose result nobody reads.
            Statement::Call { function, result, .. }
                if result.is_none_or(|r| copying.exprs[r.index()].is_none()) && !self.is_kept(copying, *function) =>
            {
                return None;
            }
            other => other.clone(),
        };
        if let Statement::Call { function, .. } = &mut patched {
            *function = self.callee(copying, *function);
        }
        statement_operands_mut(&mut patched, &mut |h| *h = copying.get(*h));
        Some(patched)
    }
}

impl Copying<'_> {
    /// The linked expression. Whatever a living expression or statement needs is alive, and precedes it.
    fn get(&self, handle: Handle<Expression>) -> Handle<Expression> {
        self.exprs[handle.index()].unwrap_or(handle)
    }
}

fn flush(emitted: &mut Option<Emitted>, block: &mut Block) {
    if let Some((first, last, span)) = emitted.take() {
        block.push(Statement::Emit(Range::new_from_bounds(first, last)), span);
    }
}

/// Expressions that are there from the start of the function: naga refuses to emit them.
fn needs_no_emit(expression: &Expression) -> bool {
    expression.needs_pre_emit()
}
