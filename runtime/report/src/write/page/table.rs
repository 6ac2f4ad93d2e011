//! The page's tables as cells, ready for the template.

use serde::Serialize;

use crate::data::{Agreement, Cost, Errors, Fits, Report, Results, Row};
use crate::write::drawing::Figures;
use crate::write::faults::of_row;
use crate::write::number::{MISSING, count, number, optional, signed};
use crate::write::tables;
use crate::write::text::{parameters, short};

/// A table with a name for each row.
#[derive(Serialize)]
pub struct Table {
    caption: String,
    /// Over the columns: a name and how many columns it spans; an empty name is none.
    groups: Vec<(&'static str, usize)>,
    columns: Vec<Column>,
    lines: Vec<Line>,
}

#[derive(Serialize)]
struct Column {
    name: String,
    /// What it is, where the name is short.
    title: &'static str,
    is_text: bool,
    /// The first of its group.
    starts: bool,
}

#[derive(Serialize)]
struct Line {
    name: String,
    /// Anchor of what it names; empty for none.
    link: String,
    title: String,
    dominated: bool,
    baseline: bool,
    cells: Vec<Cell>,
}

#[derive(Serialize)]
struct Cell {
    text: String,
    /// To sort by; empty where there is no value.
    key: String,
    is_fault: bool,
    is_text: bool,
    /// Two numbers, on one line.
    is_range: bool,
    starts: bool,
}

impl Cell {
    fn text(text: String) -> Cell {
        Cell {
            key: text.clone(),
            text,
            is_fault: false,
            is_text: true,
            is_range: false,
            starts: false,
        }
    }

    fn number(value: f64) -> Cell {
        Cell::shown(number(value), value)
    }

    fn optional(value: Option<f64>) -> Cell {
        value.map_or_else(
            || Cell {
                key: String::new(),
                ..Cell::shown(MISSING.to_owned(), 0.0)
            },
            Cell::number,
        )
    }

    fn shown(text: String, key: f64) -> Cell {
        Cell {
            text,
            // JavaScript's words for what is not finite.
            key: if key.is_finite() {
                format!("{key:?}")
            } else {
                format!("{key}").replace("inf", "Infinity")
            },
            is_fault: !key.is_finite(),
            is_text: false,
            is_range: false,
            starts: false,
        }
    }

    fn count(value: usize) -> Cell {
        Cell::shown(value.to_string(), value as f64)
    }
}

/// Builds a table's columns group by group.
struct Columns(Vec<Column>, Vec<(&'static str, usize)>);

impl Columns {
    fn group(&mut self, name: &'static str, columns: &[(&str, &'static str, bool)]) -> &mut Self {
        if columns.is_empty() {
            return self;
        }
        self.1.push((name, columns.len()));
        for (index, (column, title, is_text)) in columns.iter().enumerate() {
            self.0.push(Column {
                name: (*column).to_owned(),
                title,
                is_text: *is_text,
                starts: index == 0,
            });
        }
        self
    }

    fn table(self, caption: String, mut lines: Vec<Line>) -> Table {
        for line in &mut lines {
            for (cell, column) in line.cells.iter_mut().zip(&self.0) {
                cell.starts = column.starts;
            }
        }
        Table {
            caption,
            groups: self.1,
            columns: self.0,
            lines,
        }
    }
}

fn line(results: &Results, row: &Row, cells: Vec<Cell>) -> Line {
    Line {
        name: row.label.clone(),
        link: String::new(),
        title: row.summary.clone(),
        dominated: row.dominated,
        baseline: row.label == results.baseline,
        cells,
    }
}

/// All experiments.
pub fn overview(report: &Report, figures: &[Figures]) -> Table {
    let mut columns = Columns(Vec::new(), Vec::new());
    columns.group(
        "",
        &[
            ("what", "", true),
            ("rows", "", false),
            ("on the frontier", "Rows that no other beats in model error and cost", false),
            ("model RMS", "Least and largest of the rows", true),
            ("faults", "", false),
        ],
    );
    let lines = report.experiments.iter().zip(figures).map(|(results, figures)| {
        let found: usize = results.rows.iter().map(|row| of_row(results, row).len()).sum();
        let models = || results.rows.iter().filter_map(|row| row.model.as_ref()).map(|errors| errors.rms);
        let range = match (models().reduce(f64::min), models().reduce(f64::max)) {
            (Some(least), Some(most)) if least < most => format!("{} to {}", number(least), number(most)),
            (least, _) => optional(least),
        };
        let mut faults = Cell::count(found);
        faults.is_fault = found > 0;
        let has_place = |row: &&Row| !row.executed.mean.is_nan() && row.model.as_ref().is_none_or(|model| !model.rms.is_nan());
        let frontier = results.rows.iter().filter(|row| !row.dominated).filter(has_place).count();
        Line {
            name: results.name.clone(),
            link: format!("x-{}", figures.name),
            title: String::new(),
            dominated: false,
            baseline: false,
            cells: vec![
                Cell::text(results.title.clone()),
                Cell::count(results.rows.len()),
                Cell::count(frontier),
                Cell::text(range),
                faults,
            ],
        }
    });
    let caption = count(report.experiments.len(), "experiment");
    let lines = lines.collect();
    columns.table(caption, lines)
}

/// Errors and verdicts of one experiment.
pub fn errors(results: &Results) -> Table {
    let mut columns = Columns(Vec::new(), Vec::new());
    columns
        .group(
            "Model error",
            &[
                ("RMS", "Root of the mean square", false),
                ("p95", "Not exceeded by 95 % of the configurations", false),
                ("max", "Largest of the configurations, the hard ones among them", false),
                ("bias", "Mean with its sign: above 0, it is too high", false),
                ("searched", "Largest that a search found", false),
            ],
        )
        .group(
            "Rounding, device",
            &[("RMS", "f32 on the device against double precision", false), ("max", "", false)],
        )
        .group(
            "Rounding, evaluator",
            &[("RMS", "f32 on the CPU, the same everywhere", false), ("max", "", false)],
        )
        .group(
            "WGSL",
            &[("allows", "Error that a driver may make, not exceeded by 95 % of the numbers", false)],
        )
        .group("", &[("verdict", "", true)]);
    let lines = results.rows.iter().map(|row| {
        let model = row.model.as_ref();
        let mut cells: Vec<Cell> = [model.map(|one| one.rms), model.map(|one| one.p95), model.map(|one| one.max)]
            .map(Cell::optional)
            .into();
        cells.push(model.map_or_else(|| Cell::optional(None), |one| Cell::shown(signed(one.bias), one.bias)));
        cells.push(Cell::optional(model.map(|one| one.searched)));
        let two = |errors: Option<&Errors>| [errors.map(|one| one.rms), errors.map(|one| one.max)].map(Cell::optional);
        cells.extend(two(row.rounding.as_ref()));
        cells.extend(two(Some(&row.rounding_cpu)));
        cells.push(Cell::optional(row.allowed));
        cells.push(verdict(results, row));
        line(results, row, cells)
    });
    let caption = format!("Errors of {}: {}", short(&results.name, 80), short(&results.metric, 80));
    let lines = lines.collect();
    columns.table(caption, lines)
}

fn verdict(results: &Results, row: &Row) -> Cell {
    let parts: Vec<String> = of_row(results, row)
        .iter()
        .map(|fault| match fault.count {
            0 => fault.kind.name().to_owned(),
            some => format!("{} {some}", fault.kind.name()),
        })
        .collect();
    let mut cell = Cell::text(if parts.is_empty() { "ok".to_owned() } else { parts.join(", ") });
    cell.is_fault = !parts.is_empty();
    cell
}

/// What the rows of one experiment cost.
pub fn costs(results: &Results) -> Table {
    let counts: Vec<_> = results.rows.iter().map(|row| tables::costs(&row.cost)).collect();
    let names = tables::costs(&Cost::default()).map(|(name, _)| name.replace('_', " "));
    // What no row has would only be wide.
    let used: Vec<usize> = (0..names.len()).filter(|kind| counts.iter().any(|row| row[*kind].1 > 0)).collect();
    let holds: Vec<(&str, &'static str, bool)> = used.iter().map(|kind| (names[*kind].as_str(), "", false)).collect();
    let mut columns = Columns(Vec::new(), Vec::new());
    columns
        .group(
            "One call executes",
            &[
                ("mean", "Weighted operations, mean of the configurations", false),
                ("most", "", false),
                ("loop trips", "Mean", false),
                ("texture reads", "Mean", false),
            ],
        )
        .group(
            "Time on the device",
            &[
                ("ratio", "Median of the ratios to the baseline in one run", false),
                ("p10 to p90", "10 % of the ratios are below and 10 % above", true),
                ("ns a call", "Nanoseconds, inputs' fetch and result's store included", false),
            ],
        )
        .group("The linked program holds", &holds);
    let lines = results.rows.iter().map(|row| {
        let executed = &row.executed;
        let mut cells: Vec<Cell> = [executed.mean, executed.max, executed.trips, executed.texture]
            .map(Cell::number)
            .into();
        cells.push(Cell::optional(row.time.map(|time| time.median)));
        let spread = row.time.map(|time| Cell {
            is_text: true,
            is_range: true,
            ..Cell::shown(format!("{} to {}", number(time.p10), number(time.p90)), time.p10)
        });
        cells.push(spread.unwrap_or_else(|| Cell::optional(None)));
        cells.push(Cell::optional(row.time.map(|time| time.nanoseconds)));
        let counts = tables::costs(&row.cost);
        cells.extend(used.iter().map(|kind| Cell::count(counts[*kind].1 as usize)));
        line(results, row, cells)
    });
    let caption = match results.baseline.as_str() {
        "" => format!("Cost of {}", short(&results.name, 80)),
        baseline => format!("Cost of {}; the time of {} is 1", short(&results.name, 80), short(baseline, 80)),
    };
    let lines = lines.collect();
    columns.table(caption, lines)
}

/// Device against evaluator.
pub fn agreement(all: &[Agreement]) -> Table {
    let mut columns = Columns(Vec::new(), Vec::new());
    columns.group(
        "",
        &[
            ("function", "", true),
            ("results", "Numbers compared", false),
            ("equal", "Bit for bit the same", false),
            ("outside", "Farther off than WGSL allows", false),
            ("undecided", "A branch hangs on a rounding, so anything goes", false),
            (
                "largest, ulp",
                "Largest difference of those inside, in units in the last place",
                false,
            ),
        ],
    );
    let lines = all.iter().map(|one| {
        let mut outside = Cell::count(one.outside);
        outside.is_fault = one.outside > 0;
        let part = one.equal as f64 / one.results.max(1) as f64;
        Line {
            name: one.module.clone(),
            link: String::new(),
            title: String::new(),
            dominated: false,
            baseline: false,
            cells: vec![
                Cell::text(one.function.clone()),
                Cell::count(one.results),
                Cell::shown(percent(part), part),
                outside,
                Cell::count(one.undecided),
                Cell::number(one.ulps),
            ],
        }
    });
    let results: usize = all.iter().map(|one| one.results).sum();
    let caption = format!("{} in {}", count(results, "result"), count(all.len(), "function"));
    let lines = lines.collect();
    columns.table(caption, lines)
}

/// Models' best fits to a table of measured reflectance.
pub fn fits(fits: &Fits) -> Table {
    let mut columns = Columns(Vec::new(), Vec::new());
    columns
        .group(
            "Difference of ln(1 + f cos)",
            &[
                ("RMS", "Root of the mean square over the table's samples", false),
                ("p95", "Not exceeded by 95 % of the samples' channels", false),
                ("max", "", false),
                ("bias", "Mean with its sign: above 0, the model is too high", false),
            ],
        )
        .group("One call executes", &[("mean", "Weighted operations, mean of the samples", false)])
        .group("", &[("best fit", "* is at an end of its range", true)]);
    let lines = fits.rows.iter().map(|row| {
        let errors = &row.errors;
        Line {
            name: row.label.clone(),
            link: String::new(),
            title: row.summary.clone(),
            dominated: row.dominated,
            baseline: false,
            cells: vec![
                Cell::number(errors.rms),
                Cell::number(errors.p95),
                Cell::number(errors.max),
                Cell::shown(signed(errors.bias), errors.bias),
                Cell::number(row.executed.mean),
                Cell::text(parameters(row)),
            ],
        }
    });
    let caption = format!(
        "Best fits to {}: {}; fitted to {}",
        short(&fits.name, 80),
        count(fits.compared, "sample"),
        fits.fitted
    );
    let lines = lines.collect();
    columns.table(caption, lines)
}

/// `99.97 %`; never 100 where some are missing.
fn percent(part: f64) -> String {
    let text = format!("{:.2}", part * 100.0);
    if part < 1.0 && text == "100.00" {
        "99.99 %".to_owned()
    } else {
        format!("{text} %")
    }
}
