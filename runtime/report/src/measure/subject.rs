//! One alternative of an experiment, ready to be evaluated: its formula in any number type, its truth.

use std::cell::RefCell;
use std::collections::HashMap;

use indexmap::IndexMap;
use serde_json::{Map, Value as Json, json};
use shadewright_compiler::catalog::Signature;
use shadewright_compiler::manifest::{ModuleManifest, Node, Param, Typed, Value, typed};
use shadewright_compiler::reflect::{Fill, Layout};
use shadewright_compiler::{Catalog, Recipe};
use shadewright_evaluate::Number;
use shadewright_modules::oracles::{self, At, Truth};
use shadewright_runtime::probe::{Evaluated, Probe, Table};

use super::MeasureError;
use crate::experiment::{Alternative, Domain, Experiment, Metric, Params, TruthSource};

/// An alternative and what it should give.
pub(crate) struct Subject<'a> {
    pub experiment: &'a Experiment,
    pub alternative: &'a Alternative,
    pub probe: Probe,
    pub domain: Domain,
    truth: Against,
    signature: Signature,
    defaults: IndexMap<String, IndexMap<String, Value>>,
    known: &'a Known,
}

/// What an experiment's sampled truth gave, by input.
pub(crate) type Known = RefCell<HashMap<String, Vec<f64>>>;

/// What a subject is compared with.
enum Against {
    Form(Truth),
    Reference { probe: Box<Probe>, is_sampled: bool },
    Itself,
}

impl<'a> Subject<'a> {
    /// Links the alternative and finds its truth.
    ///
    /// # Errors
    /// A recipe cannot be probed.
    pub fn new(
        catalog: &Catalog,
        experiment: &'a Experiment,
        alternative: &'a Alternative,
        known: &'a Known,
    ) -> Result<Self, MeasureError> {
        let function = experiment.function.as_str();
        let probe = Probe::new(catalog, &alternative.recipe, function)?;
        let root = &alternative.root;
        let reference = |node: &Node, is_sampled| -> Result<Against, MeasureError> {
            let probe = Box::new(Probe::new(catalog, &Recipe::from(node.clone()), function)?);
            Ok(Against::Reference { probe, is_sampled })
        };
        let truth = match &experiment.declared.truth {
            TruthSource::Itself => Against::Itself,
            TruthSource::Closed(folder) => oracles::truth(folder, function).map_or(Against::Itself, Against::Form),
            TruthSource::Own => {
                let folder = format!("{}/{}", root.category, root.name);
                oracles::truth(&folder, function).map_or(Against::Itself, Against::Form)
            }
            TruthSource::Reference(node) => reference(node, false)?,
            TruthSource::Sampled(node) => reference(node, true)?,
        };
        let declared = &experiment.declared;
        let varied = (declared.params == Params::Declared).then_some(&root.manifest);
        let mut defaults: IndexMap<String, IndexMap<String, Value>> = IndexMap::new();
        for category in catalog.categories() {
            for (of, members) in &category.manifest.defaults {
                defaults.entry(of.clone()).or_default().extend(members.clone());
            }
        }
        Ok(Self {
            experiment,
            alternative,
            probe,
            domain: Domain::new(&declared.inputs, varied, &alternative.recipe.root.freeze),
            truth,
            signature: catalog.signature(&experiment.category, function)?.unwrap_or_default(),
            defaults,
            known,
        })
    }

    /// How far apart values are.
    pub fn metric(&self) -> &'a Metric {
        &self.experiment.declared.metric
    }

    /// Whether there is something else than its own formula to compare it with.
    pub fn has_truth(&self) -> bool {
        !matches!(self.truth, Against::Itself)
    }

    /// A row as the alternative's probe takes it: what the linked function does not read is left out.
    pub fn fitted(&self, row: &Json) -> Json {
        let mut fitted = read_by(&self.probe, row);
        let known = &self.alternative.root.manifest.params;
        let frozen = &self.alternative.recipe.root.freeze;
        let given = row.get("params").and_then(Json::as_object).into_iter().flatten();
        let kept: Map<_, _> = given
            .filter(|(name, _)| known.contains_key(*name) && !frozen.contains_key(*name))
            .map(|(name, value)| (name.clone(), value.clone()))
            .collect();
        if !kept.is_empty() {
            fitted.insert("params".to_owned(), Json::Object(kept));
        }
        Json::Object(fitted)
    }

    /// Whether the truth is a sum over samples, which may jump, and be off itself.
    pub fn is_sampled(&self) -> bool {
        matches!(self.truth, Against::Reference { is_sampled: true, .. })
    }

    /// Packs rows.
    pub fn table(&self, rows: &[Json]) -> Result<Table, MeasureError> {
        let fitted: Vec<Json> = rows.iter().map(|row| self.fitted(row)).collect();
        Ok(self.probe.table(&fitted)?)
    }

    /// The formula in a number type, on the CPU.
    pub fn formula<N: Number>(&self, rows: &[Json]) -> Result<Evaluated<N>, MeasureError> {
        Ok(self.probe.on_cpu::<N>(&self.table(rows)?)?)
    }

    /// What the rows should give; none where there is no truth but the formula itself.
    ///
    /// # Errors
    /// The truth is not finite somewhere, or has another number of numbers than the function: the experiment is wrong.
    pub fn truth(&self, rows: &[Json]) -> Result<Option<Vec<Vec<f64>>>, MeasureError> {
        let values: Vec<Vec<f64>> = match &self.truth {
            Against::Itself => return Ok(None),
            Against::Form(truth) => rows.iter().map(|row| self.closed(*truth, row)).collect(),
            Against::Reference { probe, is_sampled } => {
                let rows: Vec<Json> = rows.iter().map(|row| Json::Object(read_by(probe, row))).collect();
                match is_sampled {
                    true => self.sampled(probe, &rows)?,
                    false => probe.on_cpu::<f64>(&probe.table(&rows)?)?.values,
                }
            }
        };
        let numbers = self.probe.components().len();
        for (row, value) in rows.iter().zip(&values) {
            let why = if value.len() != numbers {
                format!("has {} numbers, the function {numbers}", value.len())
            } else if value.iter().any(|x| !x.is_finite()) {
                format!("is {value:?}")
            } else {
                continue;
            };
            return Err(MeasureError::Truth {
                experiment: self.experiment.name.clone(),
                label: self.alternative.label.clone(),
                row: row.to_string(),
                why,
            });
        }
        Ok(Some(values))
    }

    /// What a reference gives that is worth remembering: alternatives share their inputs.
    fn sampled(&self, probe: &Probe, rows: &[Json]) -> Result<Vec<Vec<f64>>, MeasureError> {
        let mut known = self.known.borrow_mut();
        let names: Vec<String> = rows.iter().map(Json::to_string).collect();
        let new: IndexMap<&String, &Json> = names.iter().zip(rows).filter(|(name, _)| !known.contains_key(*name)).collect();
        let wanted: Vec<Json> = new.values().map(|row| (*row).clone()).collect();
        if !wanted.is_empty() {
            let values = probe.on_cpu::<f64>(&probe.table(&wanted)?)?.values;
            known.extend(new.into_keys().cloned().zip(values));
        }
        Ok(names.iter().filter_map(|name| known.get(name).cloned()).collect())
    }

    fn closed(&self, truth: Truth, row: &Json) -> Vec<f64> {
        let mut inputs = Map::new();
        for (name, ty) in &self.signature.arguments {
            inputs.insert(name.clone(), self.complete(ty, row.get(name), None));
        }
        let manifest = &self.alternative.root.manifest;
        let instances: Vec<Json> = match row.get("instances") {
            Some(Json::Array(list)) => list.iter().map(|given| instance(manifest, given)).collect(),
            _ => vec![instance(manifest, &Json::Null)],
        };
        let frozen = &self.alternative.recipe.root.freeze;
        let params = filled(&manifest.params, |name| {
            let given = row.get("params").and_then(|params| params.get(name)).and_then(as_value);
            frozen.get(name).cloned().or(given)
        });
        truth(&At {
            inputs: &Json::Object(inputs),
            params: &params,
            instances: &instances,
        })
    }

    /// A value of a type with what it leaves out filled in, as the probe does it: by the interface's default, else by zero.
    fn complete(&self, ty: &str, given: Option<&Json>, default: Option<&Value>) -> Json {
        let Some(members) = self.signature.structs.get(ty) else {
            let value = given.cloned().or_else(|| default.map(numbers_of));
            return value.unwrap_or_else(|| zero(ty));
        };
        let defaults = self.defaults.get(ty);
        let member = |(name, ty): (&String, &String)| {
            let given = given.and_then(|given| given.get(name));
            let default = defaults.and_then(|defaults| defaults.get(name));
            (name.clone(), self.complete(ty, given, default))
        };
        Json::Object(members.iter().map(member).collect())
    }
}

/// The arguments and instances of a row that a probe's function reads. Parameters are each recipe's own.
fn read_by(probe: &Probe, row: &Json) -> Map<String, Json> {
    let layout = probe.input().and_then(|(_, layout)| layout.element.as_deref());
    let bindings = &probe.program().reflection().bindings;
    let reads_instances = bindings.iter().any(|binding| matches!(binding.fill, Fill::Instances { .. }));
    let mut read = Map::new();
    for (name, value) in row.as_object().into_iter().flatten() {
        let member = || layout.and_then(|l| l.members.iter().find(|m| m.name == *name));
        match name.as_str() {
            "params" => {}
            "instances" if reads_instances => {
                read.insert(name.clone(), value.clone());
            }
            "instances" => {}
            _ => {
                if let Some(member) = member() {
                    read.insert(name.clone(), only_read(&member.layout, value));
                }
            }
        }
    }
    read
}

/// The members of a value that a layout has.
fn only_read(layout: &Layout, value: &Json) -> Json {
    match value {
        Json::Object(given) if !layout.members.is_empty() => {
            let members = layout.members.iter();
            let read = members.filter_map(|m| Some((m.name.clone(), only_read(&m.layout, given.get(&m.name)?))));
            Json::Object(read.collect())
        }
        // A struct of which nothing is read.
        Json::Object(_) => json!({}),
        _ => value.clone(),
    }
}

fn instance(manifest: &ModuleManifest, given: &Json) -> Json {
    filled(&manifest.instances, |name| given.get(name).and_then(as_value))
}

/// Parameters by name: what is given, else the default, as the numbers that a device gets.
fn filled(params: &IndexMap<String, Param>, given: impl Fn(&str) -> Option<Value>) -> Json {
    let value = |(name, param): (&String, &Param)| {
        let value = given(name).unwrap_or_else(|| param.default.clone());
        // What does not fit is found by the probe, which gets the same value; a truth sees no number there.
        let json = typed(param, &value).map_or(Json::Null, json_of);
        (name.clone(), json)
    };
    Json::Object(params.iter().map(value).collect())
}

fn json_of(value: Typed) -> Json {
    let list = |numbers: &[f32]| numbers.iter().map(|x| json!(f64::from(*x))).collect();
    match value {
        Typed::Bool(b) => json!(b),
        Typed::F32(x) => json!(f64::from(x)),
        Typed::U32(x) => json!(x),
        Typed::I32(x) => json!(x),
        Typed::Vec2(v) => list(&v),
        Typed::Vec3(v) => list(&v),
        Typed::Vec4(v) => list(&v),
    }
}

fn as_value(json: &Json) -> Option<Value> {
    serde_json::from_value(json.clone()).ok()
}

fn numbers_of(value: &Value) -> Json {
    match value {
        Value::Number(x) => json!(f64::from(*x as f32)),
        Value::List(list) => list.iter().map(|x| json!(f64::from(*x as f32))).collect(),
        Value::Bool(b) => json!(b),
        Value::Text(text) => json!(text),
    }
}

/// Zero of a scalar, vector or matrix type as written in WGSL.
fn zero(ty: &str) -> Json {
    let size = ty
        .strip_prefix("vec")
        .and_then(|rest| rest.chars().next())
        .and_then(|c| c.to_digit(10));
    match size {
        Some(size) => Json::Array(vec![json!(0.0); size as usize]),
        None => json!(0.0),
    }
}
