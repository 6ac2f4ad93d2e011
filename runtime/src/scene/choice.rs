//! A chosen module with all that a scene says of it.

use indexmap::IndexMap;
use serde::de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer};
use shadewright_compiler::manifest::{Filling, Node, Value};

use std::sync::Arc;

use crate::frame::Texture;

/// One module: a recipe's node and, beside it, the values of the parameters that stay changeable and the files of its textures and data.
///
/// In RON either the module's name alone, `"ggx"`, or
/// `(module: "pcf", fill: {...}, freeze: {"radius": 2}, params: {...}, textures: {"image": "wood.png"}, files: {"measured": "gold.f32"}, label: "a")`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    /// Name of the module.
    pub module: String,
    /// What stands in its slots; a slot not named here has its default.
    pub fill: IndexMap<String, Choices>,
    /// Parameters that become constants.
    pub freeze: IndexMap<String, Value>,
    /// Parameters that stay changeable, with their values.
    pub params: IndexMap<String, Value>,
    /// Pictures by the name of the module's resource.
    pub textures: IndexMap<String, Picture>,
    /// Files of data by the name of the module's resource, relative to the scene's folder.
    pub files: IndexMap<String, String>,
    /// Keeps this subtree apart from an equal one.
    pub label: Option<String>,
}

/// What fills a slot.
#[derive(Clone, Debug, PartialEq)]
pub enum Choices {
    /// One module.
    One(Box<Choice>),
    /// Modules in order.
    Many(Vec<Choice>),
}

/// A picture for a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// PNG or JPEG, relative to the scene's folder.
    File(String),
    /// Already in memory.
    Loaded(Arc<Texture>),
}

impl<'de> Deserialize<'de> for Picture {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer).map(Self::File)
    }
}

impl Choice {
    /// A module of which nothing else is said.
    pub fn new(module: impl Into<String>) -> Self {
        Self {
            module: module.into(),
            ..Self::default()
        }
    }
}

/// What a default says, as a scene would.
impl From<&Node> for Choice {
    fn from(node: &Node) -> Self {
        Self {
            fill: node.fill.iter().map(|(slot, filling)| (slot.clone(), filling.into())).collect(),
            freeze: node.freeze.clone(),
            files: node.files.clone(),
            label: node.label.clone(),
            ..Self::new(node.module.clone())
        }
    }
}

impl From<&Filling> for Choices {
    fn from(filling: &Filling) -> Self {
        match filling {
            Filling::One(node) => Self::One(Box::new(node.into())),
            Filling::Many(nodes) => Self::Many(nodes.iter().map(Choice::from).collect()),
        }
    }
}

impl Choices {
    /// The modules in order.
    pub fn all(&self) -> &[Choice] {
        match self {
            Self::One(one) => std::slice::from_ref(&**one),
            Self::Many(many) => many,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fields {
    module: String,
    #[serde(default)]
    fill: IndexMap<String, Choices>,
    #[serde(default)]
    freeze: IndexMap<String, Value>,
    #[serde(default)]
    params: IndexMap<String, Value>,
    #[serde(default)]
    textures: IndexMap<String, Picture>,
    #[serde(default)]
    files: IndexMap<String, String>,
    #[serde(default)]
    label: Option<String>,
}

impl From<Fields> for Choice {
    fn from(f: Fields) -> Self {
        Self {
            module: f.module,
            fill: f.fill,
            freeze: f.freeze,
            params: f.params,
            textures: f.textures,
            files: f.files,
            label: f.label,
        }
    }
}

impl<'de> Deserialize<'de> for Choice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ChoiceVisitor;
        impl<'de> Visitor<'de> for ChoiceVisitor {
            type Value = Choice;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a module's name, or (module: \"name\", fill: {...}, params: {...})")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<Choice, E> {
                Ok(Choice::new(name))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Choice, A::Error> {
                Fields::deserialize(MapAccessDeserializer::new(map)).map(Choice::from)
            }
        }
        deserializer.deserialize_any(ChoiceVisitor)
    }
}

impl<'de> Deserialize<'de> for Choices {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ChoicesVisitor;
        impl<'de> Visitor<'de> for ChoicesVisitor {
            type Value = Choices;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a module's name, (module: \"name\", ...), or a list of these")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<Choices, E> {
                Ok(Choices::One(Box::new(Choice::new(name))))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Choices, A::Error> {
                Choice::deserialize(MapAccessDeserializer::new(map)).map(|one| Choices::One(Box::new(one)))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Choices, A::Error> {
                let mut many = Vec::new();
                while let Some(choice) = seq.next_element()? {
                    many.push(choice);
                }
                Ok(Choices::Many(many))
            }
        }
        deserializer.deserialize_any(ChoicesVisitor)
    }
}
