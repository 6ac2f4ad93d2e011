//! Where on a plane of its inputs a module errs: a heat map of the error's decimal logarithm.

use super::axis::{every, label};
use super::colour::{Colour, NOT_FINITE, ZERO, viridis};
use super::paint::DENSITY;
use super::{Anchor, Drawing, Mark, Raster, Target};
use crate::data::{Picture, Row};
use crate::write::WriteError;
use crate::write::number::number;
use crate::write::text::short;

const WIDTH: u32 = 412;
const HEIGHT: u32 = 388;
/// Upper left corner of the map.
const CORNER: [f64; 2] = [34.0, 36.0];
/// Its side.
const SIDE: f64 = 288.0;
/// Distance of the scale's bar from the map, its width, and cells in it.
const BAR: [f64; 2] = [18.0, 14.0];
const BAR_CELLS: u32 = 144;
/// Decades that the scale shows below the largest error. What is less is drawn as its lower end.
const DECADES: f64 = 12.0;
const TEXT: f64 = 13.5;
const SMALL: f64 = 12.0;

/// The range of the scale, as decimal logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scale {
    low: f64,
    high: f64,
    /// There are smaller errors than its lower end.
    cut: bool,
}

impl Scale {
    /// None where all errors are 0.
    fn of(errors: &[Option<f64>]) -> Option<Scale> {
        let logs = || {
            errors
                .iter()
                .flatten()
                .filter(|error| **error > 0.0 && error.is_finite())
                .map(|error| error.log10())
        };
        let high = logs().reduce(f64::max)?;
        let least = logs().fold(high, f64::min);
        // A hundredth of a decade, lest equal errors have a scale of no length.
        let low = least.max(high - DECADES).min(high - 0.01);
        Some(Scale {
            low,
            high,
            cut: least < low,
        })
    }

    fn colour(self, error: f64) -> [u8; 3] {
        viridis((error.log10() - self.low) / (self.high - self.low))
    }

    /// Marks on the bar: a part of its length from below, and what it says.
    fn marks(self) -> Vec<(f64, String)> {
        let part = |log: f64| (log - self.low) / (self.high - self.low);
        let end = |log: f64| number(10.0_f64.powf(log));
        let cut = if self.cut { "≤ " } else { "" };
        let mut marks = vec![(0.0, format!("{cut}{}", end(self.low))), (1.0, end(self.high))];
        let every = every(self.high - self.low, 6.0);
        let decades = (self.low.ceil() as i32..=self.high.floor() as i32).filter(|decade| decade % every == 0);
        // The ends need their room.
        marks.extend(
            decades
                .map(|decade| (part(f64::from(decade)), label(1, decade)))
                .filter(|(at, _)| (0.07..=0.93).contains(at)),
        );
        marks
    }
}

/// # Errors
/// There are not as many errors as cells, or none.
pub fn draw(experiment: &str, row: &Row, picture: &Picture) -> Result<Drawing, WriteError> {
    let (width, height, found) = (picture.width, picture.height, picture.errors.len());
    let wrong = || WriteError::Picture {
        experiment: experiment.to_owned(),
        row: row.label.clone(),
        width,
        height,
        found,
    };
    if found == 0 || width.checked_mul(height) != Some(found) {
        return Err(wrong());
    }
    let columns = u32::try_from(width).map_err(|_| wrong())?;
    let scale = Scale::of(&picture.errors);
    let colour = |error: &Option<f64>| match error {
        Some(0.0) => ZERO,
        Some(error) if error.is_finite() => scale.map_or(ZERO, |scale| scale.colour(*error)),
        _ => NOT_FINITE,
    };
    // Cells are whole pixels of the PNG where they are large enough, so that all are equally large.
    let whole = |cell: f64| (cell * f64::from(DENSITY)).floor() / f64::from(DENSITY);
    let cell = [width, height]
        .map(|cells| SIDE / cells as f64)
        .map(|cell| if cell >= 2.0 { whole(cell) } else { cell });
    let size = [cell[0] * width as f64, cell[1] * height as f64];
    let mut drawing = Drawing {
        width: WIDTH,
        height: HEIGHT,
        description: description(row, picture),
        ..Drawing::default()
    };
    drawing.rasters.push(Raster {
        at: CORNER,
        cell,
        columns,
        pixels: picture.errors.iter().map(colour).collect(),
    });
    names(&mut drawing.marks, row, picture, size);
    if let Some(scale) = scale {
        bar(&mut drawing, scale, size);
    }
    legend(&mut drawing, picture, scale);
    mark(&mut drawing, picture, cell, size);
    Ok(drawing)
}

fn description(row: &Row, picture: &Picture) -> String {
    let largest = picture.errors.iter().flatten().copied().fold(0.0, f64::max);
    format!(
        "Heat map of the {} error of {}: {} across, {} up; the largest error in it is {}.",
        picture.of,
        row.label,
        picture.axes[0],
        picture.axes[1],
        number(largest)
    )
}

fn text(at: [f64; 2], text: impl Into<String>, size: f64, colour: Colour, anchor: Anchor) -> Mark {
    Mark::Text {
        at,
        text: text.into(),
        size,
        colour,
        anchor,
        turned: false,
    }
}

fn names(marks: &mut Vec<Mark>, row: &Row, picture: &Picture, size: [f64; 2]) {
    let [left, top] = CORNER;
    marks.push(text(
        [left, 16.0],
        short(&format!("{}: {} error", row.label, picture.of), 44),
        15.0,
        Colour::Ink,
        Anchor::Start,
    ));
    let [across, up] = picture.axes.each_ref().map(|axis| short(axis, 42));
    marks.push(text(
        [left + size[0] / 2.0, top + size[1] + 14.0],
        across,
        TEXT,
        Colour::Faint,
        Anchor::Middle,
    ));
    marks.push(Mark::Text {
        at: [left - 14.0, top + size[1] / 2.0],
        text: up,
        size: TEXT,
        colour: Colour::Faint,
        anchor: Anchor::Middle,
        turned: true,
    });
}

fn bar(drawing: &mut Drawing, scale: Scale, [width, height]: [f64; 2]) {
    let left = CORNER[0] + width + BAR[0];
    let right = left + BAR[1];
    let cell = height / f64::from(BAR_CELLS);
    let step = |index: u32| 1.0 - (f64::from(index) + 0.5) / f64::from(BAR_CELLS);
    drawing.rasters.push(Raster {
        at: [left, CORNER[1]],
        cell: [BAR[1], cell],
        columns: 1,
        pixels: (0..BAR_CELLS).map(|index| viridis(step(index))).collect(),
    });
    for (part, label) in scale.marks() {
        // The labels at the ends stay beside the bar.
        let y = CORNER[1] + height * (1.0 - part);
        let middle = y.clamp(CORNER[1] + 5.0, CORNER[1] + height - 5.0);
        drawing.marks.push(Mark::Line {
            points: vec![[right, y], [right + 3.0, y]],
            colour: Colour::Axis,
            width: 1.0,
        });
        drawing
            .marks
            .push(text([right + 6.0, middle], label, SMALL, Colour::Faint, Anchor::Start));
    }
}

/// What is not on the scale, of what there is.
fn legend(drawing: &mut Drawing, picture: &Picture, scale: Option<Scale>) {
    let y = f64::from(HEIGHT) - 16.0;
    let mut x = CORNER[0];
    let not_finite = picture
        .errors
        .iter()
        .filter(|error| error.is_none_or(|error| !error.is_finite()))
        .count();
    let zero = picture.errors.iter().filter(|error| **error == Some(0.0)).count();
    let all = if scale.is_none() && not_finite == 0 {
        "error is 0 everywhere"
    } else {
        "error is 0"
    };
    for (count, colour, meaning, room) in [(zero, ZERO, all, 100.0), (not_finite, NOT_FINITE, "not finite", 0.0)] {
        if count > 0 {
            drawing.rasters.push(Raster {
                at: [x, y - 6.0],
                cell: [12.0, 12.0],
                columns: 1,
                pixels: vec![colour],
            });
            // Black is seen on a dark page too.
            let [right, low] = [x + 12.0, y + 6.0];
            drawing.marks.push(Mark::Line {
                points: vec![[x, y - 6.0], [right, y - 6.0], [right, low], [x, low], [x, y - 6.0]],
                colour: Colour::Axis,
                width: 1.0,
            });
            drawing
                .marks
                .push(text([x + 18.0, y], meaning, SMALL, Colour::Faint, Anchor::Start));
            x += 18.0 + room;
        }
    }
}

/// A ring around the worst input, seen on any colour; nothing where it lies outside the plane.
fn mark(drawing: &mut Drawing, picture: &Picture, cell: [f64; 2], size: [f64; 2]) {
    let at: [f64; 2] = std::array::from_fn(|axis| (picture.worst[axis] + 0.5) * cell[axis]);
    if !(0..2).all(|axis| (0.0..=size[axis]).contains(&at[axis])) {
        return;
    }
    let centre = [CORNER[0] + at[0], CORNER[1] + at[1]];
    for (radius, colour, width) in [(9.0, Colour::Dark, 4.0), (9.0, Colour::Light, 1.75)] {
        drawing.marks.push(Mark::Ring {
            centre,
            radius,
            colour,
            width,
        });
    }
    drawing.targets.push(Target {
        at: centre,
        name: "the worst input".to_owned(),
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a scale that a single tiny error stretches until nothing else can be told apart, and one of no length.
    #[test]
    fn scales_fit_their_errors() {
        let of = |errors: &[f64]| Scale::of(&errors.iter().map(|error| Some(*error)).collect::<Vec<_>>());
        assert_eq!(of(&[0.0, 0.0]), None);
        assert_eq!(of(&[f64::INFINITY]), None);
        let scale = of(&[1e-300, 1e-3, 1.0]).expect("a scale");
        assert_eq!((scale.low, scale.high, scale.cut), (-12.0, 0.0, true));
        assert_eq!(scale.marks()[0], (0.0, "≤ 1.00e-12".to_owned()));
        let scale = of(&[0.01, 0.01]).expect("a scale");
        assert_eq!(scale.colour(0.01), viridis(1.0));
        let labels: Vec<String> = of(&[1e-4, 0.5])
            .expect("a scale")
            .marks()
            .into_iter()
            .map(|(_, label)| label)
            .collect();
        assert_eq!(labels, ["1.00e-4", "0.500", "0.001", "0.01", "0.1"]);
    }
}
