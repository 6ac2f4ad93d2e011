//! Differences and their statistics.

use crate::data::{Errors, Worst};
use crate::experiment::Metric;

/// Difference of a value from what it should be, with its sign. Not finite where the value is not.
pub(crate) fn difference(metric: &Metric, got: f64, truth: f64) -> f64 {
    match metric {
        Metric::Relative { floor } => (got - truth) / truth.abs().max(*floor),
        Metric::Absolute { .. } => got - truth,
    }
}

/// The largest difference among a result's numbers and which it is of; those that are not finite are larger than all.
pub(crate) fn largest(metric: &Metric, got: &[f64], truth: &[f64]) -> (f64, usize) {
    let mut worst = (0.0, 0);
    for (index, (got, truth)) in got.iter().zip(truth).enumerate() {
        let size = difference(metric, *got, *truth).abs();
        // NaN compares as false: it is taken for infinite.
        let size = if size.is_nan() { f64::INFINITY } else { size };
        if size > worst.0 {
            worst = (size, index);
        }
    }
    worst
}

/// Statistics over many results. Numbers that are not finite are not in them: the verdict counts those.
pub(crate) fn statistics(metric: &Metric, got: &[Vec<f64>], truth: &[Vec<f64>]) -> (Errors, Option<usize>) {
    let mut sizes = Vec::new();
    let (mut sum, mut squares) = (0.0, 0.0);
    let mut worst: Option<(f64, usize)> = None;
    for (row, (got, truth)) in got.iter().zip(truth).enumerate() {
        for (got, truth) in got.iter().zip(truth) {
            let error = difference(metric, *got, *truth);
            if !error.is_finite() {
                continue;
            }
            sum += error;
            squares += error * error;
            sizes.push(error.abs());
            if worst.is_none_or(|(most, _)| error.abs() > most) {
                worst = Some((error.abs(), row));
            }
        }
    }
    if sizes.is_empty() {
        return (Errors::default(), None);
    }
    let count = sizes.len() as f64;
    sizes.sort_by(f64::total_cmp);
    let max = sizes[sizes.len() - 1];
    let errors = Errors {
        rms: (squares / count).sqrt(),
        // The smallest size that 95 % do not exceed.
        p95: sizes[((sizes.len() * 95).div_ceil(100)).clamp(1, sizes.len()) - 1],
        max,
        bias: sum / count,
        searched: max,
        worst: Worst::default(),
    };
    (errors, worst.map(|(_, row)| row))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a sign, a floor or a percentile that is wrong.
    #[test]
    fn statistics_of_known_errors() {
        let truth: Vec<Vec<f64>> = (1..=100).map(|_| vec![2.0]).collect();
        let got: Vec<Vec<f64>> = (1..=100).map(|i| vec![2.0 + 2.0 * f64::from(i)]).collect();
        let (errors, worst) = statistics(&Metric::Relative { floor: 1e-3 }, &got, &truth);
        assert_eq!((errors.p95, errors.max, errors.bias, worst), (95.0, 100.0, 50.5, Some(99)));
        assert!((errors.rms - 3383.5_f64.sqrt()).abs() < 1e-9);
        assert_eq!(difference(&Metric::Relative { floor: 0.5 }, 0.0, 0.1), -0.2);
        assert_eq!(difference(&Metric::Absolute { unit: String::new() }, 0.0, 0.1), -0.1);
    }

    /// Catches a NaN that poisons the mean, or that passes for no error.
    #[test]
    fn what_is_not_finite_is_left_to_the_verdict() {
        let metric = Metric::Absolute { unit: String::new() };
        let (errors, worst) = statistics(
            &metric,
            &[vec![f64::NAN, 1.5], vec![f64::INFINITY, 1.0]],
            &[vec![1.0, 1.0], vec![1.0, 1.0]],
        );
        assert_eq!((errors.max, errors.bias, worst), (0.5, 0.25, Some(0)));
        assert_eq!(largest(&metric, &[1.0, f64::NAN], &[0.0, 0.0]), (f64::INFINITY, 1));
        assert_eq!(statistics(&metric, &[vec![f64::NAN]], &[vec![0.0]]), (Errors::default(), None));
    }
}
