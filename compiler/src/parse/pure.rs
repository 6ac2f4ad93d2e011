//! Functions that do nothing but give a value.

use naga::{AddressSpace, Block, Expression, Function, Handle, Module, Statement, TypeInner};

/// Whether the statements of a block write nothing but the function's own variables, apart from what they call.
pub fn writes_only_own(ir: &Module, function: &Function, block: &Block) -> bool {
    let inner = |block: &Block| writes_only_own(ir, function, block);
    block.iter().all(|statement| match statement {
        Statement::Emit(_) | Statement::Break | Statement::Continue | Statement::Return { .. } | Statement::Call { .. } => true,
        Statement::Block(block) => inner(block),
        Statement::If { accept, reject, .. } => inner(accept) && inner(reject),
        Statement::Switch { cases, .. } => cases.iter().all(|c| inner(&c.body)),
        Statement::Loop { body, continuing, .. } => inner(body) && inner(continuing),
        Statement::Store { pointer, .. } => writes_local(ir, function, *pointer),
        _ => false,
    })
}

fn writes_local(ir: &Module, function: &Function, mut pointer: Handle<Expression>) -> bool {
    loop {
        match function.expressions[pointer] {
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => pointer = base,
            Expression::LocalVariable(_) => return true,
            Expression::GlobalVariable(global) => return ir.global_variables[global].space == AddressSpace::Function,
            _ => return false,
        }
    }
}

/// Whether a call of a function may go when nobody reads its result, if the function is pure: it gives one, and takes no
/// pointer to write through. A function without a result stays: what stands among its arguments may act.
pub fn droppable(ir: &Module, function: &Function) -> bool {
    let pointer = |ty| matches!(ir.types[ty].inner, TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. });
    function.result.is_some() && !function.arguments.iter().any(|a| pointer(a.ty))
}
