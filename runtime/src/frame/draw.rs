//! Writes a planned frame's passes into a command buffer.

use std::sync::Arc;

use indexmap::IndexSet;
use shadewright_compiler::manifest::Dispatch;
use wgpu_profiler::GpuProfilerQuery;

use super::fill::{Filler, Look, Shown, reads_hdr, value_of};
use super::list::{List, is_mirrored};
use super::maps::DEPTH;
use super::plan::{Compute, Plan};
use super::target::DISPLAY;
use super::upload::ATTRIBUTES;
use super::view::Eye;
use super::{Draw, Frame};
use crate::gpu::pipeline::{Constants, Pipelines, RenderPipeline, RenderRequest, RenderState};
use crate::gpu::resources::{constants, depth_attachment, layer_view};
use crate::gpu::{DataError, RuntimeError, Timer};

/// State of the scene's pipelines.
pub(crate) fn scene_state(draw: &Draw, hdr: wgpu::TextureFormat) -> RenderState {
    RenderState {
        color: Some(hdr),
        blend: draw.alpha_blend,
        depth: Some(DEPTH),
        depth_write: !draw.alpha_blend,
        cull_back: !draw.double_sided,
        mirrored: is_mirrored(draw),
    }
}

/// Shadow maps keep both sides: a thin object casts from wherever the light stands, and a cube map's faces are mirrored.
pub(crate) const CASTER: RenderState = RenderState {
    color: None,
    blend: false,
    depth: Some(DEPTH),
    depth_write: true,
    cull_back: false,
    mirrored: false,
};

/// The display pass covers the target with one triangle.
pub(crate) const SCREEN: RenderState = RenderState {
    color: Some(DISPLAY),
    blend: false,
    depth: None,
    depth_write: false,
    cull_back: false,
    mirrored: false,
};

/// The constants that a look's settings override.
pub(crate) fn overridden(look: &Look) -> Result<Constants, DataError> {
    constants(look.program.reflection(), |param| value_of(look, param))
}

/// A pipeline for a program in a state, with the constants that its settings override.
pub(crate) fn request<'l>(look: &'l Look, state: RenderState) -> Result<RenderRequest<'l>, DataError> {
    Ok(RenderRequest {
        program: &look.program,
        state,
        constants: overridden(look)?,
    })
}

/// A frame on its way into a command buffer.
pub(crate) struct Drawing<'a> {
    pub pipelines: &'a Pipelines,
    pub frame: &'a Frame,
    pub plan: &'a Plan<'a>,
    pub commands: wgpu::CommandEncoder,
    pub passes: usize,
    pub fill: Filler<'a>,
    /// Only one triangle of each call, and of that only the first texel: enough for a driver that compiles when it draws.
    pub least: bool,
    /// Times the passes, where somebody wants to know.
    pub timer: Option<&'a Timer>,
}

/// One draw call, ready.
pub(super) struct Call {
    pub material: usize,
    pub pipeline: Arc<RenderPipeline>,
    groups: Vec<wgpu::BindGroup>,
    vertices: Vec<wgpu::Buffer>,
    indices: wgpu::Buffer,
    count: u32,
    objects: std::ops::Range<u32>,
}

impl Drawing<'_> {
    pub(super) fn next_pass(&mut self) -> usize {
        self.passes += 1;
        self.passes
    }

    /// Draws all layers of all shadow maps.
    pub fn shadow_maps(&mut self, depths: &[wgpu::Texture]) -> Result<(), RuntimeError> {
        let plan = self.plan;
        for (index, (map, texture)) in plan.maps.iter().zip(depths).enumerate() {
            for (layer, (eye, list)) in (0..).zip(map.eyes.iter().zip(&plan.map_lists[index])) {
                let look = |draw: &Draw| plan.casters.get(&(index, draw.material));
                let calls = self.calls(eye, list, look, |_| CASTER)?;
                let query = self.query(|| map.name(layer as usize));
                self.shadow_layer(&layer_view(texture, layer), &calls, query);
            }
        }
        Ok(())
    }

    /// Clears a layer of a shadow map and draws into it.
    pub(super) fn shadow_layer(&mut self, view: &wgpu::TextureView, calls: &[Call], query: Option<GpuProfilerQuery>) {
        let pass = self.commands.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            depth_stencil_attachment: Some(depth_attachment(view)),
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes),
            ..Default::default()
        });
        draw_calls(pass, calls, self.least);
        self.end(query);
    }

    /// Draws what the camera sees.
    pub fn scene(&mut self, hdr: &wgpu::TextureView, depth: &wgpu::TextureView) -> Result<(), RuntimeError> {
        let plan = self.plan;
        let look = |draw: &Draw| plan.forward[draw.material].as_ref();
        let calls = self.calls(&plan.eye, &plan.list, look, |draw| scene_state(draw, plan.hdr))?;
        self.scene_calls(hdr, depth, &calls);
        Ok(())
    }

    /// Clears the HDR frame and draws into it.
    pub(super) fn scene_calls(&mut self, hdr: &wgpu::TextureView, depth: &wgpu::TextureView, calls: &[Call]) {
        let query = self.query(|| {
            let passes: IndexSet<&str> = self.plan.forward.iter().flatten().map(|look| &*look.root.module).collect();
            format!("scene ({})", Vec::from_iter(passes).join(", "))
        });
        let [r, g, b] = self.frame.background.to_array().map(f64::from);
        let pass = self.commands.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: hdr,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(depth_attachment(depth)),
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes),
            ..Default::default()
        });
        draw_calls(pass, calls, self.least);
        self.end(query);
    }

    /// The draw calls of a view.
    pub(super) fn calls<'l>(
        &mut self,
        eye: &Eye,
        list: &List,
        look: impl Fn(&Draw) -> Option<&'l Look<'l>>,
        state: impl Fn(&Draw) -> RenderState,
    ) -> Result<Vec<Call>, RuntimeError> {
        let shown = Shown {
            pass: self.next_pass(),
            eye: Some(eye),
            list: Some(list),
            hdr: None,
        };
        let mut calls = Vec::new();
        for run in &list.runs {
            let draw = &self.frame.draws[run.draw];
            let Some(look) = look(draw) else { continue };
            let path = format!("draws[{}].mesh", run.draw);
            let mesh = self.fill.uploads.mesh(self.fill.gpu, &draw.mesh, &path)?;
            if mesh.count == 0 {
                continue;
            }
            let pipeline = self.pipelines.render(&request(look, state(draw))?)?;
            let attribute = |location: &u32| {
                let buffer = mesh.attributes.get(*location as usize).and_then(Option::clone);
                buffer.ok_or_else(|| DataError::new(&path, format!("has no {}, which the recipe reads", ATTRIBUTES[*location as usize])))
            };
            calls.push(Call {
                material: draw.material,
                vertices: pipeline.vertex_locations.iter().map(attribute).collect::<Result<_, _>>()?,
                groups: self.fill.groups(&pipeline, look, &shown)?,
                pipeline,
                indices: mesh.indices.clone(),
                count: mesh.count,
                objects: run.objects.clone(),
            });
        }
        Ok(calls)
    }

    /// Runs compute passes; `hdr` is there after the scene was drawn.
    pub fn compute(&mut self, computes: &[Compute], hdr: Option<&wgpu::TextureView>) -> Result<(), RuntimeError> {
        computes.iter().try_for_each(|compute| self.dispatch(compute, hdr))
    }

    /// Runs one compute pass.
    pub(super) fn dispatch(&mut self, compute: &Compute, hdr: Option<&wgpu::TextureView>) -> Result<(), RuntimeError> {
        let Compute { entry, over, look } = compute;
        let plan = self.plan;
        let shown = Shown {
            pass: self.next_pass(),
            eye: Some(&plan.eye),
            list: None,
            hdr,
        };
        let reflection = look.program.reflection();
        if hdr.is_none() && reads_hdr(reflection) {
            return Err(DataError::new(&reflection.pass, "reads the finished frame, but runs before it").into());
        }
        let pipeline = self.pipelines.compute(&look.program, entry, &overridden(look)?)?;
        let groups = self.fill.groups(&pipeline, look, &shown)?;
        let size = reflection.entry_points.first().and_then(|e| e.workgroup_size).unwrap_or([1; 3]);
        let [x, y] = match over {
            Dispatch::Frame if !self.least => [0, 1].map(|i| self.frame.size[i].div_ceil(size[i].max(1))),
            _ => [1, 1],
        };
        let query = self.query(|| reflection.pass.clone());
        let mut pass = self.commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(&reflection.pass),
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::compute_pass_timestamp_writes),
        });
        pass.set_pipeline(&pipeline.pipeline);
        for (index, group) in (0..).zip(&groups) {
            pass.set_bind_group(index, group, &[]);
        }
        pass.dispatch_workgroups(x, y, 1);
        drop(pass);
        self.end(query);
        Ok(())
    }

    /// Draws the display image from the HDR frame.
    pub fn display(&mut self, look: &Look, texture: &wgpu::Texture, hdr: &wgpu::TextureView) -> Result<(), RuntimeError> {
        let plan = self.plan;
        let shown = Shown {
            pass: self.next_pass(),
            eye: Some(&plan.eye),
            list: None,
            hdr: Some(hdr),
        };
        let pipeline = self.pipelines.render(&request(look, SCREEN)?)?;
        if !pipeline.vertex_locations.is_empty() {
            return Err(DataError::new("display", "the pass reads a mesh; it must make its triangle from the vertex index").into());
        }
        let groups = self.fill.groups(&pipeline, look, &shown)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let query = self.query(|| format!("display ({})", look.root.module));
        let mut pass = self.commands.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline.pipeline);
        for (index, group) in (0..).zip(&groups) {
            pass.set_bind_group(index, group, &[]);
        }
        if self.least {
            pass.set_scissor_rect(0, 0, 1, 1);
        }
        pass.draw(0..3, 0..1);
        drop(pass);
        self.end(query);
        Ok(())
    }

    /// A query for the next pass, where passes are timed. It goes to [`Drawing::end`] when the pass is recorded.
    fn query(&mut self, name: impl FnOnce() -> String) -> Option<GpuProfilerQuery> {
        Some(self.timer?.begin(name(), &mut self.commands))
    }

    fn end(&mut self, query: Option<GpuProfilerQuery>) {
        if let (Some(timer), Some(query)) = (self.timer, query) {
            timer.end(&mut self.commands, query);
        }
    }
}

fn draw_calls(mut pass: wgpu::RenderPass, calls: &[Call], least: bool) {
    if least {
        pass.set_scissor_rect(0, 0, 1, 1);
    }
    for call in calls {
        pass.set_pipeline(&call.pipeline.pipeline);
        for (index, group) in (0..).zip(&call.groups) {
            pass.set_bind_group(index, group, &[]);
        }
        for (slot, buffer) in (0..).zip(&call.vertices) {
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        pass.set_index_buffer(call.indices.slice(..), wgpu::IndexFormat::Uint32);
        if least {
            pass.draw_indexed(0..3, 0, call.objects.start..call.objects.start + 1);
        } else {
            pass.draw_indexed(0..call.count, 0, call.objects.clone());
        }
    }
}
