//! Eyes: the camera's and those of shadow maps. Depth runs from 0 (near) to 1 (far).

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::{Bounds, Camera};

/// One view of the scene, as shaders get it in `frame` and, for a shadow map, in `Views`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Eye {
    pub view_projection: Mat4,
    pub position: Vec3,
    pub forward: Vec3,
    pub perspective: bool,
    pub near: f32,
    pub far: f32,
    /// Side of a texel at 1 m, or anywhere in an orthographic view, m.
    pub texel: f32,
    pub time: f32,
    pub size: Vec2,
}

/// Right, up and forward of the faces of a cube map in the order +X, -X, +Y, -Y, +Z, -Z. They follow from the table in the
/// Vulkan specification, "Cube Map Face Selection": seen from inside, a cube map is mirrored, so right x up = forward.
const FACES: [[Vec3; 3]; 6] = [
    [Vec3::NEG_Z, Vec3::Y, Vec3::X],
    [Vec3::Z, Vec3::Y, Vec3::NEG_X],
    [Vec3::X, Vec3::NEG_Z, Vec3::Y],
    [Vec3::X, Vec3::Z, Vec3::NEG_Y],
    [Vec3::X, Vec3::Y, Vec3::Z],
    [Vec3::NEG_X, Vec3::Y, Vec3::NEG_Z],
];

/// Near plane of a shadow map as a share of its far plane: closer things cast no shadow. With 1/1000 the depth of a
/// 32-bit float map still resolves 1/16 mm per metre of range at the far end.
const NEAR: f32 = 1e-3;

/// How large a shadow map's view is, and of what.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapSize {
    /// Side in texels.
    pub texels: u32,
    /// Everything that casts or receives.
    pub scene: Bounds,
    pub time: f32,
}

/// World space to clip space for an eye with these axes: x by `right` / `scale`, y by `up` / `scale`, w along `forward`.
fn perspective(origin: Vec3, [right, up, forward]: [Vec3; 3], scale: f32, near: f32, far: f32) -> Mat4 {
    let depth = far / (far - near);
    let row = |axis: Vec3, offset: f32| axis.extend(offset - axis.dot(origin));
    Mat4::from_cols(
        row(right / scale, 0.0),
        row(up / scale, 0.0),
        row(forward * depth, -near * depth),
        row(forward, 0.0),
    )
    .transpose()
}

/// An up vector that is not along `forward`, and the right one to it.
fn axes(forward: Vec3) -> [Vec3; 3] {
    let forward = forward.normalize_or(Vec3::NEG_Y);
    let helper = if forward.y.abs() < 0.99 { Vec3::Y } else { Vec3::Z };
    let right = forward.cross(helper).normalize();
    [right, right.cross(forward), forward]
}

impl Eye {
    /// The camera's.
    pub fn of_camera(camera: &Camera, size: [u32; 2], time: f32) -> Self {
        Self {
            view_projection: camera.view_projection(),
            position: camera.eye(),
            forward: camera.forward(),
            perspective: camera.is_perspective(),
            near: 0.0,
            far: 0.0,
            texel: 0.0,
            time,
            size: Vec2::new(size[0] as f32, size[1] as f32),
        }
    }

    /// Far plane of a light: its range, but not beyond the scene.
    fn far(position: Vec3, range: Option<f32>, scene: &Bounds) -> f32 {
        let whole = scene.corners().iter().map(|c| c.distance(position)).fold(0.0, f32::max);
        let far = match range {
            Some(range) if range > 0.0 => range.min(whole),
            _ => whole,
        };
        // A scene of one point at the light's place still has a view.
        if far > 0.0 && far.is_finite() { far } else { 1.0 }
    }

    /// Six views around a position, in the order of a cube map's faces.
    pub fn cube(position: Vec3, range: Option<f32>, map: &MapSize) -> [Self; 6] {
        let far = Self::far(position, range, &map.scene);
        FACES.map(|face| Self::toward(position, face, 1.0, far, map))
    }

    /// One view along a direction, `tangent` wide to each side: the tangent of half the opening angle.
    pub fn spot(position: Vec3, direction: Vec3, tangent: f32, range: Option<f32>, map: &MapSize) -> Self {
        let far = Self::far(position, range, &map.scene);
        Self::toward(position, axes(direction), tangent, far, map)
    }

    fn toward(position: Vec3, face: [Vec3; 3], tangent: f32, far: f32, map: &MapSize) -> Self {
        let near = far * NEAR;
        Self {
            view_projection: perspective(position, face, tangent, near, far),
            position,
            forward: face[2],
            perspective: true,
            near,
            far,
            texel: 2.0 * tangent / map.texels as f32,
            time: map.time,
            size: Vec2::splat(map.texels as f32),
        }
    }

    /// An orthographic view along a direction that holds the whole scene, with one texel to spare around it.
    pub fn parallel(direction: Vec3, map: &MapSize) -> Self {
        let [right, up, forward] = axes(direction);
        let center = map.scene.center();
        let extent = |axis: Vec3| {
            map.scene
                .corners()
                .iter()
                .map(|c| (*c - center).dot(axis).abs())
                .fold(0.0, f32::max)
        };
        let texels = map.texels as f32;
        let half = extent(right).max(extent(up)).max(1e-6) * texels / (texels - 2.0).max(1.0);
        let depth = extent(forward).max(1e-6) * 1.001;
        let position = center - forward * depth;
        let row = |axis: Vec3, scale: f32| (axis / scale).extend(-axis.dot(position) / scale);
        Self {
            view_projection: Mat4::from_cols(row(right, half), row(up, half), row(forward, 2.0 * depth), Vec4::W).transpose(),
            position,
            forward,
            perspective: false,
            near: 0.0,
            far: 2.0 * depth,
            texel: 2.0 * half / texels,
            time: map.time,
            size: Vec2::splat(texels),
        }
    }

    /// Whether some of the box may be seen: not all of its corners are beyond one plane. A box with a NaN is seen.
    pub fn sees(&self, world: &Bounds) -> bool {
        let clip = world.corners().map(|c| self.view_projection * c.extend(1.0));
        let beyond = |plane: fn(&Vec4) -> bool| clip.iter().all(plane);
        !(beyond(|c| c.x > c.w)
            || beyond(|c| c.x < -c.w)
            || beyond(|c| c.y > c.w)
            || beyond(|c| c.y < -c.w)
            || beyond(|c| c.z > c.w)
            || beyond(|c| c.z < 0.0))
    }

    /// Distance of a point along the view.
    pub fn depth_of(&self, point: Vec3) -> f32 {
        (point - self.position).dot(self.forward)
    }

    /// Components of a member of the `frame` block or of a `View`, by name.
    pub fn member(&self, name: &str) -> Option<Vec<f64>> {
        let list = |values: &[f32]| Some(values.iter().map(|v| f64::from(*v)).collect());
        match name {
            "view_projection" => list(&self.view_projection.to_cols_array()),
            "eye" | "position" => list(&self.position.to_array()),
            "forward" => list(&self.forward.to_array()),
            "perspective" => list(&[f32::from(u8::from(self.perspective))]),
            "near" => list(&[self.near]),
            "far" => list(&[self.far]),
            "texel" => list(&[self.texel]),
            "time" => list(&[self.time]),
            "size" => list(&self.size.to_array()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> MapSize {
        MapSize {
            texels: 64,
            scene: Bounds {
                min: Vec3::new(-3.0, 0.0, -1.0),
                max: Vec3::new(5.0, 2.0, 4.0),
            },
            time: 0.0,
        }
    }

    /// Face, s and t of a direction, from the Vulkan specification's table.
    fn select(d: Vec3) -> (usize, f32, f32) {
        let a = d.abs();
        let (face, sc, tc, ma) = if a.x >= a.y && a.x >= a.z {
            if d.x > 0.0 { (0, -d.z, -d.y, a.x) } else { (1, d.z, -d.y, a.x) }
        } else if a.y >= a.z {
            if d.y > 0.0 { (2, d.x, d.z, a.y) } else { (3, d.x, -d.z, a.y) }
        } else if d.z > 0.0 {
            (4, d.x, -d.y, a.z)
        } else {
            (5, -d.x, -d.y, a.z)
        };
        (face, (sc / ma + 1.0) * 0.5, (tc / ma + 1.0) * 0.5)
    }

    /// Catches a face that is turned, mirrored or out of order: what is drawn in a direction must be sampled there.
    #[test]
    fn cube_faces_match_the_sampling_table() {
        let position = Vec3::new(0.5, 1.0, -0.25);
        let eyes = Eye::cube(position, Some(2.0), &map());
        for i in 0..500 {
            let t = i as f32 * 0.7;
            let d = Vec3::new(t.sin() * 1.3, (t * 1.7).cos(), (t * 2.3).sin() * 0.8);
            let (face, s, t) = select(d);
            let clip = eyes[face].view_projection * (position + d * 0.9).extend(1.0);
            let ndc = clip.truncate() / clip.w;
            assert!(
                (ndc.x * 0.5 + 0.5 - s).abs() < 1e-5 && (0.5 - ndc.y * 0.5 - t).abs() < 1e-5,
                "{d} {ndc} {s} {t}"
            );
            assert!((0.0..=1.0).contains(&ndc.z));
        }
    }

    /// Catches a light's view that leaves out a part of the scene, or clips it in depth.
    #[test]
    fn parallel_view_holds_the_scene() {
        for direction in [Vec3::NEG_Y, Vec3::new(0.3, -1.0, 0.2), Vec3::X, Vec3::ZERO] {
            let eye = Eye::parallel(direction, &map());
            for corner in map().scene.corners() {
                let clip = eye.view_projection * corner.extend(1.0);
                assert!(
                    clip.x.abs() < 1.0 && clip.y.abs() < 1.0 && (0.0..=1.0).contains(&clip.z) && clip.w == 1.0,
                    "{clip}"
                );
            }
            assert!(eye.sees(&map().scene));
        }
    }

    /// Catches near and far swapped, and a wrong opening.
    #[test]
    fn spot_view_reaches_from_near_to_far() {
        let eye = Eye::spot(Vec3::new(0.0, 5.0, 0.0), Vec3::new(0.0, -2.0, 0.0), 0.5, Some(4.0), &map());
        let at = |p: Vec3| {
            let clip = eye.view_projection * p.extend(1.0);
            clip.truncate() / clip.w
        };
        assert!(at(Vec3::new(0.0, 5.0 - 0.004, 0.0)).z.abs() < 1e-3);
        assert!((at(Vec3::new(0.0, 1.0, 0.0)).z - 1.0).abs() < 1e-5);
        let edge = at(Vec3::new(1.0, 3.0, 0.0));
        assert!(
            (edge.x.abs().max(edge.y.abs()) - 1.0).abs() < 1e-5,
            "1 m aside at 2 m is the edge: {edge}"
        );
        assert!(!eye.sees(&Bounds {
            min: Vec3::splat(6.0),
            max: Vec3::splat(7.0)
        }));
    }
}
