//! Experiments: what is compared, over which configurations, with what truth. They are data of the library.
//!
//! `CATEGORY/CATEGORY.experiment.ron` compares the modules of a category, `CATEGORY/MODULE/MODULE.experiment.ron` says what only
//! that module needs. Each holds a list of [`Declared`] experiments.

mod check;
mod domain;
mod format;

use std::sync::Arc;

use indexmap::IndexMap;
use shadewright_compiler::diagnostics::{Diagnostic, codes};
use shadewright_compiler::manifest::{Node, parse};
use shadewright_compiler::{Catalog, Library, Module, Recipe, Report};

pub use domain::{Axis, Domain};
pub use format::{Alternatives, Declared, Hard, Metric, Params, Range, TruthSource};

/// Longest list that a block of hard configurations is multiplied out to, and most configurations.
pub const MOST_CONFIGURATIONS: usize = 1 << 20;

/// An experiment of a library.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Unique name: the folder, and the experiment's own name where it has one.
    pub name: String,
    /// The folder, `category` or `category/module`.
    pub folder: String,
    /// Category whose modules are compared.
    pub category: String,
    /// Function of its interface.
    pub function: String,
    /// As written.
    pub declared: Declared,
    /// What is compared, in the order of the rows.
    pub alternatives: Vec<Alternative>,
}

/// A recipe in an experiment.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// Its name there.
    pub label: String,
    /// The recipe.
    pub recipe: Recipe,
    /// Its root.
    pub root: Arc<Module>,
}

/// All experiments of a library, in the order of categories; of one category its own before those of its modules.
///
/// # Errors
/// A file cannot be read, is no list of experiments, or an experiment says something that cannot be.
pub fn load(library: &dyn Library, catalog: &Catalog) -> Result<Vec<Experiment>, Report> {
    let mut found = Vec::new();
    let mut errors = Vec::new();
    for category in catalog.categories() {
        let modules = catalog.modules().filter(|module| module.category == category.name);
        let folders = modules.map(|module| (format!("{}/{}", category.name, module.name), module.name.as_str()));
        for (folder, name) in std::iter::once((category.name.clone(), category.name.as_str())).chain(folders) {
            match of_folder(library, catalog, &category.name, &folder, name) {
                Ok(experiments) => found.extend(experiments),
                Err(report) => errors.extend(report.diagnostics),
            }
        }
    }
    Report::unless_empty(errors)?;
    leave_to_their_own(&mut found);
    Ok(found)
}

/// Takes modules out of their category's experiments about a function for which they have experiments in their own folders.
fn leave_to_their_own(experiments: &mut [Experiment]) {
    let own: Vec<(String, String)> = experiments.iter().map(|e| (e.folder.clone(), e.function.clone())).collect();
    for experiment in experiments
        .iter_mut()
        .filter(|e| e.folder == e.category && matches!(e.declared.alternatives, Alternatives::All))
    {
        let function = &experiment.function;
        experiment.alternatives.retain(|alternative| {
            let folder = format!("{}/{}", alternative.root.category, alternative.root.name);
            !own.contains(&(folder, function.clone()))
        });
    }
}

/// Reads the experiments of one folder; none where it has no file.
fn of_folder(library: &dyn Library, catalog: &Catalog, category: &str, folder: &str, name: &str) -> Result<Vec<Experiment>, Report> {
    let path = format!("{folder}/{name}.experiment.ron");
    let Some(text) = library.file(&path)? else {
        return Ok(Vec::new());
    };
    read(catalog, category, folder, &path, &text.text)
}

/// Reads a file's experiments.
///
/// # Errors
/// The text is no list of experiments, or one says something that cannot be.
pub fn read(catalog: &Catalog, category: &str, folder: &str, path: &str, text: &str) -> Result<Vec<Experiment>, Report> {
    let parsed = parse::<Vec<Declared>>(path, text)?;
    let functions = catalog.functions(category)?;
    let mut checker = check::Checker {
        parsed: &parsed,
        functions: &functions,
        category,
        errors: Vec::new(),
    };
    let mut experiments: Vec<Experiment> = Vec::new();
    for (index, declared) in parsed.value.iter().enumerate() {
        let name = if declared.name.is_empty() {
            folder.to_owned()
        } else {
            format!("{folder}/{}", declared.name)
        };
        checker.unique(index, &name, experiments.iter().map(|e| e.name.as_str()));
        let function = checker.function(index, declared);
        let alternatives = alternatives(catalog, category, folder, declared, |report| checker.adopt(index, report));
        checker.experiment(index, declared, function.as_deref(), &alternatives);
        let Some(function) = function else { continue };
        if let Some(signature) = catalog.signature(category, &function)? {
            checker.arguments(index, declared, &signature);
        }
        experiments.push(Experiment {
            name,
            folder: folder.to_owned(),
            category: category.to_owned(),
            function,
            declared: declared.clone(),
            alternatives,
        });
    }
    Report::unless_empty(checker.errors)?;
    Ok(experiments)
}

fn alternatives(catalog: &Catalog, category: &str, folder: &str, declared: &Declared, mut fail: impl FnMut(Report)) -> Vec<Alternative> {
    let nodes: IndexMap<String, Node> = match &declared.alternatives {
        Alternatives::Of(nodes) => nodes.clone(),
        Alternatives::All => {
            let fits = catalog.modules().filter(|module| module.category == category);
            let own = folder.split_once('/').map(|(_, name)| name);
            fits.filter(|module| own.is_none_or(|own| own == module.name))
                .map(|module| (module.name.clone(), Node::new(format!("{category}/{}", module.name))))
                .collect()
        }
    };
    let mut found = Vec::new();
    for (label, mut node) in nodes {
        // As in a slot: modules of other categories may have the same name.
        let qualified = format!("{category}/{}", node.module);
        if catalog.module(&qualified).is_ok() {
            node.module = qualified;
        }
        let recipe = Recipe::from(node);
        match catalog.module(&recipe.root.module) {
            Ok(root) if root.category == category => {
                let root = Arc::clone(root);
                found.push(Alternative { label, recipe, root });
            }
            Ok(root) => fail(
                Diagnostic::new(
                    codes::EXPERIMENT_INVALID,
                    format!("`{label}` is a module of `{}`, not of `{category}`", root.category),
                )
                .into(),
            ),
            Err(report) => fail(report),
        }
    }
    found
}
