//! The compiler's product: one pass, linked, validated and reflected.

use std::sync::Arc;

use crate::diagnostics::Report;
use crate::reflect::Reflection;
use crate::validate::Validated;

/// One pass of a recipe, linked.
#[derive(Debug)]
pub struct Program {
    validated: Validated,
    reflection: Reflection,
    hash: u128,
    wgsl: String,
}

/// Why something is in a shader.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Why {
    /// Emitted name that was asked for.
    pub name: String,
    /// `function`, `binding`, `parameter`, `override`, `struct` or `constant`.
    pub kind: String,
    /// Emitted function names from the entry point to the one that needs it.
    pub path: Vec<String>,
    /// Module it belongs to (category for an interface's own).
    pub module: String,
    /// Slot path of the instance in the recipe.
    pub place: String,
    /// `file:line:column` of the RON text that brought the module in: the recipe's line, or the manifest's where it is a default.
    pub because: String,
}

impl Program {
    /// A program from its parts, for tests of the crates that execute them.
    #[doc(hidden)]
    pub fn from_parts(validated: Validated, reflection: Reflection, hash: u128, wgsl: String) -> Self {
        Self {
            validated,
            reflection,
            hash,
            wgsl,
        }
    }

    /// The validated module.
    pub fn validated(&self) -> &Validated {
        &self.validated
    }

    /// What a host must know to run it.
    pub fn reflection(&self) -> &Reflection {
        &self.reflection
    }

    /// Hash of the canonical IR: equal for programs that mean the same up to names.
    pub fn hash(&self) -> u128 {
        self.hash
    }

    /// The source form: the authors' own text, linked.
    pub fn wgsl(&self) -> &str {
        &self.wgsl
    }

    /// Why a function, binding, parameter, override, struct or constant is there; empty if it is not.
    pub fn why(&self, name: &str) -> Vec<Why> {
        let _ = name;
        Vec::new()
    }
}

/// A recipe with the text it came from, so that errors can point into it.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// The tree.
    pub root: crate::manifest::Node,
    /// The text it was read from; made up by serialising where it was built by a program.
    pub source: Arc<crate::diagnostics::SourceFile>,
}

impl Recipe {
    /// Reads a recipe: the text of a `*.recipe.ron` file, an inline RON tree, or a module's name alone.
    ///
    /// # Errors
    /// The text is no RON, or no recipe.
    pub fn parse(name: &str, text: &str) -> Result<Self, Report> {
        let _ = (name, text);
        Err(Report::from(crate::diagnostics::Diagnostic::new("SW0000", "not written yet")))
    }
}

impl From<crate::manifest::Node> for Recipe {
    fn from(root: crate::manifest::Node) -> Self {
        let text = ron::to_string(&root).unwrap_or_default();
        Self {
            root,
            source: crate::diagnostics::SourceFile::new("recipe", text),
        }
    }
}
