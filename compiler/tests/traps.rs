//! Where linking naga modules goes wrong if it is done naively: one test for each known trap.

mod common;

use common::{assert_forms_agree, small};
use shadewright_compiler::{Target, emit};

/// A constant is folded where it is parsed: patching it later would leave lengths, labels and derived constants stale.
#[test]
fn frozen_parameters_reach_array_lengths_switch_labels_asserts_and_derived_constants() {
    let library = small().module(
        "value",
        "table",
        r#"params: {"n": (type: U32, default: 3, mode: Constant)}"#,
        "const DOUBLE: u32 = params.n * 2u;\nconst_assert DOUBLE > 3u;\n\nfn value(x: f32) -> f32 {\n    var sums: array<f32, params.n>;\n    \
         switch u32(x) {\n        case params.n: { sums[0] = 1.0; }\n        default: { sums[params.n - 1u] = f32(DOUBLE); }\n    }\n    return sums[0];\n}\n",
    );
    for (recipe, length, double) in [
        (r#"(module: "run", fill: {"value": "table"})"#, 3, "6.0"),
        (
            r#"(module: "run", fill: {"value": (module: "table", freeze: {"n": 7})})"#,
            7,
            "14.0",
        ),
    ] {
        let program = library.link(recipe);
        let module = program.validated().module();
        let lengths: Vec<u32> = module
            .types
            .iter()
            .filter_map(|(_, t)| match t.inner {
                naga::TypeInner::Array {
                    size: naga::ArraySize::Constant(n),
                    ..
                } => Some(n.get()),
                _ => None,
            })
            .collect();
        assert_eq!(lengths, [length]);
        let mut literals = module
            .functions
            .iter()
            .flat_map(|(_, f)| f.expressions.iter().map(|(_, e)| format!("{e:?}")));
        assert!(literals.any(|e| e == format!("Literal(F32({double}))")), "DOUBLE is not {double}");
        let labels: Vec<_> = format!("{:?}", module.functions.iter().map(|(_, f)| &f.body).collect::<Vec<_>>())
            .match_indices(&format!("value: U32({length})"))
            .map(|m| m.0)
            .collect();
        assert_eq!(labels.len(), 1, "the switch has no label {length}");
        assert_forms_agree(&program);
    }
    let error = library.error(r#"(module: "run", fill: {"value": (module: "table", freeze: {"n": 1})})"#);
    assert!(error.contains("value/table/table.wgsl:2:"), "{error}");
}

/// An alias names a type in naga, and a named type is another type than the same one without a name.
#[test]
fn aliases_do_not_make_equal_types_differ() {
    let library = |alias_in_pass: &str| {
        common::Texts::default()
            .category("pass", "group: 3", "")
            .category("value", "", "alias Triple = vec3<f32>;\n\nfn value(x: array<Triple, 2>) -> f32 {\n    return x[0].x;\n}\n")
            .module(
                "pass",
                "run",
                r#"slots: {"value": (interface: "value")}, resources: {"out": (kind: Host("out"))}"#,
                &format!(
                    "alias Own = vec3<f32>;\nvar<storage, read_write> out: array<f32>;\n\n@compute @workgroup_size(1)\nfn main() {{\n    \
                     var pair: array<{alias_in_pass}, 2>;\n    var other: array<Own, 2>;\n    other[0] = Own(out[1]);\n    pair[1] = other[0];\n    out[0] = value(pair);\n}}\n"
                ),
            )
            .module("value", "plain", "", "fn value(x: array<Triple, 2>) -> f32 {\n    var y = x[1];\n    return vec3<f32>(y).y;\n}\n")
    };
    let recipe = r#"(module: "run", fill: {"value": "plain"})"#;
    // Linked, `Own`, `Triple` and the plain type are one.
    let program = library("Triple").link(recipe);
    let arrays = program.validated().module().types.iter().filter(|(_, t)| {
        matches!(
            t.inner,
            naga::TypeInner::Array {
                size: naga::ArraySize::Constant(_),
                ..
            }
        )
    });
    assert_eq!(arrays.count(), 1);
    assert_forms_agree(&program);
    // Inside one module naga itself tells them apart: the author hears of it at the right place, with the way out.
    let error = library("Own").error(recipe);
    assert!(error.contains("pass/run/run.wgsl:10:14") && error.contains("alias"), "{error}");
}

/// Structs of one name in two modules are two structs, whatever is in them.
#[test]
fn equal_names_in_different_modules_stay_apart() {
    let pair = |members: &str| {
        format!(
            "struct Pair {{\n    {members},\n}}\n\nfn helper(p: Pair) -> f32 {{\n    return p.a;\n}}\n\nfn value(x: f32) -> f32 {{\n    var p: Pair;\n    p.a = x;\n    return helper(p);\n}}\n"
        )
    };
    let library = small()
        .module("value", "one", "", &pair("a: f32"))
        .module("value", "two", "", &pair("b: i32, a: f32"))
        .module(
            "value",
            "both",
            r#"slots: {"left": (interface: "value", prefix: "left_"), "right": (interface: "value", prefix: "right_")}"#,
            "fn value(x: f32) -> f32 {\n    return left_value(x) + right_value(x);\n}\n",
        );
    let program = library.link(r#"(module: "run", fill: {"value": (module: "both", fill: {"left": "one", "right": "two"})})"#);
    let text = program.wgsl();
    for name in ["struct OnePair", "struct TwoPair", "fn one_helper", "fn two_helper"] {
        assert!(text.contains(name), "{name} is missing:\n{text}");
    }
    assert_forms_agree(&program);
}

/// A linked name may not be captured by a local of the text into which it is written.
#[test]
fn linked_names_are_not_captured_by_locals() {
    let library = small()
        .module(
            "value",
            "inner",
            "",
            "fn help(x: f32) -> f32 {\n    return x * 3.0;\n}\n\nfn value(x: f32) -> f32 {\n    return help(x);\n}\n",
        )
        .module(
            "value",
            "outer",
            r#"slots: {"inner": (interface: "value", prefix: "in_")}"#,
            "fn value(inner_value: f32) -> f32 {\n    let inner_help = in_value(inner_value);\n    return inner_help + in_value(2.0);\n}\n",
        );
    assert_forms_agree(&library.link(r#"(module: "run", fill: {"value": (module: "outer", fill: {"inner": "inner"})})"#));
}

/// A private variable of a module that stands twice is two variables; its constants and plain functions are linked once.
#[test]
fn instances_share_what_does_not_depend_on_them() {
    let library = small()
        .module(
            "value",
            "counter",
            r#"slots: {"next": (interface: "value", arity: Optional, prefix: "next_")}"#,
            "const STEP: f32 = 2.0;\nvar<private> count: f32;\n\nfn twice(x: f32) -> f32 {\n    return x * STEP;\n}\n\nfn value(x: f32) -> f32 {\n    \
             count += twice(x);\n    return next_value(count);\n}\n",
        );
    let program = library.link(r#"(module: "run", fill: {"value": (module: "counter", fill: {"next": "counter"})})"#);
    let module = program.validated().module();
    let private = module
        .global_variables
        .iter()
        .filter(|(_, g)| g.space == naga::AddressSpace::Private)
        .count();
    assert_eq!(private, 2);
    let twice = module
        .functions
        .iter()
        .filter(|(_, f)| f.name.as_deref().is_some_and(|n| n.contains("twice")))
        .count();
    assert_eq!(twice, 1);
    assert_eq!(module.constants.len(), 1);
    assert_forms_agree(&program);
}

/// naga keeps what a dead `let` or a branch that is never taken names.
#[test]
fn dead_lets_and_constant_branches_take_their_bindings_along() {
    let library = small().module(
        "value",
        "wasteful",
        r#"params: {"extra": (type: Bool, default: false, mode: Constant)}, resources: {"table": (kind: Host("table")), "other": (kind: Host("other"))}"#,
        "var<storage, read> table: array<f32>;\nvar<storage, read> other: array<f32>;\n\nfn costly(x: f32) -> f32 {\n    return other[u32(x)];\n}\n\n\
         fn value(x: f32) -> f32 {\n    let unused = table[0];\n    let chained = unused * 2.0;\n    _ = table[1];\n    if params.extra {\n        return costly(x);\n    } else if x > 2.0 {\n        return 1.0;\n    }\n    return x;\n}\n",
    );
    let lean = library.link(r#"(module: "run", fill: {"value": "wasteful"})"#);
    let names: Vec<&str> = lean.reflection().bindings.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["run_out"], "{}", lean.wgsl());
    for gone in ["costly", "table", "unused", "chained"] {
        assert!(!lean.wgsl().contains(gone), "`{gone}` is still there:\n{}", lean.wgsl());
    }
    assert_forms_agree(&lean);
    let full = library.link(r#"(module: "run", fill: {"value": (module: "wasteful", freeze: {"extra": true})})"#);
    let names: Vec<&str> = full.reflection().bindings.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["run_out", "wasteful_other"]);
    // What stands behind a branch that is always taken and returns is gone too.
    assert!(!full.wgsl().contains("return x;"), "{}", full.wgsl());
    assert_forms_agree(&full);
}

/// `enable` stands in no IR: the source form must carry it, and reflection must say what is asked of the device.
#[test]
fn enable_directives_survive() {
    let library = small().module(
        "value",
        "halves",
        r#"capabilities: ["SHADER_FLOAT16"]"#,
        "enable f16;\n\nfn value(x: f32) -> f32 {\n    return f32(f16(x) * 2.0h);\n}\n",
    );
    let program = library.link(r#"(module: "run", fill: {"value": "halves"})"#);
    assert!(program.wgsl().starts_with("enable f16;\n"), "{}", program.wgsl());
    assert_eq!(program.reflection().capabilities, ["SHADER_FLOAT16"]);
    assert_forms_agree(&program);
}

/// A diagnostic filter of a module's file holds for that module's functions, in both forms.
#[test]
fn diagnostic_filters_stay_with_their_module() {
    let library = small().module(
        "value",
        "quiet",
        "",
        "diagnostic(off, derivative_uniformity);\n\nfn value(x: f32) -> f32 {\n    return x + 1.0;\n}\n",
    );
    let program = library.link(r#"(module: "run", fill: {"value": "quiet"})"#);
    let text = program.wgsl();
    assert_eq!(text.matches("diagnostic(off, derivative_uniformity)").count(), 1, "{text}");
    assert!(text.contains("@diagnostic(off, derivative_uniformity)\nfn quiet_value"), "{text}");
    let filtered: Vec<bool> = program
        .validated()
        .module()
        .functions
        .iter()
        .map(|(_, f)| f.diagnostic_filter_leaf.is_some())
        .collect();
    assert_eq!(filtered, [true]);
    assert_forms_agree(&program);
}

/// naga's own writer panics on override expressions, and writes a workgroup size of 1 for an overridden one.
#[test]
fn overrides_survive_the_source_form_and_panic_nowhere() {
    let library = common::Texts::default().category("pass", "group: 3", "").module(
        "pass",
        "run",
        r#"params: {"size": (type: U32, default: 8, mode: Override)}, resources: {"out": (kind: Host("out"))}"#,
        "override half: u32 = params.size / 2u + 1u;\nvar<workgroup> shared_values: array<f32, half>;\nvar<storage, read_write> out: array<f32>;\n\n\
         @compute @workgroup_size(params.size)\nfn main(@builtin(local_invocation_index) i: u32) {\n    shared_values[i % half] = f32(i);\n    workgroupBarrier();\n    out[i] = shared_values[0];\n}\n",
    );
    let program = library.link(r#""run""#);
    let text = program.wgsl();
    assert!(
        text.contains("@workgroup_size(run_size)") && text.contains("override run_half: u32 = run_size / 2u + 1u;"),
        "{text}"
    );
    let keys: Vec<&str> = program.reflection().overrides.iter().map(|o| o.name.as_str()).collect();
    assert_eq!(keys, ["run_size"]);
    assert_forms_agree(&program);
    for target in [Target::WgslFromIr, Target::SpirV, Target::Hlsl, Target::Msl, Target::Glsl] {
        // Written, or refused with an error of ours: never a panic.
        if let Err(report) = emit(program.validated(), target, Some("main")) {
            assert!(report.diagnostics[0].code.starts_with("SW06"), "{report}");
        }
    }
}

/// Results of `modf` and `frexp` have types that only the module's table of predeclared types knows.
#[test]
fn predeclared_result_types_are_carried_over() {
    let library = small()
        .module(
            "value",
            "fraction",
            "",
            "fn value(x: f32) -> f32 {\n    return modf(x).fract + f32(frexp(vec2f(x)).exp.x);\n}\n",
        )
        .module("value", "whole", "", "fn value(x: f32) -> f32 {\n    return modf(x).whole;\n}\n")
        .module(
            "value",
            "both",
            r#"slots: {"all": (interface: "value", arity: List, prefix: "all_")}"#,
            "fn value(x: f32) -> f32 {\n    return all_value(x);\n}\n",
        );
    let program = library.link(r#"(module: "run", fill: {"value": (module: "both", fill: {"all": ["fraction", "whole"]})})"#);
    assert_forms_agree(&program);
    emit(program.validated(), Target::SpirV, None).unwrap();
}

/// Early depth tests, interpolation and invariance are attributes that must come through both writers.
#[test]
fn entry_point_attributes_survive() {
    let library = common::Texts::default().category("pass", "group: 3", "").module(
        "pass",
        "draw",
        "",
        "struct Out {\n    @builtin(position) @invariant clip: vec4f,\n    @location(0) @interpolate(flat, either) id: u32,\n    @location(1) @interpolate(linear, centroid) fog: f32,\n    @location(2) unread: vec4f,\n}\n\nstruct In {\n    @builtin(vertex_index) index: u32,\n    @location(0) unread: vec3f,\n}\n\nstruct Color {\n    @location(0) color: vec4f,\n}\n\n\
         @vertex\nfn vertex_main(in: In) -> Out {\n    return Out(vec4f(f32(in.index)), in.index, 0.5, vec4f(in.unread, 1.0));\n}\n\n\
         @fragment\nfn fragment_main(in: Out) -> Color {\n    return Color(vec4f(f32(in.id), in.fog, 0.0, 1.0));\n}\n",
    );
    let program = library.link(r#""draw""#);
    let text = program.wgsl();
    for kept in ["@invariant", "@interpolate(flat, either)", "@interpolate(linear, centroid)"] {
        assert!(text.contains(kept), "{kept} is missing:\n{text}");
    }
    assert!(
        !text.contains("unread"),
        "an interpolant or vertex input that nobody reads is still there:\n{text}"
    );
    let vertex = &program.reflection().entry_points[0];
    assert!(vertex.inputs.is_empty());
    assert_eq!(vertex.outputs.iter().map(|o| o.location).collect::<Vec<_>>(), [0, 1]);
    assert_forms_agree(&program);
}

/// Something that acts beside giving a value stays, even where nobody reads the value.
#[test]
fn calls_that_act_stay() {
    let library = small().module(
        "value",
        "acting",
        "",
        "struct Box {\n    kept: f32,\n    unread: f32,\n}\n\nvar<private> log: f32;\n\nfn act(x: f32) -> f32 {\n    log += x;\n    return x;\n}\n\nfn still(x: f32) -> f32 {\n    return x * 5.0;\n}\n\n\
         fn value(x: f32) -> f32 {\n    let first = act(x);\n    var b = Box(still(x), act(2.0));\n    b.unread = still(3.0);\n    b.unread = act(4.0);\n    still(6.0);\n    act(7.0);\n    return log;\n}\n",
    );
    let program = library.link(r#"(module: "run", fill: {"value": "acting"})"#);
    let text = program.wgsl();
    assert_eq!(text.matches("acting_act(").count(), 5, "{text}");
    assert_forms_agree(&program);
}

/// A constructor under an interface's alias loses the arguments of members that nobody reads, as under the struct's own name.
#[test]
fn constructors_under_an_interfaces_alias_lose_dead_arguments() {
    let library = common::Texts::default()
        .category("pass", "group: 3", "")
        .category(
            "value",
            "",
            "struct Pair {\n    a: f32,\n    b: f32,\n}\n\nalias Two = Pair;\n\nfn value(x: f32) -> f32 {\n    return x;\n}\n",
        )
        .module(
            "pass",
            "run",
            r#"slots: {"value": (interface: "value")}, resources: {"out": (kind: Host("out"))}"#,
            "var<storage, read_write> out: array<f32>;\n\n@compute @workgroup_size(1)\nfn main() {\n    out[0] = value(out[1]);\n}\n",
        )
        .module(
            "value",
            "two",
            "",
            "fn value(x: f32) -> f32 {\n    let p = Two(x * 2.0, x * 3.0);\n    return p.b;\n}\n",
        );
    let program = library.link(r#"(module: "run", fill: {"value": "two"})"#);
    assert!(!program.wgsl().contains("2.0"), "{}", program.wgsl());
    assert_forms_agree(&program);
}

/// A line that begins like a comment but stands inside a longer one is no comment of its own: taking it away with a dead
/// member or statement below would leave the longer one open.
#[test]
fn dead_members_and_statements_leave_comments_whole() {
    let library = small().module(
        "value",
        "noted",
        "",
        "struct Noted {\n    kept: f32,\n    /* about the next\n    // one */\n    dead: f32, // gone\n    // gone, too\n    also_dead: f32,\n}\n\n\
         fn value(x: f32) -> f32 {\n    var n: Noted;\n    n.kept = x;\n    /* why\n    // so */\n    n.dead = x; // gone\n    // gone, too\n    n.also_dead = x;\n    return n.kept;\n}\n",
    );
    let program = library.link(r#"(module: "run", fill: {"value": "noted"})"#);
    let text = program.wgsl();
    assert!(!text.contains("dead") && !text.contains("gone"), "{text}");
    assert_eq!((text.matches("/*").count(), text.matches("*/").count()), (2, 2), "{text}");
    assert_forms_agree(&program);
}
