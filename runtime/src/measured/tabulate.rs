//! Tables of functions that are known, in the layout of `.bsdf` files: to see what a table loses, and to bring a model where only measured
//! materials are taken.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};

use super::rgl::direction;
use super::warp::{Warp, bilinear};
use super::{Field, Numbers};

/// Farthest elevation of an incident direction, as that of the instruments.
const FARTHEST: f64 = 85.0 / 180.0 * PI;

/// The facets along whose reflections a table has its values.
#[derive(Clone, Copy)]
pub struct Facets<'a> {
    /// Density of their normals D, 1/sr; above 0 somewhere a viewer sees.
    pub normals: &'a dyn Fn(DVec3) -> f64,
    /// Their projected area toward a direction, as a part of the surface's.
    pub area: &'a dyn Fn(DVec3) -> f64,
}

/// The fields of a table: `azimuths` incident ones (1, an isotropic function, or 3 and more, all round) and `elevations`, 2 or more, with
/// `size` x `size` values each, 3 or more. `function` is the BRDF for the directions to the viewer and to the light, 1/sr by channel.
pub fn tabulate([azimuths, elevations, size]: [usize; 3], facets: Facets, function: impl Fn(DVec3, DVec3) -> [f64; 3]) -> Vec<Field> {
    let (azimuths, elevations, size) = (if azimuths < 3 { 1 } else { azimuths }, elevations.max(2), size.max(3));
    let part = |i: usize, of: usize| i as f64 / (of - 1) as f64;
    let phi_i: Vec<f64> = match azimuths {
        1 => vec![0.0],
        n => (0..n).map(|i| (2.0 * part(i, n) - 1.0) * PI).collect(),
    };
    let theta_i: Vec<f64> = (0..elevations).map(|i| part(i, elevations) * FARTHEST).collect();
    let floats = |values: Vec<f64>| values.into_iter().map(|x| x as f32).collect::<Vec<f32>>();
    let grid = |of: &dyn Fn(DVec3) -> f64| {
        let points = (0..size * size).map(|i| at(DVec2::new(part(i % size, size), part(i / size, size)), 0.0));
        floats(points.map(of).collect())
    };
    let ndf = grid(facets.normals);
    let sigma = grid(facets.area);
    let turn = |phi: f64| if azimuths == 1 { phi } else { 0.0 };
    let mut vndf = Vec::new();
    for (phi, theta) in directions(&phi_i, &theta_i) {
        let v = direction(theta, phi);
        for i in 0..size * size {
            let u = DVec2::new(part(i % size, size), part(i / size, size));
            let m = at(u, turn(phi));
            // |dm / du|: theta goes with u squared, phi once round.
            let jacobian = 2.0 * PI * PI * u.x * (u.x * u.x * FRAC_PI_2).sin();
            vndf.push((facets.normals)(m) * v.dot(m).max(0.0) * jacobian);
        }
    }
    let vndf = floats(vndf);
    let mut rgb = Vec::new();
    // A distribution of nothing has no values: zeros stand there, and a reader says so.
    let warp = Warp::new(size, size, vndf.clone());
    let mut luminance = Vec::new();
    for (slice, (phi, theta)) in directions(&phi_i, &theta_i).into_iter().enumerate() {
        let v = direction(theta, phi);
        let area = bilinear(&sigma, size, size, DVec2::new((theta / FRAC_PI_2).sqrt(), (phi + PI) / TAU));
        let value = |i: usize| {
            let Ok(warp) = &warp else { return [0.0; 3] };
            let u = warp.sample(slice, DVec2::new(part(i % size, size), part(i / size, size)));
            let m = at(u, turn(phi));
            let l = 2.0 * v.dot(m) * m - v;
            let normals = bilinear(&ndf, size, size, u);
            if l.z <= 0.0 || normals <= 0.0 {
                return [0.0; 3];
            }
            function(v, l).map(|f| f * l.z * 4.0 * area / normals)
        };
        let values: Vec<[f64; 3]> = (0..size * size).map(value).collect();
        for channel in 0..3 {
            rgb.extend(values.iter().map(|value| value[channel]));
        }
        luminance.extend(values.iter().map(|value| value.iter().sum::<f64>() / 3.0));
    }
    let (p, t, s) = (phi_i.len(), theta_i.len(), size);
    let field = |name: &str, shape: &[usize], values: Vec<f32>| Field {
        name: name.to_owned(),
        shape: shape.to_vec(),
        numbers: Numbers::Floats(values),
    };
    let text = b"a function, tabulated".to_vec();
    vec![
        Field {
            name: "description".to_owned(),
            shape: vec![text.len()],
            numbers: Numbers::Bytes(text),
        },
        field("phi_i", &[p], floats(phi_i)),
        field("theta_i", &[t], floats(theta_i)),
        field("ndf", &[s, s], ndf),
        field("sigma", &[s, s], sigma),
        field("vndf", &[p, t, s, s], vndf),
        field("luminance", &[p, t, s, s], floats(luminance)),
        field("rgb", &[p, t, 3, s, s], floats(rgb)),
        Field {
            name: "jacobian".to_owned(),
            shape: vec![1],
            numbers: Numbers::Bytes(vec![1]),
        },
    ]
}

/// The direction at a point of the unit square, turned by an azimuth.
fn at(u: DVec2, turn: f64) -> DVec3 {
    direction(u.x * u.x * FRAC_PI_2, (2.0 * u.y - 1.0) * PI + turn)
}

fn directions(phi_i: &[f64], theta_i: &[f64]) -> Vec<(f64, f64)> {
    phi_i.iter().flat_map(|phi| theta_i.iter().map(|theta| (*phi, *theta))).collect()
}
