//! wesl: imports resolved on syntax trees, text out. It parses every module anew for every shader; it has no cache of parsed modules.

use wesl::{ModulePath, VirtualResolver, Wesl};

use crate::pieces::Piece;

/// A compiler over the modules, and the path of the shader itself.
pub struct Compiler {
    wesl: Wesl<VirtualResolver<'static>>,
    root: ModulePath,
}

impl Compiler {
    /// Writes the modules' sources with wesl's imports.
    ///
    /// With `checks` it is wesl as it comes: validation, and a source map for good errors. Without them it is as fast as it gets.
    ///
    /// # Errors
    /// A piece's name is no path.
    pub fn new(pieces: &[Piece], checks: bool) -> Result<Self, String> {
        let mut resolver = VirtualResolver::new();
        for piece in pieces {
            let mut text = String::new();
            for (module, names) in &piece.imports {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                text.push_str(&format!("import package::{module}::{{{}}};\n", names.join(", ")));
            }
            text.push('\n');
            text.push_str(&piece.text());
            resolver.add_module(path(&piece.name)?, text.into());
        }
        let options = wesl::CompileOptions {
            validate: checks,
            ..Default::default()
        };
        let mut wesl = Wesl::new("").set_custom_resolver(resolver);
        wesl.set_options(options).use_sourcemap(checks);
        let root = pieces.last().ok_or("no pieces")?;
        Ok(Self {
            wesl,
            root: path(&root.name)?,
        })
    }

    /// The shader's text.
    ///
    /// # Errors
    /// wesl refuses a module.
    pub fn text(&self) -> Result<String, String> {
        let compiled = self.wesl.compile(&self.root).map_err(|error| error.to_string())?;
        Ok(compiled.to_string())
    }
}

fn path(name: &str) -> Result<ModulePath, String> {
    format!("package::{name}")
        .parse()
        .map_err(|_| format!("`{name}` is no path of wesl's"))
}
