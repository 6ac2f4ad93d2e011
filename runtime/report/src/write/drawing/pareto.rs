//! Error against cost: what costs more and errs more than another has no use.

use crate::data::{Results, Row};
use crate::write::faults::of_row;
use crate::write::number::number;

/// An alternative's place.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub(super) label: String,
    pub(super) cost: f64,
    pub(super) error: f64,
    pub(super) dominated: bool,
    pub(super) faulty: bool,
    /// Its error is 0 because it is the truth itself.
    pub(super) truth: bool,
}

/// A plot before it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    pub(super) title: String,
    pub(super) error: String,
    pub(super) points: Vec<Point>,
    /// Dominated rows are so in this plot's errors.
    pub(super) has_frontier: bool,
}

/// For each point, cost first and error second: whether another is no worse in both and better in one. Of equal points none dominates; NaN
/// neither dominates nor is dominated.
pub fn dominated(points: &[[f64; 2]]) -> Vec<bool> {
    let beats = |[cost, error]: [f64; 2], other: [f64; 2]| cost <= other[0] && error <= other[1] && (cost < other[0] || error < other[1]);
    points.iter().map(|one| points.iter().any(|other| beats(*other, *one))).collect()
}

/// Error of the result, RMS. Which rows are dominated stands in the data.
pub fn of_result(results: &Results) -> Plot {
    let points = results.rows.iter().map(|row| Point {
        error: row.error(),
        truth: row.model.is_none(),
        ..point(results, row)
    });
    Plot {
        title: format!("{}: error", results.name),
        error: format!("error of the result, RMS, {}", results.metric),
        points: points.collect(),
        has_frontier: results.comparable,
    }
}

/// The largest rounding error, on the device where there was one, else of the evaluator. Where a row approximates, rounding alone makes
/// none of them useless: a crude formula may round best. Dominated are then the same rows as in the other plot, and there is no frontier.
/// Where none does, rounding and cost decide.
pub fn of_rounding(results: &Results) -> Plot {
    let mut points: Vec<Point> = results.rows.iter().map(|row| point(results, row)).collect();
    let has_frontier = results.comparable && !results.rows.iter().any(Row::is_approximate);
    if has_frontier {
        let places: Vec<[f64; 2]> = points.iter().map(|point| [point.cost, point.error]).collect();
        for (point, dominated) in points.iter_mut().zip(dominated(&places)) {
            point.dominated = dominated;
        }
    }
    Plot {
        title: format!("{}: rounding", results.name),
        error: format!("largest rounding error, {}", results.metric),
        points,
        has_frontier,
    }
}

fn point(results: &Results, row: &Row) -> Point {
    Point {
        label: row.label.clone(),
        cost: row.executed.mean,
        error: row.rounding.as_ref().unwrap_or(&row.rounding_cpu).max,
        dominated: row.dominated,
        faulty: !of_row(results, row).is_empty(),
        truth: false,
    }
}

impl Plot {
    /// What it shows, and which rows have no place in it.
    pub fn caption(&self) -> String {
        let dominated = self.points.iter().filter(|point| point.dominated).count();
        let left = self.points.iter().filter(|point| point.has_place() && !point.dominated).count();
        let mut text = format!("{} against cost. ", capital(&self.error));
        text += &match self.has_frontier {
            true => format!("{left} of {} on the frontier, {dominated} dominated.", self.points.len()),
            false if self.points.iter().any(|point| point.dominated) => {
                "Grey are those that are dominated in the result's error and cost.".to_owned()
            }
            false => "No row makes another one useless here.".to_owned(),
        };
        let nowhere: Vec<&str> = self
            .points
            .iter()
            .filter(|point| !point.has_place())
            .map(|point| point.label.as_str())
            .collect();
        if !nowhere.is_empty() {
            text += &format!(" Not drawn, since an error or a cost is no number: {}.", nowhere.join(", "));
        }
        text
    }
}

impl Point {
    pub(super) fn has_place(&self) -> bool {
        self.cost >= 0.0 && self.error >= 0.0
    }

    pub(super) fn name(&self, error: &str) -> String {
        let mut name = format!(
            "{}\n{error}: {}\ncost: {} operations",
            self.label,
            number(self.error),
            number(self.cost)
        );
        for (is, what) in [
            (self.truth, "it is the truth"),
            (self.dominated, "dominated"),
            (self.faulty, "with faults"),
        ] {
            if is {
                name += "\n";
                name += what;
            }
        }
        name
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches equal points that dominate each other, ties taken for free, and NaN that counts as small.
    #[test]
    fn dominance() {
        let nan = f64::NAN;
        let cases: [(&[[f64; 2]], &[bool]); 5] = [
            (&[[1.0, 1.0], [1.0, 1.0]], &[false, false]),
            (&[[1.0, 1.0], [1.0, 2.0], [2.0, 1.0], [2.0, 0.5]], &[false, true, true, false]),
            (&[[1.0, nan], [2.0, 1.0]], &[false, false]),
            (&[[1.0, 0.0], [2.0, f64::INFINITY]], &[false, true]),
            (&[], &[]),
        ];
        for (points, expected) in cases {
            assert_eq!(dominated(points), expected, "{points:?}");
        }
    }
}
