use std::f32::consts::TAU;

use super::*;

fn build(shape: &Shape) -> Result<Mesh, MeshError> {
    shape.build(|_| unreachable!())
}

fn all() -> Vec<(Shape, f32, f32)> {
    let (r, h, t) = (0.5, 0.8, 0.2);
    vec![
        // Area and volume in closed form.
        (
            Shape::Plane {
                size: [2.0, 3.0],
                segments: [3, 5],
            },
            6.0,
            0.0,
        ),
        (Shape::Box { size: [1.0, 2.0, 3.0] }, 22.0, 6.0),
        (
            Shape::Sphere {
                radius: r,
                segments: 128,
                rings: 64,
            },
            4.0 * PI * r * r,
            4.0 / 3.0 * PI * r * r * r,
        ),
        (
            Shape::Cylinder {
                radius: r,
                height: h,
                segments: 256,
            },
            TAU * r * (h + r),
            PI * r * r * h,
        ),
        (
            Shape::Cone {
                radius: r,
                height: h,
                segments: 256,
            },
            PI * r * (r + r.hypot(h)),
            PI * r * r * h / 3.0,
        ),
        (
            Shape::Torus {
                radius: r,
                tube: t,
                segments: 128,
                rings: 64,
            },
            TAU * r * TAU * t,
            TAU * r * PI * t * t,
        ),
    ]
}

/// Catches a face left out or wound inward, a wrong size, and normals that disagree with the winding.
#[test]
fn areas_volumes_and_normals() {
    for (primitive, area, volume) in all() {
        let mesh = build(&primitive).unwrap();
        mesh.check().unwrap();
        let (mut a, mut v) = (0.0, 0.0);
        for t in mesh.indices.chunks_exact(3) {
            let p = [0, 1, 2].map(|k| Vec3::from(mesh.positions[t[k] as usize]));
            let face = (p[1] - p[0]).cross(p[2] - p[0]);
            a += face.length() / 2.0;
            v += p[0].dot(p[1].cross(p[2])) / 6.0;
            for &k in t {
                let n = Vec3::from(mesh.normals[k as usize]);
                assert!(n.dot(face.normalize()) > 0.9, "{primitive:?} {p:?} {n:?}");
            }
        }
        assert!((a / area - 1.0).abs() < 2e-3, "{primitive:?}: area {a}, not {area}");
        assert!(
            (v - volume).abs() < 3e-3 * volume.max(1e-3),
            "{primitive:?}: volume {v}, not {volume}"
        );
    }
}

/// Catches tangents that do not run with u, and mirrored texture coordinates (text would read backwards).
#[test]
fn textures_are_not_mirrored() {
    for (primitive, ..) in all() {
        let mesh = build(&primitive).unwrap();
        for t in &mesh.tangents {
            assert_eq!(t[3], 1.0, "{primitive:?}");
        }
    }
    let plane = Shape::Plane {
        size: [1.0, 1.0],
        segments: [1, 1],
    }
    .build(|_| unreachable!())
    .unwrap();
    assert!(plane.tangents.iter().all(|t| t[..3] == [1.0, 0.0, 0.0]));
}

/// Catches one shared pole vertex, whose u would swirl the texture around the pole, and the neighbour's vertex at either pole.
#[test]
fn poles_have_a_vertex_for_each_segment() {
    let mesh = build(&Shape::Sphere {
        radius: 1.0,
        segments: 8,
        rings: 4,
    })
    .unwrap();
    assert_eq!(mesh.triangles(), 8 * 2 + 8 * 2 * 2);
    for pole in [1.0, -1.0] {
        let mut seen = 0;
        for t in mesh.indices.chunks_exact(3) {
            let (at_pole, rest): (Vec<u32>, Vec<u32>) = t.iter().partition(|&&k| mesh.positions[k as usize][1] == pole);
            let u = |k: u32| mesh.uvs[k as usize][0];
            if let [tip] = at_pole[..] {
                assert!((u(tip) - (u(rest[0]) + u(rest[1])) / 2.0).abs() < 1e-6);
                seen += 1;
            }
        }
        assert_eq!(seen, 8);
    }
}

/// Catches tangents that are not those which a normal map's baker presumes.
#[test]
fn tangents_are_those_of_mikktspace() {
    for (shape, ..) in all() {
        let mesh = build(&shape).unwrap();
        let mut other = mesh.clone();
        crate::mesh::generate_tangents(&mut other);
        let mut corners = 0;
        for (&a, &b) in mesh.indices.iter().zip(&other.indices) {
            let (ta, tb) = (mesh.tangents[a as usize], other.tangents[b as usize]);
            // Near a pole the mean over the triangles' corners leaves the direction of the one vertex.
            if Vec3::from_slice(&ta).dot(Vec3::from_slice(&tb)) > 0.99 && ta[3] == tb[3] {
                corners += 1;
            }
        }
        assert!(
            corners * 100 > mesh.indices.len() * 97,
            "{shape:?}: {corners} of {}",
            mesh.indices.len()
        );
    }
}

#[test]
fn nonsense_is_an_error() {
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(
            Shape::Plane {
                size: [1.0, bad],
                segments: [1, 1]
            }
            .build(|_| unreachable!())
            .is_err()
        );
        assert!(build(&Shape::Box { size: [1.0, bad, 1.0] }).is_err());
        assert!(
            Shape::Sphere {
                radius: bad,
                segments: 8,
                rings: 8
            }
            .build(|_| unreachable!())
            .is_err()
        );
        assert!(
            Shape::Torus {
                radius: 1.0,
                tube: bad,
                segments: 8,
                rings: 8
            }
            .build(|_| unreachable!())
            .is_err()
        );
    }
    let error = Shape::Sphere {
        radius: 1.0,
        segments: 2,
        rings: 8,
    }
    .build(|_| unreachable!())
    .unwrap_err();
    assert_eq!(error.to_string(), "`segments` is 2, but must be between 3 and 1024");
    assert!(
        Shape::Plane {
            size: [1.0; 2],
            segments: [1, 100_000]
        }
        .build(|_| unreachable!())
        .is_err()
    );
}
