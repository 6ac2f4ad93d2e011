//! Mesh primitives of a glTF file.

use glam::Vec3;
use gltf::Semantic;
use gltf::mesh::Mode;

use super::{GltfError, accessor, damaged, unsupported};
use crate::frame::Mesh;
use crate::mesh::{MAX_VERTICES, flat_normals, generate_tangents};

/// Reads a primitive, and makes the normals and tangents that it lacks.
pub(super) fn read(primitive: &gltf::Primitive, place: &str, buffers: &[Vec<u8>]) -> Result<Mesh, GltfError> {
    if primitive.mode() != Mode::Triangles {
        return Err(unsupported(place, format!("a primitive of {:?}", primitive.mode())));
    }
    if primitive.morph_targets().next().is_some() {
        return Err(unsupported(place, "a morph target"));
    }
    for (semantic, _) in primitive.attributes() {
        let thing = match semantic {
            Semantic::Colors(_) => "a vertex colour",
            Semantic::Joints(_) | Semantic::Weights(_) => "a skin",
            _ => continue,
        };
        return Err(unsupported(place, thing));
    }
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        return Err(damaged(place, "a primitive without POSITION"));
    };
    let mut mesh = Mesh {
        positions: accessor::floats(&positions, buffers)?,
        ..Mesh::default()
    };
    let n = mesh.positions.len();
    if n > MAX_VERTICES {
        return Err(unsupported(place, format!("a mesh of {n} vertices, more than {MAX_VERTICES},")));
    }
    let matching = |name: &str, len: usize| {
        if len == n {
            Ok(())
        } else {
            Err(damaged(place, format!("{len} of {name} for {n} of POSITION")))
        }
    };
    mesh.uvs = match primitive.get(&Semantic::TexCoords(0)) {
        Some(uvs) => accessor::floats(&uvs, buffers)?,
        None => vec![[0.0; 2]; n],
    };
    matching("TEXCOORD_0", mesh.uvs.len())?;
    mesh.indices = match primitive.indices() {
        Some(indices) => accessor::indices(&indices, buffers)?,
        None => (0..n as u32).collect(),
    };
    if !mesh.indices.len().is_multiple_of(3) {
        return Err(damaged(place, format!("{} indices, not a multiple of 3", mesh.indices.len())));
    }
    if let Some(index) = mesh.indices.iter().find(|&&i| i as usize >= n) {
        return Err(damaged(place, format!("index {index} of {n} vertices")));
    }
    let Some(normals) = primitive.get(&Semantic::Normals) else {
        // Section 3.7.2.1: flat normals, and the tangents of the file, if any, are to be ignored.
        flat_normals(&mut mesh);
        generate_tangents(&mut mesh);
        return Ok(mesh);
    };
    mesh.normals = accessor::floats(&normals, buffers)?;
    matching("NORMAL", mesh.normals.len())?;
    for normal in &mut mesh.normals {
        *normal = Vec3::from(*normal).normalize_or(Vec3::Y).to_array();
    }
    match primitive.get(&Semantic::Tangents) {
        Some(tangents) => {
            mesh.tangents = accessor::floats(&tangents, buffers)?;
            matching("TANGENT", mesh.tangents.len())?;
            for (t, n) in mesh.tangents.iter_mut().zip(&mesh.normals) {
                let unit = Vec3::from_slice(&t[..3])
                    .try_normalize()
                    .unwrap_or_else(|| Vec3::from(*n).any_orthonormal_vector());
                *t = [unit.x, unit.y, unit.z, if t[3] < 0.0 { -1.0 } else { 1.0 }];
            }
        }
        None => generate_tangents(&mut mesh),
    }
    Ok(mesh)
}
