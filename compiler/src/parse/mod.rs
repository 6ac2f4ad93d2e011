//! WGSL text to parsed units: each module alone, against stubs of what it calls.

mod always;
mod branches;
mod capabilities;
mod checks;
mod compose;
mod cuts;
mod facts;
mod filter;
mod joined;
pub mod lex;
mod lines;
mod mentions;
mod operands;
mod pure;
pub mod scan;
mod templates;
mod unit;

pub use branches::{Choice, choice, reachable};
pub use capabilities::missing;
pub use checks::{brackets, same_signature};
pub use compose::{Interface, Needs, Origin, SlotNeed, compose, constant_name, fields_struct, param_uses, typed_wgsl, wgsl_type};
pub use cuts::{Constructor, Cuts, Let, Value};
pub use facts::{Action, Call, Facts, Store, struct_type};
pub use filter::{Filter, word_hash};
pub use joined::{Joined, joined};
pub use lines::whole_lines;
pub use mentions::Meaning;
pub use operands::{expression_operands, expression_operands_mut, statement_operands_mut};
pub use templates::{Template, Templates};
pub use unit::{StructKey, Unit, chain, check_interface, labelled, parse_unit, parse_whole, readable};
