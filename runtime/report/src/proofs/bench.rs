//! Values of modules' functions on a device, over rows that are given as columns.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use glam::DVec3;
use serde_json::{Map, Value as Json, json};
use shadewright_compiler::manifest::{Node, ParamType, Value};
use shadewright_compiler::{Catalog, Module, Recipe};
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::gpu::pipeline::Pipelines;
use shadewright_runtime::probe::{Probe, Table};

use crate::measure::MeasureError;

/// Most rows that are in memory at a time.
const CHUNK: usize = 1 << 17;

/// A library's modules on a device, or on the evaluator.
pub struct Bench<'a> {
    pub(super) catalog: &'a Catalog,
    device: Option<(&'a Gpu, Pipelines)>,
    probes: RefCell<HashMap<String, Rc<Probe>>>,
}

impl<'a> Bench<'a> {
    /// Nothing is linked yet. Without a device functions are evaluated in f32 on the CPU.
    pub fn new(catalog: &'a Catalog, gpu: Option<&'a Gpu>) -> Self {
        Self {
            catalog,
            device: gpu.map(|gpu| (gpu, Pipelines::new(gpu, None))),
            probes: RefCell::default(),
        }
    }

    /// The device's name and driver.
    pub fn device(&self) -> String {
        self.device
            .as_ref()
            .map_or_else(|| "evaluator, f32".to_owned(), |(gpu, _)| gpu.name())
    }

    pub(super) fn probe(&self, node: &Node, function: &str) -> Result<Rc<Probe>, MeasureError> {
        let recipe = Recipe::from(node.clone());
        let key = format!("{function} {}", json!(node));
        if let Some(probe) = self.probes.borrow().get(&key) {
            return Ok(Rc::clone(probe));
        }
        let probe = Rc::new(Probe::new(self.catalog, &recipe, function)?);
        self.probes.borrow_mut().insert(key, Rc::clone(&probe));
        Ok(probe)
    }

    /// The numbers of each row's result, row by row.
    pub(super) fn values(&self, node: &Node, function: &str, rows: &Rows) -> Result<Vec<Vec<f64>>, MeasureError> {
        let probe = self.probe(node, function)?;
        let base = Json::Object(rows.base.clone());
        let mut values = Vec::with_capacity(rows.len());
        for start in (0..rows.len()).step_by(CHUNK) {
            let end = rows.len().min(start + CHUNK);
            let columns: Vec<(&str, &[f32])> = rows
                .columns
                .iter()
                .map(|(name, column)| (name.as_str(), &column[start..end]))
                .collect();
            let table = probe.varied(&base, &columns)?;
            values.extend(match &self.device {
                Some((gpu, pipelines)) => probe.on_gpu(pipelines, gpu, &table)?,
                None => on_cpu(&probe, &table)?,
            });
        }
        Ok(values)
    }

    /// The first number of each row's result.
    pub(super) fn numbers(&self, node: &Node, function: &str, rows: &Rows) -> Result<Vec<f64>, MeasureError> {
        let first = |value: Vec<f64>| value.first().copied().unwrap_or(f64::NAN);
        Ok(self.values(node, function, rows)?.into_iter().map(first).collect())
    }

    /// The result of each row as a vector.
    pub(super) fn vectors(&self, node: &Node, function: &str, rows: &Rows) -> Result<Vec<DVec3>, MeasureError> {
        Ok(self.values(node, function, rows)?.iter().map(|value| vector(value)).collect())
    }
}

/// The numbers of each row's result on the evaluator, in f32.
fn on_cpu(probe: &Probe, table: &Table) -> Result<Vec<Vec<f64>>, MeasureError> {
    let values = probe.on_cpu::<f32>(table)?.values;
    Ok(values.into_iter().map(|row| row.into_iter().map(f64::from).collect()).collect())
}

/// A result of three numbers.
pub(super) fn vector(value: &[f64]) -> DVec3 {
    let at = |index: usize| value.get(index).copied().unwrap_or(f64::NAN);
    DVec3::new(at(0), at(1), at(2))
}

/// Rows: what they share, and columns of what they do not.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    base: Map<String, Json>,
    columns: Vec<(String, Vec<f32>)>,
}

impl Rows {
    /// Rows that share a surface.
    pub fn new(surface: &Json) -> Self {
        Self::default().sharing("s", surface.clone())
    }

    /// The same with a shared argument more.
    pub fn sharing(mut self, name: &str, value: Json) -> Self {
        self.base.insert(name.to_owned(), value);
        self
    }

    /// The same with a vector for each row.
    pub fn vectors(mut self, name: &str, vectors: impl Iterator<Item = DVec3> + Clone) -> Self {
        if !name.contains('.') {
            self.base.insert(name.to_owned(), json!([0, 0, 1]));
        }
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            self.columns
                .push((format!("{name}.{letter}"), vectors.clone().map(|v| v[axis] as f32).collect()));
        }
        self
    }

    /// The same with a number in [0, 1)^2 for each row.
    pub fn pairs(mut self, name: &str, pairs: &[[f32; 2]]) -> Self {
        self.base.insert(name.to_owned(), json!([0, 0]));
        for (axis, letter) in ["x", "y"].into_iter().enumerate() {
            self.columns
                .push((format!("{name}.{letter}"), pairs.iter().map(|p| p[axis]).collect()));
        }
        self
    }

    /// The same with a number for each row.
    pub fn numbers(mut self, name: &str, numbers: impl Iterator<Item = f64>) -> Self {
        if !name.contains('.') {
            self.base.insert(name.to_owned(), json!(0));
        }
        self.columns.push((name.to_owned(), numbers.map(|x| x as f32).collect()));
        self
    }

    /// All of them on the evaluator, in f32.
    pub fn evaluate(&self, probe: &Probe) -> Result<Vec<Vec<f64>>, MeasureError> {
        let columns: Vec<(&str, &[f32])> = self.columns.iter().map(|(name, column)| (name.as_str(), &column[..])).collect();
        on_cpu(probe, &probe.varied(&Json::Object(self.base.clone()), &columns)?)
    }

    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |(_, column)| column.len())
    }
}

/// A surface whose normal is z and whose tangent is x; what lies on it and below it is as rough.
pub(super) fn surface(alpha: f64, widths: [f64; 2], f0: [f64; 3], diffuse: [f64; 3]) -> Json {
    json!({
        "alpha": alpha, "widths": widths, "f0": f0, "diffuse": diffuse, "normal": [0, 0, 1], "tangent": [1, 0, 0],
        "diffuse_roughness": alpha.sqrt(), "coat_alpha": alpha, "fuzz_roughness": alpha.sqrt(),
    })
}

/// The module with its defaults, and with each number among its parameters at either end of its range: what is said of it holds there too.
pub(super) fn variants(module: &Module) -> Vec<(String, Node)> {
    let plain = Node::new(format!("{}/{}", module.category, module.name));
    let mut found = vec![(String::new(), plain.clone())];
    for (name, param) in &module.manifest.params {
        let (Some((low, high)), ParamType::F32) = (param.range, param.ty) else {
            continue;
        };
        for value in [low, high] {
            let mut node = plain.clone();
            node.freeze.insert(name.clone(), Value::Number(value));
            found.push((format!("{name} {value}"), node));
        }
    }
    found
}
