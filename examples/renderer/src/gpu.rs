//! The renderer's device, target and draw call.

use std::sync::mpsc;

use thiserror::Error;

use crate::mesh::Mesh;

/// What can go wrong.
#[derive(Debug, Error)]
pub enum Error {
    /// No device.
    #[error("no usable GPU: {0}")]
    NoGpu(String),
    /// The device did not do as it was told.
    #[error("the GPU: {0}")]
    Gpu(String),
    /// A file.
    #[error("{0}")]
    File(String),
    /// A shader; the text points into its author's file.
    #[error("{0}")]
    Shader(String),
    /// `live` was asked of a program without it.
    #[error("this program was built without the feature `live`")]
    Unlinked,
}

/// A device with its queue.
#[derive(Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// Format of what is drawn: radiance in cd/m2.
pub const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of the depth.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Bytes of a pixel of [`COLOR`].
const PIXEL: u32 = 16;

impl Gpu {
    /// Any device, without a window.
    ///
    /// # Errors
    /// There is none.
    pub fn new() -> Result<Self, Error> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
        let adapter = adapter.map_err(|error| Error::NoGpu(error.to_string()))?;
        // Four storage buffers and arrays of cube maps are more than the least of devices has.
        let descriptor = wgpu::DeviceDescriptor {
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| Error::NoGpu(error.to_string()))?;
        Ok(Self { device, queue })
    }

    /// Runs calls of wgpu and returns what it found wrong with them.
    ///
    /// # Errors
    /// That.
    pub fn checked<T>(&self, calls: impl FnOnce(&wgpu::Device) -> T) -> Result<T, Error> {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = calls(&self.device);
        match pollster::block_on(scope.pop()) {
            Some(error) => Err(Error::Gpu(error.to_string())),
            None => Ok(result),
        }
    }

    /// A buffer with these contents.
    pub fn buffer(&self, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: (contents.len() as u64).next_multiple_of(4),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut padded = contents.to_vec();
        padded.resize(contents.len().next_multiple_of(4), 0);
        self.queue.write_buffer(&buffer, 0, &padded);
        buffer
    }

    /// A buffer's contents.
    ///
    /// # Errors
    /// The device is gone.
    pub fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, Error> {
        let (sender, receiver) = mpsc::channel();
        // The receiver lives as long as this function; a failed send has nobody to tell.
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| Error::Gpu(error.to_string()))?;
        match receiver.recv() {
            Ok(Ok(())) => {}
            other => return Err(Error::Gpu(format!("a buffer cannot be read: {other:?}"))),
        }
        let bytes = buffer.get_mapped_range(..).map_err(|error| Error::Gpu(error.to_string()))?;
        Ok(bytes.to_vec())
    }
}

/// What a frame is drawn into.
#[derive(Debug)]
pub struct Target {
    color: wgpu::Texture,
    depth: wgpu::Texture,
}

impl Target {
    /// Makes one; texels.
    pub fn new(gpu: &Gpu, width: u32, height: u32) -> Self {
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        Self {
            color: texture(COLOR, wgpu::TextureUsages::COPY_SRC),
            depth: texture(DEPTH, wgpu::TextureUsages::empty()),
        }
    }
}

/// A pipeline with everything that is bound to it.
#[derive(Clone, Debug)]
pub struct Draw {
    /// The pipeline.
    pub pipeline: wgpu::RenderPipeline,
    /// Bind groups by number.
    pub groups: Vec<(u32, wgpu::BindGroup)>,
}

impl Gpu {
    /// Draws a mesh, and waits for the picture: four numbers a pixel, rows from the top.
    ///
    /// # Errors
    /// The device is gone, or found something wrong.
    pub fn draw(&self, target: &Target, mesh: &Mesh, draw: &Draw) -> Result<Vec<[f32; 4]>, Error> {
        let vertices = self.buffer(bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX);
        let indices = self.buffer(bytemuck::cast_slice(&mesh.indices), wgpu::BufferUsages::INDEX);
        let size = target.color.size();
        let stride = (size.width * PIXEL).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let staging = self.checked(|device| {
            let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let (color, depth) = (
                target.color.create_view(&Default::default()),
                target.depth.create_view(&Default::default()),
            );
            let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &color,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &depth,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(1.0),
                        store: wgpu::StoreOp::Discard,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&draw.pipeline);
            for (index, group) in &draw.groups {
                pass.set_bind_group(*index, group, &[]);
            }
            pass.set_vertex_buffer(0, vertices.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.indices.len() as u32, 0, 0..1);
            drop(pass);
            let staging = device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: u64::from(stride) * u64::from(size.height),
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            let copy = wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(stride),
                    rows_per_image: None,
                },
            };
            commands.copy_texture_to_buffer(target.color.as_image_copy(), copy, size);
            self.queue.submit([commands.finish()]);
            staging
        })?;
        let bytes = self.read(&staging)?;
        let rows = bytes.chunks(stride as usize).map(|row| &row[..(size.width * PIXEL) as usize]);
        Ok(rows.flat_map(bytemuck::pod_collect_to_vec::<u8, [f32; 4]>).collect())
    }
}

/// State that all of this renderer's pipelines have in common.
pub fn depth_state() -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Less),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}
