//! Reading the manifests of a library.

use std::collections::HashMap;
use std::sync::Arc;

use indexmap::IndexMap;

use super::{Category, Module, Variants};
use crate::data::numbers;
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::library::{Library, unreadable};
use crate::manifest::{ModuleManifest, Parsed, ResourceKind, Step, check_category, check_module, parse_category, parse_module};

/// What a library declares.
pub struct Declared {
    /// In the order in which lists show them.
    pub categories: IndexMap<String, Arc<Category>>,
    /// Sorted by category order and name.
    pub modules: Vec<Arc<Module>>,
}

/// Reads all manifests of a library.
///
/// # Errors
/// A manifest is no RON, or says something that cannot be.
pub fn declared(library: &dyn Library) -> Result<Declared, Report> {
    let mut categories = Vec::new();
    let mut modules = Vec::new();
    let mut found = Vec::new();
    for name in sorted(library.folders("")) {
        let path = format!("{name}/category.ron");
        let Some(text) = read(library, &path)? else {
            found.extend(stray_module(library, &name)?);
            continue;
        };
        match parse_category(&path, &text) {
            Ok(parsed) => {
                if let Err(report) = check_category(&parsed) {
                    found.extend(report.diagnostics);
                }
                modules.extend(load_modules(library, &name, &mut found)?);
                categories.push(Arc::new(Category {
                    name,
                    manifest: parsed.value,
                    source: parsed.file,
                }));
            }
            Err(report) => found.extend(report.diagnostics),
        }
    }
    Report::unless_empty(found)?;
    categories.sort_by(|a, b| (a.manifest.order, &a.name).cmp(&(b.manifest.order, &b.name)));
    let order: HashMap<&str, usize> = categories.iter().enumerate().map(|(i, c)| (c.name.as_str(), i)).collect();
    modules.sort_by(|a: &Arc<Module>, b| (order.get(a.category.as_str()), &a.name).cmp(&(order.get(b.category.as_str()), &b.name)));
    Ok(Declared {
        categories: categories.into_iter().map(|c| (c.name.clone(), c)).collect(),
        modules,
    })
}

fn load_modules(library: &dyn Library, category: &str, found: &mut Vec<Diagnostic>) -> Result<Vec<Arc<Module>>, Report> {
    let mut modules = Vec::new();
    for name in sorted(library.folders(category)) {
        let path = format!("{category}/{name}/module.ron");
        let Some(text) = read(library, &path)? else {
            found.push(
                Diagnostic::new(
                    codes::MISSING_MANIFEST,
                    format!("the folder `{category}/{name}` has no `module.ron`"),
                )
                .note("a folder in a category is a module"),
            );
            continue;
        };
        match parse_module(&path, &text) {
            Ok(parsed) => {
                let data = match check_module(&parsed) {
                    Ok(()) => data(library, &parsed, &format!("{category}/{name}"), found),
                    Err(report) => {
                        found.extend(report.diagnostics);
                        IndexMap::new()
                    }
                };
                modules.push(Arc::new(Module {
                    name,
                    category: category.to_owned(),
                    manifest: parsed.value,
                    source: parsed.file,
                    data,
                    variants: Variants::default(),
                }));
            }
            Err(report) => found.extend(report.diagnostics),
        }
    }
    Ok(modules)
}

/// Bytes of the files that a module's resources name; those without a format are numbers.
fn data(library: &dyn Library, parsed: &Parsed<ModuleManifest>, folder: &str, found: &mut Vec<Diagnostic>) -> IndexMap<String, Arc<[u8]>> {
    let mut data = IndexMap::new();
    for (name, resource) in &parsed.value.resources {
        let ResourceKind::Data { file: Some(file), format } = &resource.kind else {
            continue;
        };
        let mut wrong = |code, message: String, label: String| {
            let path = [Step::Key("resources"), Step::Key(name), Step::Key("kind"), Step::Key("file")];
            found.push(parsed.error_at(&path, code, message, label));
        };
        let path = format!("{folder}/{file}");
        match library.bytes(&path) {
            Err(why) => wrong(
                codes::UNREADABLE_FILE,
                format!("`{path}` cannot be read: {why}"),
                "named here".to_owned(),
            ),
            Ok(None) => wrong(codes::MISSING_DATA, format!("`{path}` is not there"), "named here".to_owned()),
            Ok(Some(bytes)) => {
                if format.is_none()
                    && let Err(why) = numbers(&bytes)
                {
                    wrong(codes::BAD_DATA, format!("`{path}` is no table of numbers"), why);
                }
                data.insert(name.clone(), bytes.into());
            }
        }
    }
    data
}

/// The error about a folder that holds a module but is no category.
fn stray_module(library: &dyn Library, folder: &str) -> Result<Option<Diagnostic>, Report> {
    for name in sorted(library.folders(folder)) {
        if read(library, &format!("{folder}/{name}/module.ron"))?.is_some() {
            let message = format!("the folder `{folder}` holds the module `{name}`, but has no `category.ron`");
            return Ok(Some(Diagnostic::new(codes::MISSING_CATEGORY, message).note(
                "a folder with modules is a category: declare it, or move the module into one that is",
            )));
        }
    }
    Ok(None)
}

fn sorted(mut names: Vec<String>) -> Vec<String> {
    names.sort();
    names.dedup();
    names
}

pub fn read(library: &dyn Library, path: &str) -> Result<Option<String>, Report> {
    library.read(path).map_err(|why| unreadable(path, &why))
}
