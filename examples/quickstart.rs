//! From a recipe to WGSL and to what a host must bind: `cargo run --example quickstart`.
#![allow(clippy::print_stdout)] // what an example is for

use shadewright::compiler::{Catalog, Recipe, Report, Target, emit};

fn main() -> Result<(), Report> {
    let catalog = Catalog::load(shadewright::modules::library())?;

    // A forward pass with one kind of light. Slots that the recipe does not name have their modules' defaults.
    let recipe = Recipe::parse(
        "quickstart",
        r#"(module: "forward", fill: {"brdf": "lambert", "lights": ["point"]})"#,
    )?;
    let program = catalog.compile(&recipe, "main")?;

    println!("{}", program.wgsl());
    for binding in &program.reflection().bindings {
        println!("@group({}) @binding({}) {}", binding.group, binding.binding, binding.name);
    }
    for why in program.why("lambert_brdf") {
        println!("{} is there because of {}: {}", why.name, why.because, why.path.join(" -> "));
    }
    let spirv = emit(program.validated(), Target::SpirV, None)?;
    println!("{} bytes of SPIR-V, hash {}", spirv.len(), program.reflection().hash);
    Ok(())
}
