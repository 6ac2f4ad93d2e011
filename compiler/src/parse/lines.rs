//! Lines of text around what stands on them.

use std::ops::Range;

use super::lex::Token;

/// First byte of the block of whole-line comments right above `start`.
pub fn doc_start(text: &str, start: usize) -> usize {
    let line_start = text[..start].rfind('\n').map_or(0, |n| n + 1);
    if !text[line_start..start].trim().is_empty() {
        return start;
    }
    let first = comments_above(text, line_start);
    if first == line_start { start } else { first }
}

/// First byte of the lines right above a line that hold nothing but a `//` comment.
fn comments_above(text: &str, line_start: usize) -> usize {
    let mut first = line_start;
    while first > 0 {
        let previous = text[..first - 1].rfind('\n').map_or(0, |n| n + 1);
        if !text[previous..first].trim_start().starts_with("//") {
            break;
        }
        first = previous;
    }
    first
}

/// A stretch to take away, with its whole lines, the comment above and one behind it, where nothing else stands on them.
pub fn whole_lines(text: &str, tokens: &[Token], range: Range<usize>) -> Range<usize> {
    let line = text[..range.start].rfind('\n').map_or(0, |n| n + 1);
    let end = text[range.end..].find('\n').map_or(text.len(), |n| range.end + n + 1);
    let behind = text[range.end..end].trim();
    if !text[line..range.start].trim().is_empty() || !(behind.is_empty() || behind.starts_with("//")) {
        return range;
    }
    // A line that begins like a comment may stand inside a longer one, which must stay closed.
    let before = tokens.partition_point(|t| t.end as usize <= range.start);
    let before = tokens[..before].last().map_or(0, |t| t.end as usize);
    let in_block = text[before..range.start].contains("/*");
    let first = if in_block { line } else { comments_above(text, line) };
    first..end
}
