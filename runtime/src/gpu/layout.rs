//! Reflected bindings as bind group layouts.

use std::num::NonZeroU64;

use shadewright_compiler::manifest::ResourceKind;
use shadewright_compiler::reflect::{Binding, BindingType, Fill, Layout, Reflection, Stage};

use super::GpuError;

/// Number of bind groups that programs use.
pub const GROUPS: usize = 4;

/// Entries of each bind group's layout; a group that the program does not use is empty.
///
/// # Errors
/// The reflection asks for something that wgpu has no word for.
pub fn bind_group_entries(reflection: &Reflection) -> Result<[Vec<wgpu::BindGroupLayoutEntry>; GROUPS], GpuError> {
    let mut groups: [Vec<_>; GROUPS] = Default::default();
    for binding in &reflection.bindings {
        let group = groups
            .get_mut(binding.group as usize)
            .ok_or_else(|| unsupported(binding, format!("bind group {}", binding.group)))?;
        group.push(entry(binding)?);
    }
    Ok(groups)
}

fn unsupported(binding: &Binding, needs: String) -> GpuError {
    GpuError::Unsupported {
        what: format!("binding {}", binding.name),
        needs,
    }
}

fn entry(binding: &Binding) -> Result<wgpu::BindGroupLayoutEntry, GpuError> {
    let buffer = |ty, layout: &Layout| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: NonZeroU64::new(layout.smallest_size()),
    };
    let ty = match &binding.ty {
        BindingType::Uniform { layout } => buffer(wgpu::BufferBindingType::Uniform, layout),
        BindingType::Storage { read_only, layout } => buffer(wgpu::BufferBindingType::Storage { read_only: *read_only }, layout),
        BindingType::Texture {
            dimension,
            sample,
            multisampled,
        } => wgpu::BindingType::Texture {
            sample_type: sample_type(sample).ok_or_else(|| unsupported(binding, format!("textures of {sample}")))?,
            view_dimension: view_dimension(dimension).ok_or_else(|| unsupported(binding, format!("{dimension} textures")))?,
            multisampled: *multisampled,
        },
        BindingType::StorageTexture { dimension, format, access } => wgpu::BindingType::StorageTexture {
            access: match access.as_str() {
                "read" => wgpu::StorageTextureAccess::ReadOnly,
                "write" => wgpu::StorageTextureAccess::WriteOnly,
                "read_write" => wgpu::StorageTextureAccess::ReadWrite,
                other => return Err(unsupported(binding, format!("access {other}"))),
            },
            format: storage_format(format).ok_or_else(|| unsupported(binding, format!("storage textures of {format}")))?,
            view_dimension: view_dimension(dimension).ok_or_else(|| unsupported(binding, format!("{dimension} textures")))?,
        },
        BindingType::Sampler { comparison: true } => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
        BindingType::Sampler { comparison: false } => wgpu::BindingType::Sampler(if is_linear(&binding.fill) {
            wgpu::SamplerBindingType::Filtering
        } else {
            wgpu::SamplerBindingType::NonFiltering
        }),
    };
    let visibility = binding.stages.iter().fold(wgpu::ShaderStages::NONE, |all, stage| {
        all | match stage {
            Stage::Vertex => wgpu::ShaderStages::VERTEX,
            Stage::Fragment => wgpu::ShaderStages::FRAGMENT,
            Stage::Compute => wgpu::ShaderStages::COMPUTE,
        }
    });
    Ok(wgpu::BindGroupLayoutEntry {
        binding: binding.binding,
        visibility,
        ty,
        count: None,
    })
}

fn is_linear(fill: &Fill) -> bool {
    matches!(
        fill,
        Fill::Resource {
            declared: ResourceKind::Sampler { linear: true, .. },
            ..
        }
    )
}

fn sample_type(sample: &str) -> Option<wgpu::TextureSampleType> {
    Some(match sample {
        "float" => wgpu::TextureSampleType::Float { filterable: true },
        "unfilterable_float" => wgpu::TextureSampleType::Float { filterable: false },
        "depth" => wgpu::TextureSampleType::Depth,
        "sint" => wgpu::TextureSampleType::Sint,
        "uint" => wgpu::TextureSampleType::Uint,
        _ => return None,
    })
}

/// The view dimension of this name.
pub(crate) fn view_dimension(name: &str) -> Option<wgpu::TextureViewDimension> {
    Some(match name {
        "1d" => wgpu::TextureViewDimension::D1,
        "2d" => wgpu::TextureViewDimension::D2,
        "2d_array" => wgpu::TextureViewDimension::D2Array,
        "3d" => wgpu::TextureViewDimension::D3,
        "cube" => wgpu::TextureViewDimension::Cube,
        "cube_array" => wgpu::TextureViewDimension::CubeArray,
        _ => return None,
    })
}

fn storage_format(name: &str) -> Option<wgpu::TextureFormat> {
    use wgpu::TextureFormat as F;
    Some(match name {
        "r32float" => F::R32Float,
        "r32uint" => F::R32Uint,
        "r32sint" => F::R32Sint,
        "rg32float" => F::Rg32Float,
        "rgba8unorm" => F::Rgba8Unorm,
        "rgba16float" => F::Rgba16Float,
        "rgba32float" => F::Rgba32Float,
        "rgba32uint" => F::Rgba32Uint,
        "rgba32sint" => F::Rgba32Sint,
        _ => return None,
    })
}
