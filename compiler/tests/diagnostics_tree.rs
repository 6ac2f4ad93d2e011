//! Errors in recipes: the tree and its parameters. Whole texts: a change of a place or word must be meant.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use common::{Texts, assert_text, small};
use shadewright_compiler::{Recipe, limits};

const VALUE: &str = "fn value(x: f32) -> f32 {\n    return x;\n}\n";

/// `small` with a second category, and modules with slots and parameters.
fn library() -> Texts {
    small()
        .category("other", "", "fn other() -> f32 {\n    return 0.0;\n}\n")
        .module("value", "plain", "", VALUE)
        .module("value", "planar", "", VALUE)
        .module("other", "oddity", "", "fn other() -> f32 {\n    return 1.0;\n}\n")
        .module(
            "value",
            "scaled",
            r#"params: {
    "factor": (type: F32, unit: "m", also: {"cm": 0.01}, default: 1.0, range: (0, 10)),
    "tint": (type: Color, default: (1, 1, 1)),
    "count": (type: U32, default: 3, range: (1, 8)),
},
instances: {"power": (type: F32, default: 1.0)}"#,
            "fn value(x: f32) -> f32 {\n    return x * params.factor * params.tint.x * f32(params.count);\n}\n",
        )
        .module(
            "value",
            "wrap",
            r#"slots: {"inner": (interface: "value", prefix: "inner_"), "maybe": (interface: "value", arity: Optional, prefix: "maybe_")}"#,
            "fn value(x: f32) -> f32 {\n    return inner_value(maybe_value(x));\n}\n",
        )
}

#[test]
fn sw0201_unknown_module() {
    assert_text(
        &library().error("(\n    module: \"run\",\n    fill: {\"value\": \"plane\"},\n)\n"),
        r#"
error[SW0201]: there is no module `plane`
  --> test.recipe.ron:3:21
  |
3 |     fill: {"value": "plane"},
  |                     ^^^^^^^ named here
  |
  = did you mean `plain`?
  = modules: plain, planar, scaled, wrap
"#,
    );
    assert_text(
        &library().error("runn"),
        r#"
error[SW0201]: there is no module `runn`
  --> test.recipe.ron:1:1
  |
1 | runn
  | ^^^^ named here
  |
  = did you mean `run`?
  = modules: oddity, run, plain, planar, scaled, wrap
"#,
    );
}

#[test]
fn sw0202_wrong_category() {
    assert_text(
        &library().error("(module: \"run\", fill: {\"value\": (module: \"oddity\")})"),
        r#"
error[SW0202]: `oddity` is a module of `other`; the slot `value` takes modules of `value`
  --> test.recipe.ron:1:42
  |
1 | (module: "run", fill: {"value": (module: "oddity")})
  |                                          ^^^^^^^^ does not fit here
  |
  = modules of `value`: plain, planar, scaled, wrap
"#,
    );
}

#[test]
fn sw0203_missing_filling() {
    assert_text(
        &library().error("(\n    module: \"run\",\n    fill: {\"value\": (module: \"wrap\")},\n)\n"),
        r#"
error[SW0203]: nothing fills the slot `inner` of `wrap`
  --> test.recipe.ron:3:21
  |
3 |     fill: {"value": (module: "wrap")},
  |                     ^^^^^^^^^^^^^^^^ `inner` is missing here
  |
  = modules of `value` fit: plain, planar, scaled, wrap
"#,
    );
    assert_text(
        &library().error("\"run\""),
        r#"
error[SW0203]: nothing fills the slot `value` of `run`
  --> test.recipe.ron:1:1
  |
1 | "run"
  | ^^^^^ `value` is missing here
  |
  = modules of `value` fit: plain, planar, scaled, wrap
"#,
    );
}

#[test]
fn sw0204_unknown_slot() {
    assert_text(
        &library().error("(module: \"run\", fill: {\n    \"valeu\": \"plain\",\n})"),
        r#"
error[SW0204]: `run` has no slot `valeu`
  --> test.recipe.ron:2:5
  |
2 |     "valeu": "plain",
  |     ^^^^^^^ no such slot
  |
  = did you mean `value`?
  = slots: value
"#,
    );
    assert_text(
        &library().error("(module: \"run\", fill: {\"value\": (module: \"plain\", fill: {\"inner\": \"plain\"})})"),
        r#"
error[SW0204]: `plain` has no slot `inner`
  --> test.recipe.ron:1:58
  |
1 | (module: "run", fill: {"value": (module: "plain", fill: {"inner": "plain"})})
  |                                                          ^^^^^^^ no such slot
  |
  = slots: none
"#,
    );
}

#[test]
fn sw0205_cyclic_tree() {
    let texts = small()
        .module(
            "value",
            "hen",
            "slots: {\"origin\": (interface: \"value\", default: \"egg\", prefix: \"origin_\")}",
            "",
        )
        .module(
            "value",
            "egg",
            "slots: {\"origin\": (interface: \"value\", default: \"hen\", prefix: \"origin_\")}",
            "",
        );
    assert_text(
        &texts.error("(module: \"run\", fill: {\"value\": \"hen\"})"),
        r#"
error[SW0205]: the defaults of `hen` lead back to itself
  --> value/hen/module.ron:1:66
  |
1 | (summary: "hen", slots: {"origin": (interface: "value", default: "egg", prefix: "origin_")})
  |                                                                  ^^^^^ this default is part of the circle
  |
  = the circle is hen -> egg -> hen
  = fill the slot in the recipe, or take one of the defaults away
"#,
    );
    // A module that stands in its own slot because a recipe says so is no circle.
    library().link(r#"(module: "run", fill: {"value": (module: "wrap", fill: {"inner": (module: "wrap", fill: {"inner": "plain"})})})"#);
}

#[test]
fn sw0206_rule_broken() {
    let texts = library()
        .module(
            "value",
            "needy",
            r#"rules: [Requires(tag: "other", among: Tree, because: "it counts on an other")]"#,
            VALUE,
        )
        .module(
            "value",
            "shy",
            r#"rules: [Excludes(tag: "plain", among: Tree, because: "they do not get along")]"#,
            VALUE,
        );
    assert_text(
        &texts.error("(module: \"run\", fill: {\"value\": \"needy\"})"),
        r#"
error[SW0206]: `needy` requires `other` in the tree: it counts on an other
  --> test.recipe.ron:1:33
  |
1 | (module: "run", fill: {"value": "needy"})
  |                                 ^^^^^^^ `needy` stands here
"#,
    );
    assert_text(
        &texts.error(
            "(module: \"run\", fill: {\"value\": (module: \"wrap\", fill: {\n    \"inner\": \"plain\",\n    \"maybe\": \"shy\",\n})})",
        ),
        r#"
error[SW0206]: `shy` excludes `plain` in the tree: they do not get along
  --> test.recipe.ron:3:14
  |
2 |     "inner": "plain",
  |              ------- `plain` stands here
3 |     "maybe": "shy",
  |              ^^^^^ `shy` stands here
"#,
    );
}

#[test]
fn sw0207_too_many_fillings() {
    assert_text(
        &library().error("(module: \"run\", fill: {\n    \"value\": [\"plain\", \"planar\"],\n})"),
        r#"
error[SW0207]: 2 modules in the slot `value` of `run`
  --> test.recipe.ron:2:14
  |
2 |     "value": ["plain", "planar"],
  |              ^^^^^^^^^^^^^^^^^^^ it takes exactly one
"#,
    );
    assert_text(
        &library().error("(module: \"run\", fill: {\"value\": []})"),
        r#"
error[SW0207]: 0 modules in the slot `value` of `run`
  --> test.recipe.ron:1:33
  |
1 | (module: "run", fill: {"value": []})
  |                                 ^^ it takes exactly one
"#,
    );
    assert_text(
        &library().error(
            "(module: \"run\", fill: {\"value\": (module: \"wrap\", fill: {\"inner\": \"plain\", \"maybe\": [\"plain\", \"plain\"]})})",
        ),
        r#"
error[SW0207]: 2 modules in the slot `maybe` of `wrap`
  --> test.recipe.ron:1:84
  |
1 | (module: "run", fill: {"value": (module: "wrap", fill: {"inner": "plain", "maybe": ["plain", "plain"]})})
  |                                                                                    ^^^^^^^^^^^^^^^^^^ it takes at most one
"#,
    );
}

#[test]
fn sw0208_ambiguous_name() {
    let texts = library().module("other", "plain", "", "fn other() -> f32 {\n    return 1.0;\n}\n");
    assert_text(
        &texts.error("(module: \"plain\")"),
        r#"
error[SW0208]: several modules are called `plain`
  --> test.recipe.ron:1:10
  |
1 | (module: "plain")
  |          ^^^^^^^ named here
  |
  = write one of `other/plain`, `value/plain`
"#,
    );
    // In a slot the category is known.
    texts.link(r#"(module: "run", fill: {"value": "plain"})"#);
}

#[test]
fn sw0209_bad_label() {
    assert_text(
        &library().error("(module: \"run\", fill: {\"value\": (module: \"plain\", label: \"top coat\")})"),
        r#"
error[SW0209]: the label `top coat` is no identifier
  --> test.recipe.ron:1:58
  |
1 | (module: "run", fill: {"value": (module: "plain", label: "top coat")})
  |                                                          ^^^^^^^^^^ letters, digits and underscores, not a digit first
"#,
    );
    assert_text(
        &library().error(
            "(module: \"run\", fill: {\"value\": (module: \"wrap\", fill: {\n    \"inner\": (module: \"scaled\", label: \"top\"),\n    \"maybe\": (module: \"scaled\", label: \"top\", freeze: {\"count\": 2}),\n})})",
        ),
        r#"
error[SW0209]: the label `top` stands at two different subtrees of `scaled`
  --> test.recipe.ron:3:40
  |
2 |     "inner": (module: "scaled", label: "top"),
  |                                        ----- the first one
3 |     "maybe": (module: "scaled", label: "top", freeze: {"count": 2}),
  |                                        ^^^^^ the second one
  |
  = a label names one subtree, wherever it stands: choose another one here
"#,
    );
}

#[test]
fn sw0210_not_combinable() {
    let texts = library()
        .category(
            "many",
            "combine: {\"first\": Sum}",
            "fn first() -> f32 {\n    return 0.0;\n}\n\nfn second() -> f32 {\n    return 0.0;\n}\n",
        )
        .module(
            "many",
            "one",
            "",
            "fn first() -> f32 {\n    return 1.0;\n}\n\nfn second() -> f32 {\n    return 1.0;\n}\n",
        )
        .module(
            "many",
            "two",
            "",
            "fn first() -> f32 {\n    return 2.0;\n}\n\nfn second() -> f32 {\n    return 2.0;\n}\n",
        )
        .module(
            "value",
            "list",
            r#"slots: {"all": (interface: "many", arity: List)}"#,
            "fn value(x: f32) -> f32 {\n    return first() + second();\n}\n",
        );
    assert_text(
        &texts.error("(module: \"run\", fill: {\"value\": (module: \"list\", fill: {\n    \"all\": [\"one\", \"two\"],\n})})"),
        r#"
error[SW0210]: `many` does not say how results of `second` combine in the slot `all`
  --> test.recipe.ron:2:20
  |
2 |     "all": ["one", "two"],
  |                    ^^^^^ a second module stands in that slot here
  |
  --> many/category.ron:1:38
  |
1 | (summary: "many", order: 1, combine: {"first": Sum})
  |                                      -------------- no rule for it here
  |
  = `combine` in the interface's category.ron names the rule: Sum, Product or Chain
"#,
    );
    texts.link(r#"(module: "run", fill: {"value": (module: "list", fill: {"all": ["one"]})})"#);
}

#[test]
fn sw0211_not_a_root() {
    assert_text(
        &library().error("(\n    module: \"plain\",\n)"),
        r#"
error[SW0211]: `plain` has no entry points
  --> test.recipe.ron:2:13
  |
2 |     module: "plain",
  |             ^^^^^^^ a pass is needed here
  |
  = a subtree without entry points can be probed, not emitted
"#,
    );
}

#[test]
fn sw0212_unknown_pass_of_recipe() {
    let manifest = "passes: {\"reduce\": Compute(entry: \"reduce\", over: Once)}";
    let texts = library().module(
        "value",
        "busy",
        manifest,
        &format!("{VALUE}\n@compute @workgroup_size(1)\nfn reduce() {{\n}}\n"),
    );
    let recipe = Recipe::parse("test.recipe.ron", r#"(module: "run", fill: {"value": "busy"})"#).unwrap();
    assert_text(
        &texts.catalog().unwrap().compile(&recipe, "busy.redcue").unwrap_err().render(),
        r#"
error[SW0212]: the recipe has no pass `busy.redcue`
  --> test.recipe.ron:1:10
  |
1 | (module: "run", fill: {"value": "busy"})
  |          ^^^^^ in the tree of this root
  |
  = did you mean `busy.reduce`?
  = passes: main, busy.reduce
"#,
    );
}

#[test]
fn sw0213_unknown_probe() {
    let recipe = Recipe::parse("test.recipe.ron", "(module: \"plain\")").unwrap();
    assert_text(
        &library().catalog().unwrap().compile_probe(&recipe, "valeu").unwrap_err().render(),
        r#"
error[SW0213]: `value` has no function `valeu`
  --> test.recipe.ron:1:10
  |
1 | (module: "plain")
  |          ^^^^^^^ a module of `value`
  |
  = did you mean `value`?
  = functions: value
"#,
    );
    let walking = library()
        .category(
            "walk",
            "",
            "fn walk(at: ptr<function, vec2f>, far: f32) -> f32 {\n    return 0.0;\n}\n",
        )
        .module(
            "walk",
            "ahead",
            "",
            "fn walk(at: ptr<function, vec2f>, far: f32) -> f32 {\n    return far;\n}\n",
        );
    let recipe = Recipe::parse("test.recipe.ron", "(module: \"ahead\")").unwrap();
    assert_text(
        &walking.catalog().unwrap().compile_probe(&recipe, "walk").unwrap_err().render(),
        r#"
error[SW0213]: `walk` of `walk` cannot be probed
  --> test.recipe.ron:1:10
  |
1 | (module: "ahead")
  |          ^^^^^^^ a module of `walk`
  |
  = `at` is a pointer, and a table of inputs holds values
"#,
    );
}

/// The error of freezing so.
fn frozen(freeze: &str) -> String {
    library().error(&format!(
        "(module: \"run\", fill: {{\n    \"value\": (module: \"scaled\", freeze: {{{freeze}}}),\n}})"
    ))
}

#[test]
fn sw0301_unknown_param() {
    assert_text(
        &frozen("\"facto\": 2"),
        r#"
error[SW0301]: `scaled` has no parameter `facto`
  --> test.recipe.ron:2:42
  |
2 |     "value": (module: "scaled", freeze: {"facto": 2}),
  |                                          ^^^^^^^ no such parameter
  |
  = did you mean `factor`?
  = parameters: factor, tint, count
"#,
    );
    assert_text(
        &library().error("(module: \"run\", fill: {\"value\": (module: \"plain\", freeze: {\"x\": 1})})"),
        r#"
error[SW0301]: `plain` has no parameter `x`
  --> test.recipe.ron:1:60
  |
1 | (module: "run", fill: {"value": (module: "plain", freeze: {"x": 1})})
  |                                                            ^^^ no such parameter
  |
  = parameters: none
"#,
    );
}

#[test]
fn sw0302_param_out_of_range() {
    assert_text(
        &frozen("\"factor\": \"2000 cm\""),
        r#"
error[SW0302]: the value of `factor` does not fit
  --> test.recipe.ron:2:52
  |
2 |     "value": (module: "scaled", freeze: {"factor": "2000 cm"}),
  |                                                    ^^^^^^^^^ 20 m is outside 0 to 10 m
"#,
    );
    assert_text(
        &frozen("\"count\": 0"),
        r#"
error[SW0302]: the value of `count` does not fit
  --> test.recipe.ron:2:51
  |
2 |     "value": (module: "scaled", freeze: {"count": 0}),
  |                                                   ^ 0 is outside 1 to 8
"#,
    );
}

#[test]
fn sw0303_param_wrong_type() {
    assert_text(
        &frozen("\"count\": 2.5"),
        r#"
error[SW0303]: the value of `count` does not fit
  --> test.recipe.ron:2:51
  |
2 |     "value": (module: "scaled", freeze: {"count": 2.5}),
  |                                                   ^^^ expected a whole number from 0, found 2.5
"#,
    );
    assert_text(
        &frozen("\"tint\": true"),
        r#"
error[SW0303]: the value of `tint` does not fit
  --> test.recipe.ron:2:50
  |
2 |     "value": (module: "scaled", freeze: {"tint": true}),
  |                                                  ^^^^ expected three numbers in parentheses, linear Rec.709, or a temperature such as "2700 K", found true
"#,
    );
}

#[test]
fn sw0304_unknown_unit() {
    assert_text(
        &frozen("\"factor\": \"2 km\""),
        r#"
error[SW0304]: the value of `factor` does not fit
  --> test.recipe.ron:2:52
  |
2 |     "value": (module: "scaled", freeze: {"factor": "2 km"}),
  |                                                    ^^^^^^ the unit `km` is not taken here
  |
  = units: m, cm
"#,
    );
}

#[test]
fn sw0305_param_not_finite() {
    assert_text(
        &frozen("\"factor\": inf"),
        r#"
error[SW0305]: the value of `factor` does not fit
  --> test.recipe.ron:2:52
  |
2 |     "value": (module: "scaled", freeze: {"factor": inf}),
  |                                                    ^^^ inf is not a finite number of 32 bits
"#,
    );
}

#[test]
fn sw0306_bad_temperature() {
    assert_text(
        &frozen("\"tint\": \"100 K\""),
        r#"
error[SW0306]: the value of `tint` does not fit
  --> test.recipe.ron:2:50
  |
2 |     "value": (module: "scaled", freeze: {"tint": "100 K"}),
  |                                                  ^^^^^^^ a colour temperature of 100 K is outside 1000 to 40000 K
"#,
    );
}

#[test]
fn sw0307_instance_field_frozen() {
    assert_text(
        &frozen("\"power\": 5"),
        r#"
error[SW0307]: `power` differs from instance to instance
  --> test.recipe.ron:2:42
  |
2 |     "value": (module: "scaled", freeze: {"power": 5}),
  |                                          ^^^^^^^ a recipe cannot freeze it
  |
  = a field of `instances` has a value for each thing of a scene: set it there
"#,
    );
}

#[test]
fn sw0703_tree_too_deep() {
    let depth = limits::TREE_DEPTH;
    let nested = |n: usize| {
        format!(
            "(module: \"run\", fill: {{\"value\":\n{}\"plain\"{}}})",
            "(module: \"wrap\", fill: {\"inner\":\n".repeat(n),
            "})".repeat(n)
        )
    };
    library().link(&nested(depth - 4));
    let texts = (0..=depth).fold(library(), |texts, i| {
        let slot = format!(
            "slots: {{\"inner\": (interface: \"value\", default: \"step{}\", prefix: \"inner_\")}}",
            i + 1
        );
        texts.module("value", &format!("step{i}"), &slot, VALUE)
    });
    let texts = texts.module("value", &format!("step{}", depth + 1), "", VALUE);
    assert_text(
        &texts.error("(module: \"run\", fill: {\"value\": \"step0\"})"),
        r#"
error[SW0703]: the tree is deeper than 32 slots
  --> value/step31/module.ron:1:68
  |
1 | (summary: "step31", slots: {"inner": (interface: "value", default: "step32", prefix: "inner_")})
  |                                                                    ^^^^^^^^ here it goes too deep
"#,
    );
}

#[test]
fn sw0704_too_many_instances() {
    let texts = (0..10).fold(library(), |texts, i| {
        let slot = format!(
            "slots: {{\"a\": (interface: \"value\", default: \"pair{0}\", prefix: \"a_\"), \"b\": (interface: \"value\", default: \"pair{0}\", prefix: \"b_\")}}",
            i + 1
        );
        texts.module("value", &format!("pair{i}"), &slot, VALUE)
    });
    let texts = texts.module("value", "pair10", "", VALUE);
    assert_text(
        &texts.error("(module: \"run\", fill: {\"value\": \"pair0\"})"),
        r#"
error[SW0704]: the tree has more than 1024 modules
  --> value/pair9/module.ron:1:123
  |
1 | (summary: "pair9", slots: {"a": (interface: "value", default: "pair10", prefix: "a_"), "b": (interface: "value", default: "pair10", prefix: "b_")})
  |                                                                                                                           ^^^^^^^^ with this one
"#,
    );
}
