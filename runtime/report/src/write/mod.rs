//! The output of a report: from its data to the bytes of every file, in the order in which this list stands.
//!
//! Nothing here reads a clock, a hash map or the environment: equal data gives equal bytes.

mod difference;
mod faults;
mod markdown;
mod number;
mod proofs;
mod sheet;
mod text;

mod drawing;

mod page;
mod tables;

pub use difference::{Difference, FULL, colour, difference, errors, luminance};
pub use drawing::pareto::dominated;
pub use faults::{Fault, Kind, faults};
pub use markdown::markdown;
pub use number::number;
pub use proofs::proofs;
pub use sheet::{Tile, sheet, sheet_size};
pub use text::{parameters, replay};

use crate::data::Report;

/// A report that cannot be written. All of them are mistakes in the data or in the program, never in the machine.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The picture of a row has another number of errors than cells, or none.
    #[error("{experiment}: the picture of `{row}` should have {width} x {height} errors, not {found}")]
    Picture {
        /// Name of the experiment.
        experiment: String,
        /// Label of the row.
        row: String,
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Errors that there are.
        found: usize,
    },
    /// A plot could not be drawn.
    #[error("a plot cannot be drawn: {0}")]
    Draw(String),
    /// A PNG could not be encoded.
    #[error("a picture cannot be encoded: {0}")]
    Image(#[from] image::ImageError),
    /// The page's template does not fit its values.
    #[error("the page cannot be filled: {0}")]
    Page(#[from] minijinja::Error),
    /// A value has no JSON form.
    #[error("the report has no JSON form: {0}")]
    Json(#[from] serde_json::Error),
    /// The table cannot be written.
    #[error("the table cannot be written: {0}")]
    Csv(#[from] csv::Error),
}

/// All files of a report, relative names (with `/`) and bytes: `report.html`, `report.json`, `rows.csv`, for each experiment
/// of two rows or more `plots/NAME-error` and `plots/NAME-rounding` as `.svg` and `.png`, `plots/NAME-all` where there are all errors, and `pictures/NAME.png` for each row that has a picture.
/// Names are unique, also where letters' case does not count. The caller writes them.
///
/// # Errors
/// A picture whose size is not that of its data, or a mistake in this program.
pub fn files(report: &Report) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let figures = drawing::figures(report)?;
    let mut json = serde_json::to_vec_pretty(report)?;
    json.push(b'\n');
    let mut files = vec![
        ("report.html".to_owned(), page::page(report, &figures)?.into_bytes()),
        ("report.json".to_owned(), json),
        ("rows.csv".to_owned(), tables::rows(report)?),
    ];
    for figure in figures
        .into_iter()
        .flat_map(|figures| figures.plots.into_iter().chain(figures.pictures))
    {
        // The SVG of a picture stands in the page alone: it is a PNG with names around it.
        if figure.name.starts_with("plots/") {
            files.push((format!("{}.svg", figure.name), figure.svg.into_bytes()));
        }
        files.push((format!("{}.png", figure.name), figure.png));
    }
    Ok(files)
}
