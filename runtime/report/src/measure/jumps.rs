//! Discontinuities: places where a formula jumps and its truth does not.

use serde_json::Value as Json;

use super::sample::Random;
use super::subject::Subject;
use super::{MeasureError, worst_of};
use crate::data::Fault;
use crate::experiment::Metric;

/// A jump is as large as this share of the values beside it, or of the metric's unit. Smaller ones are not told from a steep slope.
const JUMP: f64 = 0.01;
/// Halvings of a segment: what is left of it is below the spacing of 32-bit numbers.
const HALVINGS: u32 = 28;

/// Two points of the cube that differ in one coordinate, and what the formula gives there.
struct Segment {
    ends: [Vec<f64>; 2],
    values: [Vec<f64>; 2],
}

/// Looks for jumps along segments from some points, each in one coordinate. Halves each segment, keeping the half in which the formula changes
/// more, until nothing is between its ends; then compares its change with that of the truth.
///
/// Both are in double precision: what rounding makes is no jump.
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
    let ends: Vec<Vec<f64>> = points.iter().map(far).collect();
    let formula = |points: &[Vec<f64>]| {
        let rows: Vec<Json> = points.iter().map(|p| subject.domain.row(p)).collect();
        subject.formula::<f64>(&rows).map(|done| done.values)
    };
    let values = formula(points)?.into_iter().zip(formula(&ends)?);
    let mut segments: Vec<Segment> = points
        .iter()
        .zip(&ends)
        .zip(values)
        .map(|((a, b), (at_a, at_b))| Segment {
            ends: [a.clone(), b.clone()],
            values: [at_a, at_b],
        })
        .collect();
    for _ in 0..HALVINGS {
        let middles: Vec<Vec<f64>> = segments.iter().map(|s| middle(&s.ends)).collect();
        for ((segment, at), value) in segments.iter_mut().zip(&middles).zip(formula(&middles)?) {
            let replaced = usize::from(change(subject, &segment.values[0], &value) >= change(subject, &value, &segment.values[1]));
            segment.ends[replaced].clone_from(at);
            segment.values[replaced] = value;
        }
    }
    count(subject, &segments)
}

fn middle(ends: &[Vec<f64>; 2]) -> Vec<f64> {
    ends[0].iter().zip(&ends[1]).map(|(a, b)| (a + b) / 2.0).collect()
}

/// Largest difference of two results' numbers, as a share of the larger one where the metric is relative: neither of them is the truth.
fn change(subject: &Subject, a: &[f64], b: &[f64]) -> f64 {
    let size = |(a, b): (&f64, &f64)| match subject.metric() {
        Metric::Relative { floor } => (a - b).abs() / a.abs().max(b.abs()).max(*floor),
        Metric::Absolute { .. } => (a - b).abs(),
    };
    a.iter().zip(b).map(size).fold(0.0, f64::max)
}

fn count(subject: &Subject, segments: &[Segment]) -> Result<Fault, MeasureError> {
    let mut fault = Fault::default();
    let mut most = 0.0;
    for segment in segments {
        let jump = change(subject, &segment.values[1], &segment.values[0]);
        if jump.is_nan() || jump < JUMP {
            continue;
        }
        let rows: Vec<Json> = segment.ends.iter().map(|p| subject.domain.row(p)).collect();
        let Some(truth) = subject.truth(&rows)? else { continue };
        let excess = jump - change(subject, &truth[1], &truth[0]);
        if excess > JUMP {
            fault.count += 1;
            if excess > most {
                most = excess;
                fault.worst = Some(worst_of(subject, &rows[1], &segment.values[1], &truth[1]));
            }
        }
    }
    Ok(fault)
}
