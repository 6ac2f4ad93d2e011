//! A rough gold sphere in directional light against the microfacet oracle.

use glam::DVec3;
use shadewright::compiler::manifest::Value;
use shadewright::runtime::mesh::Mesh;
use shadewright::runtime::scene::SceneFile;

use crate::view::{Pinhole, frame, hdr, read, set};
use shadewright::modules::oracles::reflection::{Surface, microfacet};

const SCENE: &str = "ggx-sphere.scene.ron";
const GOLD: [f64; 3] = [1.0, 0.766, 0.336];
const ALPHA: f64 = 0.4 * 0.4;
const ILLUMINANCE: f64 = 1000.0;

/// Direction to the sun.
fn to_light(file: &SceneFile) -> DVec3 {
    let Value::List(direction) = &file.scene().lights[0].fields["direction"] else {
        panic!("no direction")
    };
    -DVec3::from_slice(direction).normalize()
}

/// Radiance of a point with this normal toward v, cd/m2.
fn radiance(normal: DVec3, v: DVec3, l: DVec3) -> [f64; 3] {
    GOLD.map(|f0| {
        let surface = Surface {
            normal,
            diffuse: 0.0,
            f0,
            alpha: ALPHA,
        };
        microfacet(&surface, v, l) * ILLUMINANCE * normal.dot(l).max(0.0)
    })
}

/// Where a ray meets the sphere of radius 1 m around the origin.
fn on_sphere(eye: DVec3, ray: DVec3) -> Option<DVec3> {
    let middle = -eye.dot(ray);
    let square = middle * middle - eye.length_squared() + 1.0;
    (square > 0.0).then(|| eye + ray * (middle - square.sqrt()))
}

/// The largest relative difference of the three channels.
fn difference(found: [f32; 4], expected: [f64; 3]) -> f64 {
    let pairs = found.iter().zip(expected);
    pairs.map(|(f, e)| (f64::from(*f) / e - 1.0).abs()).fold(0.0, f64::max)
}

/// Catches every factor of the BRDF that is wrong, a half vector of the wrong sides, f0 without the metal's colour, roughness taken for alpha.
///
/// What the tessellation costs is derived. The vertices' normals are their positions, so the interpolated normal at a point P of a flat triangle
/// is the true normal of the sphere in the direction of P; only, P lies behind the sphere by up to the sagitta s of the triangle, and so the ray
/// meets it s tan(theta_v) beside the point of the sphere that it would have met. View and light directions are the same in both. A normal that
/// is turned by e changes ln D by at most e 2 (1 - a^2) / a (d ln D / d theta is -4 (1 - a^2) t / (a^2 + t^2), t the tangent of the angle to the half
/// vector, largest at t = a), ln(n.l) by e tan(theta_l), and ln V by at most e (tan(theta_l) + tan(theta_v)). s is 1 - cos of half the
/// diagonal of a quad of 2 pi / 1024 by pi / 512. To this comes the rounding, 1e-4 as in the test without tessellation below.
#[test]
fn pixels_are_the_oracle() {
    let file = read(SCENE);
    let (picture, camera, l) = (hdr(&frame(&file)), Pinhole::of(&file), to_light(&file));
    assert_eq!(picture.bad(), 0);
    let sagitta = 1.0 - (std::f64::consts::PI / 512.0 / 2f64.sqrt()).cos();
    let (mut count, mut worst, mut sum, mut bound) = (0, 0f64, 0.0, 0f64);
    for (column, row) in picture.pixels() {
        let ray = camera.ray(column, row);
        let Some(n) = on_sphere(camera.eye, ray) else {
            // Beside the true sphere is beside its tessellation.
            assert_eq!(picture.at(column, row)[..3], [0.0; 3], "{column} {row}");
            continue;
        };
        let (n_v, n_l) = (-n.dot(ray), n.dot(l));
        // Rays that graze the sphere or the light: the derivation's tangents have no bound there.
        if n_v < 0.15 || n_l < 0.05 {
            continue;
        }
        let found = difference(picture.at(column, row), radiance(n, -ray, l));
        let tan = |cosine: f64| cosine.acos().tan();
        let turned = sagitta * tan(n_v);
        let allowed = turned * (2.0 * (1.0 - ALPHA * ALPHA) / ALPHA + 2.0 * tan(n_l) + tan(n_v)) + 1e-4;
        assert!(
            found < allowed,
            "{column} {row}: n.v {n_v}, n.l {n_l}, error {found}, {allowed} allowed"
        );
        (count, worst, sum, bound) = (count + 1, worst.max(found), sum + found, bound.max(allowed));
    }
    println!(
        "sphere: relative error {worst:.2e} at most, {:.2e} in the mean of {count} pixels; derived bound up to {bound:.2e}",
        sum / f64::from(count)
    );
    assert!(count > 4000, "{count}");
}

/// The interpolated normal where a ray first meets a mesh from outside, not normalised, and the smallest barycentric coordinate there.
fn hit(mesh: &Mesh, eye: DVec3, ray: DVec3) -> Option<(DVec3, f64)> {
    let at = |list: &[[f32; 3]], k: u32| DVec3::from_array(list[k as usize].map(f64::from));
    let hits = mesh.indices.chunks(3).filter_map(|t| {
        let [a, b, c] = [0, 1, 2].map(|i| at(&mesh.positions, t[i]));
        let across = (b - a).cross(c - a);
        let slope = -across.dot(ray);
        if slope <= 0.0 {
            return None;
        }
        let distance = (eye - a).dot(across) / slope;
        let p = eye + ray * distance;
        let share = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(across) / across.length_squared();
        let weights = [share(b, c), share(c, a), share(a, b)];
        let least = weights.into_iter().fold(f64::MAX, f64::min);
        let normal = [0, 1, 2].map(|i| at(&mesh.normals, t[i]) * weights[i]);
        (least >= 0.0).then_some((distance, normal[0] + normal[1] + normal[2], least))
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, normal, least)| (normal, least))
}

/// Catches an error of the shading that the tessellation's own would hide, and normals that are not interpolated over the triangle as in
/// perspective: on a coarse sphere, the oracle is asked at the interpolated normal of the triangle that the ray hits.
#[test]
fn coarse_pixels_are_the_oracle_at_the_interpolated_normal() {
    let file = set(
        &read(SCENE),
        &[
            ("meshes.sphere", "Sphere(radius: 1.0, segments: 48, rings: 24)"),
            ("size", "(256, 256)"),
        ],
    );
    let frame = frame(&file);
    let (picture, camera, l) = (hdr(&frame), Pinhole::of(&file), to_light(&file));
    let (mut count, mut worst, mut sum, mut tessellation) = (0, 0f64, 0.0, 0f64);
    for (column, row) in picture.pixels().filter(|(column, row)| column % 4 == 1 && row % 4 == 2) {
        let ray = camera.ray(column, row);
        let Some((normal, least)) = hit(&frame.draws[0].mesh, camera.eye, ray) else {
            continue;
        };
        let normal = normal.normalize();
        // On an edge the GPU may take the neighbour; beside tiny cosines the relative error has no bound.
        if -normal.dot(ray) < 0.15 || normal.dot(l) < 0.05 || least < 1e-3 {
            continue;
        }
        let found = difference(picture.at(column, row), radiance(normal, -ray, l));
        if let Some(n) = on_sphere(camera.eye, ray) {
            tessellation = tessellation.max(difference(picture.at(column, row), radiance(n, -ray, l)));
        }
        (count, worst, sum) = (count + 1, worst.max(found), sum + found);
    }
    println!(
        "coarse sphere: relative error {worst:.2e} at most, {:.2e} in the mean of {count} pixels; without its tessellation it would be {tessellation:.2e}",
        sum / f64::from(count)
    );
    assert!(count > 1000, "{count}");
    assert!(worst < 1e-4, "{worst}");
}
