//! How far the reflectance models are from the papers: every module of the categories a surface's reflectance is made of, in 32 bits on the
//! evaluator and on the device, against its truth in double precision.
//!
//! What is compared. All inputs are rounded to 32 bits before anybody sees them, so what rounding the inputs does is nobody's error. A rounded
//! unit vector is off unit length by 6e-8, and a rounded tangent off a right angle. The truths take angles, which know no length, bring the
//! tangent across the normal, and take v + l as it is for the half vector: of nearly opposite directions it hangs on the rounding of their lengths.
//!
//! The measure. |got - truth| / max(|truth|, 1e-9 in the function's unit): relative to the value itself, however far below the lobe's peak it
//! is. A share of the peak would hide the tails, which are what is seen of a smooth surface beside its highlight. 1e-9 /sr of the sun's 1.3e5 lx are
//! 1.3e-4 cd/m2, which is starlight: below it no display and no eye tells a value from 0.
//!
//! The domain: alpha and widths in [1e-3, 1], angles to the normal to 89.99 degrees, for densities below the horizon too. Nearer to the horizon rows are left
//! out, since on which side they are hangs on rounding. Half of the surfaces face along an axis, the others are turned in any way.
//!
//! The bounds. Along the axes: 1e-4. In a turned frame a dot product of three terms is known to a few roundings of 6e-8, which is 3e-4 of a cosine at
//! 89.99 degrees, and so is v + l, which is 3e-4 of the slope in a lobe of width 1e-3. So there the bound is 1e-4 for widths from 0.01 and angles to 89.9 degrees, and 5e-4 in
//! the rest of the domain. Beside that, in every row: what is left of the error, when the truth's own change over four roundings of the directions
//! is taken off, is below 1e-4. Where the truth changes by more than a hundredth (it jumps: the edge of a lobe without a falloff,
//! a facet seen edge on) only that holds.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::f64::consts::TAU;
use std::sync::Arc;

use common::{catalog, gpu};
use glam::DVec3;
use serde_json::{Value as Json, json};
use shadewright::compiler::manifest::{Param, Value};
use shadewright::compiler::{Catalog, Library, Module, Recipe};
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
/// Degrees to the normal up to which there is a bound.
const STEEPEST: f64 = 89.99;

/// Largest relative error in a turned frame, where the lobe is narrow or a direction is at the rim.
const TURNED_BOUND: f64 = 5e-4;
/// Least width, and largest angle in degrees, for which a turned frame has the bound of a straight one.
const TURNED_DOMAIN: (f64, f64) = (0.01, 89.9);
/// Change of a truth over four roundings from which it jumps.
const JUMP: f64 = 0.01;

/// What a model cannot: the largest error where it is above the bound, and why. The README of each says it too.
const EXCEPTIONS: &[(&str, f64, &str)] = &[
    (
        "brdf/sgd brdf",
        3e-3,
        "within 0.2 degrees of the horizon G1 is a difference that the fits let go to 0",
    ),
    (
        "brdf/lafortune brdf",
        1.5e-3,
        "where C shrinks the lobe its peak is no cosine of 1, and 6e-8 of it counts 2 / alpha^2 times",
    ),
    (
        "brdf/rgl brdf",
        4e-3,
        "where a part of the square comes from next to nothing, its place is the quotient of two small sums",
    ),
    ("fresnel/f82 fresnel", 1e-1, "a dark tint makes the sum of two terms cross 0"),
    ("fresnel/schlick-f82 fresnel", 2e-3, "as in f82"),
    (
        "fresnel/schlick-f90 fresnel",
        5e-4,
        "where f90 is far below f0 the sum of two terms nears 0 at the horizon",
    ),
];

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

/// How a surface lies in the world.
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
    let theta = if step.is_multiple_of(2) {
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
    let widths = if step.is_multiple_of(3) {
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
    let share = |at: usize| single(fraction(step, STEPS[at]));
    // A black channel shows the lobe alone.
    let diffuse = color(16);
    json!({
        "s": {
            "normal": place.world(DVec3::Z), "tangent": place.world(DVec3::X), "alpha": single(alpha), "widths": widths.map(single),
            "f0": color(14), "f90": color(12), "f82": color(4), "diffuse": [0.0, diffuse[0], diffuse[2]], "diffuse_roughness": share(18),
            "coat": share(19), "coat_alpha": single(alpha), "coat_ior": 1.5, "coat_color": color(10), "coat_normal": place.world(DVec3::Z),
            "fuzz": share(17), "fuzz_color": color(8), "fuzz_roughness": share(6),
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

/// Parameters as a device gets them: the defaults, the ends of their ranges, and between. Those of a fit belong together; switches stay as they are.
fn sets(module: &Module) -> Vec<Json> {
    let params: Vec<(&String, &Param)> = module
        .manifest
        .params
        .iter()
        .filter(|(_, p)| !matches!(p.default, Value::Bool(_)))
        .collect();
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
            set.insert((*name).clone(), if numbers.len() == 1 { json!(numbers[0]) } else { json!(numbers) });
        }
        Json::Object(set)
    };
    let mut sets = vec![of(&|_, _, x| x)];
    if !params.is_empty() && params.len() < 5 {
        for (a, b) in [(0.0, 1.0), (1.0, 0.0), (0.25, 0.6), (0.7, 0.3)] {
            sets.push(of(&|param, index, x| {
                let (low, high) = param.range.unwrap_or((x, x));
                low + (high - low) * if index.is_multiple_of(2) { a } else { b }
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

/// The largest errors of some rows, and where the first is.
#[derive(Debug, Default)]
struct Worst {
    /// Where the truth does not jump.
    error: f64,
    /// What is left of any error when what rounding does to directions is taken off.
    left: f64,
    /// The largest that is above its bound.
    beyond: f64,
    at: String,
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
    fn errors(&self, rows: &[Json], turned: bool) -> [Worst; 2] {
        let rows: Vec<Json> = self
            .table(rows)
            .into_iter()
            .filter(|row| self.elevation(row) > elevation_at(STEEPEST))
            .collect();
        let truths: Vec<Vec<f64>> = rows.iter().map(|row| self.truth(row)).collect();
        self.results(&rows).map(|results| {
            let mut worst = Worst::default();
            for ((row, truth), got) in rows.iter().zip(&truths).zip(&results) {
                assert_eq!(truth.len(), got.len(), "{} {}", self.name, self.function);
                let mut moved = None;
                for (i, (t, g)) in truth.iter().zip(got).enumerate() {
                    let size = t.abs().max(FLOOR);
                    let error = if g.is_finite() { (g - t).abs() / size } else { f64::INFINITY };
                    if error <= worst.error && error <= worst.left && error <= BOUND {
                        continue;
                    }
                    let moved = moved.get_or_insert_with(|| self.moved(row, truth))[i];
                    let jumps = moved > JUMP * t.abs();
                    let left = (error - moved / size).max(0.0);
                    let bound = if turned && self.is_at_the_rim(row) { TURNED_BOUND } else { BOUND };
                    let seen = if jumps { left } else { error };
                    let over = if jumps { left / BOUND } else { (error / bound).max(left / BOUND) };
                    worst.left = worst.left.max(left);
                    worst.error = if jumps { worst.error } else { worst.error.max(error) };
                    if over > 1.0 && seen > worst.beyond {
                        worst.beyond = seen;
                        worst.at = format!("{g:e} for {t:e} at {row}");
                    }
                }
            }
            worst
        })
    }

    /// The least sine of the angles between the directions of a row and the surface; of densities also that of the half vector, and of the angle between
    /// a facet and who sees it.
    fn elevation(&self, row: &Json) -> f64 {
        let vector = |json: &Json| DVec3::from_array([0, 1, 2].map(|i| json[i].as_f64().unwrap_or(0.0)));
        let normal = vector(&row["s"]["normal"]);
        let [v, l, h] = ["v", "l", "h"].map(|name| row.get(name).map(vector));
        let above = v.map_or(1.0, |v| normal.dot(v));
        let other = [l, h].into_iter().flatten().map(|d| normal.dot(d).abs());
        let mut least = other.fold(above, f64::min);
        if self.function == "brdf_pdf" {
            // Nothing mirrors a direction into the opposite one.
            let half = v.unwrap() + l.unwrap();
            least = if half.length() < 1e-3 {
                0.0
            } else {
                least.min(normal.dot(half).abs() / half.length())
            };
        }
        if self.function == "facet_pdf" {
            least = least.min(v.unwrap().dot(h.unwrap()).abs());
        }
        least
    }

    /// A lobe too narrow, or a direction too near to the horizon, for the bound of straight frames.
    fn is_at_the_rim(&self, row: &Json) -> bool {
        let s = &row["s"];
        let widths = [&s["alpha"], &s["widths"][0], &s["widths"][1]].map(|x| x.as_f64().unwrap());
        widths.iter().any(|width| *width < TURNED_DOMAIN.0) || self.elevation(row) < elevation_at(TURNED_DOMAIN.1)
    }
}

/// Sine of the angle to the horizon at an angle to the normal in degrees, less a rounding.
fn elevation_at(degrees: f64) -> f64 {
    0.999 * degrees.to_radians().cos()
}

/// Lines about what is not as it should be.
fn faults(subjects: &[Subject], rows: usize) -> String {
    let (mut wrong, mut functions) = (String::new(), 0);
    println!(
        "{:<34} {:>8} {:>8} | {:>8} {:>8} | {:>8}",
        "relative error", "straight", "device", "turned", "device", "left"
    );
    for subject in subjects {
        let errors = [false, true].map(|turned| {
            let step = |step: usize| stratified(2 * step + usize::from(turned), turned, 1e-3);
            let mut all: Vec<Json> = (0..rows / 2).map(step).collect();
            all.extend(hard(&[1e-3, 0.01, 0.1, 0.5, 1.0], turned));
            subject.errors(&all, turned)
        });
        functions += 1;
        let name = format!("{} {}", subject.name, subject.function);
        let [[a, b], [c, d]] = &errors;
        let left = errors.iter().flatten().map(|w| w.left).fold(0.0, f64::max);
        println!(
            "{name:<34} {:>8.1e} {:>8.1e} | {:>8.1e} {:>8.1e} | {left:>8.1e}",
            a.error, b.error, c.error, d.error
        );
        let worst = errors.iter().flatten().max_by(|a, b| a.beyond.total_cmp(&b.beyond)).unwrap();
        match EXCEPTIONS.iter().find(|(of, ..)| *of == name) {
            None if worst.beyond > 0.0 => wrong += &format!("{name}: {:.1e}, {}\n", worst.beyond, worst.at),
            Some((_, most, why)) if worst.beyond == 0.0 => {
                wrong += &format!("{name}: is better than the bound, not {most:e} because {why}\n")
            }
            Some((_, most, _)) if worst.beyond > *most => {
                wrong += &format!("{name}: {:.1e} and not {most:e}, {}\n", worst.beyond, worst.at)
            }
            Some((_, most, _)) if worst.beyond < most / 4.0 => {
                wrong += &format!("{name}: {:.1e}, far better than {most:e}\n", worst.beyond)
            }
            _ => {}
        }
    }
    println!("{functions} functions");
    wrong
}

/// Catches a formula that cancels, a wrong constant or exponent, an approximation that is said to be exact; and an exception that is no longer needed,
/// or needed less than it says.
#[test]
fn modules_are_as_accurate_as_they_say() {
    let subjects = subjects(catalog(), &CATEGORIES);
    assert!(subjects.len() >= 50, "only {} functions have truths", subjects.len());
    let unknown = EXCEPTIONS
        .iter()
        .find(|(of, ..)| !subjects.iter().any(|s| format!("{} {}", s.name, s.function) == *of));
    assert!(unknown.is_none(), "{unknown:?}");
    let wrong = faults(&subjects, ROWS);
    assert!(wrong.is_empty(), "{wrong}");
}

/// Catches a measure that lets anything pass: GGX with the denominator that cancels, Beckmann with an exponent that is a thousandth too large, and a
/// half vector that is off by 1e-4.
#[test]
fn planted_errors_are_found() {
    let folder = tempfile::tempdir().unwrap();
    for (name, from, to) in [
        (
            "ndf/ggx",
            "along * along + sine_square(s.normal, h)",
            "cosine * cosine * (s.alpha * s.alpha - 1.0) + 1.0",
        ),
        ("ndf/beckmann", "exp(-0.5 * slope2)", "exp(-0.5005 * slope2)"),
        (
            "brdf/microfacet",
            "let h = unit_or(v + l, s.normal);\n    let facets = distribution",
            "let h = unit_or(v + l + 1e-4, s.normal);\n    let facets = distribution",
        ),
    ] {
        let file = format!("{name}/{}.wgsl", name.split_once('/').unwrap().1);
        let text = Library::read(&*library(), &file).unwrap().unwrap();
        assert!(text.contains(from), "{name} has another text");
        std::fs::create_dir_all(folder.path().join(name)).unwrap();
        std::fs::write(folder.path().join(file), text.replace(from, to)).unwrap();
        let manifest = format!("{name}/module.ron");
        std::fs::write(
            folder.path().join(&manifest),
            Library::read(&*library(), &manifest).unwrap().unwrap(),
        )
        .unwrap();
    }
    let catalog = Catalog::load(Arc::new(Overlay(vec![Arc::new(Folder::new(folder.path())), library()]))).unwrap();
    let mut planted = subjects(&catalog, &["ndf", "brdf"]);
    planted.retain(|s| matches!(&*s.name, "ndf/ggx" | "ndf/beckmann" | "brdf/microfacet") && !s.function.ends_with("pdf"));
    let wrong = faults(&planted, 1000);
    for subject in &planted {
        assert!(wrong.contains(&format!("{} {}: ", subject.name, subject.function)), "{wrong}");
    }
}

/// Catches NaN, infinity and what is negative where no bound holds any more: smaller widths, directions in the horizon and below, opposite ones.
#[test]
fn everything_is_finite_and_not_negative() {
    let mut wrong = String::new();
    for subject in subjects(catalog(), &CATEGORIES) {
        let mut rows: Vec<Json> = (0..ROWS).map(|step| stratified(step, step % 2 == 1, 1e-4)).collect();
        for turned in [false, true] {
            rows.extend(hard(&[1e-4, 1e-3, 1.0], turned));
            for (step, v) in [0.0, 45.0, 89.99, 90.0, 91.0, 180.0_f64].iter().enumerate() {
                for l in [0.0, 45.0, 89.99, 90.0, 90.01, 135.0, 180.0_f64] {
                    for phi in [0.0, 180.0_f64] {
                        let to = [direction(v.to_radians(), 0.0), direction(l.to_radians(), phi.to_radians())];
                        rows.push(row(
                            &place(step, turned),
                            1e-4,
                            [1e-4, 1.0],
                            step,
                            [to[0], to[1], to[1]],
                            l.to_radians().cos(),
                        ));
                    }
                }
            }
        }
        let rows = subject.table(&rows);
        for (results, on) in subject.results(&rows).iter().zip(["evaluator", "device"]) {
            if let Some((row, got)) = rows
                .iter()
                .zip(results)
                .find(|(_, got)| !got.iter().all(|x| x.is_finite() && *x >= 0.0))
            {
                wrong += &format!("{} {} on the {on}: {got:?} at {row}\n", subject.name, subject.function);
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
