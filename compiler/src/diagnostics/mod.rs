//! Errors that point into the author's file.

pub mod codes;
mod render;
mod report;

pub use report::{Diagnostic, Label, Part, Position, Report, SourceFile, nearest};
