//! The numbers that a value of a layout holds, by name and place.

use shadewright_compiler::reflect::Layout;

use crate::gpu::pack::{Scalar, Shape};

/// One number of a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Number {
    /// Its path from the value; empty for the value itself.
    pub name: String,
    offset: usize,
    scalar: Scalar,
}

impl Number {
    /// Reads the number from the bytes of the value; what lies beyond them is 0.
    pub fn read(&self, bytes: &[u8]) -> f64 {
        let word = bytes.get(self.offset..).and_then(|rest| rest.first_chunk::<4>()).copied();
        let word = word.unwrap_or_default();
        match self.scalar {
            Scalar::F32 => f64::from(f32::from_le_bytes(word)),
            Scalar::U32 => f64::from(u32::from_le_bytes(word)),
            Scalar::I32 => f64::from(i32::from_le_bytes(word)),
        }
    }
}

impl Number {
    /// Writes an f32 into the bytes of the value; whether there is one.
    pub fn write(&self, bytes: &mut [u8], value: f32) -> bool {
        let place = bytes.get_mut(self.offset..).and_then(|rest| rest.first_chunk_mut::<4>());
        match place {
            Some(place) if self.scalar == Scalar::F32 => {
                *place = value.to_le_bytes();
                true
            }
            _ => false,
        }
    }
}

/// All numbers of a value, in the order of its declaration.
pub(super) fn numbers(layout: &Layout) -> Vec<Number> {
    let mut found = Vec::new();
    collect(layout, "", 0, &mut found);
    found
}

fn collect(layout: &Layout, path: &str, offset: usize, found: &mut Vec<Number>) {
    for member in &layout.members {
        let path = joined(path, &member.name);
        collect(&member.layout, &path, offset + member.offset as usize, found);
    }
    if let (Some(element), Some(stride), Some(count)) = (&layout.element, layout.stride, layout.count) {
        for i in 0..count {
            collect(element, &format!("{path}[{i}]"), offset + (i * stride) as usize, found);
        }
    }
    let Some(shape) = Shape::of(&layout.ty) else { return };
    for component in 0..shape.rows * shape.columns {
        let column = match shape.columns {
            1 => path.to_owned(),
            _ => format!("{path}[{}]", component / shape.rows),
        };
        let name = match shape.rows {
            1 => column,
            rows => joined(&column, &"xyzw"[component % rows..=component % rows]),
        };
        found.push(Number {
            name,
            offset: offset + shape.offset(component),
            scalar: shape.scalar,
        });
    }
}

fn joined(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}.{name}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::testing::layout_of;

    /// Catches numbers under another's name, and a matrix's or array's padding taken for a number.
    #[test]
    fn numbers_have_their_names_and_places() {
        let layout = layout_of(
            "struct Inner { a: f32, b: vec3<f32> }
            struct Outer { u: u32, m: mat2x3<f32>, list: array<Inner, 2>, i: vec2<i32> }
            @group(0) @binding(0) var<storage> data: Outer;",
            "data",
        );
        let found = numbers(&layout);
        let names: Vec<&str> = found.iter().map(|n| n.name.as_str()).collect();
        let expected = "u m[0].x m[0].y m[0].z m[1].x m[1].y m[1].z list[0].a list[0].b.x list[0].b.y list[0].b.z \
            list[1].a list[1].b.x list[1].b.y list[1].b.z i.x i.y";
        assert_eq!(names.join(" "), expected);
        let places: Vec<usize> = found.iter().map(|n| n.offset).collect();
        assert_eq!(places, [0, 16, 20, 24, 32, 36, 40, 48, 64, 68, 72, 80, 96, 100, 104, 112, 116]);
        let mut bytes = vec![0; layout.size as usize];
        bytes[0..4].fill(255);
        bytes[36..40].copy_from_slice(&f32::NAN.to_le_bytes());
        bytes[116..120].copy_from_slice(&(-3i32).to_le_bytes());
        assert_eq!((found[0].read(&bytes), found[16].read(&bytes)), (4_294_967_295.0, -3.0));
        assert!(found[5].read(&bytes).is_nan());
        let alone = |source: &str| numbers(&layout_of(source, "x")).into_iter().map(|n| n.name).collect::<Vec<_>>();
        assert_eq!(alone("@group(0) @binding(0) var<storage> x: f32;"), [""]);
        assert_eq!(
            alone("@group(0) @binding(0) var<storage> x: array<vec2<f32>, 2>;"),
            ["[0].x", "[0].y", "[1].x", "[1].y"]
        );
    }
}
