//! Structs for what lies in buffers, byte for byte.

use std::collections::{HashMap, HashSet};

use super::docs::{Docs, escape};
use super::expr::{Expr, put};
use super::names::{Names, rust, unique};
use super::text::Text;
use super::{Pass, unsupported};
use crate::diagnostics::Report;
use crate::manifest::{Param, Typed, typed};
use crate::reflect::{Binding, BindingType, Fill, Layout, ParamPlace, Reflection, Stage, StageValue};

/// A type as Rust has it.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The type.
    pub ty: String,
    /// Its size in bytes.
    pub size: u32,
    /// What a reader must know of it.
    pub note: Option<&'static str>,
}

const COLUMNS_OF_THREE: &str = "By columns; the fourth number of each is padding.";
const COLUMNS: &str = "By columns.";
const THREES: &str = "The fourth number of each element is padding.";
const HALF: &str = "Bits of 16-bit floats.";

/// What a struct is that has nothing but a runtime-sized array; any other layout as it is.
pub fn unwrapped(layout: &Layout) -> &Layout {
    match &layout.members[..] {
        [only] if only.layout.element.is_some() && only.layout.count.is_none() => &only.layout,
        _ => layout,
    }
}

/// The type of a value in a buffer; of a runtime-sized array that of its element. `None` for what Rust has no type for.
pub fn shape(layout: &Layout, names: &Names) -> Option<Shape> {
    let layout = unwrapped(layout);
    if !layout.members.is_empty() {
        return Some(Shape {
            ty: names.of_struct(&layout.ty),
            size: layout.size,
            note: None,
        });
    }
    if let (Some(element), Some(stride)) = (&layout.element, layout.stride) {
        let mut element = element_shape(element, stride, names)?;
        if let Some(count) = layout.count {
            element.ty = format!("[{}; {count}]", element.ty);
            element.size *= count;
        }
        return Some(element);
    }
    plain(&layout.ty)
}

/// An element of an array with this stride.
fn element_shape(element: &Layout, stride: u32, names: &Names) -> Option<Shape> {
    let shape = shape(element, names)?;
    if shape.size == stride {
        return Some(shape);
    }
    let scalar = element.ty.strip_prefix("vec3<")?.strip_suffix('>')?;
    let (ty, width) = scalar_type(scalar)?;
    (stride == 4 * width).then(|| Shape {
        ty: format!("[{ty}; 4]"),
        size: stride,
        note: Some(THREES),
    })
}

fn scalar_type(name: &str) -> Option<(&'static str, u32)> {
    Some(match name {
        "f32" => ("f32", 4),
        "i32" => ("i32", 4),
        "u32" => ("u32", 4),
        "f16" => ("u16", 2),
        _ => return None,
    })
}

/// Scalars, vectors and matrices.
fn plain(name: &str) -> Option<Shape> {
    let half = name.contains("f16").then_some(HALF);
    let inner = |prefix: &str| name.strip_prefix(prefix)?.strip_suffix('>');
    if let Some((ty, size)) = scalar_type(inner("atomic<").unwrap_or(name)) {
        let ty = ty.to_owned();
        return Some(Shape { ty, size, note: half });
    }
    for count in 2..=4 {
        if let Some(scalar) = inner(&format!("vec{count}<")) {
            let (ty, width) = scalar_type(scalar)?;
            return Some(Shape {
                ty: format!("[{ty}; {count}]"),
                size: count * width,
                note: half,
            });
        }
        for rows in 2..=4 {
            if let Some(scalar) = inner(&format!("mat{count}x{rows}<")) {
                let (ty, width) = scalar_type(scalar)?;
                // Columns of three numbers are as far apart as those of four.
                let stride = if rows == 3 { 4 } else { rows };
                return Some(Shape {
                    ty: format!("[[{ty}; {stride}]; {count}]"),
                    size: count * stride * width,
                    note: Some(if rows == 3 { COLUMNS_OF_THREE } else { COLUMNS }),
                });
            }
        }
    }
    None
}

/// What a manifest says of a member.
struct Declared<'r> {
    param: &'r Param,
    /// Of which module it is, for people.
    owner: String,
}

/// Writes all structs of a pass.
pub fn write(text: &mut Text, pass: &Pass, names: &Names, docs: &Docs) -> Result<(), Report> {
    let mut written = HashSet::new();
    for binding in &pass.reflection.bindings {
        if let BindingType::Uniform { layout } | BindingType::Storage { layout, .. } = &binding.ty {
            let declared = declared(pass.reflection, binding);
            buffer(text, pass, names, docs, layout, &declared, &mut written)?;
        }
    }
    for entry in pass.reflection.entry_points.iter().filter(|e| e.stage == Stage::Vertex).take(1) {
        if !entry.inputs.is_empty() {
            vertex_input(text, pass, docs, &entry.name, &entry.inputs)?;
        }
    }
    Ok(())
}

fn buffer(
    text: &mut Text,
    pass: &Pass,
    names: &Names,
    docs: &Docs,
    layout: &Layout,
    declared: &HashMap<&str, Declared>,
    written: &mut HashSet<String>,
) -> Result<(), Report> {
    let layout = unwrapped(layout);
    if let Some(element) = &layout.element {
        buffer(text, pass, names, docs, element, declared, written)?;
    }
    if layout.members.is_empty() || !written.insert(layout.ty.clone()) {
        return Ok(());
    }
    for member in &layout.members {
        buffer(text, pass, names, docs, &member.layout, &HashMap::new(), written)?;
    }
    let mut fields = Vec::new();
    let mut tail = None;
    for member in &layout.members {
        let shape = shape(&member.layout, names);
        let shape = shape.ok_or_else(|| unsupported(pass, &format!("`{}: {}` in a buffer", member.name, member.layout.ty)))?;
        if member.layout.element.is_some() && member.layout.count.is_none() {
            tail = Some((member.name.as_str(), shape));
            continue;
        }
        let mut doc = match declared.get(member.name.as_str()) {
            Some(declared) => describe(declared),
            None => docs.of_member(&layout.ty, &member.name).to_owned(),
        };
        if doc.is_empty() {
            doc = format!("`{}: {}`", member.name, member.layout.ty);
        }
        let default = declared
            .get(member.name.as_str())
            .and_then(|d| typed(d.param, &d.param.default).ok())
            .map(literal);
        fields.push(Field {
            name: member.name.clone(),
            offset: member.offset,
            shape,
            doc,
            default,
        });
    }
    let doc = match docs.of_struct(&layout.ty) {
        "" => format!("`{}` as it lies in a buffer.", layout.ty),
        doc => doc.to_owned(),
    };
    let name = names.of_struct(&layout.ty);
    // Only before a tail can a size be none of a struct's: behind 16-bit numbers.
    if tail.is_some() && !layout.size.is_multiple_of(4) {
        let what = format!("a fixed part of {} bytes in `{}`", layout.size, layout.ty);
        return Err(unsupported(pass, &what));
    }
    structure(text, &name, &doc, &fields, layout.size);
    if let Some((member, element)) = tail {
        with_tail(text, &name, &rust(member), &element, layout);
    }
    Ok(())
}

/// A field that is no padding.
struct Field {
    name: String,
    offset: u32,
    shape: Shape,
    doc: String,
    default: Option<Expr>,
}

/// Writes a struct, its default, and what proves its layout.
fn structure(text: &mut Text, name: &str, doc: &str, fields: &[Field], size: u32) {
    let mut used: HashSet<String> = fields.iter().map(|field| field.name.clone()).collect();
    let mut at = 0;
    let (mut values, mut places) = (Vec::new(), Vec::new());
    text.blank();
    text.doc(doc);
    text.line("#[repr(C)]");
    text.line("#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]");
    text.open(&format!("pub struct {name} {{"));
    let mut pad = |text: &mut Text, at: u32, to: u32, values: &mut Vec<(String, Expr)>| {
        if to > at {
            let name = unique(format!("pad_{at}"), &mut used);
            text.doc("Padding, whatever it holds.");
            text.line(&format!("pub {name}: [u8; {}],", to - at));
            values.push((name, Expr::atom(format!("[0; {}]", to - at))));
        }
    };
    for field in fields {
        pad(text, at, field.offset, &mut values);
        text.doc(&field.doc);
        if let Some(note) = field.shape.note {
            text.doc(&format!("\n{note}"));
        }
        let rust = rust(&field.name);
        text.field(&rust, &field.shape.ty);
        at = field.offset + field.shape.size;
        let zero = || Expr::atom("bytemuck::Zeroable::zeroed()");
        values.push((rust.clone(), field.default.clone().unwrap_or_else(zero)));
        places.push((rust, field.offset));
    }
    pad(text, at, size, &mut values);
    text.close("}");
    text.blank();
    text.open(&format!("impl Default for {name} {{"));
    if fields.iter().any(|field| field.default.is_some()) {
        text.doc("The modules' defaults; 0 where they have none.");
        text.open("fn default() -> Self {");
        put(text, "", &Expr::Struct("Self".to_owned(), values), "");
    } else {
        text.doc("Zeros.");
        text.open("fn default() -> Self {");
        text.line("bytemuck::Zeroable::zeroed()");
    }
    text.close("}");
    text.close("}");
    text.blank();
    text.open("const _: () = {");
    let check = |text: &mut Text, what: String| put(text, "", &Expr::call("assert!", Expr::Atom(what)), ";");
    check(text, format!("core::mem::size_of::<{name}>() == {size}"));
    for (member, offset) in places {
        check(text, format!("core::mem::offset_of!({name}, {member}) == {offset}"));
    }
    text.close("};");
}

/// Writes what makes a buffer of a fixed part and the elements behind it.
fn with_tail(text: &mut Text, name: &str, member: &str, element: &Shape, layout: &Layout) {
    text.blank();
    text.open(&format!("impl {name} {{"));
    let note = element.note.map(|note| format!(" {note}")).unwrap_or_default();
    text.doc(&format!(
        "Contents of a buffer: this, and the elements of `{member}` behind it.{note}"
    ));
    text.doc("\nNever shorter than a binding may be: without elements the shader sees one of zeros.");
    text.function("bytes", &["&self", &format!("{member}: &[{}]", element.ty)], "Vec<u8>");
    text.line("let mut bytes = bytemuck::bytes_of(self).to_vec();");
    text.line(&format!("bytes.extend_from_slice(bytemuck::cast_slice({member}));"));
    text.line(&format!("bytes.resize(bytes.len().max({}), 0);", layout.smallest_size()));
    text.line("bytes");
    text.close("}");
    text.close("}");
}

/// Members of a binding's struct that manifests declare, by name.
fn declared<'r>(reflection: &'r Reflection, binding: &Binding) -> HashMap<&'r str, Declared<'r>> {
    let place = |name: &str| {
        let instance = reflection.instances.iter().find(|instance| instance.name == name);
        let path = instance.and_then(|instance| instance.paths.first()).map_or("", String::as_str);
        let module = instance.map_or(String::new(), |i| {
            if i.category.is_empty() {
                i.module.clone()
            } else {
                format!("{}/{}", i.category, i.module)
            }
        });
        format!("`{module}` at `{path}`")
    };
    match &binding.fill {
        Fill::Params => {
            let here = reflection.params.iter().filter_map(|param| match &param.place {
                ParamPlace::Uniform {
                    group,
                    binding: at,
                    member,
                    ..
                } if (*group, *at) == (binding.group, binding.binding) => Some((
                    member.as_str(),
                    Declared {
                        param: &param.declared,
                        owner: format!("`{}` of {}", param.name, place(&param.instance)),
                    },
                )),
                _ => None,
            });
            here.collect()
        }
        Fill::Instances { instance } => {
            let found = reflection.instances.iter().find(|i| i.name == *instance);
            let fields = found.into_iter().flat_map(|i| &i.fields);
            fields
                .map(|(name, param)| {
                    let owner = format!("`{name}` of each thing of {}", place(instance));
                    (name.as_str(), Declared { param, owner })
                })
                .collect()
        }
        Fill::Resource { .. } => HashMap::new(),
    }
}

/// A number for people: `1`, `0.5`, `1e-30`.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

/// A parameter in words: what it is, unit, range, and whose.
pub fn describe_param(param: &Param, owner: &str) -> String {
    let mut out = escape(param.doc.trim());
    if !out.is_empty() {
        out.push_str(".\n\n");
    }
    let mut facts = Vec::new();
    if !matches!(param.unit.as_str(), "" | "1") {
        facts.push(format!("in {}", escape(&param.unit)));
    }
    if let Some((low, high)) = param.range {
        facts.push(format!("from {} to {}", number(low), number(high)));
    }
    let facts = facts.join(", ");
    out.push_str(&if facts.is_empty() {
        format!("This is {owner}.")
    } else {
        format!("This is {owner}, {facts}.")
    });
    out
}

fn describe(declared: &Declared) -> String {
    describe_param(declared.param, &declared.owner)
}

/// A constant in Rust.
fn literal(value: Typed) -> Expr {
    let list = |numbers: &[f32]| Expr::Array(numbers.iter().map(|number| Expr::atom(format!("{number:?}"))).collect());
    match value {
        Typed::F32(number) => Expr::atom(format!("{number:?}")),
        Typed::U32(number) => Expr::atom(number.to_string()),
        Typed::I32(number) => Expr::atom(number.to_string()),
        Typed::Bool(truth) => Expr::atom(truth.to_string()),
        Typed::Vec2(numbers) => list(&numbers),
        Typed::Vec3(numbers) => list(&numbers),
        Typed::Vec4(numbers) => list(&numbers),
    }
}

/// The vertex format of a WGSL type, with its size in bytes.
fn vertex_format(ty: &str) -> Option<(String, u32)> {
    let (scalar, count) = match ty.strip_prefix("vec") {
        Some(rest) => {
            let (count, scalar) = rest.split_once('<')?;
            (scalar.strip_suffix('>')?, count.parse::<u32>().ok()?)
        }
        None => (ty, 1),
    };
    let (name, width) = match scalar {
        "f32" => ("Float32", 4),
        "i32" => ("Sint32", 4),
        "u32" => ("Uint32", 4),
        "f16" if count != 3 => ("Float16", 2),
        _ => return None,
    };
    let name = if count == 1 { name.to_owned() } else { format!("{name}x{count}") };
    Some((name, width * count))
}

/// Writes the struct of a vertex, and its layout.
fn vertex_input(text: &mut Text, pass: &Pass, docs: &Docs, entry: &str, inputs: &[StageValue]) -> Result<(), Report> {
    let mut at: u32 = 0;
    let (mut fields, mut attributes) = (Vec::new(), Vec::new());
    for input in inputs {
        let known = vertex_format(&input.ty).zip(plain(&input.ty));
        let ((format, size), shape) =
            known.ok_or_else(|| unsupported(pass, &format!("the vertex input `{}: {}`", input.name, input.ty)))?;
        at = at.next_multiple_of(4);
        let comment = docs.of_input(entry, &input.name);
        let doc = if comment.is_empty() {
            format!("Location {}.", input.location)
        } else {
            format!("{comment}\n\nLocation {}.", input.location)
        };
        attributes.push(Expr::Struct(
            "wgpu::VertexAttribute".to_owned(),
            vec![
                ("format".to_owned(), Expr::atom(format!("wgpu::VertexFormat::{format}"))),
                ("offset".to_owned(), Expr::atom(at.to_string())),
                ("shader_location".to_owned(), Expr::atom(input.location.to_string())),
            ],
        ));
        fields.push(Field {
            name: input.name.clone(),
            offset: at,
            shape,
            doc,
            default: None,
        });
        at += size;
    }
    let size = at.next_multiple_of(4);
    let doc = "A vertex with everything that the vertex stage reads, for a host that keeps it together.";
    structure(text, "VertexInput", doc, &fields, size);
    text.blank();
    text.open("impl VertexInput {");
    text.doc("What the locations hold, and where.");
    let ty = format!("[wgpu::VertexAttribute; {}]", attributes.len());
    super::expr::constant(text, "ATTRIBUTES", &ty, &Expr::Array(attributes));
    text.blank();
    text.doc("Layout of a buffer of these.");
    let layout = Expr::Struct(
        "wgpu::VertexBufferLayout".to_owned(),
        vec![
            ("array_stride".to_owned(), Expr::atom(size.to_string())),
            ("step_mode".to_owned(), Expr::atom("wgpu::VertexStepMode::Vertex")),
            ("attributes".to_owned(), Expr::atom("&Self::ATTRIBUTES")),
        ],
    );
    super::expr::constant(text, "LAYOUT", "wgpu::VertexBufferLayout<'static>", &layout);
    text.close("}");
    Ok(())
}
