//! Words and signs of a WESL text, by wesl's own lexer.

use std::ops::Range;

use wgsl_parse::lexer::{Lexer, Token as Kind};

/// A word or sign.
#[derive(Clone, Debug)]
pub(super) struct Token<'a> {
    /// Bytes of the text.
    pub span: Range<usize>,
    /// It, as it stands there.
    pub text: &'a str,
    /// 1 where it opens a bracket or the arguments of a template, -1 where it closes them.
    pub nesting: i32,
}

impl Token<'_> {
    /// Whether it is a name or a keyword.
    pub fn is_word(&self) -> bool {
        self.text.starts_with(|c: char| c == '_' || c.is_alphabetic())
    }
}

/// The tokens of a text without comments. Ends at what is no token; such a text isn't parsed either.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let known = Lexer::new(text).map_while(Result::ok);
    let token = |(start, kind, end): (usize, Kind, usize)| {
        let nesting = match kind {
            Kind::SymParenLeft | Kind::SymBracketLeft | Kind::SymBraceLeft | Kind::TemplateArgsStart => 1,
            Kind::SymParenRight | Kind::SymBracketRight | Kind::SymBraceRight | Kind::TemplateArgsEnd => -1,
            _ => 0,
        };
        // Of `>>` the lexer gives two ends of templates, the first with the length of both.
        let end = if kind == Kind::TemplateArgsEnd { start + 1 } else { end };
        Some(Token {
            span: start..end,
            text: text.get(start..end)?,
            nesting,
        })
    };
    known.filter_map(token).collect()
}
