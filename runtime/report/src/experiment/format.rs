//! `*.experiment.ron` as written: a list of experiments.

use indexmap::IndexMap;
use serde::Deserialize;
use shadewright_compiler::manifest::{Node, Value};

/// One experiment of a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Declared {
    /// Name among the experiments of its folder; needed where there are several.
    #[serde(default)]
    pub name: String,
    /// A line for people.
    pub title: String,
    /// What is compared, and why; Markdown without headings.
    #[serde(default)]
    pub doc: String,
    /// Function of the interface; where nothing is said, the only one.
    #[serde(default)]
    pub function: Option<String>,
    /// What is compared.
    #[serde(default)]
    pub alternatives: Alternatives,
    /// How each argument is drawn, by path: `s.alpha`, `params.width`, `instances.position`. A name that begins with `_` is drawn for the
    /// others to refer to, and given to nobody. What is not here has the interface's or the module's default.
    #[serde(default)]
    pub inputs: IndexMap<String, Range>,
    /// Whether the parameters of the modules vary.
    #[serde(default)]
    pub params: Params,
    /// How many configurations are drawn.
    #[serde(default = "default_configurations")]
    pub configurations: usize,
    /// Seed of the drawing.
    #[serde(default = "default_seed")]
    pub seed: u64,
    /// Hard configurations: of each block the values are multiplied out; an input not in it is in the middle of its range.
    #[serde(default)]
    pub hard: Vec<IndexMap<String, Hard>>,
    /// What the alternatives should give.
    pub truth: TruthSource,
    /// How far apart two values are.
    pub metric: Metric,
    /// Label of the alternative whose time is 1; the first where nothing is said.
    #[serde(default)]
    pub baseline: Option<String>,
}

fn default_configurations() -> usize {
    2048
}

fn default_seed() -> u64 {
    1
}

/// What an experiment compares.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Alternatives {
    /// Every module of the category that has no experiment of its own about the function (in a category's folder), or the module (in its own).
    #[default]
    All,
    /// These recipes, by label.
    Of(IndexMap<String, Node>),
}

/// Whether parameters vary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Params {
    /// Over the ranges that the root module declares, evenly, or evenly in the logarithm where a range spans more than three decades.
    #[default]
    Declared,
    /// They have their defaults.
    Defaults,
}

/// What a module should give.
#[allow(clippy::large_enum_variant, reason = "one exists for an experiment")]
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub enum TruthSource {
    /// The closed form in the folder of each alternative's root module.
    Own,
    /// The closed form in this folder, `category` or `category/module`.
    Closed(String),
    /// A recipe, evaluated in double precision: ground truth by brute force is a module too.
    Reference(Node),
    /// A recipe that sums over samples, evaluated in double precision. It has an error of its own, and jumps: so the worst input is that of the drawn
    /// ones and no search's, and jumps are those of the formula where the truth has none. An alternative with other samples tells the error.
    Sampled(Node),
    /// The module's own formula in double precision: it has a rounding error, and no error of model.
    Itself,
}

/// How far a value is from what it should be.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Metric {
    /// `(value - truth) / max(|truth|, floor)`, of each number.
    Relative {
        /// Below it a value is as good as 0, in the value's unit.
        floor: f64,
    },
    /// `value - truth`, of each number, in the value's unit.
    Absolute {
        /// The unit, for people.
        #[serde(default)]
        unit: String,
    },
}

/// The values of an input in a block of hard configurations.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Hard {
    /// These.
    Values(Vec<Value>),
    /// Unit vectors at these angles to +z, toward +x, in degrees.
    Angles(Vec<f64>),
    /// Unit vectors at these angles to +z and around it, in degrees.
    Directions(Vec<(f64, f64)>),
    /// As [`Range::Mirror`].
    Mirror {
        /// The direction.
        of: String,
        /// The unit vector.
        about: String,
    },
    /// As [`Range::Half`].
    Half(String, String),
}

impl Hard {
    /// Each of the values, as a range that holds nothing else.
    pub fn ranges(&self) -> Vec<Range> {
        match self {
            Self::Values(values) => values.iter().cloned().map(Range::Value).collect(),
            Self::Angles(angles) => angles.iter().map(|theta| Range::Angles(*theta, 0.0)).collect(),
            Self::Directions(angles) => angles.iter().map(|(theta, phi)| Range::Angles(*theta, *phi)).collect(),
            Self::Mirror { of, about } => vec![Range::Mirror {
                of: of.clone(),
                about: about.clone(),
            }],
            Self::Half(a, b) => vec![Range::Half(a.clone(), b.clone())],
        }
    }
}

/// How an input is drawn.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Range {
    /// Always this.
    Value(Value),
    /// Evenly between two numbers.
    Linear(f64, f64),
    /// Evenly in the logarithm, between two numbers above 0.
    Log(f64, f64),
    /// A whole number, both ends included.
    Whole(i64, i64),
    /// One of these.
    Choice(Vec<Value>),
    /// A vector of numbers drawn for themselves.
    Vector(Vec<Range>),
    /// A unit vector, evenly.
    Sphere,
    /// A unit vector on the side of +z, evenly.
    Hemisphere,
    /// A unit vector at this angle to +z and around it, both in degrees.
    Angles(f64, f64),
    /// A unit vector whose angle to +z is drawn in degrees, around +z evenly.
    Polar(Box<Range>),
    /// The normal of a facet: a unit vector around +z whose angle has a tangent of a thousandth to a thousand times the number of this name, evenly
    /// in the logarithm. The lobe of a narrow distribution is hit at its peak, on its flank and in its tail.
    Lobe(String),
    /// The direction of this name, mirrored about another unit vector.
    Mirror {
        /// The direction.
        of: String,
        /// The unit vector.
        about: String,
    },
    /// The unit vector between the directions of these two names; the first where they are opposite.
    Half(String, String),
    /// One of these ways to draw.
    Either(Vec<Range>),
}
