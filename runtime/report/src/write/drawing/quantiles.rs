//! The errors of all configurations, each row's in its own order from small to large.

use super::axis::Axis;
use super::colour::Colour;
use super::{Anchor, Drawing, Mark, chart};
use crate::data::{Results, Samples};
use crate::write::WriteError;
use crate::write::text::short;

const WIDTH: u32 = 560;
const HEIGHT: u32 = 440;
/// Left, top, right and bottom of the plot's area; names stand to the right of it.
const AREA: [f64; 4] = [62.0, 62.0, 400.0, 372.0];
const TEXT: f64 = 12.0;
/// Least distance of two names.
const PITCH: f64 = 16.0;

/// What it shows.
pub fn caption(results: &Results, samples: &Samples) -> String {
    format!(
        "Error of each of {} configurations, {}, from small to large: how large it is for which share of them.",
        samples.inputs.len(),
        results.metric
    )
}

/// A line for each row, from the share of configurations, 0 to 1, to the error that so many do not exceed.
///
/// # Errors
/// The font cannot be read.
pub fn draw(results: &Results, samples: &Samples) -> Result<Drawing, WriteError> {
    let [left, top, right, bottom] = AREA;
    let sorted = |errors: &[Option<f64>]| {
        // What is no number is larger than all.
        let mut sizes: Vec<f64> = errors.iter().map(|size| size.unwrap_or(f64::INFINITY)).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    };
    let lines: Vec<(&str, Vec<f64>)> = samples
        .errors
        .iter()
        .map(|(label, errors)| (label.as_str(), sorted(errors)))
        .collect();
    let up = Axis::new(lines.iter().flat_map(|(_, sizes)| sizes.iter().copied()), bottom, top);
    let mut marks = Vec::new();
    for share in 0..=4_u8 {
        let x = left + (right - left) * f64::from(share) / 4.0;
        marks.push(chart::line([x, top], [x, bottom], Colour::Grid, 1.0));
        marks.push(chart::text(
            [x, bottom + 13.0],
            format!("{} %", 25 * share),
            TEXT,
            Colour::Faint,
            Anchor::Middle,
        ));
    }
    chart::upright(&mut marks, &up, AREA);
    marks.push(chart::text(
        [10.0, 16.0],
        short(&format!("{}: all errors", results.name), 68),
        15.0,
        Colour::Ink,
        Anchor::Start,
    ));
    marks.push(chart::text(
        [10.0, 42.0],
        short(&format!("error of the result, {}", results.metric), 78),
        TEXT,
        Colour::Faint,
        Anchor::Start,
    ));
    marks.push(chart::text(
        [right, bottom + 33.0],
        "share of the configurations",
        TEXT,
        Colour::Faint,
        Anchor::End,
    ));

    let mut ends: Vec<(f64, &str)> = Vec::new();
    for (label, sizes) in &lines {
        let last = sizes.len().saturating_sub(1).max(1) as f64;
        let at = |(index, size): (usize, &f64)| Some([left + (right - left) * index as f64 / last, up.place(*size)?]);
        let points: Vec<[f64; 2]> = sizes.iter().enumerate().filter_map(at).collect();
        let Some(end) = points.last() else { continue };
        ends.push((end[1], label));
        let colour = if *label == results.baseline {
            Colour::Ink
        } else {
            Colour::Frontier
        };
        marks.push(Mark::Line {
            points,
            colour,
            width: 1.5,
        });
    }
    // The largest error first, and each name below the one before.
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut below = top;
    let room = ends.len().saturating_sub(1) as f64 * PITCH;
    for (index, (end, label)) in ends.iter().enumerate() {
        let y = end.max(below).min(bottom - room + index as f64 * PITCH);
        below = y + PITCH;
        marks.push(chart::line([right + 1.0, *end], [right + 14.0, y], Colour::Dominated, 1.0));
        marks.push(chart::text([right + 17.0, y], short(label, 22), TEXT, Colour::Ink, Anchor::Start));
    }
    Ok(Drawing {
        width: WIDTH,
        height: HEIGHT,
        description: caption(results, samples),
        marks,
        ..Drawing::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches errors that are drawn in the order of the configurations, one that is no number and is left out, and names over each other.
    #[test]
    fn lines_rise_and_names_are_apart() {
        let samples = Samples {
            inputs: vec![serde_json::Value::Null; 3],
            errors: [
                ("a", [Some(0.3), Some(0.1), None]),
                ("b", [Some(0.2), Some(0.1), None]),
                ("c", [Some(0.0), Some(1e-3), Some(1e-2)]),
            ]
            .map(|(label, errors)| (label.to_owned(), errors.to_vec()))
            .into(),
        };
        let drawing = draw(&Results::default(), &samples).unwrap();
        let lines: Vec<&Vec<[f64; 2]>> = drawing
            .marks
            .iter()
            .filter_map(|mark| match mark {
                Mark::Line {
                    points,
                    colour: Colour::Frontier,
                    ..
                } => Some(points),
                _ => None,
            })
            .collect();
        assert_eq!(lines.len(), 3);
        for points in lines {
            assert_eq!(points.len(), 3);
            assert!(points.is_sorted_by(|a, b| a[0] < b[0] && a[1] >= b[1]), "{points:?}");
        }
        let names: Vec<f64> = drawing
            .marks
            .iter()
            .filter_map(|mark| match mark {
                Mark::Text { at, text, .. } if ["a", "b", "c"].contains(&text.as_str()) => Some(at[1]),
                _ => None,
            })
            .collect();
        assert!(
            names.len() == 3 && names.windows(2).all(|pair| pair[1] - pair[0] >= PITCH - 1e-9),
            "{names:?}"
        );
    }
}
