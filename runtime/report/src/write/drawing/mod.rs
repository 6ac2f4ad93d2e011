//! Plots and pictures. What is drawn is a list of marks; one painter draws it as SVG and as PNG, so that both show the same.

pub mod axis;
pub mod chart;
pub mod colour;
pub mod label;
pub mod paint;
pub mod pareto;
pub mod picture;
pub mod quantiles;

use colour::Colour;

use super::WriteError;
use super::text::Names;
use crate::data::{Report, Results};

/// Marks on a sheet, back to front. Places are in pixels of 1/96 inch from the upper left corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
    /// What it shows, for those who cannot see it.
    pub description: String,
    /// Under all marks.
    pub rasters: Vec<Raster>,
    /// Back to front.
    pub marks: Vec<Mark>,
    /// Things that say their name where one points at them.
    pub targets: Vec<Target>,
}

/// Something to draw.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A line through points.
    Line { points: Vec<[f64; 2]>, colour: Colour, width: f64 },
    /// A filled circle.
    Disc { centre: [f64; 2], radius: f64, colour: Colour },
    /// A circle's line.
    Ring {
        centre: [f64; 2],
        radius: f64,
        colour: Colour,
        width: f64,
    },
    /// A line of text whose letters without ascenders have their middle at `at`.
    Text {
        at: [f64; 2],
        text: String,
        size: f64,
        colour: Colour,
        anchor: Anchor,
        /// Reads from below to above.
        turned: bool,
    },
}

/// What of a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// A grid of colours, each a rectangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Upper left corner.
    pub at: [f64; 2],
    /// Width and height of a cell.
    pub cell: [f64; 2],
    /// Cells in a row.
    pub columns: u32,
    /// Row by row from the top.
    pub pixels: Vec<[u8; 3]>,
}

/// A place with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    pub at: [f64; 2],
    pub name: String,
}

/// A drawing in both forms.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Path without ending.
    pub name: String,
    pub svg: String,
    pub png: Vec<u8>,
}

/// Figures of one experiment.
#[derive(Clone, Debug, Default)]
pub struct Figures {
    /// Anchor of the experiment in the page: the part of its files' names.
    pub name: String,
    /// Error of the result, then rounding error; none where there are fewer than two rows, since one has nothing to be compared with.
    pub plots: Vec<Figure>,
    /// What the plots say beneath.
    pub captions: Vec<String>,
    /// In the rows' order, of those that have one.
    pub pictures: Vec<Figure>,
}

/// Draws what there is to draw, an item for each experiment.
///
/// # Errors
/// A picture with another number of errors than cells.
pub fn figures(report: &Report) -> Result<Vec<Figures>, WriteError> {
    paint::register_font()?;
    let mut names = Names::default();
    let mut pictures = Names::default();
    let mut all = Vec::new();
    for results in &report.experiments {
        let name = names.give(&results.name);
        all.push(of_experiment(results, name, &mut pictures)?);
    }
    Ok(all)
}

fn of_experiment(results: &Results, name: String, names: &mut Names) -> Result<Figures, WriteError> {
    let mut figures = Figures {
        name,
        ..Figures::default()
    };
    if results.rows.len() >= 2 {
        for (end, plot) in [("error", pareto::of_result(results)), ("rounding", pareto::of_rounding(results))] {
            let path = format!("plots/{}-{end}", figures.name);
            figures.plots.push(paint::figure(path, &chart::draw(&plot)?)?);
            figures.captions.push(plot.caption());
        }
    }
    if let Some(samples) = &results.samples {
        let path = format!("plots/{}-all", figures.name);
        figures.plots.push(paint::figure(path, &quantiles::draw(results, samples)?)?);
        figures.captions.push(quantiles::caption(results, samples));
    }
    for row in &results.rows {
        if let Some(picture) = &row.picture {
            let drawing = picture::draw(&results.name, row, picture)?;
            let path = format!("pictures/{}", names.give(&format!("{} {}", results.name, row.label)));
            figures.pictures.push(paint::figure(path, &drawing)?);
        }
    }
    Ok(figures)
}
