//! Snippets on the device and on the CPU: bits are equal where WGSL leaves one result, and within the bounds elsewhere.

use std::fmt::Write as _;
use std::sync::Arc;

use serde_json::{Value as Json, json};
use shadewright::compiler::{Catalog, Library, Recipe};
use shadewright::evaluate::Allowed;
use shadewright::modules::Overlay;
use shadewright::runtime::gpu::pipeline::Pipelines;
use shadewright::runtime::probe::Probe;

use super::common::gpu;
use super::rows::Random;

/// Results that can only be these: integers, choices, what is exact, and what rounds to nearest on every driver that is tested here.
const EXACT: &[&str] = &[
    "return vec4f(a.x + b.x, a.x - b.y, a.x * b.z, -a.w);",
    "return a.wzyx * b + vec4f(vec4<bool>(a.x > b.x, a.y <= b.y, true, false)).yxwz;",
    "return floor(a) + ceil(b) * 16.0 + trunc(a) * 256.0 + round(b) * 4096.0;",
    "return select(a, b, a < b) + step(a, b) + sign(a);",
    "return vec4f(max(a.x, b.x), min(a.y, b.y), clamp(a.z, -1.0, 1.0), abs(a.w));",
    "return vec4f(k + k.yzwx * 3);",
    "return vec4f(vec4i(k.x / k.y, k.x % k.y, k.z << (u32(k.w) & 7u), k.x >> 2u));",
    "return vec4f(vec4u(k) / 7u % 1000u);",
    "return vec4f(vec4i(a * 10.0)) + vec4f(vec4u(abs(b) * 10.0));",
    "return vec4f(countOneBits(k)) + vec4f(firstLeadingBit(k)) * 64.0 + vec4f(extractBits(k, 3u, 9u));",
    "var m = mat2x2f(a.x, a.y, b.x, b.y); m[k.x & 1][k.y & 1] = 3.0; return vec4f(m[0], m[1]);",
    "var list = array<f32, 5>(1.0, 2.0, 3.0, 4.0, 5.0); var i = u32(k.x) % 5u; list[i] = a.x; return vec4f(list[0], list[1], list[i], list[4]);",
    "var sum = 0.0; for (var i = 0; i < (k.x & 15); i++) { if i == 3 { continue; } if i > 9 { break; } sum += f32(i); } return vec4f(sum);",
    "switch k.x & 3 { case 0: { return a; } case 1, 2: { return b; } default: { return a + 1.0; } }",
    "var x = vec3f(1.0); x.z += a.x; x[k.x & 1] *= 2.0; let y = x; x = vec3f(0.0); return vec4f(y, x.x);",
    "return bitcast<vec4f>((bitcast<vec4u>(a) & vec4u(0x7fffffffu)) | vec4u(0x3f800000u)) * 0.0 + vec4f(unpack4x8snorm(0u));",
    "return vec4f(f32(pack4xU8(vec4u(k)) & 0xffffu), f32(insertBits(u32(k.x), u32(k.y), 4u, 8u) & 0xffffu), f32(reverseBits(k.x) & 0xffff), 0.0);",
    "return vec4f(dot(k, k.wzyx)) + ldexp(a, k & vec4i(7));",
];

/// Results that a driver may round in its own way.
const ROUNDED: &[&str] = &[
    "return a / (abs(b) + 0.1);",
    "return sqrt(abs(a)) + inverseSqrt(abs(b) + 0.01);",
    "return vec4f(dot(a, b), length(a), distance(a, b), dot(a.xyz, b.xyz));",
    "return normalize(a + vec4f(0.0, 0.0, 0.0, 9.0));",
    "return vec4f(cross(a.xyz, b.xyz), fma(a.x, b.y, a.z));",
    "return exp(a) + exp2(b);",
    "return log(abs(a) + 0.01) + log2(abs(b) + 0.01);",
    "return pow(abs(a) + 0.01, b);",
    "return sin(a) + cos(b * 0.7);",
    "return vec4f(atan(a.x), atan2(a.y, b.x), tan(a.z * 0.3), sinh(b.x));",
    "return vec4f(tanh(a.x), cosh(a.y), asinh(a.z), acosh(abs(b.x) + 1.1));",
    "return mix(a, b, vec4f(0.3, 0.0, 1.0, 0.7)) + smoothstep(vec4f(-1.0), vec4f(2.0), b);",
    "return vec4f(reflect(a.xyz, normalize(b.xyz + vec3f(0.0, 0.0, 9.0))), fract(b.x));",
    "return mat4x4f(a, b, a.wzyx, b.yxwz) * a + b * mat4x4f(b, a, b, a);",
    "return unpack4x8unorm(u32(k.x)) + unpack2x16snorm(u32(k.y)).xyxy + quantizeToF16(a);",
    "return a % (abs(b) + 0.3) + radians(a) + degrees(b);",
    "let n = normalize(a.xyz + vec3f(0.0, 0.0, 9.0)); return vec4f(refract(n, vec3f(0.0, 0.0, -1.0), 0.7), modf(b.x).fract);",
];

/// A category with a module for each snippet.
struct Snippets;

impl Library for Snippets {
    fn folders(&self, folder: &str) -> Vec<String> {
        match folder {
            "" => vec!["snippet".to_owned()],
            "snippet" => (0..EXACT.len() + ROUNDED.len()).map(|i| format!("snippet-{i}")).collect(),
            _ => Vec::new(),
        }
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        let function = "fn eval(a: vec4f, b: vec4f, k: vec4<i32>) -> vec4f";
        let Some((name, file)) = path.strip_prefix("snippet/").and_then(|rest| rest.split_once('/')) else {
            return Ok(match path {
                "snippet/category.ron" => Some("(summary: \"tested\", order: 1, group: 3)".to_owned()),
                "snippet/interface.wgsl" => Some(format!("{function} {{ return a; }}")),
                _ => None,
            });
        };
        let Some(index) = name.strip_prefix("snippet-").and_then(|i| i.parse::<usize>().ok()) else {
            return Ok(None);
        };
        let body = EXACT.iter().chain(ROUNDED).nth(index);
        Ok(match (body, file) {
            (Some(_), "module.ron") => Some("(summary: \"tested\")".to_owned()),
            (Some(body), file) if file == format!("{name}.wgsl") => Some(format!("{function} {{ {body} }}")),
            _ => None,
        })
    }
}

fn rows() -> Vec<Json> {
    let mut random = Random(5);
    (0..256)
        .map(|i| {
            let mut four = |scale: f64| json!([0; 4].map(|_| ((random.unit() - 0.5) * scale) as f32));
            let (a, b) = (four(6.0), four(6.0));
            let k = json!([0; 4].map(|_| if i == 0 { 0 } else { (random.word() % 2000) as i64 - 1000 }));
            json!({"a": a, "b": b, "k": k})
        })
        .collect()
}

/// Catches an operation that is another one, on the device or on the CPU: of expressions, statements and functions, each alone.
#[test]
fn snippets_are_the_same_on_device_and_cpu() {
    let library = Overlay(vec![Arc::new(Snippets), shadewright::modules::library()]);
    let catalog = Catalog::load(Arc::new(library)).unwrap_or_else(|report| panic!("{report}"));
    let pipelines = Pipelines::new(&gpu(), None);
    let rows = rows();
    let mut wrong = String::new();
    for (index, body) in EXACT.iter().chain(ROUNDED).enumerate() {
        let recipe = Recipe::parse("test", &format!("\"snippet-{index}\"")).unwrap();
        let probe = match Probe::new(&catalog, &recipe, "eval") {
            Ok(probe) => probe,
            Err(error) => {
                let _ = writeln!(wrong, "{body}\n  {error}");
                continue;
            }
        };
        let table = probe.table(&rows).unwrap();
        let device = probe.on_gpu(&pipelines, &gpu(), &table).unwrap();
        let single = probe.on_cpu::<f32>(&table).unwrap();
        let allowed = probe.on_cpu::<Allowed>(&table).unwrap();
        let mut bounded = 0;
        for (row, input) in rows.iter().enumerate() {
            for (i, got) in device[row].iter().enumerate() {
                let (got, value, bounds) = (*got as f32, single.values[row][i], allowed.values[row][i]);
                let same = got == value || got.is_nan() && value.is_nan();
                if index < EXACT.len() && !same || !allowed.undecided[row] && !bounds.allows(got) {
                    let _ = writeln!(wrong, "{body}\n  {input} [{i}]: device {got:?}, CPU {value:?}, {bounds:?}");
                    break;
                }
                bounded += usize::from(bounds.is_bounded() && !allowed.undecided[row]);
            }
        }
        let share = bounded as f64 / (4 * rows.len()) as f64;
        if share < 0.3 {
            let _ = writeln!(wrong, "{body}: only {:.0} % have bounds", share * 100.0);
        }
    }
    let lines: Vec<&str> = wrong.lines().take(60).collect();
    assert!(wrong.is_empty(), "{}", lines.join("\n"));
}
