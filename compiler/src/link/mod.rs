//! The plan, written: as IR for the runtime and the other languages, as source for people.

mod body;
mod combine;
mod edits;
mod ir;
mod source;
mod splice;
mod trace;
mod trim;
mod types;

pub use ir::link;
pub use source::{write_source, write_traced};
pub use trace::Section;
