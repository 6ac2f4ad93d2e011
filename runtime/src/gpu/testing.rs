//! Programs from WGSL text for the unit tests of this crate, reflected without linking.

use indexmap::IndexMap;
use shadewright_compiler::manifest::{Param, ParamMode, ParamType, ResourceKind, Value};
use shadewright_compiler::program::Program;
use shadewright_compiler::reflect::{Binding, Fill, Layout, Layouts, Reflection, binding_type, entry_point, stages_using};
use shadewright_compiler::validate::validate;

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
    Layouts::new(&module).unwrap().of(var.ty)
}

/// A validated program of this text. `fill` says what the host puts into a binding, by the variable's name;
/// what it does not say is a host resource of that name.
pub fn program(source: &str, fill: impl Fn(&str) -> Option<Fill>) -> Program {
    let validated = validate(parse(source)).unwrap();
    let (module, info) = (validated.module(), validated.info());
    let layouts = Layouts::new(module).unwrap();
    let binding = |(handle, var): (_, &naga::GlobalVariable)| {
        let at = var.binding?;
        let name = var.name.clone().unwrap();
        Some(Binding {
            group: at.group,
            binding: at.binding,
            stages: stages_using(module, info, handle),
            ty: binding_type(module, info, &layouts, handle).unwrap(),
            fill: fill(&name).unwrap_or_else(|| Fill::Resource {
                instance: None,
                resource: name.clone(),
                declared: ResourceKind::Host(name.clone()),
            }),
            name,
        })
    };
    let hash = source
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325u128, |h, b| (h ^ u128::from(b)).wrapping_mul(0x0100_0000_01b3));
    let reflection = Reflection {
        version: 1,
        hash: format!("{hash:032x}"),
        pass: "main".into(),
        entry_points: module.entry_points.iter().filter_map(|e| entry_point(module, e)).collect(),
        bindings: module.global_variables.iter().filter_map(binding).collect(),
        overrides: vec![],
        params: vec![],
        functions: vec![],
        instances: vec![],
        capabilities: vec![],
        passes: vec![],
    };
    Program::from_parts(validated, reflection, hash, source.into())
}

/// A scalar parameter without a unit.
pub fn param(default: Value) -> Param {
    Param {
        ty: ParamType::F32,
        unit: "1".into(),
        also: IndexMap::new(),
        default,
        range: None,
        doc: String::new(),
        mode: ParamMode::Uniform,
        role: None,
    }
}
