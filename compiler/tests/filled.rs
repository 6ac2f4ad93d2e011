//! Constants that say whether a slot is filled.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::{Texts, assert_text, small};

const PARAMS: &str = "\"more\": (type: Bool, default: false, mode: Constant, role: \"filled:extra\")";
const SUM: &str = "
fn value(x: f32) -> f32 {
    if params.more {
        return x + extra_value(x);
    }
    return x;
}
";

fn library(manifest: &str) -> Texts {
    small()
        .module("value", "plain", "", "fn value(x: f32) -> f32 {\n    return x;\n}\n")
        .module("value", "sum", manifest, SUM)
}

fn manifest() -> String {
    format!("slots: {{\"extra\": (interface: \"value\", arity: Optional, prefix: \"extra_\")}}, params: {{{PARAMS}}}")
}

/// Catches a call, a function or a parameter that an empty slot leaves in the shader, and a filled one that is not called.
#[test]
fn an_empty_slot_leaves_nothing() {
    let texts = library(&manifest());
    let empty = texts.link("(module: \"run\", fill: {\"value\": \"sum\"})");
    let plain = texts.link("(module: \"run\", fill: {\"value\": \"plain\"})");
    assert_eq!(empty.hash(), plain.hash());
    assert!(
        !empty.wgsl().contains("more") && !empty.wgsl().contains("extra"),
        "{}",
        empty.wgsl()
    );
    assert!(empty.reflection().params.is_empty());
    let filled = texts.link("(module: \"run\", fill: {\"value\": (module: \"sum\", fill: {\"extra\": \"plain\"})})");
    assert_ne!(filled.hash(), plain.hash());
    assert!(filled.wgsl().contains("x + "), "{}", filled.wgsl());
    assert!(filled.reflection().params.is_empty());
}

#[test]
fn sw0301_it_cannot_be_set() {
    assert_text(
        &library(&manifest()).error("(module: \"run\", fill: {\"value\": (module: \"sum\", freeze: {\"more\": true})})"),
        r#"
error[SW0301]: `sum` has no parameter `more`
  --> test.recipe.ron:1:58
  |
1 | (module: "run", fill: {"value": (module: "sum", freeze: {"more": true})})
  |                                                          ^^^^^^ no such parameter
  |
  = parameters: none
"#,
    );
}

#[test]
fn sw0109_it_needs_an_optional_slot() {
    let text = library(&format!("params: {{{PARAMS}}}")).catalog().unwrap_err().render();
    assert_text(
        &text,
        r#"
error[SW0109]: `more` cannot say whether `extra` is filled
  --> value/sum/module.ron:1:86
  |
1 | (summary: "sum", params: {"more": (type: Bool, default: false, mode: Constant, role: "filled:extra")})
  |                                                                                      ^^^^^^^^^^^^^^ no such optional or list slot, or no constant `Bool`
  |
  = declare it `type: Bool, default: false, mode: Constant`
"#,
    );
}
