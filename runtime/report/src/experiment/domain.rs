//! From a point of the unit cube to a configuration.

use glam::DVec3;
use indexmap::IndexMap;
use serde_json::{Map, Value as Json, json};
use shadewright_compiler::manifest::{ModuleManifest, Param, ParamMode, ParamType, Value};

use super::format::Range;

/// How the coordinates of a cube become a row of a probe's table: each input takes as many as its range needs.
#[derive(Clone, Debug, Default)]
pub struct Domain {
    inputs: Vec<(String, Range)>,
    /// Coordinates of the inputs; those of the parameters come after them.
    inputs_end: usize,
    params: Vec<(String, Range)>,
    end: usize,
}

/// A coordinate of the cube.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The input that it belongs to, and what it is of it: `s.alpha`, `h (angle)`.
    pub name: String,
    /// Whether a small step changes the configuration by little.
    pub is_smooth: bool,
    /// What its ends mean, where that is a number.
    pub ends: Option<(f64, f64, bool)>,
}

impl Domain {
    /// Of an experiment's inputs and, if they vary, the parameters of a module that its recipe does not freeze.
    pub fn new(inputs: &IndexMap<String, Range>, params: Option<&ModuleManifest>, frozen: &IndexMap<String, Value>) -> Self {
        let inputs: Vec<_> = inputs.iter().map(|(name, range)| (name.clone(), range.clone())).collect();
        let inputs_end = inputs.iter().map(|(_, range)| coordinates(range)).sum();
        let is_free = |name: &str, param: &Param| {
            param.mode != ParamMode::Constant
                && !frozen.contains_key(name)
                && !inputs.iter().any(|(path, _)| path == &format!("params.{name}"))
        };
        let params: Vec<_> = params
            .into_iter()
            .flat_map(|manifest| &manifest.params)
            .filter(|(name, param)| is_free(name, param))
            .filter_map(|(name, param)| Some((format!("params.{name}"), declared(param)?)))
            .collect();
        let end = inputs_end + params.iter().map(|(_, range)| coordinates(range)).sum::<usize>();
        Self {
            inputs,
            inputs_end,
            params,
            end,
        }
    }

    /// Coordinates of a point.
    pub fn dimensions(&self) -> usize {
        self.end
    }

    /// Those of them that are parameters'.
    pub fn of_params(&self) -> std::ops::Range<usize> {
        self.inputs_end..self.end
    }

    /// The coordinates, in order.
    pub fn axes(&self) -> Vec<Axis> {
        let mut axes = Vec::with_capacity(self.end);
        for (name, range) in self.inputs.iter().chain(&self.params) {
            name_axes(name, range, true, &mut axes);
        }
        axes
    }

    /// The row of a point, every argument as a device gets it.
    pub fn row(&self, point: &[f64]) -> Json {
        let mut point = point.iter().copied();
        let mut drawn = IndexMap::new();
        for (name, range) in self.inputs.iter().chain(&self.params) {
            let value = draw(range, &mut point, &drawn);
            drawn.insert(name.as_str(), value);
        }
        row_of(&drawn)
    }

    /// The row where some inputs are these and the others in the middle of their ranges.
    pub fn row_with(&self, given: &IndexMap<&str, &Range>) -> Json {
        let mut drawn = IndexMap::new();
        for (name, range) in self.inputs.iter().chain(&self.params) {
            let range = given.get(name.as_str()).copied().unwrap_or(range);
            let value = draw(range, &mut std::iter::repeat(0.5), &drawn);
            drawn.insert(name.as_str(), value);
        }
        for (name, range) in given {
            if !drawn.contains_key(name) {
                let value = draw(range, &mut std::iter::repeat(0.5), &drawn);
                drawn.insert(name, value);
            }
        }
        row_of(&drawn)
    }
}

/// How a parameter that declares a range varies.
fn declared(param: &Param) -> Option<Range> {
    let (lo, hi) = param.range?;
    let one = if lo > 0.0 && hi / lo > 1e3 {
        Range::Log(lo, hi)
    } else if lo == 0.0 && hi > 1e3 {
        // 0 itself, which often means "none", and all magnitudes above a thousandth.
        Range::Either(vec![Range::Value(Value::Number(0.0)), Range::Log(1e-3, hi), Range::Log(1e-3, hi)])
    } else {
        Range::Linear(lo, hi)
    };
    let vector = |n: usize| Some(Range::Vector(vec![one.clone(); n]));
    match param.ty {
        ParamType::F32 => Some(one),
        // Ranges of whole numbers are far inside of i64.
        ParamType::U32 | ParamType::I32 => Some(Range::Whole(lo.ceil() as i64, hi.floor() as i64)),
        ParamType::Bool => Some(Range::Choice(vec![Value::Bool(false), Value::Bool(true)])),
        ParamType::Vec2 => vector(2),
        ParamType::Vec3 | ParamType::Color => vector(3),
        ParamType::Vec4 => vector(4),
    }
}

/// Coordinates that a range takes.
pub fn coordinates(range: &Range) -> usize {
    match range {
        Range::Value(_) | Range::Angles(..) | Range::Mirror { .. } | Range::Half(..) => 0,
        Range::Linear(..) | Range::Log(..) | Range::Whole(..) | Range::Choice(_) => 1,
        Range::Vector(parts) => parts.iter().map(coordinates).sum(),
        Range::Sphere | Range::Hemisphere | Range::Lobe(_) => 2,
        Range::Polar(angle) => coordinates(angle) + 1,
        Range::Either(ways) => 1 + ways.iter().map(coordinates).max().unwrap_or(0),
    }
}

fn name_axes(name: &str, range: &Range, smooth: bool, axes: &mut Vec<Axis>) {
    let mut axis = |what: &str, is_smooth: bool, ends: Option<(f64, f64, bool)>| {
        let name = if what.is_empty() {
            name.to_owned()
        } else {
            format!("{name} ({what})")
        };
        axes.push(Axis {
            name,
            is_smooth: is_smooth && smooth,
            ends,
        });
    };
    match range {
        Range::Value(_) | Range::Angles(..) | Range::Mirror { .. } | Range::Half(..) => {}
        Range::Linear(lo, hi) => axis("", true, Some((*lo, *hi, false))),
        Range::Log(lo, hi) => axis("", true, Some((*lo, *hi, true))),
        Range::Whole(lo, hi) => axis("", false, Some((*lo as f64, *hi as f64, false))),
        Range::Choice(_) => axis("choice", false, None),
        Range::Vector(parts) => {
            for (part, of) in parts.iter().zip(["x", "y", "z", "w"]) {
                name_axes(&format!("{name}.{of}"), part, smooth, axes);
            }
        }
        Range::Sphere => {
            axis("cosine to z", true, Some((1.0, -1.0, false)));
            axis("around z, degrees", true, Some((0.0, 360.0, false)));
        }
        Range::Hemisphere => {
            axis("cosine to z", true, Some((1.0, 0.0, false)));
            axis("around z, degrees", true, Some((0.0, 360.0, false)));
        }
        Range::Lobe(width) => {
            axis(&format!("tangent over {width}"), true, Some((1e-3, 1e3, true)));
            axis("around z, degrees", true, Some((0.0, 360.0, false)));
        }
        Range::Polar(angle) => {
            name_axes(&format!("{name} (degrees to z)"), angle, smooth, axes);
            axes.push(Axis {
                name: format!("{name} (around z, degrees)"),
                is_smooth: smooth,
                ends: Some((0.0, 360.0, false)),
            });
        }
        Range::Either(ways) => {
            axis("way", false, None);
            let most = ways.iter().map(coordinates).max().unwrap_or(0);
            for index in 0..most {
                axis(&format!("coordinate {}", index + 1), true, None);
            }
        }
    }
}

/// A value of a range. Coordinates that a range does not use are taken all the same, so that those of the next one stay where they are.
fn draw(range: &Range, point: &mut dyn Iterator<Item = f64>, drawn: &IndexMap<&str, Json>) -> Json {
    let mut next = || point.next().unwrap_or(0.5).clamp(0.0, 1.0);
    match range {
        Range::Value(value) => as_given(value),
        Range::Linear(lo, hi) => json!(lo + (hi - lo) * next()),
        Range::Log(lo, hi) => json!(logarithmic(*lo, *hi, next())),
        Range::Whole(lo, hi) => json!(lo + ((hi - lo + 1) as f64 * next()).floor().min((hi - lo) as f64) as i64),
        Range::Choice(values) => values.get(index(next(), values.len())).map_or(Json::Null, as_given),
        Range::Vector(parts) => parts.iter().map(|part| draw(part, point, drawn)).collect(),
        Range::Sphere => around(1.0 - 2.0 * next(), next()),
        Range::Hemisphere => around(1.0 - next(), next()),
        Range::Angles(theta, phi) => at_degrees(*theta, *phi),
        Range::Polar(angle) => {
            let theta = draw(angle, point, drawn).as_f64().unwrap_or(0.0);
            at_degrees(theta, 360.0 * point.next().unwrap_or(0.5))
        }
        Range::Lobe(width) => {
            let width = drawn.get(width.as_str()).and_then(Json::as_f64).unwrap_or(1.0);
            polar(f64::atan(width * logarithmic(1e-3, 1e3, next())), next() * std::f64::consts::TAU)
        }
        Range::Mirror { of, about } => mirror(drawn.get(of.as_str()), drawn.get(about.as_str())),
        Range::Half(a, b) => half(drawn.get(a.as_str()), drawn.get(b.as_str())),
        Range::Either(ways) => {
            let way = ways.get(index(next(), ways.len()));
            let taken = way.map_or(0, coordinates);
            let value = way.map_or(Json::Null, |way| draw(way, point, drawn));
            for _ in taken..ways.iter().map(coordinates).max().unwrap_or(0) {
                point.next();
            }
            value
        }
    }
}

fn index(u: f64, count: usize) -> usize {
    ((u * count as f64) as usize).min(count.saturating_sub(1))
}

fn logarithmic(lo: f64, hi: f64, u: f64) -> f64 {
    (lo.ln() + (hi.ln() - lo.ln()) * u).exp().clamp(lo.min(hi), hi.max(lo))
}

/// The unit vector with this cosine to +z, turned around it by a share of the circle.
fn around(cosine: f64, turn: f64) -> Json {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (sin_p, cos_p) = (turn * std::f64::consts::TAU).sin_cos();
    // The cosine as it is: 0 is in the horizon.
    vector(DVec3::new(sine * cos_p, sine * sin_p, cosine))
}

fn polar(theta: f64, phi: f64) -> Json {
    vector(DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()))
}

/// A unit vector by degrees to +z and around it. Right angles are exact: the cosine of pi / 2 in double precision is above 0, and so would be
/// a direction that should lie in the horizon.
fn at_degrees(theta: f64, phi: f64) -> Json {
    let turn = |degrees: f64| match (degrees / 90.0).rem_euclid(4.0) {
        0.0 => (0.0, 1.0),
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        3.0 => (-1.0, 0.0),
        _ => degrees.to_radians().sin_cos(),
    };
    let ((sin_t, cos_t), (sin_p, cos_p)) = (turn(theta), turn(phi));
    vector(DVec3::new(sin_t * cos_p, sin_t * sin_p, cos_t))
}

fn direction(json: Option<&Json>) -> DVec3 {
    let component = |i| json.and_then(|v| v.get(i)).and_then(Json::as_f64).unwrap_or(0.0);
    DVec3::new(component(0), component(1), component(2))
}

fn mirror(of: Option<&Json>, about: Option<&Json>) -> Json {
    let (v, h) = (direction(of), direction(about));
    vector(2.0 * v.dot(h) * h - v)
}

fn half(a: Option<&Json>, b: Option<&Json>) -> Json {
    let (a, b) = (direction(a), direction(b));
    vector((a + b).try_normalize().unwrap_or(a))
}

fn vector(v: DVec3) -> Json {
    json!(v.to_array())
}

/// A value with its numbers as a device gets them.
fn rounded(value: &Json) -> Json {
    match value {
        Json::Array(list) => list.iter().map(rounded).collect(),
        Json::Number(number) if number.is_f64() => json!(number.as_f64().map(|x| f64::from(x as f32))),
        other => other.clone(),
    }
}

/// A value as written.
fn as_given(value: &Value) -> Json {
    match value {
        Value::Bool(b) => json!(b),
        Value::Number(x) if x.fract() == 0.0 && x.abs() < 1e15 => json!(*x as i64),
        Value::Number(x) => json!(x),
        Value::List(list) => json!(list),
        Value::Text(text) => json!(text),
    }
}

/// Values by path as a row of a probe's table.
fn row_of(drawn: &IndexMap<&str, Json>) -> Json {
    let mut row = Map::new();
    for (path, value) in drawn.iter().filter(|(path, _)| !path.starts_with('_')) {
        // A parameter is rounded where it is read: rounded before, an end of its range may be outside.
        if let Some(field) = path.strip_prefix("instances.") {
            let list = row.entry("instances").or_insert_with(|| json!([{}]));
            if let Some(instance) = list.get_mut(0) {
                instance[field] = value.clone();
            }
        } else if path.starts_with("params.") {
            put(&mut row, path, value.clone());
        } else {
            put(&mut row, path, rounded(value));
        }
    }
    Json::Object(row)
}

fn put(row: &mut Map<String, Json>, path: &str, value: Json) {
    match path.split_once('.') {
        None => {
            row.insert(path.to_owned(), value);
        }
        Some((first, rest)) => {
            // The checks of the experiment keep a path from going through a number.
            if let Json::Object(inner) = row.entry(first).or_insert_with(|| Json::Object(Map::new())) {
                put(inner, rest, value);
            }
        }
    }
}
