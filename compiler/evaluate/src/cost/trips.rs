//! How often a counted loop runs.
//!
//! `for (var i = a; i < b; i += c)` with constants: the loop's body begins with an exit that compares the counter, its continuing part is
//! the only place that changes the counter, and the counter's first value is constant. Then the counting is done here, step by step.

use std::cell::Cell;

use naga::{
    BinaryOperator as B, Block, Expression, Function, Handle, Literal, LocalVariable, MathFunction as M, Module, ScalarKind, Statement,
    TypeInner, UnaryOperator,
};

/// A loop that counts further is left alone.
const MOST: u32 = 1 << 16;
/// And one whose counting takes more evaluations of expressions: values that stand for doubled values grow without end.
const EFFORT: u32 = 1 << 20;
/// Deeper expressions are left alone.
const DEEPEST: u32 = 64;

/// A constant, or the counter.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Number {
    Bool(bool),
    I32(i32),
    U32(u32),
    F32(f32),
}

/// A counted loop in its function.
pub(super) struct Trips<'m> {
    module: &'m Module,
    function: &'m Function,
    counter: Handle<LocalVariable>,
    /// Evaluations left.
    effort: Cell<u32>,
}

impl<'m> Trips<'m> {
    /// Trips of a loop, at most; `before` is what stands before it in its block.
    pub fn of(module: &'m Module, function: &'m Function, before: &[Statement], statement: &Statement) -> Option<u32> {
        let Statement::Loop { body, continuing, .. } = statement else {
            return None;
        };
        let (condition, stays) = exit(body)?;
        let (counter, next) = continuing.iter().find_map(|s| match s {
            Statement::Store { pointer, value } => Some((local(function, *pointer)?, *value)),
            _ => None,
        })?;
        let trips = Self {
            module,
            function,
            counter,
            effort: Cell::new(EFFORT),
        };
        let inside = trips.changes(body) + trips.changes(continuing);
        if inside != 1 {
            return None;
        }
        let mut value = trips.first(before)?;
        let mut count = 0;
        while trips.value(condition, Some(value), 0)? == Number::Bool(stays) {
            count += 1;
            if count > MOST {
                return None;
            }
            value = trips.value(next, Some(value), 0)?;
        }
        Some(count)
    }

    /// The counter before the first trip: stored right before the loop, or declared with the variable that nothing else changes.
    fn first(&self, before: &[Statement]) -> Option<Number> {
        for (index, statement) in before.iter().enumerate().rev() {
            match statement {
                Statement::Store { pointer, value } if local(self.function, *pointer) == Some(self.counter) => {
                    return self.value(*value, None, 0);
                }
                _ if self.changes(&before[index..=index]) > 0 => return None,
                _ => {}
            }
        }
        if self.changes(&self.function.body) > 1 {
            return None;
        }
        let init = self.function.local_variables[self.counter].init?;
        self.value(init, None, 0)
    }

    /// Statements in a block, however deep, that may change the counter.
    fn changes(&self, block: &[Statement]) -> usize {
        let is_counter = |pointer: &Handle<Expression>| local(self.function, *pointer) == Some(self.counter);
        let of = |statement: &Statement| match statement {
            Statement::Store { pointer, .. } | Statement::Atomic { pointer, .. } => usize::from(is_counter(pointer)),
            Statement::Call { arguments, .. } => arguments.iter().filter(|a| is_counter(a)).count(),
            _ => blocks(statement).iter().map(|inner| self.changes(inner)).sum(),
        };
        block.iter().map(of).sum()
    }

    /// A constant expression, or one of constants and the counter.
    fn value(&self, handle: Handle<Expression>, counter: Option<Number>, depth: u32) -> Option<Number> {
        self.effort.set(self.effort.get().checked_sub(1)?);
        if depth > DEEPEST {
            return None;
        }
        let value = |handle| self.value(handle, counter, depth + 1);
        match self.function.expressions[handle] {
            Expression::Load { pointer } if local(self.function, pointer) == Some(self.counter) => counter,
            Expression::Constant(constant) => self.global(self.module.constants[constant].init),
            Expression::Unary { op, expr } => unary(op, value(expr)?),
            Expression::Binary { op, left, right } => binary(op, value(left)?, value(right)?),
            Expression::As { expr, kind, convert } => converted(value(expr)?, kind, convert),
            Expression::Math {
                fun: M::Min,
                arg,
                arg1: Some(other),
                ..
            } => choose(value(arg)?, value(other)?, true),
            Expression::Math {
                fun: M::Max,
                arg,
                arg1: Some(other),
                ..
            } => choose(value(arg)?, value(other)?, false),
            ref other => self.plain(other),
        }
    }

    fn global(&self, handle: Handle<Expression>) -> Option<Number> {
        self.plain(&self.module.global_expressions[handle])
    }

    fn plain(&self, expression: &Expression) -> Option<Number> {
        Some(match *expression {
            Expression::Literal(Literal::Bool(b)) => Number::Bool(b),
            Expression::Literal(Literal::I32(i)) => Number::I32(i),
            Expression::Literal(Literal::U32(u)) => Number::U32(u),
            Expression::Literal(Literal::F32(f)) => Number::F32(f),
            Expression::ZeroValue(ty) => match self.module.types[ty].inner {
                TypeInner::Scalar(scalar) if scalar.width == 4 => match scalar.kind {
                    ScalarKind::Sint => Number::I32(0),
                    ScalarKind::Uint => Number::U32(0),
                    ScalarKind::Float => Number::F32(0.0),
                    _ => return None,
                },
                _ => return None,
            },
            _ => return None,
        })
    }
}

/// The local variable that a pointer points at.
fn local(function: &Function, pointer: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    match function.expressions[pointer] {
        Expression::LocalVariable(variable) => Some(variable),
        _ => None,
    }
}

/// The exit at a loop's beginning: its condition, and what that is as long as the loop goes on.
fn exit(body: &Block) -> Option<(Handle<Expression>, bool)> {
    let first = body.iter().find(|s| !matches!(s, Statement::Emit(_)))?;
    let Statement::If { condition, accept, reject } = first else {
        return None;
    };
    let breaks = |block: &Block| matches!(block[..], [Statement::Break]);
    match (breaks(accept), breaks(reject)) {
        (true, false) if reject.is_empty() => Some((*condition, false)),
        (false, true) if accept.is_empty() => Some((*condition, true)),
        _ => None,
    }
}

/// The blocks inside a statement.
fn blocks(statement: &Statement) -> Vec<&Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// Whether anything but its exit at the beginning ends a loop.
pub(super) fn leaves(statement: &Statement) -> bool {
    let Statement::Loop { body, break_if, .. } = statement else {
        return false;
    };
    let exit = usize::from(exit(body).is_some());
    let without = body.iter().filter(|s| !matches!(s, Statement::Emit(_))).skip(exit);
    break_if.is_some() || without.into_iter().any(|s| ends(s, true))
}

/// Whether a statement may end the function, or the loop around it where its `break` would be the loop's.
fn ends(statement: &Statement, own: bool) -> bool {
    match statement {
        Statement::Return { .. } | Statement::Kill => true,
        Statement::Break => own,
        Statement::Loop { .. } | Statement::Switch { .. } => blocks(statement).iter().any(|b| b.iter().any(|s| ends(s, false))),
        _ => blocks(statement).iter().any(|b| b.iter().any(|s| ends(s, own))),
    }
}

fn unary(op: UnaryOperator, value: Number) -> Option<Number> {
    Some(match (op, value) {
        (UnaryOperator::Negate, Number::I32(i)) => Number::I32(i.wrapping_neg()),
        (UnaryOperator::Negate, Number::F32(f)) => Number::F32(-f),
        (UnaryOperator::LogicalNot, Number::Bool(b)) => Number::Bool(!b),
        _ => return None,
    })
}

fn binary(op: B, left: Number, right: Number) -> Option<Number> {
    let compare = |order: Option<std::cmp::Ordering>| {
        use std::cmp::Ordering as O;
        Some(Number::Bool(match op {
            B::Less => order == Some(O::Less),
            B::LessEqual => matches!(order, Some(O::Less | O::Equal)),
            B::Greater => order == Some(O::Greater),
            B::GreaterEqual => matches!(order, Some(O::Greater | O::Equal)),
            B::Equal => order == Some(O::Equal),
            B::NotEqual => order != Some(O::Equal),
            _ => return None,
        }))
    };
    match (left, right) {
        (Number::I32(a), Number::I32(b)) => match op {
            B::Add => Some(Number::I32(a.wrapping_add(b))),
            B::Subtract => Some(Number::I32(a.wrapping_sub(b))),
            B::Multiply => Some(Number::I32(a.wrapping_mul(b))),
            B::Divide => a.checked_div(b).map(Number::I32),
            B::Modulo => a.checked_rem(b).map(Number::I32),
            _ => compare(a.partial_cmp(&b)),
        },
        (Number::U32(a), Number::U32(b)) => match op {
            B::Add => Some(Number::U32(a.wrapping_add(b))),
            B::Subtract => Some(Number::U32(a.wrapping_sub(b))),
            B::Multiply => Some(Number::U32(a.wrapping_mul(b))),
            B::Divide => a.checked_div(b).map(Number::U32),
            B::Modulo => a.checked_rem(b).map(Number::U32),
            B::ShiftLeft => a.checked_shl(b).map(Number::U32),
            B::ShiftRight => a.checked_shr(b).map(Number::U32),
            _ => compare(a.partial_cmp(&b)),
        },
        (Number::I32(a), Number::U32(b)) => match op {
            B::ShiftLeft => a.checked_shl(b).map(Number::I32),
            B::ShiftRight => a.checked_shr(b).map(Number::I32),
            _ => None,
        },
        (Number::F32(a), Number::F32(b)) => match op {
            B::Add => Some(Number::F32(a + b)),
            B::Subtract => Some(Number::F32(a - b)),
            B::Multiply => Some(Number::F32(a * b)),
            B::Divide => Some(Number::F32(a / b)),
            _ => compare(a.partial_cmp(&b)),
        },
        _ => None,
    }
}

fn choose(left: Number, right: Number, less: bool) -> Option<Number> {
    let is_less = binary(B::Less, left, right)?;
    Some(if is_less == Number::Bool(less) { left } else { right })
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss
)] // WGSL's conversions
fn converted(value: Number, kind: ScalarKind, convert: Option<u8>) -> Option<Number> {
    if convert != Some(4) {
        return None;
    }
    Some(match (value, kind) {
        (Number::I32(i), ScalarKind::Uint) => Number::U32(i as u32),
        (Number::I32(i), ScalarKind::Float) => Number::F32(i as f32),
        (Number::U32(u), ScalarKind::Sint) => Number::I32(u as i32),
        (Number::U32(u), ScalarKind::Float) => Number::F32(u as f32),
        (Number::F32(f), ScalarKind::Sint) => Number::I32(f as i32),
        (Number::F32(f), ScalarKind::Uint) => Number::U32(f as u32),
        (value @ Number::I32(_), ScalarKind::Sint)
        | (value @ Number::U32(_), ScalarKind::Uint)
        | (value @ Number::F32(_), ScalarKind::Float) => value,
        _ => return None,
    })
}
