//! What a host program must know to run a linked module.

mod bindings;
mod build;
mod layout;
mod types;

pub use bindings::{binding_type, entry_point, stage, stages_using};
pub use build::reflect;
pub use layout::{Layouts, wgsl_type_name};
pub use types::*;
