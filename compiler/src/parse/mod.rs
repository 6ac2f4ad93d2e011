//! WGSL text to parsed units: each module alone, against stubs of what it calls.

mod checks;
mod compose;
pub mod lex;
pub mod scan;
mod unit;

pub use compose::{Composed, Interface, Needs, Origin, SlotNeed, compose};
pub use unit::{StructKey, Unit, parse_unit};
