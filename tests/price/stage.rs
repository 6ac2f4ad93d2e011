//! A small scene that any shader with the bindings of `forward.recipe.ron` draws: the test compares the pictures, the benchmark the times.
#![allow(dead_code, clippy::expect_used, clippy::unwrap_used)]

use std::borrow::Cow;

use glam::camera::rh::proj::directx::perspective;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat3, Mat4, Vec3, Vec4};
use serde_json::{Value as Json, json};
use shadewright::compiler::canonical::canonical_module;
use shadewright::compiler::reflect::{BindingType, Layout};
use shadewright::compiler::validate::{Validated, validate};
use shadewright::compiler::{Catalog, Program, Recipe};
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::gpu::layout::{GROUPS, bind_group_entries};
use shadewright::runtime::gpu::pack::{Defaults, pack, size_with};
use shadewright::runtime::gpu::resources::{Bound, depth_attachment, layer_view, sampler};
use shadewright::runtime::mesh::{Mesh, Shape};
use shadewright::runtime::wgpu;
use wgpu::util::DeviceExt as _;

pub const RECIPE: &str = include_str!("../../examples/recipes/forward.recipe.ron");
pub const MONOLITH: &str = include_str!("monolith.wgsl");
pub const UBERSHADER: &str = include_str!("ubershader.wgsl");

/// Texels of a shadow map's side.
const MAP: u32 = 256;
const SUN: Vec3 = Vec3::new(0.8, -0.85, -0.42);
const LAMP: Vec3 = Vec3::new(1.2, 2.2, 1.4);
const NEAR: f32 = 0.01;
const FAR: f32 = 10.0;
/// Half the side of what the sun's map sees, m.
const SUN_HALF: f32 = 5.0;

/// What a scene without shadows and gloss needs of the same lights.
pub const PLAIN: &str =
    r#"(module: "forward", fill: {"brdf": "lambert", "lights": ["directional", "point", (module: "point", label: "fill")]})"#;

/// The ubershader's switches for the recipe: microfacet, filtered with radius 2, maps for the first two lists of lights.
pub const ALL_ON: [u32; 6] = [1, 1, 2, 1, 1, 0];
/// And for the plain one.
pub const PLAIN_SWITCHES: [u32; 6] = [0, 0, 0, 0, 0, 0];

/// A recipe's forward pass.
pub fn composed(recipe: &str) -> Program {
    let catalog = Catalog::load(shadewright::modules::library()).unwrap_or_else(|report| panic!("{report}"));
    let recipe = Recipe::parse("price.recipe.ron", recipe).unwrap_or_else(|report| panic!("{report}"));
    catalog.compile(&recipe, "main").unwrap_or_else(|report| panic!("{report}"))
}

/// A text, checked as the composed pass is.
pub fn checked(name: &str, wgsl: &str) -> Validated {
    let module = canonical_module(name, wgsl).unwrap_or_else(|report| panic!("{report}"));
    validate(module).unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(wgsl)))
}

/// The scene on a device.
pub struct Stage {
    pub gpu: Gpu,
    size: [u32; 2],
    layout: wgpu::PipelineLayout,
    groups: [wgpu::BindGroup; GROUPS],
    vertices: [wgpu::Buffer; 2],
    indices: wgpu::Buffer,
    /// Indices, first vertex and objects of each mesh.
    draws: Vec<(std::ops::Range<u32>, i32, std::ops::Range<u32>)>,
    target: wgpu::Texture,
    depth: wgpu::TextureView,
}

fn columns(matrix: Mat4) -> Json {
    json!(matrix.to_cols_array_2d())
}

/// World space to clip space of a cube map's face, as the library's cube maps have it: seen from inside, right x up = forward.
fn face([right, up, forward]: [Vec3; 3]) -> Mat4 {
    let depth = FAR / (FAR - NEAR);
    let row = |axis: Vec3, offset: f32| axis.extend(offset - axis.dot(LAMP));
    Mat4::from_cols(
        row(right, 0.0),
        row(up, 0.0),
        row(forward * depth, -NEAR * depth),
        row(forward, 0.0),
    )
    .transpose()
}

const FACES: [[Vec3; 3]; 6] = [
    [Vec3::NEG_Z, Vec3::Y, Vec3::X],
    [Vec3::Z, Vec3::Y, Vec3::NEG_X],
    [Vec3::X, Vec3::NEG_Z, Vec3::Y],
    [Vec3::X, Vec3::Z, Vec3::NEG_Y],
    [Vec3::X, Vec3::Y, Vec3::Z],
    [Vec3::NEG_X, Vec3::Y, Vec3::NEG_Z],
];

fn sun_view() -> Mat4 {
    let direction = SUN.normalize();
    let right = direction.cross(Vec3::Y).normalize();
    let up = right.cross(direction);
    let eye = -direction * SUN_HALF;
    let row = |axis: Vec3, scale: f32| (axis / scale).extend(-axis.dot(eye) / scale);
    Mat4::from_cols(row(right, SUN_HALF), row(up, SUN_HALF), row(direction, 2.0 * SUN_HALF), Vec4::W).transpose()
}

/// Balls of several sizes on a floor.
fn objects() -> Vec<Mat4> {
    let ball = |i: u32| {
        let (row, column) = (i / 5, i % 5);
        let radius = 0.2 + 0.05 * ((i * 7) % 5) as f32;
        let place = Vec3::new(column as f32 - 2.0, radius, 1.2 - row as f32 * 1.1);
        Mat4::from_translation(place) * Mat4::from_scale(Vec3::splat(radius))
    };
    std::iter::once(Mat4::IDENTITY).chain((0..15).map(ball)).collect()
}

/// What stands in the buffer of this name; nothing for the material's, which a picture may have otherwise.
fn contents(name: &str, size: [u32; 2]) -> Json {
    let eye = Vec3::new(0.3, 1.9, 4.4);
    let target = Vec3::new(0.0, 0.2, 0.0);
    let sun = json!({"direction": SUN.to_array(), "color": [1.0, 0.95, 0.9], "illuminance": 380.0});
    let lamp = |position: [f32; 3], intensity: f32| json!({"position": position, "color": [1.0, 0.8, 0.6], "intensity": intensity, "range": 10.0, "size": 0.03});
    let view = |matrix: Mat4, position: Vec3, texel: f32, perspective: f32| json!({"view_projection": columns(matrix), "position": position.to_array(), "near": NEAR, "far": FAR, "texel": texel, "perspective": perspective});
    match name {
        "frame" => {
            let aspect = size[0] as f32 / size[1] as f32;
            let camera = perspective(0.6, aspect, 0.1, 50.0) * look_at_mat4(eye, target, Vec3::Y);
            json!({"view_projection": columns(camera), "eye": eye.to_array(), "perspective": 1.0,
                "forward": (target - eye).normalize().to_array(), "time": 0.0, "size": [size[0] as f32, size[1] as f32]})
        }
        "objects" => {
            let object = |model: &Mat4| json!({"model": columns(*model), "normal": Mat3::from_mat4(*model).inverse().transpose().to_cols_array_2d()});
            json!(objects().iter().map(object).collect::<Vec<_>>())
        }
        "light_params" => {
            json!({"perspective_normal_offset": 1.5, "perspective_bias": 0.002, "cube_map_normal_offset": 1.5, "cube_map_bias": 0.002})
        }
        "directional_instances" => json!([sun]),
        "point_instances" => json!([lamp(LAMP.to_array(), 300.0)]),
        "point_b_instances" | "point_fill_instances" => json!([lamp([-1.9, 1.0, -1.4], 60.0)]),
        "perspective_views" => json!([view(sun_view(), -SUN.normalize() * SUN_HALF, 2.0 * SUN_HALF / MAP as f32, 0.0)]),
        "cube_map_views" => json!(FACES.map(|f| view(face(f), LAMP, 2.0 / MAP as f32, 1.0))),
        "material_params" => json!({"metalness_base_color": [0.9, 0.6, 0.4], "metalness_opacity": 1.0, "metalness_metalness": 0.6,
            "metalness_roughness": 0.45, "metalness_reflectance": 0.04, "metalness_emission_color": [0.2, 0.4, 1.0], "metalness_emission": 3.0}),
        other => panic!("the stage has no {other}"),
    }
}

fn bytes(name: &str, layout: &Layout, value: &Json) -> Vec<u8> {
    let mut value = value.clone();
    if let Some(members) = value.as_object_mut() {
        // A block of parameters has those that the permutation reads.
        members.retain(|name, _| layout.members.iter().any(|member| member.name == *name));
    }
    let value = &value;
    let elements = value.as_array().map_or(1, Vec::len);
    let mut bytes = vec![0; usize::try_from(size_with(layout, elements)).expect("small")];
    pack(layout, value, name, &Defaults::default(), &mut bytes).unwrap_or_else(|error| panic!("{error}"));
    bytes
}

fn texture(gpu: &Gpu, size: [u32; 3], format: wgpu::TextureFormat, usage: wgpu::TextureUsages) -> wgpu::Texture {
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: size[2],
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}

const SHADOW: &str = "
    @group(0) @binding(0) var<uniform> view: mat4x4f;
    struct Object { model: mat4x4f, normal: mat3x3f }
    @group(0) @binding(1) var<storage, read> objects: array<Object>;
    @vertex fn main(@builtin(instance_index) i: u32, @location(0) p: vec3f) -> @builtin(position) vec4f {
        return view * (objects[i].model * vec4f(p, 1.0));
    }";

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

impl Stage {
    /// The scene at this size, laid out as the composed pass has it.
    pub fn new(gpu: Gpu, program: &Program, size: [u32; 2], switches: [u32; 6]) -> Self {
        let device = gpu.device();
        let (vertices, indices, draws) = meshes(&gpu);
        let sampled = wgpu::TextureUsages::TEXTURE_BINDING;
        let maps = [
            texture(&gpu, [MAP, MAP, 1], DEPTH, sampled),
            texture(&gpu, [MAP, MAP, 6], DEPTH, sampled),
        ];
        let mut objects = None;
        let mut bound: Vec<(u32, u32, Bound)> = Vec::new();
        for binding in &program.reflection().bindings {
            let made = match &binding.ty {
                BindingType::Uniform { layout } | BindingType::Storage { layout, .. } => {
                    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE;
                    let bytes = bytes(&binding.name, layout, &contents(&binding.name, size));
                    let buffer = gpu.buffer(&binding.name, usage, &bytes, 0).expect("a buffer");
                    if binding.name == "objects" {
                        objects = Some(buffer.clone());
                    }
                    Bound::Buffer(buffer)
                }
                BindingType::Texture { dimension, .. } => {
                    let cube = dimension.contains("cube");
                    let dimension = if cube {
                        wgpu::TextureViewDimension::CubeArray
                    } else {
                        wgpu::TextureViewDimension::D2Array
                    };
                    Bound::Texture(maps[usize::from(cube)].create_view(&wgpu::TextureViewDescriptor {
                        dimension: Some(dimension),
                        ..Default::default()
                    }))
                }
                BindingType::Sampler { .. } => sampler(&gpu, true, false, true).expect("a sampler"),
                other => panic!("the stage has no {other:?}"),
            };
            bound.push((binding.group, binding.binding, made));
        }
        // Uniform buffers are made of 16 bytes each.
        let switches: Vec<u8> = switches.iter().chain(&[0, 0]).flat_map(|s| s.to_le_bytes()).collect();
        let usage = wgpu::BufferUsages::UNIFORM;
        bound.push((2, 1, Bound::Buffer(gpu.buffer("switches", usage, &switches, 0).expect("a buffer"))));
        let mut entries = bind_group_entries(program.reflection()).expect("a layout");
        entries[2].push(wgpu::BindGroupLayoutEntry {
            binding: 1,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        });
        let layouts = entries.map(|entries| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: None,
                entries: &entries,
            })
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &layouts.each_ref().map(Some),
            immediate_size: 0,
        });
        let groups = std::array::from_fn(|group| {
            let of_group = bound.iter().filter(|(g, _, _)| *g as usize == group);
            let entries: Vec<_> = of_group
                .map(|(_, binding, resource)| wgpu::BindGroupEntry {
                    binding: *binding,
                    resource: match resource {
                        Bound::Buffer(buffer) => buffer.as_entire_binding(),
                        Bound::Texture(view) => wgpu::BindingResource::TextureView(view),
                        Bound::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
                    },
                })
                .collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &layouts[group],
                entries: &entries,
            })
        });
        let target = texture(&gpu, [size[0], size[1], 1], COLOR, wgpu::TextureUsages::COPY_SRC);
        let depth =
            texture(&gpu, [size[0], size[1], 1], DEPTH, wgpu::TextureUsages::empty()).create_view(&wgpu::TextureViewDescriptor::default());
        let stage = Self {
            size,
            layout,
            groups,
            vertices,
            indices,
            draws,
            target,
            depth,
            gpu: gpu.clone(),
        };
        stage.draw_maps(&maps, &objects.expect("objects"));
        stage
    }

    fn draw_maps(&self, maps: &[wgpu::Texture; 2], objects: &wgpu::Buffer) {
        let device = self.gpu.device();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(SHADOW.into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[Some(vertex_layout(&POSITION))],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(depth_state()),
            multisample: wgpu::MultisampleState::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        });
        let layers = std::iter::once((&maps[0], 0, sun_view())).chain((0..6).map(|i| (&maps[1], i, face(FACES[i as usize]))));
        let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (map, layer, matrix) in layers {
            let matrix: Vec<u8> = matrix.to_cols_array().iter().flat_map(|x| x.to_le_bytes()).collect();
            let uniform = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: &matrix,
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: uniform.as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: objects.as_entire_binding(),
                    },
                ],
            });
            let view = layer_view(map, layer);
            let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
                depth_stencil_attachment: Some(depth_attachment(&view)),
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.set_vertex_buffer(0, self.vertices[0].slice(..));
            self.draw(&mut pass);
        }
        self.gpu.queue().submit([commands.finish()]);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass) {
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for (indices, first, objects) in &self.draws {
            pass.draw_indexed(indices.clone(), *first, objects.clone());
        }
    }

    /// The pipeline of a shader with the stage's bindings.
    pub fn pipeline(&self, shader: &Validated) -> wgpu::RenderPipeline {
        let device = self.gpu.device();
        let made = self.gpu.scoped("a pipeline", |_| {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Naga(Cow::Owned(shader.module().clone())),
            });
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&self.layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vertex_main"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[Some(vertex_layout(&POSITION)), Some(vertex_layout(&NORMAL))],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: Some(depth_state()),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("fragment_main"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(COLOR.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        });
        made.unwrap_or_else(|error| panic!("{error}"))
    }

    /// Draws the scene once. `times` are two queries to write when it begins and ends.
    pub fn frame(&self, pipeline: &wgpu::RenderPipeline, commands: &mut wgpu::CommandEncoder, times: Option<(&wgpu::QuerySet, u32)>) {
        let view = self.target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(depth_attachment(&self.depth)),
            timestamp_writes: times.map(|(query_set, first)| wgpu::RenderPassTimestampWrites {
                query_set,
                beginning_of_pass_write_index: Some(first),
                end_of_pass_write_index: Some(first + 1),
            }),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        for (index, group) in self.groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        for (slot, buffer) in self.vertices.iter().enumerate() {
            pass.set_vertex_buffer(slot as u32, buffer.slice(..));
        }
        self.draw(&mut pass);
    }

    /// The picture: four numbers a pixel, row by row. The width is a multiple of 16, so that rows have no gaps.
    pub fn picture(&self, shader: &Validated) -> Vec<f32> {
        let pipeline = self.pipeline(shader);
        let mut commands = self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.frame(&pipeline, &mut commands, None);
        let size = u64::from(self.size[0] * self.size[1] * 16);
        let usage = wgpu::BufferUsages::COPY_SRC;
        let buffer = self.gpu.buffer("picture", usage, &[], size).expect("a buffer");
        commands.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(self.size[0] * 16),
                    rows_per_image: None,
                },
            },
            self.target.size(),
        );
        let bytes = self.gpu.read("picture", commands, &buffer, size).expect("a picture");
        bytes
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect()
    }
}

const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];
const NORMAL: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![1 => Float32x3];

fn vertex_layout(attributes: &[wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'_> {
    wgpu::VertexBufferLayout {
        array_stride: 12,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes,
    }
}

fn depth_state() -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Less),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

type Drawn = (
    [wgpu::Buffer; 2],
    wgpu::Buffer,
    Vec<(std::ops::Range<u32>, i32, std::ops::Range<u32>)>,
);

fn meshes(gpu: &Gpu) -> Drawn {
    let shapes: [Shape; 2] = ["Plane(size: (9.0, 9.0))", "Sphere(radius: 1.0)"].map(|text| ron::from_str(text).expect("a shape"));
    let meshes: Vec<Mesh> = shapes
        .iter()
        .map(|shape| shape.build(|_| unreachable!("nothing to load")).expect("a mesh"))
        .collect();
    let floats = |of: fn(&Mesh) -> &[[f32; 3]]| -> Vec<u8> {
        let all = meshes.iter().flat_map(of).flatten();
        all.flat_map(|x| x.to_le_bytes()).collect()
    };
    let buffer = |bytes: &[u8], usage| gpu.buffer("mesh", usage, bytes, 0).expect("a buffer");
    let vertices = [
        buffer(&floats(|m| &m.positions), wgpu::BufferUsages::VERTEX),
        buffer(&floats(|m| &m.normals), wgpu::BufferUsages::VERTEX),
    ];
    let indices: Vec<u8> = meshes.iter().flat_map(|m| &m.indices).flat_map(|i| i.to_le_bytes()).collect();
    let plane = meshes[0].indices.len() as u32;
    let ball = meshes[1].indices.len() as u32;
    let draws = vec![
        (0..plane, 0, 0..1),
        (plane..plane + ball, meshes[0].positions.len() as i32, 1..objects().len() as u32),
    ];
    (vertices, buffer(&indices, wgpu::BufferUsages::INDEX), draws)
}
