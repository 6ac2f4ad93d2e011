//! What goes into bindings: parameter blocks, instance buffers, samplers, textures, and stand-ins for what nobody gave.

use std::collections::HashMap;

use indexmap::IndexMap;
use shadewright_compiler::manifest::{Param, Value};
use shadewright_compiler::reflect::{Binding, BindingType, Layout, ParamPlace, ParamUse, Reflection};

use super::layout::{GROUPS, view_dimension};
use super::pack::{put_numbers, size_with, unknown};
use super::pipeline::{Constants, Pipeline};
use super::value::numbers;
use super::{DataError, Gpu, GpuError, RuntimeError};

/// Something that can be bound.
#[derive(Clone, Debug)]
pub enum Bound {
    /// A whole buffer.
    Buffer(wgpu::Buffer),
    /// A texture.
    Texture(wgpu::TextureView),
    /// A sampler.
    Sampler(wgpu::Sampler),
}

/// Values of overridable constants; `value` says what a parameter is where it is not its default.
///
/// # Errors
/// A value does not fit its parameter.
pub fn constants(reflection: &Reflection, value: impl Fn(&ParamUse) -> Option<Value>) -> Result<Constants, DataError> {
    let mut constants = Constants::new();
    for param in &reflection.params {
        let ParamPlace::Override { name } = &param.place else { continue };
        let Some(value) = value(param) else { continue };
        constants.push((name.clone(), numbers(&param.declared, &value, &path_of(param))?[0]));
    }
    Ok(constants)
}

/// Contents of the uniform blocks with parameters, by group and binding.
///
/// # Errors
/// A value does not fit its parameter.
pub fn param_blocks(
    reflection: &Reflection,
    value: impl Fn(&ParamUse) -> Option<Value>,
) -> Result<HashMap<(u32, u32), Vec<u8>>, DataError> {
    let mut blocks = HashMap::new();
    for binding in &reflection.bindings {
        if let BindingType::Uniform { layout } = &binding.ty {
            blocks.insert((binding.group, binding.binding), (layout, vec![0; layout.size as usize]));
        }
    }
    for param in &reflection.params {
        let ParamPlace::Uniform {
            group,
            binding,
            offset,
            member,
        } = &param.place
        else {
            continue;
        };
        let path = path_of(param);
        let Some((layout, bytes)) = blocks.get_mut(&(*group, *binding)) else {
            continue;
        };
        let Some(place) = layout.members.iter().find(|m| m.name == *member) else {
            continue;
        };
        let given = value(param);
        let list = numbers(&param.declared, given.as_ref().unwrap_or(&param.declared.default), &path)?;
        put_numbers(&place.layout, &list, &path, &mut bytes[*offset as usize..])?;
    }
    Ok(blocks.into_iter().map(|(key, (_, bytes))| (key, bytes)).collect())
}

/// Declared fields of an instance's buffer.
pub(crate) fn fields_of<'a>(reflection: &'a Reflection, instance: &str) -> &'a IndexMap<String, Param> {
    static NONE: std::sync::LazyLock<IndexMap<String, Param>> = std::sync::LazyLock::new(IndexMap::new);
    reflection
        .instances
        .iter()
        .find(|i| i.name == instance)
        .map_or(&NONE, |i| &i.fields)
}

fn path_of(param: &ParamUse) -> String {
    format!("{}.{}", param.instance, param.name)
}

/// Contents of a buffer `array<Instance>`; rows name fields of `fields`, fields left out have their default.
///
/// # Errors
/// A field that does not exist, or a value that does not fit it.
pub fn instance_rows(
    layout: &Layout,
    fields: &IndexMap<String, Param>,
    rows: &[IndexMap<String, Value>],
    path: &str,
) -> Result<Vec<u8>, DataError> {
    let mut bytes = vec![0; usize::try_from(size_with(layout, rows.len())).unwrap_or(0)];
    let stride = layout.stride.unwrap_or(0) as usize;
    let members = layout.element.as_ref().map_or(&[][..], |element| &element.members);
    for (i, row) in rows.iter().enumerate() {
        let path = format!("{path}[{i}]");
        if let Some(name) = row.keys().find(|name| !fields.contains_key(*name)) {
            return Err(unknown(name, "field", "the instance", fields.keys().map(String::as_str), &path));
        }
        for (name, field) in fields {
            let path = format!("{path}.{name}");
            let list = numbers(field, row.get(name).unwrap_or(&field.default), &path)?;
            // A field that no function reads has left the struct; its value was checked all the same.
            if let Some(member) = members.iter().find(|m| m.name == *name) {
                put_numbers(&member.layout, &list, &path, &mut bytes[i * stride + member.offset as usize..])?;
            }
        }
    }
    Ok(bytes)
}

/// A sampler as a module declares it; comparison is less-or-equal.
///
/// # Errors
/// The device fails.
pub fn sampler(gpu: &Gpu, linear: bool, repeat: bool, compare: bool) -> Result<Bound, GpuError> {
    let filter = if linear {
        wgpu::FilterMode::Linear
    } else {
        wgpu::FilterMode::Nearest
    };
    let address = if repeat {
        wgpu::AddressMode::Repeat
    } else {
        wgpu::AddressMode::ClampToEdge
    };
    let sampler = gpu.scoped("sampler", |device| {
        device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: address,
            address_mode_v: address,
            address_mode_w: address,
            mag_filter: filter,
            min_filter: filter,
            mipmap_filter: if linear {
                wgpu::MipmapFilterMode::Linear
            } else {
                wgpu::MipmapFilterMode::Nearest
            },
            compare: compare.then_some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        })
    })?;
    Ok(Bound::Sampler(sampler))
}

/// What stands in a binding for which there is nothing: zeros in buffers, white in textures, the far plane in depth textures.
///
/// # Errors
/// The device fails.
pub fn stand_in(gpu: &Gpu, binding: &Binding) -> Result<Bound, RuntimeError> {
    use wgpu::BufferUsages as U;
    Ok(match &binding.ty {
        BindingType::Uniform { layout } => Bound::Buffer(gpu.buffer(&binding.name, U::UNIFORM, &[], layout.smallest_size())?),
        BindingType::Storage { layout, .. } => {
            Bound::Buffer(gpu.buffer(&binding.name, U::STORAGE | U::COPY_SRC, &[], layout.smallest_size())?)
        }
        BindingType::Texture { dimension, sample, .. } => Bound::Texture(plain_texture(gpu, binding, dimension, sample)?),
        BindingType::Sampler { comparison } => sampler(gpu, *comparison, false, *comparison)?,
        BindingType::StorageTexture { .. } => {
            return Err(GpuError::Unsupported {
                what: format!("binding {}", binding.name),
                needs: "a storage texture from the host".into(),
            }
            .into());
        }
    })
}

fn plain_texture(gpu: &Gpu, binding: &Binding, dimension: &str, sample: &str) -> Result<wgpu::TextureView, GpuError> {
    let unsupported = || GpuError::Unsupported {
        what: format!("binding {}", binding.name),
        needs: format!("a {dimension} texture of {sample}"),
    };
    let dimension = view_dimension(dimension).ok_or_else(unsupported)?;
    let is_depth = sample == "depth";
    let format = match sample {
        "depth" => wgpu::TextureFormat::Depth32Float,
        "float" | "unfilterable_float" => wgpu::TextureFormat::Rgba8Unorm,
        "uint" => wgpu::TextureFormat::Rgba8Uint,
        _ => wgpu::TextureFormat::Rgba8Sint,
    };
    let layers = if matches!(dimension, wgpu::TextureViewDimension::Cube | wgpu::TextureViewDimension::CubeArray) {
        6
    } else {
        1
    };
    let usage = if is_depth {
        wgpu::TextureUsages::RENDER_ATTACHMENT
    } else {
        wgpu::TextureUsages::COPY_DST
    };
    gpu.scoped(&binding.name, |device| {
        let size = wgpu::Extent3d {
            width: 1,
            height: 1,
            depth_or_array_layers: layers,
        };
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(&binding.name),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: dimension.compatible_texture_dimension(),
            format,
            usage: usage | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        if is_depth {
            let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            for layer in 0..layers {
                clear_depth(&mut commands, &layer_view(&texture, layer));
            }
            gpu.queue().submit([commands.finish()]);
        } else {
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4),
                rows_per_image: Some(1),
            };
            gpu.queue()
                .write_texture(texture.as_image_copy(), &vec![255; 4 * layers as usize], layout, size);
        }
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(dimension),
            ..Default::default()
        })
    })
}

/// One layer of a depth texture, to draw into.
pub fn layer_view(texture: &wgpu::Texture, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

fn clear_depth(commands: &mut wgpu::CommandEncoder, view: &wgpu::TextureView) {
    drop(commands.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(depth_attachment(view)),
        ..Default::default()
    }));
}

/// A depth attachment that starts at the far plane and is kept.
pub fn depth_attachment(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(1.0),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

/// The bind group of this number, with what `bound` gives for each binding of it.
///
/// # Errors
/// Those of `bound`, or what wgpu finds wrong.
pub fn bind_group<P>(
    gpu: &Gpu,
    pipeline: &Pipeline<P>,
    reflection: &Reflection,
    group: u32,
    mut bound: impl FnMut(&Binding) -> Result<Bound, RuntimeError>,
) -> Result<wgpu::BindGroup, RuntimeError> {
    let mut resources = Vec::new();
    for binding in reflection.bindings.iter().filter(|b| b.group == group) {
        resources.push((binding.binding, bound(binding)?));
    }
    let entries: Vec<_> = resources
        .iter()
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: match resource {
                Bound::Buffer(buffer) => buffer.as_entire_binding(),
                Bound::Texture(view) => wgpu::BindingResource::TextureView(view),
                Bound::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
            },
        })
        .collect();
    debug_assert!((group as usize) < GROUPS);
    Ok(gpu.scoped(&format!("bind group {group} of {}", reflection.pass), |device| {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.groups[group as usize],
            entries: &entries,
        })
    })?)
}
