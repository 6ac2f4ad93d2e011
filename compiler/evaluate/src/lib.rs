//! Evaluates validated naga modules on the CPU, generic over the number type, and counts what they cost.
#![forbid(unsafe_code)]

mod code;
mod compile;
pub mod cost;
mod error;
mod kind;
mod machine;
mod number;
mod texture;
mod tree;

pub use code::{Limits, Program};
pub use error::EvaluateError;
pub use kind::{Counts, Kind, operations};
pub use machine::{Invocation, Machine, Value};
pub use number::{Allowed, Number, Truth, Whole};
pub use texture::{Sampler, Texture};
