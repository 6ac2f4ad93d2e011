//! What must not happen at any input.

use serde_json::Value as Json;

use super::subject::Subject;
use super::{number, worst_of};
use crate::data::{Fault, Verdict, Worst};

/// Counts results that are not numbers, infinite, or negative where they should not be. Of each fault the first input is kept: in the order of
/// the rows the sampled ones come first, then the hard ones.
pub(crate) fn verdict(subject: &Subject, rows: &[Json], got: &[Vec<f64>], truth: &[Vec<f64>]) -> Verdict {
    let mut verdict = Verdict::default();
    for ((row, got), truth) in rows.iter().zip(got).zip(truth) {
        note(subject, &mut verdict, row, got, truth);
    }
    verdict
}

/// Adds one result to a verdict; whether it has a fault.
pub(crate) fn note(subject: &Subject, verdict: &mut Verdict, row: &Json, got: &[f64], truth: &[f64]) -> bool {
    let at = |is: &dyn Fn(f64, f64) -> bool| got.iter().zip(truth).position(|(got, truth)| is(*got, *truth));
    let mut found = false;
    let faults: [(&mut Fault, Option<usize>); 3] = [
        (&mut verdict.nan, at(&|got, _| got.is_nan())),
        (&mut verdict.infinite, at(&|got, truth| got.is_infinite() && truth.is_finite())),
        (&mut verdict.negative, at(&|got, truth| got < 0.0 && truth >= 0.0)),
    ];
    for (fault, at) in faults {
        let Some(at) = at else { continue };
        found = true;
        fault.count += 1;
        if fault.worst.is_none() {
            let names = subject.probe.components();
            fault.worst = Some(Worst {
                component: names.get(at).cloned().unwrap_or_default(),
                got: number(got.get(at)),
                expected: number(truth.get(at)),
                ..worst_of(subject, row, got, truth)
            });
        }
    }
    found
}
