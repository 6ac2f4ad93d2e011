//! Evaluates validated naga modules on the CPU, generic over the number type, and counts what they cost.
//!
//! ```text
//! naga::Module, ModuleInfo, entry point -> Program: instructions over a memory of numbers   (compile)
//! Program, a number type                -> Machine: bind buffers and textures, run, read     (machine)
//! naga::Function                        -> Analysis: what a call costs, without running it   (cost)
//! ```
//!
//! A [`Program`] knows no number type. A [`Machine`] runs it with one: `f32` as a machine that rounds correctly has it, `f64` for
//! the same formula in double precision, and [`Allowed`] for f32 with an interval of all that a conforming driver may have in its
//! place. Literals are f32 in the IR, and so is what buffers hold: f64 gets these values, not what they were rounded from.
//!
//! A value is a list of numbers, at a place that is fixed when the program is compiled, since WGSL has no recursion. So an
//! evaluation allocates nothing and looks nothing up.
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
