//! What is drawn has the density that is said: a chi-square test, as pbrt and Mitsuba do it.
//!
//! Directions are counted in bins, and held against the integral of the density over each bin. The bins are finer toward the direction
//! around which a narrow lobe lies (the mirrored eye; of facets the normal): cos = 1 - 2 t^2 for t in [0, 1].

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};
use serde_json::{Value as Json, json};
use shadewright_compiler::Module;
use shadewright_compiler::manifest::Node;
use shadewright_modules::oracles::quadrature::direction;

use super::bench::{Bench, Rows, surface};
use super::format::Draws;
use super::{Proof, Property};
use crate::measure::{MeasureError, Random};

/// Bins of t and around z.
const BINS: [usize; 2] = [32, 32];
/// Bins in each direction that are one in the coarse test.
const MERGED: usize = 4;
/// Strata of a bin's integral in each direction, with a random point in each: the integral has an error, which is known. With 8 a corner that a
/// density only just reaches is missed, which a million samples show.
const POINTS: usize = 16;
/// The same where the density changes much in a bin.
const MORE_POINTS: usize = 48;
/// How large the variance of a bin's integral may be beside that of its count, before more points are taken.
const VARIANCE: f64 = 0.05;
/// Probability by which all tests together may fail a correct library.
pub const SIGNIFICANCE: f64 = 0.01;
/// Alpha and the eye's degrees to the normal.
const SETTINGS: [(f64, f64); 3] = [(0.2, 0.0), (0.5, 50.0), (1.0, 85.0)];
/// Directions whose weight is looked at, for each setting.
const WEIGHED: usize = 20_000;

/// A surface and an eye.
struct Setting {
    surface: Json,
    eye: DVec3,
    text: String,
}

fn settings() -> Vec<Setting> {
    let setting = |(alpha, angle): (f64, f64)| Setting {
        surface: surface(alpha, [alpha, 0.5 * alpha], [0.3, 0.5, 0.9], [0.2, 0.3, 0.1]),
        eye: direction(angle.to_radians(), 0.7),
        text: format!("alpha {alpha}, v {angle}°"),
    };
    SETTINGS.map(setting).into()
}

/// How many tests a module takes: with many bins and with few, of each setting.
pub const TESTS: usize = 2 * SETTINGS.len();

/// The probability below which one of so many tests fails (Sidak 1967).
pub fn level(tests: usize) -> f64 {
    1.0 - (1.0 - SIGNIFICANCE).powf(1.0 / tests.max(1) as f64)
}

/// Functions that draw, of a recipe.
pub(super) struct Sampler<'a> {
    pub bench: &'a Bench<'a>,
    pub node: &'a Node,
    pub draws: &'a Draws,
    /// Whether narrow lobes lie around the mirrored eye; else around the normal.
    pub mirrors: bool,
}

/// The bin of a direction in a frame around z; the last for what is no direction, none for what is not even that.
fn bin(d: DVec3) -> Option<usize> {
    let length = d.length();
    if length < 0.5 {
        return Some(BINS[0] * BINS[1]);
    }
    if !length.is_finite() || (length - 1.0).abs() > 1e-4 {
        return None;
    }
    // From the sine near the pole, where the cosine has few digits.
    let t = (d.x.hypot(d.y).atan2(d.z) / 2.0).sin();
    let turn = (d.y.atan2(d.x).rem_euclid(TAU) / TAU * BINS[1] as f64) as usize;
    let ring = (t * BINS[0] as f64) as usize;
    Some(ring.min(BINS[0] - 1) * BINS[1] + turn.min(BINS[1] - 1))
}

/// Mean and the variance of that mean.
#[derive(Clone, Copy, Debug, Default)]
struct Estimate {
    mean: f64,
    variance: f64,
}

impl std::ops::Add for Estimate {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            mean: self.mean + other.mean,
            variance: self.variance + other.variance,
        }
    }
}

impl Sampler<'_> {
    fn rows(&self, setting: &Setting) -> Rows {
        Rows::new(&setting.surface).sharing("v", json!(setting.eye.to_array()))
    }

    fn drawn(&self, setting: &Setting, count: usize, random: &mut Random) -> Result<Vec<DVec3>, MeasureError> {
        let numbers: Vec<[f32; 2]> = (0..count).map(|_| [random.single(), random.single()]).collect();
        self.bench
            .vectors(self.node, &self.draws.sample, &self.rows(setting).pairs("u", &numbers))
    }

    fn densities(&self, setting: &Setting, directions: &[DVec3]) -> Result<Vec<f64>, MeasureError> {
        let rows = self.rows(setting).vectors(&self.draws.drawn, directions.iter().copied());
        self.bench.numbers(self.node, &self.draws.density, &rows)
    }

    /// Columns of a frame around where narrow lobes lie.
    fn frame(&self, setting: &Setting) -> DMat3 {
        let pole = if self.mirrors {
            DVec3::new(-setting.eye.x, -setting.eye.y, setting.eye.z)
        } else {
            DVec3::Z
        };
        let (a, b) = pole.any_orthonormal_pair();
        DMat3::from_cols(a, b, pole)
    }

    /// The density's integral over some bins; or where it is none.
    fn integrals(
        &self,
        setting: &Setting,
        bins: &[usize],
        points: usize,
        random: &mut Random,
    ) -> Result<Result<Vec<Estimate>, String>, MeasureError> {
        let frame = self.frame(setting);
        let (mut directions, mut areas) = (Vec::new(), Vec::new());
        for bin in bins {
            for point in 0..points * points {
                let ring = (bin / BINS[1] * points + point / points) as f64 + random.unit();
                let turn = (bin % BINS[1] * points + point % points) as f64 + random.unit();
                let t = ring / (BINS[0] * points) as f64;
                // The angle has the sine 2 t sqrt(1 - t^2), and half of it the sine t.
                directions.push(frame * direction(2.0 * t.asin(), turn / (BINS[1] * points) as f64 * TAU));
                areas.push(4.0 * t * TAU / (BINS[0] * BINS[1]) as f64);
            }
        }
        let mut estimates = Vec::with_capacity(bins.len());
        let densities = self.densities(setting, &directions)?;
        if let Some((d, p)) = directions.iter().zip(&densities).find(|(_, p)| !(p.is_finite() && **p >= 0.0)) {
            return Ok(Err(format!("the density is {p} at {d:?}")));
        }
        let count = (points * points) as f64;
        for (densities, areas) in densities.chunks(points * points).zip(areas.chunks(points * points)) {
            let shares = densities.iter().zip(areas).map(|(density, area)| density * area);
            let (sum, squares) = shares.fold((0.0, 0.0), |(sum, squares), x| (sum + x, squares + x * x));
            let mean = sum / count;
            estimates.push(Estimate {
                mean,
                // Strata only make it smaller.
                variance: (squares / count - mean * mean).max(0.0) / (count - 1.0),
            });
        }
        Ok(Ok(estimates))
    }

    /// Probability that a correct sampler is as far off as this one; 0 with the reason where it cannot be correct.
    fn p_value(&self, setting: &Setting, samples: usize) -> Result<(f64, String), MeasureError> {
        let mut random = Random::new(7, 11);
        let frame = self.frame(setting);
        let n = samples as f64;
        let bins = BINS[0] * BINS[1];
        let mut found = vec![0.0; bins + 1];
        for drawn in self.drawn(setting, samples, &mut random)? {
            match bin(frame.transpose() * drawn) {
                Some(bin) => found[bin] += 1.0,
                None => return Ok((0.0, format!("{drawn:?} is no unit vector"))),
            }
        }
        let all: Vec<usize> = (0..bins).collect();
        let mut expected = match self.integrals(setting, &all, POINTS, &mut random)? {
            Ok(expected) => expected,
            Err(why) => return Ok((0.0, why)),
        };
        let rough = |e: &Estimate| e.variance > VARIANCE * e.mean.max(1.0 / n) / n;
        let again: Vec<usize> = all.into_iter().filter(|&bin| rough(&expected[bin])).collect();
        match self.integrals(setting, &again, MORE_POINTS, &mut random)? {
            Ok(better) => again.iter().zip(better).for_each(|(&bin, better)| expected[bin] = better),
            Err(why) => return Ok((0.0, why)),
        }
        let total: f64 = expected.iter().map(|e| e.mean).sum();
        let variance: f64 = expected.iter().map(|e| e.variance).sum();
        if total > 1.001 + 5.0 * variance.sqrt() {
            return Ok((0.0, format!("the density integrates to {total:.4}")));
        }
        expected.push(Estimate {
            mean: (1.0 - total).max(0.0),
            variance,
        });
        // Errors of a per cent over a wide range drown in many bins, those of a narrow range in few.
        let few = p_value(&merged(&found), &merged(&expected), n);
        Ok((p_value(&found, &expected, n).min(few), String::new()))
    }
}

/// Neighbours taken together; the last, of what is no direction, stays.
fn merged<T: Copy + Default + std::ops::Add<Output = T>>(bins: &[T]) -> Vec<T> {
    let mut few = vec![T::default(); BINS[0] * BINS[1] / (MERGED * MERGED) + 1];
    for (index, value) in bins.iter().enumerate() {
        let (ring, turn) = (index / BINS[1] / MERGED, index % BINS[1] / MERGED);
        let at = (ring * (BINS[1] / MERGED) + turn).min(few.len() - 1);
        few[at] = few[at] + *value;
    }
    few
}

/// Probability of counts that are as far from what is expected as these.
fn p_value(found: &[f64], expected: &[Estimate], n: f64) -> f64 {
    // Bins with few expected directions go together. What is not known of a bin's integral counts for less.
    let (mut statistic, mut degrees) = (0.0, -1.0);
    let mut pooled = [0.0; 3];
    for (found, Estimate { mean, variance }) in found.iter().zip(expected) {
        if mean * n < 5.0 {
            pooled = [pooled[0] + found, pooled[1] + mean, pooled[2] + variance];
        } else {
            statistic += (found - mean * n).powi(2) / (mean * n + variance * n * n);
            degrees += 1.0;
        }
    }
    let [found, mean, variance] = pooled;
    if found.max(mean * n) >= 5.0 {
        statistic += (found - mean * n).powi(2) / ((mean * n).max(5.0) + variance * n * n);
        degrees += 1.0;
    }
    chi_square(statistic, f64::max(degrees, 1.0))
}

/// Probability that a chi-square variable is at least this large: by the cube root, which is nearly normal (Wilson and Hilferty 1931).
fn chi_square(statistic: f64, degrees: f64) -> f64 {
    let spread = 2.0 / (9.0 * degrees);
    let z = ((statistic / degrees).cbrt() - (1.0 - spread)) / spread.sqrt();
    0.5 * libm::erfc(z / 2f64.sqrt())
}

/// The chi-square test's smallest probability. Its bound is that of one test alone: see [`level`].
///
/// # Errors
/// The module cannot be linked, or the device fails.
pub fn prove(bench: &Bench, module: &Module, draws: &Draws, mirrors: bool, samples: usize) -> Result<Proof, MeasureError> {
    let node = Node::new(format!("{}/{}", module.category, module.name));
    let (p, at) = of_recipe(bench, &node, draws, mirrors, samples)?;
    Ok(Proof::new(module, Property::Drawn, p, at, level(TESTS)))
}

/// The same of any recipe, as a probability and where it is.
///
/// # Errors
/// As for [`prove`].
pub(super) fn of_recipe(bench: &Bench, node: &Node, draws: &Draws, mirrors: bool, samples: usize) -> Result<(f64, String), MeasureError> {
    let sampler = Sampler {
        bench,
        node,
        draws,
        mirrors,
    };
    let mut least = (f64::INFINITY, String::new());
    for setting in settings() {
        let (p, why) = sampler.p_value(&setting, samples)?;
        if p < least.0 {
            let why = if why.is_empty() { why } else { format!(": {why}") };
            least = (p, format!("{}{why}", setting.text));
        }
    }
    Ok(least)
}

/// Largest weight f n.l / p of what is drawn.
///
/// # Errors
/// As for [`prove`].
pub fn prove_weight(bench: &Bench, module: &Module, reflectance: &str, draws: &Draws) -> Result<Proof, MeasureError> {
    let node = Node::new(format!("{}/{}", module.category, module.name));
    let sampler = Sampler {
        bench,
        node: &node,
        draws,
        mirrors: true,
    };
    let mut worst = (0.0, String::new());
    for setting in settings() {
        let drawn = sampler.drawn(&setting, WEIGHED, &mut Random::new(7, 12))?;
        let densities = sampler.densities(&setting, &drawn)?;
        let rows = sampler.rows(&setting).vectors("l", drawn.iter().copied());
        let values = bench.values(&node, reflectance, &rows)?;
        for ((l, p), f) in drawn.iter().zip(densities).zip(values) {
            let most = f.iter().copied().fold(0.0, f64::max);
            let weight = most * l.z.max(0.0) / p;
            if most > 0.0 && l.z > 0.0 && (weight > worst.0 || weight.is_nan()) {
                worst = (weight, setting.text.clone());
            }
        }
    }
    Ok(Proof::new(module, Property::Weight, worst.0, worst.1, WEIGHT_OF_ALL))
}

/// A weight that is not said to be bounded must still be finite.
const WEIGHT_OF_ALL: f64 = f64::MAX;

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a tail that is wrong: quantiles of tables (Abramowitz and Stegun 1964, table 26.8).
    #[test]
    fn chi_square_quantiles() {
        for (degrees, statistic, expected) in [
            (10.0, 23.209, 0.01),
            (30.0, 50.892, 0.01),
            (100.0, 118.498, 0.1),
            (100.0, 82.358, 0.9),
        ] {
            let p = chi_square(statistic, degrees);
            assert!((p / expected - 1.0).abs() < 0.02, "{degrees} {statistic}: {p}");
        }
    }

    /// Catches bins whose area is not what the integral takes: directions that fill the sphere evenly fill the bins so.
    #[test]
    fn bins_have_their_areas() {
        let mut random = Random::new(1, 1);
        let n = 100_000.0;
        let mut found = vec![0.0; BINS[0] * BINS[1] + 1];
        for _ in 0..100_000 {
            let d = direction((1.0 - 2.0 * random.unit()).acos(), TAU * random.unit());
            found[bin(d).unwrap()] += 1.0;
        }
        let area = |bin: usize| {
            let edge = |ring: usize| (ring as f64 / BINS[0] as f64).powi(2);
            (edge(bin / BINS[1] + 1) - edge(bin / BINS[1])) / BINS[1] as f64
        };
        let exact = |mean: f64| Estimate { mean, variance: 0.0 };
        let mut expected: Vec<Estimate> = (0..BINS[0] * BINS[1]).map(|bin| exact(area(bin))).collect();
        expected.push(exact(0.0));
        assert!(p_value(&found, &expected, n) > 0.01);
        assert!(p_value(&merged(&found), &merged(&expected), n) > 0.01);
        assert_eq!(merged(&found).iter().sum::<f64>(), n);
        // One bin of two thousand with five times its directions is seen.
        found[1000] *= 5.0;
        assert!(p_value(&found, &expected, n) < 0.01);
    }
}
