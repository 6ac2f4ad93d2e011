//! naga_oil: a composer that keeps every module's IR and builds new shaders against their headers.

use std::collections::BTreeSet;

use naga::valid::Capabilities;
use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor};

use crate::pieces::Piece;

/// The modules' sources with naga_oil's imports, imported ones first; the last is the shader itself.
#[derive(Clone, Debug)]
pub struct Sources(Vec<(String, String)>);

impl Sources {
    /// Writes the sources.
    pub fn new(pieces: &[Piece]) -> Self {
        let last = pieces.len().saturating_sub(1);
        let source = |(index, piece): (usize, &Piece)| {
            let mut text = String::new();
            if index < last {
                text.push_str(&format!("#define_import_path {}\n", piece.name));
            }
            for (module, names) in &piece.imports {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                text.push_str(&format!("#import {module}::{{{}}}\n", names.join(", ")));
            }
            text.push('\n');
            text.push_str(&piece.text());
            (piece.name.clone(), text)
        };
        let pieces = without_digits(pieces);
        Self(pieces.iter().enumerate().map(source).collect())
    }

    /// A composer that knows every module but the shader itself.
    ///
    /// # Errors
    /// naga_oil refuses a module.
    pub fn composer(&self, validating: bool) -> Result<Composer, String> {
        // Not by `with_capabilities`, which builds a whole composer, regular expressions and all, once more.
        let mut composer = Composer::default();
        composer.validate = validating;
        composer.capabilities = Capabilities::all();
        let modules = self.0.split_last().map_or(&[][..], |(_, modules)| modules);
        for (name, source) in modules {
            let added = composer.add_composable_module(ComposableModuleDescriptor {
                source,
                file_path: name,
                ..Default::default()
            });
            if let Err(error) = added.map(drop) {
                return Err(error.emit_to_string(&composer));
            }
        }
        Ok(composer)
    }

    /// The shader, from a composer of [`Sources::composer`]. The first call builds the modules, later ones find them built.
    ///
    /// # Errors
    /// naga_oil refuses a module or the shader.
    pub fn make(&self, composer: &mut Composer) -> Result<naga::Module, String> {
        let (name, source) = self.0.last().ok_or("no sources")?;
        let made = composer.make_naga_module(NagaModuleDescriptor {
            source,
            file_path: name,
            ..Default::default()
        });
        made.map_err(|error| error.emit_to_string(composer))
    }
}

/// naga_oil takes no member's name that naga would write otherwise, as it does with those that end in a digit: they get a letter more.
fn without_digits(pieces: &[Piece]) -> Vec<Piece> {
    let mut pieces = pieces.to_vec();
    let structs = pieces.iter().flat_map(|piece| &piece.items).filter(|item| item.is_struct);
    let members: BTreeSet<String> = structs
        .flat_map(|item| item.text.lines())
        .filter_map(|line| line.trim().split_once(':'))
        .map(|(name, _)| name.to_owned())
        .filter(|name| name.ends_with(|c: char| c.is_ascii_digit()) && name.chars().all(is_word))
        .collect();
    for item in pieces.iter_mut().flat_map(|piece| &mut piece.items) {
        for member in &members {
            item.text = with_word(&item.text, member, &format!("{member}_n"));
        }
    }
    pieces
}

fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The text with one word in place of another.
fn with_word(text: &str, word: &str, new: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(word) {
        let end = at + word.len();
        let is_whole = !rest[..at].ends_with(is_word) && !rest[end..].starts_with(is_word);
        out.push_str(&rest[..at]);
        out.push_str(if is_whole { new } else { word });
        rest = &rest[end..];
    }
    out.push_str(rest);
    out
}
