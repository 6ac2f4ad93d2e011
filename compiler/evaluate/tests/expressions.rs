//! Every kind of expression and function, against values from the specification or worked by hand.

#![allow(clippy::float_cmp)] // exact values

mod common;

use common::{check, float, floats, ints, program, run, run_source, uints};
use shadewright_evaluate::{Counts, EvaluateError, Invocation, Kind, Limits, Machine, Program, Value};

/// Catches operands in the wrong order, a scalar that is not spread over a vector, and rows taken for columns.
#[test]
fn arithmetic() {
    let body = "
        var x = 7.0; var v = vec3f(1.0, 2.0, 4.0);
        out[0] = x - 2.0; out[1] = x / 2.0; out[2] = x % 4.0; out[3] = -x % 4.0; out[4] = -x;
        let w = 8.0 / v; out[5] = w.z; out[6] = (v - 1.0).y; out[7] = (v.zyx * v).x;";
    assert_eq!(floats(body), [5.0, 3.5, 3.0, -3.0, -7.0, 2.0, 1.0, 4.0]);
    let body = "
        var m = mat2x3f(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
        let c = m * vec2f(10.0, 1.0); let r = vec3f(1.0, 0.0, 2.0) * m;
        out[0] = c.x; out[1] = c.z; out[2] = r.x; out[3] = r.y;
        let p = transpose(m) * m; out[4] = p[1].x; out[5] = p[1].y; out[6] = (m * 2.0)[1].z; out[7] = determinant(p);";
    assert_eq!(floats(body), [14.0, 36.0, 7.0, 16.0, 32.0, 77.0, 12.0, 54.0]);
    let body = "
        var a = 9u; var b = 4u; var z = 0u;
        out[0] = a - 10u; out[1] = a / b; out[2] = a % b; out[3] = a / z; out[4] = a % z;
        out[5] = a << b; out[6] = a >> 1u; out[7] = (a & b) | (a ^ 1u);";
    assert_eq!(uints(body), [u32::MAX, 2, 1, 9, 0, 144, 4, 8]);
    let body = "
        var a = -9i; var b = 4i; var z = 0i; var least = i32(-2147483648); var one = -1i;
        out[0] = a / b; out[1] = a % b; out[2] = least / one; out[3] = least % one; out[4] = a >> 1u; out[5] = ~a; out[6] = a / z; out[7] = abs(least);";
    assert_eq!(ints(body), [-2, -1, i32::MIN, 0, -5, 8, -9, i32::MIN]);
}

/// Catches comparisons turned round, NaN that is equal or less, and a choice between the wrong two.
#[test]
fn choices() {
    let body = "
        var a = vec4f(1.0, 2.0, 3.0, 0.0); var b = vec4f(2.0); var z = 0.0; let nan = z / z;
        out[0] = dot(select(vec4f(0.0), vec4f(1.0, 10.0, 100.0, 1000.0), a < b), vec4f(1.0));
        out[1] = dot(select(vec4f(0.0), vec4f(1.0, 10.0, 100.0, 1000.0), a >= b), vec4f(1.0));
        out[2] = select(5.0, 6.0, nan == nan); out[3] = select(5.0, 6.0, nan != nan); out[4] = select(5.0, 6.0, nan < 1.0);
        out[5] = select(5.0, 6.0, any(a > b)); out[6] = select(5.0, 6.0, all(a > b)); out[7] = select(5.0, 6.0, !(a.x == 1.0) || a.y != 2.0);";
    assert_eq!(floats(body), [1001.0, 110.0, 5.0, 6.0, 5.0, 6.0, 5.0, 5.0]);
}

/// Catches conversions that wrap where WGSL saturates, or round where it cuts, and bits that change.
#[test]
fn conversions() {
    let body = "
        var big = 1e20; var x = -3.9; var y = 3.9;
        out[0] = i32(x); out[1] = i32(y); out[2] = i32(big); out[3] = i32(-big); out[4] = bitcast<i32>(y); out[5] = i32(4294967295u); out[6] = i32(true);";
    assert_eq!(
        ints(body)[..7],
        [-3, 3, 2_147_483_520, i32::MIN, 3.9_f32.to_bits().cast_signed(), -1, 1]
    );
    let body = "var big = 1e20; var x = -3.9; out[0] = u32(x); out[1] = u32(big); out[2] = bitcast<u32>(x); out[3] = u32(-1i); out[4] = u32(bool(x));";
    assert_eq!(uints(body)[..5], [0, 4_294_967_040, (-3.9_f32).to_bits(), u32::MAX, 1]);
    let body = "var u = 16777217u; out[0] = f32(u); out[1] = f32(-7i); out[2] = bitcast<f32>(0x40490fdbu); out[3] = f32(true);";
    assert_eq!(floats(body)[..4], [16_777_216.0, -7.0, std::f32::consts::PI, 1.0]);
}

/// Catches a function that is another function, or has its arguments in another order.
#[test]
fn functions_of_floats() {
    let cases = [
        ("abs(-x)", 0.7),
        ("min(x, 0.3)", 0.3),
        ("max(x, 0.3)", 0.7),
        ("clamp(x, 0.8, 0.9)", 0.8),
        ("saturate(x * 2.0)", 1.0),
        ("sign(-x)", -1.0),
        ("step(0.7, x)", 1.0),
        ("step(0.8, x)", 0.0),
        ("floor(-x)", -1.0),
        ("ceil(-x)", 0.0),
        ("round(x * 5.0)", 4.0),
        ("round(x + 1.8)", 2.0),
        ("trunc(-x)", 0.0),
        ("fract(-0.25 * sign(x))", 0.75),
        ("sqrt(x)", 0.836_660_03),
        ("inverseSqrt(x)", 1.195_228_6),
        ("exp(x)", 2.013_752_7),
        ("exp2(x)", 1.624_504_8),
        ("log(x)", -0.356_674_94),
        ("log2(x)", -0.514_573_2),
        ("pow(x, 3.0)", 0.343),
        ("sin(x)", 0.644_217_7),
        ("cos(x)", 0.764_842_2),
        ("tan(x)", 0.842_288_4),
        ("asin(x)", 0.775_397_5),
        ("acos(x)", 0.795_398_83),
        ("atan(x)", 0.610_725_97),
        ("atan2(x, -0.5)", 2.191_045_8),
        ("sinh(x)", 0.758_583_7),
        ("cosh(x)", 1.255_169),
        ("tanh(x)", 0.604_367_8),
        ("asinh(x)", 0.652_666_6),
        ("acosh(x + 1.0)", 1.123_230_9),
        ("atanh(x)", 0.867_300_5),
        ("radians(x * 100.0)", 1.221_730_5),
        ("degrees(x)", 40.107_045),
        ("ldexp(x, 3)", 5.6),
        ("fma(x, 2.0, 0.1)", 1.5),
        ("mix(x, 1.7, 0.25)", 0.95),
        ("smoothstep(0.2, 1.2, x)", 0.5),
        ("modf(x + 2.0).whole", 2.0),
        ("modf(x + 2.0).fract", 0.7),
        ("frexp(x * 8.0).fract", 0.7),
        ("f32(frexp(x * 8.0).exp)", 3.0),
        ("quantizeToF16(x)", 0.700_195_3),
        ("length(vec3f(x, 0.0, 2.4))", 2.5),
        ("distance(vec2f(x, 1.0), vec2f(-2.3, 5.0))", 5.0),
        ("normalize(vec2f(x * 3.0, 2.8)).y", 0.8),
        ("cross(vec3f(x, 1.0, 2.0), vec3f(3.0, 4.0, 5.0)).y", 2.5),
        ("dot(vec3f(x, 1.0, 2.0), vec3f(10.0, 4.0, 5.0))", 21.0),
        ("reflect(vec2f(x, -1.0), vec2f(0.0, 1.0)).y", 1.0),
        ("refract(vec2f(x, -sqrt(1.0 - x * x)), vec2f(0.0, 1.0), 0.5).x", 0.35),
        ("refract(vec2f(x, -sqrt(1.0 - x * x)), vec2f(0.0, 1.0), 2.0).y", 0.0),
        ("faceForward(vec2f(x, 1.0), vec2f(1.0, 0.0), vec2f(1.0, 0.0)).y", -1.0),
        (
            "determinant(mat4x4f(x, 1.0, 2.0, 3.0, 0.0, 2.0, 5.0, 1.0, 4.0, 0.0, 1.0, 2.0, 1.0, 1.0, 0.0, 3.0))",
            -36.5,
        ),
    ];
    for (expression, expected) in cases {
        let got = floats(&format!("var x = 0.7; out[0] = {expression};"))[0];
        assert!(
            (got - expected).abs() <= 2e-6 * expected.abs().max(1.0),
            "{expression}: {got} instead of {expected}"
        );
    }
}

/// Catches bits that are counted from the wrong end, and extraction at the edges of the word.
#[test]
fn functions_of_integers() {
    let body = "
        var x = 0x00f0u; var none = 0u; var all = 32u; 
        out[0] = countOneBits(x); out[1] = countLeadingZeros(x); out[2] = countTrailingZeros(x); out[3] = reverseBits(x);
        out[4] = firstLeadingBit(x); out[5] = firstTrailingBit(none); out[6] = extractBits(x, 4u, 2u); out[7] = insertBits(x, 1u, 4u, 2u);";
    assert_eq!(uints(body), [4, 24, 4, 0x0f00_0000, 7, u32::MAX, 3, 0xd0]);
    let body = "
        var x = -2i; var y = 5i; var off = 28u; var many = 40u;
        out[0] = firstLeadingBit(x); out[1] = extractBits(x, off, many); out[2] = sign(x); out[3] = clamp(y, x, 3); out[4] = max(x, y);
        out[5] = dot(vec2i(x, y), vec2i(y, 3)); out[6] = dot4I8Packed(0x01ff02feu, 0x01010102u); out[7] = extractBits(0x70i, 4u, 3u);";
    assert_eq!(ints(body), [0, -1, -1, 3, 5, 5, -2, -1]);
    let body = "
        var v = vec4f(0.0, 0.5, 1.0, 2.0);
        out[0] = pack4x8unorm(v); out[1] = pack4x8snorm(-v); out[2] = pack2x16float(v.yz); out[3] = pack2x16unorm(v.yz); out[4] = pack2x16snorm(-v.yz);
        out[5] = pack4xU8(vec4u(1u, 2u, 3u, 260u)); out[6] = pack4xI8Clamp(vec4i(-200, 200, 1, -1));";
    assert_eq!(
        uints(body)[..7],
        [
            0xffff_8000,
            0x8181_c100,
            0x3c00_3800,
            0xffff_8000,
            0x8001_c001,
            0x0403_0201,
            0xff01_7f80
        ]
    );
    let body = "
        out[0] = unpack4x8unorm(0xff00u).y; out[1] = unpack4x8snorm(0x81u).x; out[2] = unpack2x16float(0x3c003800u).y;
        out[3] = unpack2x16unorm(0xffffu).x; out[4] = unpack2x16snorm(0x80000000u).y; out[5] = f32(unpack4xI8(0xff00u).y); out[6] = f32(unpack4xU8(0xff00u).y);";
    assert_eq!(floats(body)[..7], [1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 255.0]);
}

/// Catches literals, constants and pipeline constants that are mixed up, or computed once for all values.
#[test]
fn constants() {
    let source = "
        @group(0) @binding(0) var<storage, read_write> out: array<f32, 4>;
        const K = vec2f(1.0, 2.0);
        @id(7) override a: f32 = 3.0;
        override b: f32 = a * 2.0 + 1.0;
        override n: u32;
        var<private> start: f32 = 0.25;
        @compute @workgroup_size(1) fn main() { out[0] = K.y; out[1] = a; out[2] = b; out[3] = start + f32(n); start = 9.0; }";
    let checked = check(source);
    let run = |given: &[(&str, f64)]| {
        let given: Vec<(String, f64)> = given.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let program = Program::new(&checked.module, &checked.info, "main", &given, Limits::default())?;
        let mut machine = Machine::<f64>::new(&program)?;
        machine.run(&Invocation::default())?;
        machine.run(&Invocation::default())?;
        machine
            .values(0, 0)
            .map(|values| values.into_iter().map(Value::number).collect::<Vec<_>>())
    };
    assert_eq!(run(&[("n", 1.0)]).unwrap(), [2.0, 3.0, 7.0, 1.25]);
    assert_eq!(run(&[("n", 2.0), ("7", 0.5)]).unwrap(), [2.0, 0.5, 2.0, 2.25]);
    assert_eq!(run(&[]).unwrap_err().to_string(), "override `n`: has no value");
    assert_eq!(run(&[("n", -1.0)]).unwrap_err().to_string(), "override `n`: cannot be -1");
    assert_eq!(
        run(&[("a", 1.0), ("n", 1.0)]).unwrap_err().to_string(),
        "the program has no override `a`"
    );
    let error = Program::new(&checked.module, &checked.info, "other", &[], Limits::default()).unwrap_err();
    assert_eq!(error, EvaluateError::NoEntryPoint("other".to_owned()));
}

/// Catches an f64 that is f32 in some variable, buffer or function on the way, and literals that are not what the shader says.
#[test]
fn double_precision_is_kept() {
    let body = "in[3] = (in[0] + 1.0) / 3.0; var v = vec2f(in[3], 0.1); out[0] = v.x; out[1] = sqrt(v.x * v.x); out[2] = exp(log(v.x)); out[3] = v.y;";
    let values: Vec<f64> = run::<f64>("f32", body).unwrap().into_iter().map(Value::number).collect();
    for value in &values[..3] {
        assert!((value - 1.0 / 3.0).abs() < 1e-15, "{values:?}");
    }
    assert_eq!(values[3], f64::from(0.1_f32));
}

/// Catches wrong offsets of a buffer's members, a length of a runtime-sized array that counts padding, and names of others' numbers.
#[test]
fn buffers() {
    let source = "
        struct Part { v: vec3f, k: u32 }
        struct Data { m: mat3x3f, n: i32, parts: array<Part> }
        @group(0) @binding(0) var<storage, read_write> out: array<f32, 8>;
        @group(1) @binding(2) var<storage, read> data: Data;
        @compute @workgroup_size(1) fn main() {
            let n = arrayLength(&data.parts);
            out[0] = f32(n); out[1] = data.parts[n - 1u].v.y; out[2] = f32(data.parts[n + 5u].k);
            out[3] = data.m[1].z; out[4] = f32(data.n); out[5] = f32(arrayLength(&data.parts));
        }";
    let program = program(source);
    let mut machine = Machine::<f32>::new(&program).unwrap();
    machine.run(&Invocation::default()).unwrap();
    assert_eq!(machine.values(0, 0).unwrap()[0], Value::Float(1.0), "zeros, and one element");
    let mut bytes = vec![0_u8; 64 + 2 * 16 + 12];
    let mut put = |at: usize, word: [u8; 4]| bytes[at..at + 4].copy_from_slice(&word);
    put(24, 9.0_f32.to_le_bytes());
    put(48, (-4_i32).to_le_bytes());
    put(84, 2.5_f32.to_le_bytes());
    put(92, 77_u32.to_le_bytes());
    machine.bind_buffer(1, 2, &bytes).unwrap();
    machine.run(&Invocation::default()).unwrap();
    let values: Vec<f32> = machine.values(0, 0).unwrap().into_iter().map(Value::number).collect();
    assert_eq!(values[..6], [2.0, 2.5, 77.0, 9.0, -4.0, 2.0]);
    let read = machine.read(1, 2).unwrap();
    let names: Vec<&str> = read.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names[5..15].join(" "),
        "m[1].z m[2].x m[2].y m[2].z n parts[0].v.x parts[0].v.y parts[0].v.z parts[0].k parts[1].v.x"
    );
    assert_eq!(read[5].1, Value::Float(9.0));
    let error = machine.bind_buffer(1, 2, &bytes[..79]).unwrap_err();
    assert_eq!(error.to_string(), "`data` needs 80 bytes, its buffer has 79");
    assert_eq!(
        machine.bind_buffer(3, 2, &bytes).unwrap_err().to_string(),
        "the program has no binding 2 in group 3"
    );
    let sampler = machine.bind_sampler(1, 2, shadewright_evaluate::Sampler::default());
    assert_eq!(sampler.unwrap_err().to_string(), "`data` is no sampler");
}

/// Catches operations that are not counted, counted in branches that are not taken, or once for a loop's whole run.
#[test]
fn operations_are_counted() {
    let source = |n: u32| {
        format!(
            "@group(0) @binding(0) var<storage, read_write> out: array<f32, 4>;
            fn work(n: u32, v: vec3f) -> f32 {{
                var sum = 0.0;
                for (var i = 0u; i < n; i++) {{ sum += dot(v, v); }}
                if n > 2u {{ sum = sqrt(sum) / 3.0; }}
                return sum;
            }}
            @compute @workgroup_size(1) fn main() {{ out[0] = work({n}u, vec3f(out[1])) * 2.0; }}"
        )
    };
    let counts = |n| {
        let program = program(&source(n));
        let mut machine = Machine::<f32>::new(&program).unwrap();
        machine.run(&Invocation::default()).unwrap();
        machine.run(&Invocation::default()).unwrap();
        assert_eq!(
            machine.executed()[Kind::Multiply],
            machine.executed_in_functions()[Kind::Multiply] + 1
        );
        machine.executed_in_functions()
    };
    let expected = |n: u64, once: u64| {
        let mut all = Counts::default();
        for (kind, count) in [
            (Kind::Add, 3 * n),
            (Kind::Multiply, 3 * n),
            (Kind::Divide, once),
            (Kind::Root, once),
            (Kind::Select, n + 2),
            (Kind::Integer, n),
            (Kind::Branch, n + 2),
            (Kind::Trip, n),
        ] {
            all[kind] = count;
        }
        all
    };
    assert_eq!(counts(2), expected(2, 0));
    assert_eq!(counts(5), expected(5, 1));
}

/// Catches built-in values and inputs that go to the wrong argument, and results that are not read back.
#[test]
fn stages() {
    let source = "
        struct Out { @builtin(position) p: vec4f, @location(1) c: vec2f }
        @vertex fn main(@location(3) at: vec3f, @builtin(vertex_index) i: u32) -> Out { return Out(vec4f(at, 1.0), vec2f(f32(i), 2.0)); }";
    let vertex = program(source);
    let mut machine = Machine::<f32>::new(&vertex).unwrap();
    let invocation = Invocation {
        vertex_index: 7,
        locations: vec![(3, vec![1.0, 2.0, 3.0])],
        ..Invocation::default()
    };
    machine.run(&invocation).unwrap();
    let result: Vec<String> = machine
        .result()
        .into_iter()
        .map(|(name, value)| format!("{name} {}", value.number()))
        .collect();
    assert_eq!(result, ["p.x 1", "p.y 2", "p.z 3", "p.w 1", "c.x 7", "c.y 2"]);
    let fragment = "@fragment fn main(@builtin(position) p: vec4f, @builtin(front_facing) front: bool) -> @location(0) f32 {
            if p.x > 2.0 { discard; }
            return select(p.y, 0.0, front);
        }";
    let fragment = program(fragment);
    let mut machine = Machine::<f32>::new(&fragment).unwrap();
    let mut invocation = Invocation {
        position: [1.0, 5.0, 0.0, 1.0],
        front_facing: false,
        ..Invocation::default()
    };
    machine.run(&invocation).unwrap();
    assert_eq!(
        (machine.is_discarded(), machine.result()),
        (false, vec![(String::new(), Value::Float(5.0))])
    );
    invocation.position[0] = 3.0;
    machine.run(&invocation).unwrap();
    assert!(machine.is_discarded());
    let compute = "
        @group(0) @binding(0) var<storage, read_write> out: array<u32, 8>;
        @compute @workgroup_size(4, 2) fn main(@builtin(global_invocation_id) g: vec3u, @builtin(local_invocation_index) i: u32, @builtin(workgroup_id) w: vec3u) {
            out[0] = g.x; out[1] = i; out[2] = w.x; out[3] = w.y;
        }";
    let compute = program(compute);
    let mut machine = Machine::<f32>::new(&compute).unwrap();
    let invocation = Invocation {
        global_invocation_id: [9, 3, 0],
        ..Invocation::default()
    };
    machine.run(&invocation).unwrap();
    assert_eq!(machine.values(0, 0).unwrap()[..4], [9, 5, 2, 1].map(Value::Uint));
}

/// Catches a value that a later write changes, and an alias of a part that moved.
#[test]
fn values_are_snapshots() {
    let source = "
        @group(0) @binding(0) var<storage, read_write> out: array<f32, 4>;
        struct S { a: f32, v: vec4f }
        @compute @workgroup_size(1) fn main() {
            var s: S; s.v = vec4f(1.0, 2.0, 3.0, 4.0);
            let before = s; let part = s.v.yzw; let pair = vec2f(part.x, part.y);
            s.v = vec4f(9.0);
            out[0] = before.v.w; out[1] = part.y; out[2] = pair.y; out[3] = s.v.x;
        }";
    let values: Vec<f32> = run_source::<f32>(source).unwrap().into_iter().map(Value::number).collect();
    assert_eq!(values, [4.0, 3.0, 3.0, 9.0]);
    assert_eq!(float("f32(array<u32, 3>(4u, 5u, 6u)[1])"), 5.0);
}
