//! Speed against error: experiments on modules, and the report of their results.
//!
//! An experiment is data of a library: which modules are compared, over which configurations, against what truth
//! ([`experiment`]). Running it gives each module a row ([`run`]): the error of its formula against the truth, apart from that the
//! error of 32-bit arithmetic, what happens at hard inputs, what it holds and executes, and how long it takes beside the others. A report
//! of all rows is plain data ([`data`]) and is written as a page, as JSON, CSV and pictures ([`write::files`]). Its part that is equal on every
//! machine is a [`Baseline`] against which a change is held. What manifests claim of modules is held against a device by [`proofs`].
//!
//! ```text
//! *.experiment.ron -> Experiment -> configurations -> values: device, f32, f64, bounds, truth -> Row -> Report -> page, JSON, CSV, PNG, SVG
//!                     (experiment)                    (measure)                                 (run)    (write)
//! ```
#![forbid(unsafe_code)]

mod baseline;
pub mod data;
pub mod experiment;
pub mod fit;
mod measure;
pub mod proofs;
mod run;
pub mod write;

pub use baseline::{Baseline, Comparison};
pub use data::Report;
pub use experiment::{Experiment, load as experiments};
pub use measure::MeasureError;
pub use run::{Done, Options, ReportError, run};
