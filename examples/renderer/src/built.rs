//! Shaders that the build script wrote: buffers are structs, bind groups have a field for each resource.

use std::collections::HashMap;

use crate::gpu::{COLOR, Draw, Gpu, depth_state};
use crate::recipes::{glossy, matte};
use crate::world::{Finish, World};

/// Pipelines, made when they are first wanted.
#[derive(Debug)]
pub struct Shaders<'g> {
    gpu: &'g Gpu,
    pipelines: HashMap<u128, wgpu::RenderPipeline>,
}

/// Fills the buffers of a pass and binds them. Both passes have the same resources; of the material each has what its BRDF reads.
macro_rules! draw {
    ($self:ident, $pass:ident, $world:ident, $material:expr) => {{
        let (device, world) = (&$self.gpu.device, $world);
        let layout = $pass::Layout::new(device);
        let pipeline = $self.pipelines.entry($pass::HASH).or_insert_with(|| {
            let state = $pass::RenderState {
                label: None,
                buffers: &[Some($pass::VertexInput::LAYOUT)],
                targets: [Some(COLOR.into())],
                depth_stencil: Some(depth_state()),
                primitive: wgpu::PrimitiveState::default(),
                multisample: wgpu::MultisampleState::default(),
                cache: None,
            };
            $pass::render_pipeline(device, &layout, &$pass::shader(device), &state)
        });
        let uniform = |bytes: &[u8]| $self.gpu.buffer(bytes, wgpu::BufferUsages::UNIFORM);
        let storage = |bytes: &[u8]| $self.gpu.buffer(bytes, wgpu::BufferUsages::STORAGE);
        let frame = uniform(bytemuck::bytes_of(&$pass::Frame {
            view_projection: world.view_projection,
            eye: world.eye,
            perspective: 1.0,
            forward: world.forward,
            ..Default::default()
        }));
        let suns = storage(bytemuck::bytes_of(&$pass::DirectionalInstance {
            direction: world.sun_direction,
            illuminance: world.sun_lux,
            ..Default::default()
        }));
        let lamps = storage(bytemuck::bytes_of(&$pass::PointInstance {
            position: world.lamp_position,
            intensity: world.lamp_candela,
            ..Default::default()
        }));
        let material = uniform(bytemuck::bytes_of(&$material));
        let objects = storage(bytemuck::bytes_of(&$pass::Object {
            model: world.model,
            normal: world.normal_matrix(),
        }));
        let (a, b, c, d) = (
            $pass::BindGroup0 {
                frame: frame.as_entire_buffer_binding(),
            },
            $pass::BindGroup1 {
                directional_instances: suns.as_entire_buffer_binding(),
                point_instances: lamps.as_entire_buffer_binding(),
            },
            $pass::BindGroup2 {
                material_params: material.as_entire_buffer_binding(),
            },
            $pass::BindGroup3 {
                objects: objects.as_entire_buffer_binding(),
            },
        );
        Draw {
            pipeline: pipeline.clone(),
            groups: vec![
                ($pass::BindGroup0::INDEX, a.bind(device, &layout.group_0)),
                ($pass::BindGroup1::INDEX, b.bind(device, &layout.group_1)),
                ($pass::BindGroup2::INDEX, c.bind(device, &layout.group_2)),
                ($pass::BindGroup3::INDEX, d.bind(device, &layout.group_3)),
            ],
        }
    }};
}

impl<'g> Shaders<'g> {
    /// None yet.
    pub fn new(gpu: &'g Gpu) -> Self {
        Self {
            gpu,
            pipelines: HashMap::new(),
        }
    }

    /// What draws a moment.
    pub fn draw(&mut self, world: &World) -> Draw {
        match world.finish {
            Finish::Matte => draw!(
                self,
                matte,
                world,
                matte::MaterialParams {
                    metalness_base_color: world.base_color,
                    ..Default::default()
                }
            ),
            Finish::Glossy => draw!(
                self,
                glossy,
                world,
                glossy::MaterialParams {
                    metalness_base_color: world.base_color,
                    metalness_roughness: world.roughness,
                    ..Default::default()
                }
            ),
        }
    }
}
