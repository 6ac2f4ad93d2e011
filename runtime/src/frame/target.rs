//! What a frame is drawn into.

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
        let draws = if cfg!(target_arch = "wasm32") {
            // No answer comes while one waits for it; WebGPU promises this much.
            let promised = FULL.guaranteed_format_features(gpu.device().features());
            promised.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT)
        } else {
            gpu.scoped("HDR target", |device| drop(texture(device, FULL, [1, 1]))).is_ok()
        };
        Self {
            draws,
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
