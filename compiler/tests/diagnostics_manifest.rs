//! Errors in manifests, whole texts. The places and words are the product: a change of any of them must be meant.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use common::{Texts, assert_text, small};
use shadewright_compiler::{Catalog, Recipe};

/// The error of a library that does not load.
fn load(texts: &Texts) -> String {
    texts.catalog().map_or_else(|report| report.render(), |_| panic!("loaded"))
}

/// The error of a library with a module of this declaration.
fn module(manifest: &str) -> String {
    load(&small().module("value", "m", manifest, ""))
}

/// The error of checking the module `m` of this declaration and text.
fn checked(manifest: &str, wgsl: &str) -> String {
    let catalog = small().module("value", "m", manifest, wgsl).catalog().unwrap();
    catalog
        .check_module("m")
        .map_or_else(|report| report.render(), |()| panic!("accepted"))
}

const VALUE: &str = "fn value(x: f32) -> f32 {\n    return x;\n}\n";

#[test]
fn sw0101_ron_syntax() {
    assert_text(
        &module("slots: {\n    \"a\" (interface: \"value\"),\n}"),
        r#"
error[SW0101]: this is not RON
  --> value/m/module.ron:2:9
  |
2 |     "a" (interface: "value"),
  |         ^ expected colon
"#,
    );
    let recipe = Recipe::parse(
        "my.recipe.ron",
        "(\n    module: \"run\",\n    fill: {\"value\": (module: \"m\"},\n)\n",
    );
    assert_text(
        &recipe.unwrap_err().render(),
        r#"
error[SW0101]: this is not RON
  --> my.recipe.ron:3:33
  |
3 |     fill: {"value": (module: "m"},
  |                                 ^ expected comma
"#,
    );
}

#[test]
fn sw0102_unknown_field() {
    assert_text(
        &module("params: {\n    \"a\": (type: F32, default: 1.0, rang: (0, 2)),\n}"),
        r#"
error[SW0102]: there is no field `rang` in `params.a`
  --> value/m/module.ron:2:36
  |
2 |     "a": (type: F32, default: 1.0, rang: (0, 2)),
  |                                    ^^^^ unknown field
  |
  = did you mean `range`?
  = fields: type, unit, also, default, range, doc, mode, role
"#,
    );
    let recipe = Recipe::parse("my.recipe.ron", "(module: \"run\", fil: {\"value\": \"m\"})");
    assert_text(
        &recipe.unwrap_err().render(),
        r#"
error[SW0102]: there is no field `fil`
  --> my.recipe.ron:1:17
  |
1 | (module: "run", fil: {"value": "m"})
  |                 ^^^ unknown field
  |
  = did you mean `fill`?
  = fields: module, fill, freeze, files, label
"#,
    );
}

#[test]
fn sw0103_wrong_shape() {
    assert_text(
        &module("params: {\n    \"a\": (type: F32, default: 1.0, range: 2),\n}"),
        r#"
error[SW0103]: a value of another shape is needed for `params.a.range`
  --> value/m/module.ron:2:43
  |
2 |     "a": (type: F32, default: 1.0, range: 2),
  |                                           ^ expected opening `(`
"#,
    );
    assert_text(
        &module("params: {\n    \"a\": (type: F32),\n}"),
        r#"
error[SW0103]: the field `default` is missing in `params.a`
  --> value/m/module.ron:2:20
  |
2 |     "a": (type: F32),
  |                    ^ ends without `default`
"#,
    );
}

#[test]
fn sw0104_unknown_variant() {
    assert_text(
        &module("params: {\n    \"a\": (type: Float, default: 1.0),\n}"),
        r#"
error[SW0104]: `Float` is no choice for `params.a.type`
  --> value/m/module.ron:2:17
  |
2 |     "a": (type: Float, default: 1.0),
  |                 ^^^^^ unknown word
  |
  = choices: F32, U32, I32, Bool, Vec2, Vec3, Vec4, Color
"#,
    );
}

#[test]
fn sw0105_duplicate_key() {
    assert_text(
        &module("params: {\n    \"a\": (type: F32, default: 1.0),\n    \"a\": (type: U32, default: 1),\n}"),
        r#"
error[SW0105]: `a` stands twice
  --> value/m/module.ron:3:5
  |
2 |     "a": (type: F32, default: 1.0),
  |     --- the first time
3 |     "a": (type: U32, default: 1),
  |     ^^^ the second time
  |
  = remove one of them
"#,
    );
}

#[test]
fn sw0106_bad_name() {
    assert_text(
        &module(
            "params: {\n    \"vec3\": (type: F32, default: 1.0),\n    \"my-alpha\": (type: F32, default: 1.0),\n    \"loop\": (type: F32, default: 1.0),\n}",
        ),
        r#"
error[SW0106]: `my-alpha` cannot be a name here
  --> value/m/module.ron:3:5
  |
3 |     "my-alpha": (type: F32, default: 1.0),
  |     ^^^^^^^^^^ no WGSL identifier
  |
  = ASCII letters, digits and underscores, not a digit or two underscores first

error[SW0106]: `loop` cannot be a name here
  --> value/m/module.ron:4:5
  |
4 |     "loop": (type: F32, default: 1.0),
  |     ^^^^^^ a word that WGSL reserves
  |
  = ASCII letters, digits and underscores, not a digit or two underscores first
"#,
    );
}

#[test]
fn sw0107_bad_default() {
    assert_text(
        &module("params: {\n    \"a\": (type: F32, unit: \"m\", default: 3.0, range: (0, 2)),\n    \"b\": (type: Vec3, default: 1.0),\n}"),
        r#"
error[SW0107]: the default of `a` does not fit
  --> value/m/module.ron:2:42
  |
2 |     "a": (type: F32, unit: "m", default: 3.0, range: (0, 2)),
  |                                          ^^^ 3 m is outside 0 to 2 m

error[SW0107]: the default of `b` does not fit
  --> value/m/module.ron:3:32
  |
3 |     "b": (type: Vec3, default: 1.0),
  |                                ^^^ expected three numbers in parentheses, found 1
"#,
    );
}

#[test]
fn sw0108_bad_range() {
    assert_text(
        &module("params: {\n    \"a\": (type: F32, default: 1.0, range: (2, 0)),\n}"),
        r#"
error[SW0108]: the range of `a` is empty
  --> value/m/module.ron:2:43
  |
2 |     "a": (type: F32, default: 1.0, range: (2, 0)),
  |                                           ^^^^^^ the first number must be below the second
"#,
    );
}

#[test]
fn sw0109_bad_mode() {
    assert_text(
        &module(
            "params: {\n    \"a\": (type: Bool, default: true),\n    \"b\": (type: Vec2, default: (1, 2), mode: Override),\n},\ninstances: {\n    \"c\": (type: Bool, default: true),\n}",
        ),
        r#"
error[SW0109]: `a` cannot reach the shader this way
  --> value/m/module.ron:2:17
  |
2 |     "a": (type: Bool, default: true),
  |                 ^^^^ WGSL has no `bool` in uniform buffers
  |
  = add `mode: Override` or `mode: Constant`

error[SW0109]: `b` cannot reach the shader this way
  --> value/m/module.ron:3:46
  |
3 |     "b": (type: Vec2, default: (1, 2), mode: Override),
  |                                              ^^^^^^^^ only scalars can be `Override`
  |
  = use `mode: Uniform` or `mode: Constant`

error[SW0109]: `c` cannot be in a buffer
  --> value/m/module.ron:6:17
  |
6 |     "c": (type: Bool, default: true),
  |                 ^^^^ WGSL has no `bool` there
  |
  = make it a `U32`
"#,
    );
}

#[test]
fn sw0110_unknown_pass() {
    assert_text(
        &module(
            "params: {\"size\": (type: U32, default: 64)},\nresources: {\n    \"map\": (kind: Depth(pass: \"shadows\")),\n},\npasses: {\n    \"shadow\": Draw(root: \"run\", view: Cube, resolution: \"size\"),\n}",
        ),
        r#"
error[SW0110]: there is no `Draw` pass `shadows`
  --> value/m/module.ron:3:31
  |
3 |     "map": (kind: Depth(pass: "shadows")),
  |                               ^^^^^^^^^ not declared
  |
  = did you mean `shadow`?
  = passes that draw: shadow
"#,
    );
}

#[test]
fn sw0111_bad_resolution() {
    assert_text(
        &module(
            "params: {\"size\": (type: F32, default: 64), \"sides\": (type: U32, default: 64)},\npasses: {\n    \"shadow\": Draw(root: \"run\", view: Cube, resolution: \"size\"),\n}",
        ),
        r#"
error[SW0111]: the pass `shadow` needs a `U32` parameter for its resolution
  --> value/m/module.ron:3:57
  |
3 |     "shadow": Draw(root: "run", view: Cube, resolution: "size"),
  |                                                         ^^^^^^ not a `U32`
  |
  = did you mean `sides`?
  = `U32` parameters: sides
"#,
    );
}

#[test]
fn sw0112_name_clash() {
    assert_text(
        &module(
            "slots: {\n    \"base\": (interface: \"value\"),\n    \"coat\": (interface: \"value\"),\n},\nresources: {\n    \"params\": (kind: Host(\"x\")),\n}",
        ),
        r#"
error[SW0112]: calls to the slots `base` and `coat` look the same
  --> value/m/module.ron:3:5
  |
2 |     "base": (interface: "value"),
  |     ------ and here
3 |     "coat": (interface: "value"),
  |     ^^^^^^ functions of `value`
  |
  = give one of them a `prefix`

error[SW0112]: a resource cannot be called `params`
  --> value/m/module.ron:6:5
  |
6 |     "params": (kind: Host("x")),
  |     ^^^^^^^^ the linker declares this name
  |
  = choose another name
"#,
    );
}

#[test]
fn sw0113_bad_unit() {
    assert_text(
        &module(
            "params: {\n    \"a\": (type: F32, unit: \"m\", also: {\"cm\": 0}, default: 1.0),\n    \"b\": (type: F32, unit: \"m\", also: {\"m\": 2}, default: 1.0),\n}",
        ),
        r#"
error[SW0113]: `a` cannot be written in `cm`
  --> value/m/module.ron:2:46
  |
2 |     "a": (type: F32, unit: "m", also: {"cm": 0}, default: 1.0),
  |                                              ^ not a positive finite factor

error[SW0113]: `b` cannot be written in `m`
  --> value/m/module.ron:3:45
  |
3 |     "b": (type: F32, unit: "m", also: {"m": 2}, default: 1.0),
  |                                             ^ this is the parameter's own unit
"#,
    );
}

#[test]
fn sw0114_unknown_capability() {
    assert_text(
        &module("capabilities: [\n    \"SHADER_F16\",\n]"),
        r#"
error[SW0114]: there is no capability `SHADER_F16`
  --> value/m/module.ron:2:5
  |
2 |     "SHADER_F16",
  |     ^^^^^^^^^^^^ unknown
  |
  = did you mean `SHADER_FLOAT16`?
"#,
    );
}

#[test]
fn sw0115_unknown_interface() {
    let texts = small().category("other", "uses: [\"valu\"]", "").module(
        "value",
        "m",
        "slots: {\n    \"next\": (interface: \"valve\"),\n},\nuses: [\"xyz\"]",
        "",
    );
    assert_text(
        &load(&texts),
        r#"
error[SW0115]: there is no category `valu`
  --> other/category.ron:1:37
  |
1 | (summary: "other", order: 1, uses: ["valu"])
  |                                     ^^^^^^ named here
  |
  = did you mean `value`?
  = categories: other, pass, value

error[SW0115]: there is no category `xyz`
  --> value/m/module.ron:4:8
  |
4 | uses: ["xyz"])
  |        ^^^^^ named here
  |
  = categories: other, pass, value

error[SW0115]: there is no category `valve`
  --> value/m/module.ron:2:25
  |
2 |     "next": (interface: "valve"),
  |                         ^^^^^^^ named here
  |
  = did you mean `value`?
  = categories: other, pass, value
"#,
    );
}

#[test]
fn sw0116_bad_group() {
    assert_text(
        &load(&small().category("other", "group: 4", "").module(
            "value",
            "m",
            "resources: {\n    \"map\": (kind: Host(\"x\"), group: 7),\n}",
            "",
        )),
        r#"
error[SW0116]: there is no bind group 4
  --> other/category.ron:1:37
  |
1 | (summary: "other", order: 1, group: 4)
  |                                     ^ too large
  |
  = groups: 0 frame, 1 lights and shadows, 2 material, 3 pass

error[SW0116]: there is no bind group 7
  --> value/m/module.ron:2:37
  |
2 |     "map": (kind: Host("x"), group: 7),
  |                                     ^ too large
  |
  = groups: 0 frame, 1 lights and shadows, 2 material, 3 pass
"#,
    );
}

/// A library whose category `value` is declared so, and a recipe that uses it.
fn category(manifest: &str) -> String {
    small()
        .category(
            "value",
            manifest,
            "struct Pair {\n    a: f32,\n    b: vec2f,\n}\n\nfn value(x: f32) -> f32 {\n    return x;\n}\n",
        )
        .module("value", "m", "", VALUE)
        .error(r#"(module: "run", fill: {"value": "m"})"#)
}

#[test]
fn sw0117_unknown_function() {
    assert_text(
        &category("combine: {\n    \"valeu\": Sum,\n}"),
        r#"
error[SW0117]: the interface `value` has no function `valeu`
  --> value/category.ron:2:5
  |
2 |     "valeu": Sum,
  |     ^^^^^^^ named here
  |
  = did you mean `value`?
  = functions: value
"#,
    );
    assert_text(
        &category("offers: [\n    \"help\",\n]"),
        r#"
error[SW0117]: the interface `value` has no function `help`
  --> value/category.ron:2:5
  |
2 |     "help",
  |     ^^^^^^ named here
  |
  = functions: value
"#,
    );
}

#[test]
fn sw0118_bad_interface_default() {
    assert_text(
        &category("defaults: {\n    \"Pear\": {\"a\": 1.0},\n}"),
        r#"
error[SW0118]: the interface `value` has no struct `Pear`
  --> value/category.ron:2:5
  |
2 |     "Pear": {"a": 1.0},
  |     ^^^^^^ no such struct
  |
  = did you mean `Pair`?
  = structs: Pair
"#,
    );
    assert_text(
        &category("defaults: {\n    \"Pair\": {\"c\": 1.0},\n}"),
        r#"
error[SW0118]: `Pair` has no member `c`
  --> value/category.ron:2:14
  |
2 |     "Pair": {"c": 1.0},
  |              ^^^ no such member
  |
  = members: a, b
"#,
    );
    assert_text(
        &category("defaults: {\n    \"Pair\": {\"b\": 1.0},\n}"),
        r#"
error[SW0118]: the default of `Pair.b` is of another type
  --> value/category.ron:2:19
  |
2 |     "Pair": {"b": 1.0},
  |                   ^^^ expected 2 numbers in parentheses
"#,
    );
}

#[test]
fn sw0119_bad_dispatch() {
    let manifest = "passes: {\n    \"reduce\": Compute(entry: \"redcue\", over: Once),\n}";
    let wgsl = format!("{VALUE}\n@compute @workgroup_size(1)\nfn reduce() {{\n}}\n");
    assert_text(
        &checked(manifest, &wgsl),
        r#"
error[SW0119]: `m` has no compute entry point `redcue`
  --> value/m/module.ron:2:30
  |
2 |     "reduce": Compute(entry: "redcue", over: Once),
  |                              ^^^^^^^^ named here
  |
  --> value/m/m.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | - not in this file
  |
  = did you mean `reduce`?
  = compute entry points: reduce
"#,
    );
    let catalog: Catalog = small().module("value", "m", manifest, &wgsl).catalog().unwrap();
    let recipe = Recipe::parse("test.recipe.ron", r#"(module: "run", fill: {"value": "m"})"#).unwrap();
    assert_text(
        &catalog.compile(&recipe, "m.reduce").unwrap_err().render(),
        r#"
error[SW0119]: `m` has no compute entry point `redcue`
  --> value/m/module.ron:2:30
  |
2 |     "reduce": Compute(entry: "redcue", over: Once),
  |                              ^^^^^^^^ named here
  |
  --> value/m/m.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | - not in this file
  |
  = did you mean `reduce`?
  = compute entry points: reduce
"#,
    );
}

/// Catches a check of a module alone that leaves its slots' defaults and its passes' trees to whoever uses it.
#[test]
fn what_a_manifest_names_is_looked_up() {
    assert_text(
        &checked(
            "slots: {\n    \"next\": (interface: \"value\", default: \"mm\", prefix: \"next_\"),\n}",
            VALUE,
        ),
        r#"
error[SW0201]: there is no module `mm`
  --> value/m/module.ron:2:43
  |
2 |     "next": (interface: "value", default: "mm", prefix: "next_"),
  |                                           ^^^^ named here
  |
  = did you mean `m`?
  = modules: m
"#,
    );
    assert_text(
        &checked(
            "params: {\"size\": (type: U32, default: 64)},\npasses: {\n    \"shadow\": Draw(root: (module: \"run\", fill: {\"vlaue\": \"m\"}), view: Cube, resolution: \"size\"),\n}",
            VALUE,
        ),
        r#"
error[SW0204]: `run` has no slot `vlaue`
  --> value/m/module.ron:3:49
  |
3 |     "shadow": Draw(root: (module: "run", fill: {"vlaue": "m"}), view: Cube, resolution: "size"),
  |                                                 ^^^^^^^ no such slot
  |
  = did you mean `value`?
  = slots: value
"#,
    );
}
