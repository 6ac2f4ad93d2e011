//! `*.space.ron`: a recipe in which slots and parameters list alternatives.

use std::fmt;
use std::sync::Arc;

use indexmap::IndexMap;
use serde::de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer};
use serde::{Deserialize, Deserializer};

use crate::diagnostics::{Report, SourceFile};
use crate::manifest::{Among, Filling, Node, Step, Value, parse, parse_recipe};

/// A space as written: choices, and what rules out some of them.
#[derive(Clone, Debug)]
pub struct SpaceFile {
    /// The tree of choices.
    pub root: Choice,
    /// Rules beside those of the modules.
    pub rules: Vec<SpaceRule>,
    /// What the target can hold.
    pub limits: Limits,
    /// The text.
    pub source: Arc<SourceFile>,
    /// Whether the root stands under `root`, or is the whole text.
    pub(super) framed: bool,
}

/// The form with rules and limits.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Framed {
    root: Choice,
    #[serde(default)]
    rules: Vec<SpaceRule>,
    #[serde(default)]
    limits: Limits,
}

impl SpaceFile {
    /// Reads a space: the text of a `*.space.ron` file, or any recipe, which is a space of one.
    ///
    /// # Errors
    /// The text exceeds a limit, is no RON, or is RON of another shape.
    pub fn parse(name: &str, text: &str) -> Result<Self, Report> {
        if let Ok(bare) = parse_recipe(name, text)
            && bare.value == Node::new(text.trim())
        {
            return Ok(Self::plain(Choice::from(&bare.value), bare.file));
        }
        let framed = crate::manifest::Locator::new(text);
        if framed.find(&[Step::Key("root")]).is_none() {
            let parsed = parse::<Choice>(name, text)?;
            return Ok(Self::plain(parsed.value, parsed.file));
        }
        let parsed = parse::<Framed>(name, text)?;
        Ok(Self {
            root: parsed.value.root,
            rules: parsed.value.rules,
            limits: parsed.value.limits,
            source: parsed.file,
            framed: true,
        })
    }

    fn plain(root: Choice, source: Arc<SourceFile>) -> Self {
        Self {
            root,
            rules: Vec::new(),
            limits: Limits::default(),
            source,
            framed: false,
        }
    }
}

/// What may stand in a place of the tree.
#[derive(Clone, Debug, PartialEq)]
pub enum Choice {
    /// One module: its name, or `(module: "...", ...)`.
    Node(SpaceNode),
    /// One after the other: `[...]`.
    List(Vec<Choice>),
    /// Exactly one of these: `(one_of: [...])`.
    OneOf(Vec<Choice>),
    /// Some of these, in their order: `(some_of: [...], min: 0, max: 2)`.
    SomeOf {
        /// What there is to choose from.
        of: Vec<Choice>,
        /// Fewest; 0 where nothing is said.
        min: Option<u32>,
        /// Most; all where nothing is said.
        max: Option<u32>,
    },
    /// Whatever the library has for the place: `(fits: Open)`.
    Fits(FitsChoice),
}

/// A module of a space: as in a recipe, but that its slots and parameters may have alternatives.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceNode {
    /// Name of the module, or `category/name`.
    pub module: String,
    /// What may stand in its slots; a slot not named here has its default.
    pub fill: IndexMap<String, Choice>,
    /// Parameters that become constants, with the values that they may have.
    pub freeze: IndexMap<String, Values>,
    /// As in a recipe.
    pub label: Option<String>,
    /// Words by which rules of this space find it.
    pub tags: Vec<String>,
}

/// How far modules of the library's own are opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Fits {
    /// Their slots have their defaults.
    Defaults,
    /// Their slots take whatever fits in turn.
    Open,
}

/// All modules that fit a place.
#[derive(Clone, Debug, PartialEq)]
pub struct FitsChoice {
    /// How far they are opened.
    pub fits: Fits,
    /// Category, for the root, which stands in no slot.
    pub of: Option<String>,
    /// Modules left out, here and further down.
    pub without: Vec<String>,
    /// How many levels of slots are opened.
    pub depth: Option<u32>,
    /// Fewest, in an optional or list slot.
    pub min: Option<u32>,
    /// Most, in an optional or list slot.
    pub max: Option<u32>,
}

/// The values that a frozen parameter may have.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Just this one.
    One(Value),
    /// `(values: [...])`
    Many(Vec<Value>),
    /// `(from: 0.1, to: 1.0, steps: 4, scale: Log)` or `(from: 0, to: 8, step: 2)`
    Range(ValueRange),
}

/// Equidistant numbers, both ends included where a step meets them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// First value, in the parameter's unit.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Distance of neighbours.
    pub step: Option<f64>,
    /// Number of steps from the first to the last value: one less than there are values.
    pub steps: Option<u32>,
    /// What is equidistant.
    pub scale: Scale,
}

/// What is equidistant in a range of values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Scale {
    /// The values.
    #[default]
    Linear,
    /// Their logarithms.
    Log,
}

/// A rule of a space. It binds every module that has the tag `when`, as if it stood in its manifest; without `when` it binds the root.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum SpaceRule {
    /// Something with this tag must stand there.
    Requires {
        /// Whom the rule binds.
        #[serde(default)]
        when: Option<String>,
        /// As in a module's rules, or a tag of the space.
        tag: String,
        /// Where.
        among: Among,
        /// Said where the rule leaves nothing.
        because: String,
    },
    /// Nothing with this tag may stand there.
    Excludes {
        /// Whom the rule binds.
        #[serde(default)]
        when: Option<String>,
        /// As in `Requires`.
        tag: String,
        /// Where.
        among: Among,
        /// Said where the rule leaves nothing.
        because: String,
    },
}

/// What a target can hold, by the modules' declarations: an upper bound of what a linked shader has.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Capabilities that it lacks, by naga's names.
    #[serde(default)]
    pub lacks: Vec<String>,
    /// Most sampled and depth textures.
    #[serde(default)]
    pub textures: Option<u32>,
    /// Most samplers.
    #[serde(default)]
    pub samplers: Option<u32>,
    /// Most storage buffers.
    #[serde(default)]
    pub storage_buffers: Option<u32>,
    /// Most uniform buffers.
    #[serde(default)]
    pub uniform_buffers: Option<u32>,
    /// Most entries of all bind groups together.
    #[serde(default)]
    pub bindings: Option<u32>,
}

impl From<&Node> for Choice {
    fn from(node: &Node) -> Self {
        let fill = node.fill.iter().map(|(slot, filling)| (slot.clone(), Self::from(filling)));
        let freeze = node.freeze.iter().map(|(name, value)| (name.clone(), Values::One(value.clone())));
        Self::Node(SpaceNode {
            module: node.module.clone(),
            fill: fill.collect(),
            freeze: freeze.collect(),
            label: node.label.clone(),
            tags: Vec::new(),
        })
    }
}

impl From<&Filling> for Choice {
    fn from(filling: &Filling) -> Self {
        match filling {
            Filling::One(node) => node.into(),
            Filling::Many(nodes) => Self::List(nodes.iter().map(Self::from).collect()),
        }
    }
}

/// All fields of all forms; which of them stand together decides the form.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fields {
    #[serde(default)]
    module: Option<String>,
    #[serde(default)]
    fill: Option<IndexMap<String, Choice>>,
    #[serde(default)]
    freeze: Option<IndexMap<String, Values>>,
    #[serde(default)]
    label: Option<String>,
    #[serde(default)]
    tags: Option<Vec<String>>,
    #[serde(default)]
    one_of: Option<Vec<Choice>>,
    #[serde(default)]
    some_of: Option<Vec<Choice>>,
    #[serde(default)]
    fits: Option<Fits>,
    #[serde(default)]
    of: Option<String>,
    #[serde(default)]
    without: Option<Vec<String>>,
    #[serde(default)]
    depth: Option<u32>,
    #[serde(default)]
    min: Option<u32>,
    #[serde(default)]
    max: Option<u32>,
}

impl Fields {
    /// Names of the fields that are there, the deciding ones first.
    fn said(&self) -> Vec<&'static str> {
        let all = [
            ("module", self.module.is_some()),
            ("one_of", self.one_of.is_some()),
            ("some_of", self.some_of.is_some()),
            ("fits", self.fits.is_some()),
            ("fill", self.fill.is_some()),
            ("freeze", self.freeze.is_some()),
            ("label", self.label.is_some()),
            ("tags", self.tags.is_some()),
            ("of", self.of.is_some()),
            ("without", self.without.is_some()),
            ("depth", self.depth.is_some()),
            ("min", self.min.is_some()),
            ("max", self.max.is_some()),
        ];
        all.into_iter().filter(|(_, there)| *there).map(|(name, _)| name).collect()
    }

    fn choice(self) -> Result<Choice, String> {
        let said = self.said();
        let takes: &[&str] = match said.first() {
            Some(&"module") => &["fill", "freeze", "label", "tags"],
            Some(&"one_of") => &[],
            Some(&"some_of") => &["min", "max"],
            Some(&"fits") => &["of", "without", "depth", "min", "max"],
            _ => return Err("one of `module`, `one_of`, `some_of` and `fits` is needed".to_owned()),
        };
        if let Some(other) = said[1..].iter().find(|field| !takes.contains(field)) {
            return Err(format!("`{other}` cannot stand beside `{}`", said[0]));
        }
        Ok(match (self.module, self.one_of, self.some_of, self.fits) {
            (Some(module), ..) => Choice::Node(SpaceNode {
                module,
                fill: self.fill.unwrap_or_default(),
                freeze: self.freeze.unwrap_or_default(),
                label: self.label,
                tags: self.tags.unwrap_or_default(),
            }),
            (_, Some(of), ..) => Choice::OneOf(of),
            (_, _, Some(of), _) => Choice::SomeOf {
                of,
                min: self.min,
                max: self.max,
            },
            (_, _, _, fits) => Choice::Fits(FitsChoice {
                // One of the four is there, as was found above.
                fits: fits.unwrap_or(Fits::Defaults),
                of: self.of,
                without: self.without.unwrap_or_default(),
                depth: self.depth,
                min: self.min,
                max: self.max,
            }),
        })
    }
}

impl<'de> Deserialize<'de> for Choice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ChoiceVisitor;
        impl<'de> Visitor<'de> for ChoiceVisitor {
            type Value = Choice;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a module's name, (module: ...), (one_of: [...]), (some_of: [...]), (fits: ...), or a list of these")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<Choice, E> {
                Ok(Choice::from(&Node::new(name)))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Choice, A::Error> {
                let fields = Fields::deserialize(MapAccessDeserializer::new(map))?;
                fields.choice().map_err(de::Error::custom)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Choice, A::Error> {
                let mut list = Vec::new();
                while let Some(element) = seq.next_element()? {
                    list.push(element);
                }
                Ok(Choice::List(list))
            }
        }
        deserializer.deserialize_any(ChoiceVisitor)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ValueFields {
    #[serde(default)]
    values: Option<Vec<Value>>,
    #[serde(default)]
    from: Option<f64>,
    #[serde(default)]
    to: Option<f64>,
    #[serde(default)]
    step: Option<f64>,
    #[serde(default)]
    steps: Option<u32>,
    #[serde(default)]
    scale: Option<Scale>,
}

impl<'de> Deserialize<'de> for Values {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ValuesVisitor;
        impl<'de> Visitor<'de> for ValuesVisitor {
            type Value = Values;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a value, (values: [...]), or (from: a, to: b, steps: n)")
            }
            fn visit_bool<E: de::Error>(self, v: bool) -> Result<Values, E> {
                Ok(Values::One(Value::Bool(v)))
            }
            fn visit_f64<E: de::Error>(self, v: f64) -> Result<Values, E> {
                Ok(Values::One(Value::Number(v)))
            }
            fn visit_i64<E: de::Error>(self, v: i64) -> Result<Values, E> {
                Ok(Values::One(Value::Number(v as f64)))
            }
            fn visit_u64<E: de::Error>(self, v: u64) -> Result<Values, E> {
                Ok(Values::One(Value::Number(v as f64)))
            }
            fn visit_str<E: de::Error>(self, v: &str) -> Result<Values, E> {
                Ok(Values::One(Value::Text(v.to_owned())))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Values, A::Error> {
                Value::deserialize(SeqAccessDeserializer::new(seq)).map(Values::One)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Values, A::Error> {
                let said = ValueFields::deserialize(MapAccessDeserializer::new(map))?;
                match said {
                    ValueFields {
                        values: Some(values),
                        from: None,
                        to: None,
                        step: None,
                        steps: None,
                        scale: None,
                    } => Ok(Values::Many(values)),
                    ValueFields {
                        values: None,
                        from: Some(from),
                        to: Some(to),
                        step,
                        steps,
                        scale,
                    } => Ok(Values::Range(ValueRange {
                        from,
                        to,
                        step,
                        steps,
                        scale: scale.unwrap_or_default(),
                    })),
                    _ => Err(de::Error::custom("either `values`, or `from` and `to` with `step` or `steps`")),
                }
            }
        }
        deserializer.deserialize_any(ValuesVisitor)
    }
}
