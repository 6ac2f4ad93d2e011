//! `cases.ron`: inputs of a module's functions, with the values that they must give.
//!
//! A file holds a list of [`Case`]s. Each is evaluated on the device by probing the module alone:
//!
//! ```ron
//! [
//!     (
//!         function: "distribution",
//!         inputs: {"s": {"alpha": 0.002025}, "h": (0.0, 0.0, 1.0)},
//!         expect: 77624.72457,
//!         relative: 1e-5,
//!         source: "Walter et al. 2007, eq. 33, evaluated in double precision",
//!     ),
//! ]
//! ```

use indexmap::IndexMap;
use ron::extensions::Extensions;
use serde::{Deserialize, Serialize};
use shadewright_compiler::manifest::{Filling, Value};

/// One input of a module's function and what it must give.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Function of the module's interface.
    pub function: String,
    /// Parameters of the module; the others have their defaults.
    #[serde(default)]
    pub params: IndexMap<String, Value>,
    /// What stands in the module's slots; the others have their defaults.
    #[serde(default)]
    pub fill: IndexMap<String, Filling>,
    /// Elements of the module's `instances`, field by field; omitted fields have their defaults.
    #[serde(default)]
    pub instances: Vec<IndexMap<String, Value>>,
    /// Arguments of the function by name. Omitted arguments and struct members have the interface's defaults.
    pub inputs: IndexMap<String, Input>,
    /// What the function returns.
    pub expect: Expected,
    /// Largest allowed difference as a share of the expected value, of each component.
    #[serde(default)]
    pub relative: f64,
    /// Largest allowed difference in the unit of the value, added to the relative one.
    #[serde(default)]
    pub absolute: f64,
    /// Where the expected value comes from.
    #[serde(default)]
    pub source: String,
}

/// A value of an argument.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Input {
    /// A number, or the components of a vector.
    Value(Value),
    /// Members of a struct.
    Struct(IndexMap<String, Value>),
}

/// An expected value.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Expected {
    /// A number, or the components of a vector.
    Value(Value),
    /// Some members of a struct; the others may be anything.
    Struct(IndexMap<String, Value>),
}

impl Case {
    /// Whether a component `got` is near enough to the component `expected`.
    pub fn accepts(&self, expected: f64, got: f64) -> bool {
        (got - expected).abs() <= self.absolute + self.relative * expected.abs()
    }
}

/// Reads a `cases.ron`.
///
/// # Errors
/// The text is no RON, says something unknown, or has a case without a tolerance. The message has line and column where known.
pub fn parse(text: &str) -> Result<Vec<Case>, String> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    let cases: Vec<Case> = options.from_str(text).map_err(|e| e.to_string())?;
    for (i, case) in cases.iter().enumerate() {
        if !(case.relative > 0.0 || case.absolute > 0.0) {
            return Err(format!("case {i} (`{}`) has neither `relative` nor `absolute`", case.function));
        }
    }
    Ok(cases)
}

#[cfg(test)]
mod tests;
