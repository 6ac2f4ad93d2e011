//! Stores into members that nobody reads.

use naga::{Expression, Handle, TypeInner};

use super::Structs;

/// Whether a store writes a member that nobody reads.
pub fn is_dead_store(
    home: usize,
    structs: &Structs,
    function: &naga::Function,
    info: &naga::valid::FunctionInfo,
    ir: &naga::Module,
    mut pointer: Handle<Expression>,
) -> bool {
    loop {
        match function.expressions[pointer] {
            Expression::AccessIndex { base, index } => {
                if struct_of(home, structs, info, ir, base).is_some_and(|id| !structs.is_live(id, index)) {
                    return true;
                }
                pointer = base;
            }
            Expression::Access { base, .. } => pointer = base,
            _ => return false,
        }
    }
}

/// The struct that an expression is, or points to.
pub fn struct_of(
    home: usize,
    structs: &Structs,
    info: &naga::valid::FunctionInfo,
    ir: &naga::Module,
    handle: Handle<Expression>,
) -> Option<usize> {
    let resolution = &info[handle].ty;
    let ty = match *resolution.inner_with(&ir.types) {
        TypeInner::Pointer { base, .. } => base,
        TypeInner::Struct { .. } => resolution.handle()?,
        _ => return None,
    };
    structs.id(home, ty)
}
