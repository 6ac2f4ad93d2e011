//! An author's text with edits made.

use std::borrow::Cow;
use std::ops::Range;

/// A stretch of text and what stands there instead.
pub type Edit<'p> = (Range<usize>, Cow<'p, str>);

/// Text that was copied as it stands.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Where it was written.
    pub at: usize,
    /// Bytes of the author's text.
    pub from: Range<usize>,
}

/// Writes the text of a range with the edits made, and notes which stretches are the author's. Edits inside a removed stretch go with it.
pub fn apply(text: &str, range: Range<usize>, edits: &mut [Edit], stretches: &mut Vec<Stretch>, out: &mut String) {
    let mut copy = |range: Range<usize>, out: &mut String| {
        stretches.push(Stretch {
            at: out.len(),
            from: range.clone(),
        });
        out.push_str(&text[range]);
    };
    edits.sort_by_key(|(a, _)| (a.start, std::cmp::Reverse(a.end)));
    let mut at = range.start;
    for (span, new) in edits {
        if span.start < at || span.end > range.end {
            // An edit that begins in a removed stretch may still reach beyond it.
            at = at.max(span.end.min(range.end).max(at));
            continue;
        }
        copy(at..span.start, out);
        out.push_str(new);
        at = span.end;
    }
    copy(at..range.end, out);
}
