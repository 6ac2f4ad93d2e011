//! RON text to declarations, with errors that point into the text.

use std::ops::Range;
use std::sync::Arc;

use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

use super::spans::blank;
use super::{CategoryManifest, Locator, ModuleManifest, Node};
use crate::diagnostics::{Diagnostic, Position, Report, SourceFile, codes};
use crate::limits;

/// What a RON text declares, with the text and the places of its values.
#[derive(Clone, Debug)]
pub struct Parsed<T> {
    /// The declaration.
    pub value: T,
    /// The text.
    pub file: Arc<SourceFile>,
    /// Places in the text.
    pub places: Locator,
}

impl<T> Parsed<T> {
    /// An error about the value at a path of the text, or about the nearest value around it that is there.
    pub fn error_at(&self, path: &[super::Step], code: &'static str, message: impl Into<String>, label: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, message).at(&self.file, self.places.find_near(path), label)
    }
}

/// Reads `category.ron`. `name` is what errors call the text.
///
/// # Errors
/// The text exceeds a limit, is no RON, or is RON of another shape.
pub fn parse_category(name: &str, text: &str) -> Result<Parsed<CategoryManifest>, Report> {
    parse(name, text)
}

/// Reads `module.ron`. `name` is what errors call the text.
///
/// # Errors
/// The text exceeds a limit, is no RON, or is RON of another shape.
pub fn parse_module(name: &str, text: &str) -> Result<Parsed<ModuleManifest>, Report> {
    parse(name, text)
}

/// Reads a recipe: a RON tree, a module's name in quotes, or the bare name, `ggx` or `ndf/ggx`.
///
/// # Errors
/// The text exceeds a limit, is no RON, or is RON of another shape.
pub fn parse_recipe(name: &str, text: &str) -> Result<Parsed<Node>, Report> {
    if is_bare_name(text.trim()) {
        return Ok(Parsed {
            value: Node::new(text.trim()),
            file: SourceFile::new(name, text),
            places: Locator::new(text),
        });
    }
    parse(name, text)
}

/// Whether the text is a module's name, or a category's and a module's.
fn is_bare_name(text: &str) -> bool {
    let word = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
    };
    let (category, module) = text.split_once('/').unwrap_or(("a", text));
    text.len() <= 256 && word(category) && word(module)
}

/// How all RON is read: an optional value is written without `Some`.
pub fn ron_options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME)
        .with_recursion_limit(4 * limits::RON_NESTING)
}

/// Reads any RON text of ours, within the limits. `name` is what errors call the text.
///
/// # Errors
/// The text exceeds a limit, is no RON, or is RON of another shape.
pub fn parse<T: DeserializeOwned>(name: &str, text: &str) -> Result<Parsed<T>, Report> {
    let file = SourceFile::new(name, text);
    limits::check_size(&file)?;
    let places = Locator::new(text);
    limits::check_ron(&file, &places)?;
    let parsed = ron_options().from_str::<T>(text);
    let value = parsed.map_err(|error| located(&file, &places, &error))?;
    let twice = places
        .duplicates()
        .into_iter()
        .map(|(key, first, second)| duplicate(&file, key, first, second));
    Report::unless_empty(twice.collect())?;
    Ok(Parsed { value, file, places })
}

fn duplicate(file: &Arc<SourceFile>, key: &str, first: Range<usize>, second: Range<usize>) -> Diagnostic {
    Diagnostic::new(codes::DUPLICATE_KEY, format!("`{key}` stands twice"))
        .at(file, second, "the second time")
        .at(file, first, "the first time")
        .note("remove one of them")
}

/// ron's error as ours.
fn located(file: &Arc<SourceFile>, places: &Locator, error: &ron::error::SpannedError) -> Diagnostic {
    use ron::Error;

    let span = span_of(file, &error.span);
    match &error.code {
        Error::NoSuchStructField { expected, found, .. } => Diagnostic::new(
            codes::UNKNOWN_FIELD,
            format!("there is no field `{found}`{}", inside(places, span.start)),
        )
        .at(file, span, "unknown field")
        .suggest(found, "fields", expected.iter().copied()),
        Error::NoSuchEnumVariant { expected, found, .. } => Diagnostic::new(
            codes::UNKNOWN_VARIANT,
            format!("`{found}` is no choice{}", for_path(places, span.start)),
        )
        .at(file, span, "unknown word")
        .suggest(found, "choices", expected.iter().copied()),
        Error::MissingStructField { field, .. } => {
            let path = places.path_at(span.start);
            let owner = if path.is_empty() { String::new() } else { format!(" in `{path}`") };
            Diagnostic::new(codes::WRONG_SHAPE, format!("the field `{field}` is missing{owner}")).at(
                file,
                span,
                format!("ends without `{field}`"),
            )
        }
        Error::DuplicateStructField { .. } if !places.duplicates().is_empty() => {
            let (key, first, second) = places.duplicates().swap_remove(0);
            duplicate(file, key, first, second)
        }
        // What ron expected instead of what it found may be a matter of grammar or of type: the text alone tells.
        other => match ron_options().from_str::<ron::Value>(&file.text) {
            Ok(_) => wrong_shape(file, places, span, other),
            Err(error) => {
                let found =
                    Diagnostic::new(codes::RON_SYNTAX, "this is not RON").at(file, span_of(file, &error.span), lowercase(&error.code));
                match (&error.code, places.unclosed()) {
                    (Error::Eof, Some(bracket)) => found.at(file, bracket..bracket + 1, "never closed"),
                    _ => found,
                }
            }
        },
    }
}

fn wrong_shape(file: &Arc<SourceFile>, places: &Locator, span: Range<usize>, error: &ron::Error) -> Diagnostic {
    // ron takes a bare word for a unit struct and is past it when the type refuses one.
    let bare = matches!(error, ron::Error::InvalidValueForType { found, .. } if found == "a unit value");
    let span = if bare {
        let before = file.text[..span.start].trim_end();
        let word = before.trim_end_matches(|c: char| c.is_alphanumeric() || c == '_').len();
        if word < before.len() { word..before.len() } else { span }
    } else {
        places.starting_at(span.start).unwrap_or(span)
    };
    let message = format!("a value of another shape is needed{}", for_path(places, span.start));
    let found = Diagnostic::new(codes::WRONG_SHAPE, message).at(file, span, lowercase(error));
    if bare {
        found.note("names and quantities are written in quotes")
    } else {
        found
    }
}

/// ` in `a.b``, for the struct around a byte.
fn inside(places: &Locator, byte: usize) -> String {
    let path = places.path_at(byte);
    // The field itself is the last step where the scanner took it for one.
    let around = path.rsplit_once('.').map_or("", |(around, _)| around);
    if around.is_empty() {
        String::new()
    } else {
        format!(" in `{around}`")
    }
}

/// ` for `a.b``, for the value at a byte.
fn for_path(places: &Locator, byte: usize) -> String {
    let path = places.path_at(byte);
    if path.is_empty() { String::new() } else { format!(" for `{path}`") }
}

/// ron's words, which begin with a capital letter.
fn lowercase(error: &ron::Error) -> String {
    let text = error.to_string();
    let mut rest = text.chars();
    rest.next()
        .map(|first| first.to_lowercase().chain(rest).collect())
        .unwrap_or_default()
}

/// The bytes of ron's span, which may begin before white space and may be empty: then the word that follows.
fn span_of(file: &SourceFile, span: &ron::error::Span) -> Range<usize> {
    let byte = |at: &ron::error::Position| {
        file.byte_at(Position {
            line: at.line,
            column: at.col,
        })
    };
    let (start, end) = (byte(&span.start), byte(&span.end));
    let start = start + blank(&file.text[start..]);
    if start < end {
        return start..end;
    }
    let rest = &file.text[start..];
    let width = rest
        .find(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '-' | '.')))
        .unwrap_or(rest.len());
    start..start + width.max(rest.chars().next().map_or(0, char::len_utf8))
}

#[cfg(test)]
mod tests;
