//! The Utah teapot (Newell 1975), tessellated at load. Source, licence and shape: `README.md` beside this file.

mod data;

use glam::{DVec3, Vec3};

use super::{MAX_SEGMENTS, Mesh, MeshError, generate_tangents};

/// Height of the published data, from the bottom to the top of the knob.
const HEIGHT: f64 = 3.15;

/// Makes the teapot: `size` is its height in metres, every patch becomes a grid of `segments` by `segments` quads.
///
/// # Errors
/// `size` is not positive, or `segments` is 0 or above [`MAX_SEGMENTS`].
pub fn teapot(size: f32, segments: u32) -> Result<Mesh, MeshError> {
    if !(size.is_finite() && size > 0.0) {
        return Err(MeshError::Length { name: "size", value: size });
    }
    // 32 patches: a quarter of what one grid may have keeps the whole below the limit of vertices.
    if !(1..=MAX_SEGMENTS / 4).contains(&segments) {
        return Err(MeshError::Segments {
            name: "segments",
            value: segments,
            least: 1,
            most: MAX_SEGMENTS / 4,
        });
    }
    let mut mesh = Mesh::default();
    for patch in &data::PATCHES {
        tessellate(&mut mesh, &patch.map(|i| DVec3::from(data::POINTS[usize::from(i)])), size, segments);
    }
    generate_tangents(&mut mesh);
    Ok(mesh)
}

/// Bernstein weights of degree 3 and their derivatives at `i / n`. They are symmetric to the last bit under `i -> n - i`,
/// so two patches that share an edge agree on it whichever way each runs along it.
fn bernstein(i: u32, n: u32) -> ([f64; 4], [f64; 4]) {
    let t = f64::from(i) / f64::from(n);
    let s = f64::from(n - i) / f64::from(n);
    (
        [s * s * s, 3.0 * (s * s) * t, 3.0 * (t * t) * s, t * t * t],
        [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t],
    )
}

/// Sum of four weighted points, with the outer and the inner pair added first: symmetric as above.
fn blend(w: &[f64; 4], p: [DVec3; 4]) -> DVec3 {
    (w[0] * p[0] + w[3] * p[3]) + (w[1] * p[1] + w[2] * p[2])
}

fn surface(points: &[DVec3; 16], u: &[f64; 4], v: &[f64; 4]) -> DVec3 {
    let row = |k: usize| blend(v, [points[4 * k], points[4 * k + 1], points[4 * k + 2], points[4 * k + 3]]);
    blend(u, [row(0), row(1), row(2), row(3)])
}

fn tessellate(mesh: &mut Mesh, points: &[DVec3; 16], size: f32, n: u32) {
    let first = mesh.positions.len() as u32;
    let scale = f64::from(size) / HEIGHT;
    // z up to y up, a rotation, so that counter-clockwise stays so.
    let turn = |p: DVec3| DVec3::new(p.x, p.z, -p.y);
    for i in 0..=n {
        for j in 0..=n {
            let (bu, du) = bernstein(i, n);
            let (bv, dv) = bernstein(j, n);
            let position = surface(points, &bu, &bv);
            let (along_u, along_v) = (surface(points, &du, &bv), surface(points, &bu, &dv));
            // An edge that is one point has no derivative along itself; just inside it grows as the mixed derivative does.
            // The outward step on the far edge turns that derivative's sign.
            let mixed = surface(points, &du, &dv);
            let inward = |k: u32| if k == 0 { 1.0 } else { -1.0 };
            let tiny = 1e-9 * HEIGHT;
            let along_v = if along_v.length() < tiny { mixed * inward(i) } else { along_v };
            let along_u = if along_u.length() < tiny { mixed * inward(j) } else { along_u };
            let normal = turn(along_v.cross(along_u)).normalize_or(DVec3::Y);
            mesh.positions.push((turn(position) * scale).as_vec3().to_array());
            mesh.normals.push(normal.as_vec3().to_array());
            mesh.uvs.push([j as f32 / n as f32, i as f32 / n as f32]);
        }
    }
    let side = n + 1;
    for i in 0..n {
        for j in 0..n {
            let corner = first + i * side + j;
            let (a, b, c, d) = (corner, corner + 1, corner + side + 1, corner + side);
            for triangle in [[a, b, c], [a, c, d]] {
                let p = triangle.map(|k| Vec3::from(mesh.positions[k as usize]));
                // Where an edge is one point, one of the two has no area.
                if p[0] != p[1] && p[1] != p[2] && p[2] != p[0] {
                    mesh.indices.extend(triangle);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    fn welded(mesh: &Mesh) -> Vec<u32> {
        let mut known = HashMap::new();
        mesh.positions
            .iter()
            .map(|p| {
                let next = known.len() as u32;
                // + 0.0 makes one zero of the two.
                *known.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(next)
            })
            .collect()
    }

    /// Catches a wrong axis, a wrong unit, and a patch left out (the spout ends at x = 3.5 / 3.15, the handle at -3).
    #[test]
    fn stands_on_the_floor_and_is_as_high_as_asked() {
        let mesh = teapot(0.15, 8).unwrap();
        mesh.check().unwrap();
        let b = mesh.bounds().unwrap();
        let unit = 0.15 / 3.15;
        assert!(b.min.y.abs() < 1e-7 && (b.max.y - 0.15).abs() < 1e-7, "{b:?}");
        assert!(
            (b.max.x - 3.434 * unit).abs() < 0.005 && (b.min.x + 3.0 * unit).abs() < 0.005,
            "{b:?}"
        );
        assert!((b.max.z - 2.0 * unit).abs() < 1e-4 && (b.min.z + 2.0 * unit).abs() < 1e-4, "{b:?}");
        assert_eq!(mesh.triangles(), 32 * 2 * 8 * 8 - 8 * 8);
    }

    /// Catches a NaN, zero or sideways normal where an edge of a patch is one point.
    #[test]
    fn the_poles_look_up_and_down() {
        for n in [1, 2, 7, 16] {
            let mesh = teapot(1.0, n).unwrap();
            mesh.check().unwrap();
            let mut found = (0, 0);
            for (p, normal) in mesh.positions.iter().zip(&mesh.normals) {
                if p[0] == 0.0 && p[2] == 0.0 && (p[1] - 1.0).abs() < 1e-6 {
                    assert!(normal[1] > 0.999, "tip {normal:?}");
                    found.0 += 1;
                }
                if p[0] == 0.0 && p[2] == 0.0 && p[1] == 0.0 {
                    assert!(normal[1] < -0.999, "bottom {normal:?}");
                    found.1 += 1;
                }
            }
            assert!(found.0 >= 4 && found.1 >= 4, "{found:?}");
        }
    }

    /// Catches triangles wound against their normals, and normals that point into the pot.
    #[test]
    fn normals_point_outward() {
        let n = 12;
        let mesh = teapot(3.15, n).unwrap();
        let mut against = 0;
        for t in mesh.indices.chunks_exact(3) {
            let p = [0, 1, 2].map(|k| Vec3::from(mesh.positions[t[k] as usize]));
            let face = (p[1] - p[0]).cross(p[2] - p[0]);
            let mean: Vec3 = t.iter().map(|&k| Vec3::from(mesh.normals[k as usize])).sum();
            against += usize::from(face.dot(mean) <= 0.0);
        }
        assert_eq!(against, 0);
        // The body: every vertex at least 1.6 away from the axis and within 2.05 belongs to it, spout and handle aside.
        let mut seen = 0;
        for (p, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let radial = Vec3::new(p[0], 0.0, p[2]);
            if (1.6..2.05).contains(&radial.length()) && p[2].abs() > 1.2 {
                assert!(Vec3::from(*normal).dot(radial) > 0.0, "{p:?} {normal:?}");
                seen += 1;
            }
        }
        assert!(seen > 100, "{seen}");
        // The spout's and the handle's normals look away from their middle lines: their enclosed volume is positive.
        for (part, least) in [(12..16, 0.05), (16..20, 0.05)] {
            let mut tube = Mesh::default();
            for patch in &data::PATCHES[part] {
                tessellate(&mut tube, &patch.map(|i| DVec3::from(data::POINTS[usize::from(i)])), 3.15, n);
            }
            let middle = tube.bounds().unwrap().center();
            let volume: f32 = tube
                .indices
                .chunks_exact(3)
                .map(|t| {
                    let p = [0, 1, 2].map(|k| Vec3::from(tube.positions[t[k] as usize]) - middle);
                    p[0].dot(p[1].cross(p[2])) / 6.0
                })
                .sum();
            assert!(volume > least, "{volume}");
        }
    }

    /// Catches cracks between patches: the only open edges are the rim's inner one, the lid's, and both ends of handle and spout.
    #[test]
    fn seams_are_bit_exact() {
        for n in 2..=12 {
            let mesh = teapot(0.2, n).unwrap();
            let weld = welded(&mesh);
            let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
            for t in mesh.indices.chunks_exact(3) {
                for k in 0..3 {
                    let (a, b) = (weld[t[k] as usize], weld[t[(k + 1) % 3] as usize]);
                    *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
                }
            }
            let open = edges.values().filter(|&&balance| balance != 0).count() as u32;
            assert_eq!(open, (4 + 4 + 2 * 2 + 2 * 2) * n, "{n} segments");
        }
    }

    #[test]
    fn limits_are_errors() {
        for size in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(matches!(teapot(size, 4), Err(MeshError::Length { name: "size", .. })));
        }
        assert!(matches!(teapot(1.0, 0), Err(MeshError::Segments { .. })));
        assert!(matches!(teapot(1.0, 1 << 20), Err(MeshError::Segments { .. })));
    }
}
