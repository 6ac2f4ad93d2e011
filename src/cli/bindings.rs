//! `bindings`: Rust for a renderer of one's own.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;
use shadewright::compiler::host::{Pass, module_name, rust};
use shadewright::compiler::{Catalog, Program, Recipe, Report};

use super::failure::Failure;
use super::output::{Outputs, json};
use super::{Context, Format, input, tree};

/// Options of `bindings`.
#[derive(Args)]
pub struct Options {
    /// Files, inline RON trees, module names, or - for standard input
    #[arg(required = true, value_name = "RECIPE")]
    recipes: Vec<String>,
    /// Which pass: the root's own (main), INSTANCE.PASS, or all for the root's own and every pass that must run before it. May be
    /// given several times
    #[arg(long = "pass", value_name = "P", default_value = "main")]
    passes: Vec<String>,
    /// Where to, instead of standard output
    #[arg(short, value_name = "FILE.rs")]
    output: Option<PathBuf>,
    /// Make a parameter a constant, in every recipe: `param=value`, or `slot.slot.param=value` for a module further down the tree
    #[arg(long, value_name = "K=V")]
    freeze: Vec<String>,
}

/// # Errors
/// A recipe is wrong, a pass has something that wgpu has no word for, two passes have one name, or the file cannot be written.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let mut programs = Vec::new();
    for typed in &options.recipes {
        let mut recipe = input::recipe(typed)?;
        for freeze in &options.freeze {
            tree::freeze(&context.catalog, &mut recipe.root, freeze)?;
        }
        let name = name_of(typed, &recipe);
        for pass in &options.passes {
            for program in compile(&context.catalog, &recipe, pass)? {
                programs.push((module_name(&name, &program.reflection().pass), program));
            }
        }
    }
    let mut names: Vec<&str> = programs.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(Failure::Usage(format!(
            "two passes would be the module `{}`: give their recipes files of different names",
            pair[0]
        )));
    }
    let passes: Vec<Pass> = programs.iter().map(|(name, program)| Pass::new(name, program)).collect();
    let text = rust(&passes)?;
    let text = match context.format {
        Format::Text => text,
        Format::Json => {
            let modules: Vec<_> = programs
                .iter()
                .map(|(name, program)| json!({"module": name, "pass": program.reflection().pass, "hash": program.reflection().hash}))
                .collect();
            json(&json!({"modules": modules, "text": text}))? + "\n"
        }
    };
    let mut outputs = Outputs::default();
    outputs.stage(options.output.as_deref().unwrap_or(Path::new("-")), text.as_bytes())?;
    outputs.commit()
}

fn compile(catalog: &Catalog, recipe: &Recipe, pass: &str) -> Result<Vec<Program>, Report> {
    match pass {
        "all" => catalog.compile_all(recipe),
        _ => Ok(vec![catalog.compile(recipe, pass)?]),
    }
}

/// What a recipe is called: its file's name up to the first dot, or its root.
fn name_of(typed: &str, recipe: &Recipe) -> String {
    let file = Path::new(&recipe.source.name).file_name().filter(|_| recipe.source.name == typed);
    let root = recipe.root.module.rsplit('/').next().unwrap_or_default();
    let stem = file.and_then(|name| name.to_str()).and_then(|name| name.split('.').next());
    stem.filter(|stem| !stem.is_empty() && typed != "-").unwrap_or(root).to_owned()
}
