//! What a frame is drawn into, and the way back to the host.

use half::f16;

use super::Frame;
use crate::gpu::{DataError, Gpu, RuntimeError};

/// A drawn frame, still on the GPU.
#[derive(Clone, Debug)]
pub struct Targets {
    /// The linear HDR frame, cd/m2 per channel in red, green and blue: `Rgba32Float`, or `Rgba16Float` where the GPU
    /// cannot draw (or blend) into that.
    pub hdr: wgpu::Texture,
    /// The display image: `Rgba8Unorm`, with whatever encoding the display pass writes. `None` if the frame has no such pass.
    pub display: Option<wgpu::Texture>,
}

/// Format of the display image.
pub(crate) const DISPLAY: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Format of the HDR frame on a GPU that can draw and blend into 32-bit floats.
pub(crate) const FULL: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// What a GPU can draw the HDR frame into.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HdrFormats {
    draws: bool,
    blends: bool,
}

impl HdrFormats {
    /// Asks the GPU. Where it is lost, the answer is the smaller format, and whatever comes next says that it is lost.
    pub fn of(gpu: &Gpu) -> Self {
        Self {
            draws: gpu.scoped("HDR target", |device| drop(texture(device, FULL, [1, 1]))).is_ok(),
            blends: gpu.device().features().contains(wgpu::Features::FLOAT32_BLENDABLE),
        }
    }

    /// The format for a frame.
    pub fn format(self, frame: &Frame) -> wgpu::TextureFormat {
        let blend = frame.draws.iter().any(|d| d.visible && d.alpha_blend);
        if self.draws && (self.blends || !blend) {
            FULL
        } else {
            wgpu::TextureFormat::Rgba16Float
        }
    }
}

fn texture(device: &wgpu::Device, format: wgpu::TextureFormat, [width, height]: [u32; 2]) -> wgpu::Texture {
    let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    if !format.is_depth_stencil_format() {
        usage |= wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
    }
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("target"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// A target of the frame's size.
pub(crate) fn target(gpu: &Gpu, format: wgpu::TextureFormat, size: [u32; 2]) -> Result<wgpu::Texture, RuntimeError> {
    let limit = gpu.device().limits().max_texture_dimension_2d;
    if size.iter().any(|side| !(1..=limit).contains(side)) {
        let message = format!("{} x {} texels; this GPU takes 1 to {limit}", size[0], size[1]);
        return Err(DataError::new("size", message).into());
    }
    Ok(gpu.scoped("target", |device| texture(device, format, size))?)
}

impl Targets {
    /// The linear HDR frame, rows from the top, four numbers a texel.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn read_hdr(&self, gpu: &Gpu) -> Result<Vec<[f32; 4]>, RuntimeError> {
        if self.hdr.format() == wgpu::TextureFormat::Rgba32Float {
            let bytes = read(gpu, &self.hdr, 16)?;
            let (texels, _) = bytes.as_chunks::<16>();
            return Ok(texels.iter().map(|texel| words(texel, f32::from_le_bytes)).collect());
        }
        let bytes = read(gpu, &self.hdr, 8)?;
        let (texels, _) = bytes.as_chunks::<8>();
        Ok(texels
            .iter()
            .map(|texel| words(texel, |b: [u8; 2]| f16::from_le_bytes(b).to_f32()))
            .collect())
    }

    /// The display image, rows from the top, four bytes a texel; `None` if the frame has none.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn read_display(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>, RuntimeError> {
        self.display.as_ref().map(|texture| read(gpu, texture, 4)).transpose()
    }
}

/// Four numbers of a texel, each of `N` bytes.
fn words<const N: usize>(texel: &[u8], number: impl Fn([u8; N]) -> f32) -> [f32; 4] {
    let (numbers, _) = texel.as_chunks::<N>();
    std::array::from_fn(|i| number(numbers[i]))
}

/// A texture's texels without the padding that copies need between rows.
fn read(gpu: &Gpu, texture: &wgpu::Texture, texel: u32) -> Result<Vec<u8>, RuntimeError> {
    let (width, height) = (texture.width(), texture.height());
    let row = width * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let size = u64::from(padded) * u64::from(height);
    let usage = wgpu::BufferUsages::COPY_SRC;
    let buffer = gpu.buffer("reading a target", usage, &[], size)?;
    let commands = gpu.scoped("reading a target", |device| {
        let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        commands.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        commands
    })?;
    let bytes = gpu.read("reading a target", commands, &buffer, size)?;
    Ok(bytes.chunks(padded as usize).flat_map(|r| &r[..row as usize]).copied().collect())
}
