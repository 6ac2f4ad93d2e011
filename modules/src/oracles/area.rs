//! Form factors of luminous shapes: illuminance over pi times luminance of a small plane at the origin, whose horizon cuts them off.
//!
//! Everything here is one formula, the sum over the edges of an outline that is clipped first (Lambert 1760; Baum et al. 1989). Outlines
//! that are curved are polygons with thousands of corners.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

/// Corners of a curved outline. With their distance corrected to give the right area, the error is of the fourth order: 1e-11.
const CORNERS: usize = 2048;

/// Of a polygon, seen from either side. The corners need not lie in a plane.
pub fn polygon(corners: &[DVec3], normal: DVec3) -> f64 {
    let clipped = above_horizon(corners, normal);
    let edges = clipped.iter().zip(clipped.iter().cycle().skip(1));
    let sum: f64 = edges.map(|(p, q)| edge(*p, *q).dot(normal)).sum();
    (sum / TAU).abs()
}

/// Angle that an edge subtends, along the normal of the plane through it and the origin.
fn edge(p: DVec3, q: DVec3) -> DVec3 {
    let across = p.cross(q);
    let sine = across.length();
    if sine == 0.0 {
        return DVec3::ZERO;
    }
    across * (sine.atan2(p.dot(q)) / sine)
}

/// Sutherland and Hodgman 1974, at the plane through the origin.
fn above_horizon(corners: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(corners.len() + 2);
    for (p, q) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (from, to) = (p.dot(normal), q.dot(normal));
        if from >= 0.0 {
            kept.push(*p);
        }
        if (from >= 0.0) != (to >= 0.0) {
            kept.push(*p + (*q - *p) * (from / (from - to)));
        }
    }
    kept
}

/// Of an ellipse with a centre and two conjugate half axes.
pub fn ellipse(c: DVec3, a: DVec3, b: DVec3, normal: DVec3) -> f64 {
    let step = TAU / CORNERS as f64;
    let out = (step / step.sin()).sqrt();
    let corner = |k: usize| {
        let (sine, cosine) = (step * k as f64).sin_cos();
        c + (a * cosine + b * sine) * out
    };
    polygon(&(0..CORNERS).map(corner).collect::<Vec<_>>(), normal)
}

/// Of a sphere: of its rim. A point inside sees what one on it sees: the half space toward the centre.
pub fn sphere(c: DVec3, radius: f64, normal: DVec3) -> f64 {
    let distance = c.length();
    if distance <= radius {
        let cosine = if distance > 0.0 { c.dot(normal) / distance } else { 0.0 };
        return 0.5 * (1.0 + cosine);
    }
    let sine = radius / distance;
    let rim = radius * (1.0 - sine * sine).sqrt();
    let (a, b) = (c / distance).any_orthonormal_pair();
    ellipse(c * (1.0 - sine * sine), a * rim, b * rim, normal)
}

/// Of a disk, seen from the side to which its normal points, or from either.
pub fn disk(c: DVec3, axis: DVec3, radius: f64, normal: DVec3, two_sided: bool) -> f64 {
    let front = -c.dot(axis);
    if front == 0.0 || front < 0.0 && !two_sided {
        return 0.0;
    }
    let (a, b) = axis.any_orthonormal_pair();
    ellipse(c, a * radius, b * radius, normal)
}

/// Columns: directions of width and height of a flat light, and its normal.
pub fn plane_axes(direction: DVec3, right: DVec3) -> DMat3 {
    let normal = direction.normalize_or(DVec3::Z);
    let width = (right - normal * right.dot(normal)).normalize_or(normal.any_orthonormal_vector());
    DMat3::from_cols(width, normal.cross(width), normal)
}

/// Of a flat polygon with corners in its plane, seen from the front or from either side.
pub fn flat(c: DVec3, axes: DMat3, corners: &[(f64, f64)], normal: DVec3, two_sided: bool) -> f64 {
    let front = -c.dot(axes.z_axis);
    if front == 0.0 || front < 0.0 && !two_sided {
        return 0.0;
    }
    let corners: Vec<_> = corners.iter().map(|(x, y)| c + axes.x_axis * *x + axes.y_axis * *y).collect();
    polygon(&corners, normal)
}

/// Of the outside of a tube, with or without the cap of the end that is seen.
pub fn tube(c: DVec3, along: DVec3, length: f64, radius: f64, normal: DVec3, caps: bool) -> f64 {
    let axis = along.normalize_or(DVec3::X);
    let half = axis * (0.5 * length);
    let foot = c - axis * c.dot(axis);
    let away = foot.length();
    let mut sum = 0.0;
    if away > radius {
        let toward = -foot / away;
        let aside = axis.cross(toward);
        let last = (radius / away).acos();
        let at = |k: usize| {
            let (sine, cosine) = (last * (2.0 * k as f64 / CORNERS as f64 - 1.0)).sin_cos();
            c + (toward * cosine + aside * sine) * radius
        };
        let there = (0..=CORNERS).map(|k| at(k) + half);
        let back = (0..=CORNERS).rev().map(|k| at(k) - half);
        sum += polygon(&there.chain(back).collect::<Vec<_>>(), normal);
    }
    if caps {
        for end in [half, -half] {
            sum += disk(c + end, end.normalize_or(DVec3::X), radius, normal, false);
        }
    }
    sum
}

/// Luminance of a light with a luminance, cd/m2, or where there is one a flux, lm, spread over an area, m2: phi / (pi A).
pub fn luminance(luminance: f64, flux: f64, area: f64) -> f64 {
    if flux > 0.0 { flux / (PI * area) } else { luminance }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn near(got: f64, expected: f64, relative: f64) {
        assert!(
            (got - expected).abs() <= relative * expected.abs().max(1e-12),
            "{got} is not {expected}"
        );
    }

    fn at(degrees: f64, distance: f64) -> DVec3 {
        let angle = degrees.to_radians();
        DVec3::new(angle.sin(), 0.0, angle.cos()) * distance
    }

    fn square(c: DVec3, direction: DVec3, size: (f64, f64)) -> f64 {
        let (x, y) = (size.0 / 2.0, size.1 / 2.0);
        let axes = plane_axes(direction, DVec3::X);
        flat(c, axes, &[(-x, -y), (x, -y), (x, y), (-x, y)], DVec3::Z, false)
    }

    /// Catches an edge that is left out, a wrong factor, a clip at the wrong side, digits lost by small and thin lights.
    #[test]
    fn polygons() {
        near(polygon(&[DVec3::X, DVec3::Y, DVec3::Z], DVec3::Z), 0.25, 1e-14);
        near(square(DVec3::Z, -DVec3::Z, (1.0, 1.0)), 0.239_456_470_461, 1e-11);
        near(square(DVec3::Z * 1e-4, -DVec3::Z, (1.0, 1.0)), 0.999_999_967_268, 1e-11);
        near(square(DVec3::Z * 100.0, -DVec3::Z, (1e-3, 1e-3)), 3.183_098_861_73e-11, 1e-6);
        near(square(DVec3::Z, -DVec3::Z, (1.0, 1e-7)), 2.749_075_72e-8, 1e-7);
        let axes = plane_axes(-DVec3::X, DVec3::Y);
        let wall = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        near(flat(DVec3::X, axes, &wall, DVec3::Z, false), 0.111_468_394_005, 1e-11);
        let turned = |degrees: f64| {
            let c = at(degrees, 1.0);
            let c = DVec3::new(0.0, -c.x, c.z);
            square(c, -c, (2.0, 2.0))
        };
        near(turned(60.0), 0.289_365_194, 1e-8);
        near(turned(100.0), 0.067_873_221, 1e-8);
        near(square(-DVec3::Z, DVec3::Z, (1.0, 1.0)), 0.0, 0.0);
        near(square(DVec3::Z, DVec3::Z, (1.0, 1.0)), 0.0, 0.0);
    }

    /// Catches a rim at the wrong place, a chord taken for its arc, the horizon's part of the outline left out.
    #[test]
    fn curved_shapes() {
        near(sphere(at(80.0, 2.0), 1.0, DVec3::Z), 0.054_695_816, 2e-8);
        near(sphere(at(90.0, 2.0), 1.0, DVec3::Z), 0.028_834_443, 2e-8);
        near(sphere(at(100.0, 2.0), 1.0, DVec3::Z), 0.011_283_772, 5e-8);
        near(sphere(at(90.0, 100.0), 1.0, DVec3::Z), 2.122_129_57e-7, 1e-7);
        near(sphere(at(120.0, 1.0), 0.999, DVec3::Z), 0.225_855_213, 1e-7);
        near(sphere(at(120.0, 1.0), 1.5, DVec3::Z), 0.25, 1e-12);
        near(disk(DVec3::Z, -DVec3::Z, 1.0, DVec3::Z, false), 0.5, 1e-9);
        near(
            disk(DVec3::new(2.0, 0.0, 1.0), -DVec3::Z, 1.0, DVec3::Z, false),
            0.052_786_404_5,
            1e-9,
        );
        near(tube(DVec3::Z, DVec3::X, 1.0, 1e-6, DVec3::Z, false), 0.549_815_144e-6, 1e-6);
        near(tube(DVec3::Z, DVec3::X, 1e6, 1e-3, DVec3::Z, false), 1e-3, 1e-6);
        near(tube(DVec3::Z, DVec3::Z, 1.0, 0.5, DVec3::Z, true), 0.5, 1e-9);
        near(tube(DVec3::Z, DVec3::Z, 1.0, 0.5, DVec3::Z, false), 0.0, 0.0);
    }

    /// Catches the flux over the area instead of over pi times the area.
    #[test]
    fn flux() {
        near(luminance(0.0, 800.0, 4.0 * PI * 0.05 * 0.05), 8_105.694_69, 1e-8);
    }
}
