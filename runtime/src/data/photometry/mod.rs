//! Measured luminous intensities: IES LM-63 files and EULUMDAT.
//!
//! Whatever a file leaves to symmetry is written out while it is read, so a [`Photometry`] is a grid of angles over all that was measured. Angles stay
//! where the file has them; between them the intensity is bilinear. Both formats, told apart by their content, go by the name `photometry` among
//! [the formats of data](super::FORMATS).
//!
//! Sources: IESNA LM-63-1986 to LM-63-2002, IES LM-63-2019, IESNA LM-75-01 (goniometers), Stockmar 1990 (EULUMDAT).

mod ies;
mod ldt;
mod text;

use std::f64::consts::TAU;

use text::Text;

/// Most angles of a kind; files have some hundreds at most.
pub const MAX_ANGLES: usize = 4096;
/// Most intensities before symmetry repeats them; files have some thousands.
pub const MAX_INTENSITIES: usize = 1 << 20;

/// Along which direction of the luminaire the polar axis of its angles lies. `direction` is where it points, `across` to its right, `up` is across x direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pole {
    /// Type C, and all of EULUMDAT: angles from `direction` (nadir), azimuths from `across` toward `up`.
    Direction,
    /// Type A: angles from -`up`, 90 degrees above the vertical angle; azimuths are horizontal angles, from `direction` toward `across`.
    Down,
    /// Type B: angles from -`across`, 90 degrees above the horizontal angle; azimuths are vertical angles, from `direction` toward `up`.
    Left,
}

/// Luminous intensities by direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Photometry {
    /// Axis from which `polar` counts.
    pub pole: Pole,
    /// Angles to the pole, rad, increasing, in [0, pi], two at least. Beyond the first and the last there is no light.
    pub polar: Vec<f64>,
    /// Angles around the pole, rad, increasing, two at least. The last is 2 pi after the first, or there is no light between them.
    pub azimuth: Vec<f64>,
    /// Candela, not negative: for each azimuth one for each polar angle.
    pub candela: Vec<f64>,
    /// Luminous flux of the lamps as the file states it, lm; of an absolute measurement there is none.
    pub lamps: Option<f64>,
    /// Extent of the luminous opening along `up`, along `across` and along `direction`, m; for types A and B as the file names them.
    pub opening: [f64; 3],
}

/// Why a file holds no intensities.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct PhotometryError {
    /// Line, counted from 1.
    pub line: usize,
    /// What is wrong with it.
    pub message: String,
}

impl Photometry {
    /// Reads an IES LM-63 or EULUMDAT file. A file with a line that begins with `TILT=` is of the former kind.
    ///
    /// # Errors
    /// The file is cut off, holds a word where a number belongs or a number that cannot be, or says something that is not taken: a tilt other than `NONE`.
    pub fn read(bytes: &[u8]) -> Result<Self, PhotometryError> {
        let text = Text::new(bytes);
        if text.is_ies() { ies::read(&text) } else { ldt::read(&text) }
    }

    /// Luminous flux, lm: the integral over all directions of what is interpolated linearly in both angles, exactly.
    pub fn flux(&self) -> f64 {
        let rows: Vec<f64> = self
            .candela
            .chunks(self.polar.len())
            .map(|row| over_polar(&self.polar, row))
            .collect();
        let pairs = self.azimuth.windows(2).zip(rows.windows(2));
        pairs.map(|(a, row)| (a[1] - a[0]) * (row[0] + row[1]) / 2.0).sum()
    }

    /// What a shader reads: 0, 1 or 2 for the pole, the number of polar angles and of azimuths, the flux in lumen; the polar angles, the azimuths, both
    /// in rad; the intensities in candela as in `candela`.
    pub fn table(&self) -> Vec<f32> {
        let pole = match self.pole {
            Pole::Direction => 0.0,
            Pole::Down => 1.0,
            Pole::Left => 2.0,
        };
        let head = [pole, self.polar.len() as f64, self.azimuth.len() as f64, self.flux()];
        let all = head.iter().chain(&self.polar).chain(&self.azimuth).chain(&self.candela);
        #[allow(clippy::cast_possible_truncation)] // that is what a table of f32 is
        all.map(|x| *x as f32).collect()
    }
}

/// The integral of I(theta) sin(theta) of an intensity that is linear between the angles. Of a piece from a to b, by parts, it is
/// I(a) (cos a - m) + I(b) (m - cos b) with the mean m of the cosine; rounding must not make a share negative.
fn over_polar(angles: &[f64], intensities: &[f64]) -> f64 {
    let pieces = angles.windows(2).zip(intensities.windows(2));
    pieces
        .map(|(t, i)| {
            let mean = (t[1].sin() - t[0].sin()) / (t[1] - t[0]);
            i[0] * (t[0].cos() - mean).max(0.0) + i[1] * (mean - t[1].cos()).max(0.0)
        })
        .sum()
}

/// The decoder of the format `photometry`.
pub(super) fn decode(bytes: &[u8]) -> Result<Vec<f32>, String> {
    Photometry::read(bytes).map(|read| read.table()).map_err(|error| error.to_string())
}

/// A grid around an axis from planes that symmetry has not yet repeated, angles in degrees.
struct Planes {
    polar: Vec<f64>,
    /// Angle and intensities of each plane, by increasing angle within a turn; one at least.
    planes: Vec<(f64, Vec<f64>)>,
}

impl Planes {
    /// Adds the mirror image at the plane of this angle: what is at angle + x is at angle - x too. A plane that is there stays as it is.
    fn mirrored(mut self, at: f64) -> Self {
        let mut images: Vec<(f64, Vec<f64>)> = Vec::new();
        for (angle, row) in &self.planes {
            let image = (2.0 * at - angle).rem_euclid(360.0);
            let near = |other: f64| {
                let apart = (image - other).rem_euclid(360.0);
                apart.min(360.0 - apart) < 1e-6
            };
            if !self.planes.iter().chain(&images).any(|(other, _)| near(*other)) {
                images.push((image, row.clone()));
            }
        }
        self.planes.extend(images);
        self.planes.sort_by(|a, b| a.0.total_cmp(&b.0));
        self
    }

    /// The whole turn. A plane a turn after the first is the first: they get their mean, as do all planes at the poles, where all meet.
    fn closed(mut self) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let first = self.planes[0].0;
        let last = self.planes.len() - 1;
        if last > 0 && self.planes[last].0 - first > 360.0 - 1e-6 {
            let (_, again) = self.planes.remove(last);
            for (one, other) in self.planes[0].1.iter_mut().zip(again) {
                *one = f64::midpoint(*one, other);
            }
        }
        for (index, angle) in self.polar.iter().enumerate() {
            if *angle == 0.0 || *angle == 180.0 {
                let mean = self.planes.iter().map(|(_, row)| row[index]).sum::<f64>() / self.planes.len() as f64;
                self.planes.iter_mut().for_each(|(_, row)| row[index] = mean);
            }
        }
        let start = self.planes[0].clone();
        self.planes.push((first + 360.0, start.1));
        self.open()
    }

    /// Only what is there.
    fn open(self) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let radians = |degrees: &f64| degrees / 360.0 * TAU;
        let azimuth = self.planes.iter().map(|(angle, _)| radians(angle)).collect();
        let candela = self.planes.into_iter().flat_map(|(_, row)| row).collect();
        (self.polar.iter().map(radians).collect(), azimuth, candela)
    }
}

#[cfg(test)]
mod tests;
