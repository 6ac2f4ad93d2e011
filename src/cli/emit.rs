//! `emit`: the shader of a recipe, and its binding layout.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::json;
use shadewright::compiler::{self, Program, Report, Target};

use super::failure::Failure;
use super::output::{Outputs, json};
use super::{Context, Format, input, tree};

/// Options of `emit`.
#[derive(Args)]
pub struct Options {
    /// File, inline RON tree, module name, or - for standard input
    recipe: String,
    /// Which pass: the root's own, or INSTANCE.PASS for one that a module of the tree declares
    #[arg(long, default_value = "main")]
    pass: String,
    /// Which language
    #[arg(long, value_enum, default_value_t = Language::Wgsl)]
    target: Language,
    /// Entry point, where the target holds one a file (glsl) and the pass has several
    #[arg(long, value_name = "NAME")]
    entry: Option<String>,
    /// Where to, instead of standard output
    #[arg(short, value_name = "PATH")]
    output: Option<PathBuf>,
    /// Also write the binding layout, as JSON
    #[arg(long, value_name = "FILE.json")]
    reflect: Option<PathBuf>,
    /// Make a parameter a constant: `param=value`, or `slot.slot.param=value` for a module further down the tree
    #[arg(long, value_name = "K=V")]
    freeze: Vec<String>,
}

/// Languages that a shader is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Language {
    /// The authors' own text, linked
    Wgsl,
    /// WGSL written from the linked IR
    WgslIr,
    /// SPIR-V 1.3, binary
    Spirv,
    /// GLSL, one entry point a file
    Glsl,
    /// HLSL, shader model 6.0
    Hlsl,
    /// Metal Shading Language 2.4
    Msl,
}

/// # Errors
/// The recipe is wrong, the target lacks something, or a file cannot be written.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let output = options.output.as_deref().unwrap_or(Path::new("-"));
    let to_stdout = output == Path::new("-");
    if to_stdout && options.reflect.as_deref() == Some(output) {
        return Err(Failure::Usage("shader and --reflect cannot both go to standard output".to_owned()));
    }
    let binary = options.target == Language::Spirv && context.format == Format::Text;
    if binary && to_stdout && std::io::stdout().is_terminal() {
        return Err(Failure::Usage(
            "SPIR-V is binary: name a file with -o, or take --format json".to_owned(),
        ));
    }
    let mut recipe = input::recipe(&options.recipe)?;
    for typed in &options.freeze {
        tree::freeze(&context.catalog, &mut recipe.root, typed)?;
    }
    let program = context.catalog.compile(&recipe, &options.pass)?;
    let shader = shader(&program, options.target, options.entry.as_deref())?;
    let shader = match context.format {
        Format::Text => shader,
        Format::Json => format!("{}\n", describe(&program, options.target, &shader)?).into_bytes(),
    };
    let mut outputs = Outputs::default();
    outputs.stage(output, &shader)?;
    if let Some(path) = &options.reflect {
        outputs.stage(path, format!("{}\n", json(program.reflection())?).as_bytes())?;
    }
    outputs.commit()
}

/// A program in a language.
///
/// # Errors
/// The language lacks something, or holds one entry point a file and none of several is named.
pub fn shader(program: &Program, language: Language, entry: Option<&str>) -> Result<Vec<u8>, Report> {
    let target = match language {
        Language::Wgsl => return Ok(program.wgsl().as_bytes().to_vec()),
        Language::WgslIr => Target::WgslFromIr,
        Language::Spirv => Target::SpirV,
        Language::Glsl => Target::Glsl,
        Language::Hlsl => Target::Hlsl,
        Language::Msl => Target::Msl,
    };
    compiler::emit(program.validated(), target, entry)
}

fn describe(program: &Program, target: Language, shader: &[u8]) -> Result<String, Failure> {
    let target_name = target.to_possible_value().map(|value| value.get_name().to_owned());
    let mut object = json!({"target": target_name, "pass": program.reflection().pass, "hash": program.reflection().hash});
    match target {
        Language::Spirv => {
            let (words, _) = shader.as_chunks::<4>();
            object["words"] = words.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
        }
        _ => object["text"] = String::from_utf8_lossy(shader).into(),
    }
    object["reflection"] =
        serde_json::to_value(program.reflection()).map_err(|error| Failure::message(format!("this has no JSON form: {error}")))?;
    json(&object)
}
