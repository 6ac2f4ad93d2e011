//! Libraries in memory, for tests of the compiler.
#![allow(dead_code)]

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use shadewright_compiler::{Catalog, Library, Program, Recipe, Report};

/// A library of texts by path.
#[derive(Clone, Default)]
pub struct Texts(pub BTreeMap<String, String>);

impl Library for Texts {
    fn folders(&self, folder: &str) -> Vec<String> {
        let prefix = if folder.is_empty() { String::new() } else { format!("{folder}/") };
        let below = self
            .0
            .keys()
            .filter_map(|path| path.strip_prefix(&prefix)?.split_once('/').map(|(name, _)| name.to_owned()));
        below.collect::<BTreeSet<_>>().into_iter().collect()
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        Ok(self.0.get(path).cloned())
    }
}

impl Texts {
    /// A category with its interface.
    #[must_use]
    pub fn category(mut self, name: &str, manifest: &str, interface: &str) -> Self {
        self.0.insert(
            format!("{name}/category.ron"),
            format!("(summary: \"{name}\", order: 1, {manifest})"),
        );
        self.0.insert(format!("{name}/interface.wgsl"), interface.to_owned());
        self
    }

    /// A module of a category.
    #[must_use]
    pub fn module(mut self, category: &str, name: &str, manifest: &str, wgsl: &str) -> Self {
        self.0.insert(
            format!("{category}/{name}/module.ron"),
            format!("(summary: \"{name}\", {manifest})"),
        );
        self.0.insert(format!("{category}/{name}/{name}.wgsl"), wgsl.to_owned());
        self
    }

    /// The catalog.
    pub fn catalog(&self) -> Result<Catalog, Report> {
        Catalog::load(Arc::new(self.clone()))
    }

    /// Links a recipe's main pass.
    pub fn compile(&self, recipe: &str) -> Result<Program, Report> {
        self.catalog()?.compile(&Recipe::parse("test.recipe.ron", recipe)?, "main")
    }

    /// Links what must link.
    pub fn link(&self, recipe: &str) -> Program {
        self.compile(recipe).unwrap_or_else(|report| panic!("{report}"))
    }

    /// The rendered error of what must not link.
    pub fn error(&self, recipe: &str) -> String {
        match self.compile(recipe) {
            Ok(program) => panic!("linked:\n{}", program.wgsl()),
            Err(report) => report.render(),
        }
    }
}

/// A library with a compute pass `run` that stores `value()` of its slot `value`, to build small cases upon.
pub fn small() -> Texts {
    Texts::default()
        .category("pass", "group: 3", "")
        .category(
            "value",
            r#"combine: {"value": Sum}"#,
            "fn value(x: f32) -> f32 {\n    return x;\n}\n",
        )
        .module(
            "pass",
            "run",
            r#"slots: {"value": (interface: "value")}, resources: {"out": (kind: Host("out"))}"#,
            "var<storage, read_write> out: array<f32>;\n\n@compute @workgroup_size(1)\nfn main() {\n    out[0] = value(out[1]);\n}\n",
        )
}

/// Asserts that a program's source form means what its IR form means.
#[track_caller]
pub fn assert_forms_agree(program: &Program) {
    let text = program.wgsl();
    let hash = shadewright_compiler::canonical::canonical_hash("source form", text);
    match hash {
        Ok(hash) => assert_eq!(hash, program.hash(), "the two forms differ:\n{text}"),
        Err(report) => panic!("the source form is no WGSL: {report}\n{text}"),
    }
}
