//! wesl's errors as diagnostics.

use std::sync::Arc;

use shadewright_compiler::diagnostics::{Diagnostic, Report, SourceFile, codes};
use wesl::{CondCompError, Error, ImportError, ModulePath, ResolveError, syntax::PathOrigin};
use wgsl_parse::error::ErrorKind;

use super::files::Files;
use super::tokens::{Token, tokens};

/// Most kinds of tokens that are named as expected; more say nothing.
const EXPECTED: usize = 8;

/// The diagnostic of an error.
pub(super) fn told(error: Error, files: &Files) -> Report {
    let whole = wesl::Diagnostic::from(error);
    let detail = *whole.detail;
    let file = detail.module_path.as_ref().and_then(|path| files.file(path));
    // The first file is the module's own and always there.
    let file = file.or_else(|| files.seen().first().map(|(_, file)| Arc::clone(file)));
    let file = file.unwrap_or_else(|| SourceFile::new("", ""));
    let span = detail.span.map(|span| span.range());
    match *whole.error {
        Error::ParseError(error) => syntax(&error, &file),
        Error::CondCompError(error) => condition(&error, &file, span.unwrap_or(0..0)),
        Error::ImportError(ImportError::MissingDecl(path, name)) => {
            let message = format!("`{path}` has no declaration `{name}`");
            let found = imported(files, &name);
            let diagnostic = Diagnostic::new(codes::WESL_IMPORT, message).at(&found.0, found.1, "not there");
            match files.file(&path) {
                Some(other) => {
                    let all = declared(&other);
                    diagnostic.suggest(&name, &format!("declarations of `{}`", other.name), all.iter().map(String::as_str))
                }
                None => diagnostic,
            }
        }
        Error::ResolveError(ResolveError::ModuleNotFound(path, _)) => nowhere(&path, files),
        Error::ImportError(error) => {
            Diagnostic::new(codes::WESL_IMPORT, one_line(&error.to_string())).at(&file, span.unwrap_or(0..0), "here")
        }
        other => Diagnostic::new(codes::WESL_SYNTAX, one_line(&other.to_string())).at(&file, span.unwrap_or(0..0), "here"),
    }
    .into()
}

fn syntax(error: &wgsl_parse::Error, file: &Arc<SourceFile>) -> Diagnostic {
    let (message, expected) = match &error.error {
        ErrorKind::UnexpectedToken { token, expected } => (
            format!("`{}` does not fit here", token.trim_start_matches("identifier ").trim_matches('`')),
            expected.as_slice(),
        ),
        ErrorKind::UnexpectedEof { expected } => ("the file ends too early".to_owned(), expected.as_slice()),
        other => (one_line(&other.to_string()), &[][..]),
    };
    let diagnostic = Diagnostic::new(codes::WESL_SYNTAX, message).at(file, error.span.range(), "not understood");
    // Signs come quoted, other kinds of tokens by the parser's own names for them.
    let readable = expected.iter().filter_map(|kind| match kind.strip_prefix('"') {
        Some(sign) => Some(format!("`{}`", sign.trim_end_matches('"'))),
        None => (kind == "IdentPatternToken").then(|| "a name".to_owned()),
    });
    let readable: Vec<String> = readable.collect();
    if readable.is_empty() || readable.len() > EXPECTED {
        return diagnostic;
    }
    diagnostic.note(format!("expected is {}", readable.join(" or ")))
}

fn condition(error: &CondCompError, file: &Arc<SourceFile>, span: std::ops::Range<usize>) -> Diagnostic {
    match error {
        CondCompError::UnexpectedFeatureFlag(name) => Diagnostic::new(codes::WESL_CONDITION, format!("there is no feature `{name}`"))
            .at(file, span, "asked for here")
            .note(format!(
                "declare it in the `wesl.ron` of the module's folder: `(features: {{\"{name}\": true}})`"
            )),
        other => Diagnostic::new(codes::WESL_CONDITION, one_line(&other.to_string())).at(file, span, "here"),
    }
}

fn nowhere(path: &ModulePath, files: &Files) -> Diagnostic {
    let last = path.components.last().cloned().unwrap_or_default();
    let (file, span) = imported(files, &last);
    let diagnostic = Diagnostic::new(codes::WESL_IMPORT, format!("the import `{path}` leads nowhere")).at(&file, span, "not there");
    match &path.origin {
        PathOrigin::Absolute => {
            let name = path.components.join("/");
            diagnostic.note(format!("looked for `{name}.wesl` and `{name}.wgsl` in the library's folder"))
        }
        _ => diagnostic.note("a path begins with `package::`, the library's folder, or `super::`; other packages are not taken"),
    }
}

/// Where a name stands in a path or an import; the beginning of the first file where it is nowhere.
fn imported(files: &Files, name: &str) -> (Arc<SourceFile>, std::ops::Range<usize>) {
    let seen = files.seen();
    for (_, file) in &seen {
        let all = tokens(&file.text);
        let near = |at: usize| all.get(at).is_some_and(|t| matches!(t.text, "::" | "{" | "," | "as"));
        let is = |(at, token): &(usize, &Token)| token.text == name && (near(at.wrapping_sub(1)) || near(at + 1)) && !is_local(&all, *at);
        if let Some((_, token)) = all.iter().enumerate().find(is) {
            return (Arc::clone(file), token.span.clone());
        }
    }
    let first = seen.first().map(|(_, file)| Arc::clone(file));
    (first.unwrap_or_else(|| SourceFile::new("", "")), 0..0)
}

/// Whether the token at this index is neither part of a path with `::` nor of an import.
fn is_local(all: &[Token], at: usize) -> bool {
    let path = |at: usize| all.get(at).is_some_and(|t| t.text == "::");
    if path(at.wrapping_sub(1)) || path(at + 1) {
        return false;
    }
    let statement = all[..at].iter().rev().take_while(|t| t.text != ";");
    !statement.into_iter().any(|t| t.text == "import")
}

/// Names that a file declares at its top level.
pub(super) fn declared(file: &SourceFile) -> Vec<String> {
    let all = tokens(&file.text);
    let mut depth = 0;
    let mut names = Vec::new();
    for (at, token) in all.iter().enumerate() {
        if depth == 0 && matches!(token.text, "fn" | "struct" | "const" | "alias" | "override" | "var") {
            let mut next = all[at + 1..].iter();
            let name =
                next.find(|t| t.is_word() && !matches!(t.text, "storage" | "read" | "read_write" | "uniform" | "private" | "workgroup"));
            names.extend(name.map(|t| t.text.to_owned()));
        }
        depth += token.nesting;
    }
    names
}

fn one_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}
