//! `why`: what brought something into a shader.

use clap::Args;
use shadewright::compiler::reflect::Fill;
use shadewright::compiler::{Program, Recipe};

use super::failure::Failure;
use super::output::{say, say_json};
use super::text::nearest;
use super::{Context, Format, input};

/// Options of `why`.
#[derive(Args)]
pub struct Options {
    /// File, inline RON tree, module name, or - for standard input
    recipe: String,
    /// Function, binding, parameter, override, struct or constant, by its emitted name or its author's
    name: String,
    /// Which pass: the root's own, or INSTANCE.PASS for one that a module of the tree declares
    #[arg(long, default_value = "main")]
    pass: String,
}

/// # Errors
/// The recipe is wrong, or the shader has nothing of that name.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let recipe: Recipe = input::recipe(&options.recipe)?;
    let program = context.catalog.compile(&recipe, &options.pass)?;
    let mut reasons = program.why(&options.name);
    if reasons.is_empty() {
        reasons = emitted(&program, &options.name).iter().flat_map(|name| program.why(name)).collect();
    }
    if reasons.is_empty() {
        let near = nearest(&options.name, names(&program));
        let (name, pass) = (&options.name, &options.pass);
        return Err(Failure::message(format!("`{name}` is not in the shader of pass `{pass}`{near}")));
    }
    if context.format == Format::Json {
        return say_json(&reasons);
    }
    let mut text = String::new();
    for reason in &reasons {
        text.push_str(&format!("{} {}\n", reason.kind, reason.name));
        text.push_str(&format!("  of       {} at {}\n", reason.module, reason.place));
        text.push_str(&format!("  needed   {}\n", reason.path.join(" -> ")));
        text.push_str(&format!("  because  {}\n", reason.because));
    }
    say(&text)
}

/// Emitted names of what its authors call by this name.
fn emitted(program: &Program, name: &str) -> Vec<String> {
    let reflection = program.reflection();
    let functions = reflection.functions.iter().filter(|function| function.source == name);
    let bindings = reflection
        .bindings
        .iter()
        .filter(|binding| matches!(&binding.fill, Fill::Resource { resource, .. } if resource == name));
    functions
        .map(|function| function.name.clone())
        .chain(bindings.map(|binding| binding.name.clone()))
        .collect()
}

/// Everything that can be asked for, nearly: what reflection names.
fn names(program: &Program) -> Vec<&str> {
    let reflection = program.reflection();
    let functions = reflection.functions.iter().map(|function| function.name.as_str());
    let bindings = reflection.bindings.iter().map(|binding| binding.name.as_str());
    let params = reflection.params.iter().map(|param| param.name.as_str());
    let overrides = reflection.overrides.iter().map(|value| value.name.as_str());
    functions.chain(bindings).chain(params).chain(overrides).collect()
}
