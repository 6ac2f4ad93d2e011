//! Errors in spaces. Whole texts: a change of a place or word must be meant.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::{Texts, assert_text, small};
use shadewright_compiler::Space;

const VALUE: &str = "fn value(x: f32) -> f32 {\n    return x;\n}\n";

fn library() -> Texts {
    small()
        .module("value", "plain", r#"properties: ["flat"]"#, VALUE)
        .module(
            "value",
            "scaled",
            r#"params: {"by": (type: F32, default: 1.0, range: (0.0, 10.0)), "n": (type: U32, default: 1, range: (0, 9), mode: Constant)}"#,
            VALUE,
        )
        .module(
            "value",
            "sum",
            r#"slots: {"all": (interface: "value", arity: List, prefix: "all_")}"#,
            VALUE,
        )
}

/// The rendered error of a space.
fn error(text: &str) -> String {
    match Space::parse(&library().catalog().unwrap(), "a.space.ron", text) {
        Ok(space) => match space.count().and_then(|count| space.not_empty().map(|()| count)) {
            Ok(count) => panic!("{count} permutations"),
            Err(report) => report.render(),
        },
        Err(report) => report.render(),
    }
}

/// The same of what stands in the slot `value` of `run`.
fn in_slot(text: &str) -> String {
    error(&format!(
        "(\n    module: \"run\",\n    fill: {{\n        \"value\": {text},\n    }},\n)\n"
    ))
}

#[test]
fn sw0103_wrong_shape() {
    assert_text(&in_slot(r#"(one_of: ["plain"], min: 1)"#), "");
    assert_text(&in_slot("(fill: {})"), "");
    assert_text(&in_slot(r#"(module: "scaled", freeze: {"by": (from: 1.0)})"#), "");
}

#[test]
fn sw0102_unknown_field() {
    assert_text(&in_slot(r#"(one_off: ["plain"])"#), "");
    assert_text(&error("(\n    root: \"run\",\n    limits: (texture: 3),\n)\n"), "");
}

/// Errors that recipes have too stand where the space says it.
#[test]
fn what_recipes_have_too() {
    assert_text(&in_slot(r#"(one_of: ["plain", "scald"])"#), "");
    assert_text(&in_slot(r#"(module: "scaled", freeze: {"n": (values: [1, 12])})"#), "");
    assert_text(&in_slot(r#"(one_of: [[], "plain"])"#), "");
    assert_text(&in_slot(r#"(fits: Open, without: ["plane"])"#), "");
}

#[test]
fn sw1001_bad_choice() {
    assert_text(&in_slot("(one_of: [])"), "");
    assert_text(&in_slot(r#"(module: "sum", fill: {"all": (some_of: ["plain"], min: 2)})"#), "");
    assert_text(
        &in_slot(r#"(module: "sum", fill: {"all": (some_of: ["plain", "sum"], min: 2, max: 1)})"#),
        "",
    );
    assert_text(&in_slot(r#"(fits: Open, of: "value")"#), "");
    assert_text(&error("(fits: Open)"), "");
    assert_text(&error(r#"["run", "run"]"#), "");
}

#[test]
fn sw1002_bad_values() {
    let freeze = |values: &str| in_slot(&format!(r#"(module: "scaled", freeze: {{"by": {values}}})"#));
    assert_text(&freeze("(values: [])"), "");
    let label = |values: &str| {
        freeze(values)
            .lines()
            .find_map(|line| Some(line.split_once("^ ")?.1.to_owned()))
            .unwrap()
    };
    assert_eq!(label("(from: 2.0, to: 1.0, steps: 3)"), "`from` must be below `to`");
    assert_eq!(
        label("(from: 0.0, to: 1.0, steps: 3, scale: Log)"),
        "logarithms need a positive `from`"
    );
    assert_eq!(
        label("(from: 1.0, to: 2.0, step: 0.1, scale: Log)"),
        "a logarithmic range wants `steps`"
    );
    assert_eq!(label("(from: 1.0, to: 2.0, steps: 0)"), "`steps` must be at least 1");
    assert_eq!(label("(from: 1.0, to: 2.0, step: -1.0)"), "`step` must be positive");
    assert_eq!(label("(from: 1.0, to: 2.0)"), "either `step` or `steps` is needed");
    assert_eq!(
        label("(from: 1.0, to: 2.0, steps: 1, step: 1.0)"),
        "either `step` or `steps` is needed"
    );
    assert_eq!(label("(from: 1.0, to: 2.0, steps: 1024)"), "too many values");
    assert_eq!(label("(from: 1.0, to: 2.0, step: 0.0001)"), "too many values");
}

#[test]
fn sw1003_unknown_tag() {
    let rule = |rule: &str| error(&format!("(\n    root: \"run\",\n    rules: [{rule}],\n)\n"));
    assert_text(&rule(r#"Excludes(when: "plain", tag: "flatt", among: Tree, because: "no")"#), "");
    assert_text(&rule(r#"Requires(when: "nobody", tag: "flat", among: Tree, because: "no")"#), "");
}

#[test]
fn sw1004_space_too_large() {
    // 64 levels of brackets, and 1024 elements of each: a few lines make a large space.
    let mut inner = "\"plain\"".to_owned();
    for _ in 0..3 {
        inner = format!("(some_of: [{}])", vec![inner; 70].join(", "));
    }
    let text = format!("(module: \"run\", fill: {{\"value\": (module: \"sum\", fill: {{\"all\": {inner}}})}})");
    assert_text(&error(&text), "");
}

#[test]
fn sw1005_space_too_tangled() {
    // Each of 24 modules demands or is another's ruin: nearly every subset must be told apart.
    let of: Vec<String> = (0..24).map(|k| format!(r#"(module: "plain", tags: ["t{k}"])"#)).collect();
    let rules: Vec<String> = (0..24)
        .map(|k| {
            format!(
                r#"Requires(when: "t{k}", tag: "t{}", among: Tree, because: "made up"), "#,
                (k + 7) % 24
            )
        })
        .collect();
    let root = format!(
        "(module: \"run\", fill: {{\"value\": (module: \"sum\", fill: {{\"all\": (some_of: [{}])}})}})",
        of.join(", ")
    );
    assert_text(&error(&format!("(\n    root: {root},\n    rules: [{}],\n)\n", rules.concat())), "");
}

#[test]
fn sw1006_space_uncountable() {
    let of = vec!["\"plain\""; 128].join(", ");
    let text = format!("(module: \"run\", fill: {{\"value\": (module: \"sum\", fill: {{\"all\": (some_of: [{of}])}})}})");
    assert_text(&error(&text), "");
    // It can be covered all the same: all there, all absent, and few more.
    let space = Space::parse(&library().catalog().unwrap(), "a.space.ron", &text).unwrap_or_else(|report| panic!("{report}"));
    assert!((2..40).contains(&space.pairwise().len()), "{}", space.pairwise().len());
    assert!(space.get(0).is_none() && space.random(1, 0).is_err() && space.iter().is_err());
    assert!(space.pairwise().iter().all(|p| p.index.is_none()));
}

#[test]
fn sw1007_space_empty() {
    assert_text(
        &error(
            "(\n    root: (module: \"run\", fill: {\"value\": \"plain\"}),\n    rules: [Requires(tag: \"sum\", among: Children, because: \"sums\")],\n)\n",
        ),
        "",
    );
    assert_text(
        &error("(\n    root: (module: \"run\", fill: {\"value\": \"plain\"}),\n    limits: (bindings: 0),\n)\n"),
        "",
    );
    assert_text(
        &error("(\n    root: (module: \"run\", fill: {\"value\": \"scaled\"}),\n    limits: (uniform_buffers: 0),\n)\n"),
        "",
    );
}

#[test]
fn sw0114_unknown_capability() {
    assert_text(&error("(\n    root: \"run\",\n    limits: (lacks: [\"SHADER_FLOAT61\"]),\n)\n"), "");
}
