//! Shaders that the program links itself: it reads modules from a folder, compiles the tree that it wants, and gives the IR to wgpu.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use shadewright_compiler::manifest::{Filling, Node, ResourceKind, Typed, typed};
use shadewright_compiler::reflect::{Binding, BindingType, Fill, Layout, ParamPlace, Reflection, Stage};
use shadewright_compiler::{Catalog, Library, Program, Recipe, Report};

use crate::gpu::{COLOR, Draw, Error, Gpu, depth_state};
use crate::mesh::Corner;
use crate::world::World;

/// The modules of a folder.
struct Shaders(PathBuf);

impl Library for Shaders {
    fn folders(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.join(folder)).into_iter().flatten().flatten();
        let folders = entries.filter(|entry| entry.path().is_dir());
        folders.filter_map(|entry| entry.file_name().into_string().ok()).collect()
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        let text = self.bytes(path)?.map(String::from_utf8).transpose();
        text.map_err(|error| error.to_string())
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        match std::fs::read(self.0.join(path)) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.to_string()),
        }
    }
}

impl From<Report> for Error {
    fn from(report: Report) -> Self {
        Self::Shader(report.to_string())
    }
}

/// Links shaders, and keeps those that it has linked.
#[derive(Debug)]
pub struct Linker<'g> {
    gpu: &'g Gpu,
    catalog: Catalog,
    recipe: Recipe,
    linked: HashMap<&'static str, Linked>,
}

#[derive(Debug)]
struct Linked {
    program: Program,
    pipeline: wgpu::RenderPipeline,
}

impl<'g> Linker<'g> {
    /// Reads the declarations of the modules that this repository has.
    ///
    /// # Errors
    /// One of them is wrong, or the recipe is not there.
    pub fn new(gpu: &'g Gpu) -> Result<Self, Error> {
        let home = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let file = home.join("shaders/matte.recipe.ron");
        let text = std::fs::read_to_string(&file).map_err(|error| Error::File(format!("{}: {error}", file.display())))?;
        Ok(Self {
            gpu,
            catalog: Catalog::load(Arc::new(Shaders(home.join("../../modules"))))?,
            recipe: Recipe::parse("matte.recipe.ron", &text)?,
            linked: HashMap::new(),
        })
    }

    /// The recipe with another module in its slot `brdf`, linked when it is first wanted.
    ///
    /// # Errors
    /// The tree cannot be linked, or wgpu refuses it.
    pub fn program(&mut self, brdf: &'static str) -> Result<&Program, Error> {
        Ok(&self.linked(brdf)?.program)
    }

    fn linked(&mut self, brdf: &'static str) -> Result<&Linked, Error> {
        if !self.linked.contains_key(brdf) {
            let mut root = self.recipe.root.clone();
            root.fill.insert("brdf".to_owned(), Filling::One(Node::new(brdf)));
            let program = self.catalog.compile(&root.into(), "main")?;
            let pipeline = self.gpu.checked(|device| pipeline(device, &program))?;
            self.linked.insert(brdf, Linked { program, pipeline });
        }
        // It was put there if it was not there yet.
        Ok(&self.linked[brdf])
    }

    /// What draws a moment. A finish that was never seen before is linked now.
    ///
    /// # Errors
    /// As for [`Linker::program`].
    pub fn draw(&mut self, world: &World) -> Result<Draw, Error> {
        let gpu = self.gpu;
        let Linked { program, pipeline } = self.linked(world.finish.module())?;
        let reflection = program.reflection();
        let mut groups: Vec<(u32, Vec<(u32, wgpu::Buffer)>)> = Vec::new();
        for binding in &reflection.bindings {
            let (usage, bytes) = contents(reflection, binding, world)?;
            let buffer = (binding.binding, gpu.buffer(&bytes, usage));
            match groups.last_mut() {
                Some((group, buffers)) if *group == binding.group => buffers.push(buffer),
                _ => groups.push((binding.group, vec![buffer])),
            }
        }
        let groups = groups.into_iter().map(|(group, buffers)| {
            let entry = |(binding, buffer): &(u32, wgpu::Buffer)| (*binding, buffer.clone());
            let buffers: Vec<_> = buffers.iter().map(entry).collect();
            let entries: Vec<_> = buffers
                .iter()
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding: *binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            let bound = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(group),
                entries: &entries,
            });
            (group, bound)
        });
        Ok(Draw {
            groups: groups.collect(),
            pipeline: pipeline.clone(),
        })
    }
}

/// wgpu takes the linked IR as it is: no text is written and none is parsed. The layout of the bind groups it finds itself.
fn pipeline(device: &wgpu::Device, program: &Program) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Naga(Cow::Owned(program.validated().module().clone())),
    });
    let inputs = program.reflection().entry_points.iter().find(|e| e.stage == Stage::Vertex);
    let inputs = inputs.map_or(&[][..], |entry| &entry.inputs);
    // The renderer's own vertices have these two attributes.
    let attributes: Vec<_> = inputs
        .iter()
        .filter(|input| matches!(input.name.as_str(), "position" | "normal"))
        .map(|input| wgpu::VertexAttribute {
            format: wgpu::VertexFormat::Float32x3,
            offset: if input.name == "normal" { 12 } else { 0 },
            shader_location: input.location,
        })
        .collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Corner>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(depth_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// What a binding holds: reflection says what it is, and where in it each thing stands.
fn contents(reflection: &Reflection, binding: &Binding, world: &World) -> Result<(wgpu::BufferUsages, Vec<u8>), Error> {
    let (usage, layout) = match &binding.ty {
        BindingType::Uniform { layout } => (wgpu::BufferUsages::UNIFORM, layout),
        BindingType::Storage { layout, .. } => (wgpu::BufferUsages::STORAGE, layout),
        _ => return Err(Error::Shader(format!("this renderer has nothing to bind to `{}`", binding.name))),
    };
    let mut bytes = vec![0; layout.smallest_size() as usize];
    let layout = layout.element.as_deref().unwrap_or(layout);
    match &binding.fill {
        Fill::Params => {
            for param in &reflection.params {
                let ParamPlace::Uniform {
                    group,
                    binding: at,
                    offset,
                    ..
                } = param.place
                else {
                    continue;
                };
                if (group, at) != (binding.group, binding.binding) {
                    continue;
                }
                match param.name.as_str() {
                    "base_color" => write(&mut bytes, offset, &world.base_color),
                    "roughness" => write(&mut bytes, offset, &[world.roughness]),
                    _ => write_typed(&mut bytes, offset, typed(&param.declared, &param.declared.default).ok()),
                }
            }
        }
        Fill::Instances { instance } => {
            // One light of each kind: the fields' defaults, and over them what this renderer knows by the fields' roles.
            let instance = reflection.instances.iter().find(|i| i.name == *instance);
            for member in &layout.members {
                let field = instance.and_then(|i| i.fields.get(&member.name));
                match member.name.as_str() {
                    "direction" => write(&mut bytes, member.offset, &world.sun_direction),
                    "illuminance" => write(&mut bytes, member.offset, &[world.sun_lux]),
                    "position" => write(&mut bytes, member.offset, &world.lamp_position),
                    "intensity" => write(&mut bytes, member.offset, &[world.lamp_candela]),
                    _ => write_typed(&mut bytes, member.offset, field.and_then(|f| typed(f, &f.default).ok())),
                }
            }
        }
        Fill::Resource {
            declared: ResourceKind::Host(_),
            ..
        } => fill_host(&mut bytes, layout, world),
        Fill::Resource { resource, .. } => return Err(Error::Shader(format!("this renderer has no `{resource}`"))),
    }
    Ok((usage, bytes))
}

/// The view and the objects, member by member.
fn fill_host(bytes: &mut [u8], layout: &Layout, world: &World) {
    for member in &layout.members {
        let at = member.offset;
        match member.name.as_str() {
            "view_projection" => write(bytes, at, world.view_projection.as_flattened()),
            "eye" => write(bytes, at, &world.eye),
            "perspective" => write(bytes, at, &[1.0]),
            "forward" => write(bytes, at, &world.forward),
            "model" => write(bytes, at, world.model.as_flattened()),
            "normal" => write(bytes, at, world.normal_matrix().as_flattened()),
            _ => {}
        }
    }
}

/// Writes numbers; what would not fit is left out.
fn write(bytes: &mut [u8], offset: u32, numbers: &[f32]) {
    let start = offset as usize;
    if let Some(place) = bytes.get_mut(start..start + size_of_val(numbers)) {
        place.copy_from_slice(bytemuck::cast_slice(numbers));
    }
}

fn write_typed(bytes: &mut [u8], offset: u32, value: Option<Typed>) {
    match value {
        Some(Typed::F32(x)) => write(bytes, offset, &[x]),
        Some(Typed::U32(x)) => write(bytes, offset, &[f32::from_bits(x)]),
        Some(Typed::I32(x)) => write(bytes, offset, &[f32::from_bits(x.cast_unsigned())]),
        Some(Typed::Vec2(x)) => write(bytes, offset, &x),
        Some(Typed::Vec3(x)) => write(bytes, offset, &x),
        Some(Typed::Vec4(x)) => write(bytes, offset, &x),
        Some(Typed::Bool(_)) | None => {}
    }
}
