//! `check`: modules, recipes, spaces and scenes; everything that can be known to be wrong without a GPU.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use serde_json::{Value as Json, json};
use shadewright::compiler::diagnostics::codes;
use shadewright::compiler::manifest::{Arity, Filling, Node};
use shadewright::compiler::{Module, Recipe, Report};

use super::failure::Failure;
use super::output::{say, say_json};
use super::{Context, Format, input};

/// Options of `check`.
#[derive(Args)]
pub struct Options {
    /// Folders of modules, recipes (*.recipe.ron), spaces (*.space.ron), scenes (*.scene.ron), or - for a recipe from standard input; all modules where nothing is said
    paths: Vec<PathBuf>,
}

/// One thing to check.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Thing {
    /// `category/name`
    Module(String),
    Recipe(PathBuf),
    Space(PathBuf),
    Scene(PathBuf),
}

/// # Errors
/// Something is wrong; all of it has been said.
pub fn run(modules: &[PathBuf], format: Format, options: &Options) -> Result<(), Failure> {
    let mut folders = modules.to_vec();
    let mut things = BTreeSet::new();
    for path in &options.paths {
        sort_out(path, &mut folders, &mut things)?;
    }
    let context = Context::new(&folders, format)?;
    if options.paths.is_empty() {
        things.extend(
            context
                .catalog
                .modules()
                .map(|module| Thing::Module(format!("{}/{}", module.category, module.name))),
        );
    }
    let mut results = Vec::new();
    let mut failed = false;
    for thing in &things {
        let (kind, name) = match thing {
            Thing::Module(name) => ("module", name.clone()),
            Thing::Recipe(path) => ("recipe", path.display().to_string()),
            Thing::Space(path) => ("space", path.display().to_string()),
            Thing::Scene(path) => ("scene", path.display().to_string()),
        };
        let result = check(&context, thing);
        failed |= result.is_err();
        match format {
            Format::Json => results.push(json!({"kind": kind, "name": name, "ok": result.is_ok(), "diagnostics": diagnostics(&result)})),
            Format::Text => {
                say(&format!("{:<6} {kind} {name}", if result.is_ok() { "ok" } else { "wrong" }))?;
                if let Err(failure) = result {
                    failure.say(format);
                }
            }
        }
    }
    if format == Format::Json {
        say_json(&results)?;
    }
    if failed { Err(Failure::Said) } else { Ok(()) }
}

fn diagnostics(result: &Result<(), Failure>) -> Json {
    match result {
        Ok(()) => json!([]),
        Err(Failure::Input(report)) => report.to_json(),
        Err(other) => json!([{"message": other.text()}]),
    }
}

/// What a path asks to be checked, and which folder must be in the library for it.
fn sort_out(path: &Path, folders: &mut Vec<PathBuf>, things: &mut BTreeSet<Thing>) -> Result<(), Failure> {
    if path == Path::new("-") {
        things.insert(Thing::Recipe(path.to_path_buf()));
        return Ok(());
    }
    let wrong = |error: std::io::Error| Failure::message(format!("{}: {error}", path.display()));
    let whole = path.canonicalize().map_err(wrong)?;
    if !whole.is_dir() {
        let name = path.to_string_lossy();
        let thing = if name.ends_with(".scene.ron") {
            Thing::Scene
        } else if name.ends_with(".space.ron") {
            Thing::Space
        } else {
            Thing::Recipe
        };
        things.insert(thing(path.to_path_buf()));
        return Ok(());
    }
    let depth = if whole.join("module.ron").is_file() {
        2
    } else if whole.join("category.ron").is_file() || has_modules(&whole) {
        1
    } else {
        0
    };
    let Some(root) = whole.ancestors().nth(depth).map(Path::to_path_buf) else {
        return Err(Failure::message(format!("{}: is in no CATEGORY folder", path.display())));
    };
    let before = things.len();
    for category in subfolders(&root) {
        for module in subfolders(&category) {
            if module.starts_with(&whole) && module.join("module.ron").is_file() {
                let name = module.strip_prefix(&root).unwrap_or(&module).to_string_lossy().replace('\\', "/");
                things.insert(Thing::Module(name));
            }
        }
    }
    if things.len() == before && !whole.join("category.ron").is_file() {
        return Err(Failure::message(format!(
            "{}: holds no module, that is no CATEGORY/NAME/module.ron",
            path.display()
        )));
    }
    if !folders.contains(&root) {
        folders.push(root);
    }
    Ok(())
}

fn has_modules(folder: &Path) -> bool {
    subfolders(folder).iter().any(|module| module.join("module.ron").is_file())
}

fn subfolders(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut folders: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
    folders.sort();
    folders
}

fn check(context: &Context, thing: &Thing) -> Result<(), Failure> {
    match thing {
        Thing::Module(name) => {
            context.catalog.check_module(name)?;
            let module = Arc::clone(context.catalog.module(name)?);
            tree(context, &Recipe::from(alone(context, &module, 0)?))?;
            cases(context, name)
        }
        Thing::Recipe(path) => tree(context, &Recipe::parse(&path.to_string_lossy(), &input::text(path)?)?),
        Thing::Space(path) => super::permutations::check_space(context, path),
        Thing::Scene(path) => super::render::check(context, path),
    }
}

/// Reads the table of a module's expected values, where it has one; what they are worth only a GPU can tell.
fn cases(context: &Context, module: &str) -> Result<(), Failure> {
    let path = format!("{module}/cases.ron");
    let wrong = |why: String| Failure::message(format!("{path}: {why}"));
    match context.library.read(&path).map_err(wrong)? {
        Some(text) => shadewright::modules::cases::parse(&text).map(|_| ()).map_err(wrong),
        None => Ok(()),
    }
}

/// Compiles all that a tree can be asked for: the root's entry points, or each function of its interface, and every pass.
pub fn tree(context: &Context, recipe: &Recipe) -> Result<(), Failure> {
    let root = context.catalog.module(&recipe.root.module)?;
    let functions = context.catalog.functions(&root.category)?;
    let mut passes = BTreeSet::new();
    let mut note = |program: &shadewright::compiler::Program| {
        let declared = program.reflection().passes.iter();
        passes.extend(declared.map(|pass| format!("{}.{}", pass.instance, pass.name)));
    };
    if functions.is_empty() {
        note(&context.catalog.compile(recipe, super::tree::ROOT)?);
    }
    for function in functions.keys() {
        match context.catalog.compile_probe(recipe, function) {
            Ok(program) => note(&program),
            Err(report) if no_probe(&report) => {}
            Err(report) => return Err(report.into()),
        }
    }
    for pass in &passes {
        context.catalog.compile(recipe, pass)?;
    }
    Ok(())
}

/// Links a tree once, so that what is wrong with it is said with its place.
///
/// # Errors
/// That.
pub fn links(context: &Context, recipe: &Recipe) -> Result<(), Failure> {
    let root = context.catalog.module(&recipe.root.module)?;
    let functions = context.catalog.functions(&root.category)?;
    if functions.is_empty() {
        context.catalog.compile(recipe, super::tree::ROOT)?;
    }
    for function in functions.keys() {
        match context.catalog.compile_probe(recipe, function) {
            Err(report) if no_probe(&report) => {}
            linked => return Ok(linked.map(|_| ())?),
        }
    }
    Ok(())
}

/// A function that links but that no probe can call: it takes screen-space derivatives (any `textureSample`), which only fragments have, or a pointer, which
/// no table of inputs holds.
fn no_probe(report: &Report) -> bool {
    let codes = [codes::WRONG_STAGE, codes::UNKNOWN_PROBE];
    report.diagnostics.iter().all(|diagnostic| codes.contains(&diagnostic.code))
}

/// A module with its slots' defaults; slots that need a module and have no default get the first that fits.
fn alone(context: &Context, module: &Module, depth: usize) -> Result<Node, Failure> {
    let mut node = Node::new(format!("{}/{}", module.category, module.name));
    for (name, slot) in &module.manifest.slots {
        if slot.arity != Arity::Single || slot.default.is_some() || depth > 8 {
            continue;
        }
        // None fits: the compiler says so.
        if let Some(first) = context.catalog.modules().find(|known| known.category == slot.interface) {
            node.fill.insert(name.clone(), Filling::One(alone(context, first, depth + 1)?));
        }
    }
    Ok(node)
}
