//! Rust for a host of its own: what a program that uses plain `wgpu` and `bytemuck` needs to run linked passes.
//!
//! One more writer, fed by [`Reflection`] and the text of the source form alone; it knows no GPU interface but by the names that it
//! writes. For each pass it makes a module with
//!
//! - a `#[repr(C)]` struct for everything that lies in a buffer, every gap an explicit field, every offset and size asserted when the
//!   host is compiled;
//! - layouts, a struct with a field for each resource of a bind group, the pipeline's layout and its constructors;
//! - the shader's text, its hash, and its entry points.
//!
//! The text is laid out as `rustfmt` would, but for names of more than 40 letters; equal input gives equal bytes, and it compiles without a warning under
//! `#![deny(warnings, missing_docs)]`. `spec/integration.md` says what stands where.

mod docs;
mod expr;
mod groups;
mod names;
mod pipelines;
mod structs;
mod text;

pub use names::module_name;

use std::collections::HashSet;

use crate::diagnostics::{Diagnostic, Report, codes};
use crate::program::Program;
use crate::reflect::Reflection;
use docs::Docs;
use names::Names;
use text::Text;

/// Version of `wgpu` that the written code is for.
pub const WGPU: &str = "30";

/// A pass to write.
#[derive(Clone, Copy, Debug)]
pub struct Pass<'a> {
    /// Name of the Rust module, see [`module_name`].
    pub module: &'a str,
    /// What the pass asks of its host.
    pub reflection: &'a Reflection,
    /// Its source form.
    pub wgsl: &'a str,
}

impl<'a> Pass<'a> {
    /// A compiled pass under this name.
    pub fn new(module: &'a str, program: &'a Program) -> Self {
        Self {
            module,
            reflection: program.reflection(),
            wgsl: program.wgsl(),
        }
    }
}

/// Rust source with a public module for each pass, in the order given. It stands in a file of its own, or where
/// `include!` puts it.
///
/// # Errors
/// A pass has something that wgpu has no word for, or two have the same name.
pub fn rust(passes: &[Pass]) -> Result<String, Report> {
    let mut text = Text::default();
    text.line(&format!(
        "// Written by Shadewright {} for wgpu {WGPU} and bytemuck 1.",
        env!("CARGO_PKG_VERSION")
    ));
    text.line("// Changes are lost when it is written again.");
    let mut seen = HashSet::new();
    for pass in passes {
        if !seen.insert(pass.module) {
            return Err(unsupported(pass, &format!("a second module of the name `{}`", pass.module)));
        }
        text.blank();
        module(&mut text, pass)?;
    }
    Ok(text.finish())
}

fn module(text: &mut Text, pass: &Pass) -> Result<(), Report> {
    let reflection = pass.reflection;
    let docs = Docs::new(pass.wgsl);
    let names = Names::new(reflection);
    head(text, reflection);
    // A host need not use everything, and the authors' names stay as they are.
    text.line("#[allow(dead_code, non_snake_case)]");
    text.line("#[allow(non_camel_case_types, non_upper_case_globals)]");
    text.open(&format!("pub mod {} {{", pass.module));
    text.doc("Hash of the canonical form: equal for shaders that mean the same.");
    text.line(&format!("pub const HASH: u128 = 0x{};", reflection.hash));
    for entry in &reflection.entry_points {
        text.blank();
        text.doc(&format!("Name of a {} entry point.", names::stage(entry.stage)));
        let one = format!("pub const {}: &str = {:?};", names.entry(&entry.name), entry.name);
        let broken = one.replacen(" = ", " =\n    ", 1);
        text.line(if text.indent() + one.len() <= text::WIDTH { &one } else { &broken });
        if let Some([x, y, z]) = entry.workgroup_size {
            text.blank();
            text.doc(&format!("Invocations of a workgroup of `{}` along x, y and z.", entry.name));
            text.line(&format!(
                "pub const {}: [u32; 3] = [{x}, {y}, {z}];",
                names.workgroup_size(&entry.name)
            ));
        }
    }
    if !reflection.capabilities.is_empty() {
        text.blank();
        text.doc("What the device must have, by naga's names.");
        let list: Vec<String> = reflection.capabilities.iter().map(|c| format!("{c:?}")).collect();
        let ty = format!("[&str; {}]", list.len());
        expr::constant(
            text,
            "CAPABILITIES",
            &ty,
            &expr::Expr::Array(list.into_iter().map(expr::Expr::Atom).collect()),
        );
    }
    structs::write(text, pass, &names, &docs)?;
    groups::write(text, pass, &names)?;
    pipelines::write(text, pass, &names)?;
    text.blank();
    text.doc("The shader.");
    text.string("pub const WGSL: &str = ", pass.wgsl, ";");
    text.close("}");
    Ok(())
}

/// What stands above the module.
fn head(text: &mut Text, reflection: &Reflection) {
    let root = reflection.instances.first().map_or("", |instance| instance.module.as_str());
    text.doc(&format!("Pass `{}` of a tree with the root `{root}`.", reflection.pass));
    if !reflection.passes.is_empty() {
        let list: Vec<String> = reflection
            .passes
            .iter()
            .map(|pass| format!("`{}.{}`", pass.instance, pass.name))
            .collect();
        text.doc(&format!("\nBefore it must have run, in this order: {}.", list.join(", ")));
    }
}

/// The error about something that cannot be written.
fn unsupported(pass: &Pass, what: &str) -> Report {
    let message = format!(
        "Rust for wgpu {WGPU} has no place for {what}, which the pass `{}` has",
        pass.reflection.pass
    );
    Diagnostic::new(codes::UNSUPPORTED_BY_TARGET, message).into()
}
