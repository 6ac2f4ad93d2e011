//! Programs from WGSL text for the unit tests of this crate, reflected without the compiler.

use naga::{ArraySize, ScalarKind, TypeInner};
use shadewright_compiler::Validated;
use shadewright_compiler::manifest::ResourceKind;
use shadewright_compiler::program::Program;
use shadewright_compiler::reflect::{Binding, BindingType, EntryPoint, Fill, Layout, Member, Reflection, Stage, StageValue};

use super::Gpu;

/// One device for all tests of the binary: opening one costs more than most tests.
pub fn gpu() -> Gpu {
    static GPU: std::sync::OnceLock<Gpu> = std::sync::OnceLock::new();
    GPU.get_or_init(|| Gpu::headless().unwrap()).clone()
}

fn parse(source: &str) -> naga::Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)))
}

/// Layout of a global variable's type.
pub fn layout_of(source: &str, global: &str) -> Layout {
    let module = parse(source);
    let (_, var) = module
        .global_variables
        .iter()
        .find(|(_, v)| v.name.as_deref() == Some(global))
        .unwrap();
    layout(&module, var.ty)
}

fn scalar(s: naga::Scalar) -> &'static str {
    match s.kind {
        ScalarKind::Float => "f32",
        ScalarKind::Uint => "u32",
        ScalarKind::Sint => "i32",
        _ => "bool",
    }
}

fn ty_name(module: &naga::Module, ty: naga::Handle<naga::Type>) -> String {
    match &module.types[ty].inner {
        TypeInner::Scalar(s) => scalar(*s).into(),
        TypeInner::Vector { size, scalar: s } => format!("vec{}<{}>", *size as u8, scalar(*s)),
        TypeInner::Matrix { columns, rows, scalar: s } => format!("mat{}x{}<{}>", *columns as u8, *rows as u8, scalar(*s)),
        TypeInner::Array { base, .. } => format!("array<{}>", ty_name(module, *base)),
        _ => module.types[ty].name.clone().unwrap_or_default(),
    }
}

fn layout(module: &naga::Module, ty: naga::Handle<naga::Type>) -> Layout {
    let mut layouter = naga::proc::Layouter::default();
    layouter.update(module.to_ctx()).unwrap();
    let mut result = Layout {
        ty: ty_name(module, ty),
        size: layouter[ty].size,
        align: (layouter[ty].alignment * 1u32) as u32,
        members: vec![],
        element: None,
        stride: None,
        count: None,
    };
    match &module.types[ty].inner {
        TypeInner::Struct { members, .. } => {
            result.members = members
                .iter()
                .map(|m| Member {
                    name: m.name.clone().unwrap(),
                    offset: m.offset,
                    layout: layout(module, m.ty),
                })
                .collect();
        }
        TypeInner::Array { base, size, stride } => {
            result.element = Some(Box::new(layout(module, *base)));
            result.stride = Some(*stride);
            match size {
                ArraySize::Constant(n) => result.count = Some(n.get()),
                _ => result.size = 0,
            }
        }
        _ => {}
    }
    result
}

fn stage_values(module: &naga::Module, ty: naga::Handle<naga::Type>, binding: Option<&naga::Binding>, name: &str) -> Vec<StageValue> {
    if let TypeInner::Struct { members, .. } = &module.types[ty].inner {
        return members
            .iter()
            .flat_map(|m| stage_values(module, m.ty, m.binding.as_ref(), m.name.as_deref().unwrap_or_default()))
            .collect();
    }
    match binding {
        Some(naga::Binding::Location { location, .. }) => vec![StageValue {
            location: *location,
            name: name.into(),
            ty: ty_name(module, ty),
        }],
        _ => vec![],
    }
}

/// A validated program of this text. `fill` says what the host puts into a binding, by the variable's name;
/// what it does not say is a host resource of that name.
pub fn program(source: &str, fill: impl Fn(&str) -> Option<Fill>) -> Program {
    let module = parse(source);
    let stages: Vec<Stage> = module.entry_points.iter().map(|e| stage(e.stage)).collect();
    let bindings = module
        .global_variables
        .iter()
        .filter_map(|(_, var)| {
            let at = var.binding?;
            let name = var.name.clone().unwrap();
            let ty = match (&module.types[var.ty].inner, var.space) {
                (_, naga::AddressSpace::Uniform) => BindingType::Uniform {
                    layout: layout(&module, var.ty),
                },
                (_, naga::AddressSpace::Storage { access }) => BindingType::Storage {
                    read_only: !access.contains(naga::StorageAccess::STORE),
                    layout: layout(&module, var.ty),
                },
                (TypeInner::Image { dim, arrayed, class }, _) => BindingType::Texture {
                    dimension: match (dim, arrayed) {
                        (naga::ImageDimension::Cube, true) => "cube_array",
                        (naga::ImageDimension::D2, true) => "2d_array",
                        (naga::ImageDimension::Cube, false) => "cube",
                        _ => "2d",
                    }
                    .into(),
                    sample: match class {
                        naga::ImageClass::Depth { .. } => "depth",
                        _ if name.starts_with("loaded") || name == "hdr" => "unfilterable_float",
                        _ => "float",
                    }
                    .into(),
                    multisampled: false,
                },
                (TypeInner::Sampler { comparison }, _) => BindingType::Sampler { comparison: *comparison },
                other => panic!("{other:?}"),
            };
            Some(Binding {
                group: at.group,
                binding: at.binding,
                stages: stages.clone(),
                ty,
                fill: fill(&name).unwrap_or_else(|| Fill::Resource {
                    instance: None,
                    resource: name.clone(),
                    declared: ResourceKind::Host(name.clone()),
                }),
                name,
            })
        })
        .collect();
    let entry_points = module
        .entry_points
        .iter()
        .map(|e| EntryPoint {
            name: e.name.clone(),
            stage: stage(e.stage),
            workgroup_size: (e.stage == naga::ShaderStage::Compute).then_some(e.workgroup_size),
            inputs: e
                .function
                .arguments
                .iter()
                .flat_map(|a| stage_values(&module, a.ty, a.binding.as_ref(), a.name.as_deref().unwrap_or_default()))
                .collect(),
            outputs: e
                .function
                .result
                .iter()
                .flat_map(|r| stage_values(&module, r.ty, r.binding.as_ref(), ""))
                .collect(),
        })
        .collect();
    let hash = source
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325u128, |h, b| (h ^ u128::from(b)).wrapping_mul(0x0100_0000_01b3));
    let reflection = Reflection {
        version: 1,
        hash: format!("{hash:032x}"),
        pass: "main".into(),
        entry_points,
        bindings,
        overrides: vec![],
        params: vec![],
        functions: vec![],
        instances: vec![],
        capabilities: vec![],
        passes: vec![],
    };
    Program::from_parts(Validated::of(module).unwrap(), reflection, hash, source.into())
}

fn stage(stage: naga::ShaderStage) -> Stage {
    match stage {
        naga::ShaderStage::Vertex => Stage::Vertex,
        naga::ShaderStage::Fragment => Stage::Fragment,
        _ => Stage::Compute,
    }
}
