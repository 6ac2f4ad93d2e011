//! What a frame shows: the renderer's whole input, made by a scene or by hand.
//!
//! Everything is in metres and photometric units, right-handed with y up. Modules are spoken of by their *place* in a
//! recipe: the slot path that reflection gives (`main.material`, `main.brdf.ndf`, `main.lights[0]`; `main` is the root).

use std::sync::Arc;

use glam::{Mat4, Vec3};
use indexmap::IndexMap;
use shadewright_compiler::manifest::{Node, Value};

/// One frame.
#[derive(Clone, Debug)]
pub struct Frame {
    /// From where.
    pub camera: Camera,
    /// Width and height of the target in texels; neither is 0.
    pub size: [u32; 2],
    /// Seconds since the first frame.
    pub time: f32,
    /// Radiance where nothing is drawn, cd/m2 per channel.
    pub background: Vec3,
    /// What draws are made of; [`Draw::material`] counts into it.
    pub materials: Vec<Material>,
    /// Objects in any order.
    pub draws: Vec<Draw>,
    /// The lights, one entry for each kind that a recipe's list holds.
    pub lights: Vec<Lights>,
    /// From the HDR frame to the display image. `None`: only the HDR frame is made.
    pub display: Option<Material>,
}

/// A camera, or any other eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World space to view space: the eye in the origin, looking along -z.
    pub view: Mat4,
    /// View space to clip space, depth 0 (near) to 1 (far); not reversed.
    pub projection: Mat4,
}

/// A recipe with the values of its parameters: a surface's look, or the display pass.
#[derive(Clone, Debug)]
pub struct Material {
    /// The tree. For an object that receives no light: a tree whose list of lights is empty.
    pub recipe: Arc<Node>,
    /// What its parameters and textures are.
    pub settings: Settings,
}

/// Values of parameters, textures and data. What is not here has the module's default; a texture that is not here is white.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// By place (`main.material`) or name of the instance, then by parameter.
    pub params: IndexMap<String, IndexMap<String, Value>>,
    /// By place or name of the instance, then by the name of the resource.
    pub textures: IndexMap<String, IndexMap<String, Arc<Texture>>>,
    /// By place or name of the instance, then by the name of the resource: see [`crate::data`].
    pub data: IndexMap<String, IndexMap<String, Arc<[f32]>>>,
}

/// An object.
#[derive(Clone, Debug)]
pub struct Draw {
    /// Its triangles, in object space. Draws that share the allocation are batched.
    pub mesh: Arc<Mesh>,
    /// Index into [`Frame::materials`].
    pub material: usize,
    /// Object space to world space.
    pub model: Mat4,
    /// Of the mesh as the geometry modules leave it, in object space; used for culling and for the views of shadow maps.
    pub bounds: Bounds,
    /// Drawn by the camera. An invisible object still casts its shadow.
    pub visible: bool,
    /// Drawn after the opaque ones, back to front, over what is there by the opacity that the shader writes.
    pub alpha_blend: bool,
    /// Both sides are drawn.
    pub double_sided: bool,
    /// Drawn into shadow maps.
    pub casts_shadow: bool,
}

/// A triangle mesh. Attributes that a recipe does not read may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// m
    pub positions: Vec<[f32; 3]>,
    /// Unit length.
    pub normals: Vec<[f32; 3]>,
    /// Direction of growing u, unit length; w is the sign of the bitangent, cross(normal, tangent) * w.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates, (0, 0) at the first texel of the first row.
    pub uvs: Vec<[f32; 2]>,
    /// Three for each triangle, counter-clockwise seen from the front.
    pub indices: Vec<u32>,
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

/// All lights of one kind: one element of a recipe's list of lights.
#[derive(Clone, Debug)]
pub struct Lights {
    /// The subtree as it stands in the recipes; equal subtrees have equal lights.
    pub node: Node,
    /// Fields of `instances[i]` for each light, in order; a field that is not there has its default.
    pub instances: Vec<IndexMap<String, Value>>,
}

/// An image for a texture: rows from the top, eight bits for each of red, green, blue and alpha, not premultiplied.
/// Whether it is sRGB-encoded is up to the module's declaration of the resource. Smaller levels are made when it is uploaded.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub rgba: Vec<u8>,
}

impl Camera {
    /// World space to clip space.
    pub fn view_projection(&self) -> Mat4 {
        self.projection * self.view
    }

    /// Position of the eye in world space, m.
    pub fn eye(&self) -> Vec3 {
        self.view.inverse().w_axis.truncate()
    }

    /// Direction of view in world space, unit length.
    pub fn forward(&self) -> Vec3 {
        -self.view.inverse().z_axis.truncate().normalize_or(Vec3::Z)
    }

    /// Whether the eye is a point; else all rays are parallel to [`Camera::forward`].
    pub fn is_perspective(&self) -> bool {
        self.projection.w_axis.w == 0.0
    }
}

impl Bounds {
    /// The box around these points; `None` if there are none, or one is not finite.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        points
            .into_iter()
            .map(|p| p.is_finite().then_some(Self { min: p, max: p }))
            .reduce(|a, b| Some(a?.union(&b?)))
            .flatten()
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            Vec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }

    /// The box around the transformed corners.
    #[must_use]
    pub fn transformed(&self, by: &Mat4) -> Self {
        let mut moved = self.corners().map(|corner| by.transform_point3(corner)).into_iter();
        let first = moved.next().unwrap_or_default();
        moved.fold(Self { min: first, max: first }, |b, p| Self {
            min: b.min.min(p),
            max: b.max.max(p),
        })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Its centre.
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Half of its diagonal: radius of the sphere around it, m.
    pub fn radius(&self) -> f32 {
        (self.max - self.min).length() * 0.5
    }
}
