//! A function's form: the living expressions, in their order, and the statements that stay. What they refer to outside of the
//! function is left to [`super::body`].

use naga::{Block, Expression, Function, Handle, LocalVariable, MathFunction, Module, Range, Span, Statement, SwitchCase};

use crate::parse::{Choice, Template, Unit, choice, expression_operands_mut, reachable, statement_operands_mut};
use crate::plan::{Plan, Planned, is_dead_store, struct_of};

/// First and last expression of a range to emit, and its place.
type Emitted = (Handle<Expression>, Handle<Expression>, Span);

/// All that the form of a function depends on.
pub(super) fn alive(plan: &Plan, planned: &Planned, into: &mut Vec<bool>) {
    into.clear();
    into.extend_from_slice(&planned.live);
    let Some(facts) = planned.facts(&plan.homes) else { return };
    for id in facts.structs.iter().filter_map(|&ty| plan.structs.id(planned.home, ty)) {
        let members = 0..plan.structs.list[id].live.len() as u32;
        into.extend(members.map(|member| plan.structs.is_live(id, member)));
    }
    let unit = &plan.homes[planned.home].unit;
    into.extend(facts.callees.iter().map(|&callee| planned.is_kept(&plan.functions, unit, callee)));
}

/// Takes out of a function what is dead.
pub(super) fn trim(plan: &Plan, planned: &Planned, source: &Function, alive: Vec<bool>) -> Template {
    let unit = &plan.homes[planned.home].unit;
    let mut trimming = Trimming {
        plan,
        planned,
        unit,
        source,
        exprs: vec![None; source.expressions.len()],
        locals: vec![None; source.local_variables.len()],
        outward: Vec::new(),
        out: Function {
            arguments: source.arguments.clone(),
            result: source.result.clone(),
            diagnostic_filter_leaf: source.diagnostic_filter_leaf,
            ..Function::default()
        },
    };
    for (handle, expression) in source.expressions.iter() {
        if planned.live[handle.index()] {
            let (trimmed, is_outward) = trimming.expression(expression);
            let done = trimming.out.expressions.append(trimmed, source.expressions.get_span(handle));
            trimming.exprs[handle.index()] = Some(done);
            trimming.outward.extend(is_outward.then_some(done));
        }
    }
    for (&handle, name) in &source.named_expressions {
        if let Some(done) = trimming.exprs[handle.index()] {
            trimming.out.named_expressions.insert(done, name.clone());
        }
    }
    trimming.out.body = trimming.block(&source.body);
    Template {
        alive,
        function: trimming.out,
        outward: trimming.outward,
    }
}

/// A function on its way to its form.
struct Trimming<'p> {
    plan: &'p Plan,
    planned: &'p Planned,
    unit: &'p Unit,
    source: &'p Function,
    exprs: Vec<Option<Handle<Expression>>>,
    locals: Vec<Option<Handle<LocalVariable>>>,
    out: Function,
    outward: Vec<Handle<Expression>>,
}

impl Trimming<'_> {
    fn ir(&self) -> &Module {
        &self.unit.ir
    }

    /// The expression in the form. Whatever a living expression or statement needs is alive, and precedes it.
    fn get(&self, handle: Handle<Expression>) -> Handle<Expression> {
        self.exprs[handle.index()].unwrap_or(handle)
    }

    /// The variable in the form, and whether this is its first use.
    fn local(&mut self, handle: Handle<LocalVariable>) -> (Handle<LocalVariable>, bool) {
        if let Some(done) = self.locals[handle.index()] {
            return (done, false);
        }
        let declared = &self.source.local_variables[handle];
        let variable = LocalVariable {
            name: declared.name.clone(),
            ty: declared.ty,
            // Initialisers are constant expressions that precede every use.
            init: declared.init.and_then(|e| self.exprs[e.index()]),
        };
        let span = self.source.local_variables.get_span(handle);
        let done = self.out.local_variables.append(variable, span);
        self.locals[handle.index()] = Some(done);
        (done, true)
    }

    /// An expression with its operands in the form, and whether it depends on something outside.
    fn expression(&mut self, expression: &Expression) -> (Expression, bool) {
        let mut trimmed = expression.clone();
        let is_outward = match &mut trimmed {
            Expression::Constant(_)
            | Expression::Override(_)
            | Expression::ZeroValue(_)
            | Expression::AtomicResult { .. }
            | Expression::WorkGroupUniformLoadResult { .. }
            | Expression::SubgroupOperationResult { .. }
            | Expression::GlobalVariable(_)
            | Expression::CallResult(_)
            | Expression::Math {
                fun: MathFunction::Modf | MathFunction::Frexp,
                ..
            } => true,
            Expression::Compose { ty, components } => {
                if let Some(id) = self.plan.structs.id(self.planned.home, *ty) {
                    let mut members = 0..;
                    components.retain(|_| members.next().is_some_and(|member| self.plan.structs.is_live(id, member)));
                }
                true
            }
            Expression::LocalVariable(local) => {
                let is_first;
                (*local, is_first) = self.local(*local);
                is_first
            }
            Expression::AccessIndex { base, index } => {
                let is_param = self.is_params(*base);
                if !is_param {
                    *index = self.member_index(*base, *index);
                }
                is_param
            }
            // Nothing but operands. A kind that naga adds stops the compiler at the visitor below.
            _ => false,
        };
        expression_operands_mut(&mut trimmed, &mut |h| *h = self.get(*h));
        (trimmed, is_outward)
    }

    fn is_params(&self, base: Handle<Expression>) -> bool {
        matches!(self.source.expressions[base], Expression::GlobalVariable(global) if self.unit.params == Some(global))
    }

    fn member_index(&self, base: Handle<Expression>, index: u32) -> u32 {
        let structs = &self.plan.structs;
        match struct_of(self.planned, structs, self.unit, base) {
            Some(id) if !structs.list[id].fixed => structs.new_index(id, index),
            _ => index,
        }
    }

    fn block(&self, source: &Block) -> Block {
        let mut block = Block::with_capacity(source.len());
        let mut emitted = None;
        self.statements(source, &mut block, &mut emitted);
        flush(&mut emitted, &mut block);
        block
    }

    /// Adds statements; inner blocks and branches that are always taken are laid open, since IR has no scopes to keep.
    fn statements(&self, source: &Block, block: &mut Block, emitted: &mut Option<Emitted>) {
        for (statement, &span) in reachable(self.ir(), self.source, source) {
            if let Statement::Emit(range) = statement {
                // Ranges that the dead expressions between them kept apart become one, as the parser would make them.
                for handle in range.clone().filter_map(|h| self.exprs[h.index()]) {
                    // Expressions that are there from the start of the function: naga refuses to emit them.
                    if self.out.expressions[handle].needs_pre_emit() {
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
            let laid_open = match statement {
                Statement::Block(inner) => Some(inner),
                Statement::If { condition, accept, reject } => match choice(self.ir(), self.source, *condition, accept, reject) {
                    Choice::Accept => Some(accept),
                    Choice::Reject => Some(reject),
                    Choice::Open => None,
                },
                _ => None,
            };
            if let Some(inner) = laid_open {
                self.statements(inner, block, emitted);
            } else if let Some(statement) = self.statement(statement) {
                flush(emitted, block);
                block.push(statement, span);
            }
        }
    }

    fn statement(&self, statement: &Statement) -> Option<Statement> {
        let mut trimmed = match statement {
            Statement::If { condition, accept, reject } => {
                let (accept, reject) = (self.block(accept), self.block(reject));
                return Some(Statement::If {
                    condition: self.get(*condition),
                    accept,
                    reject,
                });
            }
            Statement::Switch { selector, cases } => {
                let case = |c: &SwitchCase| SwitchCase {
                    value: c.value,
                    body: self.block(&c.body),
                    fall_through: c.fall_through,
                };
                return Some(Statement::Switch {
                    selector: self.get(*selector),
                    cases: cases.iter().map(case).collect(),
                });
            }
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => {
                return Some(Statement::Loop {
                    body: self.block(body),
                    continuing: self.block(continuing),
                    break_if: break_if.map(|b| self.get(b)),
                });
            }
            Statement::Store { pointer, .. } if is_dead_store(self.planned, &self.plan.structs, self.unit, self.source, *pointer) => {
                return None;
            }
            // A call that can go, and whose result nobody reads.
            Statement::Call { function, result, .. }
                if result.is_none_or(|r| self.exprs[r.index()].is_none())
                    && !self.planned.is_kept(&self.plan.functions, self.unit, *function) =>
            {
                return None;
            }
            other => other.clone(),
        };
        statement_operands_mut(&mut trimmed, &mut |h| *h = self.get(*h));
        Some(trimmed)
    }
}

fn flush(emitted: &mut Option<Emitted>, block: &mut Block) {
    if let Some((first, last, span)) = emitted.take() {
        block.push(Statement::Emit(Range::new_from_bounds(first, last)), span);
    }
}
