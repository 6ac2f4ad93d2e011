//! What can be typed, and which file does it.

mod bindings;
mod check;
mod diff;
mod emit;
pub mod failure;
mod graph;
mod input;
mod list;
mod needs;
mod new;
mod output;
mod permutations;
mod probe;
mod render;
mod report;
mod sheet;
mod show;
mod table;
mod text;
mod timings;
mod tree;
mod watch;
mod why;

use std::path::PathBuf;
use std::sync::Arc;

use clap::{Parser, Subcommand, ValueEnum};
use shadewright::compiler;
use shadewright::modules::{self, Folder, Overlay};

use failure::Failure;

/// Composes shaders: links WGSL modules into exactly the permutation that is wanted.
#[derive(Parser)]
#[command(name = "shadewright", version, after_help = EXIT_STATUS)]
pub struct Arguments {
    /// Folder of modules, laid out as CATEGORY/NAME, that stands over the standard library. May be given several times; the last wins
    #[arg(long, global = true, value_name = "DIR")]
    modules: Vec<PathBuf>,
    /// How results and errors are written
    #[arg(long, global = true, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    #[command(subcommand)]
    command: Command,
}

const EXIT_STATUS: &str = "\
A RECIPE is a file, an inline RON tree such as '(module: \"microfacet\", fill: {\"ndf\": \"ggx\"})', a module's name, or - for standard input.
Exit status: 0 done, 1 the input is wrong, 2 usage, 3 no usable GPU, 70 a bug of ours, 130 interrupted.";

/// How results and errors are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people.
    Text,
    /// For programs.
    Json,
}

#[derive(Subcommand)]
enum Command {
    /// Shows what modules there are
    List(list::Options),
    /// Shows everything that a module says of itself
    Show(show::Options),
    /// Finds everything that can be known to be wrong without a GPU
    Check(check::Options),
    /// Writes the shader of a recipe, and its binding layout
    Emit(emit::Options),
    /// Writes Rust for a renderer of one's own: structs, bind groups, pipelines
    Bindings(bindings::Options),
    /// Shows the tree of a recipe, defaults written out
    Graph(graph::Options),
    /// Says why a function, binding, parameter or struct is in the shader
    Why(why::Options),
    /// Says what changes from one recipe to another, and which choice did it
    Diff(diff::Options),
    /// Counts, lists, checks or writes the permutations of a space
    Permutations(permutations::Options),
    /// Draws a scene into a PNG (displayed) or EXR (linear, cd/m2) file
    Render(render::Options),
    /// Draws a scene with every choice of a space into one picture (*.png), labelled
    Sheet(sheet::Options),
    /// Evaluates an interface function on the GPU over a table of inputs
    Probe(probe::Options),
    /// Compares modules: speed against error, over experiments that the library declares
    Report(report::Options),
    /// Writes the numbers that fill a module's buffer, as little-endian 32-bit floats
    Table(table::Options),
    /// Makes the skeleton of a module's folder
    New(new::Options),
}

/// What all commands share.
pub struct Context {
    /// Standard library, with the folders of `--modules` over it.
    pub library: Arc<dyn compiler::Library>,
    /// Its manifests.
    pub catalog: Arc<compiler::Catalog>,
    /// How to write.
    pub format: Format,
}

impl Context {
    fn new(folders: &[PathBuf], format: Format) -> Result<Self, Failure> {
        for folder in folders {
            if !folder.is_dir() {
                return Err(Failure::message(format!("--modules {}: there is no such folder", folder.display())));
            }
        }
        let mut layers: Vec<Arc<dyn compiler::Library>> = Vec::new();
        for folder in folders.iter().rev() {
            let folder = Folder::new(folder);
            #[cfg(feature = "wesl")]
            let folder = modules::Wesl(folder);
            layers.push(Arc::new(folder));
        }
        layers.push(modules::library());
        let library: Arc<dyn compiler::Library> = Arc::new(Overlay(layers));
        let catalog = Arc::new(compiler::Catalog::load(Arc::clone(&library))?);
        Ok(Self { library, catalog, format })
    }
}

/// Does what was typed.
///
/// # Errors
/// See [`Failure`]; each is one exit status.
pub fn run(arguments: Arguments) -> Result<(), Failure> {
    let context = |folders: &[PathBuf]| Context::new(folders, arguments.format);
    match arguments.command {
        // These two bring folders of their own into the library.
        Command::Check(options) => check::run(&arguments.modules, arguments.format, &options),
        Command::New(options) => new::run(&arguments.modules, arguments.format, &options),
        Command::List(options) => list::run(&context(&arguments.modules)?, &options),
        Command::Show(options) => show::run(&context(&arguments.modules)?, &options),
        Command::Emit(options) => emit::run(&context(&arguments.modules)?, &options),
        Command::Bindings(options) => bindings::run(&context(&arguments.modules)?, &options),
        Command::Graph(options) => graph::run(&context(&arguments.modules)?, &options),
        Command::Why(options) => why::run(&context(&arguments.modules)?, &options),
        Command::Diff(options) => diff::run(&context(&arguments.modules)?, &options),
        Command::Permutations(options) => permutations::run(&context(&arguments.modules)?, &options),
        Command::Render(options) => render::run(context(&arguments.modules)?, &options),
        Command::Sheet(options) => sheet::run(context(&arguments.modules)?, &options),
        Command::Report(options) => report::run(&context(&arguments.modules)?, &options),
        Command::Table(options) => table::run(&context(&arguments.modules)?, &options),
        Command::Probe(options) => probe::run(&context(&arguments.modules)?, &options),
    }
}
