//! Errors in the WGSL of modules and interfaces, whole texts: a change of a place or word must be meant.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use common::{Texts, assert_text, small};

/// Linked by `recipe()`.
const RECIPE: &str = "(module: \"run\", fill: {\"value\": \"m\"})";

/// The error of a module `m` of `value` with this manifest and text, linked.
fn module(manifest: &str, wgsl: &str) -> String {
    small().module("value", "m", manifest, wgsl).error(RECIPE)
}

/// The error of an interface with this text.
fn interface(wgsl: &str) -> String {
    small()
        .category("value", "", wgsl)
        .module("value", "m", "", "fn value(x: f32) -> f32 {\n    return x;\n}\n")
        .error(RECIPE)
}

#[test]
fn sw0401_syntax() {
    assert_text(
        &module("", "fn value(x: f32) -> f32 {\n    let y = x * 2.0\n    return y;\n}\n"),
        r#"
error[SW0401]: expected `;`, found "return"
  --> value/m/m.wgsl:3:5
  |
3 |     return y;
  |     ^^^^^^ expected `;`
"#,
    );
    assert_text(
        &module("", "// Grün\nfn value(x: f32) -> f32 {\n    return x +* 2.0;\n}\n"),
        r#"
error[SW0402]: the operand of the `*` operator must be a pointer
  --> value/m/m.wgsl:3:15
  |
3 |     return x +* 2.0;
  |               ^^^^^ expression is not a pointer
"#,
    );
    assert_text(
        &module("", "fn value(x: f32) -> f32 {\n    return x;\n"),
        r#"
error[SW0401]: a bracket is never closed
  --> value/m/m.wgsl:1:25
  |
1 | fn value(x: f32) -> f32 {
  |                         ^ opened here
2 |     return x;
  |              - the file ends here
"#,
    );
    assert_text(
        &interface("fn value(x: f32) -> f32 {\n    return x\n}\n"),
        r#"
error[SW0401]: expected `;`, found "}"
  --> value/interface.wgsl:3:1
  |
3 | }
  | ^ expected `;`
"#,
    );
    assert_text(
        &module("", "#import other\nfn value(x: f32) -> f32 {\n    return x;\n}\n"),
        r##"
error[SW0401]: expected global item (`struct`, `const`, `var`, `alias`, `fn`, `diagnostic`, `enable`, `requires`, `;`) or the end of the file, found "#"
  --> value/m/m.wgsl:1:1
  |
1 | #import other
  | ^ expected global item (`struct`, `const`, `var`, `alias`, `fn`, `diagnostic`, `enable`, `requires`, `;`) or the end of the file
"##,
    );
}

#[test]
fn sw0402_type() {
    assert_text(
        &module("", "fn value(x: f32) -> f32 {\n    let y: u32 = x;\n    return x;\n}\n"),
        r#"
error[SW0402]: the type of `y` is expected to be `u32`, but got `f32`
  --> value/m/m.wgsl:2:9
  |
2 |     let y: u32 = x;
  |         ^ definition of `y`
"#,
    );
    assert_text(
        &module("", "fn value(x: f32) -> f32 {\n    return y;\n}\n"),
        r#"
error[SW0402]: no definition in scope for identifier: `y`
  --> value/m/m.wgsl:2:12
  |
2 |     return y;
  |            ^ unknown identifier
"#,
    );
    assert_text(
        &module("", "fn value(x: f32) -> f32 {\n    return vec2f(x);\n}\n"),
        r#"
error[SW0402]: Function 'value' is invalid: The `return` expression does not match the declared return type
  --> value/m/m.wgsl:2:12
  |
1 | fn value(x: f32) -> f32 {
  | ----------------------- in this function
2 |     return vec2f(x);
  |            ^^^^^^^^ this expression
"#,
    );
    assert_text(
        &module("", "fn value(x: f32) -> f32 {\n    return params.x;\n}\n"),
        r#"
error[SW0301]: the module has no parameter `x`
  --> value/m/m.wgsl:2:12
  |
2 |     return params.x;
  |            ^^^^^^^^ not under `params` of `value/m/module.ron`
  |
  = parameters: none
"#,
    );
    // A call of a slot's function with another number of arguments: the interface is shown too.
    assert_text(
        &module(
            r#"slots: {"next": (interface: "value", arity: Optional, prefix: "next_")}"#,
            "fn value(x: f32) -> f32 {\n    return next_value(x, x);\n}\n",
        ),
        r#"
error[SW0402]: Function 'value' is invalid: Call to `next_value` is invalid: Requires 1 arguments, but 2 are provided
  --> value/m/m.wgsl:2:12
  |
1 | fn value(x: f32) -> f32 {
  | ----------------------- in this function
2 |     return next_value(x, x);
  |            ^^^^^^^^^^^^^^^^ invalid function call
  |
  --> value/interface.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | ----------------------- called like this
"#,
    );
    assert_text(
        &interface("fn value(x: f32) -> f32 {\n    return vec2f(x);\n}\n"),
        r#"
error[SW0402]: Function 'value' is invalid: The `return` expression does not match the declared return type
  --> value/interface.wgsl:2:12
  |
1 | fn value(x: f32) -> f32 {
  | ----------------------- in this function
2 |     return vec2f(x);
  |            ^^^^^^^^ this expression
"#,
    );
}

#[test]
fn sw0403_duplicate_symbol() {
    assert_text(
        &module(
            "",
            "fn value(x: f32) -> f32 {\n    return x;\n}\n\nfn value(x: f32) -> f32 {\n    return x;\n}\n",
        ),
        r#"
error[SW0403]: `value` is declared twice
  --> value/m/m.wgsl:5:4
  |
1 | fn value(x: f32) -> f32 {
  |    ----- first declared here
  .
5 | fn value(x: f32) -> f32 {
  |    ^^^^^ declared again here
"#,
    );
    assert_text(
        &module(
            r#"slots: {"next": (interface: "value", arity: Optional)}"#,
            "fn value(x: f32) -> f32 {\n    return value(x);\n}\n",
        ),
        r#"
error[SW0403]: `value` is declared here and is also a function of the slot `next`
  --> value/m/m.wgsl:1:4
  |
1 | fn value(x: f32) -> f32 {
  |    ^^^^^ declared here
  |
  --> value/interface.wgsl:1:4
  |
1 | fn value(x: f32) -> f32 {
  |    ----- and here
  |
  = give it another name, or the slot a `prefix` in module.ron
"#,
    );
    let texts = small().category(
        "value",
        "",
        "/// What comes in.\nstruct Input {\n    x: f32,\n}\n\nfn value(x: f32) -> f32 {\n    return x;\n}\n",
    );
    assert_text(
        &texts
            .clone()
            .module(
                "value",
                "m",
                "",
                "struct Input {\n    y: f32,\n}\n\nfn value(x: f32) -> f32 {\n    return x;\n}\n",
            )
            .error(RECIPE),
        r#"
error[SW0403]: `Input` is declared here and is also declared by the interface `value`
  --> value/m/m.wgsl:1:8
  |
1 | struct Input {
  |        ^^^^^ declared here
  |
  --> value/interface.wgsl:2:8
  |
2 | struct Input {
  |        ----- and here
  |
  = give it another name; what an interface declares is there without being declared again
"#,
    );
    let other = "fn help() -> f32 {\n    return 0.0;\n}\n";
    assert_text(
        &small()
            .category("first", "", other)
            .category("second", "", other)
            .module(
                "value",
                "m",
                "slots: {\n    \"a\": (interface: \"first\", arity: Optional),\n    \"b\": (interface: \"second\", arity: Optional),\n}",
                "fn value(x: f32) -> f32 {\n    return help();\n}\n",
            )
            .error(RECIPE),
        r#"
error[SW0403]: `help` would mean two things in this module
  --> value/m/module.ron:3:5
  |
3 |     "b": (interface: "second", arity: Optional),
  |     ^^^ this brings in a second `help`
  |
  --> second/interface.wgsl:1:4
  |
1 | fn help() -> f32 {
  |    ---- declared here
  |
  --> first/interface.wgsl:1:4
  |
1 | fn help() -> f32 {
  |    ---- declared here
  |
  = give one of the slots a `prefix` in module.ron
"#,
    );
    let input = "struct Input {\n    x: f32,\n}\n";
    assert_text(
        &small()
            .category("first", "", input)
            .category("second", "", input)
            .module(
                "value",
                "m",
                "uses: [\"first\", \"second\"]",
                "fn value(x: f32) -> f32 {\n    return x;\n}\n",
            )
            .error(RECIPE),
        r#"
error[SW0403]: `Input` would mean two things in this module
  --> value/m/module.ron:1:22
  |
1 | (summary: "m", uses: ["first", "second"])
  |                      ^^^^^^^^^^^^^^^^^^^ this brings in a second `Input`
  |
  --> second/interface.wgsl:1:8
  |
1 | struct Input {
  |        ----- declared here
  |
  --> first/interface.wgsl:1:8
  |
1 | struct Input {
  |        ----- declared here
  |
  = use one of the two interfaces only
"#,
    );
}

#[test]
fn sw0404_signature_mismatch() {
    assert_text(
        &module("", "fn value(\n    x: f32,\n    y: f32,\n) -> f32 {\n    return x;\n}\n"),
        r#"
error[SW0404]: `value` has another signature than the interface `value` says
  --> value/m/m.wgsl:1:1
  |  
1 | / fn value(
2 | |     x: f32,
3 | |     y: f32,
4 | | ) -> f32 {
  | \--------^ found `fn value( x: f32, y: f32, ) -> f32`
  |  
  --> value/interface.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | ----------------------- expected `fn value(x: f32) -> f32`
"#,
    );
    assert_text(
        &module("", "fn value(x: f32) -> vec3f {\n    return vec3f(x);\n}\n"),
        r#"
error[SW0404]: `value` has another signature than the interface `value` says
  --> value/m/m.wgsl:1:1
  |
1 | fn value(x: f32) -> vec3f {
  | ^^^^^^^^^^^^^^^^^^^^^^^^^ found `fn value(x: f32) -> vec3f`
  |
  --> value/interface.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | ----------------------- expected `fn value(x: f32) -> f32`
"#,
    );
}

/// A category `sieve` whose modules call `fetch`, which the owner of their slot offers.
fn offering(owner: &str) -> Texts {
    small()
        .category(
            "sieve",
            "offers: [\"fetch\"]",
            "fn filtered(x: f32) -> f32 {\n    return x;\n}\n\n/// Offered by the owner.\nfn fetch(x: f32) -> f32 {\n    return x;\n}\n",
        )
        .module(
            "sieve",
            "twice",
            "",
            "fn filtered(x: f32) -> f32 {\n    return fetch(x) + fetch(x + 1.0);\n}\n",
        )
        .module("value", "m", r#"slots: {"sieve": (interface: "sieve", default: "twice")}"#, owner)
}

#[test]
fn sw0404_offered_with_another_signature() {
    assert_text(
        &offering("fn fetch(x: vec2f) -> f32 {\n    return x.x;\n}\n\nfn value(x: f32) -> f32 {\n    return filtered(x);\n}\n")
            .error(RECIPE),
        r#"
error[SW0404]: `fetch` is offered with another signature than it is called with
  --> value/m/m.wgsl:1:1
  |
1 | fn fetch(x: vec2f) -> f32 {
  | ^^^^^^^^^^^^^^^^^^^^^^^^^ found this
  |
  --> sieve/interface.wgsl:6:1
  |
6 | fn fetch(x: f32) -> f32 {
  | ----------------------- expected this
"#,
    );
}

#[test]
fn sw0405_missing_function() {
    assert_text(
        &module("", "fn valeu(x: f32) -> f32 {\n    return x;\n}\n"),
        r#"
error[SW0405]: the module does not define `value` of the interface `value`
  --> value/m/m.wgsl:1:1
  |
1 | fn valeu(x: f32) -> f32 {
  | ^ in this file
  |
  --> value/interface.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | ----------------------- declared here
  |
  = `valeu` has nearly this name
  = add `fn value(x: f32) -> f32 { ... }`
"#,
    );
    assert_text(
        &offering("fn value(x: f32) -> f32 {\n    return filtered(x);\n}\n").error(RECIPE),
        r#"
error[SW0405]: the module does not define `fetch`, which `twice` calls
  --> value/m/m.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | ^ in this file
  |
  --> value/m/module.ron:1:63
  |
1 | (summary: "m", slots: {"sieve": (interface: "sieve", default: "twice")})
  |                                                               ------- `twice` fills one of its slots here
  |
  = modules of `sieve` call functions of the module that they serve
"#,
    );
}

#[test]
fn sw0406_untyped_constant() {
    assert_text(
        &interface("const SCALE = 2.0;\n\nfn value(x: f32) -> f32 {\n    return x;\n}\n"),
        r#"
error[SW0406]: the interface's constant `SCALE` has no type
  --> value/interface.wgsl:1:7
  |
1 | const SCALE = 2.0;
  |       ^^^^^ a type is missing behind this name
  |
  = an untyped constant is folded away where it is parsed, so modules could not share it: write `const NAME: f32 = ...`
"#,
    );
}

#[test]
fn sw0407_recursion_across_modules() {
    assert_text(
        &offering("fn fetch(x: f32) -> f32 {\n    return value(x - 1.0);\n}\n\nfn value(x: f32) -> f32 {\n    return filtered(x);\n}\n")
            .error(RECIPE),
        r#"
error[SW0407]: functions of modules call each other in a circle
  --> value/m/m.wgsl:5:4
  |
1 | fn fetch(x: f32) -> f32 {
  |    ----- part of the circle
  .
5 | fn value(x: f32) -> f32 {
  |    ^^^^^ part of the circle
  |
  --> sieve/twice/twice.wgsl:1:4
  |
1 | fn filtered(x: f32) -> f32 {
  |    -------- part of the circle
  |
  = the circle is m::value -> twice::filtered -> m::fetch -> m::value
  = WGSL has no recursion
"#,
    );
}

#[test]
fn sw0402_recursion_inside_a_module() {
    assert_text(
        &module(
            "",
            "fn more(x: f32) -> f32 {\n    return value(x);\n}\n\nfn value(x: f32) -> f32 {\n    return more(x);\n}\n",
        ),
        r#"
error[SW0402]: declaration of `more` is cyclic
  --> value/m/m.wgsl:5:4
  |
1 | fn more(x: f32) -> f32 {
  |    ----
2 |     return value(x);
  |            ----- uses `value`
  .
5 | fn value(x: f32) -> f32 {
  |    ^^^^^
6 |     return more(x);
  |            ---- ending the cycle
"#,
    );
}

#[test]
fn sw0408_undeclared_resource() {
    let wgsl = "var<storage, read> table: array<f32>;\n\nfn value(x: f32) -> f32 {\n    return table[0];\n}\n";
    assert_text(
        &module("", wgsl),
        r#"
error[SW0408]: the manifest does not declare the resource `table`
  --> value/m/m.wgsl:1:20
  |
1 | var<storage, read> table: array<f32>;
  |                    ^^^^^ declared here, but not under `resources`
  |
  = the host must know how to fill it: add it to `resources` of the manifest beside this file
"#,
    );
    let catalog = |manifest: &str, wgsl: &str| small().module("value", "m", manifest, wgsl).catalog().unwrap().check_module("m");
    assert_text(
        &catalog("", wgsl).unwrap_err().render(),
        r#"
error[SW0408]: the manifest does not declare the resource `table`
  --> value/m/m.wgsl:1:20
  |
1 | var<storage, read> table: array<f32>;
  |                    ^^^^^ declared here, but not under `resources`
  |
  = the host must know how to fill it: add it to `resources` of module.ron
"#,
    );
    let manifest = "resources: {\n    \"tabel\": (kind: Host(\"table\")),\n}";
    assert_text(
        &catalog(manifest, "fn value(x: f32) -> f32 {\n    return x;\n}\n")
            .unwrap_err()
            .render(),
        r#"
error[SW0408]: the WGSL does not declare the resource `tabel`
  --> value/m/module.ron:2:5
  |
2 |     "tabel": (kind: Host("table")),
  |     ^^^^^^^ declared here
  |
  --> value/m/m.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | - but there is no such variable in this file
"#,
    );
    assert_text(
        &small()
            .category("value", manifest, "fn value(x: f32) -> f32 {\n    return x;\n}\n")
            .module("value", "m", "", "fn value(x: f32) -> f32 {\n    return x;\n}\n")
            .error(RECIPE),
        r#"
error[SW0408]: the interface does not declare the resource `tabel`
  --> value/category.ron:2:5
  |
2 |     "tabel": (kind: Host("table")),
  |     ^^^^^^^ declared here
  |
  --> value/interface.wgsl:1:1
  |
1 | fn value(x: f32) -> f32 {
  | - but there is no such variable in this file
"#,
    );
}

#[test]
fn sw0409_params_misused() {
    let params = r#"params: {"a": (type: F32, default: 1.0), "b": (type: F32, default: 1.0)}"#;
    assert_text(
        &module(params, "fn value(x: f32) -> f32 {\n    let all = params;\n    return all.a;\n}\n"),
        r#"
error[SW0409]: `params` is used as a whole
  --> value/m/m.wgsl:2:15
  |
2 |     let all = params;
  |               ^^^^^^ only members can be read: `params.name`
"#,
    );
    assert_text(
        &module(
            params,
            "fn help(p: ptr<uniform, Params>) -> f32 {\n    return p.a;\n}\n\nfn value(x: f32) -> f32 {\n    return help(&params);\n}\n",
        ),
        r#"
error[SW0402]: Function 'help' is invalid: Argument 'p' at index 0 is a pointer of space Uniform, which can't be passed into functions.
  --> value/m/m.wgsl:1:1
  |
1 | fn help(p: ptr<uniform, Params>) -> f32 {
  | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ in this function
"#,
    );
    let instances = r#"instances: {"a": (type: F32, default: 1.0)}"#;
    assert_text(
        &module(
            instances,
            "fn help(p: ptr<storage, array<Instance>>) -> f32 {\n    return p[0].a;\n}\n\nfn value(x: f32) -> f32 {\n    return help(&instances);\n}\n",
        ),
        r#"
error[SW0402]: Function 'help' is invalid: Argument 'p' at index 0 is a pointer of space Storage { access: StorageAccess(LOAD) }, which can't be passed into functions.
  --> value/m/m.wgsl:1:1
  |
1 | fn help(p: ptr<storage, array<Instance>>) -> f32 {
  | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ in this function
"#,
    );
}

#[test]
fn sw0410_explicit_binding() {
    assert_text(
        &module(
            r#"resources: {"table": (kind: Host("table"))}"#,
            "@group(2) @binding(0) var<storage, read> table: array<f32>;\n\nfn value(x: f32) -> f32 {\n    return table[0];\n}\n",
        ),
        r#"
error[SW0410]: `table` has a fixed @group
  --> value/m/m.wgsl:1:1
  |
1 | @group(2) @binding(0) var<storage, read> table: array<f32>;
  | ^^^^^^ the linker numbers bindings
  |
  = leave @group and @binding out; `group` of the resource in module.ron chooses the bind group
"#,
    );
}

#[test]
fn sw0411_entry_point_io() {
    let texts = small().module(
        "pass",
        "draw",
        "",
        "@vertex\nfn vertex_main(@location(0) position: vec3f) -> @builtin(position) vec4f {\n    return vec4f(position, 1.0);\n}\n",
    );
    assert_text(
        &texts.error("draw"),
        r#"
error[SW0411]: the entry point `vertex_main` has a @location outside a struct
  --> pass/draw/draw.wgsl:2:16
  |
2 | fn vertex_main(@location(0) position: vec3f) -> @builtin(position) vec4f {
  |                ^^^^^^^^^^^^^^^^^^^^^^^^^^^^ this could not be left out
  |
  = put inputs and outputs with @location into a struct, so that those nobody reads can be left out
"#,
    );
}

#[test]
fn sw0412_missing_wgsl() {
    let mut texts = small().module("value", "m", "", "");
    texts.0.remove("value/m/m.wgsl");
    assert_text(
        &texts.error(RECIPE),
        r#"
error[SW0412]: `value/m/m.wgsl` is not there
  --> value/m/module.ron:1:1
  |
1 | (summary: "m", )
  | ^ declared here
  |
  = a module's WGSL is called like its folder
"#,
    );
}

#[test]
fn sw0413_reserved_name() {
    let params = r#"params: {"a": (type: F32, default: 1.0), "n": (type: U32, default: 1, mode: Constant)}"#;
    assert_text(
        &module(
            params,
            "fn value(params: f32) -> f32 {\n    return params;\n}\n\nstruct Params {\n    a: f32,\n}\n",
        ),
        r#"
error[SW0413]: `Params` is a name that the linker gives to the struct of the parameters
  --> value/m/m.wgsl:5:8
  |
5 | struct Params {
  |        ^^^^^^ declared here
  |
  = give it another name
"#,
    );
    assert_text(
        &module(params, "const params_n: u32 = 2u;\n\nfn value(x: f32) -> f32 {\n    return x;\n}\n"),
        r#"
error[SW0413]: `params_n` is a name that the linker gives to a parameter's constant
  --> value/m/m.wgsl:1:7
  |
1 | const params_n: u32 = 2u;
  |       ^^^^^^^^ declared here
  |
  = give it another name
"#,
    );
    assert_text(
        &module(
            r#"instances: {"a": (type: F32, default: 1.0)}"#,
            "struct Instance {\n    a: f32,\n}\n\nfn value(x: f32) -> f32 {\n    return x;\n}\n",
        ),
        r#"
error[SW0413]: `Instance` is a name that the linker gives to the struct of the instances
  --> value/m/m.wgsl:1:8
  |
1 | struct Instance {
  |        ^^^^^^^^ declared here
  |
  = give it another name
"#,
    );
}

#[test]
fn sw0415_not_linkable() {
    let capabilities = r#"capabilities: ["RAY_QUERY"], resources: {"scene": (kind: Host("scene"))}"#;
    assert_text(
        &module(
            capabilities,
            "enable wgpu_ray_query;\n\nvar scene: acceleration_structure;\n\nfn value(x: f32) -> f32 {\n    var rq: ray_query;\n    rayQueryInitialize(&rq, scene, RayDesc(0u, 0xFFu, 0.0, 1.0, vec3f(x), vec3f(1.0)));\n    while (rayQueryProceed(&rq)) {\n    }\n    return x;\n}\n",
        ),
        r#"
error[SW0415]: ray tracing cannot be linked
  --> value/m/m.wgsl:3:1
  |
3 | var scene: acceleration_structure;
  | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ used here
  |
  = modules may use vertex, fragment and compute stages without ray tracing and cooperative matrices
"#,
    );
    assert_text(
        &module(
            r#"capabilities: ["COOPERATIVE_MATRIX"]"#,
            "enable wgpu_cooperative_matrix;\n\nfn value(x: f32) -> f32 {\n    var m: coop_mat8x8<f32, A>;\n    return x;\n}\n",
        ),
        r#"
error[SW0415]: a cooperative matrix cannot be linked
  --> value/m/m.wgsl:4:5
  |
4 |     var m: coop_mat8x8<f32, A>;
  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^ used here
  |
  = modules may use vertex, fragment and compute stages without ray tracing and cooperative matrices
"#,
    );
}
