//! The two forms of a report: text for people and JSON for programs.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use codespan_reporting::diagnostic;
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term::{self, Chars, Config};
use serde_json::{Value, json};

use super::report::{Diagnostic, Label, SourceFile};

/// Renders diagnostics with the lines they point at, without colour, one empty line between two of them.
pub(super) fn text(diagnostics: &[Diagnostic]) -> String {
    let config = Config {
        chars: Chars::ascii(),
        ..Config::default()
    };
    let mut out = String::new();
    for (index, diagnostic) in diagnostics.iter().enumerate() {
        if index > 0 {
            out.push('\n');
        }
        out.push_str(one(diagnostic, &config).trim_end());
        out.push('\n');
    }
    out
}

fn one(found: &Diagnostic, config: &Config) -> String {
    let mut files = SimpleFiles::new();
    let mut known: Vec<&Arc<SourceFile>> = Vec::new();
    let mut labels = Vec::with_capacity(found.labels.len());
    let mut notes = Vec::with_capacity(found.notes.len());
    for (index, label) in found.labels.iter().enumerate() {
        let range = clamp(&label.file.text, &label.span);
        if has_long_line(&label.file.text, &range) {
            notes.push(visible(&format!("{}: {}", label.file.place(range.start), label.text)).into_owned());
            continue;
        }
        let id = known.iter().position(|file| **file == label.file).unwrap_or_else(|| {
            known.push(&label.file);
            files.add(visible(&label.file.name), visible(&label.file.text))
        });
        let place = if index == 0 {
            diagnostic::Label::primary(id, range)
        } else {
            diagnostic::Label::secondary(id, range)
        };
        labels.push(place.with_message(visible(&label.text)));
    }
    notes.extend(found.notes.iter().map(|note| visible(note).into_owned()));
    let rendered = diagnostic::Diagnostic::error()
        .with_code(found.code)
        .with_message(visible(&found.message))
        .with_labels(labels)
        .with_notes(notes);
    // Clamped ranges of files that are there leave nothing to fail; should it yet happen, the message still comes through.
    term::emit_into_string(config, &files, &rendered).unwrap_or_else(|_| format!("error[{}]: {}\n", found.code, visible(&found.message)))
}

/// Longest line that is shown, in bytes. A place on a longer one is told by its line and column alone.
const LONGEST_LINE: usize = 2000;

/// Whether one of the lines that the range touches is too long to be shown.
fn has_long_line(text: &str, range: &Range<usize>) -> bool {
    let start = text[..range.start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[range.end..].find('\n').map_or(text.len(), |newline| range.end + newline);
    text[start..end].split('\n').any(|line| line.len() > LONGEST_LINE)
}

/// Text whose control characters cannot act on a terminal. Every character keeps its length, so that spans stay right.
fn visible(text: &str) -> Cow<'_, str> {
    let acts = |(index, c): (usize, char)| c.is_ascii_control() && c != '\n' && c != '\t' && !text[index..].starts_with("\r\n");
    if !text.char_indices().any(acts) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.char_indices().map(|at| if acts(at) { '?' } else { at.1 }).collect())
}

/// The range, moved inside the text and onto character boundaries.
fn clamp(text: &str, span: &Range<usize>) -> Range<usize> {
    let start = text.floor_char_boundary(span.start);
    let end = text.ceil_char_boundary(span.end.max(start));
    start..end
}

/// The form for programs; see `spec/diagnostics.md`.
pub(super) fn json(diagnostics: &[Diagnostic]) -> Value {
    let label = |label: &Label| {
        let range = clamp(&label.file.text, &label.span);
        let (start, end) = (label.file.position(range.start), label.file.position(range.end));
        json!({
            "file": label.file.name,
            "start": range.start,
            "end": range.end,
            "line": start.line,
            "column": start.column,
            "end_line": end.line,
            "end_column": end.column,
            "text": label.text,
        })
    };
    diagnostics
        .iter()
        .map(|d| {
            json!({
                "code": d.code,
                "message": d.message,
                "labels": d.labels.iter().map(label).collect::<Vec<_>>(),
                "notes": d.notes,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::diagnostics::Report;

    /// Catches a lost code, label, note or second file, and places that are off by one.
    #[test]
    fn a_full_diagnostic() {
        let recipe = SourceFile::new("a.recipe.ron", "(\n    module: \"micro\",\n)\n");
        let other = SourceFile::new("b.ron", "(summary: \"x\")");
        let report = Report::from(
            Diagnostic::new("SW0201", "there is no module `micro`")
                .at(&recipe, 14..21, "not found")
                .at(&other, 1..8, "declared here")
                .note("did you mean `microfacet`?"),
        );
        let expected = "\
error[SW0201]: there is no module `micro`
  --> a.recipe.ron:2:13
  |
2 |     module: \"micro\",
  |             ^^^^^^^ not found
  |
  --> b.ron:1:2
  |
1 | (summary: \"x\")
  |  ------- declared here
  |
  = did you mean `microfacet`?
";
        assert_eq!(report.render(), expected);
        assert_eq!(
            report.to_json(),
            json!([{
                "code": "SW0201",
                "message": "there is no module `micro`",
                "labels": [
                    {"file": "a.recipe.ron", "start": 14, "end": 21, "line": 2, "column": 13, "end_line": 2, "end_column": 20, "text": "not found"},
                    {"file": "b.ron", "start": 1, "end": 8, "line": 1, "column": 2, "end_line": 1, "end_column": 9, "text": "declared here"},
                ],
                "notes": ["did you mean `microfacet`?"],
            }])
        );
    }

    /// Catches a report whose diagnostics run into each other, and a renderer that needs a place.
    #[test]
    fn diagnostics_without_places() {
        let mut report = Report::from(Diagnostic::new("SW0802", "no manifest").note("add `module.ron`"));
        report.extend(Report::from(Diagnostic::new("SW0803", "no interface")));
        assert_eq!(
            report.render(),
            "error[SW0802]: no manifest\n = add `module.ron`\n\nerror[SW0803]: no interface\n"
        );
    }

    /// Catches a name with escape codes that would recolour or clear the terminal.
    #[test]
    fn control_characters_are_shown_harmless() {
        let file = SourceFile::new("x", "a\u{1b}[31m\rb\r\n");
        let text = Report::from(Diagnostic::new("SW0201", "no `\u{1b}[2J`").at(&file, 0..1, "here")).render();
        assert!(!text.contains('\u{1b}') && !text.contains('\r'), "{text:?}");
        assert!(text.contains("a?[31m?b"), "{text}");
    }

    /// Catches a line of a megabyte that is printed whole.
    #[test]
    fn very_long_lines_are_not_shown() {
        let long = SourceFile::new("long.ron", format!("a\n{}\nb", "(".repeat(LONGEST_LINE + 1)));
        let short = SourceFile::new("short.ron", "(".repeat(LONGEST_LINE));
        let report = |file, span| Report::from(Diagnostic::new("SW0101", "m").at(file, span, "here").note("advice")).render();
        assert_eq!(report(&long, 100..101), "error[SW0101]: m\n = long.ron:2:99: here\n = advice\n");
        assert_eq!(report(&long, 0..100), "error[SW0101]: m\n = long.ron:1:1: here\n = advice\n");
        assert!(report(&long, 0..1).contains("1 | a") && report(&short, 0..1).contains("1 | (((("));
    }

    proptest! {
        /// Catches spans outside the text, reversed, or inside a character, that make the renderer panic.
        #[test]
        fn no_span_panics(text in "\\PC{0,20}(\n|\r\n|\r|\t|é|字|\u{0}){0,5}\\PC{0,20}", spans in proptest::collection::vec((0usize..70, 0usize..70), 0..4)) {
            let file = SourceFile::new("f", text);
            let mut d = Diagnostic::new("SW0101", "m");
            for (a, b) in spans {
                d = d.at(&file, a..b, "l");
            }
            d = d.at(&file, usize::MAX - 1..usize::MAX, "far");
            let report = Report::from(d);
            prop_assert!(report.render().starts_with("error[SW0101]: m\n"));
            prop_assert!(report.to_json()[0]["labels"][0]["line"].as_u64() >= Some(1));
            prop_assert_eq!(report.render(), report.render());
        }
    }
}
