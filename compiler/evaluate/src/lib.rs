//! Evaluates validated naga modules on the CPU, generic over the number type, and counts what they cost.
#![forbid(unsafe_code)]

pub mod cost;
mod kind;

pub use kind::{Counts, Kind, operations};
