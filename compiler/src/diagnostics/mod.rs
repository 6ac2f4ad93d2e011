//! Errors that point into the author's file.

mod report;

pub use report::{Diagnostic, Label, Report, SourceFile};
