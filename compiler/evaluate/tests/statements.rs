//! Every kind of statement, with what it must do.

mod common;

use common::{floats, ints, run, run_source, uints};
use shadewright_evaluate::{EvaluateError, Value};

/// Catches a branch that runs both sides, or the wrong one, and a `switch` that falls through, misses its default, or breaks its loop.
#[test]
fn branches() {
    let body = "
        for (var i = 0i; i < 6; i++) {
            var x = 0i;
            if i < 2 { x = 1; } else if i == 2 { x = 2; } else { x = 3; }
            switch i {
                case 0, 5: { x += 10; }
                case 3: { x += 20; if x > 0 { break; } x += 1000; }
                default: { x += 30; }
            }
            out[i] = x;
        }";
    assert_eq!(ints(body)[..6], [11, 31, 32, 23, 33, 13]);
}

/// Catches `continue` that skips the continuing block, `break if` read the other way round, and inner loops that leave outer ones.
#[test]
fn loops() {
    let body = "
        var i = 0u; var sum = 0u; var trips = 0u;
        loop {
            if i == 2u { continue; }
            sum += i;
            continuing { i++; trips++; break if i >= 5u; }
        }
        out[0] = sum; out[1] = trips;
        var n = 0u;
        for (var a = 0u; a < 3u; a++) {
            for (var b = 0u; b < 10u; b++) { if b == 4u { break; } if b == 1u { continue; } n += 1u; }
            n += 100u;
        }
        out[2] = n;
        var w = 0u;
        while true { w++; switch w { case 7u: { break; } default: { continue; } } break; }
        out[3] = w;";
    assert_eq!(uints(body)[..4], [8, 5, 309, 7]);
}

/// Catches variables that keep what an earlier call or trip left in them, results of two calls that share a place, and returns that go on.
#[test]
fn calls() {
    let source = "
        @group(0) @binding(0) var<storage, read_write> out: array<f32, 8>;
        var<private> count: u32 = 5u;
        struct Pair { a: f32, b: vec3f }
        fn twice(x: f32) -> f32 { var t: f32; t += x; if x > 2.0 { return t + t; } return -1.0; }
        fn write(p: ptr<function, vec3f>, x: f32) { (*p).y = x; (*p)[2] += x; }
        fn make(x: f32) -> Pair { count++; return Pair(x, vec3f(twice(x), 1.0, 2.0)); }
        @compute @workgroup_size(1) fn main() {
            let both = twice(3.0) - twice(4.0);
            var v = vec3f(1.0, 2.0, 3.0);
            write(&v, 7.0);
            let p = make(5.0);
            out[0] = both; out[1] = v.x; out[2] = v.y; out[3] = v.z;
            out[4] = p.a; out[5] = p.b.x; out[6] = f32(count); out[7] = twice(1.0);
        }";
    let values: Vec<f32> = run_source::<f32>(source).unwrap().into_iter().map(Value::number).collect();
    assert_eq!(values, [-2.0, 1.0, 7.0, 10.0, 5.0, 10.0, 6.0, -1.0]);
}

/// Catches an index that is not clamped, strides in the wrong unit, dynamic parts of values and of pointers taken for one another.
#[test]
fn places() {
    let source = "
        struct Inner { a: f32, b: vec2f }
        struct Outer { list: array<Inner, 3>, m: mat2x3f }
        @group(0) @binding(0) var<storage, read_write> out: array<f32, 8>;
        var<private> o: Outer;
        fn index(i: i32) -> i32 { return i; }
        @compute @workgroup_size(1) fn main() {
            for (var i = 0; i < 3; i++) { o.list[i] = Inner(f32(i), vec2f(f32(i * 10), 0.5)); }
            o.m[index(1)][2] = 9.0;
            o.m[0] = vec3f(1.0, 2.0, 3.0);
            let copy = o;
            o.list[1].a = 100.0;
            out[0] = copy.list[index(1)].a;
            out[1] = o.list[index(7)].b.x;
            out[2] = o.list[index(-1)].b[index(1)];
            out[3] = copy.m[1][index(2)];
            out[4] = o.m[index(0)].y;
            let p = &o.list[index(2)];
            (*p).b.y = 4.0;
            out[5] = o.list[2].b.y;
            var small = array<f32, 2>(5.0, 6.0);
            out[6] = small[index(1)];
            out[index(70)] = 8.0;
        }";
    let values: Vec<f32> = run_source::<f32>(source).unwrap().into_iter().map(Value::number).collect();
    assert_eq!(values, [1.0, 20.0, 0.5, 9.0, 2.0, 4.0, 6.0, 8.0]);
}

/// Catches atomics that give the new value instead of the old one, or compare wrongly.
#[test]
fn atomics() {
    let source = "
        @group(0) @binding(0) var<storage, read_write> out: array<u32, 8>;
        var<workgroup> a: atomic<u32>;
        var<workgroup> s: atomic<i32>;
        @compute @workgroup_size(1) fn main() {
            atomicStore(&a, 5u);
            out[0] = atomicAdd(&a, 3u);
            out[1] = atomicSub(&a, 1u);
            out[2] = atomicMax(&a, 20u);
            out[3] = atomicExchange(&a, 30u);
            let r = atomicCompareExchangeWeak(&a, 31u, 40u);
            let t = atomicCompareExchangeWeak(&a, 30u, 50u);
            out[4] = r.old_value + select(0u, 1000u, r.exchanged);
            out[5] = t.old_value + select(0u, 1000u, t.exchanged);
            workgroupBarrier();
            atomicStore(&s, -4);
            atomicMin(&s, 3);
            out[6] = atomicLoad(&a);
            out[7] = u32(atomicLoad(&s) + 4);
        }";
    let values = run_source::<f32>(source).unwrap();
    assert_eq!(values, [5, 8, 7, 20, 30, 1030, 50, 0].map(Value::Uint));
}

/// Catches a loop without an end that hangs, and one that is cut off too early.
#[test]
fn endless_loops_end() {
    let error = run::<f32>("f32", "loop { out[0] += 1.0; if out[0] < 0.0 { break; } }").unwrap_err();
    assert!(matches!(error, EvaluateError::Steps { .. }), "{error}");
    assert_eq!(floats("for (var i = 0; i < 100000; i++) { out[0] += 1.0; }")[0], 100_000.0);
}

/// Catches what cannot be evaluated and is, and a refusal of code that is never reached.
#[test]
fn what_is_not_evaluated_is_an_error_where_it_is_reached() {
    let source = |condition: &str| {
        format!(
            "@group(0) @binding(0) var<storage, read_write> out: array<f32, 8>;
            @group(0) @binding(1) var t: texture_multisampled_2d<f32>;
            @compute @workgroup_size(1) fn main() {{ out[1] = 3.0; if out[0] {condition} 0.0 {{ out[0] = textureLoad(t, vec2i(0), 0).x; }} }}"
        )
    };
    assert_eq!(run_source::<f32>(&source("<")).unwrap()[1], Value::Float(3.0));
    let error = run_source::<f32>(&source("==")).unwrap_err();
    assert_eq!(error.to_string(), "a multisampled texture cannot be evaluated on the CPU");
    let error = run_source::<f64>(
        "@group(0) @binding(0) var<storage, read_write> out: array<u32, 8>;
        @compute @workgroup_size(1) fn main() { var x = 3lu; x += 4lu; out[0] = select(1u, 2u, x > 5lu); }",
    );
    assert_eq!(error.unwrap_err().to_string(), "the type u64 cannot be evaluated on the CPU");
}
