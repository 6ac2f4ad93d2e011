//! The way of a drawn frame to the host, with and without waiting.

use half::f16;

use super::Targets;
use crate::gpu::{Gpu, GpuError, Reading, RuntimeError};

/// The linear HDR frame on its way to the host: see [`Targets::start_read_hdr`].
#[derive(Debug)]
pub struct HdrReading {
    rows: Rows,
    full: bool,
}

/// The display image on its way to the host: see [`Targets::start_read_display`].
#[derive(Debug)]
pub struct DisplayReading {
    rows: Rows,
}

/// A texture's rows on their way, with the padding that copies need between them.
#[derive(Debug)]
struct Rows {
    reading: Reading,
    shape: Shape,
}

/// Bytes of a texture's row, with and without padding.
#[derive(Clone, Copy, Debug)]
struct Shape {
    row: usize,
    padded: usize,
}

impl Targets {
    /// The linear HDR frame, rows from the top, four numbers a texel: cd/m2 in red, green and blue, then coverage. Waits for the GPU.
    ///
    /// # Errors
    /// The GPU fails. [`GpuError::Unsupported`] on the web, where nobody may wait.
    pub fn read_hdr(&self, gpu: &Gpu) -> Result<Vec<[f32; 4]>, RuntimeError> {
        let (texel, full) = self.hdr_texel();
        Ok(numbers(&read(gpu, &self.hdr, texel)?, full))
    }

    /// The display image, rows from the top, four bytes a texel; `None` if the frame has none. Waits for the GPU.
    ///
    /// # Errors
    /// As for [`Targets::read_hdr`].
    pub fn read_display(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>, RuntimeError> {
        Ok(self.display.as_ref().map(|texture| read(gpu, texture, 4)).transpose()?)
    }

    /// Has the linear HDR frame copied to the host without waiting for it.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn start_read_hdr(&self, gpu: &Gpu) -> Result<HdrReading, RuntimeError> {
        let (texel, full) = self.hdr_texel();
        Ok(HdrReading {
            rows: Rows::start(gpu, &self.hdr, texel)?,
            full,
        })
    }

    /// Has the display image copied to the host without waiting for it; `None` if the frame has none.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn start_read_display(&self, gpu: &Gpu) -> Result<Option<DisplayReading>, RuntimeError> {
        let start = |texture| {
            Ok(DisplayReading {
                rows: Rows::start(gpu, texture, 4)?,
            })
        };
        self.display.as_ref().map(start).transpose()
    }

    /// Bytes of a texel of the HDR frame, and whether its numbers have 32 bits.
    fn hdr_texel(&self) -> (u32, bool) {
        match self.hdr.format() {
            wgpu::TextureFormat::Rgba32Float => (16, true),
            _ => (8, false),
        }
    }
}

impl HdrReading {
    /// The frame as [`Targets::read_hdr`] gives it, once, as soon as it is there: `None` means not yet. Does not wait.
    ///
    /// # Errors
    /// The device failed, or the frame has been taken already.
    pub fn take(&mut self, gpu: &Gpu) -> Option<Result<Vec<[f32; 4]>, RuntimeError>> {
        let bytes = self.rows.take(gpu)?;
        Some(bytes.map(|bytes| numbers(&bytes, self.full)))
    }
}

impl DisplayReading {
    /// The image as [`Targets::read_display`] gives it, once, as soon as it is there: `None` means not yet. Does not wait.
    ///
    /// # Errors
    /// The device failed, or the image has been taken already.
    pub fn take(&mut self, gpu: &Gpu) -> Option<Result<Vec<u8>, RuntimeError>> {
        self.rows.take(gpu)
    }
}

impl Rows {
    fn start(gpu: &Gpu, texture: &wgpu::Texture, texel: u32) -> Result<Self, GpuError> {
        let (commands, buffer, shape) = copy(gpu, texture, texel)?;
        Ok(Self {
            reading: gpu.start_read(WHAT, commands, &buffer, buffer.size())?,
            shape,
        })
    }

    fn take(&mut self, gpu: &Gpu) -> Option<Result<Vec<u8>, RuntimeError>> {
        let bytes = self.reading.take(gpu)?;
        Some(bytes.map(|bytes| self.shape.without_padding(&bytes)).map_err(RuntimeError::from))
    }
}

impl Shape {
    fn without_padding(self, bytes: &[u8]) -> Vec<u8> {
        bytes.chunks(self.padded).flat_map(|row| &row[..self.row]).copied().collect()
    }
}

/// What errors call it.
const WHAT: &str = "reading a target";

fn read(gpu: &Gpu, texture: &wgpu::Texture, texel: u32) -> Result<Vec<u8>, GpuError> {
    let (commands, buffer, shape) = copy(gpu, texture, texel)?;
    Ok(shape.without_padding(&gpu.read(WHAT, commands, &buffer, buffer.size())?))
}

/// Commands that copy a texture into a buffer.
fn copy(gpu: &Gpu, texture: &wgpu::Texture, texel: u32) -> Result<(wgpu::CommandEncoder, wgpu::Buffer, Shape), GpuError> {
    let row = texture.width() * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let size = u64::from(padded) * u64::from(texture.height());
    let buffer = gpu.buffer(WHAT, wgpu::BufferUsages::COPY_SRC, &[], size)?;
    let commands = gpu.scoped(WHAT, |device| {
        let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(padded),
            rows_per_image: None,
        };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        commands.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        commands
    })?;
    let shape = Shape {
        row: row as usize,
        padded: padded as usize,
    };
    Ok((commands, buffer, shape))
}

/// Four numbers for each texel, of 32 bits each if `full`, else of 16.
fn numbers(bytes: &[u8], full: bool) -> Vec<[f32; 4]> {
    if full {
        let (texels, _) = bytes.as_chunks::<16>();
        return texels.iter().map(|texel| words(texel, f32::from_le_bytes)).collect();
    }
    let (texels, _) = bytes.as_chunks::<8>();
    let half = |bytes: [u8; 2]| f16::from_le_bytes(bytes).to_f32();
    texels.iter().map(|texel| words(texel, half)).collect()
}

/// Four numbers of a texel, each of `N` bytes.
fn words<const N: usize>(texel: &[u8], number: impl Fn([u8; N]) -> f32) -> [f32; 4] {
    let (numbers, _) = texel.as_chunks::<N>();
    std::array::from_fn(|i| number(numbers[i]))
}
