//! A plane through the domain at the worst input: where an error is large, and how it falls off.

use serde_json::Value as Json;

use super::errors::largest;
use super::subject::Subject;
use super::{MeasureError, Of};
use crate::data::Picture;

/// Points along each coordinate to see along which the error changes most.
const PROBES: usize = 17;

/// The plane along the two coordinates that change the error most; none where the domain has fewer than two.
pub(crate) fn slice(subject: &Subject, worst: &[f64], of: Of, side: usize) -> Result<Option<Picture>, MeasureError> {
    let axes = subject.domain.axes();
    let smooth: Vec<usize> = (0..axes.len()).filter(|axis| axes[*axis].is_smooth).collect();
    if smooth.len() < 2 || side == 0 {
        return Ok(None);
    }
    let mut points = Vec::new();
    for axis in &smooth {
        points.extend((0..PROBES).map(|i| with(worst, &[(*axis, i as f64 / (PROBES - 1) as f64)])));
    }
    let errors = errors(subject, &points, of)?;
    let mut spread: Vec<(f64, usize)> = errors
        .chunks(PROBES)
        .zip(&smooth)
        .map(|(errors, axis)| {
            let logs = errors.iter().map(|e| e.unwrap_or(1e30).max(1e-12).log10());
            (
                logs.clone().fold(f64::NEG_INFINITY, f64::max) - logs.fold(f64::INFINITY, f64::min),
                *axis,
            )
        })
        .collect();
    // The axes in their order where they change it alike.
    spread.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let (x, y) = (spread[0].1.min(spread[1].1), spread[0].1.max(spread[1].1));
    let at = |i: usize| (i as f64 + 0.5) / side as f64;
    let mut points = Vec::with_capacity(side * side);
    for row in 0..side {
        for column in 0..side {
            // The first row is the top: the large end of y.
            points.push(with(worst, &[(x, at(column)), (y, 1.0 - at(row))]));
        }
    }
    Ok(Some(Picture {
        axes: [x, y].map(|axis| match axes[axis].ends {
            Some((lo, hi, true)) => format!("{} {lo:?} to {hi:?}, logarithmic", axes[axis].name),
            Some((lo, hi, false)) => format!("{} {lo:?} to {hi:?}", axes[axis].name),
            None => axes[axis].name.clone(),
        }),
        width: side,
        height: side,
        errors: self::errors(subject, &points, of)?,
        worst: [worst[x] * side as f64, (1.0 - worst[y]) * side as f64],
        of: of.name().to_owned(),
    }))
}

fn with(point: &[f64], changes: &[(usize, f64)]) -> Vec<f64> {
    let mut changed = point.to_vec();
    for (axis, value) in changes {
        changed[*axis] = *value;
    }
    changed
}

/// Errors at points; none where the module's value is not finite.
pub(crate) fn errors(subject: &Subject, points: &[Vec<f64>], of: Of) -> Result<Vec<Option<f64>>, MeasureError> {
    let rows: Vec<Json> = points.iter().map(|p| subject.domain.row(p)).collect();
    let [got, truth] = of.values(subject, &rows)?;
    let size = |(got, truth): (&Vec<f64>, &Vec<f64>)| {
        let (size, _) = largest(subject.metric(), got, truth);
        size.is_finite().then_some(size)
    };
    Ok(got.iter().zip(&truth).map(size).collect())
}
