//! Fills the bindings of a frame's programs by what reflection says of them. Nothing here knows a module's name.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{Mat3, Mat4};
use shadewright_compiler::manifest::{Node, ResourceKind};
use shadewright_compiler::program::Program;
use shadewright_compiler::reflect::{Binding, BindingType, Fill, Layout, ParamUse, Reflection};

use super::list::List;
use super::maps::{Map, MapUse, lights_of, setting};
use super::programs::{Programs, instance};
use super::upload::Uploads;
use super::view::Eye;
use super::{Frame, Settings};
use crate::gpu::layout::{GROUPS, view_dimension};
use crate::gpu::pack::{put_members, size_with};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::resources::{Bound, bind_group, instance_rows, param_blocks, sampler, stand_in};
use crate::gpu::{DataError, Gpu, GpuError, RuntimeError};

/// A program with the values of its parameters.
#[derive(Clone)]
pub(crate) struct Look<'a> {
    /// Which of the frame's materials it comes from; the display pass counts as one after the last.
    pub id: usize,
    /// The recipe that places in [`Look::settings`] and light lists belong to.
    pub root: Node,
    pub settings: &'a Settings,
    pub program: Arc<Program>,
    /// Its shadow maps.
    pub maps: Vec<MapUse>,
}

/// What a pass shows, beside the program.
#[derive(Clone, Copy, Default)]
pub(crate) struct Shown<'a> {
    /// Tells the passes of a frame apart.
    pub pass: usize,
    pub eye: Option<&'a Eye>,
    pub list: Option<&'a List>,
    /// The finished HDR frame, for passes after it.
    pub hdr: Option<&'a wgpu::TextureView>,
}

/// Buffers that modules keep from frame to frame: by recipe, material, instance and resource.
pub(crate) type Kept = HashMap<(String, usize, String, String), wgpu::Buffer>;

/// What a buffer was made for: kind, program, group and binding, and the material or pass where it differs by that.
type MemoKey = (u8, u128, u32, u32, usize);

/// Everything that bindings of one frame are filled from.
pub(crate) struct Filler<'a> {
    pub gpu: &'a Gpu,
    pub programs: &'a Programs,
    pub frame: &'a Frame,
    pub maps: &'a [Map],
    /// Textures of the maps.
    pub depths: &'a [wgpu::Texture],
    pub uploads: &'a mut Uploads,
    pub kept: &'a mut Kept,
    pub memo: HashMap<MemoKey, Bound>,
}

impl Filler<'_> {
    /// All bind groups of a program in a pass.
    pub fn groups<P>(&mut self, pipeline: &Pipeline<P>, look: &Look, shown: &Shown) -> Result<Vec<wgpu::BindGroup>, RuntimeError> {
        let gpu = self.gpu.clone();
        let reflection = look.program.reflection();
        (0..)
            .take(GROUPS)
            .map(|group| bind_group(&gpu, pipeline, reflection, group, |binding| self.bound(binding, look, shown)))
            .collect()
    }

    fn bound(&mut self, binding: &Binding, look: &Look, shown: &Shown) -> Result<Bound, RuntimeError> {
        let (kind, by) = match &binding.fill {
            Fill::Params => (0, look.id),
            Fill::Instances { .. } => (1, look.id),
            Fill::Resource { declared, .. } => match declared {
                ResourceKind::Host(_) => (2, shown.pass),
                _ => (3, look.id),
            },
        };
        let key = (kind, look.program.hash(), binding.group, binding.binding, by);
        if let Some(made) = self.memo.get(&key) {
            return Ok(made.clone());
        }
        let made = self.make(binding, look, shown)?;
        self.memo.insert(key, made.clone());
        Ok(made)
    }

    fn make(&mut self, binding: &Binding, look: &Look, shown: &Shown) -> Result<Bound, RuntimeError> {
        let reflection = look.program.reflection();
        match &binding.fill {
            Fill::Params => {
                let blocks = param_blocks(reflection, |param| value_of(look, param))?;
                let bytes = blocks.get(&(binding.group, binding.binding)).map_or(&[][..], |b| b);
                self.buffer(binding, wgpu::BufferUsages::UNIFORM, bytes)
            }
            Fill::Instances { instance: of } => self.instances(binding, look, of),
            Fill::Resource {
                instance: of,
                resource,
                declared,
            } => {
                let of = of.as_deref().unwrap_or_default();
                match declared {
                    ResourceKind::Host(name) => self.host(binding, name, shown),
                    ResourceKind::Texture { srgb } => {
                        let given = instance(reflection, of).and_then(|i| setting(&look.settings.textures, i, resource));
                        match given {
                            Some(texture) => {
                                let path = format!("{of}.{resource}");
                                Ok(Bound::Texture(self.uploads.texture(self.gpu, texture, *srgb, &path)?))
                            }
                            None => stand_in(self.gpu, binding),
                        }
                    }
                    ResourceKind::Data { .. } => {
                        let given = instance(reflection, of).and_then(|i| setting(&look.settings.data, i, resource));
                        let data = look.program.data(binding).ok_or_else(|| unknown_instance(binding, of))?;
                        Ok(Bound::Buffer(self.uploads.data(self.gpu, given, &data)?))
                    }
                    ResourceKind::Sampler { linear, repeat, compare } => Ok(sampler(self.gpu, *linear, *repeat, *compare)?),
                    ResourceKind::Depth { pass } => self.depth(binding, look, of, pass),
                    ResourceKind::Views { pass } => {
                        let map = self.map(look, of, pass)?;
                        let layout = layout_of(binding)?;
                        let bytes = rows(layout, &binding.name, &self.maps[map].eyes, Eye::member)?;
                        self.buffer(binding, wgpu::BufferUsages::STORAGE, &bytes)
                    }
                    ResourceKind::Buffer { bytes } => {
                        let key = (super::programs::text_of(&look.root), look.id, of.to_owned(), resource.clone());
                        if let Some(kept) = self.kept.get(&key) {
                            return Ok(Bound::Buffer(kept.clone()));
                        }
                        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_SRC;
                        let size = layout_of(binding).map_or(*bytes, |layout| layout.smallest_size().max(*bytes));
                        let made = self.gpu.buffer(&binding.name, usage, &[], size)?;
                        self.kept.insert(key, made.clone());
                        Ok(Bound::Buffer(made))
                    }
                }
            }
        }
    }

    fn buffer(&self, binding: &Binding, usage: wgpu::BufferUsages, bytes: &[u8]) -> Result<Bound, RuntimeError> {
        Ok(Bound::Buffer(self.gpu.buffer(&binding.name, usage, bytes, 0)?))
    }

    fn instances(&self, binding: &Binding, look: &Look, of: &str) -> Result<Bound, RuntimeError> {
        let light = instance(look.program.reflection(), of).ok_or_else(|| unknown_instance(binding, of))?;
        let lights = lights_of(self.programs, self.frame, &look.root, light)?;
        let bytes = instance_rows(layout_of(binding)?, &light.fields, &lights.instances, of)?;
        self.buffer(binding, wgpu::BufferUsages::STORAGE, &bytes)
    }

    fn host(&self, binding: &Binding, name: &str, shown: &Shown) -> Result<Bound, RuntimeError> {
        let absent = || GpuError::Unsupported {
            what: format!("binding {}", binding.name),
            needs: format!("the host resource `{name}` in this pass"),
        };
        match name {
            "frame" => {
                let layout = layout_of(binding)?;
                let mut bytes = vec![0; layout.size as usize];
                let eye = shown.eye.ok_or_else(absent)?;
                put_members(layout, name, &mut bytes, |member| eye.member(member))?;
                self.buffer(binding, wgpu::BufferUsages::UNIFORM, &bytes)
            }
            "objects" => {
                let list = shown.list.ok_or_else(absent)?;
                let models: Vec<Mat4> = list.order.iter().map(|i| self.frame.draws[*i].model).collect();
                let bytes = rows(layout_of(binding)?, name, &models, object_member)?;
                self.buffer(binding, wgpu::BufferUsages::STORAGE, &bytes)
            }
            "hdr" => Ok(Bound::Texture(shown.hdr.ok_or_else(absent)?.clone())),
            _ => Err(absent().into()),
        }
    }

    fn map(&self, look: &Look, of: &str, pass: &str) -> Result<usize, DataError> {
        let found = look.maps.iter().find(|m| m.instance == of && m.pass == pass);
        found
            .map(|m| m.map)
            .ok_or_else(|| DataError::new(of, format!("has no pass `{pass}` that draws a shadow map")))
    }

    fn depth(&self, binding: &Binding, look: &Look, of: &str, pass: &str) -> Result<Bound, RuntimeError> {
        let BindingType::Texture { dimension, .. } = &binding.ty else {
            return Err(DataError::new(&binding.name, "is no texture").into());
        };
        let texture = &self.depths[self.map(look, of, pass)?];
        let dimension = view_dimension(dimension);
        let layers = match dimension {
            Some(wgpu::TextureViewDimension::D2) => Some(1),
            Some(wgpu::TextureViewDimension::Cube) => Some(6),
            _ => None,
        };
        let view = self.gpu.scoped(&binding.name, |_| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension,
                array_layer_count: layers,
                ..Default::default()
            })
        })?;
        Ok(Bound::Texture(view))
    }
}

/// What the settings say of a parameter.
pub(crate) fn value_of(look: &Look, param: &ParamUse) -> Option<shadewright_compiler::manifest::Value> {
    let at = instance(look.program.reflection(), &param.instance)?;
    setting(&look.settings.params, at, &param.name).cloned()
}

fn unknown_instance(binding: &Binding, of: &str) -> DataError {
    DataError::new(&binding.name, format!("reflection has no instance `{of}`"))
}

fn layout_of(binding: &Binding) -> Result<&Layout, DataError> {
    match &binding.ty {
        BindingType::Uniform { layout } | BindingType::Storage { layout, .. } => Ok(layout),
        _ => Err(DataError::new(&binding.name, "is no buffer")),
    }
}

/// Contents of an array of structs that the host fills; one element of zeros where there are none.
fn rows<T>(layout: &Layout, path: &str, items: &[T], member: impl Fn(&T, &str) -> Option<Vec<f64>>) -> Result<Vec<u8>, DataError> {
    let (Some(element), Some(stride)) = (&layout.element, layout.stride) else {
        return Err(DataError::new(path, "is no array"));
    };
    let mut bytes = vec![0; usize::try_from(size_with(layout, items.len().max(1))).unwrap_or(0)];
    for (item, bytes) in items.iter().zip(bytes.chunks_mut(stride.max(1) as usize)) {
        put_members(element, path, bytes, |name| member(item, name))?;
    }
    Ok(bytes)
}

/// Components of a member of `Object`.
fn object_member(model: &Mat4, name: &str) -> Option<Vec<f64>> {
    let list = |values: &[f32]| Some(values.iter().map(|v| f64::from(*v)).collect());
    match name {
        "model" => list(&model.to_cols_array()),
        "normal" => list(&normal_matrix(model).to_cols_array()),
        _ => None,
    }
}

/// The transposed inverse of the upper 3x3 part, scaled by the absolute determinant: shaders normalise what it gives, and the
/// cofactors exist where the inverse does not, for a model that is flat.
fn normal_matrix(model: &Mat4) -> Mat3 {
    let m = Mat3::from_mat4(*model);
    let cofactors = Mat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    let determinant = m.determinant();
    if determinant.abs() > f32::MIN_POSITIVE && (1.0 / determinant).is_finite() {
        cofactors * (1.0 / determinant)
    } else {
        cofactors
    }
}

/// Whether a program reads the finished frame.
pub(crate) fn reads_hdr(reflection: &Reflection) -> bool {
    let is_hdr = |b: &Binding| matches!(&b.fill, Fill::Resource { declared: ResourceKind::Host(name), .. } if name == "hdr");
    reflection.bindings.iter().any(is_hdr)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Catches a normal matrix that is the model's own, or flips with a mirrored one.
    #[test]
    fn normals_stay_perpendicular() {
        for scale in [Vec3::new(1.0, 5.0, 0.2), Vec3::new(-1.0, 2.0, 1.0)] {
            let model = Mat4::from_rotation_x(0.4) * Mat4::from_scale(scale);
            let (tangent, normal) = (Vec3::new(1.0, -1.0, 0.5), Vec3::new(1.0, 1.0, 0.0));
            let turned = normal_matrix(&model) * normal;
            assert!(turned.dot(model.transform_vector3(tangent)).abs() < 1e-5);
            let expected = Mat3::from_mat4(model).inverse().transpose() * normal;
            assert!((turned - expected).length() < 1e-4, "{turned} {expected}");
        }
        let flat = Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0));
        assert_eq!((normal_matrix(&flat) * Vec3::Y).normalize(), Vec3::Y);
    }
}
