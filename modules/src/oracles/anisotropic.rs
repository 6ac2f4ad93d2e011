//! Lobes of anisotropic GGX as linearly transformed cosines (Kt, Heitz, Dupuy and Narayanan 2022), in a table over two widths and two angles.
//!
//! What is fitted, and what is minimised, is told in [`cosines`](super::cosines); here a map has all its numbers. Two maps are one cosine if they differ by a turn about
//! its axis or by a factor, so seven numbers are free. They are told in the space of half vectors, along the axes of the facets' ellipse:
//!
//! ```text
//! M = U [ (x, x', 0) + x" Z | (0, y, 0) + y" Z | Z ],    Z = (z, z', z"),    U = [ 2 (c f - n d s) | 2 (d f + n c s) | axis ]
//! ```
//!
//! whose determinant is that of U times x y z": positive between cells as it is in them, so no map turns a light inside out;
//! c and d are the cosine and sine of the view's azimuth from the wider width's direction, s across the plane of incidence, n = cos(theta) + a for the
//! width a in that plane, the axis the mirrored view bent toward the normal by a^2, and f across both. For smooth facets x and y are the two widths
//! and all others vanish. Divided by what they vanish with the numbers are smooth and of the order 1, and few cells do.

use std::f64::consts::PI;
use std::num::NonZero;
use std::sync::{Mutex, PoisonError};
use std::thread;

use glam::{DMat2, DMat3, DVec2, DVec3};

use super::cosines::{Cosine, Sample, descend};
use super::drawn::{Widths, ggx, ggx_anisotropic};

/// Numbers of a cell: x, x', x", y, y", z, z', z" (the map's determinant is 1 in them), A, and B less what level facets would have. See `View::cell`.
pub const NUMBERS: usize = 10;

/// Cells along the wider width, the narrower over it, the azimuth, the angle of incidence. The last is where lobes change.
pub const SIDES: [usize; 4] = [7, 5, 5, 16];

/// Roots of the smallest wider width and of the smallest ratio of a table. Beyond them its numbers stay what they are.
const SMOOTHEST: f64 = 0.05;
const THINNEST: f64 = 0.125;
/// Angles of incidence a table's ends stand for, radians, and how far from its ends an azimuth's cell is: there numbers are 0 / 0.
const STEEPEST: f64 = 0.1;
const FLATTEST: f64 = 1.570_795;
const ASIDE: f64 = 0.02;
/// Strata of the samples in each dimension.
const STRATA: usize = 64;
/// Half spaces; a lobe between the axes has no symmetry.
const HALF_SPACES: usize = 600;
/// How much wider than the lobe's narrowest the half spaces are spread, each as many.
const SPREADS: [f64; 4] = [1.0, 4.0, 16.0, 64.0];
/// Weight of a half space, as in [`cosines`](super::cosines).
const UNIFORMITY: f64 = 0.75;
/// What a number may cost by its distance from where the fit began. A smooth lobe is indifferent to where its cosine is clipped; its
/// neighbours in the table are not.
const RIDGE: f64 = 1e-4;

/// What a lobe is seen by.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The wider width.
    pub major: f64,
    /// The narrower width over it.
    pub ratio: f64,
    /// Cosine and sine of the view's azimuth from the direction of the wider width.
    pub azimuth: (f64, f64),
    /// Angle of incidence, radians.
    pub theta: f64,
}

/// A map's numbers before they are divided: ln x, x', x", ln y, y", z, z' for z" = 1, and ln A.
type Parameters = [f64; 8];

/// A half space, and what the lobe's integral over it is.
struct HalfSpace {
    n: DVec3,
    root_weight: f64,
    integral: f64,
}

/// What a map's numbers are multiplied with.
struct Basis {
    axes: DMat3,
    major: f64,
    minor: f64,
    skew: f64,
}

impl Basis {
    fn map(&self, at: &Parameters) -> DMat3 {
        let z = DVec3::new(at[5] * self.skew, at[6] * self.skew, 1.0);
        let x = DVec3::new(libm::exp(at[0]) * self.major, at[1] * self.major, 0.0) + z * (at[2] * self.skew);
        let y = DVec3::new(0.0, libm::exp(at[3]) * self.minor, 0.0) + z * (at[4] * self.skew);
        self.axes * DMat3::from_cols(x, y, z)
    }

    /// [`Self::map`] undone, with the whole lobe's integral.
    fn parameters(&self, map: &DMat3, whole: f64) -> Parameters {
        let inner = self.axes.inverse() * *map;
        let scale = 1.0 / inner.z_axis.z;
        let z = inner.z_axis * scale;
        // What they have of z, in the place of their last number.
        let level = |column: DVec3| (column - z * column.z).truncate().extend(column.z) * scale;
        let (x, y) = (level(inner.x_axis), level(inner.y_axis));
        let (p, q) = (x.x, y.x);
        let turned = 1.0 / (p * p + q * q).sqrt();
        let (x, y) = ((x * p + y * q) * turned, (y * p - x * q) * turned);
        let z = z / self.skew;
        let logs = (libm::log(x.x / self.major), libm::log(y.y / self.minor));
        [
            logs.0,
            x.y / self.major,
            x.z / self.skew,
            logs.1,
            y.z / self.skew,
            z.x,
            z.y,
            libm::log(whole),
        ]
    }
}

/// The isotropic lobe's inverse map undone on the ellipse of the facets' slopes: what stretches the facets stretches a smooth lobe alike.
pub fn stretched(inverse: DMat3, widths: &Widths) -> DMat3 {
    let Widths { along, skew, across } = *widths;
    let x = DVec3::new(1.0, -skew / across, 0.0);
    DMat3::from_cols(x, DVec3::Y * (along / across), DVec3::Z) * inverse
}

/// (1 - m)^5: what all facets would add to f0 = 0 if they lay level. Schlick 1994, eq. 15.
fn level(m: f64) -> f64 {
    let c = 1.0 - m;
    (c * c) * (c * c) * c
}

impl View {
    /// The widths in the view's frame, x toward the viewer.
    pub fn widths(&self) -> Widths {
        Widths::seen(self.major, self.major * self.ratio, self.azimuth)
    }

    /// How thick a thin lobe is, besides its facets: mirrored across the plane of incidence it is an arc, more so at grazing angles.
    fn basis(&self) -> Basis {
        let (sine, m) = (libm::sin(self.theta), libm::cos(self.theta));
        let a = self.widths().along;
        let narrow = m + a;
        let axis = DVec3::new(-sine, 0.0, m + a * a).normalize();
        let forward = DVec3::new(axis.z, 0.0, -axis.x);
        let (c, d) = self.azimuth;
        let first = (forward * c - DVec3::Y * (narrow * d)) * 2.0;
        let second = (forward * d + DVec3::Y * (narrow * c)) * 2.0;
        let grazing = a / narrow;
        let arc = 0.5 * self.major * sine * m + 2.0 * c.abs() * grazing * grazing * (1.0 - 0.7 * self.major);
        Basis {
            axes: DMat3::from_cols(first, second, axis),
            major: self.major,
            minor: self.major * (self.ratio + d.abs() * arc),
            skew: self.major * sine / narrow,
        }
    }

    /// What a cell of the table stands for.
    fn of_cell(index: [usize; 4], sides: [usize; 4]) -> Self {
        let at: [f64; 4] = std::array::from_fn(|i| index[i] as f64 / (sides[i] - 1) as f64);
        let root = |least: f64, share: f64| least + (1.0 - least) * share;
        let (rough, thin) = (root(SMOOTHEST, at[0]), root(THINNEST, at[1]));
        let (major, ratio) = (rough * rough, thin * thin);
        let toward = at[2].clamp(ASIDE, 1.0 - ASIDE);
        let square = toward * (2.0 * ratio + toward * (1.0 - ratio)) / (1.0 + ratio);
        let place = at[3] * at[3];
        let cosine = place * 0.5 * rough / (1.0 + 0.5 * rough - place);
        Self {
            major,
            ratio,
            azimuth: (square.sqrt(), (1.0 - square).sqrt()),
            theta: libm::acos(f64::min(cosine, 1.0)).clamp(STEEPEST, FLATTEST),
        }
    }

    /// Where it is in a table, 0 to 1 along each side: roots of the widths; how wide the facets are toward the viewer, between both widths; the root of
    /// m (1 + k) / (m + k), m the cosine of the angle of incidence and k half the root of the wider width.
    fn place(&self) -> [f64; 4] {
        let (c, d) = self.azimuth;
        let wide = (c * c + self.ratio * self.ratio * d * d).sqrt();
        let rough = self.major.sqrt();
        let m = libm::cos(self.theta);
        let share = |root: f64, least: f64| ((root - least) / (1.0 - least)).clamp(0.0, 1.0);
        [
            share(rough, SMOOTHEST),
            share(self.ratio.sqrt(), THINNEST),
            (c * c * (1.0 + self.ratio) / (wide + self.ratio)).clamp(0.0, 1.0),
            (m * (1.0 + 0.5 * rough) / (m + 0.5 * rough)).sqrt().clamp(0.0, 1.0),
        ]
    }

    /// What a table holds of a fit. By the ellipse's symmetry what changes sign with c or d vanishes with them, so it is divided by them.
    fn cell(&self, at: &Parameters, fresnel: f64) -> [f64; NUMBERS] {
        let (c, d) = self.azimuth;
        let (x, y, amplitude) = (libm::exp(at[0]), libm::exp(at[3]), libm::exp(at[7]));
        let scale = 1.0 / libm::cbrt(x * y);
        [
            x * scale,
            at[1] * scale / (c * d),
            at[2] / c,
            y * scale,
            at[4] / d,
            at[5] * scale / c,
            at[6] * scale / d,
            scale,
            amplitude,
            amplitude * (fresnel - level(libm::cos(self.theta))),
        ]
    }

    /// [`Self::cell`] undone: M^-1 for offsets in the frame of the plane of incidence, A and B.
    fn map(&self, cell: &[f64; NUMBERS]) -> (DMat3, f64, f64) {
        let Basis { axes, major, minor, skew } = self.basis();
        let (c, d) = self.azimuth;
        let z = DVec3::new(cell[5] * skew * c, cell[6] * skew * d, cell[7]);
        let x = DVec3::new(cell[0] * major, cell[1] * major * c * d, 0.0) + z * (cell[2] * skew * c);
        let y = DVec3::new(0.0, cell[3] * minor, 0.0) + z * (cell[4] * skew * d);
        let map = axes * DMat3::from_cols(x, y, z);
        let grazing = f64::max(cell[9] + cell[8] * level(libm::cos(self.theta)), 0.0);
        (map.inverse(), cell[8], grazing)
    }

    /// Fits the lobe, from the isotropic one's map stretched and, where that is given, from a neighbour's: the numbers, and B over A.
    fn fit(&self, near: Option<&Parameters>) -> (Parameters, f64) {
        let widths = self.widths();
        let v = DVec3::new(libm::sin(self.theta), 0.0, libm::cos(self.theta));
        let samples = ggx_anisotropic(widths, v, STRATA);
        let whole: f64 = samples.iter().map(|sample| sample.weight).sum();
        let fresnel: f64 = samples.iter().map(|sample| sample.fresnel).sum();
        let map = stretched(Cosine::fit(ggx, widths.along, self.theta).inverse(), &widths).inverse();
        let spaces = half_spaces(&map, &samples);
        let basis = self.basis();
        let mut best = descend_from(&basis, basis.parameters(&map, whole), &spaces, whole);
        if let Some(near) = near {
            let mut from = *near;
            from[7] = libm::log(whole);
            let other = descend_from(&basis, from, &spaces, whole);
            if other.1 < best.1 {
                best = other;
            }
        }
        // A share; the fit may want a hundredth more.
        best.0[7] = f64::min(best.0[7], 0.0);
        (best.0, fresnel / whole)
    }

    /// M^-1, A and B of the lobe's own fit, what a table without end would hold.
    pub fn fitted(&self) -> (DMat3, f64, f64) {
        let (at, fresnel) = self.fit(None);
        let amplitude = libm::exp(at[7]);
        (self.basis().map(&at).inverse(), amplitude, amplitude * fresnel)
    }
}

/// Differences of the integrals over each half space and its complement, and what the numbers' ways cost, squared and summed.
fn descend_from(basis: &Basis, from: Parameters, spaces: &[HalfSpace], whole: f64) -> (Parameters, f64) {
    descend(from, |at, out| {
        let transposed = basis.map(at).transpose();
        let amplitude = libm::exp(at[7]);
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
        for (at, from) in at.iter().zip(&from).take(7) {
            let way = RIDGE * (at - from);
            sum += way * way;
            out.push(way);
        }
        sum
    })
}

/// The lobe of a map wider in steps: its ellipse goes toward the circle of the cosine itself, until its narrowest is as much wider.
fn widened(map: &DMat3) -> [DMat3; 4] {
    let length = map.z_axis.length();
    let axis = map.z_axis / length;
    let first = DVec3::Y.cross(axis).normalize();
    let second = axis.cross(first);
    let flat = |v: DVec3| DVec2::new(v.dot(first), v.dot(second)) / length;
    let (a, b) = (flat(map.x_axis), flat(map.y_axis));
    let square = DMat2::from_cols(a * a.x + b * b.x, a * a.y + b * b.y);
    let half = 0.5 * (square.x_axis.x + square.y_axis.y);
    let area = a.perp_dot(b) * a.perp_dot(b);
    let least = area / (half + f64::max(half * half - area, 0.0).sqrt());
    SPREADS.map(|factor| {
        let share = if least < 1.0 {
            f64::min((factor * factor - 1.0) * least / (1.0 - least), 1.0)
        } else {
            0.0
        };
        let wider = square * (1.0 - share) + DMat2::IDENTITY * share;
        let along = wider.x_axis.x.sqrt();
        let skew = wider.x_axis.y / along;
        let across = f64::max(wider.y_axis.y - skew * skew, 1e-30).sqrt();
        DMat3::from_cols(first * along + second * skew, second * across, axis)
    })
}

/// Half spaces spread evenly over those of the spaces in which the map's lobe, widened in steps, is the cosine.
fn half_spaces(map: &DMat3, samples: &[Sample]) -> Vec<HalfSpace> {
    let wider = widened(map);
    let maps = wider.map(|map| map.transpose());
    let inverses = wider.map(|map| map.inverse().transpose());
    let density = |n: DVec3| {
        let of = |map: &DMat3| {
            let length = (*map * n).length();
            map.determinant() / (length * length * length)
        };
        maps.iter().map(of).sum::<f64>()
    };
    let mut sum = 0.0;
    let space = |index: usize| {
        let at = index as f64 + 0.5;
        let z = at / HALF_SPACES as f64;
        // The golden section spreads them.
        let around = at * 0.618_033_988_749_894_9;
        let phi = 2.0 * PI * (around - libm::floor(around));
        let sine = (1.0 - z * z).sqrt();
        let m = DVec3::new(sine * libm::cos(phi), sine * libm::sin(phi), z);
        let n = (inverses[index % SPREADS.len()] * m).normalize();
        let weight = libm::pow(density(n), -UNIFORMITY);
        sum += weight;
        let inside = samples.iter().filter(|sample| sample.l.dot(n) > 0.0);
        HalfSpace {
            n,
            root_weight: weight,
            integral: inside.map(|sample| sample.weight).sum(),
        }
    };
    let mut spaces: Vec<_> = (0..HALF_SPACES).map(space).collect();
    for space in &mut spaces {
        space.root_weight = (space.root_weight / sum).sqrt();
    }
    spaces
}

/// The cells of one wider width, ratio and azimuth, from the horizon up. Each is fitted from its neighbour nearer to the normal as well.
pub fn row(index: [usize; 3], sides: [usize; 4]) -> Vec<[f64; NUMBERS]> {
    let mut cells = vec![[0.0; NUMBERS]; sides[3]];
    let mut near = None;
    for (column, cell) in cells.iter_mut().enumerate().rev() {
        let view = View::of_cell([index[0], index[1], index[2], column], sides);
        let (at, fresnel) = view.fit(near.as_ref());
        *cell = view.cell(&at, fresnel);
        near = Some(at);
    }
    cells
}

/// The whole table, [`NUMBERS`] a cell, the angle of incidence running fastest. Every row is fitted for itself, so the number of threads changes nothing.
pub fn table(sides: [usize; 4]) -> Vec<f32> {
    let mut numbers = vec![0.0; sides.iter().product::<usize>() * NUMBERS];
    let rows = Mutex::new(numbers.chunks_mut(sides[3] * NUMBERS).enumerate());
    let next = || rows.lock().unwrap_or_else(PoisonError::into_inner).next();
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, NonZero::get) {
            scope.spawn(|| {
                while let Some((at, numbers)) = next() {
                    let index = [at / sides[2] / sides[1], at / sides[2] % sides[1], at % sides[2]];
                    for (number, exact) in numbers.iter_mut().zip(row(index, sides).as_flattened()) {
                        *number = *exact as f32;
                    }
                }
            });
        }
    });
    numbers
}

/// M^-1 in the frame of the plane of incidence, A and B from a table, between the five corners of the simplex that holds the place (Kuhn 1960).
pub fn look_up(table: &[f32], sides: [usize; 4], view: &View) -> (DMat3, f64, f64) {
    let place = view.place();
    let strides = [sides[1] * sides[2] * sides[3], sides[2] * sides[3], sides[3], 1];
    let mut at = 0;
    let mut ways = [(0.0, 0); 4];
    for index in 0..4 {
        let along = place[index] * (sides[index] - 1) as f64;
        let corner = f64::min(along.floor(), (sides[index] - 2) as f64);
        at += strides[index] * corner as usize;
        ways[index] = (along - corner, strides[index]);
    }
    ways.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut cell = [0.0; NUMBERS];
    let mut before = 1.0;
    for (share, stride) in ways.into_iter().chain([(0.0, 0)]) {
        for (sum, number) in cell.iter_mut().zip(&table[at * NUMBERS..]) {
            *sum += (before - share) * f64::from(*number);
        }
        before = share;
        at += stride;
    }
    view.map(&cell)
}
