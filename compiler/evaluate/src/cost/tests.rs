//! Counts against counts by hand.

use super::*;

fn parsed(source: &str) -> (Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    let info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    (module, info)
}

/// Cost of the function `f` of a source.
fn analysis(source: &str) -> Analysis {
    let (module, info) = parsed(source);
    let (handle, _) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some("f")).unwrap();
    cost_of_function(&module, &info, handle)
}

/// The operations of an expression of `a: f32, b: f32, u: vec3f, v: vec3f, i: i32, m: mat3x3f, t: texture_2d<f32>`, by name; those that are 0 left out.
fn operations_of(expression: &str) -> String {
    let found = analysis(&format!(
        "@group(0) @binding(0) var t: texture_2d<f32>;
        fn f(a: f32, b: f32, u: vec3f, v: vec3f, i: i32, m: mat3x3f) {{ let result = {expression}; }}"
    ));
    said(&found.cost)
}

fn said(cost: &Cost) -> String {
    let words = [
        ("add", cost.add),
        ("multiply", cost.multiply),
        ("divide", cost.divide),
        ("root", cost.root),
        ("transcendental", cost.transcendental),
        ("select", cost.select),
        ("integer", cost.integer),
        ("texture", cost.texture),
        ("loops", cost.loops),
        ("branches", cost.branches),
    ];
    let words: Vec<String> = words
        .iter()
        .filter(|(_, n)| *n > 0)
        .map(|(word, n)| format!("{n} {word}"))
        .collect();
    words.join(", ")
}

/// Catches an operation under another kind's name, a vector counted as one, and a compound function that is not what it is defined as.
#[test]
fn operations_are_counted_by_kind() {
    for (expression, expected) in [
        ("a + b - 1.0", "2 add"),
        ("-a", ""),
        ("u + v", "3 add"),
        ("a * u", "3 multiply"),
        ("u / a", "3 divide"),
        ("a % b", "1 divide"),
        ("sqrt(a) + inverseSqrt(b)", "1 add, 2 root"),
        ("sin(u)", "3 transcendental"),
        ("pow(a, b) + exp2(a)", "1 add, 2 transcendental"),
        ("dot(u, v)", "2 add, 3 multiply"),
        ("cross(u, v)", "3 add, 6 multiply"),
        ("length(u)", "2 add, 3 multiply, 1 root"),
        // A dot product, a root's inverse, three products.
        ("normalize(u)", "2 add, 6 multiply, 1 root"),
        // u (1 - a) + v a.
        ("mix(u, v, a)", "6 add, 6 multiply"),
        ("m * u", "6 add, 9 multiply"),
        ("m * m", "18 add, 27 multiply"),
        ("max(u, v)", "3 select"),
        ("clamp(a, 0.0, 1.0)", "2 select"),
        ("select(a, b, a < b)", "2 select"),
        ("abs(u).zyx", ""),
        ("i * 3 + 1", "2 integer"),
        ("f32(i)", "1 integer"),
        ("textureLoad(t, vec2i(i), 0)", "1 texture"),
        ("fma(a, b, a)", "1 add, 1 multiply"),
    ] {
        assert_eq!(operations_of(expression), expected, "{expression}");
    }
}

/// Catches a function that counts once however often it is called, calls that are not multiplied through, dead functions that count, and a
/// caller's own operations that count for the function alone.
#[test]
fn calls_multiply() {
    let (module, info) = parsed(
        "fn dead(a: f32) -> f32 { return sin(a); }
        fn leaf(a: f32) -> f32 { return a * a; }
        fn twice(a: f32) -> f32 { return leaf(a) + leaf(a + 1.0); }
        @group(0) @binding(0) var<storage, read_write> data: array<f32>;
        @group(0) @binding(1) var<uniform> block: array<vec4f, 3>;
        @group(0) @binding(2) var<uniform> unused: mat4x4f;
        @compute @workgroup_size(1) fn main() { data[0] = twice(block[0].x) / twice(twice(block[1].x)); }",
    );
    let all = cost_of(&module, &info, "main").unwrap();
    // Three calls of `twice`: 2 additions of its own and 2 products of `leaf` in each.
    let expected = Cost {
        add: 6,
        multiply: 6,
        divide: 1,
        uniform_bytes: 48,
        bindings: 2,
        storage_buffers: 1,
        ..Cost::default()
    };
    assert_eq!(all.cost, expected);
    assert_eq!(all.unrolled, all.cost.counts());
    assert_eq!(cost_of(&module, &info, "leaf"), None);
    let (twice, _) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some("twice")).unwrap();
    let alone = cost_of_function(&module, &info, twice);
    assert_eq!(said(&alone.cost), "2 add, 2 multiply");
    assert_eq!(alone.cost.bindings, 0);
}

/// Catches sides of a branch that are left out.
#[test]
fn all_sides_of_branches_count() {
    let found = analysis(
        "fn f(a: f32, i: i32) -> f32 {
            if a < 1.0 { return a * a; } else { switch i { case 1: { return a + 1.0; } case 2, 3: { return a / 3.0; } default: {} } }
            return sqrt(a);
        }",
    );
    assert_eq!(said(&found.cost), "1 add, 1 multiply, 1 divide, 1 root, 1 select, 2 branches");
}

fn trips(head: &str, before: &str, inside: &str) -> Vec<(Option<u32>, bool)> {
    let found = analysis(&format!(
        "const N = 4u; override over: i32 = 3;
        fn touch(p: ptr<function, i32>) {{ *p += 1; }}
        fn f(n: i32) -> f32 {{ var sum = 0.0; {before} for ({head}) {{ sum = sum * 2.0; {inside} }} return sum; }}"
    ));
    found.loops.iter().map(|l| (l.trips, l.leaves)).collect()
}

/// Catches a count that is off by one, a comparison or step that is read the wrong way round, a count of a loop that hangs on its input,
/// and one whose counter something else changes.
#[test]
fn constant_loops_are_counted() {
    for (head, expected) in [
        ("var i = 0; i < 5; i++", Some(5)),
        ("var i = 0; i <= 5; i += 2", Some(3)),
        ("var i = 7; i > 0; i--", Some(7)),
        ("var i = -2; i <= 2; i++", Some(5)),
        ("var i = 0u; i < N; i = 1u + i", Some(4)),
        ("var i = 1u; i != 64u; i *= 2u", Some(6)),
        ("var i = 1; i < 64; i <<= 1u", Some(6)),
        ("var i = 0; 5 > i; i++", Some(5)),
        ("var x = 0.0; x < 1.0; x += 0.25", Some(4)),
        ("var i = 0; i < i32(N) * 2 + 1; i++", Some(9)),
        ("var i = 3; i < 3; i++", Some(0)),
        ("var i = 0; i < n; i++", None),
        ("var i = 0; i < over; i++", None),
        ("var i = n; i < 5; i++", None),
        ("var i = 0; i < 5; i += n", None),
        ("var i = 0; i < 5; i -= 0", None),
        ("var i = 0u; ; i++", None),
    ] {
        let inside = if expected.is_none() && head.contains("; ;") {
            "if sum > 9.0 { break; }"
        } else {
            ""
        };
        assert_eq!(trips(head, "", inside)[0].0, expected, "{head}");
    }
    assert_eq!(trips("var i = 0; i < 5; i++", "", "if sum > 3.0 { break; }"), [(Some(5), true)]);
    assert_eq!(
        trips("var i = 0; i < 5; i++", "", "if sum > 3.0 { return sum; }"),
        [(Some(5), true)]
    );
    assert_eq!(
        trips("var i = 0; i < 5; i++", "", "switch n { case 1: { break; } default: {} }"),
        [(Some(5), false)]
    );
    assert_eq!(trips("var i = 0; i < 5; i++", "", "if n > 3 { continue; }"), [(Some(5), false)]);
    assert_eq!(trips("var i = 0; i < 5; i++", "", "i += 1;"), [(None, false)]);
    assert_eq!(trips("var i = 0; i < 5; i++", "", "if n > 2 { i = 0; }"), [(None, false)]);
    assert_eq!(trips("var i = 0; i < 5; i++", "", "touch(&i);"), [(None, false)]);
    // Looked at as a tree, the exit has 2^50 leaves.
    let doubled: String = (1..=50).map(|n| format!("let a{n} = a{} + a{};", n - 1, n - 1)).collect();
    let found = analysis(&format!(
        "fn f() -> f32 {{ var i = 1u; loop {{ let a0 = i; {doubled} if a50 == 7u {{ break; }} continuing {{ i++; }} }} return 1.0; }}"
    ));
    assert_eq!(found.loops[0].trips, None);
    // The counter as it was before the loop.
    assert_eq!(trips("; j < 5; j++", "var j = 0; j = 2;", ""), [(Some(3), false)]);
    assert_eq!(trips("; j < 5; j++", "var j = 0; if n > 1 { j = 2; }", ""), [(None, false)]);
    assert_eq!(trips("; j < 5; j++", "var j = 0; touch(&j);", ""), [(None, false)]);
    assert_eq!(trips("; j < 5; j++", "var j = 0;", ""), [(Some(5), false)]);
    assert_eq!(trips("; j < 5; j++", "var j = 0; j = 2;", "j += 1;"), [(None, false)]);
    assert_eq!(trips("; j < 5; j++", "var j = 0; j = 2; if n > 1 { j = 3; }", ""), [(None, false)]);
    // An exit that says when to leave, not when to stay.
    let leaving = analysis("fn f() -> f32 { var i = 1; loop { if i > 5 { break; } continuing { i += 2; } } return 1.0; }");
    assert_eq!(leaving.loops[0].trips, Some(3));
}

/// Catches a body that counts with its trips where it should count once, and the other way round; and nested loops that are not multiplied,
/// through calls as well.
#[test]
fn bodies_count_once_and_unrolled() {
    let found = analysis(
        "fn inner(n: i32) -> f32 { var s = 0.0; for (var k = 0; k < n; k++) { s += 1.0; } return s; }
        fn f(n: i32) -> f32 {
            var s = 0.0;
            for (var i = 0; i < 3; i++) {
                for (var j = -i; j < 4; j++) { s = s * 2.0; }
                for (var j = 0; j < 4; j++) { s = sqrt(s); }
                s += inner(n);
            }
            return s + inner(n);
        }",
    );
    // Of the loop from -i the first value is not constant: it counts once a trip of its parent.
    let name = |l: &Loop| (l.function.clone(), l.trips, l.times);
    assert_eq!(
        found.loops.iter().map(name).collect::<Vec<_>>(),
        [
            ("inner".to_owned(), None, 2),
            ("f".to_owned(), Some(3), 1),
            ("f".to_owned(), None, 1),
            ("f".to_owned(), Some(4), 1),
        ]
    );
    let Cost {
        multiply,
        root,
        add,
        loops,
        ..
    } = found.cost;
    // Additions: in `f` one a trip and one behind, in `inner` one, which two places call.
    assert_eq!((multiply, root, add, loops), (1, 1, 4, 5));
    let unrolled = |kind| found.unrolled[kind];
    assert_eq!((unrolled(Kind::Multiply), unrolled(Kind::Root)), (3, 12));
    assert_eq!(unrolled(Kind::Add), 3 + 1 + (3 + 1));
    assert_eq!(unrolled(Kind::Trip), 3 + 3 + 12 + (3 + 1));
}

/// Catches weights that make a slow function look cheap.
#[test]
fn a_slow_module_is_dearer() {
    let fast = analysis("fn f(x: f32) -> f32 { let y = 1.0 - x; let z = y * y; return z * z * y; }");
    let slow = analysis("fn f(x: f32) -> f32 { return pow(1.0 - x, 5.0) / 1.0000001; }");
    // 1 + 3 against 1 + 8 + 4.
    assert_eq!((fast.cost.weighted(), slow.cost.weighted()), (4.0, 13.0));
    let looped = analysis("fn f(x: f32) -> f32 { var y = x; for (var i = 0; i < 100; i++) { y = sin(y); } return y; }");
    // A trip: 1 itself, 1 branch, 1 comparison, 8 for the sine, 1 for counting.
    assert_eq!((looped.cost.weighted(), looped.unrolled.weighted()), (12.0, 1200.0));
}

/// Catches resources counted as others, bindings of unused ones, and a block's size without its padding.
#[test]
fn textures_and_bindings_are_counted() {
    let found = analysis(
        "@group(0) @binding(0) var t: texture_2d<f32>;
        @group(0) @binding(1) var s: sampler;
        @group(0) @binding(2) var<storage> data: array<vec4f>;
        @group(1) @binding(0) var<uniform> a: f32;
        @group(1) @binding(1) var<uniform> b: mat3x3f;
        @group(1) @binding(2) var<uniform> unread: mat3x3f;
        fn f(at: vec2f) -> vec4f { return textureSampleLevel(t, s, at, 0.0) + textureSampleLevel(t, s, at + a, b[0].x) + data[1]; }",
    );
    let Cost {
        texture,
        bindings,
        textures,
        storage_buffers,
        uniform_bytes,
        ..
    } = found.cost;
    assert_eq!((texture, bindings, textures, storage_buffers, uniform_bytes), (2, 5, 1, 1, 4 + 48));
}
