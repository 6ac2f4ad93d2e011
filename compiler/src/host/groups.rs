//! Bind groups: layouts, and a struct with a field for each resource.

use super::docs::escape;
use super::expr::{Expr, constant};
use super::names::{Names, rust};
use super::structs::{shape, unwrapped};
use super::text::Text;
use super::{Pass, unsupported};
use crate::diagnostics::Report;
use crate::manifest::ResourceKind;
use crate::reflect::{Binding, BindingType, Fill, Layout, Reflection, Stage};

/// Numbers of the bind groups that a pass uses, ascending.
pub fn used(reflection: &Reflection) -> Vec<u32> {
    let mut groups: Vec<u32> = reflection.bindings.iter().map(|binding| binding.group).collect();
    groups.sort_unstable();
    groups.dedup();
    groups
}

/// Writes all bind groups of a pass.
pub fn write(text: &mut Text, pass: &Pass, names: &Names) -> Result<(), Report> {
    for group in used(pass.reflection) {
        let bindings: Vec<&Binding> = pass.reflection.bindings.iter().filter(|b| b.group == group).collect();
        write_group(text, pass, names, group, &bindings)?;
    }
    for binding in &pass.reflection.bindings {
        resource(text, pass, binding);
    }
    Ok(())
}

fn write_group(text: &mut Text, pass: &Pass, names: &Names, group: u32, bindings: &[&Binding]) -> Result<(), Report> {
    let name = format!("BindGroup{group}");
    text.blank();
    text.doc(&format!("Resources of bind group {group}."));
    text.line("#[derive(Clone, Debug)]");
    text.open(&format!("pub struct {name}<'a> {{"));
    for binding in bindings {
        text.doc(&describe(pass, names, binding)?);
        text.field(&rust(&binding.name), handle(&binding.ty));
    }
    text.close("}");
    text.blank();
    text.open(&format!("impl {name}<'_> {{"));
    text.doc("Number of the group.");
    text.line(&format!("pub const INDEX: u32 = {group};"));
    text.blank();
    text.doc("What its bindings are.");
    let entries: Result<Vec<Expr>, Report> = bindings.iter().map(|binding| entry(pass, binding)).collect();
    let ty = format!("[wgpu::BindGroupLayoutEntry; {}]", bindings.len());
    constant(text, "ENTRIES", &ty, &Expr::Array(entries?));
    text.blank();
    text.doc("The layout, for `create_bind_group_layout`.");
    // The type stands on a line of its own: with the longest module's name it would not fit behind the constant's.
    text.line("pub const LAYOUT: wgpu::BindGroupLayoutDescriptor<'static> =");
    text.open("    wgpu::BindGroupLayoutDescriptor {");
    text.line(&format!("    label: Some({:?}),", format!("{} {group}", pass.module)));
    text.line("    entries: &Self::ENTRIES,");
    text.close("    };");
    text.blank();
    text.doc("The bind group with these resources.");
    let layout = "layout: &wgpu::BindGroupLayout";
    text.function("bind", &["&self", "device: &wgpu::Device", layout], "wgpu::BindGroup");
    text.open("device.create_bind_group(&wgpu::BindGroupDescriptor {");
    text.line("label: Self::LAYOUT.label,");
    text.line("layout,");
    let entries = bindings.iter().map(|binding| {
        let field = format!("self.{}", rust(&binding.name));
        let resource = match &binding.ty {
            BindingType::Uniform { .. } | BindingType::Storage { .. } => {
                Expr::call("wgpu::BindingResource::Buffer", Expr::atom(format!("{field}.clone()")))
            }
            BindingType::Sampler { .. } => Expr::call("wgpu::BindingResource::Sampler", Expr::atom(field)),
            _ => Expr::call("wgpu::BindingResource::TextureView", Expr::atom(field)),
        };
        Expr::Struct(
            "wgpu::BindGroupEntry".to_owned(),
            vec![
                ("binding".to_owned(), Expr::atom(binding.binding.to_string())),
                ("resource".to_owned(), resource),
            ],
        )
    });
    let entries = Expr::Around("&".to_owned(), Box::new(Expr::Array(entries.collect())), "");
    super::expr::put(text, "entries: ", &entries, ",");
    text.close("})");
    text.close("}");
    text.close("}");
    Ok(())
}

fn handle(ty: &BindingType) -> &'static str {
    match ty {
        BindingType::Uniform { .. } | BindingType::Storage { .. } => "wgpu::BufferBinding<'a>",
        BindingType::Texture { .. } | BindingType::StorageTexture { .. } => "&'a wgpu::TextureView",
        BindingType::Sampler { .. } => "&'a wgpu::Sampler",
    }
}

/// What a field holds, for people.
fn describe(pass: &Pass, names: &Names, binding: &Binding) -> Result<String, Report> {
    let contents = |layout: &Layout| -> Result<String, Report> {
        let layout = unwrapped(layout);
        let shape = shape(layout, names);
        let shape = shape.ok_or_else(|| unsupported(pass, &format!("`{}: {}` in a buffer", binding.name, layout.ty)))?;
        // Only structs of this module are links.
        let ty = if shape.ty.starts_with(|c: char| c == '[' || c.is_ascii_lowercase()) {
            format!("`{}`", shape.ty)
        } else {
            format!("[`{}`]", shape.ty)
        };
        let unsized_tail = layout
            .members
            .last()
            .is_some_and(|m| m.layout.element.is_some() && m.layout.count.is_none());
        Ok(match (&layout.element, layout.count) {
            (Some(_), None) => format!("any number of {ty}, at least one"),
            _ if unsized_tail => format!("what [`bytes`]({}::bytes) makes", names.of_struct(&layout.ty)),
            _ => ty,
        } + shape
            .note
            .map(|note| format!(". {}", note.trim_end_matches('.')))
            .as_deref()
            .unwrap_or(""))
    };
    let what = match &binding.ty {
        BindingType::Uniform { layout } => format!("uniform buffer: {}", contents(layout)?),
        BindingType::Storage { read_only: true, layout } => format!("read-only storage buffer: {}", contents(layout)?),
        BindingType::Storage { layout, .. } => format!("storage buffer: {}", contents(layout)?),
        BindingType::Texture {
            dimension,
            sample,
            multisampled,
        } => {
            let many = if *multisampled { "multisampled " } else { "" };
            format!("{many}{dimension} texture of {}", sample.replace('_', " "))
        }
        BindingType::StorageTexture { dimension, format, access } => {
            format!("{dimension} storage texture of {format}, {}", access.replace('_', " and "))
        }
        BindingType::Sampler { comparison: true } => "comparison sampler".to_owned(),
        BindingType::Sampler { .. } => "sampler".to_owned(),
    };
    let doc = escape(binding.doc.trim());
    let doc = if doc.is_empty() { doc } else { format!("{doc}.\n\n") };
    Ok(format!("{doc}Binding {}, {what}.", binding.binding))
}

fn fields(of: &str, fields: &[(&str, String)]) -> Expr {
    let fields = fields.iter().map(|(name, value)| ((*name).to_owned(), Expr::atom(value)));
    Expr::Struct(of.to_owned(), fields.collect())
}

/// A layout's entry.
fn entry(pass: &Pass, binding: &Binding) -> Result<Expr, Report> {
    let lacks = |what: String| unsupported(pass, &format!("{what} (`{}`)", binding.name));
    let ty = match &binding.ty {
        BindingType::Uniform { layout } => buffer("wgpu::BufferBindingType::Uniform".to_owned(), layout),
        BindingType::Storage { read_only, layout } => {
            buffer(format!("wgpu::BufferBindingType::Storage {{ read_only: {read_only} }}"), layout)
        }
        BindingType::Texture {
            dimension,
            sample,
            multisampled,
        } => {
            let sample = match sample.as_str() {
                "float" => "Float { filterable: true }",
                "unfilterable_float" => "Float { filterable: false }",
                "depth" => "Depth",
                "sint" => "Sint",
                "uint" => "Uint",
                other => return Err(lacks(format!("textures of {other}"))),
            };
            let sample = match sample.split_once(' ') {
                // A body of more than 18 columns stands on a line of its own.
                Some((head, _)) if sample.contains("false") => Expr::Struct(
                    format!("wgpu::TextureSampleType::{head}"),
                    vec![("filterable".to_owned(), Expr::atom("false"))],
                ),
                _ => Expr::atom(format!("wgpu::TextureSampleType::{sample}")),
            };
            Expr::Struct(
                "wgpu::BindingType::Texture".to_owned(),
                vec![
                    ("sample_type".to_owned(), sample),
                    ("view_dimension".to_owned(), Expr::Atom(view(dimension))),
                    ("multisampled".to_owned(), Expr::atom(multisampled.to_string())),
                ],
            )
        }
        BindingType::StorageTexture { dimension, format, access } => {
            let access = match access.as_str() {
                "read" => "ReadOnly",
                "write" => "WriteOnly",
                _ => "ReadWrite",
            };
            let format = storage_format(format).ok_or_else(|| lacks(format!("storage textures of {format}")))?;
            fields(
                "wgpu::BindingType::StorageTexture",
                &[
                    ("access", format!("wgpu::StorageTextureAccess::{access}")),
                    ("format", format!("wgpu::TextureFormat::{format}")),
                    ("view_dimension", view(dimension)),
                ],
            )
        }
        BindingType::Sampler { comparison } => {
            let linear = matches!(
                &binding.fill,
                Fill::Resource {
                    declared: ResourceKind::Sampler { linear: true, .. },
                    ..
                }
            );
            let kind = match (comparison, linear) {
                (true, _) => "Comparison",
                (_, true) => "Filtering",
                _ => "NonFiltering",
            };
            Expr::call(
                "wgpu::BindingType::Sampler",
                Expr::atom(format!("wgpu::SamplerBindingType::{kind}")),
            )
        }
    };
    Ok(Expr::Struct(
        "wgpu::BindGroupLayoutEntry".to_owned(),
        vec![
            ("binding".to_owned(), Expr::atom(binding.binding.to_string())),
            ("visibility".to_owned(), Expr::atom(visibility(&binding.stages))),
            ("ty".to_owned(), ty),
            ("count".to_owned(), Expr::atom("None")),
        ],
    ))
}

fn buffer(ty: String, layout: &Layout) -> Expr {
    fields(
        "wgpu::BindingType::Buffer",
        &[
            ("ty", ty),
            ("has_dynamic_offset", "false".to_owned()),
            (
                "min_binding_size",
                format!("core::num::NonZeroU64::new({})", layout.smallest_size()),
            ),
        ],
    )
}

fn view(dimension: &str) -> String {
    let name = match dimension {
        "1d" => "D1",
        "2d_array" => "D2Array",
        "3d" => "D3",
        "cube" => "Cube",
        "cube_array" => "CubeArray",
        _ => "D2",
    };
    format!("wgpu::TextureViewDimension::{name}")
}

fn visibility(stages: &[Stage]) -> String {
    let has = |stage| stages.contains(&stage);
    let name = match (has(Stage::Vertex), has(Stage::Fragment), has(Stage::Compute)) {
        (true, true, false) => "VERTEX_FRAGMENT",
        (true, false, false) => "VERTEX",
        (false, true, false) => "FRAGMENT",
        (false, false, true) => "COMPUTE",
        (false, false, false) => "NONE",
        // Layouts may be wider than their pipelines are.
        _ => "all()",
    };
    format!("wgpu::ShaderStages::{name}")
}

/// wgpu's name of a WGSL texel format.
fn storage_format(name: &str) -> Option<String> {
    let known = [
        "r8unorm",
        "r8snorm",
        "r8uint",
        "r8sint",
        "r16uint",
        "r16sint",
        "r16float",
        "rg8unorm",
        "rg8snorm",
        "rg8uint",
        "rg8sint",
        "r32uint",
        "r32sint",
        "r32float",
        "rg16uint",
        "rg16sint",
        "rg16float",
        "rgba8unorm",
        "rgba8snorm",
        "rgba8uint",
        "rgba8sint",
        "bgra8unorm",
        "rgb10a2uint",
        "rgb10a2unorm",
        "rg11b10ufloat",
        "rg32uint",
        "rg32sint",
        "rg32float",
        "rgba16uint",
        "rgba16sint",
        "rgba16float",
        "rgba32uint",
        "rgba32sint",
        "rgba32float",
        "r16unorm",
        "r16snorm",
        "rg16unorm",
        "rg16snorm",
        "rgba16unorm",
        "rgba16snorm",
    ];
    let kinds = ["unorm", "snorm", "uint", "sint", "ufloat", "float"];
    let kind = kinds
        .into_iter()
        .find(|kind| name.ends_with(kind))
        .filter(|_| known.contains(&name))?;
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    Some(capital(name.strip_suffix(kind)?) + &capital(kind))
}

/// Writes what a module says of a resource that the host makes: samplers, and sizes of buffers.
fn resource(text: &mut Text, pass: &Pass, binding: &Binding) {
    let Fill::Resource { instance, declared, .. } = &binding.fill else {
        return;
    };
    match declared {
        ResourceKind::Sampler { linear, repeat, compare } => {
            let filter = if *linear { "Linear" } else { "Nearest" };
            let edge = if *repeat { "Repeat" } else { "ClampToEdge" };
            text.blank();
            text.doc(&format!("The sampler that `{}` is declared to be.", binding.name));
            text.function(&format!("create_{}", binding.name), &["device: &wgpu::Device"], "wgpu::Sampler");
            text.open("device.create_sampler(&wgpu::SamplerDescriptor {");
            text.line(&format!("label: Some({:?}),", binding.name));
            for axis in ["u", "v", "w"] {
                text.line(&format!("address_mode_{axis}: wgpu::AddressMode::{edge},"));
            }
            text.line(&format!("mag_filter: wgpu::FilterMode::{filter},"));
            text.line(&format!("min_filter: wgpu::FilterMode::{filter},"));
            text.line(&format!("mipmap_filter: wgpu::MipmapFilterMode::{filter},"));
            if *compare {
                text.line("compare: Some(wgpu::CompareFunction::LessEqual),");
            }
            text.line("..Default::default()");
            text.close("})");
            text.close("}");
        }
        ResourceKind::Buffer { bytes } => {
            text.blank();
            text.doc(&format!(
                "Bytes of the buffer `{}`; they start as zeros and are kept.",
                binding.name
            ));
            text.line(&format!("pub const BYTES_{}: u64 = {bytes};", binding.name.to_uppercase()));
        }
        ResourceKind::Data {
            file: Some(file),
            format: None,
        } => {
            let of = pass.reflection.instances.iter().find(|of| Some(&of.name) == instance.as_ref());
            let folder = of.map_or_else(String::new, |of| format!("{}/{}/", of.category, of.module));
            text.blank();
            text.doc(&format!(
                "File of the library with the little-endian 32-bit floats that fill `{}`.",
                binding.name
            ));
            let path = format!("{folder}{file}");
            text.line(&format!("pub const FILE_{}: &str = {path:?};", binding.name.to_uppercase()));
        }
        _ => {}
    }
}
