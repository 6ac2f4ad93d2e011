//! `report`: speed against error, over the experiments that the library declares.

use std::path::{Path, PathBuf};

use clap::Args;
use indexmap::IndexMap;
use shadewright::compiler::Report;
use shadewright::compiler::diagnostics::{Diagnostic, codes};
use shadewright::report::proofs::{self, Bench, Effort};
use shadewright::report::{self, Baseline, Done, MeasureError, ReportError, fit};
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::measured::Measured;

use super::failure::Failure;
use super::input;
use super::output::{Outputs, say, say_json};
use super::watch::Watch;
use super::{Context, Format};

/// Folder in the report's for what is done, so that an interrupted report goes on where it stopped.
const DONE: &str = ".done";

/// Head of the table in Markdown.
const HEAD: &str = "# What the modules cost, and what they get wrong

Equal on every machine: errors of the evaluator, operations counted in the linked functions. [report.md](report.md) says what the columns mean.
`shadewright report --accept spec/baseline.json --markdown spec/errors.md` makes this page and the baseline that a test compares with.

";

/// Samples of a chi-square test of `--properties`, and with `--quick`.
const SAMPLES: usize = 1_000_000;
const SAMPLES_QUICK: usize = 30_000;

/// Options of `report`.
#[derive(Args)]
pub struct Options {
    /// Categories to report on; all where none is named. With --measured the models to fit, recipes; all modules where none is named
    #[arg(value_name = "CATEGORY|MODEL")]
    categories: Vec<String>,
    /// Fits models to a file of measured reflectance (MERL .binary, RGL .bsdf) instead
    #[arg(long, value_name = "FILE", conflicts_with_all = ["check", "accept"])]
    measured: Option<PathBuf>,
    /// Folder for report.html, report.json, rows.csv, plots and pictures
    #[arg(short, value_name = "DIR", default_value = "report", conflicts_with_all = ["check", "accept"])]
    output: PathBuf,
    /// Small samples, and no pictures
    #[arg(long)]
    quick: bool,
    /// Without a GPU: no times, and rounding errors of the evaluator only
    #[arg(long)]
    no_device: bool,
    /// Writes a table in Markdown of what is equal on every machine, too
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Compares errors and costs with a baseline; what is worse is an error. Small samples, no GPU, no folder
    #[arg(long, value_name = "FILE", conflicts_with_all = ["accept", "categories"])]
    check: Option<PathBuf>,
    /// Writes the baseline that --check compares with
    #[arg(long, value_name = "FILE", conflicts_with = "categories")]
    accept: Option<PathBuf>,
    /// Holds what manifests claim against the device instead, and writes the worst case of each property in Markdown. Nothing else is reported
    #[arg(long, value_name = "FILE", conflicts_with_all = ["accept", "check", "markdown", "measured", "no_device", "categories"])]
    properties: Option<PathBuf>,
}

/// # Errors
/// An experiment is wrong, an alternative cannot be measured, there is no GPU, or something is worse than the baseline.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    if let Some(path) = &options.properties {
        return properties(context, path, options.quick);
    }
    if let Some(path) = &options.measured {
        let report = fitted(context, path, options)?;
        return write(context, report, options);
    }
    let experiments = report::experiments(&*context.library, &context.catalog)?;
    let is_baseline = options.check.is_some() || options.accept.is_some();
    let gpu = if is_baseline || options.no_device {
        None
    } else {
        Some(Gpu::headless()?)
    };
    let kept = Kept {
        folder: (!is_baseline).then(|| options.output.join(DONE)),
    };
    let watch = Watch::new(1, "rows");
    let made = report::run(
        &context.catalog,
        &experiments,
        &report::Options {
            categories: &options.categories,
            device: gpu.as_ref(),
            quick: options.quick || is_baseline,
            done: &kept,
            cancel: watch.cancel(),
            progress: &|done, of, next| watch.at(done, of, next),
        },
    );
    watch.finish();
    let report = made.map_err(|error| failure(error, options))?;
    if let Some(path) = &options.check {
        return check(context, path, &Baseline::of(&report));
    }
    write(context, report, options)
}

/// The best fits to a measured table.
fn fitted(context: &Context, path: &Path, options: &Options) -> Result<report::Report, Failure> {
    let name = path.display().to_string();
    let bytes = input::bytes(path)?;
    let table = Measured::read(&bytes)
        .map_err(|error| Diagnostic::new(codes::MEASURED_DAMAGED, format!("{name}: {error}")))
        .map_err(Report::from)?;
    let subjects = fit::subjects(&*context.library, &context.catalog)?;
    let mut models = IndexMap::new();
    for typed in &options.categories {
        models.insert(typed.clone(), input::recipe(typed)?);
    }
    let watch = Watch::new(1, "models");
    let mut report = report::Report::default();
    report.provenance.version = env!("CARGO_PKG_VERSION").to_owned();
    for subject in &subjects {
        let made = fit::fit(
            &context.catalog,
            subject,
            models.clone(),
            (&name, &table),
            &fit::FitOptions {
                quick: options.quick,
                cancel: watch.cancel(),
                progress: &|done, of, next| watch.at(done, of, next),
            },
        );
        report.fits.push(made.map_err(|error| match error {
            MeasureError::Interrupted => Failure::Interrupted("nothing is written".to_owned()),
            other => failure(other.into(), options),
        })?);
    }
    watch.finish();
    Ok(report)
}

fn write(context: &Context, mut report: report::Report, options: &Options) -> Result<(), Failure> {
    let mut outputs = Outputs::default();
    if let Some(path) = &options.accept {
        outputs.stage(path, Baseline::of(&report).to_json().as_bytes())?;
    } else {
        report.provenance.date = now();
        let files = report::write::files(&report).map_err(|error| Failure::message(error.to_string()))?;
        for (name, bytes) in files {
            let path = options.output.join(name);
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder).map_err(|error| Failure::message(format!("{}: {error}", folder.display())))?;
            }
            outputs.stage(&path, &bytes)?;
        }
    }
    let head = if report.fits.is_empty() {
        HEAD
    } else {
        "# Models and measured reflectance\n\n"
    };
    if let Some(path) = &options.markdown {
        outputs.stage(path, format!("{head}{}", report::write::markdown(&report)).as_bytes())?;
    }
    outputs.commit()?;
    match context.format {
        Format::Json => say_json(&report),
        Format::Text => say(&summary(&report, options)),
    }
}

/// What is claimed, measured.
fn properties(context: &Context, path: &Path, quick: bool) -> Result<(), Failure> {
    let roles = proofs::load(&*context.library, &context.catalog)?;
    let gpu = Gpu::headless()?;
    let bench = Bench::new(&context.catalog, Some(&gpu));
    let watch = Watch::new(1, "modules");
    let effort = Effort {
        samples: if quick { SAMPLES_QUICK } else { SAMPLES },
        others: true,
        modules: &|_| true,
        cancel: watch.cancel(),
        progress: &|done, of, next| watch.at(done, of, next),
    };
    let measured = proofs::prove(&bench, &roles, &effort).and_then(|found| {
        let mut combined = Vec::new();
        for role in &roles {
            for name in &role.declared.combinations {
                combined.push(proofs::combinations(&bench, role, name, &effort)?);
            }
        }
        Ok((found, combined))
    });
    watch.finish();
    let (found, combined) = measured.map_err(|error| measure_failure(error, "nothing is written".to_owned()))?;
    let mut outputs = Outputs::default();
    let page = report::write::proofs(&bench.device(), effort.samples, &found, &combined);
    outputs.stage(path, page.as_bytes())?;
    outputs.commit()?;
    let broken: Vec<&proofs::Proof> = found.iter().filter(|proof| proof.is_broken()).collect();
    let faults: Vec<&String> = combined.iter().flat_map(|c| &c.faults).collect();
    if context.format == Format::Json {
        say_json(&serde_json::json!({"device": bench.device(), "proofs": found, "combinations": combined}))?;
    } else {
        let line = |p: &&proofs::Proof| {
            format!(
                "broken: {}: {:?}: {:e}, bound {:e}, {}",
                p.module, p.property, p.worst, p.bound, p.at
            )
        };
        let mut lines: Vec<String> = broken.iter().map(line).collect();
        lines.extend(faults.iter().map(|fault| format!("broken: {fault}")));
        lines.push(format!(
            "{} properties measured, {} broken: {}",
            found.len(),
            lines.len(),
            path.display()
        ));
        say(&lines.join("\n"))?;
    }
    if broken.is_empty() && faults.is_empty() {
        Ok(())
    } else {
        Err(Failure::Said)
    }
}

fn measure_failure(error: MeasureError, kept: String) -> Failure {
    match error {
        MeasureError::Interrupted => Failure::Interrupted(kept),
        MeasureError::Compile(report) => report.into(),
        MeasureError::Runtime(error) => error.into(),
        other => Failure::message(other.to_string()),
    }
}

fn failure(error: ReportError, options: &Options) -> Failure {
    let folder = options.output.join(DONE);
    let kept = format!(
        "what was measured is kept in {}; the same command goes on from there",
        folder.display()
    );
    match error {
        ReportError::Measure(error) => measure_failure(error, kept),
        other => Failure::message(other.to_string()),
    }
}

fn check(context: &Context, path: &Path, now: &Baseline) -> Result<(), Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::message(format!("{}: {error}", path.display())))?;
    let before = Baseline::read(&path.display().to_string(), &text)?;
    let comparison = before.compare(now);
    if context.format == Format::Json {
        say_json(&serde_json::json!({"worse": comparison.worse, "better": comparison.better}))?;
    } else {
        let mut lines: Vec<String> = comparison.worse.iter().map(|line| format!("worse: {line}")).collect();
        lines.extend(comparison.better.iter().map(|line| format!("better: {line}")));
        lines.push(format!("{} rows, {} findings", now.rows.len(), comparison.worse.len()));
        say(&lines.join("\n"))?;
    }
    if comparison.worse.is_empty() { Ok(()) } else { Err(Failure::Said) }
}

/// A line for each row with a fault, and where the page is.
fn summary(report: &report::Report, options: &Options) -> String {
    let mut lines: Vec<String> = report.fits.iter().flat_map(fit_lines).collect();
    let mut rows: usize = report.fits.iter().map(|fits| fits.rows.len()).sum();
    for results in &report.experiments {
        for row in &results.rows {
            rows += 1;
            let verdict = &row.verdict;
            let faults = [
                ("NaN", &verdict.nan),
                ("infinite", &verdict.infinite),
                ("negative", &verdict.negative),
                ("discontinuous", &verdict.discontinuous),
            ];
            for (what, fault) in faults.into_iter().filter(|(_, fault)| fault.count > 0) {
                let worst = fault.worst.as_ref().map_or(String::new(), |worst| {
                    format!(", {} instead of {} at {}", worst.got, worst.expected, worst.input)
                });
                lines.push(format!("{}: {}: {what}: {}{worst}", results.name, row.label, fault.count));
            }
        }
    }
    for agreement in report.agreement.iter().filter(|a| a.outside > 0) {
        lines.push(format!(
            "{}: {} results outside of what WGSL allows",
            agreement.module, agreement.outside
        ));
    }
    lines.extend(report.without.iter().map(|(name, why)| format!("{name}: no row: {why}")));
    if options.accept.is_none() {
        lines.push(format!("{rows} rows: {}", options.output.join("report.html").display()));
    } else {
        lines.push(format!("{rows} rows"));
    }
    lines.join("\n")
}

/// A line for each model, the best first, and why others have none.
fn fit_lines(fits: &report::data::Fits) -> Vec<String> {
    let row = |row: &report::data::Fit| {
        let errors = &row.errors;
        let figures = [errors.rms, errors.p95, errors.max].map(report::write::number);
        let [rms, p95, max] = figures;
        format!("{}: RMS {rms}, p95 {p95}, max {max}: {}", row.label, report::write::parameters(row))
    };
    let without = fits.without.iter().map(|(name, why)| format!("{name}: no fit: {why}"));
    fits.rows.iter().map(row).chain(without).collect()
}

/// Finished rows in a folder.
struct Kept {
    folder: Option<PathBuf>,
}

impl Done for Kept {
    fn get(&self, key: &str) -> Option<String> {
        std::fs::read_to_string(self.folder.as_ref()?.join(format!("{key}.json"))).ok()
    }

    fn put(&self, key: &str, row: &str) -> std::io::Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        std::fs::create_dir_all(folder)?;
        // Renamed into place: what is there is whole.
        let mut file = tempfile::NamedTempFile::new_in(folder)?;
        std::io::Write::write_all(&mut file, row.as_bytes())?;
        file.persist(folder.join(format!("{key}.json"))).map_err(|error| error.error)?;
        Ok(())
    }
}

/// RFC 3339, UTC, to the second.
fn now() -> String {
    humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string()
}
