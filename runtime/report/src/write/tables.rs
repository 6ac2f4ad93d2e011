//! `rows.csv`: a line for each row of each experiment.

use super::WriteError;
use crate::data::{Cost, Errors, Report, Results, Row};

/// Names of the statistics in [`Errors`].
const STATISTICS: [&str; 5] = ["rms", "p95", "max", "bias", "searched"];

/// Kinds of operations and resources in [`Cost`]: short names and counts, in its order.
pub fn costs(cost: &Cost) -> [(&'static str, u32); 12] {
    [
        ("add", cost.add),
        ("multiply", cost.multiply),
        ("divide", cost.divide),
        ("root", cost.root),
        ("transcendental", cost.transcendental),
        ("select", cost.select),
        ("integer", cost.integer),
        ("texture", cost.texture),
        ("loops", cost.loops),
        ("branches", cost.branches),
        ("uniform_bytes", cost.uniform_bytes),
        ("bindings", cost.bindings),
    ]
}

fn statistics(errors: Option<&Errors>) -> [String; 5] {
    let figures = errors.map(|errors| [errors.rms, errors.p95, errors.max, errors.bias, errors.searched]);
    figures.map_or_else(Default::default, |figures| figures.map(full))
}

/// All digits, and an exponent where there would be many zeros: `1e-7`, `inf`, `NaN`.
fn full(value: f64) -> String {
    format!("{value:?}")
}

/// The whole table with its header. What is missing is an empty cell.
///
/// # Errors
/// None that a caller could cause.
pub fn rows(report: &Report) -> Result<Vec<u8>, WriteError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header())?;
    for results in &report.experiments {
        for row in &results.rows {
            writer.write_record(line(results, row))?;
        }
    }
    writer.into_inner().map_err(|error| WriteError::Csv(error.into_error().into()))
}

fn header() -> Vec<String> {
    let mut names: Vec<String> = ["experiment", "category", "function", "row", "recipe", "baseline", "dominated"]
        .map(str::to_owned)
        .to_vec();
    for errors in ["model", "rounding_device", "rounding_cpu"] {
        names.extend(STATISTICS.map(|name| format!("{errors}_{name}")));
    }
    let rest = [
        "rounding_allowed",
        "nan",
        "infinite",
        "negative",
        "discontinuous",
        "executed_mean",
        "executed_max",
        "loop_trips",
        "texture_reads",
        "time_median",
        "time_p10",
        "time_p90",
        "nanoseconds",
    ];
    names.extend(rest.map(str::to_owned));
    names.extend(costs(&Cost::default()).map(|(name, _)| format!("cost_{name}")));
    names
}

fn line(results: &Results, row: &Row) -> Vec<String> {
    let mut cells = vec![
        results.name.clone(),
        results.category.clone(),
        results.function.clone(),
        row.label.clone(),
        row.recipe.clone(),
        (row.label == results.baseline).to_string(),
        row.dominated.to_string(),
    ];
    cells.extend(statistics(row.model.as_ref()));
    cells.extend(statistics(row.rounding.as_ref()));
    cells.extend(statistics(Some(&row.rounding_cpu)));
    cells.push(row.allowed.map(full).unwrap_or_default());
    let verdict = &row.verdict;
    let counts = [&verdict.nan, &verdict.infinite, &verdict.negative, &verdict.discontinuous];
    cells.extend(counts.map(|fault| fault.count.to_string()));
    let executed = &row.executed;
    cells.extend([executed.mean, executed.max, executed.trips, executed.texture].map(full));
    let time = row.time.map(|time| [time.median, time.p10, time.p90, time.nanoseconds].map(full));
    cells.extend(time.unwrap_or_default());
    cells.extend(costs(&row.cost).map(|(_, count)| count.to_string()));
    cells
}
