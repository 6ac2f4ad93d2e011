//! WGSL text to parsed units: each module alone, against stubs of what it calls.

mod branches;
mod capabilities;
mod checks;
mod compose;
mod facts;
mod filter;
pub mod lex;
mod operands;
mod pure;
pub mod scan;
mod unit;

pub use branches::{Choice, choice, leaves, reachable};
pub use capabilities::missing;
pub use checks::{brackets, same_signature};
pub use compose::{Interface, Needs, Origin, SlotNeed, compose, constant_name, fields_struct, param_uses, typed_wgsl, wgsl_type};
pub use facts::{Action, Call, Facts, Store, struct_type};
pub use filter::{Filter, word_hash};
pub use operands::{expression_operands, expression_operands_mut, statement_operands_mut};
pub use unit::{StructKey, Unit, chain, check_interface, labelled, parse_unit, parse_whole, readable};
