//! What must not have happened and did: what a reader should see first.

use serde_json::Value;

use super::text::replay;
use crate::data::{Agreement, Report, Results, Row, Worst};

/// What happened, the worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Not a number.
    Nan,
    /// Infinite.
    Infinite,
    /// Rounded worse than WGSL's accuracy table allows: device against evaluator, or f32 against double precision.
    Outside,
    /// A jump where the truth has none.
    Discontinuous,
    /// Below 0 where the truth is not.
    Negative,
}

impl Kind {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Nan => "NaN",
            Kind::Infinite => "Infinite",
            Kind::Outside => "Outside WGSL's allowance",
            Kind::Discontinuous => "Discontinuous",
            Kind::Negative => "Negative",
        }
    }
}

/// One kind of fault in one place.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault<'a> {
    /// What happened.
    pub kind: Kind,
    /// Experiment or, where device and evaluator disagree, module.
    pub place: &'a str,
    /// Row of the experiment; none where device and evaluator disagree.
    pub row: Option<&'a str>,
    /// Function of the interface.
    pub function: &'a str,
    /// How often; 0 where only the figures of the error show it.
    pub count: usize,
    /// Of so many configurations or results.
    pub of: usize,
    /// The worst input and what came of it, where one is known.
    pub worst: Option<&'a Worst>,
    /// The command that shows it, where the input is known.
    pub command: Option<String>,
}

/// All faults of a report: the worst kind first, within it in the report's order.
pub fn faults(report: &Report) -> Vec<Fault<'_>> {
    let rows = report
        .experiments
        .iter()
        .flat_map(|results| results.rows.iter().map(move |row| (results, row)));
    let mut faults: Vec<Fault<'_>> = rows.flat_map(|(results, row)| of_row(results, row)).collect();
    faults.extend(report.agreement.iter().filter(|one| one.outside > 0).map(of_device));
    faults.sort_by_key(|fault| fault.kind);
    faults
}

/// Faults of one row.
pub fn of_row<'a>(results: &'a Results, row: &'a Row) -> Vec<Fault<'a>> {
    let verdict = &row.verdict;
    let of = results.configurations + results.hard;
    let make = |kind, count, worst: Option<&'a Worst>| Fault {
        kind,
        place: &results.name,
        row: Some(&row.label),
        function: &results.function,
        count,
        of,
        worst,
        command: worst.and_then(|worst| command(&row.recipe, &results.function, worst)),
    };
    let counted = [
        (Kind::Nan, &verdict.nan),
        (Kind::Infinite, &verdict.infinite),
        (Kind::Discontinuous, &verdict.discontinuous),
        (Kind::Negative, &verdict.negative),
    ];
    let mut faults: Vec<Fault<'a>> = counted
        .into_iter()
        .filter(|(_, fault)| fault.count > 0)
        .map(|(kind, fault)| make(kind, fault.count, fault.worst.as_ref()))
        .collect();
    // The counts cover the configurations; what the search found, and an error that overflowed, shows in the figures alone.
    let errors = [row.model.as_ref(), row.rounding.as_ref(), Some(&row.rounding_cpu)];
    for errors in errors.into_iter().flatten() {
        let figures = [errors.rms, errors.p95, errors.max, errors.bias, errors.searched];
        for (kind, found) in [
            (Kind::Nan, figures.iter().any(|figure| figure.is_nan())),
            (Kind::Infinite, figures.iter().any(|figure| figure.is_infinite())),
        ] {
            if found && !faults.iter().any(|fault| fault.kind == kind) {
                faults.push(make(kind, 0, Some(&errors.worst)));
            }
        }
    }
    faults.sort_by_key(|fault| fault.kind);
    faults
}

fn of_device(one: &Agreement) -> Fault<'_> {
    Fault {
        kind: Kind::Outside,
        place: &one.module,
        row: None,
        function: &one.function,
        count: one.outside,
        of: one.results,
        worst: one.worst.as_ref(),
        command: one.worst.as_ref().and_then(|worst| command(&one.recipe, &one.function, worst)),
    }
}

/// The command that shows what happened; none where no input is known.
pub fn command(recipe: &str, function: &str, worst: &Worst) -> Option<String> {
    match worst.input {
        Value::Null => None,
        _ => Some(replay(recipe, function, &worst.input)),
    }
}
