//! The part of a report that is the same on every machine, as Markdown to be checked in.

use super::faults::of_row;
use super::number::{count, number, optional, signed};
use super::tables::costs;
use super::text::{clean, parameters};
use crate::data::{Cost, Fits, Report, Results, Row};

/// Short tables, a section for each experiment: model error, rounding of the evaluator's f32, verdict, cost. No device, no time, no date.
pub fn markdown(report: &Report) -> String {
    let sections = report.experiments.iter().map(section).chain(report.fits.iter().map(fits));
    sections.collect::<Vec<_>>().join("\n")
}

/// Best fits to a table of measured reflectance.
fn fits(fits: &Fits) -> String {
    let mut text = format!(
        "## Best fits to {}\n\n{}; {}, fitted to {}. Errors are differences of ln(1 + f cos).\n\n",
        cell(&fits.name),
        cell(&fits.format),
        count(fits.compared, "sample"),
        fits.fitted
    );
    text += "| model | RMS | p95 | max | bias | executed | best fit |\n|---|---|---|---|---|---|---|\n";
    for row in &fits.rows {
        let errors = &row.errors;
        let figures = [errors.rms, errors.p95, errors.max].map(number).join(" | ");
        let (bias, cost) = (signed(errors.bias), number(row.executed.mean));
        text += &format!(
            "| {} | {figures} | {bias} | {cost} | {} |\n",
            cell(&row.label),
            cell(&parameters(row))
        );
    }
    text
}

fn section(results: &Results) -> String {
    let configurations = count(results.configurations, "configuration");
    let mut text = format!("## {}\n\n{}\n\n", cell(&results.name), cell(&results.title));
    text += &format!(
        "`{}` against {}; error {}; {configurations} (seed {}) and {} hard.\n\n",
        results.function.replace('`', "'"),
        cell(&results.truth),
        cell(&results.metric),
        results.seed,
        results.hard,
    );
    text += "| row | model RMS | p95 | max | bias | searched | rounding RMS | max | allowed | verdict | executed | at most |\n";
    text += "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    text += &results.rows.iter().map(|row| errors(results, row)).collect::<String>();
    text += &costs_of(&results.rows);
    text
}

fn errors(results: &Results, row: &Row) -> String {
    let model = row.model.as_ref();
    let cells = [
        cell(&row.label),
        optional(model.map(|errors| errors.rms)),
        optional(model.map(|errors| errors.p95)),
        optional(model.map(|errors| errors.max)),
        model.map_or_else(|| optional(None), |errors| signed(errors.bias)),
        optional(model.map(|errors| errors.searched)),
        number(row.rounding_cpu.rms),
        number(row.rounding_cpu.max),
        optional(row.allowed),
        verdict(results, row),
        number(row.executed.mean),
        number(row.executed.max),
    ];
    format!("| {} |\n", cells.join(" | "))
}

/// `ok`, or what happened how often. What the device did is no part of it.
fn verdict(results: &Results, row: &Row) -> String {
    let on_cpu = Row {
        rounding: None,
        ..row.clone()
    };
    let faults = of_row(results, &on_cpu);
    let parts: Vec<String> = faults
        .iter()
        .map(|fault| match fault.count {
            0 => format!("**{}**", fault.kind.name()),
            count => format!("**{count} {}**", fault.kind.name()),
        })
        .collect();
    if parts.is_empty() { "ok".to_owned() } else { parts.join(", ") }
}

/// What the linked programs hold: a column for each kind that one of the rows has.
fn costs_of(rows: &[Row]) -> String {
    let names = costs(&Cost::default()).map(|(name, _)| name);
    let counts: Vec<_> = rows.iter().map(|row| costs(&row.cost).map(|(_, count)| count)).collect();
    let used: Vec<usize> = (0..names.len()).filter(|kind| counts.iter().any(|row| row[*kind] > 0)).collect();
    if used.is_empty() {
        return String::new();
    }
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let header = used.iter().map(|kind| names[*kind].replace('_', " "));
    let mut text = format!("\n{}", line(std::iter::once("row".to_owned()).chain(header).collect()));
    text += &format!("|{}\n", "---|".repeat(used.len() + 1));
    for (row, counts) in rows.iter().zip(&counts) {
        let cells = used.iter().map(|kind| counts[*kind].to_string());
        text += &line(std::iter::once(cell(&row.label)).chain(cells).collect());
    }
    text
}

/// A text that stays in its cell, and says only what it says: no HTML, no links, no emphasis.
pub(super) fn cell(text: &str) -> String {
    let mut safe = String::new();
    for letter in clean(text).chars() {
        if matches!(letter, '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#' | '&') {
            safe.push('\\');
        }
        safe.push(letter);
    }
    safe.trim().to_owned()
}
