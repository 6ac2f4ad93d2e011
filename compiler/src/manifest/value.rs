//! Values that people wrote, turned into constants of a parameter's type.

use std::fmt::Write;
use std::ops::Range;
use std::sync::Arc;

use serde_json::json;
use thiserror::Error;

use super::temperature::{KELVIN, black_body};
use super::{Param, ParamType, Value};
use crate::diagnostics::{Diagnostic, SourceFile, codes};

/// A constant of a parameter's type. Floats are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Typed {
    /// `f32`
    F32(f32),
    /// `u32`
    U32(u32),
    /// `i32`
    I32(i32),
    /// `bool`
    Bool(bool),
    /// `vec2f`
    Vec2([f32; 2]),
    /// `vec3f`; also a colour, linear Rec.709
    Vec3([f32; 3]),
    /// `vec4f`
    Vec4([f32; 4]),
}

/// Why a value is none of its parameter.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ValueError {
    /// Another type than the parameter's.
    #[error("expected {expected}, found {found}")]
    WrongType {
        /// What the parameter takes, in words.
        expected: String,
        /// What was written, in words.
        found: String,
    },
    /// A component outside the parameter's range.
    #[error("{value}{unit} is outside {lo} to {hi}{unit}")]
    OutOfRange {
        /// The component, in the parameter's unit.
        value: f64,
        /// The parameter's unit with a space before it.
        unit: String,
        /// Lower end.
        lo: f64,
        /// Upper end.
        hi: f64,
    },
    /// A quantity in a unit that the parameter does not take.
    #[error("the unit `{found}` is not taken here")]
    UnknownUnit {
        /// As written.
        found: String,
        /// The parameter's own unit and the others that it takes.
        known: Vec<String>,
    },
    /// NaN, infinite, or too large for `f32`.
    #[error("{0} is not a finite number of 32 bits")]
    NotFinite(f64),
    /// A colour temperature that is not taken.
    #[error("a colour temperature of {0} K is outside {lo} to {hi} K", lo = KELVIN.start(), hi = KELVIN.end())]
    BadTemperature(f64),
}

impl ValueError {
    /// Its code among [`codes`].
    pub fn code(&self) -> &'static str {
        match self {
            Self::WrongType { .. } => codes::PARAM_WRONG_TYPE,
            Self::OutOfRange { .. } => codes::PARAM_OUT_OF_RANGE,
            Self::UnknownUnit { .. } => codes::UNKNOWN_UNIT,
            Self::NotFinite(_) => codes::PARAM_NOT_FINITE,
            Self::BadTemperature(_) => codes::BAD_TEMPERATURE,
        }
    }

    /// The diagnostic for the parameter `name`, whose value is written at `span`.
    pub fn diagnostic(&self, name: &str, file: &Arc<SourceFile>, span: Range<usize>) -> Diagnostic {
        self.diagnostic_as(self.code(), format!("the value of `{name}` does not fit"), file, span)
    }

    /// The same under another code and message: where the value is a default, not a choice.
    pub(super) fn diagnostic_as(&self, code: &'static str, message: String, file: &Arc<SourceFile>, span: Range<usize>) -> Diagnostic {
        let found = Diagnostic::new(code, message).at(file, span, self.to_string());
        match self {
            Self::UnknownUnit { known, .. } if known.is_empty() => found.note("it is a pure number: write it without a unit"),
            Self::UnknownUnit { found: unit, known } => found.suggest(unit, "units", known.iter().map(String::as_str)),
            _ => found,
        }
    }
}

/// The constant that a value stands for.
///
/// # Errors
/// The value is of another type, in another unit, not finite, or out of the parameter's range.
pub fn typed(param: &Param, value: &Value) -> Result<Typed, ValueError> {
    match param.ty {
        ParamType::Bool => match value {
            Value::Bool(b) => Ok(Typed::Bool(*b)),
            _ => Err(wrong_type(param, value)),
        },
        ParamType::F32 => Ok(Typed::F32(float(param, scalar(param, value)?)?)),
        ParamType::U32 => {
            let number = integer(param, value, 0.0, f64::from(u32::MAX))?;
            Ok(Typed::U32(number as u32))
        }
        ParamType::I32 => {
            let number = integer(param, value, f64::from(i32::MIN), f64::from(i32::MAX))?;
            Ok(Typed::I32(number as i32))
        }
        ParamType::Vec2 => vector(param, value).map(Typed::Vec2),
        ParamType::Vec3 => vector(param, value).map(Typed::Vec3),
        ParamType::Vec4 => vector(param, value).map(Typed::Vec4),
        ParamType::Color => match value {
            Value::Text(text) => {
                let kelvin = match quantity(text) {
                    Some((kelvin, "K")) => kelvin,
                    Some((_, unit)) => {
                        return Err(ValueError::UnknownUnit {
                            found: unit.to_owned(),
                            known: vec!["K".to_owned()],
                        });
                    }
                    None => return Err(wrong_type(param, value)),
                };
                let colour = black_body(kelvin).ok_or(ValueError::BadTemperature(kelvin))?;
                vector(param, &Value::List(colour.to_vec())).map(Typed::Vec3)
            }
            _ => vector(param, value).map(Typed::Vec3),
        },
    }
}

/// Number and unit of a quantity, `800 lm`.
fn quantity(text: &str) -> Option<(f64, &str)> {
    let (number, unit) = text.trim().split_once(char::is_whitespace)?;
    Some((number.parse().ok()?, unit.trim()))
}

/// The number in the parameter's unit, not yet checked.
fn scalar(param: &Param, value: &Value) -> Result<f64, ValueError> {
    match value {
        Value::Number(number) => Ok(*number),
        Value::Text(text) => {
            let (number, unit) = quantity(text).ok_or_else(|| wrong_type(param, value))?;
            if unit == param.unit {
                return Ok(number);
            }
            let factor = param.also.get(unit).ok_or_else(|| {
                let own = (!is_pure(&param.unit)).then(|| param.unit.clone());
                ValueError::UnknownUnit {
                    found: unit.to_owned(),
                    known: own.into_iter().chain(param.also.keys().cloned()).collect(),
                }
            })?;
            Ok(number * factor)
        }
        _ => Err(wrong_type(param, value)),
    }
}

fn is_pure(unit: &str) -> bool {
    unit.is_empty() || unit == "1"
}

fn in_range(param: &Param, number: f64) -> Result<f64, ValueError> {
    match param.range {
        _ if !number.is_finite() => Err(ValueError::NotFinite(number)),
        Some((lo, hi)) if !(lo..=hi).contains(&number) => Err(out_of_range(param, number, lo, hi)),
        _ => Ok(number),
    }
}

fn out_of_range(param: &Param, value: f64, lo: f64, hi: f64) -> ValueError {
    let unit = if is_pure(&param.unit) {
        String::new()
    } else {
        format!(" {}", param.unit)
    };
    ValueError::OutOfRange { value, unit, lo, hi }
}

fn float(param: &Param, number: f64) -> Result<f32, ValueError> {
    // The range bounds the number as it was written; the nearest f32 may lie beyond its end by a rounding.
    let rounded = in_range(param, number)? as f32;
    if rounded.is_finite() {
        Ok(rounded)
    } else {
        Err(ValueError::NotFinite(number))
    }
}

fn integer(param: &Param, value: &Value, min: f64, max: f64) -> Result<f64, ValueError> {
    let number = in_range(param, scalar(param, value)?)?;
    if number.fract() != 0.0 {
        return Err(wrong_type(param, value));
    }
    if !(min..=max).contains(&number) {
        return Err(out_of_range(param, number, min, max));
    }
    Ok(number)
}

fn vector<const N: usize>(param: &Param, value: &Value) -> Result<[f32; N], ValueError> {
    let Value::List(list) = value else {
        return Err(wrong_type(param, value));
    };
    let components: &[f64; N] = list.as_slice().try_into().map_err(|_| wrong_type(param, value))?;
    let mut out = [0.0; N];
    for (to, from) in out.iter_mut().zip(components) {
        *to = float(param, *from)?;
    }
    Ok(out)
}

fn wrong_type(param: &Param, value: &Value) -> ValueError {
    let expected = match param.ty {
        ParamType::F32 if is_pure(&param.unit) && param.also.is_empty() => "a number",
        ParamType::F32 => "a number, or a number with its unit in quotes",
        ParamType::U32 => "a whole number from 0",
        ParamType::I32 => "a whole number",
        ParamType::Bool => "true or false",
        ParamType::Vec2 => "two numbers in parentheses",
        ParamType::Vec3 => "three numbers in parentheses",
        ParamType::Vec4 => "four numbers in parentheses",
        ParamType::Color => "three numbers in parentheses, linear Rec.709, or a temperature such as \"2700 K\"",
    };
    let found = match value {
        Value::Bool(b) => b.to_string(),
        Value::Number(number) => number.to_string(),
        Value::Text(text) => format!("the text {text:?}"),
        Value::List(list) => format!("{} numbers", list.len()),
    };
    ValueError::WrongType {
        expected: expected.to_owned(),
        found,
    }
}

impl Typed {
    /// A WGSL expression of exactly this value and type, without an operator outside parentheses or call.
    pub fn wgsl(&self) -> String {
        match self {
            Self::F32(x) if x.is_sign_negative() => format!("({x:?}f)"),
            Self::F32(x) => format!("{x:?}f"),
            Self::U32(n) => format!("{n}u"),
            // The smallest one has no literal of its type: its magnitude is out of range before the sign applies.
            Self::I32(n) if *n < 0 => format!("i32({n})"),
            Self::I32(n) => format!("{n}i"),
            Self::Bool(b) => b.to_string(),
            Self::Vec2(v) => call("vec2f", v),
            Self::Vec3(v) => call("vec3f", v),
            Self::Vec4(v) => call("vec4f", v),
        }
    }

    /// The value's bytes in a buffer, little endian, without padding. A `bool` is a `u32`, as WGSL has none in buffers.
    pub fn bytes(&self) -> Vec<u8> {
        match self {
            Self::F32(x) => x.to_le_bytes().to_vec(),
            Self::U32(n) => n.to_le_bytes().to_vec(),
            Self::I32(n) => n.to_le_bytes().to_vec(),
            Self::Bool(b) => u32::from(*b).to_le_bytes().to_vec(),
            Self::Vec2(v) => v.iter().flat_map(|x| x.to_le_bytes()).collect(),
            Self::Vec3(v) => v.iter().flat_map(|x| x.to_le_bytes()).collect(),
            Self::Vec4(v) => v.iter().flat_map(|x| x.to_le_bytes()).collect(),
        }
    }

    /// A JSON number, boolean or array of numbers. Floats have the fewest digits that read back to the same `f32`.
    pub fn json(&self) -> serde_json::Value {
        let list = |v: &[f32]| serde_json::Value::Array(v.iter().map(|x| shortest(*x)).collect());
        match self {
            Self::F32(x) => shortest(*x),
            Self::U32(n) => json!(n),
            Self::I32(n) => json!(n),
            Self::Bool(b) => json!(b),
            Self::Vec2(v) => list(v),
            Self::Vec3(v) => list(v),
            Self::Vec4(v) => list(v),
        }
    }

    /// The number that a pipeline-overridable constant of this value is given; `None` for vectors.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::F32(x) => Some(f64::from(*x)),
            Self::U32(n) => Some(f64::from(*n)),
            Self::I32(n) => Some(f64::from(*n)),
            Self::Bool(b) => Some(f64::from(u8::from(*b))),
            Self::Vec2(_) | Self::Vec3(_) | Self::Vec4(_) => None,
        }
    }
}

/// A JSON number with the fewest digits that read back to this `f32`; `null` for what is not finite.
pub fn shortest(x: f32) -> serde_json::Value {
    // The decimal digits of the f32, read as f64, print as themselves.
    format!("{x:?}").parse::<f64>().map_or(serde_json::Value::Null, |x| json!(x))
}

fn call(constructor: &str, components: &[f32]) -> String {
    let mut text = format!("{constructor}(");
    for (index, x) in components.iter().enumerate() {
        // Writing to a string does not fail.
        let _ = write!(text, "{}{x:?}f", if index > 0 { ", " } else { "" });
    }
    text + ")"
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::diagnostics::Report;

    fn param(ty: ParamType, unit: &str, range: Option<(f64, f64)>) -> Param {
        Param {
            ty,
            unit: unit.to_owned(),
            also: [("klm".to_owned(), 1000.0), ("mlm".to_owned(), 1e-3)]
                .into_iter()
                .filter(|_| unit == "lm")
                .collect(),
            default: Value::Number(0.0),
            range,
            doc: String::new(),
            mode: crate::manifest::ParamMode::default(),
            role: None,
        }
    }

    fn text(text: &str) -> Value {
        Value::Text(text.to_owned())
    }

    fn rendered(param: &Param, written: &str) -> String {
        let file = SourceFile::new("r", written);
        let value: Value = ron::from_str(written).unwrap();
        let error = typed(param, &value).expect_err(written);
        Report::from(error.diagnostic("p", &file, 0..written.len())).render()
    }

    /// Catches a type that takes another's values, or refuses its own.
    #[test]
    fn types() {
        let plain = |ty| param(ty, "", None);
        assert_eq!(typed(&plain(ParamType::F32), &Value::Number(0.1)), Ok(Typed::F32(0.1)));
        assert_eq!(
            typed(&plain(ParamType::U32), &Value::Number(4294967295.0)),
            Ok(Typed::U32(u32::MAX))
        );
        assert_eq!(
            typed(&plain(ParamType::I32), &Value::Number(-2147483648.0)),
            Ok(Typed::I32(i32::MIN))
        );
        assert_eq!(typed(&plain(ParamType::Bool), &Value::Bool(true)), Ok(Typed::Bool(true)));
        assert_eq!(
            typed(&plain(ParamType::Vec2), &Value::List(vec![1.0, 2.0])),
            Ok(Typed::Vec2([1.0, 2.0]))
        );
        assert_eq!(
            typed(&plain(ParamType::Color), &Value::List(vec![1.0; 3])),
            Ok(Typed::Vec3([1.0; 3]))
        );
        assert_eq!(
            typed(&plain(ParamType::Vec4), &Value::List(vec![1.0; 4])),
            Ok(Typed::Vec4([1.0; 4]))
        );
        for (ty, value) in [
            (ParamType::F32, Value::Bool(true)),
            (ParamType::F32, Value::List(vec![1.0])),
            (ParamType::F32, text("1")),
            (ParamType::F32, text("x lm")),
            (ParamType::U32, Value::Number(0.5)),
            (ParamType::I32, Value::Number(-0.5)),
            (ParamType::Bool, Value::Number(1.0)),
            (ParamType::Vec3, Value::List(vec![1.0, 2.0])),
            (ParamType::Vec3, Value::Number(1.0)),
            (ParamType::Vec3, text("2700 K")),
            (ParamType::Color, text("warm")),
        ] {
            let error = typed(&plain(ty), &value).unwrap_err();
            assert!(
                matches!(error, ValueError::WrongType { .. }) && error.code() == codes::PARAM_WRONG_TYPE,
                "{ty:?} {value:?}"
            );
        }
        assert_eq!(
            typed(&plain(ParamType::U32), &Value::Number(-1.0)).unwrap_err().code(),
            codes::PARAM_OUT_OF_RANGE
        );
        assert_eq!(
            typed(&plain(ParamType::U32), &Value::Number(4294967296.0)).unwrap_err().code(),
            codes::PARAM_OUT_OF_RANGE
        );
    }

    /// Catches a unit that is ignored, or converted the wrong way round.
    #[test]
    fn units() {
        let flux = param(ParamType::F32, "lm", None);
        assert_eq!(typed(&flux, &text("800 lm")), Ok(Typed::F32(800.0)));
        assert_eq!(typed(&flux, &text(" 1.5e1  klm ")), Ok(Typed::F32(15000.0)));
        assert_eq!(typed(&flux, &text("500 mlm")), Ok(Typed::F32(0.5)));
    }

    /// Catches a number that becomes infinite or NaN on its way.
    #[test]
    fn not_finite() {
        let plain = param(ParamType::F32, "lm", None);
        for value in [
            Value::Number(f64::NAN),
            Value::Number(f64::INFINITY),
            Value::Number(1e39),
            text("1e308 klm"),
        ] {
            assert_eq!(typed(&plain, &value).unwrap_err().code(), codes::PARAM_NOT_FINITE, "{value:?}");
        }
        let vector = param(ParamType::Vec2, "", Some((0.0, 1.0)));
        assert_eq!(
            typed(&vector, &Value::List(vec![0.0, f64::NAN])).unwrap_err().code(),
            codes::PARAM_NOT_FINITE
        );
    }

    /// Catches a colour temperature that is read as a colour, or not scaled.
    #[test]
    fn temperature() {
        let Ok(Typed::Vec3([r, g, b])) = typed(&param(ParamType::Color, "", None), &text("2856 K")) else {
            panic!("no colour");
        };
        assert!((r - 1.8448).abs() < 0.02 && (g - 0.8261).abs() < 0.006 && (b - 0.2334).abs() < 0.002);
    }

    /// Catches a message without the value, its bounds or what to write instead. One whole text for each code.
    #[test]
    fn messages() {
        let expected = "\
error[SW0302]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"2 klm\"
  | ^^^^^^^ 2000 lm is outside 0 to 1000 lm
";
        assert_eq!(rendered(&param(ParamType::F32, "lm", Some((0.0, 1000.0))), "\"2 klm\""), expected);
        let expected = "\
error[SW0303]: the value of `p` does not fit
  --> r:1:1
  |
1 | (1, 2)
  | ^^^^^^ expected three numbers in parentheses, linear Rec.709, or a temperature such as \"2700 K\", found 2 numbers
";
        assert_eq!(rendered(&param(ParamType::Color, "", None), "(1, 2)"), expected);
        let expected = "\
error[SW0304]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"2 kml\"
  | ^^^^^^^ the unit `kml` is not taken here
  |
  = did you mean `klm`?
  = units: lm, klm, mlm
";
        assert_eq!(rendered(&param(ParamType::F32, "lm", None), "\"2 kml\""), expected);
        let expected = "\
error[SW0304]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"2 m\"
  | ^^^^^ the unit `m` is not taken here
  |
  = it is a pure number: write it without a unit
";
        assert_eq!(rendered(&param(ParamType::F32, "1", None), "\"2 m\""), expected);
        let expected = "\
error[SW0305]: the value of `p` does not fit
  --> r:1:1
  |
1 | inf
  | ^^^ inf is not a finite number of 32 bits
";
        assert_eq!(rendered(&param(ParamType::F32, "1", Some((0.0, 1.0))), "inf"), expected);
        let expected = "\
error[SW0306]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"27 K\"
  | ^^^^^^ a colour temperature of 27 K is outside 1000 to 40000 K
";
        assert_eq!(rendered(&param(ParamType::Color, "", None), "\"27 K\""), expected);
    }

    fn through_naga(value: Typed) -> Vec<u8> {
        let source = format!("const c = {};", value.wgsl());
        let module = naga::front::wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{source}: {e}"));
        let constant = module.constants.iter().next().unwrap().1;
        fn bytes(module: &naga::Module, at: naga::Handle<naga::Expression>) -> Vec<u8> {
            match &module.global_expressions[at] {
                naga::Expression::Literal(naga::Literal::F32(x)) => x.to_le_bytes().to_vec(),
                naga::Expression::Literal(naga::Literal::U32(n)) => n.to_le_bytes().to_vec(),
                naga::Expression::Literal(naga::Literal::I32(n)) => n.to_le_bytes().to_vec(),
                naga::Expression::Literal(naga::Literal::Bool(b)) => u32::from(*b).to_le_bytes().to_vec(),
                naga::Expression::Compose { components, .. } => components.iter().flat_map(|c| bytes(module, *c)).collect(),
                other => panic!("{other:?}"),
            }
        }
        bytes(&module, constant.init)
    }

    proptest! {
        /// Catches a literal that loses a bit, its type or its sign on the way through naga, or bytes that differ from it.
        #[test]
        fn wgsl_and_bytes_round_trip(bits: [u32; 4], small: bool) {
            let f = bits.map(|b| if small { (b as f32) / 4096.0 - 5e5 } else { f32::from_bits(b) }).map(|x| if x.is_finite() { x } else { -0.0 });
            for value in [
                Typed::F32(f[0]), Typed::U32(bits[0]), Typed::I32(bits[1] as i32), Typed::Bool(small),
                Typed::Vec2([f[0], f[1]]), Typed::Vec3([f[0], f[1], f[2]]), Typed::Vec4(f),
            ] {
                prop_assert_eq!(through_naga(value), value.bytes(), "{}", value.wgsl());
            }
            let json = serde_json::to_string(&Typed::F32(f[0]).json()).unwrap();
            prop_assert_eq!(serde_json::from_str::<f64>(&json).unwrap() as f32, f[0]);
        }
    }

    /// Catches the extremes that random bits rarely hit, and a JSON number with a tail of digits.
    #[test]
    fn extremes() {
        for x in [0.0, -0.0, f32::MIN_POSITIVE, 1e-45, f32::MAX, f32::MIN, 1.0, 16777216.0] {
            assert_eq!(through_naga(Typed::F32(x)), x.to_le_bytes());
        }
        for n in [i32::MIN, -1, 0, i32::MAX] {
            assert_eq!(through_naga(Typed::I32(n)), n.to_le_bytes());
        }
        assert_eq!(Typed::Vec2([0.1, 3.0]).json().to_string(), "[0.1,3.0]");
    }
}
