//! A BRDF of one's own over the standard library, evaluated on the GPU: `cargo run --example custom_brdf`.
#![allow(clippy::print_stdout)] // what an example is for

use std::error::Error;
use std::sync::Arc;

use serde_json::json;
use shadewright::compiler::{Catalog, Library, Recipe};
use shadewright::modules::{Overlay, library};
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::probe::probe;

/// A library with one module: a folder would do as well (`shadewright::modules::Folder`).
struct Mine;

impl Library for Mine {
    fn folders(&self, folder: &str) -> Vec<String> {
        match folder {
            "" => vec!["brdf".to_owned()],
            "brdf" => vec!["chalk".to_owned()],
            _ => Vec::new(),
        }
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        let text = match path {
            "brdf/chalk/module.ron" => {
                r#"(
                    summary: "Lambert's law with a brighter rim",
                    uses: ["math"],
                    params: {"rim": (type: F32, unit: "1", default: 0.2, range: (0.0, 1.0), doc: "Gain at the horizon")},
                )"#
            }
            "brdf/chalk/chalk.wgsl" => {
                "fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    \
                     let edge = 1.0 - max(dot(s.normal, v), 0.0);\n    \
                     return s.diffuse * INV_PI * (1.0 + params.rim * edge);\n}\n"
            }
            _ => return Ok(None),
        };
        Ok(Some(text.to_owned()))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let catalog = Catalog::load(Arc::new(Overlay(vec![Arc::new(Mine), library()])))?;
    let recipe = Recipe::parse("custom_brdf", "chalk")?;
    let inputs = [
        json!({"s": {"diffuse": [0.8, 0.8, 0.8]}, "v": [0.0, 0.0, 1.0], "l": [0.6, 0.0, 0.8]}),
        json!({"s": {"diffuse": [0.8, 0.8, 0.8]}, "v": [0.8, 0.0, 0.6], "l": [0.6, 0.0, 0.8], "params": {"rim": 1.0}}),
    ];
    let gpu = Gpu::headless()?;
    let table = probe(&gpu, &catalog, &recipe, "brdf", &inputs)?;
    println!("{}", serde_json::to_string_pretty(&table)?);
    Ok(())
}
