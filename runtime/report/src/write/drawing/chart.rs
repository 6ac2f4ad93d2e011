//! The plot of [`super::pareto`]: logarithmic axes, points, the frontier, and names that cover none of them.

use super::axis::Axis;
use super::colour::Colour;
use super::label::{Named, nearest, place};
use super::paint::width;
use super::pareto::{Plot, Point};
use super::{Anchor, Drawing, Mark, Target};
use crate::write::WriteError;
use crate::write::text::short;

const WIDTH: u32 = 560;
const HEIGHT: u32 = 440;
/// The area of the axes: left, top, right, bottom.
const AREA: [f64; 4] = [62.0, 62.0, 546.0, 372.0];
/// Size of text.
const TEXT: f64 = 13.5;
const SMALL: f64 = 12.0;
/// Letters of a name.
const LETTERS: usize = 26;
/// Radius of a point.
const RADIUS: f64 = 5.5;

/// # Errors
/// The font is missing.
pub fn draw(plot: &Plot) -> Result<Drawing, WriteError> {
    let points: Vec<&Point> = plot.points.iter().filter(|point| point.has_place()).collect();
    let [left, top, right, bottom] = AREA;
    let across = Axis::new(points.iter().map(|point| point.cost), left, right);
    let up = Axis::new(points.iter().map(|point| point.error), bottom, top);
    let mut drawing = Drawing {
        width: WIDTH,
        height: HEIGHT,
        description: plot.caption(),
        ..Drawing::default()
    };
    let at = |point: &Point| across.place(point.cost).zip(up.place(point.error)).map(|(x, y)| [x, y]);
    // In the order of cost, so that marks and names do not depend on the rows' order more than they must.
    let mut placed: Vec<([f64; 2], &Point)> = points.into_iter().filter_map(|point| Some((at(point)?, point))).collect();
    placed.sort_by(|a, b| {
        (a.1.dominated, a.0[0], a.0[1])
            .partial_cmp(&(b.1.dominated, b.0[0], b.0[1]))
            .unwrap_or(std::cmp::Ordering::Equal)
    });

    axes(&mut drawing.marks, plot, &across, &up);
    let frontier = if plot.has_frontier { frontier(&placed) } else { Vec::new() };
    if !frontier.is_empty() {
        drawing.marks.push(Mark::Line {
            points: frontier.clone(),
            colour: Colour::Frontier,
            width: 1.5,
        });
    }
    names(&mut drawing.marks, &placed, &frontier, [&across, &up])?;
    // The dominated ones under the others.
    for (centre, point) in placed.iter().rev() {
        dot(&mut drawing.marks, *centre, point);
        drawing.targets.push(Target {
            at: *centre,
            name: point.name(&plot.error),
        });
    }
    legend(&mut drawing.marks, plot, &placed)?;
    Ok(drawing)
}

pub fn text(at: [f64; 2], text: impl Into<String>, size: f64, colour: Colour, anchor: Anchor) -> Mark {
    Mark::Text {
        at,
        text: text.into(),
        size,
        colour,
        anchor,
        turned: false,
    }
}

pub fn line(from: [f64; 2], to: [f64; 2], colour: Colour, width: f64) -> Mark {
    Mark::Line {
        points: vec![from, to],
        colour,
        width,
    }
}

fn axes(marks: &mut Vec<Mark>, plot: &Plot, across: &Axis, up: &Axis) {
    let [left, top, right, bottom] = AREA;
    // A line of the grid where there is a label, a short mark where there is none.
    for tick in across.ticks() {
        let (from, colour) = if tick.label.is_some() {
            (top, Colour::Grid)
        } else {
            (bottom - 4.0, Colour::Axis)
        };
        marks.push(line([tick.at, from], [tick.at, bottom], colour, 1.0));
        marks.extend(
            tick.label
                .map(|label| text([tick.at, bottom + 13.0], label, SMALL, Colour::Faint, Anchor::Middle)),
        );
    }
    for tick in up.ticks() {
        let (to, colour) = if tick.label.is_some() {
            (right, Colour::Grid)
        } else {
            (left + 4.0, Colour::Axis)
        };
        marks.push(line([left, tick.at], [to, tick.at], colour, 1.0));
        marks.extend(
            tick.label
                .map(|label| text([left - 7.0, tick.at], label, SMALL, Colour::Faint, Anchor::End)),
        );
    }
    // The strips of what has no logarithm, cut off by a double line.
    for side in [-1.5, 1.5] {
        marks.extend(across.cuts().map(|x| line([x + side, top], [x + side, bottom], Colour::Axis, 1.0)));
        marks.extend(up.cuts().map(|y| line([left, y + side], [right, y + side], Colour::Axis, 1.0)));
    }
    for (x, label) in [(across.zero, "0"), (across.infinite, "∞")] {
        marks.extend(x.map(|x| text([x, bottom + 13.0], label, SMALL, Colour::Ink, Anchor::Middle)));
    }
    upright(marks, up, AREA);
    marks.push(text([10.0, 16.0], short(&plot.title, 68), 15.0, Colour::Ink, Anchor::Start));
    marks.push(text([10.0, 42.0], short(&plot.error, 78), TEXT, Colour::Faint, Anchor::Start));
    marks.push(text(
        [right, bottom + 33.0],
        "cost: weighted operations executed, mean",
        TEXT,
        Colour::Faint,
        Anchor::End,
    ));
}

/// The axis of errors at the left of an area, with its ticks, and the area's own two lines.
pub fn upright(marks: &mut Vec<Mark>, up: &Axis, [left, top, right, bottom]: [f64; 4]) {
    for tick in up.ticks() {
        let (to, colour) = if tick.label.is_some() {
            (right, Colour::Grid)
        } else {
            (left + 4.0, Colour::Axis)
        };
        marks.push(line([left, tick.at], [to, tick.at], colour, 1.0));
        marks.extend(
            tick.label
                .map(|label| text([left - 7.0, tick.at], label, SMALL, Colour::Faint, Anchor::End)),
        );
    }
    for side in [-1.5, 1.5] {
        marks.extend(up.cuts().map(|y| line([left, y + side], [right, y + side], Colour::Axis, 1.0)));
    }
    for (y, label) in [(up.zero, "0"), (up.infinite, "∞")] {
        marks.extend(y.map(|y| text([left - 7.0, y], label, SMALL, Colour::Ink, Anchor::End)));
    }
    marks.push(Mark::Line {
        points: vec![[left, top], [left, bottom], [right, bottom]],
        colour: Colour::Axis,
        width: 1.25,
    });
}

/// The border of what some row dominates: a staircase through the rows that none does, from the cheapest.
fn frontier(placed: &[([f64; 2], &Point)]) -> Vec<[f64; 2]> {
    let [_, top, right, _] = AREA;
    let mut steps: Vec<[f64; 2]> = Vec::new();
    // Sorted by cost, and what dominates nothing more last.
    for (at, _) in placed.iter().filter(|(_, point)| !point.dominated) {
        let above = steps.last().map_or(top, |last| last[1]);
        steps.push([at[0], above]);
        steps.push(*at);
    }
    if let Some(last) = steps.last().copied() {
        steps.push([right, last[1]]);
    }
    steps
}

fn names(marks: &mut Vec<Mark>, placed: &[([f64; 2], &Point)], frontier: &[[f64; 2]], [across, up]: [&Axis; 2]) -> Result<(), WriteError> {
    let labels: Vec<String> = placed.iter().map(|(_, point)| short(&point.label, LETTERS)).collect();
    let mut named = Vec::new();
    for ((at, _), label) in placed.iter().zip(&labels) {
        named.push(Named {
            at: *at,
            size: [width(label, TEXT)?, TEXT],
        });
    }
    let [left, top, right, bottom] = AREA;
    let mut lines: Vec<[[f64; 2]; 2]> = frontier.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    lines.extend(across.cuts().map(|x| [[x, top], [x, bottom]]));
    lines.extend(up.cuts().map(|y| [[left, y], [right, y]]));
    let places = place(&named, &lines, [left + 3.0, top, right + 6.0, bottom - 2.0]);
    for (((at, point), label), space) in placed.iter().zip(labels).zip(&places) {
        let Some(space) = space else { continue };
        let from = nearest(*space, *at);
        let away = [from[0] - at[0], from[1] - at[1]];
        let distance = away[0].hypot(away[1]);
        if distance > RADIUS + 12.0 {
            let edge = [
                at[0] + away[0] / distance * (RADIUS + 2.0),
                at[1] + away[1] / distance * (RADIUS + 2.0),
            ];
            marks.push(line(edge, from, Colour::Dominated, 1.0));
        }
        let colour = if point.dominated { Colour::Faint } else { Colour::Ink };
        marks.push(text([space[0], (space[1] + space[3]) / 2.0], label, TEXT, colour, Anchor::Start));
    }
    let missing = places.iter().filter(|place| place.is_none()).count();
    if missing > 0 {
        let note = format!("{missing} without a name: no room");
        marks.push(text([right, top - 8.0], note, SMALL, Colour::Faint, Anchor::End));
    }
    Ok(())
}

fn dot(marks: &mut Vec<Mark>, centre: [f64; 2], point: &Point) {
    let colour = if point.dominated { Colour::Dominated } else { Colour::Frontier };
    let radius = RADIUS;
    // Paper around it, so that points over each other stay two.
    marks.push(Mark::Disc {
        centre,
        radius: radius + 1.25,
        colour: Colour::Paper,
    });
    marks.push(Mark::Disc { centre, radius, colour });
    if point.truth {
        marks.push(Mark::Disc {
            centre,
            radius: radius - 2.0,
            colour: Colour::Paper,
        });
    }
    if point.faulty {
        marks.push(Mark::Ring {
            centre,
            radius: radius + 3.0,
            colour: Colour::Fault,
            width: 1.75,
        });
    }
}

/// What the marks mean, of those that there are.
fn legend(marks: &mut Vec<Mark>, plot: &Plot, placed: &[([f64; 2], &Point)]) -> Result<(), WriteError> {
    let plain = Point {
        label: String::new(),
        cost: 0.0,
        error: 0.0,
        dominated: false,
        faulty: false,
        truth: false,
    };
    let has = |of: fn(&Point) -> bool| placed.iter().any(|(_, point)| of(point));
    let grey = Point {
        dominated: true,
        ..plain.clone()
    };
    let entries = [
        (
            has(|point| !point.dominated),
            plain.clone(),
            if plot.has_frontier { "on the frontier" } else { "not dominated" },
        ),
        (has(|point| point.dominated), grey, "dominated"),
        (
            has(|point| point.truth),
            Point {
                truth: true,
                ..plain.clone()
            },
            "the truth itself",
        ),
        (has(|point| point.faulty), Point { faulty: true, ..plain }, "with faults"),
    ];
    let mut x = AREA[0] + 6.0;
    let y = f64::from(HEIGHT) - 14.0;
    for (_, point, meaning) in entries.into_iter().filter(|(is_there, ..)| *is_there) {
        dot(marks, [x, y], &point);
        marks.push(text([x + 13.0, y], meaning, SMALL, Colour::Faint, Anchor::Start));
        x += 13.0 + width(meaning, SMALL)? + 24.0;
    }
    Ok(())
}
