//! The bounds of `Allowed`: what the accuracy table of the WGSL specification says, and that they hold what is computed.

#![allow(clippy::float_cmp, clippy::expect_used)] // exact values

mod common;

use common::{program, run};
use shadewright_evaluate::{Allowed, Invocation, Machine, Number, Value};

fn exact(x: f32) -> Allowed {
    Allowed::from_f32(x)
}

/// Width of the bounds to either side of a value, in units in its last place.
fn ulps(x: Allowed, truth: f64) -> (f64, f64) {
    let ulp = f64::from((truth as f32).abs().next_up() - (truth as f32).abs());
    ((truth - x.low()) / ulp, (x.high() - truth) / ulp)
}

/// Catches a row of the table with another number. Bounds are f32, so they lie within a unit of what the table says.
#[test]
fn bounds_are_the_tables() {
    let third = 1.0_f64 / 3.0;
    let cases = [
        ("1 / 3", exact(1.0).div(exact(3.0)), third, 2.5),
        ("inverseSqrt(3)", exact(3.0).inverse_sqrt(), 1.0 / 3.0_f64.sqrt(), 2.0),
        ("sqrt(3)", exact(3.0).sqrt(), 3.0_f64.sqrt(), 2.0 * 3.0 / 2.0 + 2.5),
        ("exp(3.3)", exact(3.3).exp(), f64::from(3.3_f32).exp(), 9.6),
        ("exp2(3.3)", exact(3.3).exp2(), f64::from(3.3_f32).exp2(), 9.6),
        ("log(7)", exact(7.0).log(), 7.0_f64.ln(), 3.0),
        ("log2(0.2)", exact(0.2).log2(), f64::from(0.2_f32).log2(), 3.0),
        ("atan(0.3)", exact(0.3).atan(), f64::from(0.3_f32).atan(), 4096.0),
        ("atan2(3, -2)", exact(3.0).atan2(exact(-2.0)), 3.0_f64.atan2(-2.0), 4096.0),
        ("unpacked", Allowed::unpacked(0.3), f64::from(0.3_f32), 3.0),
    ];
    for (name, x, truth, expected) in cases {
        let (below, above) = ulps(x, truth);
        for side in [below, above] {
            assert!(
                side <= expected + 0.6 && side >= expected - 1.3,
                "{name}: {below} and {above} ULP, the table has {expected}"
            );
        }
    }
    // Absolute errors.
    let within = |x: Allowed, truth: f64, error: f64| {
        assert!(
            (truth - x.low() - error).abs() < 1.3e-7 && (x.high() - truth - error).abs() < 1.3e-7,
            "{x:?} {truth} {error}"
        );
    };
    within(exact(0.7).sin(), f64::from(0.7_f32).sin(), 1.0 / 2048.0);
    within(exact(-3.0).cos(), (-3.0_f64).cos(), 1.0 / 2048.0);
    within(exact(1.01).log2(), f64::from(1.01_f32).log2(), 1.0 / 2_097_152.0);
    // Sums and products: either neighbour, and no more.
    let sum = exact(1.0).add(exact(1e-10));
    assert_eq!((sum.low(), sum.high()), (1.0, 1.0 + f64::from(f32::EPSILON)));
    let sum = exact(1.0).add(exact(-1e-30));
    assert_eq!((sum.low(), sum.high()), (1.0 - f64::from(f32::EPSILON) / 2.0, 1.0));
    let sum = exact(1.5).add(exact(2.25));
    assert_eq!((sum.low(), sum.high()), (3.75, 3.75));
}

/// Catches bounds where the specification gives none, and none where it does.
#[test]
fn what_is_left_open_has_no_bounds() {
    let open = [
        exact(1.0).div(exact(0.0)),
        exact(1.0).div(exact(1e-40)),
        exact(1.0).div(exact(2e38)),
        exact(-1.0).sqrt(),
        exact(0.0).inverse_sqrt(),
        exact(0.0).log(),
        exact(0.0).pow(exact(2.0)),
        exact(-1.0).pow(exact(2.0)),
        exact(3.2).sin(),
        exact(0.0).atan2(exact(1.0)),
        exact(1.0).atan2(exact(0.0)),
        exact(1.1).asin(),
        exact(3e38).add(exact(3e38)),
        exact(89.0).exp(),
        exact(f32::NAN).max(exact(1.0)),
        exact(f32::INFINITY).min(exact(1.0)),
    ];
    for (i, x) in open.iter().enumerate() {
        assert!(!x.is_bounded(), "{i}: {x:?}");
        assert!(x.allows(f32::NAN) && x.allows(1.0));
    }
    for x in [
        exact(0.0).sqrt(),
        exact(0.0).div(exact(3.0)),
        exact(0.0).exp(),
        exact(0.9).asin(),
        exact(0.3).acos(),
    ] {
        assert!(x.is_bounded() && !x.allows(f32::NAN), "{x:?}");
    }
    assert_eq!(exact(0.0).sqrt(), exact(0.0));
}

/// Catches bounds without what a driver that flushes subnormals has, or that has the product and the sum in one.
#[test]
fn flushed_and_fused() {
    let tiny = exact(1e-30).mul(exact(1e-10));
    assert!(tiny.allows(0.0) && tiny.allows(1e-30 * 1e-10));
    assert!(exact(1e-40).allows(0.0));
    let (a, b) = (exact(1.000_000_1), exact(1.000_000_2));
    let c = exact(-(1.000_000_1_f32 * 1.000_000_2));
    let fused = 1.000_000_1_f32.mul_add(1.000_000_2, -(1.000_000_1_f32 * 1.000_000_2));
    assert!(fused != 0.0 && a.mul(b).add(c).allows(fused) && a.mul(b).add(c).allows(0.0));
}

/// Catches squares that may be negative, products of one thing with itself that are taken for two.
#[test]
fn squares_are_not_negative() {
    let around = exact(1.0).add(exact(1e-9)).sub(exact(1.0));
    assert!(around.low() == 0.0 && around.neg().low() < 0.0);
    let spread = around.sub(exact(5e-8));
    assert!(spread.low() < 0.0 && spread.square().low() == 0.0 && spread.mul(spread.neg().neg()).low() < 0.0);
    let program = program(
        "@group(0) @binding(0) var<storage, read_write> out: array<f32, 4>;
        @compute @workgroup_size(1) fn main() { let d = (out[3] + 1.0 + 1e-9) - 1.0 - 5e-8; out[0] = d * d; let v = vec2f(d, d); out[1] = dot(v, v); out[2] = d * -(-d); }",
    );
    let mut machine = Machine::<Allowed>::new(&program).unwrap();
    machine.run(&Invocation::default()).unwrap();
    let low = |i: usize| machine.values(0, 0).unwrap()[i].number().low();
    assert!(low(0) == 0.0 && low(1) == 0.0 && low(2) < 0.0);
}

/// Runs a body on `Allowed`: whether the run is undecided, and the first number.
fn undecided(body: &str) -> (bool, Allowed) {
    let program = program(&format!(
        "@group(0) @binding(0) var<storage, read_write> out: array<f32, 4>;
        @compute @workgroup_size(1) fn main() {{ var one = out[3] + 1.0; let near = one / 3.0 * 3.0; {body} }}"
    ));
    let mut machine = Machine::<Allowed>::new(&program).unwrap();
    machine.run(&Invocation::default()).unwrap();
    let first = machine.values(0, 0).unwrap()[0];
    (machine.is_undecided(), first.number())
}

/// Catches a branch that hangs on a rounding and is not said to, and choices that intervals settle and are said to hang.
#[test]
fn only_what_hangs_on_a_rounding_is_undecided() {
    assert!(undecided("if near < 1.0 { out[0] = 5.0; }").0);
    assert!(!undecided("if near < 1.1 { out[0] = 5.0; }").0);
    assert!(undecided("out[0] = f32(i32(near));").0);
    assert!(!undecided("out[0] = f32(i32(near + 0.5));").0);
    assert!(undecided("out[0] = f32(bitcast<u32>(near));").0);
    assert!(undecided("out[0] = f32(pack4x8unorm(vec4f(near * 0.5)) & 1u);").0);
    assert!(undecided("loop { if near >= 1.0 { break; } out[0] += 1.0; if out[0] > 3.0 { break; } }").0);
    let (hangs, chosen) = undecided("out[0] = select(2.0, 3.0, near < 1.0);");
    assert!(!hangs && chosen.allows(2.0) && chosen.allows(3.0));
    let (hangs, step) = undecided("out[0] = step(1.0, near) + sign(near - 1.0);");
    assert!(!hangs && step.allows(2.0) && step.allows(-1.0));
    let (hangs, both) = undecided("if (near < 1.0) & (one > 2.0) { out[0] = 1.0; } if (near < 1.0) | (one < 2.0) { out[0] = 2.0; }");
    assert!(!hangs && both.value() == 2.0);
    assert!(undecided("if !((near < 1.0) | (one > 2.0)) { out[0] = 1.0; }").0);
    // `&&` is a branch, so it hangs also where its right side would settle it.
    assert!(undecided("if near < 1.0 && one > 2.0 { out[0] = 1.0; }").0);
    let (hangs, clamped) = undecided("out[0] = max(near, 1.0);");
    assert!(!hangs && clamped.low() == 1.0);
    assert!(
        undecided("if near * 1e38 * 1e38 > 0.0 { out[0] = 1.0; }").0,
        "anything may be above 0"
    );
}

/// SplitMix64 (Steele, Lea and Flood 2014).
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A number of any magnitude, from bits.
fn any_float(state: &mut u64) -> f32 {
    let word = random(state);
    match word % 4 {
        0 => f32::from_bits((word >> 32) as u32),
        1 => [
            0.0,
            -0.0,
            1.0,
            -1.0,
            f32::MAX,
            f32::MIN_POSITIVE,
            1e-40,
            0.5,
            2.0,
            std::f32::consts::PI,
        ][(word >> 8) as usize % 10],
        _ => ((word >> 40) as f32 / (1_u32 << 24) as f32 - 0.5) * 8.0,
    }
}

/// Catches bounds that do not hold f32's own result, the f64's, or a neighbour where the rounding is free; for every operation.
#[test]
fn bounds_hold_f32_and_f64() {
    type Unary = (&'static str, fn(Allowed) -> Allowed, fn(f64) -> f64);
    type Binary = (&'static str, fn(Allowed, Allowed) -> Allowed, fn(f64, f64) -> f64);
    let unary: [Unary; 26] = [
        ("abs", Number::abs, Number::abs),
        ("sign", Number::sign, Number::sign),
        ("floor", Number::floor, Number::floor),
        ("ceil", Number::ceil, Number::ceil),
        ("round", Number::round, Number::round),
        ("trunc", Number::trunc, Number::trunc),
        ("fract", Number::fract, Number::fract),
        ("sqrt", Number::sqrt, Number::sqrt),
        ("inverse_sqrt", Number::inverse_sqrt, Number::inverse_sqrt),
        ("exp", Number::exp, Number::exp),
        ("exp2", Number::exp2, Number::exp2),
        ("log", Number::log, Number::log),
        ("log2", Number::log2, Number::log2),
        ("sin", Number::sin, Number::sin),
        ("cos", Number::cos, Number::cos),
        ("tan", Number::tan, Number::tan),
        ("asin", Number::asin, Number::asin),
        ("acos", Number::acos, Number::acos),
        ("atan", Number::atan, Number::atan),
        ("sinh", Number::sinh, Number::sinh),
        ("cosh", Number::cosh, Number::cosh),
        ("tanh", Number::tanh, Number::tanh),
        ("asinh", Number::asinh, Number::asinh),
        ("acosh", Number::acosh, Number::acosh),
        ("atanh", Number::atanh, Number::atanh),
        ("square", Number::square, Number::square),
    ];
    let binary: [Binary; 10] = [
        ("add", Number::add, Number::add),
        ("sub", Number::sub, Number::sub),
        ("mul", Number::mul, Number::mul),
        ("div", Number::div, Number::div),
        ("rem", Number::rem, Number::rem),
        ("min", Number::min, Number::min),
        ("max", Number::max, Number::max),
        ("step", Number::step, Number::step),
        ("pow", Number::pow, Number::pow),
        ("atan2", Number::atan2, Number::atan2),
    ];
    let mut state = 1;
    let mut bounded = std::collections::BTreeMap::new();
    // Cancellation leaves f64 with what f32 rounded before: only single operations on exact numbers are compared.
    let mut holds = |name: &'static str, x: Allowed, truth: f64, of: String| {
        if !x.is_bounded() {
            return;
        }
        *bounded.entry(name).or_insert(0) += 1;
        assert!(x.allows(x.value()), "{name}{of}: {x:?}");
        // The truth lies within a unit in the last place of some result.
        let slack = 1e-12 * truth.abs() + f64::from(f32::MIN_POSITIVE);
        let nearest = truth as f32;
        let (low, high) = (f64::from(nearest.next_down()), f64::from(nearest.next_up()));
        assert!(
            x.low() <= high + slack && x.high() >= low - slack,
            "{name}{of}: {x:?} without {truth}"
        );
    };
    for _ in 0..20_000 {
        let (x, y) = (any_float(&mut state), any_float(&mut state));
        for (name, function, truth) in unary {
            holds(name, function(exact(x)), truth(f64::from(x)), format!("({x:?})"));
        }
        for (name, function, truth) in binary {
            holds(
                name,
                function(exact(x), exact(y)),
                truth(f64::from(x), f64::from(y)),
                format!("({x:?}, {y:?})"),
            );
        }
    }
    assert_eq!(bounded.len(), unary.len() + binary.len(), "{bounded:?}");
    assert!(bounded.values().all(|count| *count > 300), "{bounded:?}");
}

/// Catches an interval operation that forgets part of its interval: results at points inside must be inside.
#[test]
fn intervals_hold_their_points() {
    let mut state = 2;
    let spread = |x: f32, y: f32| exact(x).or_else(exact(y));
    let inside = |whole: Allowed, part: Allowed, of: &str| {
        if whole.is_bounded() {
            assert!(
                part.is_bounded() && whole.low() <= part.low() && part.high() <= whole.high(),
                "{of}: {whole:?} without {part:?}"
            );
        }
    };
    for _ in 0..20_000 {
        let [a, b, c, d] = [0; 4].map(|_| any_float(&mut state));
        let (x, y) = (spread(a, b), spread(c, d));
        let middle = a + (b - a) * 0.37;
        for p in [a, b, middle].into_iter().filter(|p| p.is_finite()).map(exact) {
            let q = exact(c);
            let unary: [fn(Allowed) -> Allowed; 12] = [
                Number::abs,
                Number::floor,
                Number::fract,
                Number::sqrt,
                Number::exp2,
                Number::log2,
                Number::sin,
                Number::cos,
                Number::atan,
                Number::square,
                Number::sign,
                Number::tanh,
            ];
            for (i, function) in unary.iter().enumerate() {
                inside(function(x), function(p), &format!("unary {i} ({a:?} to {b:?}) at {p:?}"));
            }
            let binary: [fn(Allowed, Allowed) -> Allowed; 8] = [
                Number::add,
                Number::sub,
                Number::mul,
                Number::div,
                Number::min,
                Number::max,
                Number::step,
                Number::atan2,
            ];
            for (i, function) in binary.iter().enumerate() {
                inside(
                    function(x, y),
                    function(p, q),
                    &format!("binary {i} ({a:?} to {b:?}, {c:?} to {d:?}) at {p:?}, {q:?}"),
                );
            }
            inside(x.clamp(q, y), p.clamp(q, q), &format!("clamp {a:?} {b:?} {c:?} {d:?}"));
            inside(Number::dot(&[x, y], &[y, x], false), Number::dot(&[p, q], &[q, p], false), "dot");
        }
    }
}

/// Catches sums of products whose order is taken for granted.
#[test]
fn dot_products_hold_every_order() {
    let mut state = 3;
    for _ in 0..10_000 {
        let x: [f32; 4] = std::array::from_fn(|_| (any_float(&mut state) % 100.0).clamp(-100.0, 100.0));
        let y: [f32; 4] = std::array::from_fn(|_| (any_float(&mut state) % 100.0).clamp(-100.0, 100.0));
        if x.iter().chain(&y).any(|x| !x.is_finite()) {
            continue;
        }
        let dot = Number::dot(&x.map(exact), &y.map(exact), false);
        let p: [f32; 4] = std::array::from_fn(|i| x[i] * y[i]);
        let fused = x[3].mul_add(y[3], x[2].mul_add(y[2], x[1].mul_add(y[1], p[0])));
        for sum in [
            p[0] + p[1] + p[2] + p[3],
            (p[3] + p[2]) + (p[1] + p[0]),
            p[3] + p[0] + p[2] + p[1],
            fused,
        ] {
            assert!(dot.allows(sum), "{x:?} {y:?}: {sum} is not in {dot:?}");
        }
    }
    assert!(
        matches!(run::<Allowed>("f32", "out[0] = dot(vec3f(1.0, 2.0, 3.0), vec3f(4.0, 5.0, 6.0));").unwrap()[0], Value::Float(x) if x == exact(32.0))
    );
}
