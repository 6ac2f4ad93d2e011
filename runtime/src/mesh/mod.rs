//! Triangle meshes: primitives, the Utah teapot, glTF files.
//!
//! Every mesh is in metres, right-handed with y up, counter-clockwise seen from outside, and complete: whoever makes one
//! also gives normals, tangents and texture coordinates, so that no later stage has to ask.

mod attributes;
pub mod gltf;
mod primitives;
pub mod teapot;

pub use attributes::{flat_normals, generate_tangents, smooth_normals};
pub use primitives::{MAX_SEGMENTS, Primitive};

pub use crate::frame::{Bounds, Mesh};
use glam::Vec3;

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
