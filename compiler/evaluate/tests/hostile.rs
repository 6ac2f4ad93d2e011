//! Programs and buffers that mean no good: no panic, no hang, an error that says what it is.

mod common;

use std::fmt::Write as _;

use common::{check, program, run};
use shadewright_evaluate::{Allowed, EvaluateError, Invocation, Limits, Machine, Program, Value};

fn limited(source: &str, limits: Limits) -> Result<(), EvaluateError> {
    let checked = check(source);
    let program = Program::new(&checked.module, &checked.info, "main", &[], limits)?;
    let mut machine = Machine::<Allowed>::new(&program)?;
    machine.run(&Invocation::default())
}

/// Catches memory that is taken before it is counted: by variables, by types that double at each level, and by buffers.
#[test]
fn large_variables_are_refused() {
    let small = Limits {
        numbers: 1 << 16,
        ..Limits::default()
    };
    let large = "var<private> a: array<vec4f, 1000000>; @compute @workgroup_size(1) fn main() { a[1].x = 1.0; }";
    assert!(matches!(limited(large, small), Err(EvaluateError::TooLarge { .. })));
    let mut doubled = "struct S0 { a: vec4f, b: vec4f }\n".to_owned();
    for i in 1..24 {
        let _ = writeln!(doubled, "struct S{i} {{ a: S{0}, b: S{0} }}", i - 1);
    }
    doubled.push_str(
        "var<private> s: S23; @compute @workgroup_size(1) fn main() { s.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.x = 1.0; }",
    );
    assert!(matches!(limited(&doubled, Limits::default()), Err(EvaluateError::TooLarge { .. })));
    let source = "@group(0) @binding(0) var<storage, read_write> out: array<u32>; @compute @workgroup_size(1) fn main() { out[0] = arrayLength(&out); }";
    let checked = check(source);
    let program = Program::new(&checked.module, &checked.info, "main", &[], small).unwrap();
    let mut machine = Machine::<f32>::new(&program).unwrap();
    assert!(matches!(
        machine.bind_buffer(0, 0, &vec![0; 1 << 20]),
        Err(EvaluateError::TooLarge { .. })
    ));
    // Binding again does not grow without end, and a shorter one is shorter.
    for n in [64, 8, 40] {
        machine.bind_buffer(0, 0, &vec![0; n]).unwrap();
        machine.run(&Invocation::default()).unwrap();
        let values = machine.values(0, 0).unwrap();
        assert_eq!((values.len(), values[0]), (n / 4, Value::Uint(u32::try_from(n).unwrap() / 4)));
    }
}

/// Catches steps that cost nothing: copies of large arrays, calls in calls, loops in loops.
#[test]
fn every_step_is_paid() {
    let few = Limits {
        steps: 100_000,
        ..Limits::default()
    };
    let copies = "var<private> a: array<f32, 100000>; @compute @workgroup_size(1) fn main() { var b: array<f32, 100000>; for (var i = 0; i < 1000; i++) { b = a; a = b; } }";
    let mut calls = "fn g0(x: f32) -> f32 { return x + 1.0; }\n".to_owned();
    for i in 1..40 {
        let _ = writeln!(calls, "fn g{i}(x: f32) -> f32 {{ return g{0}(x) + g{0}(x); }}", i - 1);
    }
    calls.push_str("var<private> y: f32; @compute @workgroup_size(1) fn main() { y = g39(y); }");
    let nothing = "@compute @workgroup_size(1) fn main() { loop { if false { break; } } }";
    let switches = "var<private> y: u32; @compute @workgroup_size(1) fn main() { loop { switch y { case 1u: { break; } default: { continue; } } if y == 3u { break; } } }";
    for source in [copies, &calls, nothing, switches] {
        let start = std::time::Instant::now();
        assert_eq!(limited(source, few), Err(EvaluateError::Steps { limit: 100_000 }), "{source}");
        assert!(start.elapsed().as_secs() < 20);
    }
}

/// Catches indices that leave their variable: huge, negative, of NaN, of runtime-sized arrays, through pointers that were passed on.
#[test]
fn indices_stay_inside() {
    let source = "
        struct Open { n: u32, list: array<vec2f> }
        @group(0) @binding(0) var<storage, read_write> out: array<f32, 4>;
        @group(0) @binding(1) var<storage, read_write> open: Open;
        @group(0) @binding(2) var<uniform> fixed: array<vec4f, 3>;
        fn write(p: ptr<function, array<vec2f, 3>>, i: i32) { (*p)[i].y = 5.0; (*p)[u32(i)][i] = 6.0; }
        @compute @workgroup_size(1) fn main() {
            let far = array<i32, 5>(-1, 2147483647, -2147483648, i32(out[3] / out[2]), 1000);
            for (var k = 0; k < 5; k++) {
                let i = far[k];
                var passed: array<vec2f, 3>; write(&passed, i);
                let p = &open.list[u32(i)]; (*p)[i] = passed[i].y;
                open.list[i] = vec2f(1.0);
                var m = mat4x4f(); m[i][i] = 2.0;
                var a = array<array<f32, 3>, 2>(); a[i][i] = m[u32(i)].w;
                out[i] = a[1][2] + fixed[i].x + fixed[1][i];
            }
        }";
    let program = program(source);
    let mut machine = Machine::<f32>::new(&program).unwrap();
    machine.run(&Invocation::default()).unwrap();
    assert_eq!(machine.values(0, 1).unwrap().len(), 3, "one element");
    assert_eq!(machine.values(0, 1).unwrap()[0], Value::Uint(0), "its neighbour is untouched");
    for bytes in 0..64 {
        let bound = machine.bind_buffer(0, 1, &vec![0; bytes]);
        assert_eq!(bound.is_ok(), bytes >= 16, "{bytes}");
        machine.run(&Invocation::default()).unwrap();
    }
}

/// Catches functions that panic at the edges of their domain, with every number type.
#[test]
fn functions_take_anything() {
    let edges = "let edges = array<f32, 10>(0.0, -0.0, 1.0, -1.0, 3.4e38, -3.4e38, 1e-45, bitcast<f32>(0x7f800000u + u32(in[0])), bitcast<f32>(0x7fc00000u + u32(in[0])), 0.5);
        for (var i = 0; i < 10; i++) { for (var j = 0; j < 10; j++) { let x = edges[i]; let y = edges[j]; let u = bitcast<u32>(x); let s = bitcast<i32>(y);";
    let expressions = [
        "sin(x) + cos(x) + tan(x) + asin(x) + acos(x) + atan(x) + atan2(x, y) + sinh(x) + cosh(x) + tanh(x) + asinh(x) + acosh(x) + atanh(x)",
        "exp(x) + exp2(x) + log(x) + log2(x) + pow(x, y) + sqrt(x) + inverseSqrt(x) + ldexp(x, s) + frexp(x).fract + f32(frexp(x).exp) + modf(x).whole",
        "min(x, y) + max(x, y) + clamp(x, y, 0.5) + saturate(x) + mix(x, y, 0.5) + step(x, y) + smoothstep(x, y, 0.5) + fma(x, y, x) + sign(x) + fract(x) + round(x)",
        "length(vec3f(x, y, 1.0)) + normalize(vec3f(x, y, x)).x + cross(vec3f(x), vec3f(y)).x + reflect(vec2f(x), vec2f(y)).x + refract(vec2f(x), vec2f(y), x).x + distance(vec2f(x), vec2f(y))",
        "f32(i32(x)) + f32(u32(x)) + f32(pack4x8unorm(vec4f(x))) + f32(pack2x16float(vec2f(y))) + f32(pack4x8snorm(vec4f(x))) + quantizeToF16(x) + x % y + unpack2x16float(u).x",
        "f32(u / (u & 1u)) + f32(s / (s & 1)) + f32(s % (s & 1)) + f32(u << (u >> 5u)) + f32(s >> u) + f32(abs(s)) + f32(extractBits(s, u, u)) + f32(insertBits(u, u, u, u)) + f32(-s) + f32(dot4I8Packed(u, u))",
    ];
    for expression in expressions {
        let body = format!("{edges} out[i % 8] = {expression}; }} }}");
        run::<f32>("f32", &body).unwrap_or_else(|error| panic!("{error}: {expression}"));
        run::<f64>("f32", &body).unwrap_or_else(|error| panic!("{error}: {expression}"));
        run::<Allowed>("f32", &body).unwrap_or_else(|error| panic!("{error}: {expression}"));
    }
}
