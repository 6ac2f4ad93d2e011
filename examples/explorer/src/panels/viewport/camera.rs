//! Turning, moving and zooming a camera around what it looks at.

use glam::{Quat, Vec2, Vec3};
use serde::Serialize;
use shadewright_runtime::frame::Frame;
use shadewright_runtime::scene::Scene;

/// As near to straight up or down as a camera is turned, radians: beyond that its picture would turn over.
const NEAREST_POLE: f32 = 0.02;

/// A camera that looks at something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// As a scene has it.
    pub decl: Decl,
}

/// A scene's camera, written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Decl {
    /// m
    pub eye: (f32, f32, f32),
    /// m
    pub target: (f32, f32, f32),
    /// Up in the picture.
    pub up: (f32, f32, f32),
    /// Vertical, degrees.
    pub fov: f32,
    /// m
    pub near: f32,
    /// m
    pub far: f32,
}

impl Camera {
    /// The scene's camera; where a file brings it, what the frame was seen by.
    pub fn of(scene: &Scene, frame: &Frame) -> Self {
        let tuple = |v: [f32; 3]| (v[0], v[1], v[2]);
        if let Some(decl) = scene.camera {
            return Self {
                decl: Decl {
                    eye: tuple(decl.eye),
                    target: tuple(decl.target),
                    up: tuple(decl.up),
                    fov: decl.fov,
                    near: decl.near,
                    far: decl.far,
                },
            };
        }
        let (eye, forward) = (frame.camera.eye(), frame.camera.forward());
        let boxes = frame.draws.iter().map(|draw| draw.bounds.transformed(&draw.model));
        let middle = boxes.reduce(|a, b| a.union(&b)).map_or(Vec3::ZERO, |whole| whole.center());
        // The point of the view that is nearest to the middle of what there is.
        let away = (middle - eye).dot(forward).max(0.1);
        let tangent = 1.0 / frame.camera.projection.y_axis.y.abs().max(1e-6);
        Self {
            decl: Decl {
                eye: eye.into(),
                target: (eye + forward * away).into(),
                up: (0.0, 1.0, 0.0),
                fov: (2.0 * tangent.atan()).to_degrees(),
                near: away / 1000.0,
                far: away * 1000.0,
            },
        }
    }

    fn parts(&self) -> (Vec3, Vec3, Vec3) {
        let up = Vec3::from(self.decl.up).normalize_or(Vec3::Y);
        (self.decl.eye.into(), self.decl.target.into(), up)
    }

    /// Turns it around what it looks at, by shares of the picture's height: to the right and down.
    pub fn orbit(&mut self, by: Vec2) {
        let (eye, target, up) = self.parts();
        let arm = eye - target;
        let arm = Quat::from_axis_angle(up, -by.x * std::f32::consts::PI) * arm;
        let pole = arm.angle_between(up);
        let tilt = (pole - by.y * std::f32::consts::PI).clamp(NEAREST_POLE, std::f32::consts::PI - NEAREST_POLE) - pole;
        let side = up.cross(arm).normalize_or(Vec3::X);
        self.decl.eye = (target + Quat::from_axis_angle(side, tilt) * arm).into();
    }

    /// Moves it in the plane of the picture, by shares of its height, so that what it looks at follows the mouse.
    pub fn pan(&mut self, by: Vec2) {
        let (eye, target, up) = self.parts();
        let arm = target - eye;
        let right = arm.cross(up).normalize_or(Vec3::X);
        let above = right.cross(arm).normalize_or(Vec3::Y);
        let height = 2.0 * arm.length() * (self.decl.fov.to_radians() * 0.5).tan();
        let moved = (above * by.y - right * by.x) * height;
        self.decl.eye = (eye + moved).into();
        self.decl.target = (target + moved).into();
    }

    /// Goes nearer to what it looks at (positive) or away, by e-folds of the distance.
    pub fn zoom(&mut self, by: f32) {
        let (eye, target, _) = self.parts();
        let length = (eye - target).length() * (-by).exp();
        // Not through what it looks at, and not so far that nothing is left.
        let length = length.clamp(self.decl.near * 1.5, self.decl.far * 0.8);
        let arm = (eye - target).normalize_or(Vec3::Z) * length;
        self.decl.eye = (target + arm).into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            decl: Decl {
                eye: (0.0, 0.0, 5.0),
                target: (0.0, 0.0, 0.0),
                up: (0.0, 1.0, 0.0),
                fov: 90.0,
                near: 0.1,
                far: 100.0,
            },
        }
    }

    fn near(a: (f32, f32, f32), b: Vec3) {
        assert!(Vec3::from(a).distance(b) < 1e-4, "{a:?} {b}");
    }

    /// Catches a drag that goes the other way, a distance that changes, and a camera that turns over at a pole.
    #[test]
    fn orbits_keep_their_distance() {
        let mut turned = camera();
        turned.orbit(Vec2::new(0.5, 0.0));
        near(turned.decl.eye, Vec3::new(-5.0, 0.0, 0.0));
        let mut tilted = camera();
        tilted.orbit(Vec2::new(0.0, 0.25));
        near(tilted.decl.eye, Vec3::new(0.0, 1.0, 1.0).normalize() * 5.0);
        (0..20).for_each(|_| tilted.orbit(Vec2::new(0.0, 0.25)));
        let eye = Vec3::from(tilted.decl.eye);
        assert!((eye.length() - 5.0).abs() < 1e-3 && eye.y > 4.99 && eye.z > 0.0, "{eye}");
    }

    /// Catches a picture that does not follow the mouse, and a zoom through the target.
    #[test]
    fn pans_follow_and_zooms_stop() {
        let mut moved = camera();
        moved.pan(Vec2::new(0.5, 0.25));
        near(moved.decl.target, Vec3::new(-5.0, 2.5, 0.0));
        near(moved.decl.eye, Vec3::new(-5.0, 2.5, 5.0));
        let mut zoomed = camera();
        zoomed.zoom(2.0_f32.ln());
        near(zoomed.decl.eye, Vec3::new(0.0, 0.0, 2.5));
        zoomed.zoom(100.0);
        near(zoomed.decl.eye, Vec3::new(0.0, 0.0, 0.15));
        zoomed.zoom(-100.0);
        near(zoomed.decl.eye, Vec3::new(0.0, 0.0, 80.0));
    }
}
