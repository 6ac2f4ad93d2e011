//! A model held against what was measured.

use serde_json::{Map, Value as Json, json};
use shadewright_compiler::diagnostics::{Diagnostic, codes};
use shadewright_compiler::{Catalog, Recipe, Report};
use shadewright_evaluate::Counts;
use shadewright_runtime::measured::Sample;
use shadewright_runtime::probe::Probe;

use super::{Subject, Variables, unfit};
use crate::data::{Executed, FitErrors};
use crate::experiment::Metric;
use crate::measure::{MeasureError, Random, executed, latin, statistics};

/// Points and samples that tell what is read from what is not.
const POINTS: usize = 4;
const FEW: usize = 64;
/// What a value that is not finite differs by: far more than any that is.
const LOST: f64 = 1e6;

/// A linked model, and samples to compare it with.
pub struct Comparison {
    probe: Probe,
    pub variables: Variables,
    /// Rows of the probe without what is free.
    rows: Vec<Map<String, Json>>,
    /// Of each row the cosine of the light's angle, and what was measured, as the metric has it.
    measured: Vec<(f64, [f64; 3])>,
}

impl Comparison {
    /// Links a model.
    ///
    /// # Errors
    /// Its recipe is wrong, its function gives no three numbers, or it reads what a fit does not vary.
    pub fn new(catalog: &Catalog, subject: &Subject, recipe: &Recipe, samples: &[Sample]) -> Result<Self, MeasureError> {
        let declared = &subject.declared;
        let probe = Probe::new(catalog, recipe, &declared.function)?;
        let numbers = probe.components().len();
        let why = if numbers == 3 {
            unfit(&probe)
        } else {
            Some(format!("`{}` gives {numbers} numbers instead of three channels", declared.function))
        };
        if let Some(why) = why {
            let message = format!("`{}` {why}", recipe.root.module);
            return Err(Report::from(Diagnostic::new(codes::FIT_INVALID, message)).into());
        }
        let read = probe.input().and_then(|(_, layout)| layout.element.as_deref());
        let is_read = |name: &str| read.is_some_and(|layout| layout.members.iter().any(|member| member.name == name));
        let row = |sample: &Sample| -> Map<String, Json> {
            let directions = [(&declared.view, sample.v), (&declared.light, sample.l)];
            let read = directions.into_iter().filter(|(name, _)| is_read(name));
            read.map(|(name, direction)| (name.clone(), json!(direction.to_array()))).collect()
        };
        let metric = |sample: &Sample| (sample.l.z, sample.value.map(|f| compressed(f, sample.l.z)));
        let mut comparison = Self {
            variables: Variables::of(subject, &probe),
            rows: samples.iter().map(row).collect(),
            measured: samples.iter().map(metric).collect(),
            probe,
        };
        // A linked function has the whole struct, whatever it reads of it.
        let mut variables = comparison.variables.clone();
        let points = latin(variables.len(), POINTS, &mut Random::new(2, 0));
        variables.drop_unread(&points, |a, b| {
            Ok::<bool, MeasureError>(comparison.differences(a, FEW)? == comparison.differences(b, FEW)?)
        })?;
        comparison.variables = variables;
        Ok(comparison)
    }

    /// Values of the model at its first samples, by sample and channel in the metric, and what they executed.
    fn values(&self, point: &[f64], count: usize) -> Result<(Vec<Vec<f64>>, Vec<Counts>), MeasureError> {
        let mut free = Map::new();
        self.variables.write(point, &mut free);
        let whole = |row: &Map<String, Json>| {
            let mut row = row.clone();
            row.extend(free.clone());
            Json::Object(row)
        };
        let rows: Vec<Json> = self.rows.iter().take(count).map(whole).collect();
        let evaluated = self.probe.on_cpu::<f64>(&self.probe.table(&rows)?)?;
        let compress =
            |(values, (cosine, _)): (Vec<f64>, &(f64, [f64; 3]))| -> Vec<f64> { values.iter().map(|f| compressed(*f, *cosine)).collect() };
        let values = evaluated.values.into_iter().zip(&self.measured).map(compress).collect();
        Ok((values, evaluated.executed))
    }

    /// Numbers that so many samples are compared by.
    pub fn points(&self, count: usize) -> usize {
        3 * self.rows.len().min(count)
    }

    /// Differences at the first samples, channel by channel.
    pub fn differences(&self, point: &[f64], count: usize) -> Result<Vec<f64>, MeasureError> {
        let (values, _) = self.values(point, count)?;
        let differences = values.iter().zip(&self.measured).flat_map(|(got, (_, measured))| {
            let difference = |(got, measured): (&f64, &f64)| if got.is_finite() { got - measured } else { LOST };
            got.iter().zip(measured).map(difference).collect::<Vec<f64>>()
        });
        Ok(differences.collect())
    }

    /// Statistics over all samples, and what a call executes.
    pub fn errors(&self, point: &[f64]) -> Result<(FitErrors, Executed), MeasureError> {
        let (values, counts) = self.values(point, self.rows.len())?;
        let measured: Vec<Vec<f64>> = self.measured.iter().map(|(_, measured)| measured.to_vec()).collect();
        let (errors, _) = statistics(&Metric::Absolute { unit: String::new() }, &values, &measured);
        let fit = FitErrors {
            rms: errors.rms,
            p95: errors.p95,
            max: errors.max,
            bias: errors.bias,
        };
        Ok((fit, executed(&counts)))
    }
}

/// ln(1 + f cos) (Löw et al. 2012). A value below 0 is compared as it is: the logarithm has none of -1.
fn compressed(f: f64, cosine: f64) -> f64 {
    let x = f * cosine;
    if x >= 0.0 { x.ln_1p() } else { x }
}
