//! Least squares within ranges, from several beginnings.

use std::sync::atomic::{AtomicBool, Ordering};

use rmpfit::{MPConfig, MPError, MPFitter, MPPar, MPResult};

use super::compare::Comparison;
use crate::data::Fit;
use crate::measure::{MeasureError, Random, latin};

/// Points at which a search may begin, beside the model's defaults; the best ones are used.
const POINTS: usize = 48;
/// So many of them, the defaults not counted.
const BEGINNINGS: usize = 3;
/// Samples that tell good points from bad ones.
const FEW: usize = 128;
/// Step of the numerical derivatives, of a range. Numbers reach the model in 32 bits: a step of 1e-8 would be lost in them.
const STEP: f64 = 3e-4;
/// A fit ends when the sum of squares, or the point, changes by less than this part.
const TOLERANCE: f64 = 1e-10;
const ITERATIONS: usize = 150;

/// The best fit of a model to its first samples; its errors are over all of them. What has no name here is for the caller.
///
/// # Errors
/// The model cannot be evaluated, or somebody asked to stop.
pub fn best(model: &Comparison, count: usize, cancel: &AtomicBool) -> Result<Fit, MeasureError> {
    let dimensions = model.variables.len();
    let mut evaluations = 0;
    let mut best: Option<(f64, Vec<f64>)> = None;
    for begin in beginnings(model, count, &mut evaluations)? {
        let mut search = Search::new(model, count, dimensions, cancel);
        let mut point = begin.clone();
        let ended = if dimensions > 0 {
            search.mpfit(&mut point).map(|_| ())
        } else {
            Ok(())
        };
        evaluations += search.evaluations;
        match ended {
            Ok(()) | Err(MPError::Nan) => {}
            Err(error) => match search.failed.take() {
                Some(failed) => return Err(failed),
                // More numbers free than measured: what it begins with is as good as it gets.
                None if matches!(error, MPError::DoF | MPError::Empty) => point = begin,
                None => return Err(MeasureError::Fit(error.to_string())),
            },
        }
        let square = sum_of_squares(&model.differences(&point, count)?);
        if best.as_ref().is_none_or(|(least, _)| square < *least) {
            best = Some((square, point));
        }
    }
    let point = best.map(|(_, point)| point).unwrap_or_default();
    let (errors, executed) = model.errors(&point)?;
    Ok(Fit {
        parameters: model.variables.fitted(&point),
        errors,
        executed,
        evaluations,
        ..Fit::default()
    })
}

/// The defaults, and the best of points that fill the ranges.
fn beginnings(model: &Comparison, count: usize, evaluations: &mut usize) -> Result<Vec<Vec<f64>>, MeasureError> {
    let mut beginnings = vec![model.variables.start()];
    if model.variables.len() == 0 {
        return Ok(beginnings);
    }
    let mut points = Vec::with_capacity(POINTS);
    for point in latin(model.variables.len(), POINTS, &mut Random::new(1, 0)) {
        let differences = model.differences(&point, count.min(FEW))?;
        points.push((sum_of_squares(&differences), point));
    }
    *evaluations += POINTS;
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    beginnings.extend(points.into_iter().take(BEGINNINGS).map(|(_, point)| point));
    Ok(beginnings)
}

fn sum_of_squares(differences: &[f64]) -> f64 {
    differences.iter().map(|x| x * x).sum()
}

/// A model's differences as the solver wants them.
struct Search<'a> {
    model: &'a Comparison,
    count: usize,
    cancel: &'a AtomicBool,
    parameters: Vec<MPPar>,
    config: MPConfig,
    points: usize,
    evaluations: usize,
    failed: Option<MeasureError>,
}

impl<'a> Search<'a> {
    fn new(model: &'a Comparison, count: usize, dimensions: usize, cancel: &'a AtomicBool) -> Self {
        let parameter = || MPPar {
            limited_low: true,
            limited_up: true,
            limit_low: 0.0,
            limit_up: 1.0,
            step: STEP,
            ..MPPar::default()
        };
        Self {
            model,
            count,
            cancel,
            parameters: (0..dimensions).map(|_| parameter()).collect(),
            config: MPConfig {
                ftol: TOLERANCE,
                xtol: TOLERANCE,
                max_iter: ITERATIONS,
                ..MPConfig::default()
            },
            points: model.points(count),
            evaluations: 0,
            failed: None,
        }
    }

    fn try_eval(&self, point: &[f64], deviates: &mut [f64]) -> Result<(), MeasureError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(MeasureError::Interrupted);
        }
        let differences = self.model.differences(point, self.count)?;
        deviates.iter_mut().zip(differences).for_each(|(to, from)| *to = from);
        Ok(())
    }
}

impl MPFitter for Search<'_> {
    fn eval(&mut self, point: &[f64], deviates: &mut [f64]) -> MPResult<()> {
        self.evaluations += 1;
        self.try_eval(point, deviates).map_err(|error| {
            self.failed = Some(error);
            MPError::Eval
        })
    }

    fn number_of_points(&self) -> usize {
        self.points
    }

    fn config(&self) -> &MPConfig {
        &self.config
    }

    fn parameters(&self) -> &[MPPar] {
        &self.parameters
    }
}
