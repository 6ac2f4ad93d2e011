//! Parameters' values, as people write them, as numbers of the unit that the shader sees.

use shadewright_compiler::manifest::{Param, ParamType, Value};

use super::DataError;

/// Components of the value in the parameter's own unit.
///
/// # Errors
/// The value does not fit the parameter's type, unit or range.
pub fn numbers(param: &Param, value: &Value, path: &str) -> Result<Vec<f64>, DataError> {
    let wrong = |message: String| DataError::new(path, message);
    let list = match value {
        Value::Bool(b) => vec![f64::from(u8::from(*b))],
        Value::Number(n) => vec![*n],
        Value::List(list) => list.clone(),
        Value::Text(text) => {
            let (number, unit) = text
                .split_once(' ')
                .ok_or_else(|| wrong(format!("expected a number with its unit, found {text:?}")))?;
            let number: f64 = number.parse().map_err(|_| wrong(format!("{number:?} is no number")))?;
            let factor = if unit == param.unit { Some(&1.0) } else { param.also.get(unit) };
            vec![number * factor.ok_or_else(|| wrong(format!("expected the unit {}, found {unit}", param.unit)))?]
        }
    };
    let components = match param.ty {
        ParamType::F32 | ParamType::U32 | ParamType::I32 | ParamType::Bool => 1,
        ParamType::Vec2 => 2,
        ParamType::Vec3 | ParamType::Color => 3,
        ParamType::Vec4 => 4,
    };
    if list.len() != components {
        return Err(wrong(format!("expected {components} components, found {}", list.len())));
    }
    if let Some((low, high)) = param.range
        && let Some(outside) = list.iter().find(|n| !(low..=high).contains(n))
    {
        return Err(wrong(format!("expected {low} to {high}, found {outside}")));
    }
    Ok(list)
}
