//! Tokens of WGSL text, with comments and blanks left out.

use std::ops::Range;

/// Kind of a token, as far as linking text needs to tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Identifier or keyword.
    Word,
    /// Number literal.
    Number,
    /// A single character of punctuation; operators of several characters are several tokens.
    Mark(u8),
}

/// A token and its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: Kind,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Token {
    /// Its bytes.
    pub fn range(self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// Whether it is this punctuation.
    pub fn is(self, mark: u8) -> bool {
        self.kind == Kind::Mark(mark)
    }
}

/// Whether `&&` or `||` is among the tokens: naga makes a branch of it.
pub fn short_circuits(tokens: &[Token]) -> bool {
    let twice = |pair: &[Token], mark| pair[0].is(mark) && pair[1].is(mark) && pair[0].end == pair[1].start;
    tokens.windows(2).any(|pair| twice(pair, b'&') || twice(pair, b'|'))
}

/// Splits text into tokens. Text that is no WGSL gives some tokens too: the parser proper judges it.
pub fn lex(text: &str) -> Vec<Token> {
    let bytes = text.as_bytes();
    let mut tokens = Vec::with_capacity(bytes.len() / 4);
    let mut at = 0;
    while at < bytes.len() {
        let start = at;
        let byte = bytes[at];
        let kind = match byte {
            b'/' if bytes.get(at + 1) == Some(&b'/') => {
                at = line_end(bytes, at);
                continue;
            }
            b'/' if bytes.get(at + 1) == Some(&b'*') => {
                at = block_comment_end(bytes, at);
                continue;
            }
            b'0'..=b'9' => {
                at = number_end(bytes, at);
                Kind::Number
            }
            b'.' if bytes.get(at + 1).is_some_and(u8::is_ascii_digit) && !follows_value(&tokens, start) => {
                at = number_end(bytes, at);
                Kind::Number
            }
            _ if is_word_byte(byte) => {
                while at < bytes.len() && (is_word_byte(bytes[at]) || bytes[at].is_ascii_digit()) {
                    at += 1;
                }
                Kind::Word
            }
            _ if byte.is_ascii_whitespace() => {
                at += 1;
                continue;
            }
            _ => {
                at += 1;
                Kind::Mark(byte)
            }
        };
        tokens.push(Token {
            kind,
            start: start as u32,
            end: at as u32,
        });
    }
    tokens
}

/// Letters, the underscore, and every byte of a character beyond ASCII (WGSL identifiers are XID).
fn is_word_byte(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_' || byte >= 0x80
}

/// `.5` right after a value would be a member access, which no digit can follow: never a number there.
fn follows_value(tokens: &[Token], start: usize) -> bool {
    tokens
        .last()
        .is_some_and(|t| t.end as usize == start && (t.kind == Kind::Word || t.is(b')') || t.is(b']')))
}

fn line_end(bytes: &[u8], from: usize) -> usize {
    bytes[from..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |n| from + n)
}

fn block_comment_end(bytes: &[u8], from: usize) -> usize {
    let mut depth = 0usize;
    let mut at = from;
    while at < bytes.len() {
        if bytes[at..].starts_with(b"/*") {
            depth += 1;
            at += 2;
        } else if bytes[at..].starts_with(b"*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    bytes.len()
}

fn number_end(bytes: &[u8], from: usize) -> usize {
    let hex = bytes[from] == b'0' && matches!(bytes.get(from + 1), Some(b'x' | b'X'));
    let mut at = from;
    while at < bytes.len() {
        let byte = bytes[at];
        let exponent = if hex {
            matches!(byte, b'p' | b'P')
        } else {
            matches!(byte, b'e' | b'E')
        };
        if exponent && matches!(bytes.get(at + 1), Some(b'+' | b'-')) {
            at += 2;
        } else if byte.is_ascii_alphanumeric() || byte == b'.' {
            at += 1;
        } else {
            break;
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<&str> {
        lex(text).iter().map(|t| &text[t.range()]).collect()
    }

    #[test]
    fn comments_nest_and_numbers_hold_together() {
        assert_eq!(texts("a /* x /* y */ z */ .b // c\n+1.5e-3f"), ["a", ".", "b", "+", "1.5e-3f"]);
        assert_eq!(texts("v.xy*.5 0x1p-3 1u"), ["v", ".", "xy", "*", ".5", "0x1p-3", "1u"]);
        assert_eq!(texts("/* open"), Vec::<&str>::new());
    }
}
