//! The camera's matrices and the objects' transforms.

use glam::camera::rh::{self, proj::directx};
use glam::{EulerRot, Mat4, Quat, Vec3};
use shadewright_compiler::diagnostics::codes;
use shadewright_compiler::manifest::Step;

use super::CameraDecl;
use super::check::{Examiner, join};
use crate::frame::Camera;
use crate::mesh::gltf;

/// Translation, rotation and scale as a matrix; the angles are degrees about x, then y, then z of the world.
pub(super) fn placed(translate: [f32; 3], rotate: [f32; 3], scale: [f32; 3]) -> Mat4 {
    let [x, y, z] = rotate.map(f32::to_radians);
    Mat4::from_scale_rotation_translation(scale.into(), Quat::from_euler(EulerRot::ZYX, z, y, x), translate.into())
}

/// Checks and makes a transform; `path` is that of the thing that has the fields.
pub(super) fn transform(examiner: &mut Examiner, path: &[Step], translate: [f32; 3], rotate: [f32; 3], scale: [f32; 3]) -> Mat4 {
    let model = placed(translate, rotate, scale);
    let inverse = model.inverse();
    if !model.is_finite() || !inverse.is_finite() || scale.contains(&0.0) {
        examiner.error(
            &join(path, &[Step::Key("scale")]),
            codes::SCENE_INVALID,
            "the transform squeezes the object flat or out of all bounds",
            "numbers must be finite, factors other than 0",
        );
    }
    model
}

/// The camera's matrices.
pub(super) fn camera(examiner: &mut Examiner, decl: &CameraDecl, size: [u32; 2]) -> Camera {
    let (eye, target, up) = (Vec3::from(decl.eye), Vec3::from(decl.target), Vec3::from(decl.up));
    let mut wrong = |field: &'static str, message: &str, label: &str| {
        examiner.error(&[Step::Key("camera"), Step::Key(field)], codes::SCENE_INVALID, message, label);
    };
    let forward = (target - eye).try_normalize();
    match forward {
        None => wrong("target", "the camera has no direction", "is where the eye is"),
        Some(forward) if forward.cross(up.normalize_or_zero()).length() < 1e-4 => {
            wrong("up", "the camera has no up", "along the direction of view, or zero");
        }
        Some(_) => {}
    }
    if !(decl.fov > 0.0 && decl.fov < 180.0) {
        wrong(
            "fov",
            "the field of view is not between 0 and 180 degrees",
            "degrees, from bottom to top",
        );
    }
    if !(decl.near > 0.0 && decl.near < decl.far && decl.far.is_finite()) {
        wrong("near", "the camera's depths are not 0 < near < far", "m");
    }
    let aspect = size[0] as f32 / size[1].max(1) as f32;
    Camera {
        view: rh::view::look_at_mat4(eye, target, up.normalize_or(Vec3::Y)),
        projection: directx::perspective(decl.fov.to_radians(), aspect, decl.near, decl.far),
    }
}

/// The matrices of a glTF file's camera; `None` for an orthographic one.
pub(super) fn gltf_camera(camera: &gltf::Camera, size: [u32; 2]) -> Option<Camera> {
    let gltf::Perspective { fov, near, far } = camera.perspective?;
    let aspect = size[0] as f32 / size[1].max(1) as f32;
    // A node's scale does not scale its camera's view.
    let axis = |k: usize, fallback: Vec3| camera.world.col(k).truncate().normalize_or(fallback).extend(0.0);
    let world = Mat4::from_cols(axis(0, Vec3::X), axis(1, Vec3::Y), axis(2, Vec3::Z), camera.world.w_axis);
    let projection = match far {
        Some(far) => directx::perspective(fov, aspect, near, far),
        None => directx::perspective_infinite(fov, aspect, near),
    };
    Some(Camera {
        view: world.inverse(),
        projection,
    })
    .filter(|c| c.view.is_finite() && c.projection.is_finite())
}
