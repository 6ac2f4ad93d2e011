//! Parameters' values, as people write them, as numbers of the unit that the shader sees.

use shadewright_compiler::manifest::{Param, Typed, Value, typed};

use super::DataError;

/// Components of the value in the parameter's own unit; booleans are 0 and 1.
///
/// # Errors
/// The value does not fit the parameter's type, unit or range.
pub fn numbers(param: &Param, value: &Value, path: &str) -> Result<Vec<f64>, DataError> {
    let wide = |list: &[f32]| list.iter().map(|v| f64::from(*v)).collect();
    Ok(
        match typed(param, value).map_err(|error| DataError::new(path, error.to_string()))? {
            Typed::F32(v) => wide(&[v]),
            Typed::U32(v) => vec![v.into()],
            Typed::I32(v) => vec![v.into()],
            Typed::Bool(v) => vec![u8::from(v).into()],
            Typed::Vec2(v) => wide(&v),
            Typed::Vec3(v) => wide(&v),
            Typed::Vec4(v) => wide(&v),
        },
    )
}
