//! `.binary` files: a grid over half and difference angles (Matusik et al. 2003, A Data-Driven Reflectance Model; Rusinkiewicz 1998, A New Change
//! of Variables for Efficient BRDF Representation).
//!
//! Three little-endian `i32` (how many theta_h, theta_d, phi_d), then three planes of `f64`, red, green, blue, phi_d fastest, theta_h slowest.
//! The numbers are divided by 1500, green and blue multiplied by 1.15 and 1.66. theta_h in [0, pi/2] is quantised by its square root, theta_d in
//! [0, pi/2] and phi_d in [0, pi) evenly: reciprocity makes phi_d + pi the same as phi_d. A number stands in the middle of its cell.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::{Damaged, Sample, is_within, spread};

/// What the file's numbers are multiplied by to be 1/sr.
const SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
/// Names of the dimensions, in the file's order.
const DIMENSIONS: [&str; 3] = ["theta_h", "theta_d", "phi_d"];
const PLANES: [&str; 3] = ["red", "green", "blue"];
const HEADER: usize = 12;
/// Samples along a dimension: enough to interpolate between, and so few that their product is far from overflowing.
const SIZES: std::ops::RangeInclusive<usize> = 2..=1024;

/// A table over half and difference angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Merl {
    sizes: [usize; 3],
    /// 1/sr; below 0 where the file says that nothing was measured.
    values: Vec<[f32; 3]>,
}

impl Merl {
    /// The size of the published tables: theta_h, theta_d, phi_d.
    pub const PUBLISHED: [usize; 3] = [90, 90, 180];

    /// Reads a file. Other sizes than the published are taken where each dimension is from 2 to 1024. A negative number means that nothing was
    /// measured there; a cell with one in any channel is invalid.
    ///
    /// # Errors
    /// The file is too short or too long for its dimensions, they cannot be, a number is not finite, or no cell is valid.
    pub fn read(bytes: &[u8]) -> Result<Self, Damaged> {
        let Some(header) = bytes.first_chunk::<HEADER>() else {
            return Err(Damaged::new(
                bytes.len(),
                format!("{HEADER} bytes of dimensions"),
                format!("the end of the file after {} bytes", bytes.len()),
            ));
        };
        let mut sizes = [0; 3];
        for (axis, size) in sizes.iter_mut().enumerate() {
            let at = 4 * axis;
            let given = i32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
            *size = usize::try_from(given).ok().filter(|n| SIZES.contains(n)).ok_or_else(|| {
                let name = DIMENSIONS[axis];
                Damaged::new(
                    at,
                    format!("a size of {name} from {} to {}", SIZES.start(), SIZES.end()),
                    given.to_string(),
                )
            })?;
        }
        let cells: usize = sizes.iter().product();
        let whole = HEADER + cells * 24;
        if bytes.len() != whole {
            let [h, d, p] = sizes;
            return Err(Damaged::new(
                bytes.len().min(whole),
                format!("{whole} bytes for {h} x {d} x {p} cells of three channels"),
                format!("{} bytes", bytes.len()),
            ));
        }
        let mut values = vec![[0.0f32; 3]; cells];
        for (index, chunk) in bytes[HEADER..].chunks_exact(8).enumerate() {
            let (plane, cell) = (index / cells, index % cells);
            // Chunks of 8 are 8 bytes long.
            let number = f64::from_le_bytes(chunk.try_into().unwrap_or_default());
            let value = (number * SCALES[plane]) as f32;
            if !value.is_finite() {
                let at = HEADER + index * 8;
                let expected = format!("a number that f32 can hold, {} of cell {cell}", PLANES[plane]);
                return Err(Damaged::new(at, expected, format!("{number:?}")));
            }
            values[cell][plane] = value;
        }
        let table = Self { sizes, values };
        if !table.values.iter().any(is_valid) {
            return Err(Damaged::new(HEADER, "at least one cell without negative numbers", "none"));
        }
        Ok(table)
    }

    /// The file that [`Merl::read`] reads.
    pub fn write(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER + self.values.len() * 24);
        for size in self.sizes {
            bytes.extend(i32::try_from(size).unwrap_or(i32::MAX).to_le_bytes());
        }
        for (plane, scale) in SCALES.iter().enumerate() {
            for value in &self.values {
                bytes.extend((f64::from(value[plane]) / scale).to_le_bytes());
            }
        }
        bytes
    }

    /// Tabulates a function of the directions to the viewer and to the light, 1/sr by channel; `sizes` as [`Merl::read`] takes them, else the nearest
    /// of those. Cells where a direction is below the horizon are invalid.
    pub fn tabulate(sizes: [usize; 3], function: impl Fn(DVec3, DVec3) -> [f64; 3]) -> Self {
        let sizes = sizes.map(|size| size.clamp(*SIZES.start(), *SIZES.end()));
        let mut values = Vec::with_capacity(sizes.iter().product());
        for h in 0..sizes[0] {
            for d in 0..sizes[1] {
                for p in 0..sizes[2] {
                    let (v, l) = middle(sizes, [h, d, p]);
                    let seen = v.z > 0.0 && l.z > 0.0;
                    values.push(if seen { function(v, l).map(|x| x as f32) } else { [-1.0; 3] });
                }
            }
        }
        Self { sizes, values }
    }

    /// How many theta_h, theta_d and phi_d.
    pub fn sizes(&self) -> [usize; 3] {
        self.sizes
    }

    /// What was measured in a cell; none where nothing was.
    pub fn value(&self, cell: [usize; 3]) -> Option<[f32; 3]> {
        let [_, d, p] = self.sizes;
        let value = self.values.get((cell[0] * d + cell[1]) * p + cell[2])?;
        is_valid(value).then_some(*value)
    }

    /// See [`super::Measured::samples`].
    pub fn samples(&self, count: usize, most: f64) -> Vec<Sample> {
        let mut samples = Vec::new();
        spread(self.sizes, count, |cell| {
            let (v, l) = middle(self.sizes, cell);
            let Some(value) = self.value(cell).filter(|_| is_within(v, l, most)) else {
                return false;
            };
            samples.push(Sample {
                v,
                l,
                value: value.map(f64::from),
            });
            true
        });
        samples
    }

    /// The table for a shader, which stands at points and not in cells: theta_h and theta_d have a point at 0 before those in the middles of the cells.
    /// First the three sizes, without those points, then red, green and blue of each point, in the file's order.
    ///
    /// An invalid cell has the value of the nearest valid one with the same theta_h and phi_d and a smaller theta_d: a pair of directions goes
    /// below the horizon as theta_d grows, and so interpolation at the horizon is not with black. Where there is none, it is 0. At an angle of 0
    /// phi_d means nothing: the mean over it of the nearest cells stands there, so that what is interpolated has no jump.
    pub fn floats(&self) -> Vec<f32> {
        let [h, d, p] = self.sizes;
        let mut filled = self.values.clone();
        for cell in 0..filled.len() {
            if !is_valid(&filled[cell]) {
                // What stands p cells before is filled already.
                filled[cell] = if cell / p % d > 0 { filled[cell - p] } else { [0.0; 3] };
            }
        }
        let mean = |row: &[[f32; 3]]| -> [f32; 3] {
            std::array::from_fn(|channel| (row.iter().map(|value| f64::from(value[channel])).sum::<f64>() / row.len() as f64) as f32)
        };
        let mut floats: Vec<f32> = self.sizes.iter().map(|size| *size as f32).collect();
        floats.reserve((h + 1) * (d + 1) * p * 3);
        for i in 0..=h {
            for j in 0..=d {
                let row = &filled[(i.saturating_sub(1) * d + j.saturating_sub(1)) * p..][..p];
                let mean = (i == 0 || j == 0).then(|| mean(row));
                for value in row {
                    floats.extend(mean.unwrap_or(*value));
                }
            }
        }
        floats
    }
}

fn is_valid(value: &[f32; 3]) -> bool {
    value.iter().all(|x| *x >= 0.0)
}

/// Directions to the viewer and to the light in the middle of a cell.
fn middle(sizes: [usize; 3], cell: [usize; 3]) -> (DVec3, DVec3) {
    let at = |axis: usize| (cell[axis] as f64 + 0.5) / sizes[axis] as f64;
    directions(at(0).powi(2) * FRAC_PI_2, at(1) * FRAC_PI_2, at(2) * PI)
}

/// Directions to the viewer and to the light with these half and difference angles, the half vector in the plane of x and z.
fn directions(theta_h: f64, theta_d: f64, phi_d: f64) -> (DVec3, DVec3) {
    let (sin_h, cos_h) = theta_h.sin_cos();
    let (sin_d, cos_d) = theta_d.sin_cos();
    let turned = |x: f64, y: f64| DVec3::new(x * cos_h + cos_d * sin_h, y, cos_d * cos_h - x * sin_h);
    let (x, y) = (sin_d * phi_d.cos(), sin_d * phi_d.sin());
    (turned(-x, -y), turned(x, y))
}
