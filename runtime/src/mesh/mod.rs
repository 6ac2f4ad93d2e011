//! Triangle meshes: primitives, the Utah teapot, glTF files.
//!
//! Every mesh is in metres, right-handed with y up, counter-clockwise seen from outside, and complete: whoever makes one
//! also gives normals, tangents and texture coordinates, so that no later stage has to ask.

mod attributes;
pub mod gltf;
mod primitives;
pub mod teapot;

pub use attributes::{flat_normals, generate_tangents, smooth_normals};
pub use primitives::{MAX_SEGMENTS, Shape};

pub use crate::frame::{Bounds, Mesh};
use glam::{Mat3, Mat4, Vec3};

/// Most vertices that one mesh may have. It keeps a slip of the pen in a scene from taking all memory.
pub const MAX_VERTICES: usize = 16 << 20;

/// Why a mesh cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A length is not a positive finite number.
    #[error("`{name}` is {value}, but must be a positive, finite length in metres")]
    Length {
        /// Field of the primitive.
        name: &'static str,
        /// What it was.
        value: f32,
    },
    /// A subdivision is out of its limits.
    #[error("`{name}` is {value}, but must be between {least} and {most}")]
    Segments {
        /// Field of the primitive.
        name: &'static str,
        /// What it was.
        value: u32,
        /// Smallest that makes a body.
        least: u32,
        /// Declared limit.
        most: u32,
    },
    /// A file cannot be taken.
    #[error(transparent)]
    Gltf(#[from] gltf::GltfError),
    /// A file has no mesh of this name.
    #[error("the file has no mesh `{0}`")]
    NoSuchMesh(String),
    /// The attribute lists differ in length, or an index points past their end.
    #[error("{0}")]
    Inconsistent(String),
}

impl Mesh {
    /// The box around all positions; `None` if there are none, or one is not finite.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of(self.positions.iter().map(|&p| Vec3::from(p)))
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }

    /// The mesh under a transform: the normals turn with the surface, and a transform that mirrors turns the triangles and the
    /// bitangents around, so that the outside stays outside.
    #[must_use]
    pub fn transformed(&self, by: &Mat4) -> Self {
        let linear = Mat3::from_mat4(*by);
        let mirrors = linear.determinant() < 0.0;
        // The cofactors are the transposed inverse but for a factor, and there where a scale is 0, too.
        let normal = Mat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        ) * if mirrors { -1.0 } else { 1.0 };
        let mut mesh = self.clone();
        for i in 0..mesh.positions.len() {
            mesh.positions[i] = by.transform_point3(self.positions[i].into()).to_array();
            let n = (normal * Vec3::from(self.normals[i])).normalize_or(Vec3::Y);
            let t = linear * Vec3::from_slice(&self.tangents[i]);
            let t = (t - n * n.dot(t)).try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
            mesh.normals[i] = n.to_array();
            mesh.tangents[i] = [t.x, t.y, t.z, if mirrors { -self.tangents[i][3] } else { self.tangents[i][3] }];
        }
        if mirrors {
            for triangle in mesh.indices.chunks_exact_mut(3) {
                triangle.swap(1, 2);
            }
        }
        mesh
    }

    /// The same mesh for a model matrix that mirrors: the bitangents' signs are turned, as the shader's cross product is not mirrored.
    /// The triangles stay: a renderer turns its front face for such matrices.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mut mesh = self.clone();
        for tangent in &mut mesh.tangents {
            tangent[3] = -tangent[3];
        }
        mesh
    }

    /// Adds another mesh's triangles.
    ///
    /// # Errors
    /// There would be more than [`MAX_VERTICES`].
    pub fn append(&mut self, other: &Self) -> Result<(), MeshError> {
        let first = self.positions.len();
        if first + other.positions.len() > MAX_VERTICES {
            return Err(MeshError::Inconsistent(format!("more than the limit of {MAX_VERTICES} vertices")));
        }
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.tangents.extend(&other.tangents);
        self.uvs.extend(&other.uvs);
        self.indices.extend(other.indices.iter().map(|i| i + first as u32));
        Ok(())
    }

    /// Checks what a renderer relies on: equal lengths, indices in range, finite numbers, unit normals and tangents.
    ///
    /// # Errors
    /// [`MeshError::Inconsistent`] says the first thing that is wrong.
    pub fn check(&self) -> Result<(), MeshError> {
        let n = self.positions.len();
        let wrong = |text: String| Err(MeshError::Inconsistent(text));
        for (name, len) in [
            ("normals", self.normals.len()),
            ("tangents", self.tangents.len()),
            ("texture coordinates", self.uvs.len()),
        ] {
            if len != n {
                return wrong(format!("{len} {name} for {n} positions"));
            }
        }
        if n > MAX_VERTICES {
            return wrong(format!("{n} vertices, more than the limit of {MAX_VERTICES}"));
        }
        if !self.indices.len().is_multiple_of(3) {
            return wrong(format!("{} indices, not a multiple of 3", self.indices.len()));
        }
        if let Some(i) = self.indices.iter().find(|&&i| i as usize >= n) {
            return wrong(format!("index {i} of {n} vertices"));
        }
        for i in 0..n {
            let (p, normal, t) = (
                Vec3::from(self.positions[i]),
                Vec3::from(self.normals[i]),
                Vec3::from_slice(&self.tangents[i]),
            );
            if !p.is_finite() || !self.uvs[i].iter().all(|x| x.is_finite()) {
                return wrong(format!("vertex {i} has a coordinate that is no finite number"));
            }
            // 1e-3: normals and tangents of files are often quantised to 8 or 16 bits.
            if (normal.length() - 1.0).abs() > 1e-3 || (t.length() - 1.0).abs() > 1e-3 || self.tangents[i][3].abs() != 1.0 {
                return wrong(format!("vertex {i} has a normal or tangent that is not of unit length"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches triangles, normals or bitangents that turn inside out under a mirror or a skewed scale.
    #[test]
    fn transforms_keep_the_outside() {
        let sphere = Shape::Sphere {
            radius: 1.0,
            segments: 16,
            rings: 8,
        }
        .build(|_| unreachable!())
        .unwrap();
        for scale in [Vec3::new(2.0, 0.5, 1.0), Vec3::new(-1.0, 1.0, 3.0), Vec3::new(-1.0, -1.0, -2.0)] {
            let matrix = Mat4::from_rotation_z(0.3) * Mat4::from_scale(scale);
            let moved = sphere.transformed(&matrix);
            moved.check().unwrap();
            for t in moved.indices.chunks_exact(3) {
                let p = [0, 1, 2].map(|k| Vec3::from(moved.positions[t[k] as usize]));
                let face = (p[1] - p[0]).cross(p[2] - p[0]);
                assert!(face.dot(p[0] + p[1] + p[2]) > 0.0);
                for &k in t {
                    assert!(Vec3::from(moved.normals[k as usize]).dot(face) > 0.0);
                }
            }
            // The bitangent of a point is that of the sphere, moved.
            for i in (0..moved.positions.len()).step_by(7) {
                let bitangent = |m: &Mesh| Vec3::from(m.normals[i]).cross(Vec3::from_slice(&m.tangents[i])) * m.tangents[i][3];
                assert!(bitangent(&moved).dot(matrix.transform_vector3(bitangent(&sphere))) > 0.0);
            }
        }
        let mut twice = sphere.clone();
        twice.append(&sphere).unwrap();
        twice.check().unwrap();
        assert_eq!(twice.triangles(), 2 * sphere.triangles());
        assert_ne!(twice.indices[0], twice.indices[sphere.indices.len()]);
    }

    /// Catches a check that lets a renderer read past an attribute's end or divide by a zero normal.
    #[test]
    fn broken_meshes_are_found() {
        let good = Shape::Box { size: [1.0; 3] }.build(|_| unreachable!()).unwrap();
        let breaks: [fn(&mut Mesh); 6] = [
            |m| m.indices[0] = 9999,
            |m| m.uvs.truncate(3),
            |m| m.normals[2] = [0.0; 3],
            |m| m.tangents[2][3] = 0.0,
            |m| m.positions[0][1] = f32::NAN,
            |m| m.indices.truncate(4),
        ];
        good.check().unwrap();
        for (i, break_it) in breaks.iter().enumerate() {
            let mut bad = good.clone();
            break_it(&mut bad);
            assert!(bad.check().is_err(), "break {i}");
        }
    }
}
