//! Errors of linking, of targets, of limits and of the library's folders. Whole texts: a change of a place or word must be meant.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use std::sync::Arc;

use common::{Texts, assert_text, small};
use shadewright_compiler::diagnostics::codes;
use shadewright_compiler::{Catalog, Library, Recipe, Target, emit, limits};

const RECIPE: &str = "(module: \"run\", fill: {\"value\": \"m\"})";

/// The error of a module `m` of `value` with this manifest and text, linked.
fn module(manifest: &str, wgsl: &str) -> String {
    small().module("value", "m", manifest, wgsl).error(RECIPE)
}

/// Two modules that are right by themselves, and cannot be in one shader: a pipeline has one block of immediates.
#[test]
fn sw0501_linked_invalid() {
    let immediate = |name: &str| format!("var<immediate> {name}: f32;\n\nfn value(x: f32) -> f32 {{\n    return x + {name};\n}}\n");
    let manifest = |name: &str| format!(r#"capabilities: ["IMMEDIATES"], resources: {{"{name}": (kind: Host("{name}"))}}"#);
    let texts = small()
        .module("value", "one", &manifest("first"), &immediate("first"))
        .module("value", "two", &manifest("second"), &immediate("second"))
        .module(
            "pass",
            "sum",
            r#"slots: {"all": (interface: "value", arity: List)}, resources: {"out": (kind: Host("out"))}"#,
            "var<storage, read_write> out: array<f32>;\n\n@compute @workgroup_size(1)\nfn main() {\n    out[0] = value(out[1]);\n}\n",
        );
    assert_text(
        &texts.error("(module: \"sum\", fill: {\"all\": [\"one\", \"two\"]})"),
        r#"
error[SW0501]: Entry point main at Compute is invalid: More than 1 immediate data variable is used
  --> value/two/two.wgsl:1:1
  |
1 | var<immediate> second: f32;
  | ^^^^^^^^^^^^^^^^^^^^^^^^^^^ this global variable
  |
  = the modules are valid each by itself, but not linked together
"#,
    );
}

/// Derivatives exist in fragment stages only: the module is right by itself, the compute pass around it makes it wrong.
#[test]
fn sw0503_stage_of_a_function() {
    assert_text(
        &module(
            "",
            "fn slope(x: f32) -> f32 {\n    return dpdx(x);\n}\n\nfn value(x: f32) -> f32 {\n    return slope(x) * 2.0;\n}\n",
        ),
        r#"
error[SW0503]: a derivative in the compute stage `main`: only fragment stages have that
  --> value/m/m.wgsl:2:12
  |
2 |     return dpdx(x);
  |            ^^^^ used here
  |
  --> test.recipe.ron:1:10
  |
1 | (module: "run", fill: {"value": "m"})
  |          ----- the root of this tree has the stage
  |
  = the module is valid by itself: it does not fit into this tree
"#,
    );
}

/// A barrier waits for a workgroup, which a vertex stage does not have.
#[test]
fn sw0503_barrier() {
    let texts = small()
        .module("value", "m", "", "fn value(x: f32) -> f32 {\n    if x > 1.0 {\n        workgroupBarrier();\n    }\n    return x;\n}\n")
        .module(
            "pass",
            "draw",
            r#"slots: {"value": (interface: "value")}"#,
            "struct Out {\n    @builtin(position) position: vec4f,\n}\n\n@vertex\nfn main(@builtin(vertex_index) i: u32) -> Out {\n    return Out(vec4f(value(f32(i))));\n}\n",
        );
    assert_text(
        &texts.error("(module: \"draw\", fill: {\"value\": \"m\"})"),
        r#"
error[SW0503]: a barrier in the vertex stage `main`: only compute stages have that
  --> value/m/m.wgsl:3:9
  |
3 |         workgroupBarrier();
  |         ^^^^^^^^^^^^^^^^ used here
  |
  --> test.recipe.ron:1:10
  |
1 | (module: "draw", fill: {"value": "m"})
  |          ------ the root of this tree has the stage
  |
  = the module is valid by itself: it does not fit into this tree
"#,
    );
}

#[test]
fn sw0502_capability_undeclared() {
    let half = "enable f16;\n\nfn value(x: f32) -> f32 {\n    return f32(f16(x) * 2.0h);\n}\n";
    assert_text(
        &module("", half),
        r#"
error[SW0502]: this needs the capability `SHADER_FLOAT16`, which nothing declares
  --> value/m/m.wgsl:4:16
  |
3 | fn value(x: f32) -> f32 {
  | ----------------------- in this function
4 |     return f32(f16(x) * 2.0h);
  |                ^^^^^^ this expression
  |
  = write `capabilities: ["SHADER_FLOAT16"]` into `value/m/module.ron`
"#,
    );
    assert_text(
        &module("capabilities: [\"SUBGROUP\"]", half),
        r#"
error[SW0502]: this needs the capability `SHADER_FLOAT16`, which nothing declares
  --> value/m/m.wgsl:4:16
  |
3 | fn value(x: f32) -> f32 {
  | ----------------------- in this function
4 |     return f32(f16(x) * 2.0h);
  |                ^^^^^^ this expression
  |
  = add `SHADER_FLOAT16` to `capabilities` of `value/m/module.ron`
"#,
    );
    let texts = small()
        .category(
            "value",
            "",
            "enable f16;\n\nfn value(x: f32) -> f32 {\n    return f32(f16(x));\n}\n",
        )
        .module("value", "m", "", "fn value(x: f32) -> f32 {\n    return x;\n}\n");
    assert_text(
        &texts.error(RECIPE),
        r#"
error[SW0502]: this needs the capability `SHADER_FLOAT16`, which nothing declares
  --> value/interface.wgsl:4:16
  |
3 | fn value(x: f32) -> f32 {
  | ----------------------- in this function
4 |     return f32(f16(x));
  |                ^^^^^^ this expression
  |
  = an interface has to work on every device: leave this to the modules
"#,
    );
}

/// The error of writing a module `m` for a target.
fn emitted(manifest: &str, wgsl: &str, target: Target) -> String {
    let program = small().module("value", "m", manifest, wgsl).link(RECIPE);
    emit(program.validated(), target, None).map_or_else(|report| report.render(), |_| panic!("written"))
}

#[test]
fn sw0601_unsupported_by_target() {
    let subgroup = "fn value(x: f32) -> f32 {\n    return subgroupAdd(x);\n}\n";
    let capabilities = "capabilities: [\"SUBGROUP\"]";
    emitted_for_all(capabilities, subgroup);
    let long = "fn value(x: f32) -> f32 {\n    return f32(i64(x));\n}\n";
    assert_text(
        &emitted("capabilities: [\"SHADER_INT64\"]", long, Target::Glsl),
        r#"
error[SW0601]: GLSL cannot express this shader
 = it has no signed integer numbers of 64 bits
"#,
    );
    let half = "enable f16;\n\nfn value(x: f32) -> f32 {\n    return f32(f16(x) * 2.0h);\n}\n";
    assert_text(
        &emitted("capabilities: [\"SHADER_FLOAT16\"]", half, Target::Glsl),
        r#"
error[SW0601]: GLSL cannot express this shader
 = it has no floating-point numbers of 16 bits
"#,
    );
}

/// Written or refused, but never a panic.
fn emitted_for_all(manifest: &str, wgsl: &str) {
    let program = small().module("value", "m", manifest, wgsl).link(RECIPE);
    for target in Target::ALL {
        if let Err(report) = emit(program.validated(), target, None) {
            assert!(report.diagnostics[0].code.starts_with("SW06"), "{report}");
        }
    }
}

#[test]
fn sw0603_unknown_entry_point() {
    let program = small()
        .module("value", "m", "", "fn value(x: f32) -> f32 {\n    return x;\n}\n")
        .link(RECIPE);
    assert_text(
        &emit(program.validated(), Target::Msl, Some("mian")).unwrap_err().render(),
        r#"
error[SW0603]: there is no entry point `mian`
 = did you mean `main`?
 = entry points: main
"#,
    );
}

#[test]
fn sw0701_file_too_large() {
    let comment = format!("// {}\n", "x".repeat(limits::FILE_SIZE));
    assert_text(
        &module("", &comment),
        r#"
error[SW0701]: `value/m/m.wgsl` is too large: 1048580 bytes
 = at most 1048576 bytes are read
"#,
    );
    assert_text(
        &Recipe::parse("my.recipe.ron", &comment).unwrap_err().render(),
        r#"
error[SW0701]: `my.recipe.ron` is too large: 1048580 bytes
 = at most 1048576 bytes are read
"#,
    );
}

#[test]
fn sw0702_nesting_too_deep() {
    let deep = |n: usize| {
        format!(
            "fn value(x: f32) -> f32 {{\n    return\n{}x{};\n}}\n",
            "(\n".repeat(n),
            ")".repeat(n)
        )
    };
    small().module("value", "m", "", &deep(limits::WGSL_NESTING - 1)).link(RECIPE);
    assert_text(
        &module("", &deep(limits::WGSL_NESTING)),
        r#"
error[SW0702]: brackets are nested too deep
    --> value/m/m.wgsl:129:1
    |
129 | (
    | ^ level 128
    |
    = at most 127 levels are taken
"#,
    );
    let long = |n: usize| format!("fn value(x: f32) -> f32 {{\n    return x{};\n}}\n", "\n+ x".repeat(n));
    small().module("value", "m", "", &long(limits::WGSL_EXPRESSION - 2)).link(RECIPE);
    assert_text(
        &module("", &long(limits::WGSL_EXPRESSION + 1)),
        r#"
error[SW0702]: an expression or a chain of `else` is too long
     --> value/m/m.wgsl:1025:1
     |
1025 | + x
     | ^ operator 1025
     |
     = at most 1024 operators, members and indices may apply to one another: name parts of it with `let`
"#,
    );
    let recipe = format!("{}\"m\"{}", "(module: \"m\", fill: {\"value\":\n".repeat(33), "})".repeat(33));
    assert_text(
        &Recipe::parse("my.recipe.ron", &recipe).unwrap_err().render(),
        r#"
error[SW0702]: brackets are nested too deep
   --> my.recipe.ron:33:1
   |
33 | (module: "m", fill: {"value":
   | ^ level 65
   |
   = at most 64 levels are taken
"#,
    );
}

#[test]
fn sw0706_list_too_long() {
    let many = format!(
        "fn value(x: f32) -> f32 {{\n    return x;\n}}\n{}",
        "const a = 1;\n".repeat(limits::WGSL_DECLARATIONS)
    );
    assert_text(
        &module("", &many),
        r#"
error[SW0706]: too many declarations in one file
     --> value/m/m.wgsl:4099:12
     |
4099 | const a = 1;
     |            ^ one too many
     |
     = at most 4096 are taken
"#,
    );
    let recipe = format!(
        "(module: \"run\", fill: {{\"value\": [\n{}]}})",
        "\"m\",\n".repeat(limits::LIST_LENGTH + 1)
    );
    assert_text(
        &Recipe::parse("my.recipe.ron", &recipe).unwrap_err().render(),
        r#"
error[SW0706]: a list is too long
  --> my.recipe.ron:1:33
  |
1 | (module: "run", fill: {"value": [
  |                                 ^ begins here
  |
  = at most 1024 elements are taken
"#,
    );
}

fn load(texts: &Texts) -> String {
    texts.catalog().map_or_else(|report| report.render(), |_| panic!("loaded"))
}

#[test]
fn sw0801_missing_category() {
    let mut texts = small();
    texts.0.remove("pass/category.ron");
    assert_text(
        &load(&texts),
        r#"
error[SW0801]: the folder `pass` holds the module `run`, but has no `category.ron`
 = a folder with modules is a category: declare it, or move the module into one that is
"#,
    );
    // A folder without modules is somebody else's.
    texts.0.remove("pass/run/module.ron");
    texts.catalog().unwrap();
}

#[test]
fn sw0802_missing_manifest() {
    let mut texts = small();
    texts.0.remove("pass/run/module.ron");
    assert_text(
        &load(&texts),
        r#"
error[SW0802]: the folder `pass/run` has no `module.ron`
 = a folder in a category is a module
"#,
    );
}

#[test]
fn sw0803_missing_interface() {
    let mut texts = small().module("value", "m", "", "fn value(x: f32) -> f32 {\n    return x;\n}\n");
    texts.0.remove("value/interface.wgsl");
    assert_text(
        &texts.error(RECIPE),
        r#"
error[SW0803]: the category `value` has no `interface.wgsl`
  --> value/category.ron:1:1
  |
1 | (summary: "value", order: 1, combine: {"value": Sum})
  | ^ declared here
"#,
    );
}

/// A library with a file that is no text.
struct Damaged(Texts, &'static str);

impl Library for Damaged {
    fn folders(&self, folder: &str) -> Vec<String> {
        self.0.folders(folder)
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        if path == self.1 {
            Err("it is no UTF-8".to_owned())
        } else {
            self.0.read(path)
        }
    }
}

#[test]
fn sw0804_unreadable_file() {
    let texts = small().module("value", "m", "", "");
    let catalog = Catalog::load(Arc::new(Damaged(texts.clone(), "value/m/module.ron")));
    assert_text(
        &catalog.unwrap_err().render(),
        r#"
error[SW0804]: `value/m/module.ron` cannot be read: it is no UTF-8
"#,
    );
    let catalog = Catalog::load(Arc::new(Damaged(texts, "value/m/m.wgsl"))).unwrap();
    assert_text(
        &catalog.compile(&Recipe::parse("r", RECIPE).unwrap(), "main").unwrap_err().render(),
        r#"
error[SW0804]: `value/m/m.wgsl` cannot be read: it is no UTF-8
"#,
    );
}

/// Catches a code that is declared, but whose text no test asserts. Those of scenes, tables and experiments are raised, and
/// asserted, by the runtime and the report.
#[test]
fn every_code_is_asserted() {
    const HEAD: &str = "error[";
    fn sources(folder: &std::path::Path, texts: &mut String) {
        for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
            if entry.path().is_dir() {
                sources(&entry.path(), texts);
            } else {
                let text = std::fs::read_to_string(entry.path()).unwrap();
                // Of a source file the tests are the end.
                let tests = if folder.ends_with("tests") {
                    0
                } else {
                    text.find("#[cfg(test)]").unwrap_or(text.len())
                };
                texts.push_str(&text[if entry.file_name() == "tests.rs" { 0 } else { tests }..]);
            }
        }
    }
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut texts = String::new();
    sources(&root.join("tests"), &mut texts);
    sources(&root.join("src"), &mut texts);
    // Of files that recipes name, which the runtime reads.
    sources(&root.join("../runtime/src/data"), &mut texts);
    // Of modules written in WESL, which are read there.
    sources(&root.join("../modules/src"), &mut texts);
    let codes = codes::ALL
        .iter()
        .map(|(code, _)| *code)
        .filter(|code| !code.starts_with("SW09") && !code.starts_with("SW11"));
    let missing: Vec<&str> = codes.filter(|code| !texts.contains(&format!("\n{HEAD}{code}]: "))).collect();
    assert_eq!(missing, [""; 0], "codes that no test asserts");
}
