//! Functions that do nothing but give a value.

use naga::{AddressSpace, Block, Expression, Function, Handle, Statement, TypeInner};

use super::Planned;
use crate::parse::Unit;

/// Whether a function writes nothing but its own variables and calls only such functions.
pub fn is_pure(unit: &Unit, function: &Function, calls_pure: &dyn Fn(Handle<Function>) -> bool) -> bool {
    block(unit, function, &function.body, calls_pure)
}

fn block(unit: &Unit, function: &Function, body: &Block, calls_pure: &dyn Fn(Handle<Function>) -> bool) -> bool {
    body.iter().all(|statement| match statement {
        Statement::Emit(_) | Statement::Break | Statement::Continue | Statement::Return { .. } => true,
        Statement::Block(inner) => block(unit, function, inner, calls_pure),
        Statement::If { accept, reject, .. } => block(unit, function, accept, calls_pure) && block(unit, function, reject, calls_pure),
        Statement::Switch { cases, .. } => cases.iter().all(|c| block(unit, function, &c.body, calls_pure)),
        Statement::Loop { body, continuing, .. } => {
            block(unit, function, body, calls_pure) && block(unit, function, continuing, calls_pure)
        }
        Statement::Store { pointer, .. } => writes_local(unit, function, *pointer),
        Statement::Call { function, .. } => calls_pure(*function),
        _ => false,
    })
}

fn writes_local(unit: &Unit, function: &Function, mut pointer: Handle<Expression>) -> bool {
    loop {
        match function.expressions[pointer] {
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => pointer = base,
            Expression::LocalVariable(_) => return true,
            Expression::GlobalVariable(global) => return unit.ir.global_variables[global].space == AddressSpace::Function,
            _ => return false,
        }
    }
}

/// Whether a call may go when nobody reads its result: the callee is pure, and is given no pointer to write through. A
/// function without a result stays: what stands among its arguments may act.
pub fn can_go(functions: &[Planned], planned: &Planned, unit: &Unit, callee: Handle<Function>) -> bool {
    let takes_pointer = unit.ir.functions[callee].arguments.iter().any(|a| {
        matches!(
            unit.ir.types[a.ty].inner,
            TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. }
        )
    });
    !takes_pointer && unit.ir.functions[callee].result.is_some() && planned.calls.get(&callee).is_some_and(|&id| functions[id].pure)
}
