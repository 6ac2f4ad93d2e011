//! `module.ron`: the declaration of one module.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::{Node, Value};

/// A module's declaration, as written in `module.ron`. The module's category is the folder it stands in,
/// its name the folder's own name.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ModuleManifest {
    /// One line: what the module computes.
    pub summary: String,
    /// Where the formula comes from: author, year, equation or section.
    #[serde(default)]
    pub source: Vec<String>,
    /// Holes that other modules fill.
    #[serde(default)]
    pub slots: IndexMap<String, Slot>,
    /// Interfaces whose structs, constants, resources and functions the WGSL names as they stand,
    /// beside those of its own category and of its slots.
    #[serde(default)]
    pub uses: Vec<String>,
    /// Parameters, read in WGSL as `params.<name>`.
    #[serde(default)]
    pub params: IndexMap<String, Param>,
    /// Fields of `instances[i]`, for a module that stands for many things of one kind in one buffer (lights).
    #[serde(default)]
    pub instances: IndexMap<String, Param>,
    /// Module-scope resource variables of the WGSL, and how the host fills them.
    #[serde(default)]
    pub resources: IndexMap<String, Resource>,
    /// Device capabilities without which the module does not work, by naga's names (`SHADER_FLOAT16`).
    #[serde(default)]
    pub capabilities: Vec<String>,
    /// What must or must not stand in the same tree.
    #[serde(default)]
    pub rules: Vec<Rule>,
    /// Properties that the module claims and tests check (`reciprocal`, `energy_conserving`, `isotropic`).
    #[serde(default)]
    pub properties: Vec<String>,
    /// Passes that must have run before the function of this module is called.
    #[serde(default)]
    pub passes: IndexMap<String, PassDecl>,
    /// Things of foreign formats that this module stands for, such as `gltf:light/point`.
    #[serde(default)]
    pub represents: Vec<String>,
}

impl ModuleManifest {
    /// The format of the files that whoever uses the module may name for this resource; `None` where none may be named.
    pub fn format_of(&self, resource: &str) -> Option<&str> {
        match &self.resources.get(resource)?.kind {
            ResourceKind::Data { format, .. } => format.as_deref(),
            _ => None,
        }
    }
}

/// A hole in a module, typed by an interface.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Slot {
    /// The category whose modules fit.
    pub interface: String,
    /// How many modules the slot takes.
    #[serde(default)]
    pub arity: Arity,
    /// What stands in the slot when a recipe says nothing. A list slot may name several.
    #[serde(default)]
    pub default: Option<Filling>,
    /// Written before the interface's function names in this module's calls, so that
    /// two slots of one interface can be told apart: `coat_` makes `brdf` be called as `coat_brdf`.
    #[serde(default)]
    pub prefix: String,
    /// One line: what the slot decides.
    #[serde(default)]
    pub doc: String,
    /// Things of foreign formats that belong here, and the module that then fills the slot:
    /// `{"gltf:baseColorTexture": "color-texture"}`.
    #[serde(default)]
    pub represents: IndexMap<String, String>,
}

/// How many modules a slot takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Arity {
    /// Exactly one; a recipe without it is an error unless there is a default.
    #[default]
    Single,
    /// None or one. When empty, calls reach the interface's own (neutral) bodies.
    Optional,
    /// Any number, combined by the interface's rule; when empty, the neutral bodies.
    List,
}

/// What fills a slot: one node, or a list of them.
#[allow(
    clippy::large_enum_variant,
    reason = "nearly all are one node: a box would only cost each an allocation"
)]
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Filling {
    /// One module.
    One(Node),
    /// Modules in order.
    Many(Vec<Node>),
}

/// A parameter, or a field of `instances[i]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Param {
    /// Its type.
    #[serde(rename = "type")]
    pub ty: ParamType,
    /// Unit of the number that the shader sees; "1" for a pure number.
    #[serde(default)]
    pub unit: String,
    /// Other units a person may write, and the factor that turns one of them into `unit`.
    #[serde(default)]
    pub also: IndexMap<String, f64>,
    /// Value where nothing is said.
    pub default: Value,
    /// Smallest and largest allowed value, of every component.
    #[serde(default)]
    pub range: Option<(f64, f64)>,
    /// One line for people.
    #[serde(default)]
    pub doc: String,
    /// How the value reaches the shader unless a recipe freezes it.
    #[serde(default)]
    pub mode: ParamMode,
    /// What the host must know of the value beyond its number (`position`, `direction`, `range` of a light).
    #[serde(default)]
    pub role: Option<String>,
}

impl Param {
    /// The slot of which the parameter, by its role `filled:SLOT`, says whether anything stands in it. Nobody sets such a parameter: a branch on it
    /// leaves no trace of what an empty slot would have done.
    pub fn filled_slot(&self) -> Option<&str> {
        self.role.as_deref()?.strip_prefix("filled:")
    }
}

/// Type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
pub enum ParamType {
    /// `f32`
    F32,
    /// `u32`
    U32,
    /// `i32`
    I32,
    /// `bool`; cannot be `Uniform`
    Bool,
    /// `vec2f`
    Vec2,
    /// `vec3f`
    Vec3,
    /// `vec4f`
    Vec4,
    /// `vec3f`: linear Rec.709. People may also write a colour temperature, `"2700 K"`
    Color,
}

/// How a parameter reaches the shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, Serialize)]
pub enum ParamMode {
    /// Member of a uniform block; may change at every draw.
    #[default]
    Uniform,
    /// Pipeline-overridable constant; fixed when the pipeline is made. Scalars only.
    Override,
    /// Constant; fixed before parsing, so array lengths and branches may depend on it.
    Constant,
}

/// How the host fills a module-scope resource variable of the WGSL.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Resource {
    /// What it is.
    pub kind: ResourceKind,
    /// Bind group; the category's group if not said.
    #[serde(default)]
    pub group: Option<u32>,
    /// One line for people.
    #[serde(default)]
    pub doc: String,
}

/// Kinds of resources, by how the host makes them.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum ResourceKind {
    /// Filled by the host program under this name (`frame`, `objects`, `hdr`).
    Host(String),
    /// A texture that a scene names for this module, under the resource's name.
    Texture {
        /// Whether texels are sRGB-encoded colours (else linear data).
        #[serde(default)]
        srgb: bool,
    },
    /// A sampler.
    Sampler {
        /// Linear filtering (else nearest).
        #[serde(default)]
        linear: bool,
        /// Repeat outside [0, 1] (else clamp to edge).
        #[serde(default)]
        repeat: bool,
        /// Compares against a depth, less-or-equal.
        #[serde(default)]
        compare: bool,
    },
    /// The depth that a `Draw` pass of this module rendered.
    Depth {
        /// Name of the pass in `passes`.
        pass: String,
    },
    /// The views of a `Draw` pass: `array<View>` with one element for each layer, as laid out in the `pass` interface.
    Views {
        /// Name of the pass in `passes`.
        pass: String,
    },
    /// A storage buffer of this many bytes, zeroed when made, that the module's compute passes and functions share.
    Buffer {
        /// Size in bytes.
        bytes: u64,
    },
    /// A read-only storage buffer of 32-bit floats from a file: the module's own, or one that whoever uses the module names under the
    /// resource's name. At least one of the fields is there.
    Data {
        /// File in the module's folder: its table or, with `format`, what is read where nobody names another.
        #[serde(default)]
        file: Option<String>,
        /// How the file's bytes become numbers; then a file may be named by whoever uses the module. Without it the file is the module's own,
        /// little-endian 32-bit floats.
        #[serde(default)]
        format: Option<String>,
    },
}

/// A pass that a module needs.
#[allow(clippy::large_enum_variant, reason = "a handful of them exist, in maps")]
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum PassDecl {
    /// Draws the scene into a depth texture, once for each view.
    Draw {
        /// Root of the pass's own recipe.
        root: Node,
        /// Slots of that root that are filled as in the main recipe.
        #[serde(default)]
        inherit: Vec<String>,
        /// From where.
        view: ViewKind,
        /// Parameter of this module with the side of the square depth texture, in texels.
        resolution: String,
    },
    /// Runs a compute entry point of this module.
    Compute {
        /// Name of the entry point in the WGSL.
        entry: String,
        /// Over what.
        over: Dispatch,
    },
}

/// The views a `Draw` pass renders for each light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum ViewKind {
    /// Six 90 degree perspectives from the light's `position` to its `range`.
    Cube,
    /// One view: a perspective from `position` along `direction`; for a light without a position
    /// an orthographic view along `direction` that holds the whole scene.
    Projected,
}

/// What a compute pass is dispatched over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Dispatch {
    /// A single workgroup.
    Once,
    /// One invocation for each texel of the HDR frame.
    Frame,
}

/// A demand on the rest of the tree.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Rule {
    /// Something with this tag must stand there.
    Requires {
        /// A module's name, its category, a property it claims, or a role one of its instance fields has.
        tag: String,
        /// Where.
        among: Among,
        /// Said to the person whose recipe breaks the rule.
        because: String,
    },
    /// Nothing with this tag may stand there.
    Excludes {
        /// As in `Requires`.
        tag: String,
        /// Where.
        among: Among,
        /// Said to the person whose recipe breaks the rule.
        because: String,
    },
}

/// Which modules a rule looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Among {
    /// The module whose slot this one fills.
    Parent,
    /// The modules in this one's slots, at any depth.
    Children,
    /// Every other module of the recipe.
    Tree,
}
