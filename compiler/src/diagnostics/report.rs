use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A text that diagnostics point into.
#[derive(Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Name shown to people: a path relative to the library, or what the caller named it.
    pub name: String,
    /// The text as the author wrote it, or as a library made it of what authors wrote.
    pub text: String,
    /// Where a made text comes from, in the text's order; empty for what an author wrote as it stands.
    parts: Vec<Part>,
}

/// A part of a made text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Bytes of the made text.
    pub text: Range<usize>,
    /// The author's file.
    pub file: Arc<SourceFile>,
    /// Bytes of the author's file. As many as of the made text: each byte stands for the one in its place; else all for all.
    pub span: Range<usize>,
}

impl SourceFile {
    /// A named text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            text: text.into(),
            parts: Vec::new(),
        })
    }

    /// A text made of parts of other files: errors in it are told at their places. Parts stand in order and do not overlap; places that are
    /// in none of them are told as they are.
    pub fn made(name: impl Into<String>, text: impl Into<String>, parts: Vec<Part>) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            text: text.into(),
            parts,
        })
    }

    /// The author's file and the bytes of it that these bytes come from: itself, where the author wrote it as it stands.
    pub fn origin(self: &Arc<Self>, span: Range<usize>) -> (Arc<Self>, Range<usize>) {
        let Some(first) = self.part(span.start) else {
            return (Arc::clone(self), span);
        };
        let copied = |part: &Part| part.text.len() == part.span.len();
        let start = if copied(first) {
            first.span.start + (span.start - first.text.start)
        } else {
            first.span.start
        };
        let last = self
            .part(span.end.saturating_sub(1).max(span.start))
            .filter(|last| Arc::ptr_eq(&last.file, &first.file));
        let end = match last {
            Some(last) if copied(last) => last.span.start + (span.end - last.text.start),
            Some(last) => last.span.end,
            None => first.span.end,
        };
        (Arc::clone(&first.file), start..end.max(start))
    }

    fn part(&self, byte: usize) -> Option<&Part> {
        let part = self.parts.get(self.parts.partition_point(|part| part.text.end <= byte))?;
        part.text.contains(&byte).then_some(part)
    }

    /// Name of the author's file and line of it for a byte of the text, which stands on this line of the text.
    pub(crate) fn line_of(&self, byte: usize, line: usize) -> (&str, usize) {
        let Some(part) = self.part(byte) else {
            return (&self.name, line);
        };
        let copied = part.text.len() == part.span.len();
        let start = part.span.start + if copied { byte - part.text.start } else { 0 };
        (&part.file.name, part.file.position(start).line)
    }

    /// Line and column of a byte of the text; a byte past the end counts as the end.
    pub fn position(&self, byte: usize) -> Position {
        let before = &self.text[..self.text.floor_char_boundary(byte)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Position {
            line: before.bytes().filter(|&b| b == b'\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    /// The byte at which the character of this line and column stands; the line's or the text's end where there is none.
    pub fn byte_at(&self, position: Position) -> usize {
        let mut start = 0;
        for _ in 1..position.line {
            match self.text[start..].find('\n') {
                Some(newline) => start += newline + 1,
                None => return self.text.len(),
            }
        }
        let line = self.text[start..].split('\n').next().unwrap_or_default();
        let column = position.column.saturating_sub(1);
        start + line.char_indices().nth(column).map_or(line.len(), |(byte, _)| byte)
    }

    /// `name:line:column` of a byte of the text.
    pub fn place(&self, byte: usize) -> String {
        let Position { line, column } = self.position(byte);
        format!("{}:{line}:{column}", self.name)
    }
}

/// A position as people count it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// A place in a file and what is to be seen there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The file.
    pub file: Arc<SourceFile>,
    /// Bytes of its text.
    pub span: Range<usize>,
    /// What is there.
    pub text: String,
}

/// Most names that are listed beside the nearest one.
const LONGEST_LIST: usize = 32;

/// One error with its stable code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// `SW` and four digits; listed in `spec/diagnostics.md`.
    pub code: &'static str,
    /// What is wrong, in one line.
    pub message: String,
    /// Where; the first is the primary place.
    pub labels: Vec<Label>,
    /// What was expected and what to do.
    pub notes: Vec<String>,
}

impl Diagnostic {
    /// An error without a place yet.
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
            labels: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Adds a place, told in the author's own file; the first one added is the primary one.
    #[must_use]
    pub fn at(mut self, file: &Arc<SourceFile>, span: Range<usize>, text: impl Into<String>) -> Self {
        let (file, span) = file.origin(span);
        self.labels.push(Label {
            file,
            span,
            text: text.into(),
        });
        self
    }

    /// Adds advice.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Advises the known name that is nearest to `found` if one is near, and lists all of them, unless there are so many that
    /// the nearest one would drown.
    #[must_use]
    pub fn suggest<'a>(mut self, found: &str, what: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        let known: Vec<&str> = known.into_iter().collect();
        let near = nearest(found, known.iter().copied());
        if let Some(near) = near {
            self.notes.push(format!("did you mean `{near}`?"));
        }
        if near.is_none() || known.len() <= LONGEST_LIST {
            let list = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            self.notes.push(format!("{what}: {list}"));
        }
        self
    }
}

/// One or more errors; what every fallible call of the compiler returns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// In the order found, never empty.
    pub diagnostics: Vec<Diagnostic>,
}

impl From<Diagnostic> for Report {
    fn from(diagnostic: Diagnostic) -> Self {
        Self {
            diagnostics: vec![diagnostic],
        }
    }
}

impl Report {
    /// The rendered text that people read: every error with the lines it points at.
    pub fn render(&self) -> String {
        super::render::text(&self.diagnostics)
    }

    /// The machine-readable form: a list of objects with `code`, `message`, `labels` (`file`, `start`, `end`, `line`, `column`,
    /// `end_line`, `end_column`, `text`) and `notes`.
    pub fn to_json(&self) -> serde_json::Value {
        super::render::json(&self.diagnostics)
    }

    /// Appends the diagnostics of another report.
    pub fn extend(&mut self, other: Report) {
        self.diagnostics.extend(other.diagnostics);
    }

    /// A report of what was found, or nothing where nothing was.
    ///
    /// # Errors
    /// There are diagnostics.
    pub fn unless_empty(diagnostics: Vec<Diagnostic>) -> Result<(), Report> {
        if diagnostics.is_empty() {
            Ok(())
        } else {
            Err(Report { diagnostics })
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render())
    }
}

impl std::error::Error for Report {}

/// The name nearest to `found`, if it is near enough to be a slip of the pen. Of equally near ones the first.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut best: Option<(f64, &str)> = None;
    for name in known {
        // A name that continues what was written (or the reverse) is near however long the rest is.
        let continues = found.len() >= 3 && (name.starts_with(found) || found.starts_with(name) && name.len() >= 3);
        let one_slip = found.len() >= 3 && strsim::damerau_levenshtein(found, name) == 1;
        let similarity = strsim::jaro_winkler(found, name).max(if continues || one_slip { 0.9 } else { 0.0 });
        if similarity >= 0.75 && best.is_none_or(|(s, _)| similarity > s) {
            best = Some((similarity, name));
        }
    }
    best.map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches bytes counted as columns, and lines counted from zero.
    #[test]
    fn positions_count_characters_from_one() {
        let file = SourceFile::new("f", "aé\n字b\n");
        assert_eq!(file.position(0), Position { line: 1, column: 1 });
        assert_eq!(file.position(7), Position { line: 2, column: 2 });
        assert_eq!(file.place(99), "f:3:1");
        for byte in [0, 1, 3, 4, 7, 8, 9] {
            assert_eq!(file.byte_at(file.position(byte)), byte);
        }
        assert_eq!(file.byte_at(Position { line: 9, column: 9 }), file.text.len());
    }

    /// Catches an error in a made text that is told at its place there, or at the wrong one in the author's file.
    #[test]
    fn made_texts_are_told_by_their_parts() {
        let (one, two) = (SourceFile::new("one", "abcdefgh"), SourceFile::new("two", "0123456789"));
        let part = |text, file: &Arc<SourceFile>, span| Part {
            text,
            file: Arc::clone(file),
            span,
        };
        // "cd" + "XYZ" in place of "ef" + "gh" + "\n" + "345"
        let parts = vec![
            part(0..2, &one, 2..4),
            part(2..5, &one, 4..6),
            part(5..7, &one, 6..8),
            part(8..11, &two, 3..6),
        ];
        let made = SourceFile::made("made", "cdXYZgh\n345", parts);
        let told = |span| {
            let (file, span) = made.origin(span);
            (file.name.clone(), span)
        };
        assert_eq!(told(1..2), ("one".to_owned(), 3..4));
        assert_eq!(told(3..4), ("one".to_owned(), 4..6)); // no byte of the word has a place of its own
        assert_eq!(told(1..6), ("one".to_owned(), 3..7));
        assert_eq!(told(7..8), ("made".to_owned(), 7..8));
        assert_eq!(told(9..11), ("two".to_owned(), 4..6));
        assert_eq!(told(6..9), ("one".to_owned(), 7..8)); // over two files: the first
        assert_eq!(told(0..0), ("one".to_owned(), 2..2));
        assert_eq!(one.origin(1..3), (Arc::clone(&one), 1..3));
        assert_eq!(Diagnostic::new("SW0101", "m").at(&made, 9..10, "").labels[0].file, two);
    }

    /// Catches a suggestion of something far off, and a miss of an evident one.
    #[test]
    fn nearest_names() {
        assert_eq!(nearest("micofacet", ["lambert", "microfacet"]), Some("microfacet"));
        assert_eq!(nearest("ggx", ["smith-ggx-correlated", "schlick"]), None);
        assert_eq!(nearest("smith", ["ggx", "smith-ggx-correlated"]), Some("smith-ggx-correlated"));
        assert_eq!(nearest("kml", ["lm", "klm"]), Some("klm"));
        assert_eq!(nearest("xyz", ["lambert"]), None);
    }
}
