//! The table of this module: how much GGX facets lose, and what Schlick's grazing term adds.

use crate::oracles::Table;
use crate::oracles::albedo::{ggx, ggx_mean};
use crate::oracles::quadrature::nodes;

pub(super) const TABLES: &[(&str, Table)] = &[("albedo", albedo)];

/// Directions and widths.
const SIDE: usize = 32;

/// Panels of the quadrature: its error is a hundredth of the interpolation's.
const PANELS: usize = 4;

/// Rows for alpha, evenly in its root from 1e-4 to 1; in each the cosines m for which m (1 + alpha) / (m + alpha) is evenly spaced in its
/// root: pairs of the root of the lost share, and of B less what facets that are all level would have. Behind them the means for each alpha: the
/// lost share over alpha^2, and B.
fn albedo() -> Vec<f32> {
    let step = |i: usize| i as f64 / (SIDE - 1) as f64;
    let widths: Vec<f64> = (0..SIDE).map(|row| (0.01 + 0.99 * step(row)) * (0.01 + 0.99 * step(row))).collect();
    let mut table = Vec::with_capacity(2 * SIDE * (SIDE + 1));
    for &alpha in &widths {
        for column in 0..SIDE {
            let t = step(column) * step(column);
            let cosine = (t * alpha / (1.0 + alpha - t)).min(1.0);
            let at = ggx(alpha, cosine, PANELS);
            let x = 1.0 - cosine;
            table.push(at.lost.max(0.0).sqrt() as f32);
            table.push((at.grazing - (1.0 - at.lost) * (x * x * x * x * x)) as f32);
        }
    }
    for (row, &alpha) in widths.iter().enumerate() {
        let lost = mean_of_row(&table[2 * SIDE * row..2 * SIDE * (row + 1)], alpha);
        table.push((lost / (alpha * alpha)) as f32);
        table.push(ggx_mean(alpha, PANELS).grazing as f32);
    }
    table
}

/// The mean of the lost share as a row interpolates it: what is brought back over all directions is then what was taken off, to the last digit,
/// whatever the row errs by.
fn mean_of_row(row: &[f32], alpha: f64) -> f64 {
    let mut mean = 0.0;
    for (x, weight) in nodes(0.0, 1.0, 64) {
        // All decades of the cosine count, from alpha on.
        let cosine = x * x * x * x;
        let place = (cosine * (1.0 + alpha) / (cosine + alpha)).min(1.0).sqrt() * (SIDE - 1) as f64;
        let column = (place as usize).min(SIDE - 2);
        let (low, high) = (f64::from(row[2 * column]), f64::from(row[2 * column + 2]));
        let root = low + (high - low) * (place - column as f64);
        mean += 2.0 * cosine * 4.0 * x * x * x * weight * (root * root);
    }
    mean
}
