//! The module's own table, looked up in double precision: angles and rotations as in the papers, arcs from the standard library.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DQuat;

use crate::oracles::lobes::{cosine_density, lit, local};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// The file that the module has where nobody names another.
const FILE: &[u8] = include_bytes!("sample.binary");

/// Matusik et al. 2003, with Rusinkiewicz's angles.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else { return vec![0.0; 3] };
    let (v, l) = (local(at, lit.v).normalize(), local(at, lit.l).normalize());
    let h = (v + l).normalize();
    let (theta_h, phi_h) = (h.truncate().length().atan2(h.z), h.y.atan2(h.x));
    // The light, where the half vector is the z axis.
    let d = DQuat::from_rotation_y(-theta_h) * (DQuat::from_rotation_z(-phi_h) * l);
    let (theta_d, phi_d) = (d.truncate().length().atan2(d.z), d.y.atan2(d.x).rem_euclid(PI));
    let table = Table::of(FILE);
    (0..3).map(|channel| table.at(channel, theta_h, theta_d, phi_d)).collect()
}

struct Table<'a> {
    sizes: [usize; 3],
    numbers: &'a [u8],
}

impl<'a> Table<'a> {
    fn of(file: &'a [u8]) -> Self {
        let size = |i: usize| i32::from_le_bytes([file[4 * i], file[4 * i + 1], file[4 * i + 2], file[4 * i + 3]]) as usize;
        Self {
            sizes: [size(0), size(1), size(2)],
            numbers: &file[12..],
        }
    }

    /// A cell's value; where nothing was measured, that of the next smaller theta_d.
    fn cell(&self, channel: usize, h: usize, d: usize, p: usize) -> f64 {
        let [hs, ds, ps] = self.sizes;
        let number = |channel: usize| {
            let at = 8 * (((channel * hs + h) * ds + d) * ps + p);
            self.numbers[at..at + 8].try_into().map_or(f64::NAN, f64::from_le_bytes)
        };
        if (0..3).all(|channel| number(channel) >= 0.0) {
            number(channel) * [1.0, 1.15, 1.66][channel] / 1500.0
        } else if d > 0 {
            self.cell(channel, h, d - 1, p)
        } else {
            0.0
        }
    }

    /// At a point of theta_h and of theta_d, number 0 at an angle of 0, where the mean over phi_d stands, the others in the middles of the cells.
    fn point(&self, channel: usize, h: usize, d: usize, p: usize) -> f64 {
        let cell = |p: usize| self.cell(channel, h.saturating_sub(1), d.saturating_sub(1), p);
        if h > 0 && d > 0 {
            return cell(p);
        }
        (0..self.sizes[2]).map(cell).sum::<f64>() / self.sizes[2] as f64
    }

    fn at(&self, channel: usize, theta_h: f64, theta_d: f64, phi_d: f64) -> f64 {
        // Where the points stand, in cells: 0, 0.5, 1.5, ...
        let place = |u: f64, size: usize| {
            let stands = |i: usize| if i == 0 { 0.0 } else { i as f64 - 0.5 };
            let x = (u * size as f64).min(stands(size));
            let low = (0..size).rev().find(|i| stands(*i) <= x).unwrap_or(0);
            (low, (x - stands(low)) / (stands(low + 1) - stands(low)))
        };
        let (h, part_h) = place((theta_h / FRAC_PI_2).sqrt(), self.sizes[0]);
        let (d, part_d) = place(theta_d / FRAC_PI_2, self.sizes[1]);
        let count = self.sizes[2];
        let turn = phi_d / PI * count as f64 - 0.5;
        let (before, after) = ((turn.floor() as i64).rem_euclid(count as i64) as usize, (turn.ceil() as i64).rem_euclid(count as i64) as usize);
        let part_p = turn - turn.floor();
        let mix = |a: f64, b: f64, part: f64| a + (b - a) * part;
        let row = |h: usize, d: usize| mix(self.point(channel, h, d, before), self.point(channel, h, d, after), part_p);
        let plane = |h: usize| mix(row(h, d), row(h, d + 1), part_d);
        mix(plane(h), plane(h + 1), part_h)
    }
}

/// By the cosine.
fn brdf_pdf(at: &At) -> Vec<f64> {
    vec![cosine_density(at)]
}
