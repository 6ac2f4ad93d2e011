//! Simple bodies around the origin, sizes in metres.

use std::f32::consts::PI;

use std::sync::Arc;

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::gltf::{Asset, GltfError};
use super::{Mesh, MeshError, teapot};

/// Most subdivisions along one direction.
pub const MAX_SEGMENTS: u32 = 1024;

/// What a mesh is made of: a body that a few numbers describe, or a file.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// Rectangle in the plane y = 0 that looks up.
    Plane {
        /// Along x and z, m.
        size: [f32; 2],
        /// Quads along x and z.
        #[serde(default = "one_by_one")]
        segments: [u32; 2],
    },
    /// Cuboid with flat faces.
    Box {
        /// Along x, y and z, m.
        size: [f32; 3],
    },
    /// Sphere of latitude and longitude; u runs east, v from the north pole (+y) to the south pole.
    Sphere {
        /// m
        radius: f32,
        /// Around the axis.
        #[serde(default = "sphere_segments")]
        segments: u32,
        /// From pole to pole.
        #[serde(default = "sphere_rings")]
        rings: u32,
    },
    /// Closed cylinder around the y axis.
    Cylinder {
        /// m
        radius: f32,
        /// m
        height: f32,
        /// Around the axis.
        #[serde(default = "sphere_segments")]
        segments: u32,
    },
    /// Closed cone around the y axis, tip up.
    Cone {
        /// Of the base, m.
        radius: f32,
        /// m
        height: f32,
        /// Around the axis.
        #[serde(default = "sphere_segments")]
        segments: u32,
    },
    /// Torus around the y axis.
    Torus {
        /// From the axis to the middle of the tube, m.
        radius: f32,
        /// Of the tube, m.
        tube: f32,
        /// Around the axis.
        #[serde(default = "sphere_segments")]
        segments: u32,
        /// Around the tube.
        #[serde(default = "sphere_rings")]
        rings: u32,
    },
    /// The Utah teapot on the plane y = 0.
    Teapot {
        /// Height, m.
        size: f32,
        /// Quads along each side of its 32 patches.
        #[serde(default = "teapot_segments")]
        segments: u32,
    },
    /// The triangles of a glTF file as they stand in its scene, joined; its materials, lights and cameras are left aside.
    Gltf {
        /// Path of the file.
        file: String,
        /// Only meshes of this name.
        #[serde(default)]
        mesh: Option<String>,
    },
}

fn one_by_one() -> [u32; 2] {
    [1, 1]
}
fn sphere_segments() -> u32 {
    64
}
fn sphere_rings() -> u32 {
    32
}
fn teapot_segments() -> u32 {
    16
}

fn length(name: &'static str, value: f32) -> Result<f32, MeshError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(MeshError::Length { name, value })
    }
}

fn count(name: &'static str, value: u32, least: u32) -> Result<u32, MeshError> {
    if (least..=MAX_SEGMENTS).contains(&value) {
        Ok(value)
    } else {
        Err(MeshError::Segments {
            name,
            value,
            least,
            most: MAX_SEGMENTS,
        })
    }
}

impl Shape {
    /// Makes the mesh, tangents included; `load` reads a glTF file.
    ///
    /// # Errors
    /// A length is not positive, a subdivision is out of its limits, or the file cannot be taken.
    pub fn build(&self, load: impl FnOnce(&str) -> Result<Arc<Asset>, GltfError>) -> Result<Mesh, MeshError> {
        let mut mesh = Mesh::default();
        match *self {
            Self::Gltf { ref file, mesh: ref name } => return load(file)?.joined(name.as_deref()),
            Self::Teapot { size, segments } => return teapot::teapot(size, segments),
            Self::Plane { size, segments } => {
                let (x, z) = (length("size", size[0])?, length("size", size[1])?);
                let (nx, nz) = (count("segments", segments[0], 1)?, count("segments", segments[1], 1)?);
                grid(&mut mesh, nx, nz, Vec3::X, |u, v| {
                    (Vec3::new((u - 0.5) * x, 0.0, (v - 0.5) * z), Vec3::Y, Vec2::new(u, v))
                });
            }
            Self::Box { size } => {
                let half = Vec3::new(length("size", size[0])?, length("size", size[1])?, length("size", size[2])?) * 0.5;
                for normal in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z] {
                    // Right and down on the face as seen from outside, up being +y on the four walls.
                    let down = if normal.y == 0.0 { -Vec3::Y } else { Vec3::Z * normal.y };
                    let right = normal.cross(down);
                    grid(&mut mesh, 1, 1, right, |u, v| {
                        let at = normal + right * (2.0 * u - 1.0) + down * (2.0 * v - 1.0);
                        (at * half, normal, Vec2::new(u, v))
                    });
                }
            }
            Self::Sphere { radius, segments, rings } => {
                let (r, nu, nv) = (
                    length("radius", radius)?,
                    count("segments", segments, 3)?,
                    count("rings", rings, 2)?,
                );
                turned(&mut mesh, nu, nv, |v| {
                    let n = arc(v * 0.5);
                    // The profile starts at the north pole: x is the distance from the axis.
                    let n = Vec2::new(n.y, n.x);
                    (n * r, n)
                });
            }
            Self::Cylinder { radius, height, segments } => {
                let (r, h, nu) = (
                    length("radius", radius)?,
                    length("height", height)?,
                    count("segments", segments, 3)?,
                );
                turned(&mut mesh, nu, 1, |v| (Vec2::new(r, h * (0.5 - v)), Vec2::X));
                turned(&mut mesh, nu, 1, |v| (Vec2::new(r * v, h * 0.5), Vec2::Y));
                turned(&mut mesh, nu, 1, |v| (Vec2::new(r * (1.0 - v), h * -0.5), Vec2::NEG_Y));
            }
            Self::Cone { radius, height, segments } => {
                let (r, h, nu) = (
                    length("radius", radius)?,
                    length("height", height)?,
                    count("segments", segments, 3)?,
                );
                let slope = Vec2::new(h, r).normalize();
                turned(&mut mesh, nu, 1, |v| (Vec2::new(r * v, h * (0.5 - v)), slope));
                turned(&mut mesh, nu, 1, |v| (Vec2::new(r * (1.0 - v), h * -0.5), Vec2::NEG_Y));
            }
            Self::Torus {
                radius,
                tube,
                segments,
                rings,
            } => {
                let (r, t) = (length("radius", radius)?, length("tube", tube)?);
                let (nu, nv) = (count("segments", segments, 3)?, count("rings", rings, 3)?);
                turned(&mut mesh, nu, nv, |v| {
                    let n = arc(0.25 - v);
                    (Vec2::new(r, 0.0) + n * t, n)
                });
            }
        }
        Ok(mesh)
    }
}

/// Point of the unit circle after this many turns, exact at the quarters so that seams and poles meet.
fn arc(turns: f32) -> Vec2 {
    let turns = turns.rem_euclid(1.0);
    let quarter = (turns * 4.0).round();
    let (s, c) = ((turns * 4.0 - quarter) * (PI / 2.0)).sin_cos();
    match quarter as i32 % 4 {
        0 => Vec2::new(c, s),
        1 => Vec2::new(-s, c),
        2 => Vec2::new(-c, -s),
        _ => Vec2::new(s, -c),
    }
}

/// A flat grid of quads whose u runs along `right` and v runs down as seen from outside.
fn grid(mesh: &mut Mesh, nu: u32, nv: u32, right: Vec3, at: impl Fn(f32, f32) -> (Vec3, Vec3, Vec2)) {
    let first = mesh.positions.len() as u32;
    for j in 0..=nv {
        for i in 0..=nu {
            let (position, normal, uv) = at(i as f32 / nu as f32, j as f32 / nv as f32);
            mesh.positions.push(position.to_array());
            mesh.normals.push(normal.to_array());
            mesh.tangents.push(right.extend(1.0).to_array());
            mesh.uvs.push(uv.to_array());
        }
    }
    for j in 0..nv {
        for i in 0..nu {
            let a = first + j * (nu + 1) + i;
            let (b, c, d) = (a + 1, a + nu + 2, a + nu + 1);
            for t in [[a, d, c], [a, c, b]] {
                push_triangle(mesh, t);
            }
        }
    }
}

/// Turns a profile (distance from the y axis and height, with its normal; v from 0 to 1, outside on the left hand going on) around the
/// y axis. Where the profile touches the axis every segment gets a vertex of its own, with the normal and u of the segment's middle.
fn turned(mesh: &mut Mesh, nu: u32, nv: u32, profile: impl Fn(f32) -> (Vec2, Vec2)) {
    let first = mesh.positions.len() as u32;
    for j in 0..=nv {
        let v = j as f32 / nv as f32;
        let (p, n) = profile(v);
        let on_axis = p.x.abs() < 1e-7 * p.length().max(1e-30);
        for i in 0..=nu {
            let u = if on_axis { (i as f32 + 0.5).min(nu as f32) } else { i as f32 } / nu as f32;
            let around = arc(u);
            let place = |q: Vec2| Vec3::new(q.x * around.x, q.y, -q.x * around.y);
            let p = if on_axis { Vec2::new(0.0, p.y) } else { p };
            mesh.positions.push(place(p).to_array());
            mesh.normals.push(place(n).normalize_or(Vec3::Y).to_array());
            mesh.tangents.push([-around.y, 0.0, -around.x, 1.0]);
            mesh.uvs.push([u, v]);
        }
    }
    for j in 0..nv {
        for i in 0..nu {
            let a = first + j * (nu + 1) + i;
            let (b, c, d) = (a + 1, a + nu + 2, a + nu + 1);
            // On the axis each vertex serves the segment to its right: a for the top row, d for the bottom row.
            let triangles = if mesh.positions[d as usize] == mesh.positions[c as usize] {
                [[a, d, b], [d, c, b]]
            } else {
                [[a, d, c], [a, c, b]]
            };
            for t in triangles {
                push_triangle(mesh, t);
            }
        }
    }
}

/// Leaves out triangles with two corners in one place.
fn push_triangle(mesh: &mut Mesh, t: [u32; 3]) {
    let p = t.map(|k| Vec3::from(mesh.positions[k as usize]));
    if p[0] != p[1] && p[1] != p[2] && p[2] != p[0] {
        mesh.indices.extend(t);
    }
}

#[cfg(test)]
mod tests;
