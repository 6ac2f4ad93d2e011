//! Pipelines: their layout, what the shader leaves open of them, and their constructors.

use super::expr::{Expr, put};
use super::names::{Names, rust};
use super::structs::describe_param;
use super::text::Text;
use super::{Pass, groups, unsupported};
use crate::diagnostics::Report;
use crate::reflect::{EntryPoint, Override, Stage};

/// Writes layout, constants and constructors of a pass.
pub fn write(text: &mut Text, pass: &Pass, names: &Names) -> Result<(), Report> {
    layout(text, pass);
    let overrides = &pass.reflection.overrides;
    if !overrides.is_empty() {
        constants(text, pass, overrides)?;
    }
    text.blank();
    text.doc("The shader's module. It is checked by wgpu as any WGSL is.");
    text.function("shader", &["device: &wgpu::Device"], "wgpu::ShaderModule");
    text.open("device.create_shader_module(wgpu::ShaderModuleDescriptor {");
    text.line(&format!("label: Some({:?}),", pass.module));
    text.line("source: wgpu::ShaderSource::Wgsl(WGSL.into()),");
    text.close("})");
    text.close("}");
    let of = |stage: Stage| -> Vec<&EntryPoint> { pass.reflection.entry_points.iter().filter(|e| e.stage == stage).collect() };
    let (vertex, fragment) = (of(Stage::Vertex), of(Stage::Fragment));
    if vertex.len() > 1 || fragment.len() > 1 {
        return Err(unsupported(pass, "several vertex or fragment entry points"));
    }
    if let Some(vertex) = vertex.first() {
        render(text, pass, names, vertex, fragment.first().copied());
    }
    for entry in of(Stage::Compute) {
        compute(text, pass, names, entry);
    }
    Ok(())
}

fn layout(text: &mut Text, pass: &Pass) {
    let used = groups::used(pass.reflection);
    text.blank();
    text.doc("Layouts of the bind groups and of the pipelines.");
    text.line("#[derive(Clone, Debug)]");
    text.open("pub struct Layout {");
    for group in &used {
        text.doc(&format!("Of [`BindGroup{group}`]."));
        text.line(&format!("pub group_{group}: wgpu::BindGroupLayout,"));
    }
    text.doc("Of the pipelines.");
    text.line("pub pipeline: wgpu::PipelineLayout,");
    text.close("}");
    text.blank();
    text.open("impl Layout {");
    text.doc("Makes them.");
    text.open("pub fn new(device: &wgpu::Device) -> Self {");
    for group in &used {
        let call = Expr::call("device.create_bind_group_layout", Expr::atom(format!("&BindGroup{group}::LAYOUT")));
        put(text, &format!("let group_{group} = "), &call, ";");
    }
    text.open("let pipeline = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {");
    text.line(&format!("label: Some({:?}),", pass.module));
    let last = used.last().map_or(0, |last| last + 1);
    let list = (0..last).map(|group| {
        Expr::atom(if used.contains(&group) {
            format!("Some(&group_{group})")
        } else {
            "None".to_owned()
        })
    });
    let list = Expr::Around("&".to_owned(), Box::new(Expr::Array(list.collect())), "");
    put(text, "bind_group_layouts: ", &list, ",");
    text.line("immediate_size: 0,");
    text.close("});");
    let mut fields: Vec<String> = used.iter().map(|group| format!("group_{group}")).collect();
    fields.push("pipeline".to_owned());
    let fields = fields.into_iter().map(|field| (String::new(), Expr::Atom(field)));
    put(text, "", &Expr::Struct("Self".to_owned(), fields.collect()), "");
    text.close("}");
    text.close("}");
}

/// Writes the struct of the pipeline-overridable constants.
fn constants(text: &mut Text, pass: &Pass, overrides: &[Override]) -> Result<(), Report> {
    let mut fields = Vec::new();
    for constant in overrides {
        let (ty, default, number) = match constant.ty.as_str() {
            "bool" => ("bool", (constant.default != 0.0).to_string(), "f64::from(u8::from(self.NAME))"),
            "f32" | "f16" => ("f32", format!("{:?}", constant.default as f32), "f64::from(self.NAME)"),
            "i32" => ("i32", format!("{}", constant.default), "f64::from(self.NAME)"),
            "u32" => ("u32", format!("{}", constant.default), "f64::from(self.NAME)"),
            other => return Err(unsupported(pass, &format!("the constant `{}: {other}`", constant.name))),
        };
        let field = rust(&constant.name);
        let number = number.replace("NAME", &field);
        fields.push((constant, field, ty, default, number));
    }
    text.blank();
    text.doc("Constants that a pipeline is made with.");
    text.line("#[derive(Clone, Copy, Debug, PartialEq)]");
    text.open("pub struct Constants {");
    for (constant, field, ty, ..) in &fields {
        let params = &pass.reflection.params;
        let param = params.iter().find(|p| p.instance == constant.instance && p.name == constant.param);
        let owner = format!("`{}` of `{}`", constant.param, constant.instance);
        text.doc(&param.map_or_else(|| format!("This is {owner}."), |p| describe_param(&p.declared, &owner)));
        text.field(field, ty);
    }
    text.close("}");
    text.blank();
    text.open("impl Default for Constants {");
    text.doc("The modules' defaults.");
    text.open("fn default() -> Self {");
    let values = fields
        .iter()
        .map(|(_, field, _, default, _)| (field.clone(), Expr::atom(default)))
        .collect();
    put(text, "", &Expr::Struct("Self".to_owned(), values), "");
    text.close("}");
    text.close("}");
    text.blank();
    text.open("impl Constants {");
    text.doc("Keys and values, as wgpu takes them.");
    let count = fields.len();
    text.open(&format!("pub fn entries(&self) -> [(&'static str, f64); {count}] {{"));
    let list = fields
        .iter()
        .map(|(constant, _, _, _, number)| Expr::atom(format!("({:?}, {number})", constant.name)));
    put(text, "", &Expr::Array(list.collect()), "");
    text.close("}");
    text.close("}");
    Ok(())
}

/// Writes what the shader leaves open of a render pipeline, and its constructor.
fn render(text: &mut Text, pass: &Pass, names: &Names, vertex: &EntryPoint, fragment: Option<&EntryPoint>) {
    let constants = !pass.reflection.overrides.is_empty();
    let targets = fragment.map_or(&[][..], |entry| &entry.outputs);
    let count = targets.last().map_or(0, |last| last.location + 1);
    text.blank();
    text.doc("What the shader leaves open of a render pipeline.");
    text.line("#[derive(Clone, Debug)]");
    text.open("pub struct RenderState<'a> {");
    text.doc("Name for people.");
    text.line("pub label: Option<&'a str>,");
    if !vertex.inputs.is_empty() {
        text.doc("Vertex buffers: `&[Some(VertexInput::LAYOUT)]`, or the host's own with the same locations.");
        text.line("pub buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],");
    }
    if count > 0 {
        let list: Vec<String> = targets.iter().map(|t| format!("{} `{}: {}`", t.location, t.name, t.ty)).collect();
        text.doc(&format!("Colour targets by location: {}.", list.join(", ")));
        text.line(&format!("pub targets: [Option<wgpu::ColorTargetState>; {count}],"));
    }
    text.doc("Depth and stencil.");
    text.line("pub depth_stencil: Option<wgpu::DepthStencilState>,");
    text.doc("Topology, culling, winding.");
    text.line("pub primitive: wgpu::PrimitiveState,");
    text.doc("Samples a pixel.");
    text.line("pub multisample: wgpu::MultisampleState,");
    if constants {
        text.doc("Constants.");
        text.line("pub constants: Constants,");
    }
    text.doc("Where the driver may keep what it compiles.");
    text.line("pub cache: Option<&'a wgpu::PipelineCache>,");
    text.close("}");
    text.blank();
    text.doc("A render pipeline. Its errors are wgpu's own, told as the device tells them.");
    let arguments = [
        "device: &wgpu::Device",
        "layout: &Layout",
        "shader: &wgpu::ShaderModule",
        "state: &RenderState<'_>",
    ];
    text.function("render_pipeline", &arguments, "wgpu::RenderPipeline");
    options(text, constants, "state.constants");
    text.open("device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {");
    text.line("label: state.label,");
    text.line("layout: Some(&layout.pipeline),");
    text.open("vertex: wgpu::VertexState {");
    text.line("module: shader,");
    text.line(&format!("entry_point: Some({}),", names.entry(&vertex.name)));
    text.line(if fragment.is_some() {
        "compilation_options: options.clone(),"
    } else {
        "compilation_options: options,"
    });
    text.line(if vertex.inputs.is_empty() {
        "buffers: &[],"
    } else {
        "buffers: state.buffers,"
    });
    text.close("},");
    text.line("primitive: state.primitive,");
    text.line("depth_stencil: state.depth_stencil.clone(),");
    text.line("multisample: state.multisample,");
    if let Some(fragment) = fragment {
        text.open("fragment: Some(wgpu::FragmentState {");
        text.line("module: shader,");
        text.line(&format!("entry_point: Some({}),", names.entry(&fragment.name)));
        text.line("compilation_options: options,");
        text.line(if count > 0 { "targets: &state.targets," } else { "targets: &[]," });
        text.close("}),");
    } else {
        text.line("fragment: None,");
    }
    text.line("multiview_mask: None,");
    text.line("cache: state.cache,");
    text.close("})");
    text.close("}");
}

/// Writes the constructor of a compute pipeline.
fn compute(text: &mut Text, pass: &Pass, names: &Names, entry: &EntryPoint) {
    let constants = !pass.reflection.overrides.is_empty();
    text.blank();
    text.doc(&format!("The compute pipeline of `{}`.", entry.name));
    let mut arguments = vec!["device: &wgpu::Device", "layout: &Layout", "shader: &wgpu::ShaderModule"];
    if constants {
        arguments.push("constants: &Constants");
    }
    arguments.push("cache: Option<&wgpu::PipelineCache>");
    // The render pipeline's constructor has that name.
    let name = if entry.name == "render" { "render_compute" } else { &entry.name };
    text.function(&format!("{name}_pipeline"), &arguments, "wgpu::ComputePipeline");
    options(text, constants, "constants");
    text.open("device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {");
    text.line(&format!("label: Some({}),", names.entry(&entry.name)));
    text.line("layout: Some(&layout.pipeline),");
    text.line("module: shader,");
    text.line(&format!("entry_point: Some({}),", names.entry(&entry.name)));
    text.line("compilation_options: options,");
    text.line("cache,");
    text.close("})");
    text.close("}");
}

fn options(text: &mut Text, constants: bool, from: &str) {
    if constants {
        text.line(&format!("let constants = {from}.entries();"));
        text.open("let options = wgpu::PipelineCompilationOptions {");
        text.line("constants: &constants,");
        text.line("..Default::default()");
        text.close("};");
    } else {
        text.line("let options = wgpu::PipelineCompilationOptions::default();");
    }
}
