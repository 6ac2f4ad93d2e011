//! Best fits of models to a table of measured reflectance.
//!
//! ```text
//! CATEGORY.fit.ron -> Declared: what is free beside a model's own parameters
//! model            -> Variables: its free numbers, each in its range          (free)
//! table            -> samples -> differences of a model from them            (compare)
//! both             -> least squares within the ranges -> Fit                  (solve)
//! ```
//!
//! A model is any recipe of the category: the fit evaluates the linked function on the CPU in double precision, and needs no code of its own for a
//! model. Differences are of `ln(1 + f cos)`, f the BRDF and cos that of the light's angle: Löw et al. 2012, BRDF Models for Accurate and Efficient
//! Rendering of Glossy Surfaces. Without a logarithm a glossy table is its peak alone.

mod compare;
mod free;
mod solve;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use indexmap::IndexMap;
use serde::Deserialize;
use shadewright_compiler::catalog::Signature;
use shadewright_compiler::diagnostics::{Diagnostic, codes};
use shadewright_compiler::manifest::{Node, Parsed, ResourceKind, Step, parse};
use shadewright_compiler::reflect::{Binding, Fill};
use shadewright_compiler::{Catalog, Library, Module, Recipe, Report};
use shadewright_runtime::measured::Measured;
use shadewright_runtime::probe::Probe;

use crate::data::{Fit, Fits};
use crate::measure::{MeasureError, one_line};
use compare::Comparison;
use free::Variables;

/// Farthest that a direction may be from the normal, degrees: beyond it measurements are extrapolated (Ngan et al. 2005, Experimental Analysis of BRDF
/// Models, leave out the same).
const MOST_DEGREES: f64 = 80.0;

/// An RMS error as good as none: tables hold 32-bit numbers.
const ROUNDING: f64 = 1e-6;

/// `CATEGORY/CATEGORY.fit.ron` as written: how the category's models are held against a table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Declared {
    /// Function of the interface that gives three channels for two directions.
    pub function: String,
    /// Its argument that is the direction to the viewer, the normal being +z.
    pub view: String,
    /// Its argument that is the direction to the light.
    pub light: String,
    /// What of its other arguments is free, by path: `s.alpha`, with the least and the largest value of each component. A range above 0 that spans more
    /// than three decades is searched evenly in the logarithm. A model's parameters have the ranges that it declares.
    pub free: IndexMap<String, (f64, f64)>,
}

/// A category's declaration.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The category.
    pub category: String,
    declared: Declared,
    signature: Signature,
}

/// Declarations of a library, in the order of categories.
///
/// # Errors
/// A file cannot be read, or says something that cannot be.
pub fn subjects(library: &dyn Library, catalog: &Catalog) -> Result<Vec<Subject>, Report> {
    let mut found = Vec::new();
    for category in catalog.categories() {
        let path = format!("{0}/{0}.fit.ron", category.name);
        if let Some(text) = library.file(&path)? {
            found.push(read(catalog, &category.name, &path, &text.text)?);
        }
    }
    Ok(found)
}

/// Reads a category's declaration.
///
/// # Errors
/// The text is none, or names what the interface does not have.
pub fn read(catalog: &Catalog, category: &str, path: &str, text: &str) -> Result<Subject, Report> {
    let parsed = parse::<Declared>(path, text)?;
    let declared = parsed.value.clone();
    let functions = catalog.functions(category)?;
    let Some(signature) = catalog.signature(category, &declared.function)? else {
        let message = format!("`{category}` has no function `{}`", declared.function);
        let known = functions.keys().map(String::as_str);
        let error = parsed.error_at(&[Step::Key("function")], codes::FIT_INVALID, message, "no such function");
        return Err(error.suggest(&declared.function, "functions", known).into());
    };
    let mut errors = Vec::new();
    for (key, name) in [("view", &declared.view), ("light", &declared.light)] {
        if free::components(signature.arguments.get(name).map_or("", String::as_str)) != Some(3) {
            let message = format!("`{}` has no argument `{name}` with three numbers", declared.function);
            errors.push(parsed.error_at(&[Step::Key(key)], codes::FIT_INVALID, message, "a direction is one"));
        }
    }
    errors.extend(wrong_ranges(&parsed, &signature));
    Report::unless_empty(errors)?;
    Ok(Subject {
        category: category.to_owned(),
        declared,
        signature,
    })
}

fn wrong_ranges(parsed: &Parsed<Declared>, signature: &Signature) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    for (path, (low, high)) in &parsed.value.free {
        let at = [Step::Key("free"), Step::Key(path)];
        if free::type_of(signature, path).and_then(free::components).is_none() {
            let message = format!("`{}` has no floats at `{path}`", parsed.value.function);
            errors.push(parsed.error_at(&at, codes::FIT_INVALID, message, "an argument's member, such as `s.alpha`"));
        } else if !(low < high && low.is_finite() && high.is_finite()) {
            let message = format!("the range of `{path}` holds nothing");
            errors.push(parsed.error_at(&at, codes::FIT_INVALID, message, "the least value, then the largest"));
        }
    }
    errors
}

/// How a fit is made.
pub struct FitOptions<'a> {
    /// A sample that a test has time for.
    pub quick: bool,
    /// Set to stop.
    pub cancel: &'a AtomicBool,
    /// Called with what is done next: steps done, all steps, and its name.
    pub progress: &'a dyn Fn(usize, usize, &str),
}

/// Fits models to a table: those given, by label, or all of the category. The best comes first.
///
/// A model that cannot be fitted is no row, but named under [`Fits::without`] with the reason.
///
/// # Errors
/// Somebody asked to stop, a model given is of another category, or the table holds nothing to compare with.
pub fn fit(
    catalog: &Catalog,
    subject: &Subject,
    models: IndexMap<String, Recipe>,
    (name, table): (&str, &Measured),
    options: &FitOptions,
) -> Result<Fits, MeasureError> {
    let is_all = models.is_empty();
    let models = if is_all { all(catalog, subject) } else { models };
    // Those to fit are among those to compare with: both are the first ones of one sequence.
    let (fitted, compared) = if options.quick { (192, 768) } else { (768, 6144) };
    let samples = table.samples(compared, MOST_DEGREES.to_radians());
    if samples.is_empty() {
        let message = format!("{name}: nothing was measured within {MOST_DEGREES} degrees of the normal");
        return Err(Report::from(Diagnostic::new(codes::MEASURED_DAMAGED, message)).into());
    }
    let mut fits = Fits {
        name: name.to_owned(),
        format: table.format().to_owned(),
        fitted: samples.len().min(fitted),
        compared: samples.len(),
        ..Fits::default()
    };
    for (done, (label, recipe)) in models.iter().enumerate() {
        (options.progress)(done, models.len(), label);
        let root = root(catalog, subject, recipe)?;
        let model = Comparison::new(catalog, subject, recipe, &samples);
        match model.and_then(|model| solve::best(&model, fits.fitted, options.cancel)) {
            Ok(found) => fits.rows.push(Fit {
                label: label.clone(),
                recipe: one_line(recipe),
                summary: root.manifest.summary.clone(),
                ..found
            }),
            Err(MeasureError::Interrupted) => return Err(MeasureError::Interrupted),
            // Who names a model wants to know why it has none.
            Err(error) if !is_all => return Err(error),
            Err(error) => {
                fits.without.insert(label.clone(), error.to_string().trim().to_owned());
            }
        }
    }
    rank(&mut fits.rows);
    Ok(fits)
}

/// Puts the best first, and marks what another beats. Errors that are the table's rounding are equal: among those the cheapest is best.
fn rank(rows: &mut [Fit]) {
    let place = |row: &Fit| (row.errors.rms.max(ROUNDING), row.executed.mean);
    rows.sort_by(|a, b| {
        let ((a_error, a_cost), (b_error, b_cost)) = (place(a), place(b));
        a_error
            .total_cmp(&b_error)
            .then(a_cost.total_cmp(&b_cost))
            .then_with(|| a.label.cmp(&b.label))
    });
    let places: Vec<(f64, f64)> = rows.iter().map(place).collect();
    for (row, (error, cost)) in rows.iter_mut().zip(&places) {
        row.dominated = places.iter().any(|(e, c)| e <= error && c <= cost && (e < error || c < cost));
    }
}

fn all(catalog: &Catalog, subject: &Subject) -> IndexMap<String, Recipe> {
    let fits = catalog.modules().filter(|module| module.category == subject.category);
    let recipe = |module: &Module| Recipe::from(Node::new(format!("{}/{}", subject.category, module.name)));
    fits.map(|module| (module.name.clone(), recipe(module))).collect()
}

fn root<'c>(catalog: &'c Catalog, subject: &Subject, recipe: &Recipe) -> Result<&'c Arc<Module>, MeasureError> {
    let root = catalog.module(&recipe.root.module)?;
    if root.category == subject.category {
        return Ok(root);
    }
    let message = format!("`{}` is a module of `{}`, not of `{}`", root.name, root.category, subject.category);
    Err(Report::from(Diagnostic::new(codes::FIT_INVALID, message)).into())
}

/// Why a linked model cannot be fitted, if so: it reads what a fit does not vary. A module's own tables are part of its formula.
fn unfit(probe: &Probe) -> Option<String> {
    let own = [probe.input(), probe.output()].map(|table| table.map(|(binding, _)| (binding.group, binding.binding)));
    let is_foreign = |binding: &&Binding| match &binding.fill {
        Fill::Resource {
            declared: ResourceKind::Data { format, .. },
            ..
        } => format.is_some(),
        Fill::Resource { .. } => !own.contains(&Some((binding.group, binding.binding))),
        _ => false,
    };
    let foreign = probe.program().reflection().bindings.iter().find(is_foreign);
    foreign.map(|binding| format!("reads `{}`, which a fit does not vary", binding.name))
}
