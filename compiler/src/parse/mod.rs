//! WGSL text to parsed units: each module alone, against stubs of what it calls.

mod capabilities;
mod checks;
mod compose;
pub mod lex;
pub mod scan;
mod unit;

pub use capabilities::missing;
pub use checks::{brackets, same_signature};
pub use compose::{Interface, Needs, Origin, SlotNeed, compose, constant_name, fields_struct, param_uses, typed_wgsl, wgsl_type};
pub use unit::{StructKey, Unit, chain, check_interface, labelled, parse_unit, parse_whole, readable};
