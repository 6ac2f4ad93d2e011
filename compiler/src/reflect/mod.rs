//! What a host program must know to run a linked module.

mod types;

pub use types::*;
