//! How far the reflectance models are from the papers: every module of the categories a surface's reflectance is made of, in 32 bits on the
//! evaluator and on the device, against its truth in double precision.
//!
//! What is compared. All inputs are rounded to 32 bits before anybody sees them, so what rounding the inputs does is nobody's error. A rounded
//! unit vector is off unit length by 6e-8, and a rounded tangent off a right angle; the papers know neither, so the truths bring them back first.
//! Where a module is sensitive to such a length, that is its error.
//!
//! The measure. |got - truth| / max(|truth|, 1e-9 in the function's unit): relative to the value itself, however far below the lobe's peak it
//! is. A share of the peak would hide the tails, which are what is seen of a smooth surface beside its highlight. 1e-9 /sr of the sun's 1.6e9
//! cd/m2 is what paper lit by a candle at a hundred metres has; below it no display and no eye tells a value from 0.
//!
//! The domain: alpha and widths in [1e-3, 1], directions above the horizon to 89.99 degrees, and for densities below it too. A direction nearer to the horizon
//! is left out, since on which side it is hangs on rounding. Half of the surfaces face along an axis, the others are turned in any way.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;

use common::{catalog, gpu};
use glam::DVec3;
use indexmap::IndexMap;
use serde_json::{Value as Json, json};
use shadewright::compiler::manifest::{Param, Value};
use shadewright::compiler::{Catalog, Module, Recipe};
use shadewright::modules::oracles::quadrature::direction;
use shadewright::modules::oracles::{self, At, Truth};
use shadewright::modules::{Folder, Overlay, library};
use shadewright::runtime::gpu::pipeline::Pipelines;
use shadewright::runtime::probe::Probe;

/// Categories whose modules are compared.
const CATEGORIES: [&str; 5] = ["brdf", "ndf", "masking", "fresnel", "diffuse"];
/// Stratified rows of each function; the hard ones come on top.
const ROWS: usize = 10_000;
/// Largest relative error.
const BOUND: f64 = 1e-4;
/// Below it a value is as good as 0: see above.
const FLOOR: f64 = 1e-9;
/// Four roundings of a number below 1: what a dot product of three terms, or the sum of two directions, may lose.
const MOVE: f64 = 4.0 * 5.96e-8;
/// Degrees to the normal up to which there is a bound, and its cosine.
const STEEPEST: f64 = 89.99;

/// What a model cannot: where its error is above [`BOUND`], how large it is at most, and why. The README of each says it too.
const EXCEPTIONS: &[(&str, &str, f64, &str)] = &[];

/// A stratified number for each step: multiples of an irrational fill the unit interval evenly.
fn fraction(step: usize, by: f64) -> f64 {
    (step as f64 * by + 0.5).fract()
}

/// Irrational steps of the dimensions of a row.
const STEPS: [f64; 20] = [
    0.618_033_989,
    0.414_213_562,
    0.732_050_808,
    0.236_067_977,
    0.645_751_311,
    0.316_624_790,
    0.605_551_275,
    0.123_105_626,
    0.358_898_944,
    0.795_831_523,
    0.385_164_807,
    0.567_764_363,
    0.082_762_530,
    0.403_124_237,
    0.557_438_524,
    0.855_654_600,
    0.280_109_889,
    0.681_145_748,
    0.810_249_676,
    0.185_352_771,
];

/// Where a configuration lies: two angles of v and of l or h, radians, in the frame of the surface, and that frame.
struct Place {
    normal: DVec3,
    tangent: DVec3,
}

impl Place {
    fn world(&self, local: DVec3) -> [f64; 3] {
        let d = self.tangent * local.x + self.normal.cross(self.tangent) * local.y + self.normal * local.z;
        d.normalize().as_vec3().as_dvec3().to_array()
    }
}

/// A frame along the axes, or turned in any way.
fn place(step: usize, tilted: bool) -> Place {
    if !tilted {
        return Place {
            normal: DVec3::Z,
            tangent: DVec3::X,
        };
    }
    let normal = direction(f64::acos(1.0 - 2.0 * fraction(step, STEPS[0])), TAU * fraction(step, STEPS[1]));
    let tangent = normal.any_orthonormal_vector();
    let turn = TAU * fraction(step, STEPS[2]);
    Place {
        normal,
        tangent: tangent * turn.cos() + normal.cross(tangent) * turn.sin(),
    }
}

/// A direction above the surface: anywhere, or near its rim.
fn upper(step: usize, at: usize) -> DVec3 {
    let (a, b) = (fraction(step, STEPS[at]), fraction(step, STEPS[at + 1]));
    let most = STEEPEST.to_radians();
    let theta = if step % 2 == 0 {
        f64::acos(1.0 - a * (1.0 - most.cos()))
    } else {
        80f64.to_radians() + a * (most - 80f64.to_radians())
    };
    direction(theta, TAU * b)
}

/// A half vector in the lobe of this width, from its core to its tail.
fn half(step: usize, alpha: f64, at: usize) -> DVec3 {
    let slope = alpha * 10f64.powf(-2.0 + 3.5 * fraction(step, STEPS[at]));
    direction(slope.atan(), TAU * fraction(step, STEPS[at + 1]))
}

fn mirrored(v: DVec3, h: DVec3) -> DVec3 {
    2.0 * v.dot(h) * h - v
}

/// The arguments of a row, for any of the functions: alpha in [least, 1].
fn stratified(step: usize, tilted: bool, least: f64) -> Json {
    let number = |at: usize| fraction(step, STEPS[at]);
    let alpha = least.powf(number(3));
    let widths = if step % 3 == 0 {
        [least.powf(number(3)), least.powf(number(4))]
    } else {
        [alpha; 2]
    };
    let v = upper(step, 5);
    let h = half(step, widths[step % 2], 7);
    let l = match step % 8 {
        0..=3 => mirrored(v, h),
        4 => v,
        _ => upper(step, 9),
    };
    let facet = if step % 4 == 3 { upper(step, 11) } else { h };
    row(&place(step, tilted), alpha, widths, step, [v, l, facet], number(13))
}

fn row(place: &Place, alpha: f64, widths: [f64; 2], step: usize, [v, l, facet]: [DVec3; 3], cosine: f64) -> Json {
    let single = |x: f64| f64::from(x as f32);
    let color = |at: usize| [single(fraction(step, STEPS[at])), single(fraction(step, STEPS[at + 1])), 1.0];
    // A black channel shows the lobe alone.
    let diffuse = color(16);
    json!({
        "s": {
            "normal": place.world(DVec3::Z), "tangent": place.world(DVec3::X), "alpha": single(alpha), "widths": widths.map(single),
            "f0": color(14), "diffuse": [0.0, diffuse[0], diffuse[2]],
        },
        "v": place.world(v), "l": place.world(l), "h": place.world(facet), "cosine": single(cosine),
    })
}

/// Angles to the normal in degrees, up to the horizon.
const ANGLES: [f64; 9] = [0.0, 0.01, 1.0, 20.0, 45.0, 70.0, 85.0, 89.0, 89.99];

/// Mirror directions, l = v, across the plane of incidence, both along the rim, and below it.
fn hard(alphas: &[f64], tilted: bool) -> Vec<Json> {
    let mut rows = Vec::new();
    for (i, alpha) in alphas.iter().enumerate() {
        for (j, v) in ANGLES.iter().enumerate() {
            for (k, l) in ANGLES.iter().chain(&[91.0, 135.0]).enumerate() {
                for phi in [0.0, 90.0, 180.0_f64] {
                    let step = 1000 * i + 100 * j + k;
                    let to = [direction(v.to_radians(), 0.0), direction(l.to_radians(), phi.to_radians())];
                    let place = place(step, tilted);
                    rows.push(row(&place, *alpha, [*alpha; 2], step, [to[0], to[1], to[1]], l.to_radians().cos()));
                }
            }
        }
    }
    rows
}

/// A function of a module with its truth.
struct Subject {
    name: String,
    function: String,
    truth: Truth,
    probe: Probe,
    params: Vec<Json>,
}

/// Parameters as a device gets them: the defaults, the ends of their ranges, and between. Those of a fit belong together.
fn sets(module: &Module) -> Vec<Json> {
    let params = &module.manifest.params;
    let list = |value: &Value| match value {
        Value::Number(x) => vec![*x],
        Value::List(list) => list.clone(),
        other => panic!("{other:?}"),
    };
    let of = |choose: &dyn Fn(&Param, usize, f64) -> f64| {
        let mut set = serde_json::Map::new();
        for (index, (name, param)) in params.iter().enumerate() {
            let numbers: Vec<f64> = list(&param.default)
                .iter()
                .map(|x| f64::from(choose(param, index, *x) as f32))
                .collect();
            set.insert(name.clone(), if numbers.len() == 1 { json!(numbers[0]) } else { json!(numbers) });
        }
        Json::Object(set)
    };
    let mut sets = vec![of(&|_, _, x| x)];
    if !params.is_empty() && params.len() < 5 {
        for (a, b) in [(0.0, 1.0), (1.0, 0.0), (0.25, 0.6), (0.7, 0.3)] {
            sets.push(of(&|param, index, x| {
                let (low, high) = param.range.unwrap_or((x, x));
                low + (high - low) * if index % 2 == 0 { a } else { b }
            }));
        }
    }
    sets
}

fn subjects(catalog: &Catalog, categories: &[&str]) -> Vec<Subject> {
    let mut subjects = Vec::new();
    for module in catalog.modules().filter(|m| categories.contains(&m.category.as_str())) {
        let name = format!("{}/{}", module.category, module.name);
        for function in catalog.functions(&module.category).unwrap().keys() {
            let Some(truth) = oracles::truth(&name, function) else { continue };
            let recipe = Recipe::parse("test", &format!("{name:?}")).unwrap_or_else(|e| panic!("{name}: {e}"));
            subjects.push(Subject {
                truth,
                probe: Probe::new(catalog, &recipe, function).unwrap_or_else(|error| panic!("{name}: {error}")),
                params: sets(module),
                function: function.clone(),
                name: name.clone(),
            });
        }
    }
    subjects
}

/// Errors of a kind of rows: the largest, and the largest that remains when what rounding does to directions is taken off, and where.
#[derive(Default)]
struct Worst {
    error: f64,
    at: String,
    left: f64,
    left_at: String,
}

impl Subject {
    /// The rows with what the function takes, and parameters in turn.
    fn table(&self, rows: &[Json]) -> Vec<Json> {
        let arguments: &[&str] = match self.function.as_str() {
            "distribution" => &["s", "h"],
            "facet_pdf" => &["s", "v", "h"],
            "fresnel" => &["s", "cosine"],
            "masking" => &["s", "v", "l", "h"],
            _ => &["s", "v", "l"],
        };
        let pick = |(i, row): (usize, &Json)| {
            let mut picked: serde_json::Map<String, Json> = arguments.iter().map(|name| ((*name).to_owned(), row[*name].clone())).collect();
            if self.function == "masking" {
                let sum = |i: usize| row["v"][i].as_f64().unwrap() + row["l"][i].as_f64().unwrap();
                let h = DVec3::new(sum(0), sum(1), sum(2)).normalize_or(DVec3::Z).as_vec3().as_dvec3();
                picked.insert("h".to_owned(), json!(h.to_array()));
            }
            // Runs of equal parameters: each is a dispatch.
            let params = &self.params[i * self.params.len() / rows.len()];
            if !self.params[0].as_object().unwrap().is_empty() {
                picked.insert("params".to_owned(), params.clone());
            }
            Json::Object(picked)
        };
        rows.iter().enumerate().map(pick).collect()
    }

    /// Results on the evaluator and on the device.
    fn results(&self, rows: &[Json]) -> [Vec<Vec<f64>>; 2] {
        let table = self.probe.table(rows).unwrap_or_else(|error| panic!("{}: {error}", self.name));
        let single = self
            .probe
            .on_cpu::<f32>(&table)
            .unwrap_or_else(|error| panic!("{}: {error}", self.name));
        let single = single
            .values
            .iter()
            .map(|row| row.iter().map(|x| f64::from(*x)).collect())
            .collect();
        [single, self.probe.on_gpu(&Pipelines::new(&gpu(), None), &gpu(), &table).unwrap()]
    }

    fn truth(&self, row: &Json) -> Vec<f64> {
        let none = json!({});
        (self.truth)(&At {
            inputs: row,
            params: row.get("params").unwrap_or(&none),
            instances: &[],
        })
    }

    /// How much the truth changes where its directions move by four roundings, each along the axis that changes it most.
    fn moved(&self, row: &Json, truth: &[f64]) -> Vec<f64> {
        let mut change = vec![0.0; truth.len()];
        for name in ["v", "l", "h"] {
            let mut most = vec![0.0_f64; truth.len()];
            for (axis, step) in (0..3).flat_map(|axis| [(axis, MOVE), (axis, -MOVE)]) {
                let mut near = row.clone();
                let Some(x) = near.get_mut(name).and_then(|d| d.get_mut(axis)) else {
                    continue;
                };
                *x = json!(x.as_f64().unwrap() + step);
                for ((most, near), truth) in most.iter_mut().zip(self.truth(&near)).zip(truth) {
                    *most = most.max((near - truth).abs());
                }
            }
            change.iter_mut().zip(most).for_each(|(sum, most)| *sum += most);
        }
        change
    }

    /// Largest errors on the evaluator and on the device.
    fn errors(&self, rows: &[Json]) -> [Worst; 2] {
        let rows: Vec<Json> = self.table(rows).into_iter().filter(|row| self.in_domain(row)).collect();
        let truths: Vec<Vec<f64>> = rows.iter().map(|row| self.truth(row)).collect();
        self.results(&rows).map(|results| {
            let mut worst = Worst::default();
            for ((row, truth), got) in rows.iter().zip(&truths).zip(&results) {
                assert_eq!(truth.len(), got.len(), "{} {}", self.name, self.function);
                let mut moved = None;
                for (i, (t, g)) in truth.iter().zip(got).enumerate() {
                    let size = t.abs().max(FLOOR);
                    let error = (g - t).abs() / size;
                    let at = || format!("{g:e} for {t:e} at {row}");
                    // What is no number is the worst.
                    if !(error <= worst.error) {
                        (worst.error, worst.at) = (error, at());
                    }
                    if error <= worst.left {
                        continue;
                    }
                    let left = error - moved.get_or_insert_with(|| self.moved(row, truth))[i] / size;
                    if !(left <= worst.left) {
                        (worst.left, worst.left_at) = (left, at());
                    }
                }
            }
            worst
        })
    }

    /// Above the horizon by more than rounding; of densities l and h are below it too.
    fn in_domain(&self, row: &Json) -> bool {
        let vector = |json: &Json| DVec3::from_array([0, 1, 2].map(|i| json[i].as_f64().unwrap_or(0.0)));
        let normal = vector(&row["s"]["normal"]);
        let elevation = |name: &str| row.get(name).map_or(1.0, |d| normal.dot(vector(d)));
        let least = 0.999 * STEEPEST.to_radians().cos();
        let [v, l, h] = ["v", "l", "h"].map(elevation);
        let apart = (vector(&row["v"]) + vector(&row["l"])).length();
        v > least && l.abs() > least && h.abs() > least && (!self.function.ends_with("pdf") || apart > 1e-3 || row.get("l").is_none())
    }
}

/// Catches a formula that cancels, a wrong constant or exponent, an approximation that is said to be exact; and an exception that is no longer needed,
/// or needed less than it says.
#[test]
fn modules_are_as_accurate_as_they_say() {
    let mut wrong = String::new();
    let mut table = BTreeMap::new();
    for subject in subjects(catalog(), &CATEGORIES) {
        for tilted in [false, true] {
            let mut rows: Vec<Json> = (0..ROWS / 2)
                .map(|step| stratified(2 * step + usize::from(tilted), tilted, 1e-3))
                .collect();
            rows.extend(hard(&[1e-3, 0.01, 0.1, 0.5, 1.0], tilted));
            let [cpu, device] = subject.errors(&rows);
            let key = format!("{} {}{}", subject.name, subject.function, if tilted { ", tilted" } else { "" });
            println!(
                "{key:<60} {:>9.1e} {:>9.1e} {:>9.1e} {:>9.1e}",
                cpu.error, device.error, cpu.left, device.left
            );
            println!("    {}\n    {}", cpu.at, device.left_at);
            table.insert(key, (cpu, device));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
