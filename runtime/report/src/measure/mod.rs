//! Measures one alternative of an experiment.
//!
//! ```text
//! experiment, alternative -> Subject: formula in f32, f64, with allowances; truth        (subject)
//! seed                    -> points of the unit cube -> rows of inputs                    (sample, experiment::domain)
//! Subject, rows           -> statistics of model error and rounding error                 (errors)
//!                         -> NaN, infinities, negatives, jumps                            (verdict, jumps)
//!                         -> the device held against what WGSL allows                  (agree)
//!                         -> the worst input, by search                                   (search)
//!                         -> a picture of the plane through it                            (slice)
//! ```

mod agree;
mod errors;
mod executed;
mod jumps;
mod row;
mod sample;
mod search;
mod slice;
mod subject;
mod verdict;

use serde_json::{Value as Json, json};
use shadewright_compiler::Report;
use shadewright_runtime::gpu::RuntimeError;

pub(crate) use errors::statistics;
pub(crate) use executed::executed;
pub(crate) use row::{Effort, Measured, OnDevice, configurations, key, mark_dominated, measure, one_line};
pub(crate) use sample::{Random, latin};
pub(crate) use subject::{Known, Subject};

use crate::data::Worst;
use errors::largest;

/// Why an alternative cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// Its recipe cannot be linked, a row does not fit it, or the device fails.
    #[error(transparent)]
    Runtime(#[from] RuntimeError),
    /// The library is wrong.
    #[error(transparent)]
    Compile(#[from] Report),
    /// A truth that is none.
    #[error("{experiment}, {label}: the truth {why} at {row}")]
    Truth {
        /// The experiment.
        experiment: String,
        /// The alternative.
        label: String,
        /// The input.
        row: String,
        /// What it is.
        why: String,
    },
    /// A finished row cannot be kept.
    #[error("a finished row cannot be kept: {0}")]
    Keep(#[from] std::io::Error),
    /// The solver of a fit gave up.
    #[error("a fit ends without a result: {0}")]
    Fit(String),
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Which error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Of {
    /// The formula in double precision against the truth.
    Model,
    /// The formula in f32 against itself in double precision.
    Rounding,
}

impl Of {
    fn name(self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::Rounding => "rounding",
        }
    }

    /// What is, and what should be, on the CPU.
    fn values(self, subject: &Subject, rows: &[Json]) -> Result<[Vec<Vec<f64>>; 2], MeasureError> {
        let table = subject.table(rows)?;
        let precise = subject.probe.on_cpu::<f64>(&table)?.values;
        match self {
            Self::Model => {
                let truth = subject.truth(rows)?.unwrap_or_else(|| precise.clone());
                Ok([precise, truth])
            }
            Self::Rounding => {
                let single = subject.probe.on_cpu::<f32>(&table)?.values;
                Ok([single.into_iter().map(widened).collect(), precise])
            }
        }
    }
}

fn widened(values: Vec<f32>) -> Vec<f64> {
    values.into_iter().map(f64::from).collect()
}

/// An input and what came of it: the number that is off most.
pub(crate) fn worst_of(subject: &Subject, row: &Json, got: &[f64], truth: &[f64]) -> Worst {
    let (_, index) = largest(subject.metric(), got, truth);
    let names = subject.probe.components();
    Worst {
        input: subject.fitted(row),
        component: names.get(index).cloned().unwrap_or_default(),
        got: number(got.get(index)),
        expected: number(truth.get(index)),
    }
}

/// A number; what JSON has no number for as text.
pub(crate) fn number(x: Option<&f64>) -> Json {
    match x {
        None => Json::Null,
        Some(x) if x.is_finite() => json!(x),
        Some(x) if x.is_nan() => json!("NaN"),
        Some(x) if *x > 0.0 => json!("Infinity"),
        Some(_) => json!("-Infinity"),
    }
}
