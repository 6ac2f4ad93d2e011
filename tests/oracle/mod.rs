//! What the modules must compute, in double precision, written from the papers.
//!
//! Each function is the textbook form of its formula, in angles where the paper has angles: none is a translation of
//! the WGSL, which uses other forms for the sake of 32-bit floats. `tests/oracles.rs` pins them to published values and
//! to identities that they must obey.

// Every test program that includes this uses a part of it.
#![allow(dead_code)]

pub mod display;
pub mod lights;
pub mod quadrature;
pub mod reflection;
pub mod shadows;
