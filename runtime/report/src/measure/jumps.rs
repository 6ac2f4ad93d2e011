//! Discontinuities: places where a formula jumps and its truth does not.

use serde_json::Value as Json;

use super::errors::difference;
use super::sample::Random;
use super::subject::Subject;
use super::{MeasureError, worst_of};
use crate::data::Fault;
use crate::experiment::Metric;

/// A jump is as large as this share of the values beside it, or of the metric's unit. Smaller ones are not told from a steep slope.
const JUMP: f64 = 0.01;
/// Halvings of a segment: what is left of it is below the spacing of 32-bit numbers.
const HALVINGS: u32 = 28;
/// Evaluations of the formula for a segment.
pub(crate) const EVALUATIONS: f64 = 2.0 + HALVINGS as f64;

/// A point of the cube, what the formula gives there, and how far that is from the truth.
#[derive(Clone)]
struct End {
    point: Vec<f64>,
    value: Vec<f64>,
    truth: Vec<f64>,
}

/// Looks for jumps along segments from some points, each in one coordinate. Halves each segment, keeping the half in which the formula's error
/// changes more, until nothing is between its ends; then compares the formula's change with that of the truth. Of a formula that is right nearly
/// everywhere the error is flat but where it jumps, however steep the formula itself is.
///
/// Both are in double precision: what rounding makes is no jump. A truth that is sampled would lead astray, and cost the most: there the formula's own
/// change is followed, and the truth asked at the ends.
pub(crate) fn jumps(subject: &Subject, points: &[Vec<f64>], random: &mut Random) -> Result<Fault, MeasureError> {
    let axes = subject.domain.axes();
    let smooth: Vec<usize> = (0..axes.len()).filter(|axis| axes[*axis].is_smooth).collect();
    if smooth.is_empty() || !subject.has_truth() {
        return Ok(Fault::default());
    }
    let far = |point: &Vec<f64>| {
        let mut end = point.clone();
        end[smooth[random.below(smooth.len())]] = random.unit();
        end
    };
    let others: Vec<Vec<f64>> = points.iter().map(far).collect();
    let along = |points: Vec<Vec<f64>>| ends(subject, points, !subject.is_sampled());
    let starts = along(points.to_vec())?;
    let mut segments: Vec<[End; 2]> = starts.into_iter().zip(along(others)?).map(|(a, b)| [a, b]).collect();
    for _ in 0..HALVINGS {
        let middles = along(segments.iter().map(middle).collect())?;
        for (segment, middle) in segments.iter_mut().zip(middles) {
            let replaced = usize::from(drift(subject, &segment[0], &middle) >= drift(subject, &middle, &segment[1]));
            segment[replaced] = middle;
        }
    }
    if subject.is_sampled() {
        // Only where the formula changes has the truth something to say.
        segments.retain(|[a, b]| change(subject, &b.value, &a.value) > JUMP);
        let (first, last) = segments.into_iter().map(|[a, b]| (a.point, b.point)).unzip();
        let pairs = ends(subject, first, true)?.into_iter().zip(ends(subject, last, true)?);
        segments = pairs.map(|(a, b)| [a, b]).collect();
    }
    Ok(count(subject, &segments))
}

/// Values at points; beside the truth, or beside 0.
fn ends(subject: &Subject, points: Vec<Vec<f64>>, with_truth: bool) -> Result<Vec<End>, MeasureError> {
    let rows: Vec<Json> = points.iter().map(|p| subject.domain.row(p)).collect();
    let values = subject.formula::<f64>(&rows)?.values;
    let truths = match with_truth {
        true => subject.truth(&rows)?.unwrap_or_else(|| values.clone()),
        false => values.iter().map(|value| vec![0.0; value.len()]).collect(),
    };
    let end = |((point, value), truth)| End { point, value, truth };
    Ok(points.into_iter().zip(values).zip(truths).map(end).collect())
}

fn middle(ends: &[End; 2]) -> Vec<f64> {
    ends[0].point.iter().zip(&ends[1].point).map(|(a, b)| (a + b) / 2.0).collect()
}

/// How much the error changes from one end to the other.
fn drift(subject: &Subject, a: &End, b: &End) -> f64 {
    let error = |end: &End| -> Vec<f64> {
        let pairs = end.value.iter().zip(&end.truth);
        pairs.map(|(value, truth)| difference(subject.metric(), *value, *truth)).collect()
    };
    error(a).iter().zip(error(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Largest difference of two results' numbers, as a share of the larger one where the metric is relative: neither of them is the truth.
fn change(subject: &Subject, a: &[f64], b: &[f64]) -> f64 {
    let size = |(a, b): (&f64, &f64)| match subject.metric() {
        Metric::Relative { floor } => (a - b).abs() / a.abs().max(b.abs()).max(*floor),
        Metric::Absolute { .. } => (a - b).abs(),
    };
    a.iter().zip(b).map(size).fold(0.0, f64::max)
}

fn count(subject: &Subject, segments: &[[End; 2]]) -> Fault {
    let mut fault = Fault::default();
    let mut most = 0.0;
    for [a, b] in segments {
        let excess = change(subject, &b.value, &a.value) - change(subject, &b.truth, &a.truth);
        if excess > JUMP {
            fault.count += 1;
            if excess > most {
                most = excess;
                // The end that is further from the truth.
                let end = if drift(subject, &at_truth(b), b) >= drift(subject, &at_truth(a), a) {
                    b
                } else {
                    a
                };
                fault.worst = Some(worst_of(subject, &subject.domain.row(&end.point), &end.value, &end.truth));
            }
        }
    }
    fault
}

fn at_truth(end: &End) -> End {
    End {
        value: end.truth.clone(),
        ..end.clone()
    }
}
