//! Files of numbers that fill read-only storage buffers: resources of kind `Data`.
//!
//! A module's own table is a file of little-endian 32-bit floats in its folder, read with the manifest and held against the WGSL's type. What
//! a recipe names for a module is not read here: [`Program::data`] says which file it is, and points there when the reader finds it wrong.

use std::sync::Arc;

use crate::diagnostics::{Diagnostic, codes};
use crate::manifest::ResourceKind;
use crate::program::Program;
use crate::reflect::{Binding, BindingType, Fill, Layout};
use crate::resolve::Place;

/// The numbers of a file of little-endian 32-bit floats.
///
/// # Errors
/// Says what is wrong: no numbers, a number cut off, or one that is not finite.
pub fn numbers(bytes: &[u8]) -> Result<Vec<f32>, String> {
    let (whole, rest) = bytes.as_chunks::<4>();
    if !rest.is_empty() {
        return Err(format!("{} bytes are no whole number of 32-bit floats", bytes.len()));
    }
    let numbers: Vec<f32> = whole.iter().map(|word| f32::from_le_bytes(*word)).collect();
    finite(&numbers)?;
    Ok(numbers)
}

/// Whether these are numbers at all.
///
/// # Errors
/// There are none, or one of them is infinite or not a number.
pub fn finite(numbers: &[f32]) -> Result<(), String> {
    if numbers.is_empty() {
        return Err("it holds no number".to_owned());
    }
    match numbers.iter().position(|number| !number.is_finite()) {
        Some(index) => Err(format!("number {index} is {}", numbers[index])),
        None => Ok(()),
    }
}

/// Numbers of one element of an array without gaps between its 32-bit floats, and how many elements the type says that it has; `None`
/// for anything else.
pub fn shape(layout: &Layout) -> Option<(u32, Option<u32>)> {
    let width = width(layout.element.as_deref()?)?;
    (layout.stride == width.checked_mul(4)).then_some((width, layout.count))
}

fn width(layout: &Layout) -> Option<u32> {
    if let Some((width, count)) = shape(layout) {
        return width.checked_mul(count?);
    }
    match layout.ty.as_str() {
        "f32" => Some(1),
        "vec2<f32>" => Some(2),
        "vec4<f32>" => Some(4),
        _ => None,
    }
}

/// Whether so many numbers fill a buffer of this layout.
///
/// # Errors
/// Says how many it takes.
pub fn fits(layout: &Layout, count: usize) -> Result<(), String> {
    match shape(layout) {
        None => Err(format!("`{}` is no array of 32-bit floats", layout.ty)),
        Some((width, Some(elements))) if u64::from(width) * u64::from(elements) != count as u64 => Err(format!(
            "{count} numbers, but `{}` takes {}",
            layout.ty,
            u64::from(width) * u64::from(elements)
        )),
        Some((width, None)) if !count.is_multiple_of(width.max(1) as usize) => {
            Err(format!("{count} numbers, but an element of `{}` takes {width}", layout.ty))
        }
        Some(_) => Ok(()),
    }
}

/// Where the numbers of a binding come from.
#[derive(Clone, Debug)]
pub enum Origin<'p> {
    /// A file in the module's folder.
    Module {
        /// Its path in the library.
        path: String,
        /// What it holds.
        bytes: &'p Arc<[u8]>,
    },
    /// A file that the recipe names, by a path of the recipe's author.
    Recipe(&'p str),
    /// The recipe must name a file, and does not.
    Nobody,
}

/// What a binding of kind `Data` is filled with.
#[derive(Clone, Debug)]
pub struct Data<'p> {
    /// How bytes become numbers; `None` where they are little-endian 32-bit floats.
    pub format: Option<&'p str>,
    /// Where the bytes are.
    pub origin: Origin<'p>,
    /// `instance.resource`
    pub name: String,
    /// Layout of the buffer.
    pub layout: &'p Layout,
    place: Place,
}

impl Data<'_> {
    /// An error about the file, at the place that names it.
    pub fn wrong(&self, code: &'static str, message: impl Into<String>, label: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, message).at(&self.place.file, self.place.span(), label)
    }

    /// The error about a file that nobody names.
    pub fn unnamed(&self) -> Diagnostic {
        let resource = self.name.rsplit('.').next().unwrap_or_default();
        let format = self.format.unwrap_or_default();
        self.wrong(
            codes::MISSING_FILE,
            format!("`{}` needs a file of the format `{format}`", self.name),
            "none is named here",
        )
        .note(format!("name one: `files: {{\"{resource}\": \"PATH\"}}`"))
    }
}

impl Program {
    /// What fills a binding of kind `Data`; `None` for any other.
    pub fn data<'p>(&'p self, binding: &'p Binding) -> Option<Data<'p>> {
        let Fill::Resource {
            instance: Some(instance),
            resource,
            declared: ResourceKind::Data { file, format },
        } = &binding.fill
        else {
            return None;
        };
        let BindingType::Storage { layout, .. } = &binding.ty else {
            return None;
        };
        let (tree, node) = self.node_of(instance)?;
        let at = &tree.nodes[node];
        let path = || format!("{}/{}/{}", at.module.category, at.module.name, file.as_deref().unwrap_or_default());
        let (origin, place) = match (at.files.get(resource), at.module.data.get(resource)) {
            (Some(named), _) => (Origin::Recipe(named), tree.place(node).keys(&["files", resource])),
            (None, Some(bytes)) => (
                Origin::Module { path: path(), bytes },
                Place::new(&at.module.source).keys(&["resources", resource, "kind", "file"]),
            ),
            (None, None) => (Origin::Nobody, tree.place(node).keys(&["module"])),
        };
        Some(Data {
            format: format.as_deref(),
            origin,
            name: format!("{instance}.{resource}"),
            layout,
            place,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reflect::Layouts;

    fn layout(ty: &str) -> Layout {
        let module = naga::front::wgsl::parse_str(&format!("alias V = vec4f; @group(0) @binding(0) var<storage> a: {ty};")).unwrap();
        let (_, global) = module.global_variables.iter().next().unwrap();
        Layouts::new(&module).unwrap().of(global.ty)
    }

    /// Catches numbers of another byte order, a cut file that is read in part, and NaN and infinities that pass.
    #[test]
    fn only_whole_and_finite_numbers() {
        assert_eq!(numbers(&[0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0]), Ok(vec![1.0, -2.0]));
        assert_eq!(numbers(&[]), Err("it holds no number".to_owned()));
        assert_eq!(numbers(&[0; 7]), Err("7 bytes are no whole number of 32-bit floats".to_owned()));
        let bytes = |list: &[f32]| list.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
        assert_eq!(numbers(&bytes(&[1.0, f32::NAN])), Err("number 1 is NaN".to_owned()));
        assert_eq!(numbers(&bytes(&[f32::NEG_INFINITY, f32::NAN])), Err("number 0 is -inf".to_owned()));
    }

    /// Catches a table that is shorter or longer than the type, half an element, and types with gaps between their numbers.
    #[test]
    fn a_table_fills_its_type() {
        assert_eq!(fits(&layout("array<f32>"), 7), Ok(()));
        assert_eq!(fits(&layout("array<vec2f, 3>"), 6), Ok(()));
        assert_eq!(fits(&layout("array<array<vec2f, 2>, 3>"), 12), Ok(()));
        let wrong = |ty, count| fits(&layout(ty), count).unwrap_err();
        assert_eq!(wrong("array<vec2f, 3>", 5), "5 numbers, but `array<vec2<f32>, 3>` takes 6");
        assert_eq!(wrong("array<vec4f>", 6), "6 numbers, but an element of `array<vec4<f32>>` takes 4");
        assert_eq!(wrong("array<vec3f>", 4), "`array<vec3<f32>>` is no array of 32-bit floats");
        assert_eq!(wrong("array<u32>", 4), "`array<u32>` is no array of 32-bit floats");
        assert_eq!(wrong("vec4f", 4), "`vec4<f32>` is no array of 32-bit floats");
        assert_eq!(wrong("array<mat3x3f>", 9), "`array<mat3x3<f32>>` is no array of 32-bit floats");
    }
}
