//! `table`: the numbers that fill a module's buffer.

use std::path::{Path, PathBuf};

use clap::Args;
use shadewright::compiler::Module;
use shadewright::compiler::diagnostics::{Diagnostic, codes};
use shadewright::compiler::manifest::ResourceKind;
use shadewright::runtime::data::{PLAIN, decode, read};

use super::Context;
use super::failure::Failure;
use super::output::Outputs;

/// Options of `table`.
#[derive(Args)]
pub struct Options {
    /// Name, or CATEGORY/NAME
    module: String,
    /// Name of the resource
    resource: String,
    /// A file of the resource's format, in place of the module's own
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    /// Computes the module's own table anew
    #[arg(long, conflicts_with = "file")]
    make: bool,
    /// Where to, instead of standard output
    #[arg(short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// # Errors
/// There is no such module or resource, or no file that it can be filled with.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let module = context.catalog.module(&options.module)?;
    let numbers = numbers(module, options)?;
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let mut outputs = Outputs::default();
    outputs.stage(options.output.as_deref().unwrap_or(Path::new("-")), &bytes)?;
    outputs.commit()
}

fn numbers(module: &Module, options: &Options) -> Result<Vec<f32>, Failure> {
    let resources = &module.manifest.resources;
    let Some(ResourceKind::Data { file, format }) = resources.get(&options.resource).map(|r| &r.kind) else {
        let known = resources.iter().filter(|(_, r)| matches!(r.kind, ResourceKind::Data { .. }));
        let message = format!("`{}` has no table `{}`", module.name, options.resource);
        let found =
            Diagnostic::new(codes::UNKNOWN_FILE, message).suggest(&options.resource, "tables", known.map(|(name, _)| name.as_str()));
        return Err(shadewright::compiler::Report::from(found).into());
    };
    let plain = format.as_deref().unwrap_or(PLAIN);
    let wrong = |file: &str, why: &dyn std::fmt::Display| Failure::message(format!("{file}: {why}"));
    if options.make {
        let folder = format!("{}/{}", module.category, module.name);
        let Some(make) = shadewright::modules::oracles::table(&folder, &options.resource) else {
            let message = format!("`{folder}` has no `table.rs` that computes `{}`", options.resource);
            return Err(Failure::message(message));
        };
        return Ok(make());
    }
    if let Some(file) = &options.file {
        if format.is_none() {
            let message = format!(
                "`{}.{}` is the module's own table: it takes no other file",
                module.name, options.resource
            );
            return Err(Failure::Usage(message));
        }
        return read(file, plain).map_err(|error| wrong(&file.display().to_string(), &error));
    }
    match (file, module.data.get(&options.resource)) {
        (Some(file), Some(bytes)) => decode(plain, bytes).map_err(|error| wrong(file, &error)),
        _ => Err(Failure::message(format!(
            "`{}.{}` has no file of its own: name one of the format `{plain}` with --file",
            module.name, options.resource
        ))),
    }
}
