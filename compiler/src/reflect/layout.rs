//! Layouts of types in buffers, as naga computes them.

use naga::common::wgsl::TypeContext;
use naga::proc::{LayoutError, Layouter};
use naga::{ArraySize, Handle, Module, Type, TypeInner};

use super::{Layout, Member};

/// The layouts of a module's types.
pub struct Layouts<'m> {
    module: &'m Module,
    layouter: Layouter,
}

impl<'m> Layouts<'m> {
    /// Computes the layouts of all types of the module.
    ///
    /// # Errors
    /// A type is larger than naga allows, or the module is not a validated one.
    pub fn new(module: &'m Module) -> Result<Self, LayoutError> {
        let mut layouter = Layouter::default();
        layouter.update(module.to_ctx())?;
        Ok(Self { module, layouter })
    }

    /// Layout of a type of this module.
    pub fn of(&self, ty: Handle<Type>) -> Layout {
        let mut layout = Layout {
            ty: wgsl_type_name(self.module, ty),
            size: self.layouter[ty].size,
            align: self.layouter[ty].alignment * 1,
            members: Vec::new(),
            element: None,
            stride: None,
            count: None,
        };
        match self.module.types[ty].inner {
            TypeInner::Array { base, size, stride } => {
                layout.element = Some(Box::new(self.of(base)));
                layout.stride = Some(stride);
                match size {
                    ArraySize::Constant(count) => layout.count = Some(count.get()),
                    // naga counts one element of these.
                    ArraySize::Pending(_) | ArraySize::Dynamic => layout.size = 0,
                }
            }
            TypeInner::Struct { ref members, .. } => {
                for (index, member) in members.iter().enumerate() {
                    layout.members.push(Member {
                        name: member.name.clone().unwrap_or_else(|| format!("member_{index}")),
                        offset: member.offset,
                        layout: self.of(member.ty),
                    });
                }
                if let Some(last) = members.last()
                    && self.is_unsized(last.ty)
                {
                    layout.size = last.offset;
                }
            }
            _ => {}
        }
        layout
    }

    fn is_unsized(&self, ty: Handle<Type>) -> bool {
        matches!(
            self.module.types[ty].inner,
            TypeInner::Array {
                size: ArraySize::Dynamic,
                ..
            }
        )
    }
}

/// A type as WGSL writes it, `vec3<f32>`; a struct's name where it is one.
pub fn wgsl_type_name(module: &Module, ty: Handle<Type>) -> String {
    module.to_ctx().type_to_string(ty)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(source: &str) -> Layout {
        let module = naga::front::wgsl::parse_str(source).unwrap();
        let global = module.global_variables.iter().next().unwrap().1;
        Layouts::new(&module).unwrap().of(global.ty)
    }

    /// Catches offsets, sizes and strides that are not WGSL's (a `vec3f` followed by a scalar, an array of `vec3f`, a matrix).
    #[test]
    fn members_and_arrays() {
        let found = layout(
            "struct Light { position: vec3f, flux: f32, on: u32 }
            struct Frame { view: mat3x3f, lights: array<Light, 4>, dirs: array<vec3f, 2>, @size(32) last: vec2u }
            @group(0) @binding(0) var<uniform> frame: Frame;",
        );
        assert_eq!((found.ty.as_str(), found.size, found.align), ("Frame", 240, 16));
        let members: Vec<_> = found
            .members
            .iter()
            .map(|m| (m.name.as_str(), m.offset, m.layout.ty.as_str(), m.layout.size))
            .collect();
        let expected = [
            ("view", 0, "mat3x3<f32>", 48),
            ("lights", 48, "array<Light, 4>", 128),
            ("dirs", 176, "array<vec3<f32>, 2>", 32),
            ("last", 208, "vec2<u32>", 8),
        ];
        assert_eq!(members, expected);
        let lights = &found.members[1].layout;
        assert_eq!((lights.stride, lights.count), (Some(32), Some(4)));
        let light = lights.element.as_ref().unwrap();
        let offsets: Vec<_> = light.members.iter().map(|m| m.offset).collect();
        assert_eq!((light.size, light.align, offsets), (32, 16, vec![0, 12, 16]));
        assert_eq!(found.members[2].layout.stride, Some(16));
    }

    /// Catches a runtime-sized array that is counted as one element.
    #[test]
    fn runtime_sized() {
        let found = layout("@group(0) @binding(0) var<storage> a: array<vec4f>;");
        assert_eq!(
            (found.ty.as_str(), found.size, found.stride, found.count),
            ("array<vec4<f32>>", 0, Some(16), None)
        );
        let found = layout("struct S { n: u32, data: array<vec4f> } @group(0) @binding(0) var<storage> a: S;");
        assert_eq!((found.size, found.align, found.members[1].offset), (16, 16, 16));
        let found = layout("@group(0) @binding(0) var<storage, read_write> a: atomic<u32>;");
        assert_eq!((found.ty.as_str(), found.size), ("atomic<u32>", 4));
    }
}
