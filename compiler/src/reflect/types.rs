//! The reflection of one linked pass: all that a host program needs to feed it.

use indexmap::IndexMap;
use serde::Serialize;

use crate::manifest::{Param, ParamType, PassDecl, ResourceKind, Value};

/// Version of the JSON form of [`Reflection`]. It grows when a field changes its meaning or goes away.
pub const SCHEMA_VERSION: u32 = 1;

/// What a linked pass asks of its host.
#[derive(Clone, Debug, Serialize)]
pub struct Reflection {
    /// [`SCHEMA_VERSION`].
    pub version: u32,
    /// Canonical hash of the linked module, 32 hexadecimal digits.
    pub hash: String,
    /// The pass's name: `main`, or `<module>.<pass>` for a pass that a module of the tree declares.
    pub pass: String,
    /// Entry points in the order of their stages.
    pub entry_points: Vec<EntryPoint>,
    /// Bindings, sorted by group and binding. Unused ones are not there.
    pub bindings: Vec<Binding>,
    /// Pipeline-overridable constants.
    pub overrides: Vec<Override>,
    /// Parameters that reached the shader, with the place where each is.
    pub params: Vec<ParamUse>,
    /// Every function of the shader and where it came from.
    pub functions: Vec<FunctionOrigin>,
    /// Module instances of the tree, reached or not, in tree order.
    pub instances: Vec<Instance>,
    /// Device capabilities that the modules ask for.
    pub capabilities: Vec<String>,
    /// Passes that must run before this one, in order.
    pub passes: Vec<Pass>,
}

/// An entry point.
#[derive(Clone, Debug, Serialize)]
pub struct EntryPoint {
    /// Its name in every emitted form that keeps names (WGSL, IR, SPIR-V).
    pub name: String,
    /// `vertex`, `fragment` or `compute`.
    pub stage: Stage,
    /// Workgroup size of a compute entry point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workgroup_size: Option<[u32; 3]>,
    /// Locations that the stage reads.
    pub inputs: Vec<StageValue>,
    /// Locations that the stage writes.
    pub outputs: Vec<StageValue>,
}

/// A shader stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Runs for every vertex.
    Vertex,
    /// Runs for every fragment.
    Fragment,
    /// Runs for every invocation of a dispatch.
    Compute,
}

/// An input or output of a stage with a location.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageValue {
    /// The location.
    pub location: u32,
    /// Member or argument name.
    pub name: String,
    /// WGSL type (`vec3<f32>`).
    #[serde(rename = "type")]
    pub ty: String,
}

/// A bound resource.
#[derive(Clone, Debug, Serialize)]
pub struct Binding {
    /// Bind group.
    pub group: u32,
    /// Number in the group.
    pub binding: u32,
    /// Name of the variable in the emitted text.
    pub name: String,
    /// Stages that use it.
    pub stages: Vec<Stage>,
    /// Type and access, as the API's bind group layout wants to know.
    #[serde(rename = "type")]
    pub ty: BindingType,
    /// What the host puts there.
    pub fill: Fill,
    /// One line for people, of a resource whose declaration has one.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub doc: String,
}

/// Type of a bound resource.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum BindingType {
    /// Uniform buffer.
    Uniform {
        /// Layout of its contents.
        layout: Layout,
    },
    /// Storage buffer.
    Storage {
        /// Declared `read`.
        read_only: bool,
        /// Layout of its contents.
        layout: Layout,
    },
    /// Sampled texture.
    Texture {
        /// `1d`, `2d`, `2d_array`, `3d`, `cube`, `cube_array`.
        dimension: String,
        /// `float`, `unfilterable_float` (never sampled, only loaded), `depth`, `sint`, `uint`.
        sample: String,
        /// Multisampled.
        multisampled: bool,
    },
    /// Storage texture.
    StorageTexture {
        /// As in `Texture`.
        dimension: String,
        /// WGSL texel format, `rgba16float`.
        format: String,
        /// `read`, `write` or `read_write`.
        access: String,
    },
    /// Sampler.
    Sampler {
        /// Comparison sampler.
        comparison: bool,
    },
}

/// Layout of a type in a buffer, as naga computes it, in bytes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Layout {
    /// WGSL type, with the emitted name where it is a struct.
    #[serde(rename = "type")]
    pub ty: String,
    /// Size; of a runtime-sized array the size of its fixed part, 0 when there is none.
    pub size: u32,
    /// Alignment.
    pub align: u32,
    /// Members of a struct, in order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub members: Vec<Member>,
    /// Element of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub element: Option<Box<Layout>>,
    /// Bytes from one element of an array to the next.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stride: Option<u32>,
    /// Number of elements; `None` for runtime-sized arrays and what is no array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<u32>,
}

impl Layout {
    /// Fewest bytes that a binding of this layout may have: a runtime-sized array counts with one element.
    pub fn smallest_size(&self) -> u64 {
        if let Some(last) = self.members.last() {
            let end = u64::from(last.offset) + last.layout.smallest_size();
            return u64::from(self.size).max(end).next_multiple_of(u64::from(self.align.max(1)));
        }
        match (&self.element, self.count, self.stride) {
            (Some(_), None, Some(stride)) => u64::from(stride),
            _ => u64::from(self.size),
        }
    }
}

/// A member of a struct in a buffer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Member {
    /// Name.
    pub name: String,
    /// Bytes from the start of the struct.
    pub offset: u32,
    /// Layout of the member's own type.
    pub layout: Layout,
}

/// What the host puts into a binding.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Fill {
    /// Parameters of several instances: [`Reflection::params`] says which is where.
    Params,
    /// `array<Instance>` with the fields that the module declares under `instances`.
    Instances {
        /// Name of the instance, as in [`Reflection::instances`].
        instance: String,
    },
    /// A resource that a module or an interface declares.
    Resource {
        /// Name of the instance; `None` for a resource of an interface, which all modules share.
        instance: Option<String>,
        /// Name of the variable in the author's WGSL.
        resource: String,
        /// How it is made.
        declared: ResourceKind,
    },
}

/// A pipeline-overridable constant.
#[derive(Clone, Debug, Serialize)]
pub struct Override {
    /// Key for the pipeline's constants.
    pub name: String,
    /// WGSL type.
    #[serde(rename = "type")]
    pub ty: String,
    /// Instance and parameter it stands for.
    pub instance: String,
    /// The parameter.
    pub param: String,
    /// Its default, as the number that the API takes.
    pub default: f64,
}

/// A parameter and its place.
#[derive(Clone, Debug, Serialize)]
pub struct ParamUse {
    /// Name of the instance.
    pub instance: String,
    /// Module's name.
    pub module: String,
    /// The parameter's name.
    pub name: String,
    /// Its type.
    #[serde(rename = "type")]
    pub ty: ParamType,
    /// Unit, range, default and the rest, as the module declares them.
    pub declared: Param,
    /// Where it is.
    pub place: ParamPlace,
}

/// Where a parameter's value is.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum ParamPlace {
    /// In a uniform buffer.
    Uniform {
        /// Bind group.
        group: u32,
        /// Binding.
        binding: u32,
        /// Bytes from the start of the buffer.
        offset: u32,
        /// Name of the member.
        member: String,
    },
    /// A pipeline-overridable constant of this name.
    Override {
        /// Key.
        name: String,
    },
    /// A constant.
    Constant {
        /// The value that it was frozen to.
        value: Value,
    },
}

/// Where a function came from.
#[derive(Clone, Debug, Serialize)]
pub struct FunctionOrigin {
    /// Name in the emitted text.
    pub name: String,
    /// Name in the author's file.
    pub source: String,
    /// Instance; `None` for an interface's own function.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instance: Option<String>,
    /// Module; the category for an interface's own function.
    pub module: String,
    /// The author's file, relative to the library.
    pub file: String,
    /// Line of its first character, from 1; 0 for functions that the linker made.
    pub line: u32,
}

/// A module of the tree.
#[derive(Clone, Debug, Serialize)]
pub struct Instance {
    /// Name in this recipe; unique.
    pub name: String,
    /// Module's name.
    pub module: String,
    /// Module's category.
    pub category: String,
    /// Places in the tree where it stands, as slot paths: `main`, `main.brdf.ndf`, `main.lights[1]`.
    pub paths: Vec<String>,
    /// Fields of `instances[i]`, where the module has any.
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    pub fields: IndexMap<String, Param>,
    /// Files that the recipe names for its resources, as it names them.
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    pub files: IndexMap<String, String>,
}

/// A pass that must run before.
#[derive(Clone, Debug, Serialize)]
pub struct Pass {
    /// Instance that declares it.
    pub instance: String,
    /// Its name there.
    pub name: String,
    /// What it is.
    pub declared: PassDecl,
}
