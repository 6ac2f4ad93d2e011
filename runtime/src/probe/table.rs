//! Rows of JSON as bytes, in batches that one dispatch can take.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use serde_json::{Map, Value as Json};
use shadewright_compiler::catalog::Catalog;
use shadewright_compiler::manifest::Value;
use shadewright_compiler::reflect::{BindingType, Fill, Layout, ParamPlace, ParamUse, Reflection};

use super::numbers::Number;
use crate::gpu::DataError;
use crate::gpu::pack::{Defaults, pack, unknown};
use crate::gpu::pipeline::Constants;
use crate::gpu::resources::{constants, fields_of, instance_rows, param_blocks};

/// Rows of inputs, packed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    bytes: Vec<u8>,
    stride: usize,
    len: usize,
    batches: Vec<Batch>,
}

/// Rows that share parameters and instances, and so a pipeline and its bindings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Batch {
    /// Contents of the uniform buffers by bind group and binding; zeros where no parameter is.
    pub blocks: BTreeMap<(u32, u32), Vec<u8>>,
    /// Values of the overridable constants that the rows set, by name.
    pub constants: Constants,
    /// Contents of the instance buffers by bind group and binding.
    pub instances: BTreeMap<(u32, u32), Vec<u8>>,
    /// Places of the batch's rows in the table, ascending.
    pub rows: Vec<usize>,
}

impl Table {
    /// Rows.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// As many rows as the columns are long, each like the first but for the columns' numbers.
    ///
    /// # Errors
    /// No number has a column's name, or columns differ in length.
    pub(super) fn varied(mut self, numbers: &[Number], columns: &[(&str, &[f32])]) -> Result<Self, DataError> {
        self.len = columns.first().map_or(1, |(_, column)| column.len());
        let first = std::mem::take(&mut self.bytes);
        self.bytes = first.repeat(self.len);
        for &(name, column) in columns {
            let Some(number) = numbers.iter().find(|number| number.name == name) else {
                return Err(unknown(name, "number", "a row", numbers.iter().map(|n| n.name.as_str()), name));
            };
            if column.len() != self.len {
                return Err(DataError::new(name, format!("{} numbers, others have {}", column.len(), self.len)));
            }
            for (row, value) in self.bytes.chunks_mut(self.stride.max(1)).zip(column) {
                if !number.write(row, *value) {
                    return Err(DataError::new(name, "is no f32"));
                }
            }
        }
        for batch in &mut self.batches {
            batch.rows = (0..self.len).collect();
        }
        Ok(self)
    }

    /// A row's arguments: the bytes of its element in the input buffer. Empty where the function reads no argument, or there is no such row.
    pub fn row(&self, row: usize) -> &[u8] {
        self.bytes.get(row * self.stride..(row + 1) * self.stride).unwrap_or_default()
    }

    /// The rows by what they share, in the order of their first rows.
    pub fn batches(&self) -> &[Batch] {
        &self.batches
    }
}

/// Packs rows for a probe's program; `arguments` is the layout of a row's arguments.
///
/// # Errors
/// A row does not fit.
pub(super) fn pack_rows(reflection: &Reflection, arguments: Option<&Layout>, names: &Names, rows: &[Json]) -> Result<Table, DataError> {
    let stride = arguments.map_or(0, |a| a.size as usize);
    let mut bytes = vec![0; stride * rows.len()];
    let mut shared: IndexMap<String, Shared> = IndexMap::new();
    for (i, row) in rows.iter().enumerate() {
        let path = format!("[{i}]");
        let (params, instances) = read_row(row, arguments, &names.defaults, &path, &mut bytes[i * stride..(i + 1) * stride])?;
        let group = shared.entry(format!("{params}{instances}")).or_default();
        if group.rows.is_empty() {
            group.params = resolve_params(&params, reflection, names, &path)?;
            group.instances = instances;
        }
        group.rows.push(i);
    }
    Ok(Table {
        bytes,
        stride,
        len: rows.len(),
        batches: shared
            .into_values()
            .map(|shared| shared.packed(reflection))
            .collect::<Result<_, _>>()?,
    })
}

/// What rows share, as it was given.
#[derive(Default)]
struct Shared {
    params: IndexMap<String, Value>,
    instances: Json,
    rows: Vec<usize>,
}

impl Shared {
    fn packed(self, reflection: &Reflection) -> Result<Batch, DataError> {
        let value = |param: &ParamUse| self.params.get(&format!("{}.{}", param.instance, param.name)).cloned();
        let constants = constants(reflection, value)?;
        let blocks = param_blocks(reflection, value)?.into_iter().collect();
        let buffers = || reflection.bindings.iter().filter(|b| matches!(b.fill, Fill::Instances { .. }));
        let path = format!("[{}].instances", self.rows[0]);
        let mut instances = BTreeMap::new();
        for binding in buffers() {
            if let (Fill::Instances { instance }, BindingType::Storage { layout, .. }) = (&binding.fill, &binding.ty) {
                let rows = rows_of(&self.instances, instance, buffers().count() == 1, &path)?;
                let bytes = instance_rows(layout, fields_of(reflection, instance), &rows, &path)?;
                instances.insert((binding.group, binding.binding), bytes);
            }
        }
        Ok(Batch {
            blocks,
            constants,
            instances,
            rows: self.rows,
        })
    }
}

/// What a table may name beyond what reached the shader.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    /// Defaults of struct members.
    pub defaults: Defaults,
    /// Instance and name of parameters that the modules declare but the function does not read.
    pub unread: Vec<(String, String)>,
}

impl Names {
    /// All that the categories and the program's modules declare.
    pub fn of(catalog: &Catalog, reflection: &Reflection) -> Self {
        let mut names = Self::default();
        for category in catalog.categories() {
            for (of, members) in &category.manifest.defaults {
                names.defaults.entry(of.clone()).or_default().extend(members.clone());
            }
        }
        for instance in &reflection.instances {
            let Ok(module) = catalog.module(&format!("{}/{}", instance.category, instance.module)) else {
                continue;
            };
            for name in module.manifest.params.keys() {
                if !reflection.params.iter().any(|p| p.instance == instance.name && p.name == *name) {
                    names.unread.push((instance.name.clone(), name.clone()));
                }
            }
        }
        names
    }
}

/// Packs a row's arguments into its bytes, and gives its parameters and instances.
fn read_row(row: &Json, arguments: Option<&Layout>, defaults: &Defaults, path: &str, bytes: &mut [u8]) -> Result<(Json, Json), DataError> {
    let Json::Object(row) = row else {
        return Err(DataError::new(path, "expected an object keyed by argument name"));
    };
    let members = arguments.map_or(&[][..], |a| &a.members);
    let mut given = row.clone();
    let params = given.shift_remove("params").unwrap_or(Json::Null);
    let instances = given.shift_remove("instances").unwrap_or(Json::Null);
    if let Some(name) = given.keys().find(|name| !members.iter().any(|m| m.name == **name)) {
        return Err(unknown(
            name,
            "argument",
            "the function",
            members.iter().map(|m| m.name.as_str()),
            path,
        ));
    }
    for member in members.iter().filter(|m| !given.contains_key(&m.name)).collect::<Vec<_>>() {
        if member.layout.members.is_empty() {
            let message = format!("argument `{}` of type {} is missing", member.name, member.layout.ty);
            return Err(DataError::new(path, message));
        }
        given.insert(member.name.clone(), Json::Object(Map::new()));
    }
    if let Some(arguments) = arguments {
        pack(arguments, &Json::Object(given), path, defaults, bytes)?;
    }
    Ok((params, instances))
}

/// Parameters of a row by `instance.name`. A bare name means the root's parameter, or the only one of that name.
fn resolve_params(given: &Json, reflection: &Reflection, names: &Names, path: &str) -> Result<IndexMap<String, Value>, DataError> {
    let path = format!("{path}.params");
    let given = match given {
        Json::Null => return Ok(IndexMap::new()),
        Json::Object(given) => given,
        _ => return Err(DataError::new(path, "expected an object keyed by parameter name")),
    };
    let root = reflection.instances.first().map_or("", |i| i.name.as_str());
    let mut params = IndexMap::new();
    for (name, value) in given {
        let path = format!("{path}.{name}");
        let is_named = |instance: &str, param: &str| *name == param || *name == format!("{instance}.{param}");
        let mut found: Vec<&ParamUse> = reflection.params.iter().filter(|p| is_named(&p.instance, &p.name)).collect();
        if found.len() > 1 && found.iter().any(|p| p.instance == root) {
            found.retain(|p| p.instance == root);
        }
        match found[..] {
            [] if names.unread.iter().any(|(instance, param)| is_named(instance, param)) => {}
            [] => {
                return Err(unknown(
                    name,
                    "parameter",
                    "the recipe",
                    reflection.params.iter().map(|p| p.name.as_str()),
                    &path,
                ));
            }
            [param] => {
                if matches!(param.place, ParamPlace::Constant { .. }) {
                    return Err(DataError::new(
                        path,
                        "is a constant of this recipe; freeze it to another value there",
                    ));
                }
                params.insert(format!("{}.{}", param.instance, param.name), manifest_value(value, &path)?);
            }
            _ => {
                let all: Vec<_> = found.iter().map(|p| format!("`{}.{}`", p.instance, p.name)).collect();
                return Err(DataError::new(path, format!("is one of {}; say which", all.join(", "))));
            }
        }
    }
    Ok(params)
}

fn manifest_value(value: &Json, path: &str) -> Result<Value, DataError> {
    serde_json::from_value(value.clone()).map_err(|error| DataError::new(path, error.to_string()))
}

/// Rows of one instance buffer, from a list, or from an object with a list for each instance of a module.
fn rows_of(given: &Json, instance: &str, only: bool, path: &str) -> Result<Vec<IndexMap<String, Value>>, DataError> {
    let list = match given {
        Json::Null => None,
        Json::Array(list) if only => Some(list),
        Json::Object(by_name) => match by_name.get(instance) {
            None => None,
            Some(Json::Array(list)) => Some(list),
            Some(_) => return Err(DataError::new(format!("{path}.{instance}"), "expected a list of objects")),
        },
        _ if only => return Err(DataError::new(path, "expected a list of objects")),
        _ => {
            return Err(DataError::new(
                path,
                "several modules have instances: expected an object with a list for each",
            ));
        }
    };
    let Some(list) = list else { return Ok(vec![IndexMap::new()]) };
    if list.is_empty() {
        return Err(DataError::new(path, "expected at least one instance"));
    }
    let row = |(i, fields): (usize, &Json)| {
        let path = format!("{path}[{i}]");
        let Json::Object(fields) = fields else {
            return Err(DataError::new(path, "expected an object"));
        };
        let value = |(name, value): (&String, &Json)| Ok((name.clone(), manifest_value(value, &format!("{path}.{name}"))?));
        fields.iter().map(value).collect()
    };
    list.iter().enumerate().map(row).collect()
}
