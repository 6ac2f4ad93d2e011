//! Normals and tangents for meshes that come without.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace};
use glam::Vec3;

use super::Mesh;

/// Makes every triangle flat: no vertex is shared any more, and each has its triangle's normal. This is what glTF 2.0
/// (section 3.7.2.1) asks for where a file gives no normals. Triangles without area are dropped, as they have no normal.
pub fn flat_normals(mesh: &mut Mesh) {
    let mut flat = Mesh::default();
    for corners in mesh.indices.chunks_exact(3) {
        let p = [0, 1, 2].map(|k| Vec3::from(mesh.positions[corners[k] as usize]));
        let Some(normal) = (p[1] - p[0]).cross(p[2] - p[0]).try_normalize() else {
            continue;
        };
        for k in 0..3 {
            let old = corners[k] as usize;
            flat.indices.push(flat.positions.len() as u32);
            flat.positions.push(p[k].to_array());
            flat.normals.push(normal.to_array());
            flat.uvs.push(mesh.uvs.get(old).copied().unwrap_or([0.0; 2]));
        }
    }
    *mesh = flat;
}

/// Gives every vertex the mean normal of its triangles, weighted by area. Vertices that no triangle with an area uses get the y axis.
pub fn smooth_normals(mesh: &mut Mesh) {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for corners in mesh.indices.chunks_exact(3) {
        let p = [0, 1, 2].map(|k| Vec3::from(mesh.positions[corners[k] as usize]));
        let area = (p[1] - p[0]).cross(p[2] - p[0]);
        for &corner in corners {
            sums[corner as usize] += area;
        }
    }
    mesh.normals = sums.iter().map(|s| s.normalize_or(Vec3::Y).to_array()).collect();
}

struct Corners<'a> {
    mesh: &'a Mesh,
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.indices[face * 3 + corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles()
    }
    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }
    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, vert)]
    }
    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, vert)]
    }
    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        // MikkTSpace takes v up; ours is down.
        let [u, v] = self.mesh.uvs[self.vertex(face, vert)];
        [u, 1.0 - v]
    }
    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, vert: usize) {
        let normal = Vec3::from(self.normal(face, vert));
        let encoded = space.map_or([0.0, 0.0, 0.0, 1.0], |s| s.tangent_encoded());
        let tangent = Vec3::from_slice(&encoded);
        // Against the normal, so that the frame is orthogonal; any direction serves where the texture coordinates give none.
        let tangent = (tangent - normal * normal.dot(tangent))
            .try_normalize()
            .unwrap_or_else(|| normal.any_orthonormal_vector());
        self.tangents[face * 3 + vert] = [tangent.x, tangent.y, tangent.z, encoded[3]];
    }
}

/// Tangents by MikkTSpace (Mikkelsen 2008), which is what glTF 2.0 asks for where a file gives none. A vertex whose triangles
/// disagree (mirrored texture coordinates) is split, so the mesh may gain vertices. Vertices that no triangle uses are dropped.
pub fn generate_tangents(mesh: &mut Mesh) {
    let mut corners = Corners {
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; mesh.indices.len()],
        mesh,
    };
    // The error has no variants: the generator cannot fail.
    let _ = bevy_mikktspace::generate_tangents(&mut corners);
    let tangents = corners.tangents;

    let mut made = Mesh::default();
    let mut known: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    for (&old, tangent) in mesh.indices.iter().zip(&tangents) {
        let index = *known.entry((old, tangent.map(f32::to_bits))).or_insert_with(|| {
            let at = old as usize;
            made.positions.push(mesh.positions[at]);
            made.normals.push(mesh.normals[at]);
            made.uvs.push(mesh.uvs[at]);
            made.tangents.push(*tangent);
            (made.positions.len() - 1) as u32
        });
        made.indices.push(index);
    }
    *mesh = made;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad() -> Mesh {
        Mesh {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 4],
            tangents: vec![],
            uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
            indices: vec![0, 1, 2, 0, 2, 3],
        }
    }

    /// Catches a bitangent that points up the picture while v runs down (a normal map lit from the wrong side).
    #[test]
    fn tangents_follow_the_texture() {
        let mut mesh = quad();
        generate_tangents(&mut mesh);
        mesh.check().unwrap();
        assert_eq!(mesh.positions.len(), 4);
        for (n, t) in mesh.normals.iter().zip(&mesh.tangents) {
            assert_eq!(t[..3], [1.0, 0.0, 0.0]);
            let bitangent = Vec3::from(*n).cross(Vec3::from_slice(t)) * t[3];
            // glTF: the green axis of a normal map points to growing +y of the picture, against v.
            assert_eq!(bitangent, Vec3::Y);
        }
    }

    /// Catches one tangent being kept for both sides of a mirror seam.
    #[test]
    fn a_mirrored_seam_is_split() {
        let mut mesh = Mesh {
            positions: vec![[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 4],
            tangents: vec![],
            uvs: vec![[1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [1.0, 1.0]],
            indices: vec![0, 1, 2, 1, 3, 2],
        };
        generate_tangents(&mut mesh);
        mesh.check().unwrap();
        assert_eq!(mesh.positions.len(), 6);
        assert_eq!(mesh.tangents.iter().filter(|t| t[3] < 0.0).count(), 3);
    }

    /// Catches NaN from texture coordinates that are all the same.
    #[test]
    fn no_texture_still_gives_a_frame() {
        let mut mesh = quad();
        mesh.uvs = vec![[0.0; 2]; 4];
        generate_tangents(&mut mesh);
        mesh.check().unwrap();
    }

    /// Catches shared vertices, whose flat normals would be the last triangle's, and NaN from a sliver.
    #[test]
    fn flat_and_smooth() {
        let mut bent = Mesh {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [2.0, 0.0, 0.0]],
            uvs: vec![[0.0; 2]; 5],
            indices: vec![0, 1, 2, 0, 2, 3, 0, 1, 4],
            ..Mesh::default()
        };
        let mut smooth = bent.clone();
        smooth_normals(&mut smooth);
        let half = std::f32::consts::FRAC_1_SQRT_2;
        assert!((Vec3::from(smooth.normals[0]) - Vec3::new(half, 0.0, half)).length() < 1e-6);
        assert_eq!(smooth.normals[4], [0.0, 1.0, 0.0]);
        flat_normals(&mut bent);
        assert_eq!(bent.triangles(), 2);
        assert_eq!(bent.normals[0], [0.0, 0.0, 1.0]);
        assert_eq!(bent.normals[3], [1.0, 0.0, 0.0]);
    }
}
