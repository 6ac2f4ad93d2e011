//! What the integration tests share.

// Every test program that includes this uses a part of it.
#![allow(dead_code)]

use std::sync::{Arc, OnceLock};

use serde_json::{Value as Json, json};
use shadewright::compiler::{Catalog, Recipe};
use shadewright::modules::library;
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::probe::probe as probe_on;

/// The standard library's catalog, read once.
pub fn catalog() -> &'static Catalog {
    static CATALOG: OnceLock<Catalog> = OnceLock::new();
    CATALOG.get_or_init(|| Catalog::load(library()).unwrap_or_else(|report| panic!("{report}")))
}

/// The device of this test program. Its absence fails the test: what needs a device is not skipped.
pub fn gpu() -> Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    Arc::clone(GPU.get_or_init(|| Arc::new(Gpu::headless().unwrap_or_else(|error| panic!("{error}")))))
}

/// Evaluates a function of a recipe's root over a list of inputs: the list of results.
pub fn probe(recipe: &str, function: &str, inputs: Json) -> Json {
    let Json::Array(rows) = inputs else {
        panic!("inputs are a list");
    };
    let parsed = Recipe::parse("test", recipe).unwrap_or_else(|report| panic!("{recipe}\n{report}"));
    let mut said = probe_on(&gpu(), catalog(), &parsed, function, &rows).unwrap_or_else(|error| panic!("{recipe} {function}: {error}"));
    said.get_mut("results").map_or(json!([]), Json::take)
}
