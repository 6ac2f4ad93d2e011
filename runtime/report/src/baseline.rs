//! What errors and costs were when somebody last looked, so that a change that makes one worse is noticed.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use shadewright_compiler::Report as Diagnostics;
use shadewright_compiler::diagnostics::{Diagnostic, SourceFile, codes};

use crate::data::{Cost, Errors, Report, Row};

/// An error that is smaller is rounding of double precision, which differs between machines.
const NOISE: f64 = 1e-12;
/// Share by which an error may grow before it is worse. Everything is computed in the same way everywhere but the closed forms,
/// whose last digits are the machine's.
const TOLERANCE: f64 = 1e-3;

/// A line for each row of a report, by experiment and label.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// The rows.
    pub rows: IndexMap<String, Line>,
}

/// What a change must not make worse.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Model error; none where the formula is its own truth.
    pub model: Option<Sizes>,
    /// Rounding error of the evaluator's f32.
    pub rounding: Sizes,
    /// Inputs that gave NaN, an infinity, a negative number, a jump.
    pub faults: [usize; 4],
    /// What the linked function holds.
    pub cost: Cost,
    /// Weighted operations that a call executes, in the mean.
    pub executed: f64,
}

/// Size of an error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sizes {
    /// Root of the mean square.
    pub rms: f64,
    /// Largest that was found.
    pub most: f64,
}

impl Baseline {
    /// Of a report made without a device, quickly: that is equal on every machine.
    pub fn of(report: &Report) -> Self {
        let rows = report.experiments.iter().flat_map(|results| {
            let name = move |row: &Row| format!("{}: {}", results.name, row.label);
            results.rows.iter().map(move |row| (name(row), Line::of(row)))
        });
        Self { rows: rows.collect() }
    }

    /// Reads a baseline.
    ///
    /// # Errors
    /// The text is no JSON, or of another form.
    pub fn read(name: &str, text: &str) -> Result<Self, Diagnostics> {
        serde_json::from_str(text).map_err(|error| {
            let file = SourceFile::new(name, text);
            let at = file.byte_at(shadewright_compiler::diagnostics::Position {
                line: error.line().max(1),
                column: error.column().max(1),
            });
            Diagnostic::new(codes::BASELINE_INVALID, "this is no baseline of errors and costs")
                .at(&file, at..at, error.to_string())
                .note("`shadewright report --accept FILE` writes one")
                .into()
        })
    }

    /// As JSON, a line a number: a diff shows what changed.
    pub fn to_json(&self) -> String {
        // Plain data with names as keys.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// What is worse now, a line each that begins with the row's name; and what is better.
    pub fn compare(&self, now: &Self) -> Comparison {
        let mut comparison = Comparison::default();
        for (name, old) in &self.rows {
            match now.rows.get(name) {
                None => comparison.worse.push(format!("{name}: is gone")),
                Some(new) => old.compare(new, name, &mut comparison),
            }
        }
        for name in now.rows.keys().filter(|name| !self.rows.contains_key(*name)) {
            comparison.worse.push(format!("{name}: is not in the baseline"));
        }
        comparison
    }
}

/// What changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Rows that are worse, gone, or new.
    pub worse: Vec<String>,
    /// Rows that are better.
    pub better: Vec<String>,
}

impl Comparison {
    fn error(&mut self, name: &str, what: &str, old: f64, new: f64) {
        let line = || format!("{name}: {what} {new:.4e}, was {old:.4e}");
        // Written so that what is no number is worse.
        if !(new <= old * (1.0 + TOLERANCE) || new <= NOISE) {
            self.worse.push(line());
        } else if new < old * (1.0 - TOLERANCE) && old > NOISE {
            self.better.push(line());
        }
    }

    fn count(&mut self, name: &str, what: &str, old: f64, new: f64) {
        let line = || format!("{name}: {what} {new}, was {old}");
        // A mean of whole numbers: its last digits are the order of a sum.
        if new > old * (1.0 + 1e-9) {
            self.worse.push(line());
        } else if new < old * (1.0 - 1e-9) {
            self.better.push(line());
        }
    }
}

impl Line {
    fn of(row: &Row) -> Self {
        let sizes = |errors: &Errors| Sizes {
            rms: errors.rms,
            most: errors.searched,
        };
        let verdict = &row.verdict;
        Self {
            model: row.model.as_ref().map(sizes),
            rounding: sizes(&row.rounding_cpu),
            faults: [&verdict.nan, &verdict.infinite, &verdict.negative, &verdict.discontinuous].map(|fault| fault.count),
            cost: row.cost,
            executed: row.executed.mean,
        }
    }

    fn compare(&self, new: &Self, name: &str, to: &mut Comparison) {
        match (&self.model, &new.model) {
            (Some(old), Some(new)) => {
                to.error(name, "model error (rms)", old.rms, new.rms);
                to.error(name, "largest model error", old.most, new.most);
            }
            (Some(_), None) => to.worse.push(format!("{name}: has no truth any more")),
            (None, Some(_)) => to.worse.push(format!("{name}: has a truth that is not in the baseline")),
            (None, None) => {}
        }
        to.error(name, "rounding error (rms)", self.rounding.rms, new.rounding.rms);
        to.error(name, "largest rounding error", self.rounding.most, new.rounding.most);
        for (at, what) in ["NaN", "infinities", "negatives", "discontinuities"].into_iter().enumerate() {
            to.count(name, what, self.faults[at] as f64, new.faults[at] as f64);
        }
        for ((what, old), (_, new)) in named(&self.cost).into_iter().zip(named(&new.cost)) {
            to.count(name, &what, old, new);
        }
        to.count(name, "executed operations", self.executed, new.executed);
    }
}

/// The counts by the names that JSON has.
fn named(cost: &Cost) -> Vec<(String, f64)> {
    let json = serde_json::to_value(cost).unwrap_or_default();
    let fields = json.as_object().into_iter().flatten();
    fields
        .map(|(name, count)| (name.clone(), count.as_f64().unwrap_or(f64::NAN)))
        .collect()
}
