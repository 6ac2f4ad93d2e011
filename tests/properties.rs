//! What the manifests of BRDFs and of their diffuse parts claim, checked on the device over stratified and hard directions; and what none
//! of them may do.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::f64::consts::TAU;
use std::sync::Arc;

use common::{catalog, gpu};
use glam::DVec3;
use serde_json::{Value as Json, json};
use shadewright::compiler::{Catalog, Recipe};
use shadewright::modules::oracles::quadrature::direction;
use shadewright::modules::{Folder, Overlay, library};
use shadewright::runtime::gpu::pipeline::Pipelines;
use shadewright::runtime::probe::Probe;

/// Stratified pairs of directions; the hard ones come on top.
const PAIRS: usize = 10_000;
/// Directions drawn for an albedo.
const DRAWN: usize = 2048;
const ALPHAS: [f64; 5] = [1e-3, 0.01, 0.1, 0.5, 1.0];
/// Degrees to the normal, up to the horizon.
const ANGLES: [f64; 9] = [0.0, 0.01, 1.0, 20.0, 45.0, 70.0, 85.0, 89.0, 89.99];

/// A stratified number for each step: multiples of an irrational fill the unit interval evenly.
fn fraction(step: usize, by: f64) -> f64 {
    (step as f64 * by + 0.5).fract()
}

/// Pairs of directions above the surface, as a device gets them.
fn pairs() -> Vec<(DVec3, DVec3)> {
    let single = |d: DVec3| d.as_vec3().as_dvec3();
    let upper = |step: usize, a: f64, b: f64| direction(f64::acos(1.0 - fraction(step, a)), TAU * fraction(step, b));
    let mut found: Vec<(DVec3, DVec3)> = (0..PAIRS)
        .map(|step| (upper(step, 0.819_172_513, 0.671_043_607), upper(step, 0.549_700_478, 0.450_299_522)))
        .collect();
    for v in ANGLES {
        for l in ANGLES {
            for phi in [0.0, 40.0, 180.0_f64] {
                found.push((direction(v.to_radians(), 0.0), direction(l.to_radians(), phi.to_radians())));
            }
        }
    }
    found.into_iter().map(|(v, l)| (single(v), single(l))).collect()
}

/// A module under test.
struct Subject<'a> {
    catalog: &'a Catalog,
    name: &'a str,
    function: &'a str,
}

impl Subject<'_> {
    fn values(&self, function: &str, rows: &[Json]) -> Vec<Vec<f64>> {
        let recipe = Recipe::parse("test", self.name).unwrap();
        let probe = Probe::new(self.catalog, &recipe, function).unwrap_or_else(|error| panic!("{}: {error}", self.name));
        let table = probe.table(rows).unwrap_or_else(|error| panic!("{}: {error}", self.name));
        probe.on_gpu(&Pipelines::new(&gpu(), None), &gpu(), &table).unwrap()
    }

    /// The function over pairs of directions; the surface changes from pair to pair.
    fn over(&self, pairs: &[(DVec3, DVec3)]) -> Vec<Vec<f64>> {
        let row = |(step, (v, l)): (usize, &(DVec3, DVec3))| json!({"s": surface(ALPHAS[step % ALPHAS.len()]), "v": v.to_array(), "l": l.to_array()});
        let rows: Vec<Json> = pairs.iter().enumerate().map(row).collect();
        self.values(self.function, &rows)
    }

    /// Albedo toward an eye of a white surface, whose white is shared between facets and what is below them, and its standard error; by what
    /// the module draws, or by the cosine.
    fn albedo(&self, f0: f64, alpha: f64, degrees: f64) -> (f64, f64) {
        let eye = direction(degrees.to_radians(), 0.3);
        let s = json!({
            "alpha": alpha, "widths": [alpha, alpha], "f0": [f0, f0, f0], "diffuse": [1.0 - f0, 1.0 - f0, 1.0 - f0], "diffuse_roughness": alpha.sqrt(),
        });
        // A diffuse part has no sampler.
        let is_whole = self.function == "brdf";
        let numbers = |step: usize| [fraction(step, 0.754_877_666), fraction(step, 0.569_840_291)];
        let drawn: Vec<Vec<f64>> = if is_whole {
            let rows: Vec<Json> = (0..DRAWN)
                .map(|step| json!({"s": s, "v": eye.to_array(), "u": numbers(step)}))
                .collect();
            self.values("brdf_sample", &rows)
        } else {
            let cosine = |[a, b]: [f64; 2]| direction(a.sqrt().asin(), TAU * b).to_array().to_vec();
            (0..DRAWN).map(|step| cosine(numbers(step))).collect()
        };
        let rows: Vec<Json> = drawn.iter().map(|l| json!({"s": s, "v": eye.to_array(), "l": l})).collect();
        let values = self.values(self.function, &rows);
        let densities: Vec<f64> = if is_whole {
            self.values("brdf_pdf", &rows).into_iter().map(|p| p[0]).collect()
        } else {
            drawn.iter().map(|l| l[2] / std::f64::consts::PI).collect()
        };
        let weight = |((l, f), p): ((&Vec<f64>, &Vec<f64>), &f64)| if l[2] > 0.0 && *p > 0.0 { f[0] * l[2] / p } else { 0.0 };
        let weights: Vec<f64> = drawn.iter().zip(&values).zip(&densities).map(weight).collect();
        let mean = weights.iter().sum::<f64>() / DRAWN as f64;
        let variance = weights.iter().map(|w| (w - mean).powi(2)).sum::<f64>() / DRAWN as f64;
        (mean, (variance / DRAWN as f64).sqrt())
    }

    /// What is claimed and does not hold, and what must hold of all.
    fn broken(&self, claims: &[String], pairs: &[(DVec3, DVec3)]) -> Vec<String> {
        let claimed = |claim: &str| claims.iter().any(|c| c == claim);
        let mut broken = Vec::new();
        let values = self.over(pairs);
        let mut differ = |other: &[Vec<f64>], what: &str, tolerance: f64| {
            let mut most = (0.0, 0);
            for (at, (a, b)) in values.iter().zip(other).enumerate() {
                for (a, b) in a.iter().zip(b) {
                    let error = (a - b).abs() / a.abs().max(b.abs()).max(1e-9);
                    if error > most.0 {
                        most = (error, at);
                    }
                }
            }
            if most.0 > tolerance {
                broken.push(format!("{} is not {what}: {:e} at {:?}", self.name, most.0, pairs[most.1]));
            }
            println!("{:<28} {what:<20} {:.1e}", self.name, most.0);
        };
        if claimed("reciprocal") {
            let swapped: Vec<_> = pairs.iter().map(|(v, l)| (*l, *v)).collect();
            differ(&self.over(&swapped), "reciprocal", 1e-5);
        }
        if claimed("isotropic") {
            // A quarter turn exchanges components and rounds nothing.
            let quarter = |d: DVec3| DVec3::new(-d.y, d.x, d.z);
            let turned: Vec<_> = pairs.iter().map(|(v, l)| (quarter(*v), quarter(*l))).collect();
            differ(&self.over(&turned), "isotropic", 1e-5);
        }
        for (value, pair) in values.iter().zip(pairs) {
            if value.iter().any(|x| !(x.is_finite() && *x >= 0.0)) {
                broken.push(format!("{} is {value:?} at {pair:?}", self.name));
                break;
            }
        }
        if claimed("energy_conserving") {
            let mut most = 0.0_f64;
            for (f0, alpha) in [0.0, 0.5, 1.0].into_iter().flat_map(|f0| [0.05, 0.3, 1.0].map(|alpha| (f0, alpha))) {
                for degrees in [0.0, 30.0, 60.0, 80.0, 89.0] {
                    let (albedo, error) = self.albedo(f0, alpha, degrees);
                    most = most.max(albedo);
                    if albedo > 1.001 + 4.0 * error {
                        broken.push(format!(
                            "{} reflects {albedo} +- {error} at f0 {f0}, alpha {alpha}, {degrees} degrees",
                            self.name
                        ));
                    }
                }
            }
            println!("{:<28} {:<20} {most:.3}", self.name, "largest albedo");
        }
        broken
    }
}

fn surface(alpha: f64) -> Json {
    json!({
        "alpha": alpha, "widths": [alpha, alpha], "f0": [0.04, 0.5, 1.0], "diffuse": [1.0, 0.5, 0.0], "diffuse_roughness": alpha.sqrt(),
        "coat_alpha": alpha, "coat_color": [0.9, 0.5, 0.1], "fuzz_roughness": alpha.sqrt(),
    })
}

/// Catches a claim that does not hold, a BRDF that is negative or not finite.
#[test]
fn claimed_properties_hold() {
    let pairs = pairs();
    let mut broken = Vec::new();
    let mut checked = 0;
    for module in catalog().modules().filter(|m| matches!(m.category.as_str(), "brdf" | "diffuse")) {
        let subject = Subject {
            catalog: catalog(),
            name: &format!("{}/{}", module.category, module.name),
            function: &module.category,
        };
        checked += 1;
        broken.extend(subject.broken(&module.manifest.properties, &pairs));
    }
    assert!(checked >= 3 && broken.is_empty(), "{checked} {broken:#?}");
}

/// Catches checks that let anything pass: each claim is made by a module that does not keep it.
#[test]
fn false_claims_fail() {
    let folder = tempfile::tempdir().unwrap();
    let module = |name: &str, claim: &str, value: &str| {
        let path = folder.path().join("brdf").join(name);
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(
            path.join("module.ron"),
            format!("(summary: \"planted\", uses: [\"math\"], properties: [{claim:?}])"),
        )
        .unwrap();
        let text = format!("fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {{\n    return vec3f({value});\n}}\n");
        std::fs::write(path.join(format!("{name}.wgsl")), text).unwrap();
    };
    module("lopsided", "reciprocal", "INV_PI * (1.0 + 1e-4 * dot(s.normal, v))");
    module("brushed", "isotropic", "INV_PI * (1.0 + 1e-3 * l.x * l.x)");
    module("bright", "energy_conserving", "INV_PI * 1.01");
    module("dark", "reciprocal", "-1e-6");
    let catalog = Catalog::load(Arc::new(Overlay(vec![Arc::new(Folder::new(folder.path())), library()]))).unwrap();
    let pairs = pairs();
    for (name, what) in [
        ("lopsided", "not reciprocal"),
        ("brushed", "not isotropic"),
        ("bright", "reflects 1.0"),
        ("dark", "is [-"),
    ] {
        let claims = &catalog.module(name).unwrap().manifest.properties;
        let subject = Subject {
            catalog: &catalog,
            name,
            function: "brdf",
        };
        let broken = subject.broken(claims, &pairs);
        assert!(broken.iter().any(|line| line.contains(what)), "{name}: {broken:?}");
    }
}
