//! What is under the mouse: the first triangle that a ray meets.

use glam::{Mat4, Vec2, Vec3};
use shadewright_runtime::frame::{Camera, Draw, Frame};

use crate::App;
use crate::tree::Kind;

/// Selects the material of the object that is there. `at` is a share of the picture, from its upper left corner.
pub(super) fn select(app: &mut App, frame: &Frame, at: Vec2) {
    let Some(draw) = pick(frame, at) else { return };
    let scene = app.document.scene().scene();
    // A frame has the scene's objects first, without those that neither are seen nor cast a shadow.
    let drawn = scene
        .objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.visible || object.casts_shadow);
    let Some((index, object)) = drawn.clone().nth(draw) else {
        let file = app
            .rows
            .iter()
            .find(|row| matches!(row.kind, Kind::Gltf { .. }))
            .map(|row| row.path.clone());
        app.selected = file.unwrap_or_else(|| app.selected.clone());
        return;
    };
    let name = object.name.clone().unwrap_or_else(|| format!("object {}", index + 1));
    app.message = format!("{name}, made of {}", object.material);
    let material = format!("materials{}", crate::document::step_path(&object.material));
    app.selected = material;
    app.tree.scroll_to = true;
}

/// Number of the nearest draw that is seen there.
pub fn pick(frame: &Frame, at: Vec2) -> Option<usize> {
    let (origin, direction) = ray(&frame.camera, at)?;
    let mut nearest: Option<(f32, usize)> = None;
    for (index, draw) in frame.draws.iter().enumerate().filter(|(_, draw)| draw.visible) {
        if let Some(distance) = meets(draw, origin, direction)
            && nearest.is_none_or(|(best, _)| distance < best)
        {
            nearest = Some((distance, index));
        }
    }
    nearest.map(|(_, index)| index)
}

/// From the near plane through a point of the picture.
fn ray(camera: &Camera, at: Vec2) -> Option<(Vec3, Vec3)> {
    let back = camera.view_projection().inverse();
    let (x, y) = (2.0 * at.x - 1.0, 1.0 - 2.0 * at.y);
    let near = back.project_point3(Vec3::new(x, y, 0.0));
    // Not the far plane: it may be infinitely far away.
    let beyond = back.project_point3(Vec3::new(x, y, 0.5));
    let direction = (beyond - near).try_normalize()?;
    near.is_finite().then_some((near, direction))
}

/// Distance along the ray to the nearest triangle of a draw.
fn meets(draw: &Draw, origin: Vec3, direction: Vec3) -> Option<f32> {
    let inverse: Mat4 = draw.model.inverse();
    // Not normalised: distances stay those of the world.
    let (o, d) = (inverse.transform_point3(origin), inverse.transform_vector3(direction));
    if !enters(draw.bounds.min, draw.bounds.max, o, d) {
        return None;
    }
    let corner = |index: u32| draw.mesh.positions.get(index as usize).map(|p| Vec3::from(*p));
    let (triangles, _) = draw.mesh.indices.as_chunks::<3>();
    let distances = triangles
        .iter()
        .filter_map(|[a, b, c]| triangle([corner(*a)?, corner(*b)?, corner(*c)?], o, d));
    distances.reduce(f32::min)
}

/// Whether a ray meets a box.
fn enters(min: Vec3, max: Vec3, o: Vec3, d: Vec3) -> bool {
    let (a, b) = ((min - o) / d, (max - o) / d);
    let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
    // A ray in a side's plane has NaN there, of which nothing is said.
    !(near > far || far < 0.0)
}

/// Möller and Trumbore 1997: distance to a triangle, from either side.
fn triangle([a, b, c]: [Vec3; 3], o: Vec3, d: Vec3) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let p = d.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let from = (o - a) / determinant;
    let u = from.dot(p);
    let q = from.cross(ab);
    let v = d.dot(q);
    let t = ac.dot(q);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use shadewright_compiler::Catalog;
    use shadewright_runtime::scene::SceneFile;

    use super::*;

    /// Catches a picture that is mirrored or upside down for the mouse, an object behind another, and a hole that is taken for the object.
    #[test]
    fn the_nearest_object_is_picked() {
        let text = r#"(
            camera: (eye: (0.0, 0.0, 10.0), target: (0.0, 0.0, 0.0), fov: 40.0), pass: "forward",
            meshes: {"ball": Sphere(radius: 1.0), "ring": Torus(radius: 1.0, tube: 0.1)},
            materials: {"m": {"material": "metalness"}},
            objects: [
                (mesh: "ball", material: "m", translate: (1.5, 1.5, -3.0), scale: (3.0, 1.0, 1.0)), (mesh: "ball", material: "m", translate: (-2.0, 0.0, 0.0)),
                (mesh: "ball", material: "m", translate: (-2.0, 0.0, -4.0)), (mesh: "ring", material: "m", translate: (2.0, -1.5, 0.0), rotate: (90.0, 0.0, 0.0)),
            ],
        )"#;
        let catalog = Catalog::load(shadewright_modules::library()).unwrap();
        let frame = SceneFile::parse("test", text, Path::new(""))
            .unwrap()
            .frame(&catalog, Some([100, 100]))
            .unwrap();
        let at = |x: f32, y: f32| {
            let clip = frame.camera.view_projection().project_point3(Vec3::new(x, y, 0.0));
            pick(&frame, Vec2::new(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y))
        };
        assert_eq!(at(1.2, 1.2), Some(0));
        assert_eq!(at(-2.0, 0.0), Some(1));
        assert_eq!(at(0.0, -3.0), None);
        assert_eq!(at(2.0, -1.5), None, "the hole of the ring");
        assert_eq!(at(3.0, -1.5), Some(3));
    }
}
