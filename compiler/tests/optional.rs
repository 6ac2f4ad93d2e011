//! Functions that a module may leave out: the interface's own bodies run.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use common::{Texts, assert_forms_agree, assert_text};

const INTERFACE: &str = "\
/// Needed.
fn value(x: f32) -> f32 {
    return x;
}

/// Left out, twice the value; of the same group.
fn draw(x: f32) -> f32 {
    return 2.0 * x;
}

fn density(x: f32) -> f32 {
    return 0.5;
}
";

fn texts() -> Texts {
    Texts::default()
        .category("pass", "group: 3", "")
        .category("value", r#"optional: [["draw", "density"]]"#, INTERFACE)
        .module(
            "pass",
            "run",
            r#"slots: {"value": (interface: "value")}, resources: {"out": (kind: Host("out"))}"#,
            "var<storage, read_write> out: array<f32>;\n\n@compute @workgroup_size(1)\nfn main() {\n    out[0] = value(out[1]) + draw(out[2]) * density(out[3]);\n}\n",
        )
        .module("value", "short", "", "fn value(x: f32) -> f32 {\n    return x + 1.0;\n}\n")
        .module(
            "value",
            "whole",
            "",
            "fn value(x: f32) -> f32 {\n    return x + 1.0;\n}\n\nfn draw(x: f32) -> f32 {\n    return 3.0 * x;\n}\n\nfn density(x: f32) -> f32 {\n    return 0.25;\n}\n",
        )
        .module(
            "value",
            "half",
            "",
            "fn value(x: f32) -> f32 {\n    return x + 1.0;\n}\n\nfn draw(x: f32) -> f32 {\n    return 3.0 * x;\n}\n",
        )
}

/// Catches a module's own function that is passed over for the interface's, and one that is left out and found nowhere.
#[test]
fn what_is_left_out_is_the_interfaces() {
    let short = texts().link("(module: \"run\", fill: {\"value\": \"short\"})");
    assert!(
        short.wgsl().contains("return 2.0 * x;") && short.wgsl().contains("return 0.5;"),
        "{}",
        short.wgsl()
    );
    assert_forms_agree(&short);
    let whole = texts().link("(module: \"run\", fill: {\"value\": \"whole\"})");
    assert!(
        whole.wgsl().contains("return 3.0 * x;") && !whole.wgsl().contains("2.0 * x"),
        "{}",
        whole.wgsl()
    );
    assert_forms_agree(&whole);
    assert_ne!(short.hash(), whole.hash());
}

/// Catches half of a group: a density that is not of what is drawn.
#[test]
fn a_group_is_left_out_as_a_whole() {
    assert_text(
        &texts().error("(module: \"run\", fill: {\"value\": \"half\"})"),
        r#"
error[SW0405]: the module does not define `density` of the interface `value`
   --> value/half/half.wgsl:1:1
   |
 1 | fn value(x: f32) -> f32 {
   | ^ in this file
   |
   --> value/interface.wgsl:11:1
   |
11 | fn density(x: f32) -> f32 {
   | ------------------------- declared here
   |
   = add `fn density(x: f32) -> f32 { ... }`
"#,
    );
}

/// Catches a name in a group that the interface does not have.
#[test]
fn a_group_names_the_interfaces_functions() {
    let texts = texts().category("value", r#"optional: [["draw", "denstiy"]]"#, INTERFACE);
    assert_text(
        &texts.error("(module: \"run\", fill: {\"value\": \"whole\"})"),
        r#"
error[SW0117]: the interface `value` has no function `denstiy`
  --> value/category.ron:1:50
  |
1 | (summary: "value", order: 1, optional: [["draw", "denstiy"]])
  |                                                  ^^^^^^^^^ named here
  |
  = did you mean `density`?
  = functions: value, draw, density
"#,
    );
}
