//! Branches on constants: only one side of them is linked.

use naga::{Block, Expression, Handle, Literal, Statement};

/// Which side of a branch is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// Only known when the shader runs.
    Open,
    /// Always the first.
    Accept,
    /// Always the second.
    Reject,
}

/// The side that a condition takes. naga has folded what was constant when it parsed the unit.
///
/// The condition of a `while` or `for` stays open, and so does the branch that naga makes of `a && f()`: the text has none
/// there that could go.
pub fn choice(ir: &naga::Module, function: &naga::Function, condition: Handle<Expression>, accept: &Block, reject: &Block) -> Choice {
    if accept.is_empty() && matches!(**reject, [Statement::Break]) {
        return Choice::Open;
    }
    let is_lowered = match accept.last() {
        Some(&Statement::Store { pointer, .. }) => match function.expressions[pointer] {
            Expression::LocalVariable(local) => function.local_variables[local].name.is_none(),
            _ => false,
        },
        _ => false,
    };
    if is_lowered {
        return Choice::Open;
    }
    let literal = match function.expressions[condition] {
        Expression::Literal(literal) => Some(literal),
        Expression::Constant(constant) => match ir.global_expressions[ir.constants[constant].init] {
            Expression::Literal(literal) => Some(literal),
            _ => None,
        },
        _ => None,
    };
    match literal {
        Some(Literal::Bool(true)) => Choice::Accept,
        Some(Literal::Bool(false)) => Choice::Reject,
        _ => Choice::Open,
    }
}

/// The statements of a block that can be reached: a branch that is always taken and leaves the block ends it.
pub fn reachable<'b>(
    ir: &naga::Module,
    function: &naga::Function,
    block: &'b Block,
) -> impl Iterator<Item = (&'b Statement, &'b naga::Span)> {
    let end = block
        .iter()
        .position(|s| leaves(ir, function, s))
        .map_or(block.len(), |last| last + 1);
    block.span_iter().take(end)
}

/// Whether nothing after a statement can be reached because of a branch on a constant, or because it leaves the block itself.
pub fn leaves(ir: &naga::Module, function: &naga::Function, statement: &Statement) -> bool {
    let last_leaves = |block: &Block| block.iter().any(|s| leaves(ir, function, s));
    match statement {
        Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue => true,
        Statement::Block(inner) => last_leaves(inner),
        Statement::If { condition, accept, reject } => match choice(ir, function, *condition, accept, reject) {
            Choice::Accept => last_leaves(accept),
            Choice::Reject => last_leaves(reject),
            Choice::Open => false,
        },
        _ => false,
    }
}
