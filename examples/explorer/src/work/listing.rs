//! Text that is shown by its lines.

use std::ops::Range;

use shadewright_compiler::LineOrigin;

/// A text with its lines.
#[derive(Clone, Debug, Default)]
pub struct Listing {
    /// What is shown.
    pub text: String,
    /// What is saved, where that is not the text.
    pub bytes: Option<Vec<u8>>,
    /// The lines.
    pub lines: Vec<Line>,
    /// Where they come from; empty where that is not known.
    pub origins: Vec<Option<LineOrigin>>,
    /// Characters of the longest line.
    pub width: usize,
}

/// A line of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Its bytes, without what ends it.
    pub bytes: Range<usize>,
    /// It begins inside a block comment.
    pub in_comment: bool,
}

/// Words of SPIR-V in a line.
const WORDS: usize = 8;

impl Listing {
    /// A text.
    pub fn new(text: &str, origins: Vec<Option<LineOrigin>>) -> Self {
        let mut lines = Vec::new();
        let (mut start, mut in_comment, mut width) = (0, false, 0);
        for line in text.split_inclusive('\n') {
            let shown = line.trim_end_matches(['\n', '\r']);
            lines.push(Line {
                bytes: start..start + shown.len(),
                in_comment,
            });
            start += line.len();
            width = width.max(shown.chars().count());
            in_comment = stays_open(shown, in_comment);
        }
        Self {
            text: text.to_owned(),
            bytes: None,
            lines,
            origins,
            width,
        }
    }

    /// Little-endian words, as numbers.
    pub fn of_words(bytes: Vec<u8>) -> Self {
        use std::fmt::Write as _;
        let (words, _) = bytes.as_chunks::<4>();
        let mut text = format!("// {} bytes, {} words\n", bytes.len(), words.len());
        for (index, line) in words.chunks(WORDS).enumerate() {
            // Infallible: writing to a string.
            let _ = write!(text, "{:06x}:", index * WORDS * 4);
            for word in line {
                let _ = write!(text, " {:08x}", u32::from_le_bytes(*word));
            }
            text.push('\n');
        }
        Self {
            bytes: Some(bytes),
            ..Self::new(&text, Vec::new())
        }
    }

    /// A line's text.
    pub fn line(&self, index: usize) -> &str {
        let bytes = self.lines.get(index).map(|line| line.bytes.clone());
        bytes.and_then(|bytes| self.text.get(bytes)).unwrap_or_default()
    }

    /// Where a text stands in it, whatever the case of its letters: line, and bytes of the line.
    pub fn find(&self, wanted: &str) -> Vec<(usize, Range<usize>)> {
        let wanted = wanted.to_ascii_lowercase();
        if wanted.is_empty() {
            return Vec::new();
        }
        let mut found = Vec::new();
        for index in 0..self.lines.len() {
            let line = self.line(index).to_ascii_lowercase();
            found.extend(line.match_indices(&wanted).map(|(at, text)| (index, at..at + text.len())));
        }
        found
    }
}

/// Whether a block comment is open at the end of a line.
fn stays_open(line: &str, open: bool) -> bool {
    let mut open = open;
    let mut rest = line;
    loop {
        let next = if open { rest.find("*/") } else { rest.find("/*") };
        let comment = rest.find("//");
        match next {
            Some(at) if open || comment.is_none_or(|comment| at < comment) => {
                open = !open;
                rest = &rest[at + 2..];
            }
            _ => return open,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches lines that lose a character, comments that colour the rest of a file, and a search that misses the second one of a line.
    #[test]
    fn lines_comments_and_finds() {
        let listing = Listing::new("a /* b\r\nc */ d // /* e\nIf if\n\né", Vec::new());
        let lines: Vec<(&str, bool)> = (0..5).map(|i| (listing.line(i), listing.lines[i].in_comment)).collect();
        assert_eq!(
            lines,
            [
                ("a /* b", false),
                ("c */ d // /* e", true),
                ("If if", false),
                ("", false),
                ("é", false)
            ]
        );
        assert_eq!(listing.find("IF"), [(2, 0..2), (2, 3..5)]);
        assert_eq!((listing.find(""), listing.width), (Vec::new(), 14));
        assert_eq!(Listing::default().line(3), "");
    }

    /// Catches words in the wrong order of bytes, and a saved file that is the listing.
    #[test]
    fn words_are_numbers() {
        let listing = Listing::of_words(vec![3, 2, 0x23, 7, 0, 0, 1, 0]);
        assert_eq!(listing.text, "// 8 bytes, 2 words\n000000: 07230203 00010000\n");
        assert_eq!(listing.bytes.map(|bytes| bytes.len()), Some(8));
    }
}
