//! The renderer: plans a frame from its recipes' reflection, then draws it.
//!
//! Order of a frame: shadow maps, compute passes of the materials, the scene into the HDR target, compute passes of the
//! display recipe, the display image. All of it is one submission.

use std::collections::HashMap;
use std::sync::Arc;

use shadewright_compiler::catalog::Catalog;
use shadewright_compiler::manifest::{Dispatch, Node, PassDecl};
use shadewright_compiler::program::Program;

use super::fill::{Filler, Kept, Look, Shown, reads_hdr, value_of};
use super::list::{List, is_mirrored, world_bounds};
use super::maps::{DEPTH, Map, maps_of, scene_bounds};
use super::programs::Programs;
use super::target::{DISPLAY, Targets, hdr_format, target};
use super::upload::{ATTRIBUTES, Uploads};
use super::view::Eye;
use super::{Draw, Frame};
use crate::gpu::pipeline::{Counts, Pipelines, RenderPipeline, RenderRequest, RenderState};
use crate::gpu::resources::{constants, depth_attachment, layer_view};
use crate::gpu::{DataError, Gpu, GpuError, RuntimeError};

/// Draws frames on one device. What it compiles, makes and uploads is kept for the next frame.
pub struct Renderer {
    gpu: Gpu,
    programs: Programs,
    pipelines: Pipelines,
    uploads: Uploads,
    kept: Kept,
}

/// A frame's programs and views.
struct Plan<'a> {
    /// By material; `None` for materials that nothing shown or casting has.
    forward: Vec<Option<Look<'a>>>,
    maps: Vec<Map>,
    /// By map and material.
    casters: HashMap<(usize, usize), Look<'a>>,
    display: Option<Look<'a>>,
    /// Compute passes before the scene is drawn, and before the display pass: entry point, over what, and the program.
    before: Vec<Compute<'a>>,
    after: Vec<Compute<'a>>,
    eye: Eye,
    list: List,
    /// By map, then layer.
    map_lists: Vec<Vec<List>>,
    hdr: wgpu::TextureFormat,
}

struct Compute<'a> {
    entry: String,
    over: Dispatch,
    look: Look<'a>,
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

    /// Makes everything that a frame will need, on all cores: programs and pipelines.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn prepare(&self, frame: &Frame) -> Result<(), RuntimeError> {
        let plan = self.plan(frame)?;
        self.make_pipelines(frame, &plan)
    }

    /// Draws a frame. It stays on the GPU: see [`Targets`].
    ///
    /// # Errors
    /// A recipe or value is wrong, the frame's parts do not fit together, or the GPU fails.
    pub fn render(&mut self, frame: &Frame) -> Result<Targets, RuntimeError> {
        self.gpu.check()?;
        let plan = self.plan(frame)?;
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

    /// Compiles what the frame needs, and finds out from where it is seen.
    fn plan<'a>(&self, frame: &'a Frame) -> Result<Plan<'a>, RuntimeError> {
        let used = self.used_materials(frame)?;
        let mut wanted: Vec<(Node, String)> = Vec::new();
        for material in used.iter().map(|i| &frame.materials[*i]).chain(&frame.display) {
            let item = ((*material.recipe).clone(), "main".to_owned());
            if !wanted.contains(&item) {
                wanted.push(item);
            }
        }
        self.programs.get_many(&wanted)?;
        let bounds = world_bounds(&frame.draws);
        let scene = scene_bounds(frame, &bounds);
        let mut plan = Plan {
            forward: vec![None; frame.materials.len()],
            maps: Vec::new(),
            casters: HashMap::new(),
            display: None,
            before: Vec::new(),
            after: Vec::new(),
            eye: Eye::of_camera(&frame.camera, frame.size, frame.time),
            list: List::default(),
            map_lists: Vec::new(),
            hdr: hdr_format(&self.gpu, frame.draws.iter().any(|d| d.visible && d.alpha_blend)),
        };
        for id in used {
            let material = &frame.materials[id];
            let program = self.programs.get(&material.recipe, "main")?;
            let parts = (&*material.recipe, &material.settings, &*program);
            let maps = maps_of(&self.programs, frame, parts, scene, &mut plan.maps)?;
            let look = Look {
                id,
                root: (*material.recipe).clone(),
                settings: &material.settings,
                program,
                maps,
            };
            plan.before.extend(self.computes(&look)?);
            plan.forward[id] = Some(look);
        }
        if let Some(material) = &frame.display {
            let look = Look {
                id: frame.materials.len(),
                root: (*material.recipe).clone(),
                settings: &material.settings,
                program: self.programs.get(&material.recipe, "main")?,
                maps: Vec::new(),
            };
            plan.after = self.computes(&look)?;
            plan.display = Some(look);
        }
        plan.list = List::of_camera(&frame.draws, &bounds, &plan.eye);
        for (index, map) in plan.maps.iter().enumerate() {
            let lists: Vec<_> = map.eyes.iter().map(|eye| List::of_casters(&frame.draws, &bounds, eye)).collect();
            for run in lists.iter().flat_map(|l| &l.runs) {
                let id = frame.draws[run.draw].material;
                if let Some(main) = &plan.forward[id]
                    && !plan.casters.contains_key(&(index, id))
                {
                    let root = map.caster(&self.programs, &main.root);
                    let program = self.programs.get(&root, "main")?;
                    let look = Look {
                        root,
                        program,
                        maps: Vec::new(),
                        ..main.clone()
                    };
                    plan.casters.insert((index, id), look);
                }
            }
            plan.map_lists.push(lists);
        }
        Ok(plan)
    }

    /// Materials of draws that are shown or cast, checked.
    fn used_materials(&self, frame: &Frame) -> Result<Vec<usize>, DataError> {
        let mut used = vec![false; frame.materials.len()];
        for (i, draw) in frame.draws.iter().enumerate() {
            let Some(seen) = used.get_mut(draw.material) else {
                let message = format!("material {} of {}", draw.material, frame.materials.len());
                return Err(DataError::new(format!("draws[{i}].material"), message));
            };
            if !draw.model.is_finite() {
                return Err(DataError::new(format!("draws[{i}].model"), "is not finite"));
            }
            *seen |= draw.visible || draw.casts_shadow;
        }
        if !frame.camera.view_projection().is_finite() {
            return Err(DataError::new("camera", "is not finite"));
        }
        Ok((0..used.len()).filter(|i| used[*i]).collect())
    }

    /// The compute passes that a program's modules declare.
    fn computes<'a>(&self, look: &Look<'a>) -> Result<Vec<Compute<'a>>, RuntimeError> {
        let mut computes = Vec::new();
        for pass in &look.program.reflection().passes {
            if let PassDecl::Compute { entry, over } = &pass.declared {
                let program = self.programs.get(&look.root, &format!("{}.{}", pass.instance, pass.name))?;
                let entries = &program.reflection().entry_points;
                let name = entries.first().map_or(entry, |e| &e.name).clone();
                computes.push(Compute {
                    entry: name,
                    over: *over,
                    look: Look { program, ..look.clone() },
                });
            }
        }
        Ok(computes)
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

/// State of the scene's pipelines.
fn scene_state(draw: &Draw, hdr: wgpu::TextureFormat) -> RenderState {
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
const CASTER: RenderState = RenderState {
    color: None,
    blend: false,
    depth: Some(DEPTH),
    depth_write: true,
    cull_back: false,
    mirrored: false,
};

/// The display pass covers the target with one triangle.
const SCREEN: RenderState = RenderState {
    color: Some(DISPLAY),
    blend: false,
    depth: None,
    depth_write: false,
    cull_back: false,
    mirrored: false,
};

fn request<'l>(look: &'l Look, state: RenderState) -> Result<RenderRequest<'l>, DataError> {
    Ok(RenderRequest {
        program: &look.program,
        state,
        constants: constants(look.program.reflection(), |param| value_of(look, param))?,
    })
}

/// A frame on its way into a command buffer.
struct Drawing<'a> {
    pipelines: &'a Pipelines,
    frame: &'a Frame,
    plan: &'a Plan<'a>,
    commands: wgpu::CommandEncoder,
    passes: usize,
    fill: Filler<'a>,
}

/// One draw call, ready.
struct Call {
    pipeline: Arc<RenderPipeline>,
    groups: Vec<wgpu::BindGroup>,
    vertices: Vec<wgpu::Buffer>,
    indices: wgpu::Buffer,
    count: u32,
    objects: std::ops::Range<u32>,
}

impl Drawing<'_> {
    fn next_pass(&mut self) -> usize {
        self.passes += 1;
        self.passes
    }

    fn shadow_maps(&mut self, depths: &[wgpu::Texture]) -> Result<(), RuntimeError> {
        let plan = self.plan;
        for (index, (map, texture)) in plan.maps.iter().zip(depths).enumerate() {
            for (layer, (eye, list)) in (0..).zip(map.eyes.iter().zip(&plan.map_lists[index])) {
                let look = |draw: &Draw| plan.casters.get(&(index, draw.material));
                let calls = self.calls(eye, list, look, |_| CASTER)?;
                let view = layer_view(texture, layer);
                let pass = self.commands.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("shadow map"),
                    depth_stencil_attachment: Some(depth_attachment(&view)),
                    ..Default::default()
                });
                draw_calls(pass, &calls);
            }
        }
        Ok(())
    }

    fn scene(&mut self, hdr: &wgpu::TextureView, depth: &wgpu::TextureView) -> Result<(), RuntimeError> {
        let plan = self.plan;
        let look = |draw: &Draw| plan.forward[draw.material].as_ref();
        let calls = self.calls(&plan.eye, &plan.list, look, |draw| scene_state(draw, plan.hdr))?;
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
            ..Default::default()
        });
        draw_calls(pass, &calls);
        Ok(())
    }

    /// The draw calls of a view.
    fn calls<'l>(
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

    fn compute(&mut self, computes: &[Compute], hdr: Option<&wgpu::TextureView>) -> Result<(), RuntimeError> {
        for Compute { entry, over, look } in computes {
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
            let constants = constants(reflection, |param| value_of(look, param))?;
            let pipeline = self.pipelines.compute(&look.program, entry, &constants)?;
            let groups = self.fill.groups(&pipeline, look, &shown)?;
            let size = reflection.entry_points.first().and_then(|e| e.workgroup_size).unwrap_or([1; 3]);
            let [x, y] = match over {
                Dispatch::Once => [1, 1],
                Dispatch::Frame => [0, 1].map(|i| self.frame.size[i].div_ceil(size[i].max(1))),
            };
            let mut pass = self.commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(&reflection.pass),
                timestamp_writes: None,
            });
            pass.set_pipeline(&pipeline.pipeline);
            for (index, group) in (0..).zip(&groups) {
                pass.set_bind_group(index, group, &[]);
            }
            pass.dispatch_workgroups(x, y, 1);
        }
        Ok(())
    }

    fn display(&mut self, look: &Look, texture: &wgpu::Texture, hdr: &wgpu::TextureView) -> Result<(), RuntimeError> {
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
            ..Default::default()
        });
        pass.set_pipeline(&pipeline.pipeline);
        for (index, group) in (0..).zip(&groups) {
            pass.set_bind_group(index, group, &[]);
        }
        pass.draw(0..3, 0..1);
        Ok(())
    }
}

fn draw_calls(mut pass: wgpu::RenderPass, calls: &[Call]) {
    for call in calls {
        pass.set_pipeline(&call.pipeline.pipeline);
        for (index, group) in (0..).zip(&call.groups) {
            pass.set_bind_group(index, group, &[]);
        }
        for (slot, buffer) in (0..).zip(&call.vertices) {
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        pass.set_index_buffer(call.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..call.count, 0, call.objects.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Bounds, Camera, Material, Mesh, Settings};
    use crate::gpu::testing::{catalog, gpu};
    use glam::{Mat4, Vec3};

    /// Writes the object's own position into the frame, with the opacity .25; members of `Frame` and `Object` are partly left out.
    const FORWARD: &str = "
        struct In { @builtin(instance_index) object: u32, @location(0) position: vec3f }
        struct Out { @builtin(position) clip: vec4f, @location(0) @interpolate(flat) place: vec3f }
        struct Color { @location(0) color: vec4f }
        @vertex fn vertex_main(in: In) -> Out {
            let model = objects[in.object].model;
            return Out(frame.view_projection * model * vec4f(in.position, 1.0), model[3].xyz + vec3f(0.0, frame.size.x, 0.0));
        }
        @fragment fn fragment_main(in: Out) -> Color { return Color(vec4f(in.place, 0.25)); }";

    const DISPLAY_PASS: &str = "
        struct In { @builtin(vertex_index) i: u32 }
        struct At { @builtin(position) at: vec4f }
        struct Color { @location(0) color: vec4f }
        @vertex fn vertex_main(in: In) -> At {
            return At(vec4f(f32(in.i & 1u) * 4.0 - 1.0, f32(in.i >> 1u) * 4.0 - 1.0, 0.0, 1.0));
        }
        @fragment fn fragment_main(in: At) -> Color {
            return Color(vec4f(textureLoad(hdr, vec2u(in.at.xy), 0).rgb / 20.0, 1.0));
        }";

    fn renderer(gpu: &Gpu) -> Renderer {
        let textured = FORWARD
            .replace("position: vec3f }", "position: vec3f, @location(3) uv: vec2f }")
            .replace("in.position,", "in.position + in.uv.xxx,");
        let catalog = catalog(&[
            ("pass/flat/module.ron", "(summary: \"tested\")"),
            ("pass/flat/flat.wgsl", FORWARD),
            ("pass/show/module.ron", "(summary: \"tested\", uses: [\"post\"])"),
            ("pass/show/show.wgsl", DISPLAY_PASS),
            ("pass/textured/module.ron", "(summary: \"tested\")"),
            ("pass/textured/textured.wgsl", &textured),
        ]);
        Renderer::new(gpu, catalog)
    }

    fn material(recipe: &str) -> Material {
        Material {
            recipe: Arc::new(Node::new(recipe)),
            settings: Settings::default(),
        }
    }

    /// A square with corners at +-1 that faces +z.
    fn square() -> Arc<Mesh> {
        Arc::new(Mesh {
            positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Default::default()
        })
    }

    fn draw(mesh: &Arc<Mesh>, model: Mat4) -> Draw {
        Draw {
            mesh: Arc::clone(mesh),
            material: 0,
            model,
            bounds: Bounds {
                min: Vec3::new(-1.0, -1.0, 0.0),
                max: Vec3::new(1.0, 1.0, 0.0),
            },
            visible: true,
            alpha_blend: false,
            double_sided: false,
            casts_shadow: true,
        }
    }

    /// An orthographic camera at z = 10: a target of 8 x 8 texels over 8 x 8 m.
    fn frame(draws: Vec<Draw>) -> Frame {
        Frame {
            camera: Camera {
                view: Mat4::from_translation(Vec3::new(0.0, 0.0, -10.0)),
                projection: glam::camera::rh::proj::directx::orthographic(-4.0, 4.0, -4.0, 4.0, 0.1, 100.0),
            },
            size: [8, 8],
            time: 0.0,
            background: Vec3::new(0.5, 0.0, 0.0),
            materials: vec![material("flat")],
            draws,
            lights: vec![],
            display: Some(material("show")),
        }
    }

    fn at(x: f32, y: f32, z: f32) -> Mat4 {
        Mat4::from_translation(Vec3::new(x, y, z))
    }

    /// The texel that shows (x, y, 0).
    fn texel(image: &[[f32; 4]], x: f32, y: f32) -> [f32; 4] {
        image[((4.0 - y) as usize) * 8 + (x + 4.0) as usize]
    }

    /// Catches wrong transforms of instances, depth order, culling, blending, background, and rows upside down.
    #[test]
    fn squares_stand_where_they_should() {
        let mesh = square();
        let turned = at(2.5, -2.5, 0.0) * Mat4::from_rotation_y(std::f32::consts::PI);
        let blended = Draw {
            alpha_blend: true,
            ..draw(&mesh, at(-2.5, -2.5, 3.0))
        };
        let mirrored = at(0.0, 0.0, 0.0) * Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let draws = vec![
            draw(&mesh, at(-2.5, 2.5, -1.0)),
            draw(&mesh, at(-2.5, 2.5, -2.0)),
            draw(&mesh, at(2.5, 2.5, 1.0)),
            draw(&mesh, turned),
            blended,
            draw(&mesh, mirrored),
        ];
        let mut renderer = renderer(&gpu());
        let frame = frame(draws);
        let targets = renderer.render(&frame).unwrap();
        let hdr = targets.read_hdr(&gpu()).unwrap();
        assert_eq!(texel(&hdr, -2.5, 2.5), [-2.5, 10.5, -1.0, 0.25], "the nearer one, first row on top");
        assert_eq!(texel(&hdr, 2.5, 2.5), [2.5, 10.5, 1.0, 0.25]);
        assert_eq!(texel(&hdr, 2.5, -2.5), [0.5, 0.0, 0.0, 1.0], "seen from behind");
        assert_eq!(texel(&hdr, 0.0, 0.0)[1], 8.0, "mirrored, still seen from the front");
        let mix = texel(&hdr, -2.5, -2.5);
        assert_eq!(mix[..3], [0.25 * -2.5 + 0.75 * 0.5, 0.25 * 5.5, 0.25 * 3.0]);
        let display = targets.read_display(&gpu()).unwrap().unwrap();
        assert_eq!(display[(8 + 6) * 4..][..4], [32, 134, 13, 255]);
        assert_eq!(renderer.pipeline_counts().misses, 4, "scene, blended, mirrored, display");
        let again = renderer.render(&frame).unwrap();
        assert_eq!(again.read_hdr(&gpu()).unwrap(), hdr);
        assert_eq!(renderer.pipeline_counts().misses, 4);
    }

    /// Catches a panic or a silent picture where the frame's parts do not fit.
    #[test]
    fn bad_frames_are_errors() {
        let mut renderer = renderer(&gpu());
        let mesh = square();
        let mut fail = |change: &dyn Fn(&mut Frame)| {
            let mut frame = frame(vec![draw(&mesh, Mat4::IDENTITY)]);
            change(&mut frame);
            renderer.render(&frame).unwrap_err().to_string()
        };
        assert_eq!(fail(&|f| f.draws[0].material = 3), "draws[0].material: material 3 of 1");
        assert_eq!(fail(&|f| f.draws[0].model.x_axis.x = f32::NAN), "draws[0].model: is not finite");
        assert!(fail(&|f| f.size = [0, 4]).starts_with("size: 0 x 4 texels"));
        assert!(fail(&|f| f.size = [4_000_000, 4]).starts_with("size: 4000000 x 4 texels"));
        let with = |positions: usize, indices: Vec<u32>| {
            Arc::new(Mesh {
                positions: vec![[0.0; 3]; positions],
                indices,
                ..Default::default()
            })
        };
        assert_eq!(
            fail(&|f| f.draws[0].mesh = with(3, vec![0, 1, 3])),
            "draws[0].mesh: index 3 in a mesh of 3 vertices"
        );
        assert_eq!(
            fail(&|f| f.draws[0].mesh = with(3, vec![0, 1])),
            "draws[0].mesh: 2 indices are no triangles"
        );
        let mut textured = frame(vec![draw(&mesh, Mat4::IDENTITY)]);
        textured.materials = vec![material("textured")];
        let error = renderer.render(&textured).unwrap_err().to_string();
        assert_eq!(error, "draws[0].mesh: has no texture coordinates, which the recipe reads");
    }

    /// Catches a loss that panics or hangs, and a new device that draws another frame.
    #[test]
    fn lost_device_is_an_error_and_a_new_one_draws_the_same() {
        let frame = frame(vec![draw(&square(), Mat4::IDENTITY)]);
        let draw_on = |gpu: &Gpu| renderer(gpu).render(&frame).and_then(|t| t.read_hdr(gpu));
        let gpu = Gpu::headless().unwrap();
        let before = draw_on(&gpu).unwrap();
        let mut renderer = renderer(&gpu);
        let targets = renderer.render(&frame).unwrap();
        gpu.device().destroy();
        for result in [
            targets.read_hdr(&gpu).map(drop),
            renderer.render(&frame).map(drop),
            draw_on(&gpu).map(drop),
        ] {
            assert!(matches!(result, Err(RuntimeError::Gpu(GpuError::Lost(_)))), "{result:?}");
        }
        assert_eq!(draw_on(&Gpu::headless().unwrap()).unwrap(), before);
    }
}
