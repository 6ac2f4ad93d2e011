//! Rust for a user's own renderer. That it compiles and draws is shown in `examples/renderer`; here is what it looks like.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;

use std::io::Write;
use std::process::Command;

use common::{Texts, assert_text, recipes, small, standard};
use shadewright_compiler::host::{Pass, module_name, rust};
use shadewright_compiler::{Catalog, Program, Recipe};

fn written(name: &str, program: &Program) -> String {
    rust(&[Pass::new(name, program)]).unwrap_or_else(|report| panic!("{report}"))
}

/// Everything that the examples' recipes become, by recipe.
fn examples(catalog: &Catalog) -> Vec<(String, String)> {
    let written = |(file, text): (String, String)| {
        let name = file.split('.').next().unwrap().to_owned();
        let recipe = Recipe::parse(&file, &text).unwrap_or_else(|report| panic!("{report}"));
        let programs = catalog.compile_all(&recipe).unwrap_or_else(|report| panic!("{report}"));
        let names: Vec<String> = programs.iter().map(|p| module_name(&name, &p.reflection().pass)).collect();
        let passes: Vec<Pass> = names
            .iter()
            .zip(&programs)
            .map(|(name, program)| Pass::new(name, program))
            .collect();
        let text = rust(&passes).unwrap_or_else(|report| panic!("{report}"));
        (file, text)
    };
    recipes().into_iter().map(written).collect()
}

const LONG: &str = "very_long_name_of_a_thing_that_somebody_thought_up_without_thinking_of_lines";

/// A pass with names and types of every length, and of every kind of resource and entry point.
fn odd(long: &str) -> Program {
    let wgsl = format!(
        r##"
        /// It says "#quoted".
        struct Layout {{
            /// In [brackets], <b>bold</b>, and `as[it]<is>`.
            pad_4: f32,
            in: vec3f,
            {long}: vec2u,
            many: array<vec3f, 3>,
        }}
        struct Tail {{ n: u32, rest: array<mat3x2f> }}
        /// Nothing but its tail.
        struct Only {{ points: array<vec3f> }}
        var<storage, read_write> only: Only;
        var<storage, read> {long}: Layout;
        var<storage, read_write> tail: Tail;
        var<storage, read_write> numbers: array<atomic<i32>>;
        var cubes: texture_depth_cube_array;
        var ids: texture_multisampled_2d<u32>;
        var volume: texture_3d<f32>;
        var out: texture_storage_2d<r32uint, read_write>;
        var compare: sampler_comparison;
        var near: sampler;
        struct In {{ @location(5) {long}: vec2u, @location(1) uv: vec2f, @location(0) a: i32 }}
        struct Out {{ @builtin(position) p: vec4f, @location(0) uv: vec2f }}
        struct Colors {{ @location(2) c: vec4u, @location(0) a: vec4f }}
        @vertex fn {long}_vertex(in: In) -> Out {{
            return Out({long}.in.xyzx * {long}.pad_4 * f32(in.a) * f32({long}.{long}.x + in.{long}.y) * {long}.many[1].x, in.uv);
        }}
        @fragment fn f(in: Out) -> Colors {{
            let lit = textureSampleCompareLevel(cubes, compare, vec3f(in.uv, 1.0), 0, 0.5);
            let deep = textureLoad(volume, vec3i(0), 0) * textureSampleLevel(volume, near, vec3f(0.5), 0.0);
            return Colors(vec4u(textureLoad(ids, vec2i(0), 0).x), deep * lit);
        }}
        @compute @workgroup_size(8, 8) fn c() {{
            atomicAdd(&numbers[0], i32(tail.n) + i32(params.gain));
            only.points[0].x = 1.0;
            tail.rest[0] *= params.size.x;
            textureStore(out, vec2i(0), textureLoad(out, vec2i(0)) + select(0u, 1u, params.on));
        }}"##
    );
    let manifest = format!(
        r#"params: {{
            "gain": (type: F32, default: 0.1, range: (-1e-9, 2.5), unit: "lx", doc: "Of [all]", mode: Override),
            "on": (type: Bool, default: true, mode: Override),
            "size": (type: Vec2, default: (1.0, 0.5), doc: "Of it"),
        }}, resources: {{
            "{long}": (kind: Host("a")), "tail": (kind: Host("b")), "only": (kind: Host("o")), "numbers": (kind: Buffer(bytes: 64)), "cubes": (kind: Host("c")),
            "ids": (kind: Host("d")), "volume": (kind: Host("e"), group: 1), "out": (kind: Host("f"), doc: "Ids"),
            "compare": (kind: Sampler(compare: true, linear: true)), "near": (kind: Sampler()),
        }}"#
    );
    Texts::default()
        .category("pass", "group: 3", "")
        .module("pass", "odd", &manifest, &wgsl)
        .link("odd")
}

/// Catches lines that `rustfmt` would break or join, which a user's own formatting of the file would then change.
#[test]
fn it_is_laid_out_as_rustfmt_would() {
    let catalog = standard().catalog().unwrap_or_else(|report| panic!("{report}"));
    let mut all = examples(&catalog);
    // One name for each way in which a line can be too long.
    for long in ["fine", "a_longer_name_of_a_thing", "a_long_name_that_somebody_thought_up"] {
        all.push((long.to_owned(), written("odd", &odd(long))));
    }
    let folder = std::env::temp_dir().join(format!("shadewright-host-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut said = Vec::new();
    for (name, text) in all {
        let file = folder.join("bindings.rs");
        std::fs::write(&file, &text).unwrap();
        match Command::new("rustfmt")
            .args(["--check", "--edition", "2024", "--color", "never"])
            .arg(&file)
            .output()
        {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                // Not `println`, which is held back from who does not ask for it.
                let _ = writeln!(std::io::stdout(), "rustfmt is not installed: its verdict is missing");
            }
            Err(error) => panic!("{error}"),
            Ok(ran) if ran.status.success() => {}
            Ok(ran) => said.push(format!("{name}:\n{}", String::from_utf8_lossy(&ran.stdout))),
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(said.is_empty(), "{}", said.join("\n"));
}

/// Catches any change of the whole, which users' programs are written against.
#[test]
fn a_small_pass() {
    let texts = small().module(
        "value",
        "scaled",
        r#"params: {"factor": (type: F32, unit: "m", default: 2.5, range: (0.0, 10.0), doc: "How much")}"#,
        "fn value(x: f32) -> f32 {\n    return x * params.factor;\n}\n",
    );
    let program = texts.link(r#"(module: "run", fill: {"value": "scaled"})"#);
    let expected = include_str!("golden/small.rs.txt");
    let actual = written("small", &program);
    assert!(actual == expected, "compiler/tests/golden/small.rs.txt should be:\n{actual}");
}

/// Catches names of the shader that stand in the way of the written code's own, comments that rustdoc or rustc trip over, and a raw
/// string that ends too early.
#[test]
fn names_and_comments_that_are_trouble() {
    let text = written("odd", &odd(LONG));
    for part in [
        "pub struct OddLayout {",
        "pub pad_4: f32,\n        /// Padding, whatever it holds.\n        pub pad_4_: [u8; 12],",
        "pub r#in: [f32; 3],",
        r"/// In \[brackets\], \<b\>bold\</b\>, and `as[it]<is>`.",
        "= r##\"",
        "storage buffer: any number of `[f32; 4]`, at least one. The fourth number of each element is padding.\n        pub odd_only: ",
        "storage buffer: what [`bytes`](OddTail::bytes) makes.",
        "the elements of `rest` behind it. By columns.",
        "/// Of \\[all\\].\n        ///\n        /// This is `gain` of `odd`, in lx, from -1e-9 to 2.5.\n        pub odd_gain: f32,",
    ] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
    // An interface's structs keep their names, so they can meet ours.
    let texts = Texts::default().category(
        "pass",
        r#"group: 3, resources: {"settings": (kind: Host("settings"))}"#,
        "struct Layout { a: u32 }\nvar<storage, read_write> settings: Layout;\n",
    );
    let texts = texts.module("pass", "p", "", "@compute @workgroup_size(1) fn main() { settings.a = 1u; }");
    let text = written("p", &texts.link("p"));
    assert!(
        text.contains("pub struct Layout_ {") && text.contains("pub struct Layout {") && text.contains("[`Layout_`]"),
        "{text}"
    );
}

/// Catches a module's name that Rust does not take.
#[test]
fn modules_names() {
    let names = [
        ("auto-exposure", "main"),
        ("a", "cube_map.shadow"),
        ("2d", "main"),
        ("match", "main"),
        ("Über", "main"),
        ("-", "main"),
    ];
    let found: Vec<String> = names.iter().map(|(recipe, pass)| module_name(recipe, pass)).collect();
    assert_eq!(found, ["auto_exposure", "a_cube_map_shadow", "pass_2d", "match_", "_ber", "pass__"]);
}

/// Catches text that depends on a hash map's order, or on the order in which a file system lists folders.
#[test]
fn equal_input_gives_equal_bytes() {
    let catalog = || standard().catalog().unwrap_or_else(|report| panic!("{report}"));
    assert!(examples(&catalog()) == examples(&catalog()));
    assert!(written("odd", &odd(LONG)) == written("odd", &odd(LONG)));
}

/// Catches code that would not compile, or not do what it says, where an error should be.
#[test]
fn what_cannot_be_written() {
    let pass = |manifest: &str, wgsl: &str| {
        Texts::default()
            .category("pass", "group: 3", "")
            .module("pass", "p", manifest, wgsl)
            .link("p")
    };
    let error = |program: &Program| rust(&[Pass::new("p", program)]).expect_err("it should not be written").render();
    let two = pass(
        "",
        "struct O { @builtin(position) p: vec4f }
        @vertex fn a() -> O { return O(vec4f(0.0)); }
        @vertex fn b() -> O { return O(vec4f(1.0)); }",
    );
    assert_text(
        &error(&two),
        "
error[SW0601]: Rust for wgpu 30 has no place for several vertex or fragment entry points, which the pass `main` has
",
    );
    let wide = pass(
        r#"resources: {"x": (kind: Host("x"))}, capabilities: ["FLOAT64"]"#,
        "struct X { a: f32, b: f64 }\nvar<storage, read_write> x: X;\n@compute @workgroup_size(1) fn c() { x.b = 1.0lf; }",
    );
    assert_text(
        &error(&wide),
        "
error[SW0601]: Rust for wgpu 30 has no place for `b: f64` in a buffer, which the pass `main` has
",
    );
    let (one, other) = (Pass::new("same", &two), Pass::new("same", &wide));
    assert!(rust(&[one, other]).is_err());
    let half = pass(
        r#"resources: {"x": (kind: Host("x"))}, capabilities: ["SHADER_FLOAT16"]"#,
        "enable f16;\nstruct X { a: f32, b: f16, c: array<f16> }
        var<storage, read_write> x: X;\n@compute @workgroup_size(1) fn c() { x.b = x.c[1]; }",
    );
    assert_text(
        &error(&half),
        "
error[SW0601]: Rust for wgpu 30 has no place for a fixed part of 6 bytes in `P_X`, which the pass `main` has
",
    );
    let small = Texts::default()
        .category("pass", "", "")
        .module("pass", "e", "", "@compute @workgroup_size(1) fn c() {}")
        .link("e");
    let twice = rust(&[Pass::new("p", &small), Pass::new("p", &small)])
        .expect_err("one name")
        .render();
    assert_text(
        &twice,
        "
error[SW0601]: Rust for wgpu 30 has no place for a second module of the name `p`, which the pass `main` has
",
    );
}
