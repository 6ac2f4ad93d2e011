//! Pipelines from programs: the IR goes to wgpu as it is, or the source form where a browser compiles, and what has been made is kept.
//!
//! Programs with equal canonical hashes share shader modules and pipelines, whatever recipes they came from.

use std::sync::Arc;

use rayon::prelude::*;
use shadewright_compiler::Validated;
use shadewright_compiler::program::Program;
use shadewright_compiler::reflect::{EntryPoint, Stage};

use super::form::ir;
use super::kept::{Counts, Kept};
use super::layout::{GROUPS, bind_group_entries};
use super::{Gpu, GpuError};

/// Fixed-function state of a render pipeline; with the program and its constants it is the cache's key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize)]
pub struct RenderState {
    /// Colour target; `None` for a depth-only pass.
    #[serde(serialize_with = "format_name")]
    pub color: Option<wgpu::TextureFormat>,
    /// Blend over what is there by the written alpha (not premultiplied).
    pub blend: bool,
    /// Depth target, compared with less; `None` for no depth test.
    #[serde(serialize_with = "format_name")]
    pub depth: Option<wgpu::TextureFormat>,
    /// Write depth.
    pub depth_write: bool,
    /// Drop triangles seen from behind.
    pub cull_back: bool,
    /// The front is where the corners run clockwise: the transform mirrors.
    pub mirrored: bool,
}

/// WebGPU's name of a format: `rgba32float`.
#[allow(clippy::ref_option)] // serde's signature
fn format_name<S: serde::Serializer>(format: &Option<wgpu::TextureFormat>, to: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&format.map(|f| format!("{f:?}").to_lowercase()), to)
}

/// Values of pipeline-overridable constants by key; what is not here keeps its default.
pub type Constants = Vec<(String, f64)>;

/// A pipeline with what is needed to bind resources to it.
#[derive(Debug)]
pub struct Pipeline<P> {
    /// wgpu's pipeline.
    pub pipeline: P,
    /// Layout of each bind group; a group that is not used is empty.
    pub groups: [wgpu::BindGroupLayout; GROUPS],
    /// Locations of the vertex buffers, one buffer for each, in the order of their slots.
    pub vertex_locations: Vec<u32>,
}

/// A render pipeline.
pub type RenderPipeline = Pipeline<wgpu::RenderPipeline>;
/// A compute pipeline.
pub type ComputePipeline = Pipeline<wgpu::ComputePipeline>;

/// What [`Pipelines::render_many`] makes.
#[derive(Clone, Debug)]
pub struct RenderRequest<'a> {
    /// Has a vertex entry point, and a fragment entry point unless it only writes depth.
    pub program: &'a Program,
    /// The rest.
    pub state: RenderState,
    /// Overridden constants.
    pub constants: Constants,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Key<S> {
    hash: u128,
    constants: Vec<(String, u64)>,
    state: S,
}

impl<S> Key<S> {
    fn new(program: &Program, state: S, constants: &Constants) -> Self {
        Self {
            hash: program.hash(),
            constants: bits(constants),
            state,
        }
    }
}

/// The pipelines of one device.
#[derive(Debug)]
pub struct Pipelines {
    gpu: Gpu,
    cache: Option<wgpu::PipelineCache>,
    shaders: Kept<u128, wgpu::ShaderModule>,
    render: Kept<Key<RenderState>, RenderPipeline>,
    compute: Kept<Key<String>, ComputePipeline>,
}

impl Pipelines {
    /// No pipelines yet. They are made with the driver's cache, where one is given: see [`super::cache`].
    pub fn new(gpu: &Gpu, cache: Option<wgpu::PipelineCache>) -> Self {
        Self {
            gpu: gpu.clone(),
            cache,
            shaders: Kept::new(),
            render: Kept::new(),
            compute: Kept::new(),
        }
    }

    /// Render and compute pipelines found and made so far.
    pub fn counts(&self) -> Counts {
        let (render, compute) = (self.render.counts(), self.compute.counts());
        Counts {
            hits: render.hits + compute.hits,
            misses: render.misses + compute.misses,
        }
    }

    /// A frame begins: what it asks for is not forgotten at its end.
    pub(crate) fn begin(&self) {
        self.shaders.begin();
        self.render.begin();
        self.compute.begin();
    }

    /// Forgets what was asked for longest ago, until so many of each kind are left or only those of the present frame.
    pub(crate) fn trim(&self, most: usize) {
        self.shaders.trim(most);
        self.render.trim(most);
        self.compute.trim(most);
    }

    /// Takes this module wherever the program's own would be taken, however it was made. It must have the program's entry points, and what
    /// it reads must be bound where the program binds it. Pipelines that were made before stay.
    ///
    /// # Errors
    /// wgpu rejects the module.
    pub fn draw_with(&self, program: &Program, module: &Validated) -> Result<(), GpuError> {
        self.shaders.get(program.hash(), || self.make_shader(program, ir(module))).map(drop)
    }

    /// One render pipeline.
    ///
    /// # Errors
    /// wgpu rejects it, or the program has no vertex entry point.
    pub fn render(&self, request: &RenderRequest) -> Result<Arc<RenderPipeline>, GpuError> {
        let RenderRequest { program, state, constants } = request;
        self.render.get(Key::new(program, *state, constants), || {
            self.make_render(program, *state, constants)
        })
    }

    /// Whether a render pipeline is there. One that is being made is not.
    pub fn has_render(&self, request: &RenderRequest) -> bool {
        self.render.has(&Key::new(request.program, request.state, &request.constants))
    }

    /// Many render pipelines at once, on all cores; equal requests are made once.
    ///
    /// # Errors
    /// As for [`Pipelines::render`]; of several, that of the first request.
    pub fn render_many(&self, requests: &[RenderRequest]) -> Result<Vec<Arc<RenderPipeline>>, GpuError> {
        let made: Vec<_> = requests.par_iter().map(|request| self.render(request)).collect();
        made.into_iter().collect()
    }

    /// The compute pipeline of an entry point.
    ///
    /// # Errors
    /// wgpu rejects it.
    pub fn compute(&self, program: &Program, entry: &str, constants: &Constants) -> Result<Arc<ComputePipeline>, GpuError> {
        self.compute.get(Key::new(program, entry.to_owned(), constants), || {
            let shader = self.shader(program)?;
            let (groups, layout) = self.layouts(program)?;
            let constants = borrowed(constants);
            let pipeline = self.gpu.scoped(&format!("compute pipeline {entry}"), |device| {
                device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry),
                    layout: Some(&layout),
                    module: &shader,
                    entry_point: Some(entry),
                    compilation_options: options(&constants),
                    cache: self.cache.as_ref(),
                })
            })?;
            Ok(Pipeline {
                pipeline,
                groups,
                vertex_locations: Vec::new(),
            })
        })
    }

    /// Whether the compute pipeline of an entry point is there. One that is being made is not.
    pub fn has_compute(&self, program: &Program, entry: &str, constants: &Constants) -> bool {
        self.compute.has(&Key::new(program, entry.to_owned(), constants))
    }

    fn shader(&self, program: &Program) -> Result<Arc<wgpu::ShaderModule>, GpuError> {
        self.shaders
            .get(program.hash(), || self.make_shader(program, self.gpu.form().of(program)))
    }

    fn make_shader(&self, program: &Program, source: wgpu::ShaderSource) -> Result<wgpu::ShaderModule, GpuError> {
        self.gpu.scoped("shader module", |device| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(&program.reflection().pass),
                source,
            })
        })
    }

    fn layouts(&self, program: &Program) -> Result<([wgpu::BindGroupLayout; GROUPS], wgpu::PipelineLayout), GpuError> {
        let entries = bind_group_entries(program.reflection())?;
        self.gpu.scoped("pipeline layout", |device| {
            let groups = entries.map(|entries| {
                device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                    label: None,
                    entries: &entries,
                })
            });
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &groups.each_ref().map(Some),
                immediate_size: 0,
            });
            (groups, layout)
        })
    }

    fn make_render(&self, program: &Program, state: RenderState, constants: &Constants) -> Result<RenderPipeline, GpuError> {
        let entries = &program.reflection().entry_points;
        let of_stage = |stage: Stage| entries.iter().find(|e| e.stage == stage);
        let vertex = of_stage(Stage::Vertex).ok_or_else(|| GpuError::Unsupported {
            what: format!("drawing with pass {}", program.reflection().pass),
            needs: "a vertex entry point".into(),
        })?;
        let fragment = of_stage(Stage::Fragment);
        let shader = self.shader(program)?;
        let (groups, layout) = self.layouts(program)?;
        let attributes = attributes(vertex)?;
        let buffers: Vec<_> = attributes
            .iter()
            .map(|a| {
                Some(wgpu::VertexBufferLayout {
                    array_stride: a.format.size(),
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: std::slice::from_ref(a),
                })
            })
            .collect();
        let constants = borrowed(constants);
        let targets = [state.color.map(|format| wgpu::ColorTargetState {
            format,
            blend: state.blend.then_some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::ALL,
        })];
        let pipeline = self.gpu.scoped(&format!("render pipeline {}", vertex.name), |device| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(&program.reflection().pass),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &shader,
                    entry_point: Some(&vertex.name),
                    compilation_options: options(&constants),
                    buffers: &buffers,
                },
                primitive: wgpu::PrimitiveState {
                    cull_mode: state.cull_back.then_some(wgpu::Face::Back),
                    front_face: if state.mirrored {
                        wgpu::FrontFace::Cw
                    } else {
                        wgpu::FrontFace::Ccw
                    },
                    ..Default::default()
                },
                depth_stencil: state.depth.map(|format| wgpu::DepthStencilState {
                    format,
                    depth_write_enabled: Some(state.depth_write),
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: fragment.map(|entry| wgpu::FragmentState {
                    module: &shader,
                    entry_point: Some(&entry.name),
                    compilation_options: options(&constants),
                    targets: if state.color.is_some() { &targets } else { &[] },
                }),
                multiview_mask: None,
                cache: self.cache.as_ref(),
            })
        })?;
        Ok(Pipeline {
            pipeline,
            groups,
            vertex_locations: attributes.iter().map(|a| a.shader_location).collect(),
        })
    }
}

/// What a location of the vertex stage holds; the binding ABI fixes it.
fn attributes(vertex: &EntryPoint) -> Result<Vec<wgpu::VertexAttribute>, GpuError> {
    let attribute = |input: &shadewright_compiler::reflect::StageValue| {
        let (format, ty) = match input.location {
            0 | 1 => (wgpu::VertexFormat::Float32x3, "vec3<f32>"),
            2 => (wgpu::VertexFormat::Float32x4, "vec4<f32>"),
            3 => (wgpu::VertexFormat::Float32x2, "vec2<f32>"),
            other => {
                return Err(GpuError::Unsupported {
                    what: format!("vertex input {}", input.name),
                    needs: format!("a mesh attribute at location {other}"),
                });
            }
        };
        if input.ty != ty {
            return Err(GpuError::Unsupported {
                what: format!("vertex input {}", input.name),
                needs: format!("a mesh attribute of {} at location {}", input.ty, input.location),
            });
        }
        Ok(wgpu::VertexAttribute {
            format,
            offset: 0,
            shader_location: input.location,
        })
    };
    vertex.inputs.iter().map(attribute).collect()
}

/// Overridden constants as a key: sorted, values by their bits.
pub(crate) fn bits(constants: &Constants) -> Vec<(String, u64)> {
    let mut bits: Vec<_> = constants.iter().map(|(name, value)| (name.clone(), value.to_bits())).collect();
    bits.sort();
    bits
}

fn borrowed(constants: &Constants) -> Vec<(&str, f64)> {
    constants.iter().map(|(name, value)| (name.as_str(), *value)).collect()
}

fn options<'a>(constants: &'a [(&'a str, f64)]) -> wgpu::PipelineCompilationOptions<'a> {
    wgpu::PipelineCompilationOptions {
        constants,
        ..Default::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::testing::{gpu, pass};

    const FLAT: &str = "
        struct In { @location(0) position: vec3f }
        struct Out { @builtin(position) clip: vec4f }
        struct Color { @location(0) color: vec4f }
        @vertex fn v(in: In) -> Out { return Out(vec4f(in.position, 1.0)); }
        @fragment fn f() -> Color { return Color(vec4f(0.75)); }";

    fn state() -> RenderState {
        RenderState {
            color: Some(wgpu::TextureFormat::Rgba8Unorm),
            blend: false,
            depth: None,
            depth_write: false,
            cull_back: false,
            mirrored: false,
        }
    }

    /// Catches a pipeline made twice for one key, and one shared by two keys.
    #[test]
    fn equal_requests_share_one_pipeline() {
        let pipelines = Pipelines::new(&gpu(), None);
        let (a, same) = (pass(FLAT), pass(&FLAT.replace("Color", "Named")));
        let other = pass(&FLAT.replace("0.75", "0.5"));
        let request = |program, state| RenderRequest {
            program,
            state,
            constants: vec![],
        };
        let blended = RenderState { blend: true, ..state() };
        let made = pipelines
            .render_many(&[
                request(&a, state()),
                request(&same, state()),
                request(&a, blended),
                request(&other, state()),
            ])
            .unwrap();
        assert!(Arc::ptr_eq(&made[0], &made[1]));
        assert!(!Arc::ptr_eq(&made[0], &made[2]) && !Arc::ptr_eq(&made[0], &made[3]));
        assert_eq!(pipelines.counts(), Counts { hits: 1, misses: 3 });
        assert_eq!(made[0].vertex_locations, [0]);
    }

    /// Catches wgpu's panic on an uncaptured error, and errors without a name.
    #[test]
    fn invalid_pipeline_is_a_typed_error() {
        let pipelines = Pipelines::new(&gpu(), None);
        let wrong = pass(&FLAT.replace("color: vec4f", "color: vec4u").replace("vec4f(0.75)", "vec4u(1u)"));
        let request = RenderRequest {
            program: &wrong,
            state: state(),
            constants: vec![],
        };
        let error = pipelines.render(&request).unwrap_err();
        assert!(
            matches!(&error, GpuError::Invalid { what, .. } if what == "render pipeline v"),
            "{error:?}"
        );
        let unknown = RenderRequest {
            constants: vec![("nonsense".into(), 1.0)],
            ..request
        };
        assert!(matches!(pipelines.render(&unknown).unwrap_err(), GpuError::Invalid { .. }));
        let many = vec![unknown; 4];
        assert!(matches!(pipelines.render_many(&many).unwrap_err(), GpuError::Invalid { .. }));
        assert_eq!(gpu().check(), Ok(()), "the error was captured");
    }

    /// Catches a vertex input bound to a mesh attribute of another type, which the driver would fill with garbage.
    #[test]
    fn vertex_input_of_another_type_is_refused() {
        let pipelines = Pipelines::new(&gpu(), None);
        let wrong = pass(&FLAT.replace("@location(0) position", "@location(3) position"));
        let error = pipelines.render(&RenderRequest {
            program: &wrong,
            state: state(),
            constants: vec![],
        });
        assert_eq!(
            error.unwrap_err().to_string(),
            "vertex input position needs a mesh attribute of vec3<f32> at location 3, which is not there"
        );
    }
}
