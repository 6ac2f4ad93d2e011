//! Libraries in memory, for tests of the compiler.
#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

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

/// The standard library's own texts and recipes, read from beside this crate.
pub fn standard() -> Texts {
    fn walk(folder: &std::path::Path, path: &str, texts: &mut BTreeMap<String, String>) {
        for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let name = entry.file_name().into_string().unwrap();
            let path = if path.is_empty() { name.clone() } else { format!("{path}/{name}") };
            if entry.path().is_dir() {
                walk(&entry.path(), &path, texts);
            } else if name.ends_with(".wgsl") || name == "module.ron" || name == "category.ron" {
                texts.insert(path, std::fs::read_to_string(entry.path()).unwrap());
            } else if !name.ends_with(".md") && !name.ends_with(".rs") && !name.ends_with(".ron") {
                // A table: as many numbers, all 0, which are a text too.
                let length = entry.metadata().unwrap().len();
                texts.insert(path, "\0".repeat(usize::try_from(length).unwrap()));
            }
        }
    }
    let mut texts = Texts::default();
    walk(&beside("modules"), "", &mut texts.0);
    assert!(texts.0.len() > 40, "the standard library is not there");
    texts
}

/// The recipes of the examples, by file name.
pub fn recipes() -> BTreeMap<String, String> {
    let files = std::fs::read_dir(beside("examples/recipes")).unwrap().map(Result::unwrap);
    let recipe = |name: &str| name.ends_with(".recipe.ron");
    let found: BTreeMap<String, String> = files
        .filter(|f| recipe(&f.file_name().to_string_lossy()))
        .map(|f| (f.file_name().into_string().unwrap(), std::fs::read_to_string(f.path()).unwrap()))
        .collect();
    assert!(!found.is_empty(), "no recipes");
    found
}

fn beside(folder: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder)
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

/// Asserts that an error's text is exactly this one; the expected text begins on a line of its own.
#[track_caller]
pub fn assert_text(actual: &str, expected: &str) {
    let expected = expected.strip_prefix('\n').unwrap_or(expected);
    assert!(actual == expected, "expected:\n{expected}\nfound:\n{actual}");
}
