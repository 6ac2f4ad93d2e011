//! What there is to see: one object, a sun, a lamp, a camera. Lengths in m, colours linear Rec.709.

use std::f32::consts::TAU;

/// A 4x4 matrix by columns.
pub type Matrix = [[f32; 4]; 4];

/// How the object's surface is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// Scatters evenly.
    Matte,
    /// Has highlights.
    Glossy,
}

impl Finish {
    /// The module that fills the slot `brdf`.
    pub fn module(self) -> &'static str {
        match self {
            Self::Matte => "lambert",
            Self::Glossy => "microfacet",
        }
    }
}

/// A moment.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// How the surface is.
    pub finish: Finish,
    /// Its albedo.
    pub base_color: [f32; 3],
    /// Its perceptual roughness, where the finish has one.
    pub roughness: f32,
    /// Object space to world space: a rotation.
    pub model: Matrix,
    /// World space to clip space.
    pub view_projection: Matrix,
    /// Where the camera is.
    pub eye: [f32; 3],
    /// Where it looks, unit length.
    pub forward: [f32; 3],
    /// Where the sun's light travels to.
    pub sun_direction: [f32; 3],
    /// Illuminance perpendicular to it, lx.
    pub sun_lux: f32,
    /// Where the lamp is.
    pub lamp_position: [f32; 3],
    /// Its luminous intensity, cd.
    pub lamp_candela: f32,
}

impl World {
    /// The ring at a share of its turn in [0, 1), seen from 4 m.
    pub fn at(turn: f32, finish: Finish) -> Self {
        let (sin, cos) = (TAU * (0.1 + 0.2 * turn)).sin_cos();
        let eye = [0.0, 0.0, 4.0];
        Self {
            finish,
            base_color: [0.7, 0.35, 0.15],
            roughness: 0.3,
            model: [
                [1.0, 0.0, 0.0, 0.0],
                [0.0, cos, sin, 0.0],
                [0.0, -sin, cos, 0.0],
                [0.0, 0.0, 0.0, 1.0],
            ],
            view_projection: view_projection(eye, 50_f32.to_radians()),
            eye,
            forward: [0.0, 0.0, -1.0],
            sun_direction: [-1.0, -1.0, -1.0],
            sun_lux: 2000.0,
            lamp_position: [-2.0, 0.5, 1.5],
            lamp_candela: 3000.0,
        }
    }

    /// Transposed inverse of the model matrix's upper part, by columns: of a rotation it is that part itself.
    pub fn normal_matrix(&self) -> [[f32; 4]; 3] {
        [self.model[0], self.model[1], self.model[2]]
    }
}

/// A camera that looks along -z: depth 0 at 0.1 m, 1 at 100 m; `angle` is the whole height of its picture, in rad.
fn view_projection(eye: [f32; 3], angle: f32) -> Matrix {
    let (near, far) = (0.1, 100.0);
    let f = 1.0 / (angle / 2.0).tan();
    let (a, b) = (far / (near - far), near * far / (near - far));
    let [x, y, z] = eye;
    [
        [f, 0.0, 0.0, 0.0],
        [0.0, f, 0.0, 0.0],
        [0.0, 0.0, a, -1.0],
        [-f * x, -f * y, b - a * z, z],
    ]
}
