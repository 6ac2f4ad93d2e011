//! The lines of the tables, from what reflection says.

use shadewright_compiler::Reflection;
use shadewright_compiler::manifest::ResourceKind;
use shadewright_compiler::reflect::{Binding, BindingType, Fill, Layout, ParamPlace, Stage};
use shadewright_evaluate::cost::Analysis;

use crate::document::ron_of;

/// A line of a table.
#[derive(Debug, Default)]
pub struct Line {
    /// What stands in its columns.
    pub cells: Vec<String>,
    /// The column that is clicked.
    pub name: usize,
    /// Name of the instance that a click selects.
    pub instance: Option<String>,
    /// More of it.
    pub hover: String,
    /// It tells more of a line above.
    pub is_part: bool,
}

/// Columns, with their first widths.
pub const RESOURCES: &[(&str, f32)] = &[
    ("group", 44.0),
    ("binding", 52.0),
    ("name", 190.0),
    ("stages", 110.0),
    ("type", 230.0),
    ("bytes", 70.0),
    ("filled by", 170.0),
    ("module", 130.0),
];
/// As above.
pub const PARAMETERS: &[(&str, f32)] = &[
    ("parameter", 170.0),
    ("instance", 170.0),
    ("type", 70.0),
    ("unit", 60.0),
    ("where", 280.0),
    ("default", 110.0),
];
/// As above.
pub const STAGES: &[(&str, f32)] = &[
    ("entry point", 170.0),
    ("stage", 80.0),
    ("location", 60.0),
    ("name", 170.0),
    ("type", 120.0),
];
/// As above.
pub const COST: &[(&str, f32)] = &[
    ("entry point", 150.0),
    ("weighted", 66.0),
    ("add", 44.0),
    ("multiply", 56.0),
    ("divide", 48.0),
    ("root", 40.0),
    ("transcendental", 96.0),
    ("select", 50.0),
    ("integer", 54.0),
    ("textures", 60.0),
    ("branches", 62.0),
    ("loops", 44.0),
    ("with all trips", 90.0),
];

/// Bound resources, members of structs below them.
pub fn resources(reflection: &Reflection) -> Vec<Line> {
    let mut lines = Vec::new();
    for binding in &reflection.bindings {
        let (instance, filled) = filled(binding);
        let module = instance
            .as_ref()
            .and_then(|name| reflection.instances.iter().find(|i| i.name == *name));
        let module = module.map(|instance| instance.module.clone()).unwrap_or_default();
        let stages: Vec<&str> = binding.stages.iter().copied().map(stage).collect();
        let (ty, bytes, layout) = of_type(&binding.ty);
        lines.push(Line {
            cells: vec![
                binding.group.to_string(),
                binding.binding.to_string(),
                binding.name.clone(),
                stages.join(", "),
                ty,
                bytes,
                filled,
                module,
            ],
            name: 2,
            hover: binding.doc.clone(),
            instance,
            is_part: false,
        });
        if let Some(layout) = layout {
            members(layout, 0, 1, &mut lines);
        }
        if binding.fill == Fill::Params {
            of_params(reflection, binding, &mut lines);
        }
    }
    lines
}

/// The members of a block belong to instances: a click on one leads there.
fn of_params(reflection: &Reflection, binding: &Binding, lines: &mut [Line]) {
    for param in &reflection.params {
        if let ParamPlace::Uniform {
            group,
            binding: of,
            offset,
            ..
        } = param.place
            && (group, of) == (binding.group, binding.binding)
            && let Some(line) = lines
                .iter_mut()
                .rev()
                .find(|line| line.is_part && line.cells[1] == format!("+{offset}"))
        {
            line.instance = Some(param.instance.clone());
            line.cells[7].clone_from(&param.module);
            line.hover.clone_from(&param.declared.doc);
        }
    }
}

fn members(layout: &Layout, start: u32, depth: usize, lines: &mut Vec<Line>) {
    let of = layout.element.as_deref().unwrap_or(layout);
    for member in &of.members {
        let at = start + member.offset;
        lines.push(Line {
            cells: vec![
                String::new(),
                format!("+{at}"),
                format!("{}{}", "    ".repeat(depth), member.name),
                String::new(),
                member.layout.ty.clone(),
                member.layout.size.to_string(),
                String::new(),
                String::new(),
            ],
            name: 2,
            is_part: true,
            ..Line::default()
        });
        if !member.layout.members.is_empty() || member.layout.element.as_ref().is_some_and(|e| !e.members.is_empty()) {
            members(&member.layout, at, depth + 1, lines);
        }
    }
}

fn stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vertex",
        Stage::Fragment => "fragment",
        Stage::Compute => "compute",
    }
}

fn of_type(ty: &BindingType) -> (String, String, Option<&Layout>) {
    let sized = |layout: &Layout| match (&layout.element, layout.count, layout.stride) {
        (Some(_), None, Some(stride)) => format!("n x {stride}"),
        _ => layout.size.to_string(),
    };
    match ty {
        BindingType::Uniform { layout } => (format!("uniform {}", layout.ty), sized(layout), Some(layout)),
        BindingType::Storage { read_only, layout } => {
            let access = if *read_only { "read" } else { "read_write" };
            (format!("storage {access} {}", layout.ty), sized(layout), Some(layout))
        }
        BindingType::Texture {
            dimension,
            sample,
            multisampled,
        } => {
            let many = if *multisampled { " multisampled" } else { "" };
            (format!("texture {dimension} {sample}{many}"), String::new(), None)
        }
        BindingType::StorageTexture { dimension, format, access } => {
            (format!("storage texture {dimension} {format} {access}"), String::new(), None)
        }
        BindingType::Sampler { comparison } => {
            let kind = if *comparison { "comparison sampler" } else { "sampler" };
            (kind.to_owned(), String::new(), None)
        }
    }
}

/// The instance that it belongs to, and what the host puts there.
fn filled(binding: &Binding) -> (Option<String>, String) {
    match &binding.fill {
        Fill::Params => (None, "parameters".to_owned()),
        Fill::Instances { instance } => (Some(instance.clone()), "instances".to_owned()),
        Fill::Resource {
            instance,
            resource,
            declared,
        } => {
            let what = match declared {
                ResourceKind::Host(name) => format!("host: {name}"),
                ResourceKind::Texture { srgb } => format!("texture of the scene{}", if *srgb { ", sRGB" } else { "" }),
                ResourceKind::Sampler { .. } => "sampler".to_owned(),
                ResourceKind::Depth { pass } => format!("depth of {pass}"),
                ResourceKind::Views { pass } => format!("views of {pass}"),
                ResourceKind::Buffer { bytes } => format!("zeros, {bytes} bytes"),
                ResourceKind::Data { file, .. } => format!("data {}", file.as_deref().unwrap_or(resource)),
            };
            (instance.clone(), what)
        }
    }
}

/// Parameters that reached the shader.
pub fn parameters(reflection: &Reflection) -> Vec<Line> {
    let line = |param: &shadewright_compiler::reflect::ParamUse| {
        let place = match &param.place {
            ParamPlace::Uniform {
                group,
                binding,
                offset,
                member,
            } => format!("group {group}, binding {binding}, +{offset} ({member})"),
            ParamPlace::Override { name } => format!("override {name}"),
            ParamPlace::Constant { value } => format!("constant {}", ron_of(value)),
        };
        Line {
            cells: vec![
                param.name.clone(),
                param.instance.clone(),
                format!("{:?}", param.ty),
                param.declared.unit.clone(),
                place,
                ron_of(&param.declared.default),
            ],
            instance: Some(param.instance.clone()),
            hover: param.declared.doc.clone(),
            ..Line::default()
        }
    };
    reflection.params.iter().map(line).collect()
}

/// Entry points, and what they read and write.
pub fn stages(reflection: &Reflection) -> Vec<Line> {
    let mut lines = Vec::new();
    for entry in &reflection.entry_points {
        let group = entry
            .workgroup_size
            .map_or_else(String::new, |[x, y, z]| format!("workgroup {x} x {y} x {z}"));
        lines.push(Line {
            cells: vec![
                entry.name.clone(),
                stage(entry.stage).to_owned(),
                String::new(),
                group,
                String::new(),
            ],
            ..Line::default()
        });
        for (what, values) in [("in", &entry.inputs), ("out", &entry.outputs)] {
            for value in values {
                lines.push(Line {
                    cells: vec![
                        String::new(),
                        what.to_owned(),
                        value.location.to_string(),
                        value.name.clone(),
                        value.ty.clone(),
                    ],
                    is_part: true,
                    ..Line::default()
                });
            }
        }
    }
    lines
}

/// What the entry points hold, counted in their IR; loops below them.
pub fn cost(costs: &[(String, Analysis)]) -> Vec<Line> {
    let mut lines = Vec::new();
    for (name, analysis) in costs {
        let cost = &analysis.cost;
        let counts = [
            cost.add,
            cost.multiply,
            cost.divide,
            cost.root,
            cost.transcendental,
            cost.select,
            cost.integer,
            cost.texture,
            cost.branches,
            cost.loops,
        ];
        let mut cells = vec![name.clone(), format!("{:.0}", cost.weighted())];
        cells.extend(counts.iter().map(u32::to_string));
        cells.push(format!("{:.0}", analysis.unrolled.weighted()));
        lines.push(Line { cells, ..Line::default() });
        for found in &analysis.loops {
            let trips = match (found.trips, found.leaves) {
                (Some(trips), false) => format!("{trips} trips"),
                (Some(trips), true) => format!("at most {trips} trips"),
                (None, _) => "trips depend on the input".to_owned(),
            };
            let mut cells = vec![format!("    loop in {}: {trips}", found.function)];
            cells.resize(COST.len(), String::new());
            lines.push(Line {
                cells,
                is_part: true,
                ..Line::default()
            });
        }
    }
    lines
}
