//! The renderer: plans a frame from its recipes' reflection, then draws it.
//!
//! Order of a frame: shadow maps, compute passes of the materials, the scene into the HDR target, compute passes of the
//! display recipe, the display image. All of it is one submission.

use std::collections::HashMap;
use std::sync::Arc;

use shadewright_compiler::Validated;
use shadewright_compiler::catalog::Catalog;
use shadewright_compiler::manifest::Node;
use shadewright_compiler::program::Program;

use super::Frame;
use super::draw::{CASTER, Drawing, SCREEN, request, scene_state};
use super::fill::{Filler, Kept};
use super::maps::{DEPTH, Map};
use super::plan::Plan;
use super::programs::Programs;
use super::target::{DISPLAY, Targets, target};
use super::upload::Uploads;
use crate::gpu::pipeline::{Counts, Pipelines};
use crate::gpu::{Gpu, GpuError, RuntimeError};

/// Draws frames on one device. What it compiles, makes and uploads is kept for the next frame.
pub struct Renderer {
    gpu: Gpu,
    programs: Programs,
    pipelines: Pipelines,
    uploads: Uploads,
    kept: Kept,
}

impl Renderer {
    /// A renderer that links from this library.
    pub fn new(gpu: &Gpu, catalog: Arc<Catalog>) -> Self {
        Self {
            gpu: gpu.clone(),
            programs: Programs::new(catalog),
            pipelines: Pipelines::new(gpu),
            uploads: Uploads::default(),
            kept: Kept::new(),
        }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The library.
    pub fn catalog(&self) -> &Catalog {
        self.programs.catalog()
    }

    /// Pipelines found and made so far.
    pub fn pipeline_counts(&self) -> Counts {
        self.pipelines.counts()
    }

    /// The program that draws a recipe's own pass, compiled if it is new.
    ///
    /// # Errors
    /// The recipe is wrong.
    pub fn program(&self, recipe: &Node) -> Result<Arc<Program>, RuntimeError> {
        Ok(self.programs.get(recipe, "main")?)
    }

    /// Draws with this module instead of the program's own, however it was made: for holding another way to link against ours. Say so before
    /// the first frame. It must have the program's entry points, and what it reads must be bound where the program binds it.
    ///
    /// # Errors
    /// wgpu rejects the module.
    pub fn draw_with(&mut self, program: &Program, module: &Validated) -> Result<(), RuntimeError> {
        Ok(self.pipelines.draw_with(program, module)?)
    }

    /// Makes everything that a frame will need, on all cores: programs and pipelines.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn prepare(&self, frame: &Frame) -> Result<(), RuntimeError> {
        let plan = Plan::of(&self.gpu, &self.programs, frame)?;
        self.make_pipelines(frame, &plan)
    }

    /// Draws a frame. It stays on the GPU: see [`Targets`].
    ///
    /// # Errors
    /// A recipe or value is wrong, the frame's parts do not fit together, or the GPU fails.
    pub fn render(&mut self, frame: &Frame) -> Result<Targets, RuntimeError> {
        self.gpu.check()?;
        let plan = Plan::of(&self.gpu, &self.programs, frame)?;
        self.make_pipelines(frame, &plan)?;
        let hdr = target(&self.gpu, plan.hdr, frame.size)?;
        let depth = target(&self.gpu, DEPTH, frame.size)?;
        let display = plan.display.as_ref().map(|_| target(&self.gpu, DISPLAY, frame.size)).transpose()?;
        let depths = plan.maps.iter().map(|map| self.depth_array(map)).collect::<Result<Vec<_>, _>>()?;
        self.uploads.begin();
        let mut drawing = Drawing {
            pipelines: &self.pipelines,
            frame,
            plan: &plan,
            commands: self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default()),
            passes: 0,
            fill: Filler {
                gpu: &self.gpu,
                programs: &self.programs,
                frame,
                maps: &plan.maps,
                depths: &depths,
                uploads: &mut self.uploads,
                kept: &mut self.kept,
                memo: HashMap::new(),
            },
        };
        drawing.shadow_maps(&depths)?;
        drawing.compute(&plan.before, None)?;
        let hdr_view = hdr.create_view(&wgpu::TextureViewDescriptor::default());
        let depth_view = depth.create_view(&wgpu::TextureViewDescriptor::default());
        drawing.scene(&hdr_view, &depth_view)?;
        if let (Some(look), Some(texture)) = (&plan.display, &display) {
            drawing.compute(&plan.after, Some(&hdr_view))?;
            drawing.display(look, texture, &hdr_view)?;
        }
        let commands = drawing.commands;
        self.gpu.scoped("frame", |_| {
            self.gpu.queue().submit([commands.finish()]);
        })?;
        self.uploads.end();
        Ok(Targets { hdr, display })
    }

    fn make_pipelines(&self, frame: &Frame, plan: &Plan) -> Result<(), RuntimeError> {
        let mut requests = Vec::new();
        for run in &plan.list.runs {
            let draw = &frame.draws[run.draw];
            if let Some(look) = &plan.forward[draw.material] {
                requests.push(request(look, scene_state(draw, plan.hdr))?);
            }
        }
        for look in plan.casters.values() {
            requests.push(request(look, CASTER)?);
        }
        if let Some(look) = &plan.display {
            requests.push(request(look, SCREEN)?);
        }
        requests.sort_by_key(|r| (r.program.hash(), r.state.blend, r.state.cull_back, r.state.mirrored));
        requests.dedup_by(|a, b| a.program.hash() == b.program.hash() && a.state == b.state && a.constants == b.constants);
        self.pipelines.render_many(&requests)?;
        Ok(())
    }

    fn depth_array(&self, map: &Map) -> Result<wgpu::Texture, RuntimeError> {
        let limits = self.gpu.device().limits();
        let layers = u32::try_from(map.eyes.len()).unwrap_or(u32::MAX);
        if map.texels > limits.max_texture_dimension_2d || layers > limits.max_texture_array_layers {
            return Err(GpuError::Unsupported {
                what: format!("a shadow map of {layers} layers of {} texels", map.texels),
                needs: format!(
                    "a texture beyond {} layers of {} texels",
                    limits.max_texture_array_layers, limits.max_texture_dimension_2d
                ),
            }
            .into());
        }
        Ok(self.gpu.scoped("shadow map", |device| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("shadow map"),
                size: wgpu::Extent3d {
                    width: map.texels,
                    height: map.texels,
                    depth_or_array_layers: layers,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: DEPTH,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        })?)
    }
}
