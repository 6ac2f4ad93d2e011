//! Stores into members that nobody reads.

use naga::{Expression, Handle};

use super::{Planned, Structs};
use crate::parse::{Unit, struct_type};

/// Whether a store writes a member that nobody reads.
pub fn is_dead_store(
    planned: &Planned,
    structs: &Structs,
    unit: &Unit,
    function: &naga::Function,
    mut pointer: Handle<Expression>,
) -> bool {
    loop {
        match function.expressions[pointer] {
            Expression::AccessIndex { base, index } => {
                if struct_of(planned, structs, unit, base).is_some_and(|id| !structs.is_live(id, index)) {
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
pub fn struct_of(planned: &Planned, structs: &Structs, unit: &Unit, handle: Handle<Expression>) -> Option<usize> {
    structs.id(planned.home, struct_type(unit, planned.info_of(unit)?, handle)?)
}
