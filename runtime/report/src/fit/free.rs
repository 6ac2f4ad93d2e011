//! What of a model is free, as numbers from 0 to 1.

use serde_json::{Map, Value as Json, json};
use shadewright_compiler::catalog::Signature;
use shadewright_compiler::manifest::{ParamType, Value};
use shadewright_compiler::reflect::{Layout, ParamPlace};
use shadewright_runtime::probe::Probe;

use super::Subject;
use crate::data::Fitted;

/// A free number or vector.
#[derive(Clone, Debug)]
struct Variable {
    name: String,
    place: Place,
    components: usize,
    low: f64,
    high: f64,
    /// Where the search begins, component by component, from 0 to 1.
    start: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Place {
    /// A member of an argument, or an argument.
    Input(Vec<String>),
    /// A parameter by instance and name.
    Param(String),
}

impl Variable {
    fn is_logarithmic(&self) -> bool {
        self.low > 0.0 && self.high / self.low > 1e3
    }

    fn value(&self, unit: f64) -> f64 {
        if self.is_logarithmic() {
            (self.low * (self.high / self.low).powf(unit)).clamp(self.low, self.high)
        } else {
            self.low + (self.high - self.low) * unit
        }
    }

    fn unit(&self, value: f64) -> f64 {
        let unit = if self.is_logarithmic() {
            (value.max(self.low) / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        unit.clamp(0.0, 1.0)
    }
}

/// All that is free of a model.
#[derive(Clone, Debug)]
pub struct Variables(Vec<Variable>);

impl Variables {
    /// Of a linked function: the members among those declared that it reads, and its parameters that are floats with a range.
    pub fn of(subject: &Subject, probe: &Probe) -> Self {
        let mut variables = Vec::new();
        let read = probe.input().and_then(|(_, layout)| layout.element.as_deref());
        for (path, (low, high)) in &subject.declared.free {
            let steps: Vec<String> = path.split('.').map(str::to_owned).collect();
            let is_read = read.is_some_and(|layout| reads(layout, &steps));
            let components = type_of(&subject.signature, path).and_then(components);
            if let Some(components) = components.filter(|_| is_read) {
                variables.push(Variable {
                    name: path.clone(),
                    place: Place::Input(steps),
                    components,
                    low: *low,
                    high: *high,
                    start: vec![0.5; components],
                });
            }
        }
        let reflection = probe.program().reflection();
        for param in &reflection.params {
            let components = match param.ty {
                ParamType::F32 => 1,
                ParamType::Vec2 => 2,
                ParamType::Vec3 | ParamType::Color => 3,
                ParamType::Vec4 => 4,
                ParamType::U32 | ParamType::I32 | ParamType::Bool => continue,
            };
            let (Some((low, high)), ParamPlace::Uniform { .. }) = (param.declared.range, &param.place) else {
                continue;
            };
            let key = format!("{}.{}", param.instance, param.name);
            let is_unique = reflection.params.iter().filter(|other| other.name == param.name).count() == 1;
            let mut variable = Variable {
                name: if is_unique { param.name.clone() } else { key.clone() },
                place: Place::Param(key),
                components,
                low,
                high,
                start: Vec::new(),
            };
            variable.start = (0..components)
                .map(|i| variable.unit(default(&param.declared.default, i)))
                .collect();
            variables.push(variable);
        }
        Self(variables)
    }

    /// Free numbers.
    pub fn len(&self) -> usize {
        self.0.iter().map(|variable| variable.components).sum()
    }

    /// Drops what is not read: those that may have any value and change nothing. `is_same` says whether two points do.
    ///
    /// # Errors
    /// Those of `is_same`.
    pub fn drop_unread<E>(&mut self, points: &[Vec<f64>], mut is_same: impl FnMut(&[f64], &[f64]) -> Result<bool, E>) -> Result<(), E> {
        let mut first = 0;
        let mut kept = Vec::new();
        for variable in &self.0 {
            let own = first..first + variable.components;
            first = own.end;
            let mut is_read = false;
            for point in points {
                let mut pair = [point.clone(), point.clone()];
                pair[0][own.clone()].fill(0.3);
                pair[1][own.clone()].fill(0.7);
                is_read = is_read || !is_same(&pair[0], &pair[1])?;
            }
            kept.push(is_read);
        }
        let mut kept = kept.into_iter();
        self.0.retain(|_| kept.next().unwrap_or(true));
        Ok(())
    }

    /// Where the search begins: parameters as they are by default, all else in the middle of its range.
    pub fn start(&self) -> Vec<f64> {
        self.0.iter().flat_map(|variable| variable.start.clone()).collect()
    }

    /// Writes values into a probe's row.
    pub fn write(&self, point: &[f64], row: &mut Map<String, Json>) {
        let mut rest = point;
        for variable in &self.0 {
            let (own, others) = rest.split_at(variable.components.min(rest.len()));
            rest = others;
            let value = json_of(own.iter().map(|unit| variable.value(*unit)));
            match &variable.place {
                Place::Input(steps) => put(row, steps, value),
                Place::Param(key) => put(row, &["params".to_owned(), key.clone()], value),
            }
        }
    }

    /// What they are at a point, for people.
    pub fn fitted(&self, point: &[f64]) -> Vec<Fitted> {
        let mut rest = point;
        let mut fitted = Vec::new();
        for variable in &self.0 {
            let (own, others) = rest.split_at(variable.components.min(rest.len()));
            rest = others;
            fitted.push(Fitted {
                name: variable.name.clone(),
                values: own.iter().map(|unit| variable.value(*unit)).collect(),
                range: [variable.low, variable.high],
                at_end: own.iter().any(|unit| *unit <= 0.0 || *unit >= 1.0),
            });
        }
        fitted
    }
}

/// Puts a value into nested objects.
fn put(object: &mut Map<String, Json>, steps: &[String], value: Json) {
    match steps {
        [] => {}
        [last] => {
            object.insert(last.clone(), value);
        }
        [first, rest @ ..] => {
            if let Json::Object(inner) = object.entry(first.clone()).or_insert_with(|| json!({})) {
                put(inner, rest, value);
            }
        }
    }
}

fn json_of(mut numbers: impl ExactSizeIterator<Item = f64>) -> Json {
    match (numbers.len(), numbers.next()) {
        (1, Some(one)) => json!(one),
        (_, first) => first.into_iter().chain(numbers).collect(),
    }
}

fn default(value: &Value, component: usize) -> f64 {
    match value {
        Value::Number(x) => *x,
        Value::List(list) => list.get(component).copied().unwrap_or(0.0),
        Value::Bool(_) | Value::Text(_) => 0.0,
    }
}

/// Whether a layout has what the steps lead to.
fn reads(layout: &Layout, steps: &[String]) -> bool {
    let Some((first, rest)) = steps.split_first() else { return true };
    let member = layout.members.iter().find(|member| member.name == *first);
    member.is_some_and(|member| reads(&member.layout, rest))
}

/// The type at a path of a function's arguments.
pub fn type_of<'s>(signature: &'s Signature, path: &str) -> Option<&'s str> {
    let mut steps = path.split('.');
    let first = signature.arguments.get(steps.next()?)?;
    steps.try_fold(first.as_str(), |ty, step| signature.structs.get(ty)?.get(step).map(String::as_str))
}

/// How many floats a scalar or vector type of WGSL has.
pub fn components(ty: &str) -> Option<usize> {
    match ty.replace(' ', "").as_str() {
        "f32" => Some(1),
        "vec2f" | "vec2<f32>" => Some(2),
        "vec3f" | "vec3<f32>" => Some(3),
        "vec4f" | "vec4<f32>" => Some(4),
        _ => None,
    }
}
