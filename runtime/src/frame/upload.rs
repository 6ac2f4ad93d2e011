//! Meshes, textures and tables on the GPU, kept as long as frames show them.

use std::collections::HashMap;
use std::sync::Arc;

use shadewright_compiler::Report;
use shadewright_compiler::data::{Data, Origin, fits};

use super::{Mesh, Texture};
use crate::data::load;
use crate::gpu::{DataError, Gpu, GpuError, RuntimeError};
use crate::image::mip_levels;

/// A mesh's buffers.
#[derive(Debug)]
pub(crate) struct GpuMesh {
    /// By vertex location; `None` where the mesh has no such attribute.
    pub attributes: [Option<wgpu::Buffer>; 4],
    pub indices: wgpu::Buffer,
    pub count: u32,
}

/// Names of the attributes by location.
pub(crate) const ATTRIBUTES: [&str; 4] = ["positions", "normals", "tangents", "texture coordinates"];

/// What has been uploaded, by the address of the host's allocation, which is held so that no other can take its place.
#[derive(Debug, Default)]
pub(crate) struct Uploads {
    meshes: HashMap<usize, (Arc<Mesh>, Arc<GpuMesh>, u64)>,
    textures: HashMap<(usize, bool), (Arc<Texture>, wgpu::TextureView, u64)>,
    /// By the address of what it was made from: a scene's numbers, or a module's file.
    data: HashMap<usize, (DataOwner, wgpu::Buffer, u64)>,
    frame: u64,
}

/// Keeps an address from being used again.
#[derive(Debug)]
enum DataOwner {
    Given(#[allow(dead_code, reason = "held, not read")] Arc<[f32]>),
    Module(#[allow(dead_code, reason = "held, not read")] Arc<[u8]>),
}

impl Uploads {
    /// Begins a frame.
    pub fn begin(&mut self) {
        self.frame += 1;
    }

    /// Drops what this frame has not used.
    pub fn end(&mut self) {
        let frame = self.frame;
        self.meshes.retain(|_, (_, _, used)| *used == frame);
        self.textures.retain(|_, (_, _, used)| *used == frame);
        self.data.retain(|_, (_, _, used)| *used == frame);
    }

    /// The mesh's buffers; `path` names it in errors.
    pub fn mesh(&mut self, gpu: &Gpu, mesh: &Arc<Mesh>, path: &str) -> Result<Arc<GpuMesh>, RuntimeError> {
        let key = Arc::as_ptr(mesh).addr();
        if let Some((_, made, used)) = self.meshes.get_mut(&key) {
            *used = self.frame;
            return Ok(Arc::clone(made));
        }
        let made = Arc::new(upload_mesh(gpu, mesh, path)?);
        self.meshes.insert(key, (Arc::clone(mesh), Arc::clone(&made), self.frame));
        Ok(made)
    }

    /// The texture with all its levels; `srgb` says that its colours are encoded.
    pub fn texture(&mut self, gpu: &Gpu, texture: &Arc<Texture>, srgb: bool, path: &str) -> Result<wgpu::TextureView, RuntimeError> {
        let key = (Arc::as_ptr(texture).addr(), srgb);
        if let Some((_, made, used)) = self.textures.get_mut(&key) {
            *used = self.frame;
            return Ok(made.clone());
        }
        let made = upload_texture(gpu, texture, srgb, path)?;
        self.textures.insert(key, (Arc::clone(texture), made.clone(), self.frame));
        Ok(made)
    }

    /// The buffer of a binding of kind `Data`: with the numbers that are given for it, or else with those of the module's own file.
    pub fn data(&mut self, gpu: &Gpu, given: Option<&Arc<[f32]>>, data: &Data) -> Result<wgpu::Buffer, RuntimeError> {
        let (key, owner) = match (given, &data.origin) {
            (Some(numbers), _) => (numbers.as_ptr().addr(), DataOwner::Given(Arc::clone(numbers))),
            (None, Origin::Module { bytes, .. }) => (bytes.as_ptr().addr(), DataOwner::Module(Arc::clone(bytes))),
            (None, _) => return Err(Report::from(data.unnamed()).into()),
        };
        if let Some((_, made, used)) = self.data.get_mut(&key) {
            *used = self.frame;
            return Ok(made.clone());
        }
        let numbers = match given {
            Some(numbers) => {
                fits(data.layout, numbers.len()).map_err(|why| DataError::new(&data.name, why))?;
                Arc::clone(numbers)
            }
            None => load(data).map_err(Report::from)?,
        };
        let made = gpu.buffer(&data.name, wgpu::BufferUsages::STORAGE, bytemuck::cast_slice(&numbers), 0)?;
        self.data.insert(key, (owner, made.clone(), self.frame));
        Ok(made)
    }
}

fn upload_mesh(gpu: &Gpu, mesh: &Mesh, path: &str) -> Result<GpuMesh, RuntimeError> {
    let vertices = mesh.positions.len();
    if !mesh.indices.len().is_multiple_of(3) {
        return Err(DataError::new(path, format!("{} indices are no triangles", mesh.indices.len())).into());
    }
    if let Some(index) = mesh.indices.iter().find(|i| **i as usize >= vertices) {
        return Err(DataError::new(path, format!("index {index} in a mesh of {vertices} vertices")).into());
    }
    let count = u32::try_from(mesh.indices.len()).map_err(|_| DataError::new(path, "more indices than 32 bits can count"))?;
    let attribute = |location: usize, length: usize, bytes: &[u8]| -> Result<Option<wgpu::Buffer>, RuntimeError> {
        match length {
            0 => Ok(None),
            n if n == vertices => Ok(Some(gpu.buffer(ATTRIBUTES[location], wgpu::BufferUsages::VERTEX, bytes, 0)?)),
            n => Err(DataError::new(path, format!("{n} {} for {vertices} vertices", ATTRIBUTES[location])).into()),
        }
    };
    Ok(GpuMesh {
        attributes: [
            attribute(0, vertices, bytemuck::cast_slice(&mesh.positions))?,
            attribute(1, mesh.normals.len(), bytemuck::cast_slice(&mesh.normals))?,
            attribute(2, mesh.tangents.len(), bytemuck::cast_slice(&mesh.tangents))?,
            attribute(3, mesh.uvs.len(), bytemuck::cast_slice(&mesh.uvs))?,
        ],
        indices: gpu.buffer("indices", wgpu::BufferUsages::INDEX, bytemuck::cast_slice(&mesh.indices), 0)?,
        count,
    })
}

fn upload_texture(gpu: &Gpu, texture: &Texture, srgb: bool, path: &str) -> Result<wgpu::TextureView, RuntimeError> {
    let (width, height) = (texture.width, texture.height);
    let limit = gpu.device().limits().max_texture_dimension_2d;
    if width == 0 || height == 0 || width > limit || height > limit {
        return Err(DataError::new(path, format!("a texture of {width} x {height} texels; this GPU takes 1 to {limit}")).into());
    }
    if texture.rgba.len() as u64 != u64::from(width) * u64::from(height) * 4 {
        return Err(DataError::new(path, format!("{} bytes for {width} x {height} texels of 4", texture.rgba.len())).into());
    }
    let levels = mip_levels(texture, srgb);
    let made = gpu.scoped(path, |device| {
        let made = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(path),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: u32::try_from(levels.len()).unwrap_or(1),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: if srgb {
                wgpu::TextureFormat::Rgba8UnormSrgb
            } else {
                wgpu::TextureFormat::Rgba8Unorm
            },
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        for (level, image) in (0..).zip(&levels) {
            let to = wgpu::TexelCopyTextureInfo {
                mip_level: level,
                ..made.as_image_copy()
            };
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(image.width * 4),
                rows_per_image: None,
            };
            let size = wgpu::Extent3d {
                width: image.width,
                height: image.height,
                depth_or_array_layers: 1,
            };
            gpu.queue().write_texture(to, &image.rgba, layout, size);
        }
        made.create_view(&wgpu::TextureViewDescriptor::default())
    });
    made.map_err(|error: GpuError| error.into())
}
