//! `report.html`: one page that needs nothing else, filled into `page.html`.

mod doc;
mod table;

use minijinja::{Environment, Value};
use serde::Serialize;

use self::table::Table;
use super::WriteError;
use super::drawing::Figures;
use super::drawing::colour::Colour;
use super::faults::{self, Fault, Kind, faults};
use super::number::{count, number};
use super::text::{happened, value};
use crate::data::{Agreement, Errors, Fits, Report, Results, Row, Worst};

/// The template. It is well-formed XML as well as HTML, and so is the page.
const TEMPLATE: &str = include_str!("page.html");

/// All that the template says.
#[derive(Serialize)]
struct Page<'a> {
    report: &'a Report,
    /// Roles of colours: hexadecimal, and the variable.
    colours: Vec<(String, &'static str)>,
    faults: Vec<FaultLine>,
    overview: Table,
    sections: Vec<Section<'a>>,
    fits: Vec<FitSection<'a>>,
    agreement: Option<Table>,
    /// Largest differences of functions without a fault.
    closest: Vec<FaultLine>,
    without: Vec<(&'a String, &'a String)>,
}

/// Best fits to one table.
#[derive(Serialize)]
struct FitSection<'a> {
    fits: &'a Fits,
    table: Table,
}

#[derive(Serialize)]
struct Section<'a> {
    results: &'a Results,
    anchor: &'a str,
    doc: Value,
    sampling: String,
    plots: Vec<Plot<'a>>,
    errors: Table,
    costs: Table,
    alternatives: Vec<Alternative<'a>>,
    pictures: Vec<PictureView>,
}

#[derive(Serialize)]
struct Plot<'a> {
    svg: Value,
    caption: &'a str,
}

#[derive(Serialize)]
struct Alternative<'a> {
    label: &'a str,
    summary: &'a str,
    recipe: &'a str,
    worsts: Vec<WorstLine>,
}

/// A worst input for people: what it is the worst of, what came of it, how to see it again.
#[derive(Serialize)]
struct WorstLine {
    of: &'static str,
    error: String,
    happened: String,
    command: Option<String>,
}

#[derive(Serialize)]
struct PictureView {
    svg: Value,
    label: String,
    worst: Option<WorstLine>,
}

#[derive(Serialize)]
struct FaultLine {
    kind: &'static str,
    what: &'static str,
    place: String,
    /// Of the place in the page.
    anchor: String,
    row: Option<String>,
    function: String,
    times: String,
    component: String,
    got: Option<String>,
    expected: Option<String>,
    command: Option<String>,
}

/// Fills the page.
///
/// # Errors
/// The template has a mistake.
pub fn page(report: &Report, figures: &[Figures]) -> Result<String, WriteError> {
    let mut environment = Environment::new();
    environment.set_trim_blocks(true);
    environment.set_lstrip_blocks(true);
    environment.add_template("page.html", TEMPLATE)?;
    let faults = faults(report);
    let anchor = |fault: &Fault<'_>| match fault.row {
        None => "agreement".to_owned(),
        Some(_) => {
            let found = report
                .experiments
                .iter()
                .zip(figures)
                .find(|(results, _)| results.name == fault.place);
            found.map(|(_, figures)| format!("x-{}", figures.name)).unwrap_or_default()
        }
    };
    let page = Page {
        report,
        colours: Colour::THEMED.iter().map(|colour| (colour.hex(), colour.variable())).collect(),
        faults: faults.iter().map(|fault| fault_line(fault, anchor(fault))).collect(),
        overview: table::overview(report, figures),
        sections: report
            .experiments
            .iter()
            .zip(figures)
            .map(|(results, figures)| section(results, figures))
            .collect(),
        fits: report
            .fits
            .iter()
            .map(|fits| FitSection {
                fits,
                table: table::fits(fits),
            })
            .collect(),
        agreement: (!report.agreement.is_empty()).then(|| table::agreement(&report.agreement)),
        closest: report.agreement.iter().filter_map(closest_line).collect(),
        without: report.without.iter().collect(),
    };
    let text = environment.get_template("page.html")?.render(&page)?;
    // Of the control characters XML allows line breaks and tabs alone.
    let legal = |letter: char| {
        if letter.is_control() && !matches!(letter, '\n' | '\t') {
            char::REPLACEMENT_CHARACTER
        } else {
            letter
        }
    };
    Ok(text.chars().map(legal).collect())
}

fn section<'a>(results: &'a Results, figures: &'a Figures) -> Section<'a> {
    let plots = figures.plots.iter().zip(&figures.captions).map(|(figure, caption)| Plot {
        svg: Value::from_safe_string(figure.svg.clone()),
        caption,
    });
    let pictured = results.rows.iter().filter(|row| row.picture.is_some());
    Section {
        results,
        anchor: &figures.name,
        doc: Value::from_safe_string(doc::html(&results.doc)),
        sampling: format!(
            "{} sampled with seed {}, and {} hard",
            count(results.configurations, "configuration"),
            results.seed,
            results.hard
        ),
        plots: plots.collect(),
        errors: table::errors(results),
        costs: table::costs(results),
        alternatives: results.rows.iter().map(|row| alternative(results, row)).collect(),
        pictures: pictured
            .zip(&figures.pictures)
            .map(|(row, figure)| picture(results, row, figure.svg.clone()))
            .collect(),
    }
}

fn alternative<'a>(results: &Results, row: &'a Row) -> Alternative<'a> {
    let all = [
        ("model error", row.model.as_ref()),
        ("rounding error on the device", row.rounding.as_ref()),
        ("rounding error of the evaluator", Some(&row.rounding_cpu)),
    ];
    let worsts = all
        .into_iter()
        .filter_map(|(of, errors)| errors.map(|errors| worst_line(results, row, of, errors)));
    Alternative {
        label: &row.label,
        summary: &row.summary,
        recipe: &row.recipe,
        worsts: worsts.filter(|line| line.command.is_some()).collect(),
    }
}

fn worst_line(results: &Results, row: &Row, of: &'static str, errors: &Errors) -> WorstLine {
    WorstLine {
        of,
        error: number(errors.searched),
        happened: happened(&errors.worst),
        command: faults::command(&row.recipe, &results.function, &errors.worst),
    }
}

fn picture(results: &Results, row: &Row, svg: String) -> PictureView {
    let of_model = row.picture.as_ref().is_some_and(|picture| picture.of == "model");
    let (of, errors) = match (&row.model, &row.rounding) {
        (Some(model), _) if of_model => ("model error", model),
        (_, Some(device)) => ("rounding error on the device", device),
        _ => ("rounding error of the evaluator", &row.rounding_cpu),
    };
    let line = worst_line(results, row, of, errors);
    PictureView {
        svg: Value::from_safe_string(svg),
        label: row.label.clone(),
        worst: line.command.is_some().then_some(line),
    }
}

/// What a kind of fault means.
fn meaning(kind: Kind) -> &'static str {
    match kind {
        Kind::Nan => "not a number",
        Kind::Infinite => "infinite where it must not be",
        Kind::Outside => "rounded worse than WGSL's accuracy table allows",
        Kind::Discontinuous => "jumps where the truth does not",
        Kind::Negative => "below 0 where the truth is not",
    }
}

fn fault_line(fault: &Fault<'_>, anchor: String) -> FaultLine {
    let what = if fault.row.is_some() { "configuration" } else { "result" };
    let known = |get: fn(&Worst) -> &serde_json::Value| fault.worst.map(get).filter(|found| !found.is_null()).map(value);
    FaultLine {
        kind: fault.kind.name(),
        what: meaning(fault.kind),
        place: fault.place.to_owned(),
        anchor,
        row: fault.row.map(str::to_owned),
        function: fault.function.to_owned(),
        times: match fault.count {
            0 => "in the figures of its error".to_owned(),
            some => format!("{some} of {}", count(fault.of, what)),
        },
        component: fault.worst.map(|worst| worst.component.clone()).unwrap_or_default(),
        got: known(|worst| &worst.got),
        expected: known(|worst| &worst.expected),
        command: fault.command.clone(),
    }
}

/// Where a module's device and evaluator are farthest apart without a fault.
fn closest_line(one: &Agreement) -> Option<FaultLine> {
    let worst = one.worst.as_ref().filter(|_| one.outside == 0)?;
    Some(FaultLine {
        kind: "",
        what: "",
        place: one.module.clone(),
        anchor: String::new(),
        row: None,
        function: one.function.clone(),
        times: format!("{} ulp", number(one.ulps)),
        component: worst.component.clone(),
        got: (!worst.got.is_null()).then(|| value(&worst.got)),
        expected: (!worst.expected.is_null()).then(|| value(&worst.expected)),
        command: faults::command(&one.recipe, &one.function, worst),
    })
}
