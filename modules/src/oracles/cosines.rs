//! Lobes as linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016): the fit, and the tables made of it.
//!
//! A lobe is what a surface with the BRDF f reflects toward v: f(v, l) cos(theta_l), a function of l. It is taken for A D(l), with D the clamped cosine
//! max(z, 0) / pi of a direction, carried along by the linear map M of directions. A polygon's integral over it is A times the form factor of the
//! polygon moved by M^-1.
//!
//! What is minimised is not the difference at points, which a renderer never sees, but that of integrals. The integral of a light's polygon
//! changes with where its edges are, and each edge lies on a great circle: so both sides are integrated over half spaces {l: l.n > 0}, and the
//! squared differences are summed over n. Lights of uniform luminance with random edges have that mean square error but for what corners
//! contribute (Crofton's formula makes it the energy distance of the two lobes as measures on the sphere). Over a half space both sides are cheap: the
//! lobe's integral is a sum over samples, and that of the transformed cosine has the closed form
//!
//! ```text
//! A (1 + m.z / |m|) / 2,    m = M^T n
//! ```
//!
//! since the map takes the half space n to the half space m, and the cosine's integral over two half spaces is that of a lune. The sphere below
//! the horizon takes part, where the lobe is 0 and a transformed cosine need not be: what leaks through the horizon is an error like any other.
//!
//! Everything is additions, multiplications, divisions, square roots and functions of `libm`, in a fixed order: the same bits on every machine.

use std::f64::consts::PI;
use std::num::NonZero;
use std::sync::Mutex;
use std::thread;

use glam::{DMat3, DVec3};

/// A direction drawn from a lobe.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Unit direction to the light.
    pub l: DVec3,
    /// Its share of the lobe's integral for F = 1.
    pub weight: f64,
    /// The same times (1 - v.h)^5, what Schlick's Fresnel term adds for f0 = 0 (1994, eq. 15).
    pub fresnel: f64,
}

/// Draws a lobe: for the width alpha, seen along v (unit, y = 0, above z = 0), with this many strata in each of two dimensions.
pub type Lobe = fn(alpha: f64, v: DVec3, strata: usize) -> Vec<Sample>;

/// A fitted lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cosine {
    /// Angle from the normal to the axis of the map, away from the viewer where it is negative, radians.
    pub tilt: f64,
    /// Logarithm of the stretch in the plane of incidence.
    pub along: f64,
    /// Logarithm of the stretch across it.
    pub across: f64,
    /// Shear of the axis in the plane of incidence.
    pub shear: f64,
    /// Logarithm of A.
    pub amplitude: f64,
    /// B: A times the lobe's mean of (1 - v.h)^5.
    pub fresnel: f64,
    /// Root of the weighted mean square of the half spaces' differences.
    pub error: f64,
}

/// Numbers of a cell of a table: `M^-1` at `[0][0]`, `[0][2]`, `[2][0]` and `[2][2]`, A, and B less what level facets would have. See [`Cosine::cell`].
pub const NUMBERS: usize = 6;

/// Rows and columns of the tables that shaders read.
pub const SIDE: usize = 32;

/// Smallest alpha of a table. Below it a lobe is its limit: to f32 a mirror.
const SMOOTHEST: f64 = 1e-4;
/// Angles of incidence a table's ends stand for, radians: at 0 and 90 degrees two of its numbers are 0 / 0.
const STEEPEST: f64 = 0.1;
const FLATTEST: f64 = 1.570_795;
/// Strata of the samples in each dimension. The edge of a half space goes through some 100 of 10^4 cells: its integral is good to 3e-4, and
/// the errors of the half spaces are independent.
const STRATA: usize = 64;
/// Half spaces. By the lobe's symmetry each stands for four.
const HALF_SPACES: usize = 300;
/// How much wider than the lobe the half spaces are spread, each as many: edges far away see its tails.
const SPREADS: [f64; 4] = [1.0, 4.0, 16.0, 64.0];
/// Weight of a half space: the density of great circles, uniform on the sphere, over that with which they were drawn, to this power. 1 is the
/// mean over lights of all places and sizes, 0 looks at the lobe as if it had the width 1.
const UNIFORMITY: f64 = 0.75;

/// A half space, and what the lobe's integral over it is.
struct HalfSpace {
    n: DVec3,
    root_weight: f64,
    integral: f64,
}

/// (1 - m)^5: what all facets would add to f0 = 0 if they lay level. Schlick 1994, eq. 15.
fn level(m: f64) -> f64 {
    let c = 1.0 - m;
    (c * c) * (c * c) * c
}

/// z to (sin(angle), 0, cos(angle)).
fn turn(angle: f64) -> DMat3 {
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    DMat3::from_cols(DVec3::new(cosine, 0.0, -sine), DVec3::Y, DVec3::new(sine, 0.0, cosine))
}

impl Cosine {
    /// The map M from the cosine's directions to the lobe's, in the frame of tangent (toward the viewer), bitangent and normal.
    pub fn map(&self) -> DMat3 {
        let frame = turn(self.tilt);
        let axis = frame.x_axis * self.shear + frame.z_axis;
        DMat3::from_cols(frame.x_axis * libm::exp(self.along), frame.y_axis * libm::exp(self.across), axis)
    }

    /// Its inverse.
    pub fn inverse(&self) -> DMat3 {
        let frame = turn(self.tilt);
        let x = (frame.x_axis - frame.z_axis * self.shear) * libm::exp(-self.along);
        DMat3::from_cols(x, frame.y_axis * libm::exp(-self.across), frame.z_axis).transpose()
    }

    /// What a table holds of it, for the angle of incidence theta.
    ///
    /// M^-1 is taken in the frame around the mirrored view, whose direction the shader knows exactly, and its middle number is made 1, since a map's
    /// length is nothing to directions. What is left is divided by what it vanishes with: the third row by alpha, the two numbers that mix
    /// x and z by alpha sin(theta), and the two others by alpha + cos(theta). A smooth surface's lobe is 2 alpha wide, and 2 alpha cos(theta) across; within
    /// alpha of the horizon that ends. So the numbers are of the order 1 and smooth, and few cells do. B has taken
    /// off it what facets that lie level would have: the columns of a smooth surface are too few for a fifth power. A lobe
    /// without a Fresnel term has 0.
    pub fn cell(&self, alpha: f64, theta: f64) -> [f64; NUMBERS] {
        let map = self.inverse() * turn(-theta);
        let scale = 1.0 / map.y_axis.y;
        let skew = scale / (alpha * libm::sin(theta));
        let narrow = libm::cos(theta) + alpha;
        [
            map.x_axis.x * scale / narrow,
            map.z_axis.x * skew,
            map.x_axis.z * skew,
            map.z_axis.z * scale / (alpha * narrow),
            libm::exp(self.amplitude),
            if self.fresnel > 0.0 {
                self.fresnel - libm::exp(self.amplitude) * level(libm::cos(theta))
            } else {
                0.0
            },
        ]
    }

    /// [`Self::cell`] undone: M^-1 for offsets in the frame of tangent, bitangent and normal, A, and B where the lobe has a Fresnel term.
    pub fn of_cell(cell: &[f64; NUMBERS], alpha: f64, theta: f64) -> (DMat3, f64, f64) {
        let skew = alpha * libm::sin(theta);
        let narrow = libm::cos(theta) + alpha;
        let x = DVec3::new(cell[0] * narrow, 0.0, cell[2] * skew);
        let z = DVec3::new(cell[1] * skew, 0.0, cell[3] * alpha * narrow);
        let grazing = cell[5] + cell[4] * level(libm::cos(theta));
        (DMat3::from_cols(x, DVec3::Y, z) * turn(-theta).transpose(), cell[4], grazing)
    }

    const fn parameters(&self) -> [f64; 5] {
        [self.tilt, self.along, self.across, self.shear, self.amplitude]
    }

    const fn with(self, [tilt, along, across, shear, amplitude]: [f64; 5]) -> Self {
        Self {
            tilt,
            along,
            across,
            shear,
            amplitude,
            ..self
        }
    }

    /// Differences of the integrals over each half space and its complement, and the sum of their squares.
    fn residuals(&self, spaces: &[HalfSpace], whole: f64, out: &mut Vec<f64>) -> f64 {
        let transposed = self.map().transpose();
        let amplitude = libm::exp(self.amplitude);
        out.clear();
        let mut sum = 0.0;
        for space in spaces {
            let m = transposed * space.n;
            let cosine = m.z / m.length();
            let inside = space.root_weight * (amplitude * 0.5 * (1.0 + cosine) - space.integral);
            let outside = space.root_weight * (amplitude * 0.5 * (1.0 - cosine) - (whole - space.integral));
            sum += inside * inside + outside * outside;
            out.push(inside);
            out.push(outside);
        }
        sum
    }

    /// The same lobe wider by a factor, in each direction up to the cosine itself.
    fn widened(&self, factor: f64) -> Self {
        let wider = |stretch: f64| f64::max(f64::min(stretch + libm::log(factor), 0.0), stretch);
        Self {
            along: wider(self.along),
            across: wider(self.across),
            ..*self
        }
    }

    /// Half spaces spread evenly over those of the spaces in which this lobe, widened in steps, is the cosine.
    fn half_spaces(&self, samples: &[Sample]) -> Vec<HalfSpace> {
        let wider = SPREADS.map(|factor| self.widened(factor));
        let maps = wider.map(|lobe| lobe.map().transpose());
        let inverses = wider.map(|lobe| lobe.inverse().transpose());
        // How densely they are drawn, all steps together.
        let density = |n: DVec3| {
            let of = |map: &DMat3| {
                let length = (*map * n).length();
                map.determinant() / (length * length * length)
            };
            maps.iter().map(of).sum::<f64>()
        };
        let mut spaces = Vec::with_capacity(HALF_SPACES);
        let mut sum = 0.0;
        for index in 0..HALF_SPACES {
            let at = index as f64 + 0.5;
            let z = at / HALF_SPACES as f64;
            // The golden section spreads them; by the lobe's symmetry half the circle will do.
            let around = at * 0.618_033_988_749_894_9;
            let phi = PI * (around - libm::floor(around));
            let sine = (1.0 - z * z).sqrt();
            let m = DVec3::new(sine * libm::cos(phi), sine * libm::sin(phi), z);
            let n = (inverses[index % SPREADS.len()] * m).normalize();
            let weight = libm::pow(density(n), -UNIFORMITY);
            sum += weight;
            let integral = samples
                .iter()
                .filter(|sample| sample.l.dot(n) > 0.0)
                .map(|sample| sample.weight)
                .sum();
            spaces.push(HalfSpace {
                n,
                root_weight: weight,
                integral,
            });
        }
        for space in &mut spaces {
            space.root_weight = (space.root_weight / sum).sqrt();
        }
        spaces
    }

    /// Fits a lobe at a width and an angle of incidence, radians.
    pub fn fit(lobe: Lobe, alpha: f64, theta: f64) -> Self {
        let samples = lobe(alpha, DVec3::new(libm::sin(theta), 0.0, libm::cos(theta)), STRATA);
        let whole: f64 = samples.iter().map(|sample| sample.weight).sum();
        let fresnel: f64 = samples.iter().map(|sample| sample.fresnel).sum();
        let tilt = median(&samples, |l| libm::atan2(l.x, l.z));
        let upright = turn(tilt).transpose();
        // The median of |x| / z under a cosine of the stretch 1 is the root of a third. Directions behind the axis count as infinitely far.
        let stretch = |slope: fn(DVec3) -> f64| {
            let far = median(&samples, |l| {
                let l = upright * l;
                if l.z > 0.0 { slope(l).abs() / l.z } else { f64::INFINITY }
            });
            libm::log(f64::min(far * 3.0_f64.sqrt(), 1e3))
        };
        let mut fit = Self {
            tilt,
            along: stretch(|l| l.x),
            across: stretch(|l| l.y),
            shear: 0.0,
            amplitude: libm::log(whole),
            fresnel: 0.0,
            error: 0.0,
        };
        // Around the lobe's own middle and widths, not around the fit: that would be free to look away from what it misses.
        let spaces = fit.half_spaces(&samples);
        let (parameters, error) = descend(fit.parameters(), |at, out| fit.with(*at).residuals(&spaces, whole, out));
        fit = Self {
            error: error.sqrt(),
            ..fit.with(parameters)
        };
        // A share; the fit may want a hundredth more.
        fit.amplitude = f64::min(fit.amplitude, 0.0);
        fit.fresnel = libm::exp(fit.amplitude) * fresnel / whole;
        fit
    }
}

/// The number that samples of half the weight do not exceed.
fn median(samples: &[Sample], of: impl Fn(DVec3) -> f64) -> f64 {
    let mut numbers: Vec<(f64, f64)> = samples.iter().map(|sample| (of(sample.l), sample.weight)).collect();
    numbers.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut left: f64 = 0.5 * numbers.iter().map(|number| number.1).sum::<f64>();
    for (number, weight) in &numbers {
        left -= weight;
        if left <= 0.0 {
            return *number;
        }
    }
    0.0
}

/// Where a sum of squared residuals is least, and that sum: Levenberg 1944 and Marquardt 1963, damped by the diagonal. Of the crates that do this each goes
/// through a library of linear algebra with kernels by processor; a few unknowns need none, and the bits must not depend on the machine.
pub(super) fn descend<const N: usize>(from: [f64; N], of: impl Fn(&[f64; N], &mut Vec<f64>) -> f64) -> ([f64; N], f64) {
    let mut at = from;
    let mut residuals = Vec::new();
    let mut trial = Vec::new();
    let mut slopes: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    let mut error = of(&at, &mut residuals);
    let mut damping = 1e-2;
    for _ in 0..100 {
        for (index, slope) in slopes.iter_mut().enumerate() {
            let mut moved = at;
            moved[index] += 1e-6;
            of(&moved, &mut trial);
            slope.clear();
            slope.extend(trial.iter().zip(&residuals).map(|(after, before)| (after - before) * 1e6));
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut normal = [[0.0; N]; N];
        let mut right = [0.0; N];
        for ((row, right), a) in normal.iter_mut().zip(&mut right).zip(&slopes) {
            for (entry, b) in row.iter_mut().zip(&slopes) {
                *entry = dot(a, b);
            }
            *right = -dot(a, &residuals);
        }
        let mut is_done = true;
        for _ in 0..12 {
            let mut damped = normal;
            for (index, row) in damped.iter_mut().enumerate() {
                // A parameter that changes nothing stays where it is.
                row[index] += row[index] * damping + 1e-14;
            }
            let step = solve(damped, right);
            let mut moved = at;
            for (number, by) in moved.iter_mut().zip(step) {
                *number += by.clamp(-1.0, 1.0);
            }
            let after = of(&moved, &mut trial);
            if after < error {
                is_done = error - after < 1e-9 * error;
                std::mem::swap(&mut residuals, &mut trial);
                (at, error) = (moved, after);
                damping = f64::max(damping * 0.2, 1e-9);
                break;
            }
            damping *= 5.0;
        }
        if is_done {
            break;
        }
    }
    (at, error)
}

/// Solves a system. Gauss, with pivots by column.
fn solve<const N: usize>(mut rows: [[f64; N]; N], mut right: [f64; N]) -> [f64; N] {
    for column in 0..N {
        let mut pivot = column;
        for row in column + 1..N {
            if rows[row][column].abs() > rows[pivot][column].abs() {
                pivot = row;
            }
        }
        rows.swap(column, pivot);
        right.swap(column, pivot);
        let above = rows[column];
        for row in column + 1..N {
            let factor = rows[row][column] / above[column];
            for (entry, above) in rows[row].iter_mut().zip(&above) {
                *entry -= factor * above;
            }
            right[row] -= factor * right[column];
        }
    }
    let mut solution = [0.0; N];
    for row in (0..N).rev() {
        let mut rest = right[row];
        for column in row + 1..N {
            rest -= rows[row][column] * solution[column];
        }
        solution[row] = rest / rows[row][row];
    }
    solution
}

/// Width that the row `row` of `side` stands for: rows are evenly spaced in roughness, its root.
pub fn alpha_of(row: usize, side: usize) -> f64 {
    let roughness = row as f64 / (side - 1) as f64;
    f64::max(roughness * roughness, SMOOTHEST)
}

/// Angle of incidence of a column, radians: they are evenly spaced in the root of m (1 + alpha) / (m + alpha), m its cosine, from 90 degrees down. A lobe
/// changes most where m is about alpha, and it is cut by the horizon.
pub fn theta_of(column: usize, side: usize, alpha: f64) -> f64 {
    let root = column as f64 / (side - 1) as f64;
    let place = root * root;
    libm::acos(f64::min(place * alpha / (1.0 + alpha - place), 1.0)).clamp(STEEPEST, FLATTEST)
}

/// One cell of a lobe's table of `side` times `side` cells.
pub fn cell(lobe: Lobe, row: usize, column: usize, side: usize) -> [f64; NUMBERS] {
    let alpha = alpha_of(row, side);
    let theta = theta_of(column, side, alpha);
    Cosine::fit(lobe, alpha, theta).cell(alpha, theta)
}

/// The whole table, cells by row, [`NUMBERS`] each. Every cell is fitted for itself, so the number of threads changes nothing.
pub fn table(lobe: Lobe, side: usize) -> Vec<f32> {
    let mut numbers = vec![0.0; side * side * NUMBERS];
    let rows = Mutex::new(numbers.chunks_mut(side * NUMBERS).enumerate());
    let next = || rows.lock().unwrap_or_else(std::sync::PoisonError::into_inner).next();
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, NonZero::get) {
            scope.spawn(|| {
                while let Some((row, cells)) = next() {
                    for (column, numbers) in cells.chunks_mut(NUMBERS).enumerate() {
                        for (number, exact) in numbers.iter_mut().zip(cell(lobe, row, column, side)) {
                            *number = exact as f32;
                        }
                    }
                }
            });
        }
    });
    numbers
}

/// M^-1, A and B from a table, interpolated linearly between four cells.
pub fn look_up(table: &[f32], side: usize, alpha: f64, cosine: f64) -> (DMat3, f64, f64) {
    let last = (side - 1) as f64;
    let alpha = alpha.clamp(SMOOTHEST, 1.0);
    let m = cosine.clamp(0.0, 1.0);
    let (x, y) = ((m * (1.0 + alpha) / (m + alpha)).sqrt() * last, alpha.sqrt() * last);
    let (column, row) = (f64::min(x.floor(), last - 1.0), f64::min(y.floor(), last - 1.0));
    let mut cell = [0.0; NUMBERS];
    for (down, across) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let along = |at: f64, first: f64, second: usize| if second == 0 { 1.0 - (at - first) } else { at - first };
        let weight = along(y, row, down) * along(x, column, across);
        let start = ((row as usize + down) * side + column as usize + across) * NUMBERS;
        for (sum, number) in cell.iter_mut().zip(&table[start..start + NUMBERS]) {
            *sum += weight * f64::from(*number);
        }
    }
    Cosine::of_cell(&cell, alpha, libm::acos(m))
}
