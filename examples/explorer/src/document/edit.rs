//! Edits of a scene's text: values set, modules chosen, parameters frozen.

use serde::Serialize;
use shadewright_compiler::Report;
use shadewright_compiler::manifest::Value;

use super::Draft;

/// A module on the way to a choice that the scene may not name: it stands there by a default.
#[derive(Clone, Debug, PartialEq)]
pub struct Ancestor {
    /// Its path in the scene.
    pub path: String,
    /// RON of it, as the default has it.
    pub text: String,
}

impl Draft {
    /// Puts a value at a path. Defaults on the way are written out first, outermost first.
    ///
    /// # Errors
    /// The path leads nowhere, or what comes out is no scene.
    pub fn set(&mut self, above: &[Ancestor], path: &str, value: &str) -> Result<(), Report> {
        self.write_out(above)?;
        self.scene = self.scene.set(path, value)?;
        Ok(())
    }

    /// Writes out defaults, outermost first.
    pub(super) fn write_out(&mut self, above: &[Ancestor]) -> Result<(), Report> {
        for default in above {
            if self.scene.get(&default.path).is_none() {
                self.scene = self.scene.set(&default.path, &default.text)?;
            }
        }
        Ok(())
    }

    /// Takes what stands at a path away, if something does.
    ///
    /// # Errors
    /// What is left is no scene.
    pub fn unset(&mut self, path: &str) -> Result<(), Report> {
        if self.scene.get(path).is_some() {
            self.scene = self.scene.unset(path)?;
        }
        Ok(())
    }

    /// Makes a parameter a constant of the shader with its present value, or a uniform again.
    ///
    /// # Errors
    /// As for [`Draft::set`].
    pub fn freeze(&mut self, above: &[Ancestor], module: &str, name: &str, freeze: bool, value: &Value) -> Result<(), Report> {
        let (from, to) = if freeze { ("params", "freeze") } else { ("freeze", "params") };
        self.unset(&format!("{module}.{from}{}", step_path(name)))?;
        self.set(above, &format!("{module}.{to}{}", step_path(name)), &ron_of(value))
    }
}

/// A value as RON.
pub fn ron_of(value: &impl Serialize) -> String {
    // Numbers, strings, lists and maps with string keys always have a RON form.
    ron::to_string(value).unwrap_or_default()
}

/// A name as RON: in quotes.
pub fn quoted(name: &str) -> String {
    format!("\"{}\"", name.escape_default())
}

/// A name as a step of a path: `.name`, or `[two words]`.
pub fn step_path(name: &str) -> String {
    let plain = !name.is_empty() && !name.contains(['.', '[', ']', ' ', '"']);
    if plain { format!(".{name}") } else { format!("[{name}]") }
}
