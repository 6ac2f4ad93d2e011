//! What is drawn has the density that is said: chi-square tests of every module that draws directions, on the device.
//!
//! As pbrt and Mitsuba do it: directions are counted in bins, and held against the integral of the density over each bin. The bins are finer
//! toward the direction around which a narrow lobe lies (the mirrored eye; of facets the normal): cos = 1 - 2 t^2 for t in [0, 1].

#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;

use std::f64::consts::TAU;

use common::{catalog, gpu};
use glam::{DMat3, DVec3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use serde_json::{Value as Json, json};
use shadewright::compiler::{Catalog, Recipe};
use shadewright::runtime::gpu::pipeline::Pipelines;
use shadewright::runtime::probe::Probe;

/// Directions drawn for a test.
const SAMPLES: usize = 30_000;
/// Bins of t and around z.
const BINS: [usize; 2] = [32, 32];
/// Strata of a bin's integral in each direction, with a random point in each: the integral has an error, which is known.
const POINTS: usize = 5;
/// Probability by which all tests together may fail a correct module.
const SIGNIFICANCE: f64 = 0.01;

fn values(catalog: &Catalog, recipe: &str, function: &str, rows: &[Json]) -> Vec<Vec<f64>> {
    let probe = Probe::new(catalog, &Recipe::parse("test", recipe).unwrap(), function).unwrap_or_else(|error| panic!("{recipe}: {error}"));
    let table = probe.table(rows).unwrap_or_else(|error| panic!("{recipe}: {error}"));
    probe.on_gpu(&Pipelines::new(&gpu(), None), &gpu(), &table).unwrap()
}

fn direction(cosine: f64, turn: f64) -> [f64; 3] {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    [sine * turn.cos(), sine * turn.sin(), cosine]
}

/// The bin of a direction in a frame around z; none for what is no direction.
fn bin(d: DVec3) -> Option<usize> {
    let length = d.length();
    assert!(length.is_finite(), "{d:?}");
    if length < 0.5 {
        return None;
    }
    assert!((length - 1.0).abs() < 1e-4, "not of unit length: {d:?}");
    // From the sine near the pole, where the cosine has few digits.
    let t = (d.x.hypot(d.y).atan2(d.z) / 2.0).sin();
    let turn = (d.y.atan2(d.x).rem_euclid(TAU) / TAU * BINS[1] as f64) as usize;
    let ring = (t * BINS[0] as f64) as usize;
    Some(ring.min(BINS[0] - 1) * BINS[1] + turn.min(BINS[1] - 1))
}

/// A module's function that draws and the one that says the density, for one surface and eye.
struct Sampler<'a> {
    catalog: &'a Catalog,
    recipe: &'a str,
    sample: &'a str,
    pdf: &'a str,
    /// Name of the drawn direction among the density's arguments.
    drawn: &'a str,
    surface: Json,
    eye: [f64; 3],
}

impl Sampler<'_> {
    fn row(&self, name: &str, value: Json) -> Json {
        let mut row = json!({"s": self.surface, "v": self.eye});
        row[name] = value;
        row
    }

    /// Columns of a frame around where narrow lobes lie.
    fn frame(&self) -> DMat3 {
        let [x, y, z] = self.eye;
        let pole = if self.drawn == "l" { DVec3::new(-x, -y, z) } else { DVec3::Z };
        let (a, b) = pole.any_orthonormal_pair();
        DMat3::from_cols(a, b, pole)
    }

    /// Share of the directions in each bin; what the density says, and the variance of that. The last bin is of what is no direction.
    fn shares(&self, samples: usize) -> (Vec<f64>, Vec<(f64, f64)>) {
        let frame = self.frame();
        let mut random = Pcg64::new(7, 11);
        let mut unit = || (random.next_u64() >> 40) as f64 / (1u64 << 24) as f64;
        let rows: Vec<Json> = (0..samples).map(|_| self.row("u", json!([unit(), unit()]))).collect();
        let mut found = vec![0.0; BINS[0] * BINS[1] + 1];
        for drawn in values(self.catalog, self.recipe, self.sample, &rows) {
            let drawn = frame.transpose() * DVec3::new(drawn[0], drawn[1], drawn[2]);
            let at = bin(drawn).unwrap_or(BINS[0] * BINS[1]);
            found[at] += 1.0 / samples as f64;
        }
        let (mut rows, mut areas) = (Vec::new(), Vec::new());
        for cosine in 0..BINS[0] * POINTS {
            for turn in 0..BINS[1] * POINTS {
                let t = (cosine as f64 + unit()) / (BINS[0] * POINTS) as f64;
                let turn = (turn as f64 + unit()) / (BINS[1] * POINTS) as f64 * TAU;
                rows.push(self.row(
                    self.drawn,
                    json!((frame * DVec3::from(direction(1.0 - 2.0 * t * t, turn))).to_array()),
                ));
                areas.push(4.0 * t * TAU / (BINS[0] * BINS[1]) as f64);
            }
        }
        let mut moments = vec![[0.0; 2]; BINS[0] * BINS[1]];
        for (at, density) in values(self.catalog, self.recipe, self.pdf, &rows).iter().enumerate() {
            assert!(density[0] >= 0.0 && density[0].is_finite(), "{density:?} at {}", rows[at]);
            let (cosine, turn) = (at / (BINS[1] * POINTS) / POINTS, at % (BINS[1] * POINTS) / POINTS);
            let share = density[0] * areas[at];
            let moments = &mut moments[cosine * BINS[1] + turn];
            *moments = [moments[0] + share, moments[1] + share * share];
        }
        let count = (POINTS * POINTS) as f64;
        let estimate = |[sum, squares]: &[f64; 2]| {
            let mean = sum / count;
            // Strata only make it smaller.
            (mean, (squares / count - mean * mean).max(0.0) / (count - 1.0))
        };
        let mut expected: Vec<(f64, f64)> = moments.iter().map(estimate).collect();
        let total: f64 = expected.iter().map(|e| e.0).sum();
        let error = expected.iter().map(|e| e.1).sum::<f64>().sqrt();
        assert!(
            total < 1.001 + 5.0 * error,
            "the density of {} integrates to {total} +- {error}",
            self.recipe
        );
        expected.push(((1.0 - total).max(0.0), error * error));
        (found, expected)
    }

    /// Probability that a correct module is as far off as this one.
    fn p_value(&self, samples: usize) -> f64 {
        let (found, expected) = self.shares(samples);
        let n = samples as f64;
        // Bins with few expected directions go together. What is not known of a bin's integral counts for less.
        let (mut statistic, mut degrees) = (0.0, -1.0);
        let mut pooled = [0.0; 3];
        for (found, (expected, variance)) in found.iter().zip(&expected) {
            if expected * n < 5.0 {
                pooled = [pooled[0] + found, pooled[1] + expected, pooled[2] + variance];
            } else {
                statistic += (found - expected).powi(2) / (expected / n + variance);
                degrees += 1.0;
            }
        }
        let [found, expected, variance] = pooled;
        if found.max(expected) * n >= 5.0 {
            statistic += (found - expected).powi(2) / (expected.max(5.0 / n) / n + variance);
            degrees += 1.0;
        }
        chi_square(statistic, f64::max(degrees, 1.0))
    }
}

/// Probability that a chi-square variable is at least this large: by the cube root, which is nearly normal (Wilson and Hilferty 1931).
fn chi_square(statistic: f64, degrees: f64) -> f64 {
    let spread = 2.0 / (9.0 * degrees);
    let z = ((statistic / degrees).cbrt() - (1.0 - spread)) / spread.sqrt();
    // Abramowitz and Stegun 7.1.26 for the complementary error function: 1.5e-7.
    let x = z.abs() / 2f64.sqrt();
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let poly = t * (0.254_829_592 + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    let upper = 0.5 * poly * (-x * x).exp();
    if z >= 0.0 { upper } else { 1.0 - upper }
}

fn surface(alpha: f64) -> Json {
    json!({"alpha": alpha, "widths": [alpha, alpha * 0.5], "f0": [0.3, 0.5, 0.9], "diffuse": [0.2, 0.3, 0.1], "coat_alpha": alpha, "fuzz_roughness": alpha})
}

fn eyes() -> [[f64; 3]; 3] {
    [0.0, 50.0, 85.0].map(|degrees: f64| direction(degrees.to_radians().cos(), 0.7))
}

/// Catches a density that is not of what is drawn: a Jacobian that is forgotten, a share that is exchanged, an angle of another meaning.
#[test]
fn every_module_draws_what_it_says() {
    let mut tests = Vec::new();
    for module in catalog().modules() {
        let (sample, pdf, drawn) = match module.category.as_str() {
            "brdf" => ("brdf_sample", "brdf_pdf", "l"),
            "ndf" => ("facet_sample", "facet_pdf", "h"),
            _ => continue,
        };
        for (alpha, eye) in [0.2, 0.5, 1.0].into_iter().zip(eyes()) {
            tests.push((format!("{}/{}", module.category, module.name), sample, pdf, drawn, alpha, eye));
        }
    }
    assert!(tests.len() >= 9, "{}", tests.len());
    // Sidak's correction for many tests.
    let level = 1.0 - (1.0 - SIGNIFICANCE).powf(1.0 / tests.len() as f64);
    let mut wrong = Vec::new();
    for (recipe, sample, pdf, drawn, alpha, eye) in &tests {
        let sampler = Sampler {
            catalog: catalog(),
            recipe: &format!("{recipe:?}"),
            sample,
            pdf,
            drawn,
            surface: surface(*alpha),
            eye: *eye,
        };
        let p = sampler.p_value(SAMPLES);
        println!("{recipe}, alpha {alpha}, eye {:.2}: p {p:.4}", eye[2]);
        if p < level {
            wrong.push(format!("{recipe}, alpha {alpha}, eye {eye:?}: p {p:e}, below {level:e}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
