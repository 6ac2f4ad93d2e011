//! Resources and entry points as a host's API wants to know them.

use naga::common::wgsl::ToWgsl;
use naga::valid::ModuleInfo;
use naga::{AddressSpace, Binding, GlobalVariable, Handle, ImageClass, ImageDimension, Module, ScalarKind, StorageAccess, Type, TypeInner};

use super::{BindingType, EntryPoint, Layouts, Stage, StageValue, wgsl_type_name};

/// Type of a resource for a bind group layout; `None` for what is no resource, or one that we do not know (binding arrays,
/// external textures, acceleration structures).
///
/// A storage buffer is read-only where its declaration says so. A texture of floats is `unfilterable_float` where no entry point
/// samples it.
pub fn binding_type(module: &Module, info: &ModuleInfo, layouts: &Layouts, global: Handle<GlobalVariable>) -> Option<BindingType> {
    let variable = &module.global_variables[global];
    match (&module.types[variable.ty].inner, variable.space) {
        (TypeInner::Sampler { comparison }, _) => Some(BindingType::Sampler { comparison: *comparison }),
        (TypeInner::Image { dim, arrayed, class }, _) => {
            let dimension = dimension(*dim, *arrayed).to_owned();
            let (sample, multisampled) = match *class {
                ImageClass::Sampled { kind, multi } => {
                    let sample = match kind {
                        ScalarKind::Sint => "sint",
                        ScalarKind::Uint => "uint",
                        _ if is_sampled(module, info, global) => "float",
                        _ => "unfilterable_float",
                    };
                    (sample, multi)
                }
                ImageClass::Depth { multi } => ("depth", multi),
                ImageClass::Storage { format, access } => {
                    let (load, store) = (access.contains(StorageAccess::LOAD), access.contains(StorageAccess::STORE));
                    let access = match (load, store) {
                        (true, true) => "read_write",
                        (true, false) => "read",
                        _ => "write",
                    };
                    return Some(BindingType::StorageTexture {
                        dimension,
                        format: format.to_wgsl().to_owned(),
                        access: access.to_owned(),
                    });
                }
                ImageClass::External => return None,
            };
            Some(BindingType::Texture {
                dimension,
                sample: sample.to_owned(),
                multisampled,
            })
        }
        (_, AddressSpace::Uniform) => Some(BindingType::Uniform {
            layout: layouts.of(variable.ty),
        }),
        (_, AddressSpace::Storage { access }) => Some(BindingType::Storage {
            read_only: !access.contains(StorageAccess::STORE),
            layout: layouts.of(variable.ty),
        }),
        _ => None,
    }
}

fn dimension(dim: ImageDimension, arrayed: bool) -> &'static str {
    match (dim, arrayed) {
        (ImageDimension::D1, _) => "1d",
        (ImageDimension::D2, false) => "2d",
        (ImageDimension::D2, true) => "2d_array",
        (ImageDimension::D3, _) => "3d",
        (ImageDimension::Cube, false) => "cube",
        (ImageDimension::Cube, true) => "cube_array",
    }
}

fn is_sampled(module: &Module, info: &ModuleInfo, image: Handle<GlobalVariable>) -> bool {
    (0..module.entry_points.len()).any(|index| info.get_entry_point(index).sampling_set.iter().any(|key| key.image == image))
}

/// Stages that use a global variable, in their order, each once.
pub fn stages_using(module: &Module, info: &ModuleInfo, global: Handle<GlobalVariable>) -> Vec<Stage> {
    let uses = module
        .entry_points
        .iter()
        .enumerate()
        .filter(|(index, _)| !info.get_entry_point(*index)[global].is_empty());
    let mut stages: Vec<Stage> = uses.filter_map(|(_, entry)| stage(entry.stage)).collect();
    stages.sort_unstable();
    stages.dedup();
    stages
}

/// Our name of naga's stage; `None` for those that we have no pipelines for.
pub fn stage(stage: naga::ShaderStage) -> Option<Stage> {
    match stage {
        naga::ShaderStage::Vertex => Some(Stage::Vertex),
        naga::ShaderStage::Fragment => Some(Stage::Fragment),
        naga::ShaderStage::Compute => Some(Stage::Compute),
        _ => None,
    }
}

/// An entry point with the locations that it reads and writes, each list in the order of locations; `None` for stages that we
/// have no pipelines for. An output without a name is called `result`.
pub fn entry_point(module: &Module, entry: &naga::EntryPoint) -> Option<EntryPoint> {
    let stage = stage(entry.stage)?;
    let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
    for (index, argument) in entry.function.arguments.iter().enumerate() {
        let name = argument.name.clone().unwrap_or_else(|| format!("argument_{index}"));
        located(module, &name, argument.ty, argument.binding.as_ref(), &mut inputs);
    }
    if let Some(result) = &entry.function.result {
        located(module, "result", result.ty, result.binding.as_ref(), &mut outputs);
    }
    inputs.sort_by_key(|value| value.location);
    outputs.sort_by_key(|value| value.location);
    Some(EntryPoint {
        name: entry.name.clone(),
        stage,
        workgroup_size: (stage == Stage::Compute).then_some(entry.workgroup_size),
        inputs,
        outputs,
    })
}

/// Adds what has a location: the value itself, or the members of its struct.
fn located(module: &Module, name: &str, ty: Handle<Type>, binding: Option<&Binding>, values: &mut Vec<StageValue>) {
    match (binding, &module.types[ty].inner) {
        (Some(Binding::Location { location, .. }), _) => values.push(StageValue {
            location: *location,
            name: name.to_owned(),
            ty: wgsl_type_name(module, ty),
        }),
        (None, TypeInner::Struct { members, .. }) => {
            for member in members {
                // Members of an entry point's struct each have a binding of their own: this goes no deeper.
                if let Some(binding) = &member.binding {
                    located(module, member.name.as_deref().unwrap_or_default(), member.ty, Some(binding), values);
                }
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validate::{Validated, validate};

    fn validated(source: &str) -> Validated {
        let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
        validate(module).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)))
    }

    const SHADER: &str = "
        struct Params { a: vec3f }
        @group(0) @binding(0) var<uniform> params: Params;
        @group(0) @binding(1) var<storage> read_only: array<u32>;
        @group(0) @binding(2) var<storage, read_write> written: array<u32>;
        @group(0) @binding(3) var sampled: texture_2d<f32>;
        @group(0) @binding(4) var loaded: texture_2d_array<f32>;
        @group(0) @binding(5) var shadow: texture_depth_cube_array;
        @group(0) @binding(6) var ids: texture_multisampled_2d<u32>;
        @group(0) @binding(7) var out: texture_storage_3d<rgba16float, write>;
        @group(0) @binding(8) var smooth_sampler: sampler;
        @group(0) @binding(9) var shadow_sampler: sampler_comparison;
        @group(0) @binding(10) var unused: texture_cube<i32>;
        var<private> counter: u32;

        fn through(t: texture_2d<f32>, s: sampler, uv: vec2f) -> vec4f { return textureSampleLevel(t, s, uv, 0.0); }

        struct In { @builtin(position) p: vec4f, @location(3) b: vec2f, @location(1) a: vec3f }
        struct Colours { @location(1) second: vec4f, @location(0) first: vec4f }
        @vertex fn vs(@location(2) at: vec3f, @location(0) @interpolate(flat) id: u32) -> @builtin(position) vec4f {
            return vec4f(at + params.a, f32(id));
        }
        @fragment fn fs(in: In) -> Colours {
            counter += 1u;
            let lit = textureSampleCompareLevel(shadow, shadow_sampler, in.a, 0, 0.5);
            let texel = textureLoad(loaded, vec2i(0), 0, 0) * f32(textureLoad(ids, vec2i(0), 0).x);
            return Colours(through(sampled, smooth_sampler, in.b) * lit, texel * params.a.x);
        }
        @compute @workgroup_size(8, 4) fn cs() { written[0] = read_only[0]; textureStore(out, vec3i(0), vec4f(1.0)); }
        @fragment fn plain() -> @location(0) vec4f { return vec4f(params.a, 1.0); }
    ";

    /// Catches each kind of resource that is taken for another, above all float textures that are only loaded, and sampling
    /// that happens inside a function that is given the texture.
    #[test]
    fn kinds() {
        let program = validated(SHADER);
        let (module, info) = (program.module(), program.info());
        let layouts = Layouts::new(module).unwrap();
        let found: Vec<String> = module
            .global_variables
            .iter()
            .filter_map(|(handle, global)| Some((global.name.clone()?, binding_type(module, info, &layouts, handle)?)))
            .map(|(name, ty)| match ty {
                BindingType::Uniform { layout } => format!("{name}: uniform {}", layout.ty),
                BindingType::Storage { read_only, layout } => format!("{name}: storage {read_only} {}", layout.ty),
                other => format!("{name}: {}", serde_json::to_string(&other).unwrap()),
            })
            .collect();
        let expected = [
            r#"params: uniform Params"#,
            r#"read_only: storage true array<u32>"#,
            r#"written: storage false array<u32>"#,
            r#"sampled: {"kind":"texture","dimension":"2d","sample":"float","multisampled":false}"#,
            r#"loaded: {"kind":"texture","dimension":"2d_array","sample":"unfilterable_float","multisampled":false}"#,
            r#"shadow: {"kind":"texture","dimension":"cube_array","sample":"depth","multisampled":false}"#,
            r#"ids: {"kind":"texture","dimension":"2d","sample":"uint","multisampled":true}"#,
            r#"out: {"kind":"storage_texture","dimension":"3d","format":"rgba16float","access":"write"}"#,
            r#"smooth_sampler: {"kind":"sampler","comparison":false}"#,
            r#"shadow_sampler: {"kind":"sampler","comparison":true}"#,
            r#"unused: {"kind":"texture","dimension":"cube","sample":"sint","multisampled":false}"#,
        ];
        assert_eq!(found, expected);
    }

    /// Catches uses that are missed in called functions, and stages that are listed twice or out of order.
    #[test]
    fn stages() {
        let program = validated(SHADER);
        let (module, info) = (program.module(), program.info());
        let of = |name: &str| {
            let mut globals = module.global_variables.iter();
            stages_using(
                module,
                info,
                globals.find(|(_, global)| global.name.as_deref() == Some(name)).unwrap().0,
            )
        };
        assert_eq!(of("params"), [Stage::Vertex, Stage::Fragment]);
        assert_eq!(of("smooth_sampler"), [Stage::Fragment]);
        assert_eq!(of("written"), [Stage::Compute]);
        assert_eq!(of("unused"), []);
    }

    /// Catches built-ins taken for locations, struct members that are lost, and a wrong order or workgroup size.
    #[test]
    fn entry_points() {
        let program = validated(SHADER);
        let module = program.module();
        let found: Vec<EntryPoint> = module.entry_points.iter().filter_map(|entry| entry_point(module, entry)).collect();
        let values = |values: &[StageValue]| {
            values
                .iter()
                .map(|v| format!("{} {}: {}", v.location, v.name, v.ty))
                .collect::<Vec<_>>()
        };
        assert_eq!(values(&found[0].inputs), ["0 id: u32", "2 at: vec3<f32>"]);
        assert_eq!(values(&found[0].outputs), [""; 0]);
        assert_eq!(values(&found[1].inputs), ["1 a: vec3<f32>", "3 b: vec2<f32>"]);
        assert_eq!(values(&found[1].outputs), ["0 first: vec4<f32>", "1 second: vec4<f32>"]);
        assert_eq!(found[2].workgroup_size, Some([8, 4, 1]));
        assert_eq!((found[1].workgroup_size, found[1].stage), (None, Stage::Fragment));
        assert_eq!(values(&found[3].outputs), ["0 result: vec4<f32>"]);
    }
}
