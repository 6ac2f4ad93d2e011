//! Resources of kind `Data`: what is linked of them, what is reflected, and what is refused, as whole texts.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use std::sync::Arc;

use common::{Texts, assert_text, small};
use shadewright_compiler::data::Origin;
use shadewright_compiler::host::{Pass, rust};
use shadewright_compiler::{Catalog, Library, Recipe};

const TABLE: &str = "resources: {\"steps\": (kind: Data(file: \"steps.f32\"), doc: \"Steps\")}";
const READS: &str = "var<storage> steps: array<f32>;\n\nfn value(x: f32) -> f32 {\n    return steps[u32(x)];\n}\n";

/// A library of texts with a file that is none.
struct WithTable(Texts, Option<Vec<u8>>);

impl Library for WithTable {
    fn folders(&self, folder: &str) -> Vec<String> {
        self.0.folders(folder)
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        self.0.read(path)
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        match path {
            "value/m/steps.f32" => Ok(self.1.clone()),
            "value/m/locked.f32" => Err("permission denied".to_owned()),
            _ => self.0.bytes(path),
        }
    }
}

fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// The module `m` with a table in `steps.f32`.
fn catalog(manifest: &str, wgsl: &str, table: Option<Vec<u8>>) -> Result<Catalog, shadewright_compiler::Report> {
    Catalog::load(Arc::new(WithTable(small().module("value", "m", manifest, wgsl), table)))
}

/// What is wrong with the library, with the module alone, or with the recipe.
fn error(manifest: &str, wgsl: &str, table: Option<Vec<u8>>) -> String {
    let catalog = match catalog(manifest, wgsl, table) {
        Ok(catalog) => catalog,
        Err(report) => return report.render(),
    };
    let linked = catalog
        .compile(&recipe("(module: \"run\", fill: {\"value\": \"m\"})"), "main")
        .unwrap_err()
        .render();
    // A module by itself is checked as it is in a tree.
    assert_eq!(catalog.check_module("m").unwrap_err().render(), linked);
    linked
}

fn recipe(text: &str) -> Recipe {
    Recipe::parse("test.recipe.ron", text).unwrap()
}

/// Catches a table that does not reach its binding, a reflection that does not say which file it is, and generated Rust that does not.
#[test]
fn a_table_is_linked_and_reflected() {
    let catalog = catalog(TABLE, READS, Some(bytes(&[1.0, 2.0]))).unwrap();
    let program = catalog
        .compile(&recipe("(module: \"run\", fill: {\"value\": \"m\"})"), "main")
        .unwrap();
    let binding = program.reflection().bindings.iter().find(|b| b.doc == "Steps").unwrap();
    let json = serde_json::to_string(&binding.fill).unwrap();
    assert_eq!(
        json,
        r#"{"kind":"resource","instance":"m","resource":"steps","declared":{"Data":{"file":"steps.f32","format":null}}}"#
    );
    let data = program.data(binding).unwrap();
    let Origin::Module { path, bytes: found } = data.origin else {
        panic!("{data:?}")
    };
    assert_eq!((path.as_str(), &**found), ("value/m/steps.f32", &bytes(&[1.0, 2.0])[..]));
    let text = rust(&[Pass::new("run", &program)]).unwrap();
    assert!(text.contains("pub const FILE_M_STEPS: &str = \"value/m/steps.f32\";"), "{text}");
    assert!(
        program
            .reflection()
            .bindings
            .iter()
            .filter(|b| b.doc != "Steps")
            .all(|b| program.data(b).is_none())
    );
}

/// Catches two files for equal subtrees that are linked as one, and one file that is linked twice.
#[test]
fn files_keep_subtrees_apart() {
    let texts = small()
        .module("value", "m", "resources: {\"steps\": (kind: Data(format: \"f32\"))}", READS)
        .module(
            "value",
            "sum",
            r#"slots: {"a": (interface: "value", prefix: "a_"), "b": (interface: "value", prefix: "b_")}"#,
            "fn value(x: f32) -> f32 { return a_value(x) + b_value(x); }",
        );
    let node = |file: &str| format!("(module: \"m\", files: {{\"steps\": \"{file}\"}})");
    let linked = |a: &str, b: &str| {
        let sum = format!("(module: \"sum\", fill: {{\"a\": {}, \"b\": {}}})", node(a), node(b));
        let program = texts.link(&format!("(module: \"run\", fill: {{\"value\": {sum}}})"));
        let tables = program.reflection().bindings.iter().filter_map(|b| program.data(b));
        tables
            .map(|data| match data.origin {
                Origin::Recipe(file) => file.to_owned(),
                other => panic!("{other:?}"),
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(linked("one", "two"), ["one", "two"]);
    assert_eq!(linked("one", "one"), ["one"]);
}

/// Catches a reload that keeps the numbers of before.
#[test]
fn a_changed_table_is_a_changed_module() {
    let texts = || small().module("value", "m", TABLE, READS);
    struct Changing(Texts, std::sync::Mutex<Vec<u8>>);
    impl Library for Changing {
        fn folders(&self, folder: &str) -> Vec<String> {
            self.0.folders(folder)
        }
        fn read(&self, path: &str) -> Result<Option<String>, String> {
            self.0.read(path)
        }
        fn bytes(&self, _: &str) -> Result<Option<Vec<u8>>, String> {
            Ok(Some(self.1.lock().unwrap().clone()))
        }
    }
    let library = Arc::new(Changing(texts(), bytes(&[1.0]).into()));
    let before = Catalog::load(Arc::clone(&library) as Arc<dyn Library>).unwrap();
    let recipe = recipe("(module: \"run\", fill: {\"value\": \"m\"})");
    let program = before.compile(&recipe, "main").unwrap();
    assert!(program.is_current(&before.reload().unwrap()));
    *library.1.lock().unwrap() = bytes(&[2.0]);
    let after = before.reload().unwrap();
    assert!(!program.is_current(&after));
    assert_eq!(*after.module("m").unwrap().data["steps"], bytes(&[2.0]));
}

#[test]
fn sw0120_bad_data_kind() {
    assert_text(
        &error("resources: {\"steps\": (kind: Data())}", READS, None),
        r#"
error[SW0120]: nothing fills `steps`
  --> value/m/module.ron:1:44
  |
1 | (summary: "m", resources: {"steps": (kind: Data())})
  |                                            ^^^^^^ neither `file` nor `format`
  |
  = `Data(file: "NAME.f32")` is the module's own table, `Data(format: "NAME")` a file that a recipe names
"#,
    );
    assert_text(
        &error("resources: {\"steps\": (kind: Data(file: \"../steps.f32\"))}", READS, None),
        r#"
error[SW0120]: `../steps.f32` is no file of the module's folder
  --> value/m/module.ron:1:55
  |
1 | (summary: "m", resources: {"steps": (kind: Data(file: "../steps.f32"))})
  |                                                       ^^^^^^^^^^^^^^ not a file's bare name
  |
  = put the file beside `module.ron`
"#,
    );
    let texts = small().category("other", "resources: {\"steps\": (kind: Data(format: \"f32\"))}", "");
    assert_text(
        &texts.catalog().unwrap_err().render(),
        r#"
error[SW0120]: `steps` cannot be `Data`
  --> other/category.ron:1:58
  |
1 | (summary: "other", order: 1, resources: {"steps": (kind: Data(format: "f32"))})
  |                                                          ^^^^^^^^^^^^^^^^^^^ in a category
  |
  = a module has files in its folder; a category's resources are its modules' and the host's
"#,
    );
}

#[test]
fn sw0214_unknown_file() {
    let catalog = catalog(TABLE, READS, Some(bytes(&[1.0]))).unwrap();
    let recipe = recipe("(module: \"run\", fill: {\"value\": (module: \"m\", files: {\"steps\": \"mine.f32\"})})");
    assert_text(
        &catalog.compile(&recipe, "main").unwrap_err().render(),
        r#"
error[SW0214]: `m` takes no file `steps`
  --> test.recipe.ron:1:55
  |
1 | (module: "run", fill: {"value": (module: "m", files: {"steps": "mine.f32"})})
  |                                                       ^^^^^^^ no such resource
  |
  = resources that take a file: none
"#,
    );
}

#[test]
fn sw0421_bad_data_type() {
    for ty in [
        "var<storage, read_write> steps: array<f32>",
        "var<storage> steps: array<vec3f>",
        "var<uniform> steps: vec4f",
    ] {
        let read = if ty.contains("array") { "f32(steps[u32(x)].x)" } else { "steps.x" };
        let read = if ty.contains("f32>") { "steps[u32(x)]" } else { read };
        let wgsl = format!("{ty};\n\nfn value(x: f32) -> f32 {{\n    return {read};\n}}\n");
        let column = ty.find("steps").unwrap() + 1;
        assert_text(
            &error(TABLE, &wgsl, Some(bytes(&[1.0]))),
            &format!(
                "
error[SW0421]: `steps` cannot be filled with numbers from a file
  --> value/m/m.wgsl:1:{column}
  |
1 | {ty};
  | {}^^^^^ no `var<storage>` that is an array of `f32`, `vec2f` or `vec4f`
",
                " ".repeat(column - 1)
            ),
        );
    }
}

#[test]
fn sw0804_unreadable_table() {
    assert_text(
        &error("resources: {\"steps\": (kind: Data(file: \"locked.f32\"))}", READS, None),
        r#"
error[SW0804]: `value/m/locked.f32` cannot be read: permission denied
  --> value/m/module.ron:1:55
  |
1 | (summary: "m", resources: {"steps": (kind: Data(file: "locked.f32"))})
  |                                                       ^^^^^^^^^^^^ named here
"#,
    );
}

#[test]
fn sw0805_missing_data() {
    assert_text(
        &error(TABLE, READS, None),
        r#"
error[SW0805]: `value/m/steps.f32` is not there
  --> value/m/module.ron:1:55
  |
1 | (summary: "m", resources: {"steps": (kind: Data(file: "steps.f32"), doc: "Steps")})
  |                                                       ^^^^^^^^^^^ named here
"#,
    );
}

#[test]
fn sw0806_bad_data() {
    let wrong = |why: &str| {
        format!(
            "
error[SW0806]: `value/m/steps.f32` is no table of numbers
  --> value/m/module.ron:1:55
  |
1 | (summary: \"m\", resources: {{\"steps\": (kind: Data(file: \"steps.f32\"), doc: \"Steps\")}})
  |                                                       ^^^^^^^^^^^ {why}
"
        )
    };
    assert_text(
        &error(TABLE, READS, Some(vec![0; 6])),
        &wrong("6 bytes are no whole number of 32-bit floats"),
    );
    assert_text(&error(TABLE, READS, Some(bytes(&[0.0, f32::INFINITY]))), &wrong("number 1 is inf"));
    assert_text(&error(TABLE, READS, Some(Vec::new())), &wrong("it holds no number"));
    let wgsl = READS.replace("array<f32>", "array<f32, 3>");
    assert_text(
        &error(TABLE, &wgsl, Some(bytes(&[1.0, 2.0]))),
        r#"
error[SW0806]: `steps.f32` does not fill `steps`
  --> value/m/module.ron:1:55
  |
1 | (summary: "m", resources: {"steps": (kind: Data(file: "steps.f32"), doc: "Steps")})
  |                                                       ^^^^^^^^^^^ 2 numbers, but `array<f32, 3>` takes 3
  |
  --> value/m/m.wgsl:1:14
  |
1 | var<storage> steps: array<f32, 3>;
  |              ----- the buffer
"#,
    );
}
