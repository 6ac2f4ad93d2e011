//! Typed values into bytes and back, by reflected layout. No offset is written down here: all come from the compiler.

use indexmap::IndexMap;
use serde_json::Value as Json;
use shadewright_compiler::diagnostics::nearest;
use shadewright_compiler::manifest::Value;
use shadewright_compiler::reflect::Layout;

use super::DataError;

/// Values of struct members that the input leaves out: struct, then member. What is not here is zero.
pub type Defaults = IndexMap<String, IndexMap<String, Value>>;

/// Scalar types that a buffer can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    F32,
    U32,
    I32,
}

/// A scalar, vector (one column) or matrix; every scalar is four bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shape {
    pub scalar: Scalar,
    pub rows: usize,
    pub columns: usize,
}

impl Shape {
    pub fn of(ty: &str) -> Option<Self> {
        let (head, inner) = match ty.strip_suffix('>').and_then(|t| t.split_once('<')) {
            Some((head, inner)) => (head, inner),
            None => ("", ty),
        };
        let scalar = match inner {
            "f32" => Scalar::F32,
            "u32" => Scalar::U32,
            "i32" => Scalar::I32,
            _ => return None,
        };
        let (rows, columns) = match head {
            "" | "atomic" => (1, 1),
            "vec2" => (2, 1),
            "vec3" => (3, 1),
            "vec4" => (4, 1),
            _ => {
                let (columns, rows) = head.strip_prefix("mat")?.split_once('x')?;
                (rows.parse().ok()?, columns.parse().ok()?)
            }
        };
        Some(Self { scalar, rows, columns })
    }

    /// Byte of a component: the columns of a matrix are aligned as vectors, so those of three rows have a hole.
    pub fn offset(self, component: usize) -> usize {
        let column = match self.rows {
            3 => 16,
            rows => rows * 4,
        };
        component / self.rows * column + component % self.rows * 4
    }
}

/// Bytes of a value of this layout, with this many elements in its runtime-sized array, if it has one.
pub fn size_with(layout: &Layout, elements: usize) -> u64 {
    let elements = elements as u64;
    if let Some(last) = layout.members.last()
        && is_open(&last.layout)
    {
        let end = u64::from(last.offset) + size_with(&last.layout, 1) * elements;
        return end.next_multiple_of(u64::from(layout.align.max(1)));
    }
    match layout.stride {
        Some(stride) if is_open(layout) => u64::from(stride) * elements,
        _ => u64::from(layout.size),
    }
}

/// Whether the layout is a runtime-sized array itself.
fn is_open(layout: &Layout) -> bool {
    layout.element.is_some() && layout.count.is_none()
}

/// Writes numbers into the bytes of a scalar, vector or matrix, matrices column by column.
///
/// # Errors
/// Another count of numbers than the type has components, a number that the type cannot hold, or a type that is none of these.
pub fn put_numbers(layout: &Layout, numbers: &[f64], path: &str, bytes: &mut [u8]) -> Result<(), DataError> {
    let shape = Shape::of(&layout.ty).ok_or_else(|| DataError::new(path, format!("expected {}, found numbers", layout.ty)))?;
    if numbers.len() != shape.rows * shape.columns {
        let expected = shape.rows * shape.columns;
        return Err(DataError::new(
            path,
            format!("{} has {expected} components, found {}", layout.ty, numbers.len()),
        ));
    }
    for (i, &number) in numbers.iter().enumerate() {
        let word = word(shape.scalar, number).ok_or_else(|| DataError::new(path, format!("{number:?} does not fit {}", layout.ty)))?;
        let at = shape.offset(i);
        bytes
            .get_mut(at..at + 4)
            .ok_or_else(|| DataError::new(path, "outside of its buffer"))?
            .copy_from_slice(&word);
    }
    Ok(())
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the ranges are checked
fn word(scalar: Scalar, number: f64) -> Option<[u8; 4]> {
    let integral = number.fract() == 0.0;
    match scalar {
        Scalar::F32 => {
            let short = number as f32;
            (short.is_finite() || !number.is_finite()).then_some(short.to_le_bytes())
        }
        Scalar::U32 => (integral && (0.0..=f64::from(u32::MAX)).contains(&number)).then_some((number as u32).to_le_bytes()),
        Scalar::I32 => (integral && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&number)).then_some((number as i32).to_le_bytes()),
    }
}

/// Writes the members of a struct that the host fills: `value` gives the numbers of each.
///
/// # Errors
/// The struct has a member that the host does not know, or knows with another type.
pub fn put_members(layout: &Layout, path: &str, bytes: &mut [u8], value: impl Fn(&str) -> Option<Vec<f64>>) -> Result<(), DataError> {
    for member in &layout.members {
        let path = format!("{path}.{}", member.name);
        let numbers = value(&member.name).ok_or_else(|| DataError::new(&path, "is not known to the host"))?;
        let rest = bytes
            .get_mut(member.offset as usize..)
            .ok_or_else(|| DataError::new(&path, "outside of its buffer"))?;
        put_numbers(&member.layout, &numbers, &path, rest)?;
    }
    Ok(())
}

/// Writes a JSON value: structs as objects, vectors and arrays as arrays, matrices as arrays of columns. Members that an
/// object leaves out have their default, else zero. `bytes` starts zeroed.
///
/// # Errors
/// The value does not have the layout's shape; the error's path begins with `path`.
pub fn pack(layout: &Layout, value: &Json, path: &str, defaults: &Defaults, bytes: &mut [u8]) -> Result<(), DataError> {
    if !layout.members.is_empty() {
        return pack_struct(layout, value, path, defaults, bytes);
    }
    if let (Some(element), Some(stride)) = (&layout.element, layout.stride) {
        let Json::Array(items) = value else {
            return Err(DataError::new(
                path,
                format!("expected a list for {}, found {}", layout.ty, kind(value)),
            ));
        };
        if let Some(count) = layout.count
            && items.len() != count as usize
        {
            return Err(DataError::new(path, format!("expected {count} elements, found {}", items.len())));
        }
        for (i, item) in items.iter().enumerate() {
            let path = format!("{path}[{i}]");
            let rest = bytes
                .get_mut(i * stride as usize..)
                .ok_or_else(|| DataError::new(&path, "outside of its buffer"))?;
            pack(element, item, &path, defaults, rest)?;
        }
        return Ok(());
    }
    let mut numbers = Vec::new();
    flatten(value, path, &mut numbers)?;
    put_numbers(layout, &numbers, path, bytes)
}

fn pack_struct(layout: &Layout, value: &Json, path: &str, defaults: &Defaults, bytes: &mut [u8]) -> Result<(), DataError> {
    let Json::Object(given) = value else {
        return Err(DataError::new(
            path,
            format!("expected an object for {}, found {}", layout.ty, kind(value)),
        ));
    };
    let own_defaults = defaults.get(&layout.ty);
    for name in given.keys() {
        let known = layout.members.iter().any(|m| m.name == *name) || own_defaults.is_some_and(|d| d.contains_key(name));
        if !known {
            return Err(unknown(
                name,
                "member",
                &layout.ty,
                layout.members.iter().map(|m| m.name.as_str()),
                path,
            ));
        }
    }
    for member in &layout.members {
        let path = format!("{path}.{}", member.name);
        let rest = bytes
            .get_mut(member.offset as usize..)
            .ok_or_else(|| DataError::new(&path, "outside of its buffer"))?;
        if let Some(value) = given.get(&member.name) {
            pack(&member.layout, value, &path, defaults, rest)?;
        } else if let Some(default) = own_defaults.and_then(|d| d.get(&member.name)) {
            put_numbers(&member.layout, &numbers_of(default, &path)?, &path, rest)?;
        } else if !member.layout.members.is_empty() {
            pack_struct(&member.layout, &Json::Object(serde_json::Map::new()), &path, defaults, rest)?;
        }
    }
    Ok(())
}

/// An error that names the nearest of the names that exist.
pub(crate) fn unknown<'a>(name: &str, kind: &str, of: &str, names: impl Iterator<Item = &'a str>, path: &str) -> DataError {
    let names: Vec<_> = names.collect();
    let hint = match nearest(name, names.iter().copied()) {
        Some(nearest) => format!("; did you mean `{nearest}`?"),
        None if names.is_empty() => "; there are none".to_owned(),
        None => format!("; there are {}", names.join(", ")),
    };
    DataError::new(path, format!("{of} has no {kind} `{name}`{hint}"))
}

fn kind(value: &Json) -> String {
    match value {
        Json::Null => "null".into(),
        Json::Bool(_) => "a boolean".into(),
        Json::Number(n) => format!("the number {n}"),
        Json::String(s) => format!("the text {s:?}"),
        Json::Array(a) => format!("a list of {}", a.len()),
        Json::Object(_) => "an object".into(),
    }
}

/// Numbers of a manifest's value.
fn numbers_of(value: &Value, path: &str) -> Result<Vec<f64>, DataError> {
    Ok(match value {
        Value::Bool(b) => vec![f64::from(u8::from(*b))],
        Value::Number(n) => vec![*n],
        Value::List(list) => list.clone(),
        Value::Text(text) => return Err(DataError::new(path, format!("the default {text:?} is no number"))),
    })
}

/// A JSON number, its spelled-out special values, or lists of them (columns of a matrix), in order.
fn flatten(value: &Json, path: &str, numbers: &mut Vec<f64>) -> Result<(), DataError> {
    match value {
        Json::Number(n) => numbers.push(n.as_f64().unwrap_or(f64::NAN)),
        Json::Bool(b) => numbers.push(f64::from(u8::from(*b))),
        Json::String(s) if s == "NaN" => numbers.push(f64::NAN),
        Json::String(s) if s == "Infinity" => numbers.push(f64::INFINITY),
        Json::String(s) if s == "-Infinity" => numbers.push(f64::NEG_INFINITY),
        Json::Array(items) => {
            for (i, item) in items.iter().enumerate() {
                flatten(item, &format!("{path}[{i}]"), numbers)?;
            }
        }
        other => return Err(DataError::new(path, format!("expected a number, found {}", kind(other)))),
    }
    Ok(())
}

/// Reads bytes as JSON, in the form that [`pack`] takes. An f32 is written with the fewest digits that read back as the same f32.
pub fn unpack(layout: &Layout, bytes: &[u8]) -> Json {
    if !layout.members.is_empty() {
        let member = |m: &shadewright_compiler::reflect::Member| {
            let rest = bytes.get(m.offset as usize..).unwrap_or_default();
            (m.name.clone(), unpack(&m.layout, rest))
        };
        return Json::Object(layout.members.iter().map(member).collect());
    }
    if let (Some(element), Some(stride)) = (&layout.element, layout.stride) {
        let stride = stride.max(1) as usize;
        let count = layout.count.map_or(bytes.len() / stride, |c| c as usize);
        return Json::Array(
            (0..count)
                .map(|i| unpack(element, bytes.get(i * stride..).unwrap_or_default()))
                .collect(),
        );
    }
    let Some(shape) = Shape::of(&layout.ty) else { return Json::Null };
    let component = |i: usize| {
        let at = shape.offset(i);
        bytes
            .get(at..)
            .and_then(|rest| rest.first_chunk::<4>())
            .map_or(Json::Null, |word| number(shape.scalar, *word))
    };
    let column = |c: usize| Json::Array((0..shape.rows).map(|r| component(c * shape.rows + r)).collect());
    match (shape.rows, shape.columns) {
        (1, 1) => component(0),
        (_, 1) => column(0),
        (_, columns) => Json::Array((0..columns).map(column).collect()),
    }
}

fn number(scalar: Scalar, word: [u8; 4]) -> Json {
    match scalar {
        Scalar::U32 => u32::from_le_bytes(word).into(),
        Scalar::I32 => i32::from_le_bytes(word).into(),
        Scalar::F32 => {
            let value = f32::from_le_bytes(word);
            if value.is_nan() {
                "NaN".into()
            } else if value.is_infinite() {
                if value > 0.0 { "Infinity" } else { "-Infinity" }.into()
            } else {
                // The f64 nearest to the f32's shortest decimal form prints as that form, and rounds back to the f32.
                value.to_string().parse::<f64>().map_or(Json::Null, Json::from)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::testing::layout_of;
    use serde_json::json;

    const SOURCE: &str = "
        struct Inner { a: f32, b: vec3<f32> }
        struct Outer { m: mat3x3<f32>, inner: array<Inner, 2>, n: vec2<i32>, u: u32, list: array<vec3<f32>> }
        @group(0) @binding(0) var<storage, read> data: Outer;
        @compute @workgroup_size(1) fn main() { _ = data.u; }";

    fn defaults() -> Defaults {
        let inner = IndexMap::from([("b".to_owned(), Value::List(vec![7.0, 8.0, 9.0]))]);
        IndexMap::from([("Inner".to_owned(), inner)])
    }

    /// Catches a wrong offset, stride or matrix column, in either direction alone: the bytes are compared with WGSL's rules.
    #[test]
    fn nested_value_has_wgsl_layout_and_comes_back() {
        let layout = layout_of(SOURCE, "data");
        assert_eq!(size_with(&layout, 2), 160);
        let value = json!({
            "m": [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]],
            "inner": [{"a": 0.1, "b": [1.0, "NaN", "-Infinity"]}, {"a": -0.0, "b": [1e-40, 3.4028235e38, 16777217]}],
            "n": [-1, 2147483647], "u": 4294967295u32, "list": [[1.5, 2.5, 3.5], [4.5, 5.5, 6.5]],
        });
        let mut bytes = vec![0; 160];
        pack(&layout, &value, "x", &defaults(), &mut bytes).unwrap();
        let f = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!(
            [f(0), f(8), f(12), f(16), f(40)],
            [1.0, 3.0, 0.0, 4.0, 9.0],
            "columns of mat3x3 stand 16 apart"
        );
        assert_eq!([f(48), f(64), f(80), f(96)], [0.1, 1.0, -0.0, 1e-40], "Inner is 32 bytes, b at 16");
        assert_eq!(bytes[112..124], [255, 255, 255, 255, 255, 255, 255, 127, 255, 255, 255, 255]);
        assert_eq!([f(128), f(136), f(144), f(152)], [1.5, 3.5, 4.5, 6.5], "list at 128, stride 16");
        let mut expected = value;
        expected["inner"][1]["b"][2] = json!(16777216.0);
        let back = unpack(&layout, &bytes);
        assert_eq!(back.to_string(), expected.to_string());
    }

    /// Catches defaults that are dropped, and zeros put where there is a default.
    #[test]
    fn omitted_members_have_defaults_else_zero() {
        let layout = layout_of(SOURCE, "data");
        let mut bytes = vec![0; 128];
        pack(&layout, &json!({"inner": [{}, {"a": 2}], "list": []}), "x", &defaults(), &mut bytes).unwrap();
        let back = unpack(&layout, &bytes);
        assert_eq!(
            back["inner"],
            json!([{"a": 0.0, "b": [7.0, 8.0, 9.0]}, {"a": 2.0, "b": [7.0, 8.0, 9.0]}])
        );
        assert_eq!(back["u"], json!(0));
    }

    /// Catches errors without a path, and bad input that is taken silently.
    #[test]
    fn errors_name_the_place() {
        let layout = layout_of(SOURCE, "data");
        let fail = |value: Json| {
            let mut bytes = vec![0; 256];
            pack(&layout, &value, "[3].s", &defaults(), &mut bytes).unwrap_err().to_string()
        };
        assert_eq!(
            fail(json!({"inner": [{"a": 1}, {"aa": 1}]})),
            "[3].s.inner[1]: Inner has no member `aa`; did you mean `a`?"
        );
        assert_eq!(fail(json!({"inner": [{}]})), "[3].s.inner: expected 2 elements, found 1");
        assert_eq!(fail(json!({"u": -1})), "[3].s.u: -1.0 does not fit u32");
        assert_eq!(fail(json!({"u": 1.5})), "[3].s.u: 1.5 does not fit u32");
        assert_eq!(fail(json!({"n": [1, 2, 3]})), "[3].s.n: vec2<i32> has 2 components, found 3");
        assert_eq!(fail(json!({"m": {"x": 1}})), "[3].s.m: expected a number, found an object");
        assert_eq!(
            fail(json!({"list": [[1, null, 2]]})),
            "[3].s.list[0][1]: expected a number, found null"
        );
        assert_eq!(fail(json!({"inner": [{"a": 1e39}, {}]})), "[3].s.inner[0].a: 1e39 does not fit f32");
        assert_eq!(fail(json!([])), "[3].s: expected an object for Outer, found a list of 0");
    }

    /// Catches f32 printed as f64, or with too few digits.
    #[test]
    fn every_f32_round_trips_through_text() {
        let layout = Layout {
            ty: "f32".into(),
            size: 4,
            align: 4,
            members: vec![],
            element: None,
            stride: None,
            count: None,
        };
        assert_eq!(unpack(&layout, &0.1f32.to_le_bytes()).to_string(), "0.1");
        let mut bits = 1u32;
        for _ in 0..20_000 {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let value = f32::from_bits(bits);
            if value.is_finite() {
                let text = unpack(&layout, &bits.to_le_bytes()).to_string();
                let mut bytes = [0; 4];
                pack(&layout, &serde_json::from_str(&text).unwrap(), "x", &Defaults::new(), &mut bytes).unwrap();
                assert_eq!(u32::from_le_bytes(bytes), bits, "{text}");
            }
        }
    }
}
