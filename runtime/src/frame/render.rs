//! The renderer: plans a frame from its recipes' reflection, then draws it.
//!
//! Order of a frame: shadow maps, compute passes of the materials, the scene into the HDR target, compute passes of the
//! display recipe, the display image. All of it is one submission.

use std::collections::HashMap;
use std::sync::Arc;

use rayon::prelude::*;
use shadewright_compiler::Validated;
use shadewright_compiler::catalog::Catalog;
use shadewright_compiler::manifest::Node;
use shadewright_compiler::program::Program;
use web_time::Instant;

use super::Frame;
use super::draw::Drawing;
use super::fill::{Filler, Kept};
use super::jobs::Jobs;
use super::list::Cut;
use super::maps::{DEPTH, Map};
use super::needs::{distinct, requests};
use super::plan::Plan;
use super::programs::Programs;
use super::target::{DISPLAY, HdrFormats, Targets, target};
use super::times::Clock;
use super::upload::Uploads;
use crate::gpu::pipeline::Pipelines;
use crate::gpu::{Counts, Gpu, GpuError, RuntimeError};

/// What a frame is drawn into.
pub(super) struct Made {
    pub hdr: wgpu::Texture,
    pub display: Option<wgpu::Texture>,
    /// Shadow maps.
    pub depths: Vec<wgpu::Texture>,
    pub hdr_view: wgpu::TextureView,
    pub depth_view: wgpu::TextureView,
}

/// Draws frames on one device. What it compiles, makes and uploads is kept for the next frame.
pub struct Renderer {
    pub(super) gpu: Gpu,
    pub(super) programs: Arc<Programs>,
    pub(super) pipelines: Arc<Pipelines>,
    pub(super) jobs: Jobs,
    uploads: Uploads,
    kept: Kept,
    formats: Option<HdrFormats>,
    /// Most programs, and most pipelines, that are kept; `None`: all.
    capacity: Option<usize>,
    pub(super) clock: Option<Clock>,
}

impl Renderer {
    /// A renderer that links from this library.
    pub fn new(gpu: &Gpu, catalog: Arc<Catalog>) -> Self {
        Self::with_cache(gpu, catalog, None)
    }

    /// The same, with a driver's cache of compiled pipelines: see [`cache`](crate::gpu::cache).
    pub fn with_cache(gpu: &Gpu, catalog: Arc<Catalog>, cache: Option<wgpu::PipelineCache>) -> Self {
        Self {
            gpu: gpu.clone(),
            programs: Arc::new(Programs::new(catalog)),
            pipelines: Arc::new(Pipelines::new(gpu, cache)),
            jobs: Jobs::default(),
            uploads: Uploads::default(),
            kept: Kept::new(),
            formats: None,
            capacity: None,
            clock: None,
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

    /// Links from another library from now on, such as the same one after an edit. Programs are linked again; pipelines of programs that come out the
    /// same are kept, as is what was uploaded.
    pub fn set_catalog(&mut self, catalog: Arc<Catalog>) {
        self.programs = Arc::new(Programs::new(catalog));
    }

    /// Pipelines found and made so far.
    pub fn pipeline_counts(&self) -> Counts {
        self.pipelines.counts()
    }

    /// Keeps at most so many programs, and as many pipelines, beside those of the latest frame, whichever was drawn with last: for hosts that draw
    /// with ever new permutations. By itself a renderer keeps all.
    pub fn set_capacity(&mut self, most: usize) {
        self.capacity = Some(most);
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

    /// Draws a frame. It stays on the GPU: see [`Targets`].
    ///
    /// # Errors
    /// A recipe or value is wrong, the frame's parts do not fit together, or the GPU fails.
    pub fn render(&mut self, frame: &Frame) -> Result<Targets, RuntimeError> {
        let hdr = self.hdr(frame)?;
        let start = Instant::now();
        self.programs.begin();
        self.pipelines.begin();
        let plan = Plan::of(&self.programs, frame, hdr, &Cut::default())?;
        let planned = Instant::now();
        let wanted = requests(&plan, frame)?;
        let made: Vec<_> = distinct(&wanted).par_iter().map(|request| request.make(&self.pipelines)).collect();
        made.into_iter().collect::<Result<(), GpuError>>()?;
        if let Some(clock) = &mut self.clock {
            clock.cpu.link = planned - start;
            clock.cpu.pipelines = planned.elapsed();
        }
        let shown = self.show(frame, &plan);
        if let Some(most) = self.capacity {
            self.programs.trim(most);
            self.pipelines.trim(most);
        }
        shown
    }

    /// Draws what is planned.
    pub(super) fn show(&mut self, frame: &Frame, plan: &Plan) -> Result<Targets, RuntimeError> {
        let start = Instant::now();
        // Where drawing fails its queries are lost, and with them the timer: it would wait for them.
        let mut clock = self.clock.take();
        let result = self.draw(frame, plan, None, clock.as_mut(), |drawing, made| {
            drawing.shadow_maps(&made.depths)?;
            drawing.compute(&plan.before, None)?;
            drawing.scene(&made.hdr_view, &made.depth_view)?;
            if let (Some(look), Some(texture)) = (&plan.display, &made.display) {
                drawing.compute(&plan.after, Some(&made.hdr_view))?;
                drawing.display(look, texture, &made.hdr_view)?;
            }
            Ok(())
        });
        self.clock = match (clock, result.is_ok()) {
            (Some(mut clock), true) => {
                clock.cpu.record = start.elapsed();
                clock.submitted()?;
                Some(clock)
            }
            (Some(_), false) => Some(Clock::new(&self.gpu)?),
            (None, _) => None,
        };
        let made = result?;
        Ok(Targets {
            hdr: made.hdr,
            display: made.display,
        })
    }

    /// Format of the HDR frame.
    pub(super) fn hdr(&mut self, frame: &Frame) -> Result<wgpu::TextureFormat, RuntimeError> {
        self.gpu.ask()?;
        let gpu = &self.gpu;
        Ok(self.formats.get_or_insert_with(|| HdrFormats::of(gpu)).format(frame))
    }

    /// Makes targets, has them drawn into, and submits. Buffers that modules keep are in `kept`, or else those of the renderer.
    pub(super) fn draw<'p>(
        &mut self,
        frame: &'p Frame,
        plan: &'p Plan<'p>,
        kept: Option<&mut Kept>,
        mut clock: Option<&mut Clock>,
        passes: impl FnOnce(&mut Drawing, &Made) -> Result<(), RuntimeError>,
    ) -> Result<Made, RuntimeError> {
        let hdr = target(&self.gpu, plan.hdr, frame.size)?;
        let depth = target(&self.gpu, DEPTH, frame.size)?;
        let made = Made {
            display: plan.display.as_ref().map(|_| target(&self.gpu, DISPLAY, frame.size)).transpose()?,
            depths: plan.maps.iter().map(|map| self.depth_array(map)).collect::<Result<Vec<_>, _>>()?,
            hdr_view: hdr.create_view(&wgpu::TextureViewDescriptor::default()),
            depth_view: depth.create_view(&wgpu::TextureViewDescriptor::default()),
            hdr,
        };
        self.uploads.begin();
        let mut drawing = Drawing {
            pipelines: &self.pipelines,
            frame,
            plan,
            commands: self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default()),
            passes: 0,
            fill: Filler {
                gpu: &self.gpu,
                programs: &self.programs,
                frame,
                maps: &plan.maps,
                depths: &made.depths,
                uploads: &mut self.uploads,
                kept: kept.unwrap_or(&mut self.kept),
                memo: HashMap::new(),
            },
            least: false,
            timer: clock.as_deref().map(|clock| &clock.timer),
        };
        passes(&mut drawing, &made)?;
        let mut commands = drawing.commands;
        // Buffers of recipes that the frame has no more.
        drawing.fill.kept.retain(|(recipe, id, ..), _| plan.has(*id, recipe));
        self.gpu.scoped("frame", |_| {
            if let Some(clock) = &mut clock {
                clock.timer.resolve(&mut commands);
            }
            self.gpu.queue().submit([commands.finish()]);
        })?;
        self.uploads.end();
        Ok(made)
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
