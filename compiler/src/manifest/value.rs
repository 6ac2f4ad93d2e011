//! Values that people wrote, turned into constants of a parameter's type.

use std::fmt::Write;
use std::ops::Range;
use std::sync::Arc;

use serde_json::json;
use thiserror::Error;

use super::temperature::{DAYLIGHT, KELVIN, black_body, daylight};
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
    /// A colour temperature that daylight does not have.
    #[error("daylight of {0} K is outside {lo} to {hi} K", lo = DAYLIGHT.start(), hi = DAYLIGHT.end())]
    BadDaylight(f64),
    /// A luminous efficacy that no light has.
    #[error("an efficacy of {0} lm/W is outside 0 to {MAX_EFFICACY} lm/W")]
    BadEfficacy(f64),
}

/// Luminous efficacy of light of 540 THz, of which there is no larger one but by a rounding (definition of the candela), lm/W.
pub const MAX_EFFICACY: f64 = 683.0;

impl ValueError {
    /// Its code among [`codes`].
    pub fn code(&self) -> &'static str {
        match self {
            Self::WrongType { .. } => codes::PARAM_WRONG_TYPE,
            Self::OutOfRange { .. } | Self::BadEfficacy(_) => codes::PARAM_OUT_OF_RANGE,
            Self::UnknownUnit { .. } => codes::UNKNOWN_UNIT,
            Self::NotFinite(_) => codes::PARAM_NOT_FINITE,
            Self::BadTemperature(_) | Self::BadDaylight(_) => codes::BAD_TEMPERATURE,
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
            Self::UnknownUnit { found: unit, known } if unit == "W" && known.iter().any(|unit| unit == "lm") => {
                found.note("how much light a watt gives is the lamp's efficacy: write it as `60 W at 15 lm/W`")
            }
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
                let colour = match quantity(text) {
                    Some((kelvin, "K")) => black_body(kelvin).ok_or(ValueError::BadTemperature(kelvin))?,
                    Some((kelvin, "K daylight")) => daylight(kelvin).ok_or(ValueError::BadDaylight(kelvin))?,
                    Some((_, unit)) => {
                        return Err(ValueError::UnknownUnit {
                            found: unit.to_owned(),
                            known: vec!["K".to_owned(), "K daylight".to_owned()],
                        });
                    }
                    None => return Err(wrong_type(param, value)),
                };
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

/// A power in watt with the efficacy that makes light of it, `60 W at 15 lm/W`, as a flux in lumen; anything else as it is.
fn luminous(number: f64, unit: &str) -> Result<(f64, &str), ValueError> {
    let efficacy = unit.strip_prefix("W at ").and_then(quantity);
    match efficacy {
        Some((efficacy, "lm/W")) if (0.0..=MAX_EFFICACY).contains(&efficacy) => Ok((number * efficacy, "lm")),
        Some((efficacy, "lm/W")) => Err(ValueError::BadEfficacy(efficacy)),
        _ => Ok((number, unit)),
    }
}

/// The number in the parameter's unit, not yet checked.
fn scalar(param: &Param, value: &Value) -> Result<f64, ValueError> {
    match value {
        Value::Number(number) => Ok(*number),
        Value::Text(text) => {
            let (number, unit) = quantity(text).ok_or_else(|| wrong_type(param, value))?;
            let (number, unit) = luminous(number, unit)?;
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
mod tests;
