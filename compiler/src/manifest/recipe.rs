//! Recipes: trees of chosen modules with frozen parameters.

use std::path::Path;

use indexmap::IndexMap;
use serde::de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize};

use super::Filling;

/// One module of a recipe, with what fills its slots.
///
/// In RON either the module's name alone, `"ggx"`, or
/// `(module: "microfacet", fill: {"ndf": "ggx"}, freeze: {"x": 0.5}, label: "coat")`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Node {
    /// Name of the module, or `category/name` where the name alone is not unique.
    pub module: String,
    /// What stands in its slots; a slot not named here has its default.
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    pub fill: IndexMap<String, Filling>,
    /// Parameters that become constants, with their values.
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    pub freeze: IndexMap<String, Value>,
    /// Files by the name of the module's resource, for resources that take files of whoever uses the module. The compiler does not read them.
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    pub files: IndexMap<String, String>,
    /// Keeps this subtree apart from an equal one, so that both have parameters of their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

impl Node {
    /// A node that names a module and says nothing else.
    pub fn new(module: impl Into<String>) -> Self {
        Self {
            module: module.into(),
            fill: IndexMap::new(),
            freeze: IndexMap::new(),
            files: IndexMap::new(),
            label: None,
        }
    }

    /// Puts a folder before the relative paths of all files that the tree names.
    pub fn files_below(&mut self, folder: &Path) {
        for file in self.files.values_mut() {
            *file = folder.join(&*file).to_string_lossy().into_owned();
        }
        for filling in self.fill.values_mut() {
            match filling {
                Filling::One(node) => node.files_below(folder),
                Filling::Many(nodes) => nodes.iter_mut().for_each(|node| node.files_below(folder)),
            }
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NodeFields {
    module: String,
    #[serde(default)]
    fill: IndexMap<String, Filling>,
    #[serde(default)]
    freeze: IndexMap<String, Value>,
    #[serde(default)]
    files: IndexMap<String, String>,
    #[serde(default)]
    label: Option<String>,
}

impl<'de> Deserialize<'de> for Node {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NodeVisitor;
        impl<'de> Visitor<'de> for NodeVisitor {
            type Value = Node;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a module's name, or (module: \"name\", fill: {...}, freeze: {...})")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<Node, E> {
                Ok(Node::new(name))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Node, A::Error> {
                let NodeFields {
                    module,
                    fill,
                    freeze,
                    files,
                    label,
                } = NodeFields::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Node {
                    module,
                    fill,
                    freeze,
                    files,
                    label,
                })
            }
        }
        deserializer.deserialize_any(NodeVisitor)
    }
}

impl<'de> Deserialize<'de> for Filling {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FillingVisitor;
        impl<'de> Visitor<'de> for FillingVisitor {
            type Value = Filling;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a module's name, (module: \"name\", ...), or a list of these")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<Filling, E> {
                Ok(Filling::One(Node::new(name)))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Filling, A::Error> {
                Node::deserialize(MapAccessDeserializer::new(map)).map(Filling::One)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Filling, A::Error> {
                let mut nodes = Vec::new();
                while let Some(node) = seq.next_element()? {
                    nodes.push(node);
                }
                Ok(Filling::Many(nodes))
            }
        }
        deserializer.deserialize_any(FillingVisitor)
    }
}

/// A parameter's value as written by a person.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// `true`, `false`
    Bool(bool),
    /// A number in the parameter's unit.
    Number(f64),
    /// A number with a unit, `"800 lm"`, or a colour temperature, `"2700 K"`.
    Text(String),
    /// Components of a vector or colour, `(0.5, 0.5, 0.5)` or `[0.5, 0.5, 0.5]`.
    List(Vec<f64>),
}

impl<'de> Deserialize<'de> for Value {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ValueVisitor;
        impl<'de> Visitor<'de> for ValueVisitor {
            type Value = Value;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a number, a boolean, a quantity with its unit in quotes, or a tuple of numbers")
            }
            fn visit_bool<E: de::Error>(self, v: bool) -> Result<Value, E> {
                Ok(Value::Bool(v))
            }
            fn visit_f64<E: de::Error>(self, v: f64) -> Result<Value, E> {
                Ok(Value::Number(v))
            }
            fn visit_i64<E: de::Error>(self, v: i64) -> Result<Value, E> {
                Ok(Value::Number(v as f64))
            }
            fn visit_u64<E: de::Error>(self, v: u64) -> Result<Value, E> {
                Ok(Value::Number(v as f64))
            }
            fn visit_str<E: de::Error>(self, v: &str) -> Result<Value, E> {
                Ok(Value::Text(v.to_owned()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Value, A::Error> {
                let mut list = Vec::new();
                while let Some(component) = seq.next_element()? {
                    list.push(component);
                }
                Ok(Value::List(list))
            }
        }
        deserializer.deserialize_any(ValueVisitor)
    }
}
