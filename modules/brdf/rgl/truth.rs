//! The module's own table, looked up in double precision. The warp is inverted by integrating its density: whole cells one after another, in the row
//! and below it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::oracles::lobes::{cosine_density, lit, spherical};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// The file that the module has where nobody names another.
const FILE: &[u8] = include_bytes!("sample.bsdf");

/// A field's sizes and numbers.
struct Field {
    sizes: Vec<usize>,
    data: &'static [u8],
}

impl Field {
    /// Finds a field in the tensor file: names, types and places stand in its front.
    fn of(name: &str) -> Self {
        let number = |at: usize, bytes: usize| FILE[at..at + bytes].iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte));
        let mut at = 18;
        for _ in 0..number(14, 4) {
            let length = number(at, 2);
            let named = &FILE[at + 2..at + 2 + length];
            at += 2 + length;
            let (dimensions, place) = (number(at, 2), number(at + 3, 8));
            at += 11;
            let sizes: Vec<usize> = (0..dimensions).map(|i| number(at + 8 * i, 8)).collect();
            at += 8 * dimensions;
            if named == name.as_bytes() {
                return Self {
                    sizes,
                    data: &FILE[place..],
                };
            }
        }
        Self {
            sizes: Vec::new(),
            data: &[],
        }
    }

    fn number(&self, index: usize) -> f64 {
        self.data[4 * index..4 * index + 4].try_into().map_or(f64::NAN, |bytes| f64::from(f32::from_le_bytes(bytes)))
    }

    /// Points along a row, and rows.
    fn size(&self) -> [usize; 2] {
        [self.sizes[self.sizes.len() - 1], self.sizes[self.sizes.len() - 2]]
    }

    /// Bilinear at a place in the unit square of a slice.
    fn at(&self, slice: usize, x: f64, y: f64) -> f64 {
        let [w, h] = self.size();
        let (x, y) = (x.clamp(0.0, 1.0) * (w - 1) as f64, y.clamp(0.0, 1.0) * (h - 1) as f64);
        let (i, j) = ((x as usize).min(w - 2), (y as usize).min(h - 2));
        let (x, y) = (x - i as f64, y - j as f64);
        let value = |i: usize, j: usize| self.number((slice * h + j) * w + i);
        value(i, j) * (1.0 - x) * (1.0 - y) + value(i + 1, j) * x * (1.0 - y) + value(i, j + 1) * (1.0 - x) * y + value(i + 1, j + 1) * x * y
    }

    /// Integral of a slice over [0, x] x [0, y] and over all x up to y, and that of the whole row at y up to x: all by midpoints that are exact for
    /// what is bilinear in a cell.
    fn row(&self, slice: usize, x: f64, y: f64) -> f64 {
        let [w, _] = self.size();
        parts(x, w).map(|(from, to)| (to - from) * self.at(slice, 0.5 * (from + to), y)).sum()
    }

    fn below(&self, slice: usize, y: f64) -> f64 {
        let [_, h] = self.size();
        parts(y, h).map(|(from, to)| (to - from) * self.row(slice, 1.0, 0.5 * (from + to))).sum()
    }
}

/// The cells of a side up to a place, the last one cut off there.
fn parts(end: f64, points: usize) -> impl Iterator<Item = (f64, f64)> {
    let cell = 1.0 / (points - 1) as f64;
    (0..points - 1).map(move |i| (i as f64 * cell, ((i + 1) as f64 * cell).min(end))).filter(|(from, to)| to > from)
}

/// Dupuy and Jakob 2018: rgb D / (4 sigma cos), of the table's isotropic kind.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else { return vec![0.0; 3] };
    let ((theta_v, phi_v), (theta_m, phi_m)) = (spherical(at, lit.v), spherical(at, lit.v + lit.l));
    let u = ((theta_m / FRAC_PI_2).sqrt(), ((phi_m - phi_v + PI) / TAU).rem_euclid(1.0));
    let thetas = Field::of("theta_i");
    let count = thetas.sizes[0];
    let low = (0..count - 1).rev().find(|i| thetas.number(*i) <= theta_v).unwrap_or(0);
    let part = ((theta_v - thetas.number(low)) / (thetas.number(low + 1) - thetas.number(low))).clamp(0.0, 1.0);
    let slices = [(low, 1.0 - part), (low + 1, part)];
    // Each slice is scaled to an integral of 1 before they are mixed.
    let vndf = Field::of("vndf");
    let mixed = |of: &dyn Fn(usize) -> f64| slices.iter().map(|(slice, weight)| weight * of(*slice) / vndf.below(*slice, 1.0)).sum::<f64>();
    let even = (
        mixed(&|slice| vndf.row(slice, u.0, u.1)) / mixed(&|slice| vndf.row(slice, 1.0, u.1)),
        mixed(&|slice| vndf.below(slice, u.1)),
    );
    let rgb = Field::of("rgb");
    let normals = Field::of("ndf").at(0, u.0, u.1);
    let area = Field::of("sigma").at(0, (theta_v / FRAC_PI_2).sqrt(), ((phi_v + PI) / TAU).clamp(0.0, 1.0));
    let value = |channel: usize| slices.iter().map(|(slice, weight)| weight * rgb.at(slice * 3 + channel, even.0, even.1)).sum::<f64>();
    (0..3).map(|channel| value(channel) * normals / (4.0 * area * lit.theta_l.cos())).collect()
}

/// By the cosine.
fn brdf_pdf(at: &At) -> Vec<f64> {
    vec![cosine_density(at)]
}
