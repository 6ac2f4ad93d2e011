//! White facets in white light: what several facets hand on is not lost. And tables that the project computes are what their programs compute.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::f64::consts::{PI, TAU};

use common::{catalog, gpu};
use serde_json::{Value as Json, json};
use shadewright::compiler::Recipe;
use shadewright::modules::oracles::quadrature::direction;
use shadewright::modules::oracles::tables;
use shadewright::runtime::gpu::pipeline::Pipelines;
use shadewright::runtime::probe::Probe;

/// Directions drawn by the module, and as many by the cosine.
const DRAWN: usize = 512;
/// The same for smooth surfaces, whose lobe is narrow and wide at once.
const DRAWN_FOR_SMOOTH: usize = 4096;

/// Tables that take most of a minute: some of their rows are compared where their fits are tested.
const SLOW: [&str; 1] = ["highlight/ltc-anisotropic"];

/// Catches a table in the repository that is not what its `table.rs` computes, down to the last bit, and a program without a table.
#[test]
fn tables_are_what_their_programs_compute() {
    let mut compared = 0;
    for (folder, resource, make) in tables().filter(|(folder, ..)| !SLOW.contains(folder)) {
        let module = catalog().module(folder).unwrap();
        let bytes: Vec<u8> = make().iter().flat_map(|number| number.to_le_bytes()).collect();
        let kept = &module.data[resource];
        assert!(
            **kept == bytes[..],
            "{folder}: `shadewright table {folder} {resource} --make` gives another file than the one kept"
        );
        compared += 1;
    }
    assert!(compared > 0);
}

/// A probe of the device.
struct Device {
    pipelines: Pipelines,
}

impl Device {
    fn values(&self, recipe: &str, function: &str, rows: &[Json]) -> Vec<Vec<f64>> {
        let probe =
            Probe::new(catalog(), &Recipe::parse("test", recipe).unwrap(), function).unwrap_or_else(|error| panic!("{recipe}: {error}"));
        let table = probe.table(rows).unwrap();
        probe.on_gpu(&self.pipelines, &gpu(), &table).unwrap()
    }

    /// Albedo of white facets toward an eye at an angle, for each alpha and angle, and its standard error. Half of the directions are the
    /// module's, half the cosine's, each weighted by both densities (Veach and Guibas 1995).
    fn furnace(&self, recipe: &str, alphas: &[f64], degrees: &[f64], count: usize) -> Vec<(f64, f64, f64, f64)> {
        let configurations: Vec<(f64, f64)> = alphas.iter().flat_map(|a| degrees.iter().map(|d| (*a, *d))).collect();
        let at = |(alpha, degrees): (f64, f64), more: Json| {
            let mut row = json!({
                "s": {"alpha": alpha, "widths": [alpha, alpha], "f0": [1, 1, 1], "diffuse": [0, 0, 0]},
                "v": direction(degrees.to_radians(), 0.3).to_array(),
            });
            row.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
            row
        };
        let u = |i: usize| [(0.5 + 0.754_877_666 * i as f64).fract(), (0.5 + 0.569_840_291 * i as f64).fract()];
        let draws: Vec<Json> = configurations
            .iter()
            .flat_map(|c| (0..count).map(|i| at(*c, json!({"u": u(i)}))))
            .collect();
        let drawn = self.values(recipe, "brdf_sample", &draws);
        let mut rows = Vec::new();
        for (index, c) in configurations.iter().enumerate() {
            for i in 0..count {
                rows.push(at(*c, json!({"l": drawn[index * count + i]})));
                let [a, b] = u(i);
                rows.push(at(*c, json!({"l": direction(a.sqrt().asin(), TAU * b).to_array()})));
            }
        }
        let values = self.values(recipe, "brdf", &rows);
        let densities = self.values(recipe, "brdf_pdf", &rows);
        let weights: Vec<f64> = rows
            .iter()
            .zip(values.iter().zip(&densities))
            .map(|(row, (value, density))| {
                let cosine = row["l"][2].as_f64().unwrap();
                if cosine > 0.0 {
                    value[0] * cosine / (0.5 * density[0] + 0.5 * cosine / PI)
                } else {
                    0.0
                }
            })
            .collect();
        let found = configurations.iter().zip(weights.chunks(2 * count));
        found
            .map(|((alpha, degrees), weights)| {
                let mean = weights.iter().sum::<f64>() / weights.len() as f64;
                let variance = weights.iter().map(|w| (w - mean).powi(2)).sum::<f64>() / weights.len() as f64;
                (*alpha, *degrees, mean, (variance / weights.len() as f64).sqrt())
            })
            .collect()
    }
}

const SMOOTH: f64 = 0.01;
const ALPHAS: [f64; 5] = [0.03, 0.1, 0.3, 0.6, 1.0];
const ANGLES: [f64; 7] = [0.0, 30.0, 60.0, 80.0, 85.0, 89.0, 89.9];

fn compensated(by: &str) -> String {
    format!("(module: \"microfacet\", fill: {{\"compensation\": {by}, \"diffuse\": \"lambertian\"}})")
}

/// Catches a lobe that is too weak or too strong, a table read at the wrong place, and a surface that is not compensated at all, which
/// loses 59 % at alpha 1.
#[test]
fn white_facets_lose_nothing() {
    let device = Device {
        pipelines: Pipelines::new(&gpu(), None),
    };
    let mut wrong = Vec::new();
    for by in ["\"kulla-conty\"", "\"turquin\""] {
        let mut most = (0.0, 0.0, 0.0, 0.0);
        let mut found = device.furnace(&compensated(by), &ALPHAS, &ANGLES, DRAWN);
        found.extend(device.furnace(&compensated(by), &[SMOOTH], &ANGLES, DRAWN_FOR_SMOOTH));
        for (alpha, degrees, albedo, error) in found {
            let off = (albedo - 1.0).abs();
            if off > most.0 {
                most = (off, alpha, degrees, error);
            }
            if off > 0.01 {
                wrong.push(format!(
                    "{by}: {albedo:.4} at alpha {alpha}, {degrees} degrees, standard error {error:.0e}"
                ));
            }
        }
        println!(
            "{by:<16} {:.4} from 1 at alpha {}, {} degrees, standard error {:.0e}",
            most.0, most.1, most.2, most.3
        );
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let bare = device.furnace("\"microfacet\"", &[1.0], &[0.0], DRAWN);
    assert!((bare[0].2 - (1.0 - 2_f64.ln())).abs() < 0.01, "{bare:?}");
}

/// Catches facets of one distribution compensated by the albedo of another that nobody notices: what it costs is printed, and what is said in
/// the modules' READMEs holds.
#[test]
fn other_facets_want_their_own_albedo() {
    let device = Device {
        pipelines: Pipelines::new(&gpu(), None),
    };
    let beckmann = |albedo: &str| {
        format!(
            "(module: \"microfacet\", fill: {{\"ndf\": \"beckmann\", \"masking\": \"smith-beckmann\", \"compensation\": (module: \"kulla-conty\", fill: {{\"albedo\": {albedo}}})}})"
        )
    };
    let most = |recipe: &str| {
        let found = device.furnace(recipe, &[0.03, 0.3, 1.0], &[0.0, 60.0, 85.0], DRAWN);
        found.into_iter().map(|(_, _, albedo, _)| (albedo - 1.0).abs()).fold(0.0, f64::max)
    };
    let borrowed = most(&beckmann("\"albedo/tabulated\""));
    let own = most(&beckmann(
        "(module: \"integrated\", fill: {\"ndf\": \"beckmann\", \"masking\": \"smith-beckmann\"}, freeze: {\"samples\": 1024})",
    ));
    println!("beckmann with the albedo of ggx {borrowed:.3}, with its own {own:.4}");
    assert!(own < 0.015 && borrowed > 0.25, "{borrowed} {own}");
}

/// Catches a lobe that is not the same both ways, to the fifth digit.
#[test]
fn the_lobe_beside_is_reciprocal() {
    let device = Device {
        pipelines: Pipelines::new(&gpu(), None),
    };
    let mut there = Vec::new();
    let mut back = Vec::new();
    for i in 0..4096_usize {
        let part = |by: f64| (0.5 + by * i as f64).fract();
        let v = direction((1.0 - part(0.819_172_513)).acos(), TAU * part(0.671_043_607));
        let l = direction((1.0 - part(0.549_700_478)).acos(), TAU * part(0.450_299_522));
        let s = json!({"alpha": ALPHAS[i % ALPHAS.len()], "f0": [0.04, 0.5, 1.0], "diffuse": [0, 0, 0]});
        there.push(json!({"s": s, "v": v.to_array(), "l": l.to_array()}));
        back.push(json!({"s": s, "v": l.to_array(), "l": v.to_array()}));
    }
    let recipe = compensated("\"kulla-conty\"");
    let (there, back) = (device.values(&recipe, "brdf", &there), device.values(&recipe, "brdf", &back));
    let differences = there.iter().flatten().zip(back.iter().flatten());
    let most = differences.map(|(a, b)| (a - b).abs() / a.max(*b).max(1e-9)).fold(0.0, f64::max);
    println!("reciprocal to {most:.1e}");
    assert!(most < 1e-5, "{most}");
}
