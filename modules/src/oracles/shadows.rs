//! Projections, shadow comparisons and their filters.

use std::f64::consts::FRAC_PI_4;

use glam::{DMat4, DVec3, DVec4};

/// Perspective with a depth of 0 at `near` and 1 at `far`, looking along -z, y up; `fov` is the full vertical angle.
pub fn perspective(fov: f64, aspect: f64, near: f64, far: f64) -> DMat4 {
    let f = 1.0 / (fov / 2.0).tan();
    DMat4::from_cols(
        DVec4::new(f / aspect, 0.0, 0.0, 0.0),
        DVec4::new(0.0, f, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -far / (far - near), -1.0),
        DVec4::new(0.0, 0.0, -far * near / (far - near), 0.0),
    )
}

/// Parallel projection of a box of this width and height with a depth of 0 at `near` and 1 at `far`, looking along -z.
pub fn orthographic(width: f64, height: f64, near: f64, far: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(2.0 / width, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 2.0 / height, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -1.0 / (far - near), 0.0),
        DVec4::new(0.0, 0.0, -near / (far - near), 1.0),
    )
}

/// Axis, right and up of the faces of a cube map, as seen from inside, in the order of its layers
/// (WebGPU specification, texture view dimension `cube`).
pub const FACES: [[DVec3; 3]; 6] = [
    [DVec3::X, DVec3::NEG_Z, DVec3::Y],
    [DVec3::NEG_X, DVec3::Z, DVec3::Y],
    [DVec3::Y, DVec3::X, DVec3::NEG_Z],
    [DVec3::NEG_Y, DVec3::X, DVec3::Z],
    [DVec3::Z, DVec3::X, DVec3::Y],
    [DVec3::NEG_Z, DVec3::NEG_X, DVec3::Y],
];

/// Face that a direction points at, and u and v in it, from the upper left corner.
pub fn cube_face(direction: DVec3) -> (usize, f64, f64) {
    let along = |face: &[DVec3; 3]| direction.dot(face[0]);
    let face = (0..6).max_by(|&a, &b| along(&FACES[a]).total_cmp(&along(&FACES[b])));
    let face = face.unwrap_or(0);
    let [axis, right, up] = FACES[face];
    let z = direction.dot(axis);
    (face, 0.5 + 0.5 * direction.dot(right) / z, 0.5 - 0.5 * direction.dot(up) / z)
}

/// View-projection matrix of a face of the cube around `position`.
pub fn cube_view_projection(face: usize, position: DVec3, near: f64, far: f64) -> DMat4 {
    let [axis, right, up] = FACES[face];
    let rows = DMat4::from_cols(right.extend(0.0), up.extend(0.0), (-axis).extend(0.0), DVec4::W).transpose();
    perspective(2.0 * FRAC_PI_4, 1.0, near, far) * rows * DMat4::from_translation(-position)
}

/// Depth of a distance along the axis of a perspective.
pub fn perspective_depth(z: f64, near: f64, far: f64) -> f64 {
    let clip = perspective(1.0, 1.0, near, far) * DVec4::new(0.0, 0.0, -z, 1.0);
    clip.z / clip.w
}

/// Whether a receiver at `depth` is lit where `stored` is the nearest depth. Williams 1978.
pub fn lit(depth: f64, stored: f64) -> bool {
    depth <= stored
}

/// Share of the taps at whole texels within `radius` that are lit, weighted by a tent that is 0 at `radius` + 1.
pub fn tent_filter(radius: i32, lit: impl Fn(i32, i32) -> bool) -> f64 {
    let reach = f64::from(radius + 1);
    let tent = |x: i32| (reach - f64::from(x.abs())) / (reach * reach);
    let taps = (-radius..=radius).flat_map(|y| (-radius..=radius).map(move |x| (x, y)));
    taps.filter(|&(x, y)| lit(x, y)).map(|(x, y)| tent(x) * tent(y)).sum()
}
