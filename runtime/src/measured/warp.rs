//! Functions on the unit square that are bilinear between the points of a grid, and the map that takes evenly spread points to points spread by
//! such a function: rows by the marginal, then within a row by the conditional distribution. One for each incident direction of a table.

use glam::DVec2;

/// Densities on the unit square, a slice for each incident direction, with what inverting their distributions needs. The first of a slice's
/// coordinates is along a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Warp {
    pub width: usize,
    pub height: usize,
    /// Each slice scaled so that its cells' means add up to 1.
    pub values: Vec<f32>,
    /// Integrals along each row up to each point, in cells.
    pub conditional: Vec<f32>,
    /// Integrals of whole rows up to each row.
    pub marginal: Vec<f32>,
}

impl Warp {
    /// Scales and integrates the slices of `values`, in place of each other the grids of `width` x `height` points, each at least 2.
    ///
    /// # Errors
    /// The number of the first slice whose integral is not a positive number that f32 can divide by.
    pub fn new(width: usize, height: usize, mut values: Vec<f32>) -> Result<Self, usize> {
        let mut conditional = Vec::with_capacity(values.len());
        let mut marginal = Vec::with_capacity(values.len() / width);
        for (number, slice) in values.chunks_mut(width * height).enumerate() {
            let mut rows = vec![0.0f64];
            let (mut sum, mut before) = (0.0f64, None);
            let mut integrals = Vec::with_capacity(slice.len());
            for row in slice.chunks(width) {
                let mut along = 0.0f64;
                integrals.push(along);
                for pair in row.windows(2) {
                    along += 0.5 * (f64::from(pair[0]) + f64::from(pair[1]));
                    integrals.push(along);
                }
                if let Some(before) = before.replace(along) {
                    sum += 0.5 * (before + along);
                    rows.push(sum);
                }
            }
            let scale = 1.0 / sum;
            // A scale that f32 cannot hold makes numbers that it cannot hold.
            if sum <= 0.0 || !(scale as f32).is_finite() {
                return Err(number);
            }
            conditional.extend(integrals.into_iter().map(|x| (x * scale) as f32));
            marginal.extend(rows.into_iter().map(|x| (x * scale) as f32));
            slice.iter_mut().for_each(|x| *x = (f64::from(*x) * scale) as f32);
        }
        Ok(Self {
            width,
            height,
            values,
            conditional,
            marginal,
        })
    }

    /// The point of a slice to which an evenly spread point of the unit square goes.
    pub fn sample(&self, slice: usize, even: DVec2) -> DVec2 {
        let (w, h) = (self.width, self.height);
        let marginal = &self.marginal[slice * h..][..h];
        let row = interval(h, |i| f64::from(marginal[i]) < even.y);
        let integral = |row: usize, i: usize| f64::from(self.conditional[(slice * h + row) * w + i]);
        let (r0, r1) = (integral(row, w - 1), integral(row + 1, w - 1));
        let y = invert(r0, r1, even.y - f64::from(marginal[row]));
        let between = |i: usize| (1.0 - y) * integral(row, i) + y * integral(row + 1, i);
        let along = even.x * between(w - 1);
        let column = interval(w, |i| between(i) < along);
        let value = |row: usize, i: usize| f64::from(self.values[(slice * h + row) * w + i]);
        let at = |i: usize| (1.0 - y) * value(row, i) + y * value(row + 1, i);
        let x = invert(at(column), at(column + 1), along - between(column));
        DVec2::new((column as f64 + x) / (w - 1) as f64, (row as f64 + y) / (h - 1) as f64)
    }
}

/// The interval of `size` ascending points in which `is_before` ends.
fn interval(size: usize, is_before: impl Fn(usize) -> bool) -> usize {
    (1..size - 1).take_while(|i| is_before(*i)).last().unwrap_or(0)
}

/// Where in [0, 1] the integral of a function that goes evenly from `a` to `b` reaches `area`.
fn invert(a: f64, b: f64, area: f64) -> f64 {
    let root = (a * a + 2.0 * area * (b - a)).max(0.0).sqrt();
    // The quadratic formula without cancellation. Where nothing is, any place is as good.
    if a + root > 0.0 {
        (2.0 * area / (a + root)).clamp(0.0, 1.0)
    } else {
        0.5
    }
}

/// A bilinear function's value at a point of the unit square.
pub fn bilinear(values: &[f32], width: usize, height: usize, at: DVec2) -> f64 {
    let place = |x: f64, size: usize| {
        let x = x.clamp(0.0, 1.0) * (size - 1) as f64;
        let cell = (x as usize).min(size - 2);
        (cell, x - cell as f64)
    };
    let ((i, x), (j, y)) = (place(at.x, width), place(at.y, height));
    let value = |i: usize, j: usize| f64::from(values[j * width + i]);
    let row = |j: usize| (1.0 - x) * value(i, j) + x * value(i + 1, j);
    (1.0 - y) * row(j) + y * row(j + 1)
}
