//! Measures a library's experiments: the rows of a report.

use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::Value as Json;
use shadewright_compiler::Catalog;
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::gpu::pipeline::Pipelines;
use shadewright_runtime::probe::{Probe, Table, time};

use crate::data::{Provenance, Report, Results, Row, Samples, Time};
use crate::experiment::{Experiment, Metric, TruthSource};
use crate::measure::{Effort, Known, MeasureError, Measured, OnDevice, Subject, configurations, key, mark_dominated, measure};

/// Repetitions of a timing.
const REPETITIONS: usize = 15;
/// Configurations that are timed; they repeat until a pass lasts long enough.
const TIMED: usize = 512;

/// What is measured, and how.
pub struct Options<'a> {
    /// Categories whose experiments are run; empty for all.
    pub categories: &'a [String],
    /// Device for the errors in f32 and the times; none for what is equal on every machine.
    pub device: Option<&'a Gpu>,
    /// A sample that a test has time for.
    pub quick: bool,
    /// What is already measured.
    pub done: &'a dyn Done,
    /// Set to stop after the step that is being done.
    pub cancel: &'a AtomicBool,
    /// Called with what is done next: steps done, all steps, and its name.
    pub progress: &'a dyn Fn(usize, usize, &str),
}

/// Finished rows, kept so that a report can be resumed.
pub trait Done {
    /// The row kept under a key.
    fn get(&self, key: &str) -> Option<String>;
    /// Keeps a row.
    ///
    /// # Errors
    /// It cannot be kept.
    fn put(&self, key: &str, row: &str) -> std::io::Result<()>;
}

/// Nothing is kept.
impl Done for () {
    fn get(&self, _: &str) -> Option<String> {
        None
    }

    fn put(&self, _: &str, _: &str) -> std::io::Result<()> {
        Ok(())
    }
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// An alternative cannot be measured.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// There is no such category, or none of its modules is in an experiment.
    #[error("{0}")]
    Nothing(String),
}

/// Runs experiments.
///
/// An alternative that cannot be measured is no row, but named under [`Report::without`] with the reason.
///
/// # Errors
/// See [`ReportError`].
pub fn run(catalog: &Catalog, experiments: &[Experiment], options: &Options) -> Result<Report, ReportError> {
    let chosen: Vec<&Experiment> = experiments
        .iter()
        .filter(|e| options.categories.is_empty() || options.categories.contains(&e.category))
        .collect();
    for category in options.categories {
        if !chosen.iter().any(|e| e.category == *category) {
            let known: Vec<&str> = experiments.iter().map(|e| e.category.as_str()).collect();
            let nearest = shadewright_compiler::diagnostics::nearest(category, known).map(|n| format!("; did you mean `{n}`?"));
            let message = format!("no experiment is about a category `{category}`{}", nearest.unwrap_or_default());
            return Err(ReportError::Nothing(message));
        }
    }
    let pipelines = options.device.map(|gpu| Pipelines::new(gpu, None));
    let device = options
        .device
        .zip(pipelines.as_ref())
        .map(|(gpu, pipelines)| OnDevice { gpu, pipelines });
    let steps = chosen.iter().map(|e| e.alternatives.len() + 1).sum();
    let mut run = Run {
        catalog,
        options,
        device,
        effort: if options.quick { Effort::QUICK } else { Effort::FULL },
        steps,
        done: 0,
        report: Report {
            provenance: provenance(options.device),
            ..Report::default()
        },
    };
    for experiment in &chosen {
        run.experiment(experiment)?;
    }
    if options.categories.is_empty() {
        run.others(experiments);
    }
    Ok(run.report)
}

fn provenance(device: Option<&Gpu>) -> Provenance {
    let commit = option_env!("SHADEWRIGHT_COMMIT").unwrap_or_default().to_owned();
    let version = env!("CARGO_PKG_VERSION").to_owned();
    let Some(gpu) = device else {
        return Provenance {
            version,
            commit,
            ..Provenance::default()
        };
    };
    let info = gpu.info();
    Provenance {
        device: info.name.clone(),
        driver: format!("{} {} ({})", info.driver, info.driver_info, info.backend).trim().to_owned(),
        is_software: gpu.is_software(),
        version,
        commit,
        date: String::new(),
    }
}

struct Run<'a> {
    catalog: &'a Catalog,
    options: &'a Options<'a>,
    device: Option<OnDevice<'a>>,
    effort: Effort,
    steps: usize,
    done: usize,
    report: Report,
}

impl Run<'_> {
    fn step(&mut self, what: &str) -> Result<(), MeasureError> {
        if self.options.cancel.load(Ordering::Relaxed) {
            return Err(MeasureError::Interrupted);
        }
        (self.options.progress)(self.done, self.steps, what);
        self.done += 1;
        Ok(())
    }

    fn experiment(&mut self, experiment: &Experiment) -> Result<(), ReportError> {
        let known = Known::default();
        let mut subjects = Vec::new();
        let mut rows: Vec<Row> = Vec::new();
        let mut hard = 0;
        let mut samples: Option<Samples> = None;
        for alternative in &experiment.alternatives {
            let name = format!("{}: {}", experiment.name, alternative.label);
            self.step(&name)?;
            let measured = Subject::new(self.catalog, experiment, alternative, &known).and_then(|subject| {
                let found = self.row(&subject)?;
                Ok((subject, found))
            });
            match measured {
                Ok((subject, (measured, count))) => {
                    hard = hard.max(count);
                    if !measured.errors.is_empty() {
                        let samples = samples.get_or_insert_with(|| Samples {
                            inputs: configurations(&subject, &self.effort).0,
                            ..Samples::default()
                        });
                        samples.errors.insert(measured.row.label.clone(), measured.errors);
                    }
                    rows.push(measured.row);
                    self.report.agreement.extend(measured.agreement);
                    subjects.push(subject);
                }
                Err(error @ (MeasureError::Interrupted | MeasureError::Truth { .. } | MeasureError::Keep(_))) => return Err(error.into()),
                Err(error) => {
                    self.report.without.insert(name, first_line(&error));
                }
            }
        }
        self.step(&format!("{}: times", experiment.name))?;
        let baseline = experiment.declared.baseline.clone();
        let baseline = baseline.or_else(|| rows.first().map(|row| row.label.clone())).unwrap_or_default();
        self.times(&subjects, &mut rows, &baseline)?;
        let comparable = matches!(
            experiment.declared.truth,
            TruthSource::Closed(_) | TruthSource::Reference(_) | TruthSource::Sampled(_)
        );
        if comparable {
            mark_dominated(&mut rows);
        }
        self.report.experiments.push(Results {
            name: experiment.name.clone(),
            title: experiment.declared.title.clone(),
            doc: experiment.declared.doc.clone(),
            category: experiment.category.clone(),
            function: experiment.function.clone(),
            truth: truth_name(&experiment.declared.truth),
            metric: metric_name(&experiment.declared.metric),
            configurations: experiment.declared.configurations.min(self.effort.configurations),
            hard,
            seed: experiment.declared.seed,
            comparable,
            baseline,
            samples,
            rows,
        });
        Ok(())
    }

    /// A row, measured or found among those that are done.
    fn row(&self, subject: &Subject) -> Result<(Measured, usize), MeasureError> {
        let (rows, hard) = configurations(subject, &self.effort);
        let key = key(subject, &rows, &self.effort, &self.report.provenance)?;
        let kept = self
            .options
            .done
            .get(&key)
            .and_then(|text| serde_json::from_str::<Measured>(&text).ok());
        if let Some(measured) = kept {
            return Ok((measured, hard));
        }
        let measured = measure(subject, self.device, &self.effort, self.options.cancel)?;
        // Plain data without a number that JSON lacks: those are text or absent.
        if let Ok(text) = serde_json::to_string(&measured) {
            self.options.done.put(&key, &text)?;
        }
        Ok((measured, hard))
    }

    /// Times the alternatives of an experiment in turn; ratios are of one repetition.
    fn times(&self, subjects: &[Subject], rows: &mut [Row], baseline: &str) -> Result<(), MeasureError> {
        let Some(device) = self.device else { return Ok(()) };
        let mut tables: Vec<Table> = Vec::new();
        for subject in subjects {
            let (rows, _) = configurations(subject, &self.effort);
            // With one set of parameters and instances: many would be as many dispatches, whose price is not the function's.
            let first = rows.first().cloned().unwrap_or_default();
            let rows: Vec<Json> = rows.iter().take(TIMED).map(|row| with_shared(row, &first)).collect();
            tables.push(subject.table(&rows)?);
        }
        let alternatives: Vec<(&Probe, &Table)> = subjects.iter().map(|s| &s.probe).zip(&tables).collect();
        if alternatives.is_empty() {
            return Ok(());
        }
        let Some(times) = time(device.pipelines, device.gpu, &alternatives, REPETITIONS, self.options.cancel)? else {
            return Ok(());
        };
        if self.options.cancel.load(Ordering::Relaxed) {
            // Fewer repetitions than it says are no figures.
            return Err(MeasureError::Interrupted);
        }
        let Some(base) = rows.iter().position(|row| row.label == baseline) else {
            return Ok(());
        };
        for (row, own) in rows.iter_mut().zip(&times) {
            let ratios = own.iter().zip(&times[base]).map(|(own, base)| own / base);
            row.time = spread(ratios.collect(), own.clone());
        }
        Ok(())
    }

    /// Modules that are in no experiment, and why.
    fn others(&mut self, experiments: &[Experiment]) {
        for module in self.catalog.modules() {
            let name = format!("{}/{}", module.category, module.name);
            let is_in = |e: &Experiment| {
                e.alternatives
                    .iter()
                    .any(|a| a.root.category == module.category && a.root.name == module.name)
            };
            if experiments.iter().any(is_in) {
                continue;
            }
            let why = match self.catalog.functions(&module.category) {
                Err(report) => first_line(&report),
                Ok(functions) if functions.is_empty() => "it has entry points, and no function to call".to_owned(),
                Ok(functions) => {
                    let recipe = shadewright_compiler::Recipe::from(shadewright_compiler::manifest::Node::new(&name));
                    let tried = functions.keys().next().map(|function| Probe::new(self.catalog, &recipe, function));
                    match tried {
                        Some(Err(error)) => first_line(&error),
                        _ => "no experiment is about it".to_owned(),
                    }
                }
            };
            self.report.without.insert(name, why);
        }
    }
}

fn first_line(error: &dyn std::fmt::Display) -> String {
    let text = error.to_string();
    text.lines().next().unwrap_or_default().to_owned()
}

/// A row with the parameters and instances of another.
fn with_shared(row: &Json, of: &Json) -> Json {
    let mut row = row.clone();
    for shared in ["params", "instances"] {
        if let (Json::Object(members), Some(value)) = (&mut row, of.get(shared)) {
            members.insert(shared.to_owned(), value.clone());
        }
    }
    row
}

fn spread(mut ratios: Vec<f64>, mut nanoseconds: Vec<f64>) -> Option<Time> {
    if ratios.is_empty() {
        return None;
    }
    ratios.sort_by(f64::total_cmp);
    nanoseconds.sort_by(f64::total_cmp);
    let at = |list: &[f64], share: f64| list[((list.len() - 1) as f64 * share).round() as usize];
    Some(Time {
        median: at(&ratios, 0.5),
        p10: at(&ratios, 0.1),
        p90: at(&ratios, 0.9),
        nanoseconds: at(&nanoseconds, 0.5),
    })
}

fn truth_name(truth: &TruthSource) -> String {
    match truth {
        TruthSource::Own => "closed form of each module".to_owned(),
        TruthSource::Closed(folder) => format!("closed form of `{folder}`"),
        TruthSource::Reference(node) => format!("`{}` in double precision", node.module),
        TruthSource::Sampled(node) => format!("`{}` in double precision, sampled", node.module),
        TruthSource::Itself => "none: the formula itself in double precision".to_owned(),
    }
}

fn metric_name(metric: &Metric) -> String {
    match metric {
        Metric::Relative { floor } => format!("relative to the truth, or to {floor:e} where that is smaller"),
        Metric::Absolute { unit } if unit.is_empty() => "absolute".to_owned(),
        Metric::Absolute { unit } => format!("absolute, {unit}"),
    }
}
