//! Rectangles of uniform luminance 1, what a surface mirrors of them by quadrature in double precision, and by Lambert's contour of the
//! rectangle moved by M^-1.
#![allow(dead_code)]

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

/// Lights of one roughness.
pub const LIGHTS: usize = 360;

/// Steele, Lea and Flood 2014, splitmix64.
pub struct Random(pub u64);

impl Random {
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * ((z >> 11) as f64 / (1_u64 << 53) as f64)
    }

    pub fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let phi = self.between(0.0, 2.0 * PI);
        let sine = f64::max(1.0 - z * z, 0.0).sqrt();
        DVec3::new(sine * phi.cos(), sine * phi.sin(), z)
    }
}

pub struct Light {
    /// Angle of incidence of the view, radians.
    pub theta: f64,
    pub corners: [DVec3; 4],
}

/// Views of all angles, every second one beyond 60 degrees; rectangles of 0.4 to 3 m with any orientation, half of them in a box around the point,
/// half about the mirrored view, many across the horizon.
pub fn lights() -> Vec<Light> {
    let mut random = Random(20);
    let mut lights = Vec::new();
    while lights.len() < LIGHTS {
        let kind = lights.len();
        let degrees = if kind % 2 == 0 {
            random.between(0.0, 89.5)
        } else {
            random.between(60.0, 89.9)
        };
        let theta = degrees.to_radians();
        let centre = if kind % 4 < 2 {
            let aside = random.direction();
            let spread = random.between(0.0, 0.8);
            let mirror = DVec3::new(-theta.sin(), 0.0, theta.cos());
            (mirror + aside * spread).normalize() * random.between(0.5, 3.0)
        } else {
            DVec3::new(random.between(-3.0, 3.0), random.between(-3.0, 3.0), random.between(-0.5, 3.0))
        };
        let normal = random.direction();
        let width = normal.cross(random.direction()).normalize();
        let height = normal.cross(width);
        let (a, b) = (width * random.between(0.2, 1.5), height * random.between(0.2, 1.5));
        let corners = [centre - a - b, centre + a - b, centre + a + b, centre - a + b];
        if corners.iter().any(|corner| corner.z > 0.0) && centre.length() >= 0.3 {
            lights.push(Light { theta, corners });
        }
    }
    lights
}

/// What is above the plane z = 0.
fn above(polygon: &[DVec3]) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (index, &a) in polygon.iter().enumerate() {
        let b = polygon[(index + 1) % polygon.len()];
        if a.z >= 0.0 {
            kept.push(a);
        }
        if (a.z >= 0.0) != (b.z >= 0.0) {
            let cut = a + (b - a) * (a.z / (a.z - b.z));
            kept.push(DVec3::new(cut.x, cut.y, 0.0));
        }
    }
    kept
}

/// Lambert 1760: integral of the cosine over a polygon above the horizon, over pi.
fn form_factor(polygon: &[DVec3]) -> f64 {
    let polygon = above(polygon);
    let edge = |index: usize| {
        let (a, b) = (polygon[index], polygon[(index + 1) % polygon.len()]);
        let across = a.cross(b);
        let sine = across.length();
        if sine == 0.0 { 0.0 } else { sine.atan2(a.dot(b)) * across.z / sine }
    };
    (0..polygon.len()).map(edge).sum::<f64>().abs() / (2.0 * PI)
}

/// Integrals of the lobe over a planar quadrangle by Gauss and Legendre's five points in each direction, in quarters where they disagree.
pub struct Quadrature<'a> {
    /// f cos(theta_l) for F = 1.
    density: &'a dyn Fn(DVec3) -> f64,
    /// Of the lobe's facets.
    narrowest: f64,
    widest: f64,
    mirror: DVec3,
    normal: DVec3,
}

impl<'a> Quadrature<'a> {
    const POINTS: [(f64, f64); 5] = [
        (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];

    fn once(&self, [a, b, c, d]: [DVec3; 4]) -> f64 {
        let mut sum = 0.0;
        for (x, wx) in Self::POINTS {
            for (y, wy) in Self::POINTS {
                let (s, t) = (0.5 + 0.5 * x, 0.5 + 0.5 * y);
                let point = a.lerp(b, s).lerp(d.lerp(c, s), t);
                let area = (b - a).lerp(c - d, t).cross((d - a).lerp(c - b, s)).length();
                let square = point.length_squared();
                let l = point / square.sqrt();
                sum += 0.25 * wx * wy * area * self.normal.dot(l).abs() / square * (self.density)(l);
            }
        }
        sum
    }

    fn refined(&self, [a, b, c, d]: [DVec3; 4], whole: f64, depth: u32) -> f64 {
        let (ab, bc, cd, da) = (a.midpoint(b), b.midpoint(c), c.midpoint(d), d.midpoint(a));
        let middle = ab.midpoint(cd);
        let quarters = [[a, ab, middle, da], [ab, b, bc, middle], [middle, bc, c, cd], [da, middle, cd, d]];
        let parts = quarters.map(|quarter| self.once(quarter));
        let sum: f64 = parts.iter().sum();
        // A narrow lobe may be between all points: what is near its middle is divided until it is as small as the lobe.
        let size = (c - a).length().max((d - b).length()) / middle.length();
        let hides = size > 2.0 * self.narrowest && (middle.normalize() - self.mirror).length() < size + 10.0 * self.widest;
        if depth == 14 || (depth > 1 && !hides && (sum - whole).abs() < 3e-6) {
            return sum;
        }
        quarters
            .iter()
            .zip(parts)
            .map(|(quarter, part)| self.refined(*quarter, part, depth + 1))
            .sum()
    }

    /// What the surface sends toward v of a light.
    pub fn of(density: &'a dyn Fn(DVec3) -> f64, (narrowest, widest): (f64, f64), light: &Light) -> f64 {
        let [a, b, _, d] = light.corners;
        let quadrature = Self {
            density,
            narrowest,
            widest,
            mirror: DVec3::new(-light.theta.sin(), 0.0, light.theta.cos()),
            normal: (b - a).cross(d - a).normalize(),
        };
        // A convex polygon is made of kites around its middle.
        let polygon = above(&light.corners);
        let count = polygon.len();
        let middle = polygon.iter().sum::<DVec3>() / count as f64;
        let kite = |index: usize| {
            let (before, at, after) = (polygon[(index + count - 1) % count], polygon[index], polygon[(index + 1) % count]);
            let kite = [middle, before.midpoint(at), at, at.midpoint(after)];
            quadrature.refined(kite, quadrature.once(kite), 0)
        };
        (0..count).map(kite).sum()
    }
}

/// Root mean square and largest error.
pub fn error(answers: impl Iterator<Item = f64>, truths: &[f64]) -> (f64, f64) {
    let errors: Vec<f64> = answers.zip(truths).map(|(answer, truth)| answer - truth).collect();
    let square = errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64;
    (square.sqrt(), errors.iter().fold(0.0, |most, e| most.max(e.abs())))
}

pub fn mirrored(map: DMat3, integral: f64, light: &Light) -> f64 {
    integral * form_factor(&light.corners.map(|corner| map * corner))
}
