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
    assert_text(
        &in_slot(r#"(one_of: ["plain"], min: 1)"#),
        r#"
error[SW0103]: a value of another shape is needed for `fill.value`
  --> a.space.ron:4:44
  |
4 |         "value": (one_of: ["plain"], min: 1),
  |                                            ^ `min` cannot stand beside `one_of`
"#,
    );
    assert_text(
        &in_slot("(fill: {})"),
        r#"
error[SW0103]: a value of another shape is needed for `fill.value`
  --> a.space.ron:4:27
  |
4 |         "value": (fill: {}),
  |                           ^ one of `module`, `one_of`, `some_of` and `fits` is needed
"#,
    );
    assert_text(
        &in_slot(r#"(module: "scaled", freeze: {"by": (from: 1.0)})"#),
        r#"
error[SW0103]: a value of another shape is needed for `fill.value.freeze.by`
  --> a.space.ron:4:62
  |
4 |         "value": (module: "scaled", freeze: {"by": (from: 1.0)}),
  |                                                              ^ either `values`, or `from` and `to` with `step` or `steps`
"#,
    );
}

#[test]
fn sw0102_unknown_field() {
    assert_text(
        &in_slot(r#"(one_off: ["plain"])"#),
        r#"
error[SW0102]: there is no field `one_off` in `fill.value`
  --> a.space.ron:4:19
  |
4 |         "value": (one_off: ["plain"]),
  |                   ^^^^^^^ unknown field
  |
  = did you mean `one_of`?
  = fields: module, fill, freeze, label, tags, one_of, some_of, fits, of, without, depth, min, max
"#,
    );
    assert_text(
        &error("(\n    root: \"run\",\n    limits: (texture: 3),\n)\n"),
        r#"
error[SW0102]: there is no field `texture` in `limits`
  --> a.space.ron:3:14
  |
3 |     limits: (texture: 3),
  |              ^^^^^^^ unknown field
  |
  = did you mean `textures`?
  = fields: lacks, textures, samplers, storage_buffers, uniform_buffers, bindings
"#,
    );
}

/// Errors that recipes have too stand where the space says it.
#[test]
fn what_recipes_have_too() {
    assert_text(
        &in_slot(r#"(one_of: ["plain", "scald"])"#),
        r#"
error[SW0201]: there is no module `scald`
  --> a.space.ron:4:37
  |
4 |         "value": (one_of: ["plain", "scald"]),
  |                                     ^^^^^^^ named here
  |
  = did you mean `scaled`?
  = modules: plain, scaled, sum
"#,
    );
    assert_text(
        &in_slot(r#"(module: "scaled", freeze: {"n": (values: [1, 12])})"#),
        r#"
error[SW0302]: the value of `n` does not fit
  --> a.space.ron:4:64
  |
4 |         "value": (module: "scaled", freeze: {"n": (values: [1, 12])}),
  |                                                                ^^ 12 is outside 0 to 9
"#,
    );
    assert_text(
        &in_slot(r#"(one_of: [[], "plain"])"#),
        r#"
error[SW0207]: 0 modules in the slot `value` of `run`
  --> a.space.ron:4:18
  |
4 |         "value": (one_of: [[], "plain"]),
  |                  ^^^^^^^^^^^^^^^^^^^^^^^ it takes exactly one
"#,
    );
    assert_text(
        &in_slot(r#"(fits: Open, without: ["plane"])"#),
        r#"
error[SW0201]: there is no module `plane`
  --> a.space.ron:4:41
  |
4 |         "value": (fits: Open, without: ["plane"]),
  |                                         ^^^^^^^ named here
  |
  = did you mean `plain`?
  = modules: run, plain, scaled, sum
"#,
    );
}

#[test]
fn sw1001_bad_choice() {
    assert_text(
        &in_slot("(one_of: [])"),
        r#"
error[SW1001]: there is nothing to choose from
  --> a.space.ron:4:27
  |
4 |         "value": (one_of: []),
  |                           ^^ empty
"#,
    );
    assert_text(
        &in_slot(r#"(module: "sum", fill: {"all": (some_of: ["plain"], min: 2)})"#),
        r#"
error[SW1001]: no choice keeps these bounds
  --> a.space.ron:4:74
  |
4 |         "value": (module: "sum", fill: {"all": (some_of: ["plain"], min: 2)}),
  |                                                                          ^ there are only 1
"#,
    );
    assert_text(
        &in_slot(r#"(module: "sum", fill: {"all": (some_of: ["plain", "sum"], min: 2, max: 1)})"#),
        r#"
error[SW1001]: no choice keeps these bounds
  --> a.space.ron:4:81
  |
4 |         "value": (module: "sum", fill: {"all": (some_of: ["plain", "sum"], min: 2, max: 1)}),
  |                                                                                 ^ more than the `max` of 1
"#,
    );
    assert_text(
        &in_slot(r#"(fits: Open, of: "value")"#),
        r#"
error[SW1001]: `of` is for the root, which stands in no slot
  --> a.space.ron:4:18
  |
4 |         "value": (fits: Open, of: "value"),
  |                  ^^^^^^^^^^^^^^^^^^^^^^^^^ the slot says of which category
"#,
    );
    assert_text(
        &error("(fits: Open)"),
        r#"
error[SW1001]: `of` is for the root, which stands in no slot
  --> a.space.ron:1:1
  |
1 | (fits: Open)
  | ^^^^^^^^^^^^ of which category?
"#,
    );
    assert_text(
        &error(r#"["plain", "plain"]"#),
        r#"
error[SW1001]: a recipe has exactly one root
  --> a.space.ron:1:1
  |
1 | ["plain", "plain"]
  | ^^^^^^^^^^^^^^^^^^ this is not always one module
"#,
    );
}

#[test]
fn sw1002_bad_values() {
    let freeze = |values: &str| in_slot(&format!(r#"(module: "scaled", freeze: {{"by": {values}}})"#));
    assert_text(
        &freeze("(values: [])"),
        r#"
error[SW1002]: these are no values for `by`
  --> a.space.ron:4:61
  |
4 |         "value": (module: "scaled", freeze: {"by": (values: [])}),
  |                                                             ^^ none is here
  |
  = name at least one value
"#,
    );
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
    assert_text(
        &rule(r#"Excludes(when: "plain", tag: "flatt", among: Tree, because: "no")"#),
        r#"
error[SW1003]: nothing has the tag `flatt`
  --> a.space.ron:3:42
  |
3 |     rules: [Excludes(when: "plain", tag: "flatt", among: Tree, because: "no")],
  |                                          ^^^^^^^ unknown
  |
  = a tag is a module's name, its category, a property that it claims, a role of one of its fields, or a tag of the space
  = did you mean `flat`?
  = tags: flat, pass, plain, run, scaled, sum, value
"#,
    );
    assert_text(
        &rule(r#"Requires(when: "nobody", tag: "flat", among: Tree, because: "no")"#),
        r#"
error[SW1003]: nothing has the tag `nobody`
  --> a.space.ron:3:28
  |
3 |     rules: [Requires(when: "nobody", tag: "flat", among: Tree, because: "no")],
  |                            ^^^^^^^^ unknown
  |
  = a tag is a module's name, its category, a property that it claims, a role of one of its fields, or a tag of the space
  = tags: flat, pass, plain, run, scaled, sum, value
"#,
    );
}

#[test]
fn sw1004_space_too_large() {
    // Chains of eight out of twelve modules: a short text makes a large space.
    let library = (0..12).fold(library(), |library, k| {
        let slot = r#"slots: {"inner": (interface: "value", prefix: "inner_")}"#;
        library.module("value", &format!("chain{k}"), slot, VALUE)
    });
    let text = "(\n    module: \"run\",\n    fill: {\"value\": (fits: Open)},\n)\n";
    let found = Space::parse(&library.catalog().unwrap(), "a.space.ron", text).unwrap_err().render();
    assert_text(
        &found,
        r#"
error[SW1004]: the space has too many alternatives
  --> a.space.ron:3:21
  |
3 |     fill: {"value": (fits: Open)},
  |                     ^^^^^^^^^^^^ with these
  |
  = at most 262144 are taken, those inside one another counted
  = open fewer levels (`depth`), or leave modules out (`without`)
"#,
    );
}

/// The same for a cover.
#[test]
fn sw1004_too_many_options() {
    let values = |from: u32| format!("(from: {from}.0, to: 10.0, steps: 1000)");
    let of: Vec<String> = (0..9)
        .map(|k| format!("(module: \"scaled\", freeze: {{\"by\": {}}})", values(k)))
        .collect();
    let text = format!(
        "(\n    module: \"run\",\n    fill: {{\"value\": (one_of: [{}])}},\n)\n",
        of.join(", ")
    );
    let space = Space::parse(&library().catalog().unwrap(), "a.space.ron", &text).unwrap();
    assert_eq!(space.count().unwrap(), 9009);
    assert_text(
        &space.pairwise().unwrap_err().render(),
        r#"
error[SW1004]: the space has too many alternatives to cover pairwise
  --> a.space.ron:2:13
  |
2 |     module: "run",
  |             ^^^^^ of this
  |
  = it has 9018 options, at most 8192 are taken
  = take a random sample, or leave alternatives out
"#,
    );
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
    let value = format!("(module: \"sum\", fill: {{\"all\": (some_of: [{}])}})", of.join(", "));
    let root = format!("(\n        module: \"run\",\n        fill: {{\"value\": {value}}},\n    )");
    assert_text(
        &error(&format!("(\n    root: {root},\n    rules: [{}],\n)\n", rules.concat())),
        r#"
error[SW1005]: the rules tie together too much of the space
  --> a.space.ron:3:17
  |
3 |         module: "run",
  |                 ^^^^^ of this
  |
  = every tag, limit and label that rules look at multiplies what must be told apart: use fewer, or open less
"#,
    );
}

#[test]
fn sw1006_space_uncountable() {
    let of = vec!["\"plain\""; 128].join(", ");
    let text = format!("(\n    module: \"run\",\n    fill: {{\"value\": (module: \"sum\", fill: {{\"all\": (some_of: [{of}])}})}},\n)\n");
    assert_text(
        &error(&text),
        r#"
error[SW1006]: the space has 340282366920938463463374607431768211455 permutations or more
  --> a.space.ron:2:13
  |
2 |     module: "run",
  |             ^^^^^ of this
  |
  = it can be covered pairwise; to number it, to walk through it or to sample it, leave alternatives out
"#,
    );
    // It can be covered all the same: all there, all absent, and few more.
    let space = Space::parse(&library().catalog().unwrap(), "a.space.ron", &text).unwrap_or_else(|report| panic!("{report}"));
    assert!(
        (2..40).contains(&space.pairwise().unwrap().len()),
        "{}",
        space.pairwise().unwrap().len()
    );
    assert!(space.get(0).is_none() && space.random(1, 0).is_err() && space.iter().is_err());
    assert!(space.pairwise().unwrap().iter().all(|p| p.index.is_none()));

    // One that can be numbered, but not held: the numbers of all would take the machine's memory.
    let of = vec!["\"plain\""; 40].join(", ");
    let text = format!("(\n    module: \"run\",\n    fill: {{\"value\": (module: \"sum\", fill: {{\"all\": (some_of: [{of}])}})}},\n)\n");
    let space = Space::parse(&library().catalog().unwrap(), "a.space.ron", &text).unwrap_or_else(|report| panic!("{report}"));
    assert_text(
        &space.random(usize::MAX, 0).unwrap_err().render(),
        r#"
error[SW1006]: 1099511627776 permutations are more than are drawn at once
  --> a.space.ron:2:13
  |
2 |     module: "run",
  |             ^^^^^ of this
  |
  = at most 16777216 are drawn; all can be walked through
"#,
    );
    assert_eq!(space.random(3, 0).unwrap().len(), 3);
}

#[test]
fn sw1007_space_empty() {
    assert_text(
        &error(
            "(\n    root: (module: \"run\", fill: {\"value\": \"plain\"}),\n    rules: [Requires(tag: \"sum\", among: Children, because: \"sums\")],\n)\n",
        ),
        r#"
error[SW1007]: no permutation of the space is legal
  --> a.space.ron:2:20
  |
2 |     root: (module: "run", fill: {"value": "plain"}),
  |                    ^^^^^ nothing comes of this
  |
  = without `rules[0]` something is: sums
  = the rules of its modules, its own and its limits leave nothing; emit one of its recipes to see which rule it breaks
"#,
    );
    assert_text(
        &error("(\n    root: (module: \"run\", fill: {\"value\": \"plain\"}),\n    limits: (bindings: 0),\n)\n"),
        r#"
error[SW1007]: no permutation of the space is legal
  --> a.space.ron:2:20
  |
2 |     root: (module: "run", fill: {"value": "plain"}),
  |                    ^^^^^ nothing comes of this
  |
  = without `limits` something is
  = the rules of its modules, its own and its limits leave nothing; emit one of its recipes to see which rule it breaks
"#,
    );
    assert_text(
        &error("(\n    root: (module: \"run\", fill: {\"value\": \"scaled\"}),\n    limits: (uniform_buffers: 0),\n)\n"),
        r#"
error[SW1007]: no permutation of the space is legal
  --> a.space.ron:3:13
  |
3 |     limits: (uniform_buffers: 0),
  |             ^^^^^^^^^^^^^^^^^^^^ no tree keeps these limits
  |
  = what every tree shares comes to 1 uniform buffers, 0 allowed
"#,
    );
}

#[test]
fn sw0114_unknown_capability() {
    assert_text(
        &error("(\n    root: \"run\",\n    limits: (lacks: [\"SHADER_FLOAT61\"]),\n)\n"),
        r#"
error[SW0114]: there is no capability `SHADER_FLOAT61`
  --> a.space.ron:3:22
  |
3 |     limits: (lacks: ["SHADER_FLOAT61"]),
  |                      ^^^^^^^^^^^^^^^^ unknown
  |
  = did you mean `SHADER_FLOAT16`?
"#,
    );
}
