//! Colours for code: words, numbers and comments of the languages that naga writes, which have these alike.

use std::ops::Range;

use eframe::egui::{Color32, Visuals};

/// What a piece of code is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Token {
    /// `fn`, `return`, `struct`
    Keyword,
    /// `vec3<f32>`
    Type,
    /// A name before a bracket.
    Function,
    /// `1.0f`
    Number,
    /// To the end of the line, or a block.
    Comment,
    /// `@group`, `#version`
    Attribute,
    /// Anything else.
    Plain,
}

const KEYWORDS: &str = " alias break case const const_assert continue continuing default diagnostic discard do else enable false fn for if in inout \
    inline layout let loop out override precision return requires register static struct switch true uniform using namespace var void while buffer \
    device constant constexpr thread thread_index_in_threadgroup template typename highp flat smooth readonly writeonly cbuffer ";
const TYPES: &str = " bool i32 u32 f32 f16 int uint float half double size_t array atomic ptr sampler sampler_comparison Texture2D Texture2DArray \
    TextureCube SamplerState SamplerComparisonState ByteAddressBuffer RWByteAddressBuffer texture2d texturecube storage private workgroup function \
    read write read_write image2D isampler2D usampler2D sampler2D samplerCube sampler2DArray sampler2DShadow samplerCubeShadow samplerCubeArrayShadow ";

impl Token {
    /// Its colour.
    pub fn colour(self, visuals: &Visuals) -> Color32 {
        let dark = visuals.dark_mode;
        let pick = |on_dark: [u8; 3], on_light: [u8; 3]| {
            let [r, g, b] = if dark { on_dark } else { on_light };
            Color32::from_rgb(r, g, b)
        };
        match self {
            Self::Keyword => pick([197, 134, 192], [140, 20, 140]),
            Self::Type => pick([78, 201, 176], [20, 105, 130]),
            Self::Function => pick([220, 220, 150], [110, 80, 10]),
            Self::Number => pick([181, 206, 168], [10, 110, 60]),
            Self::Comment => pick([120, 155, 100], [70, 115, 50]),
            Self::Attribute => pick([156, 200, 254], [30, 60, 170]),
            Self::Plain => visuals.text_color(),
        }
    }
}

/// The pieces of a line, without gaps. `in_comment`: it begins inside a block comment.
pub fn pieces(line: &str, in_comment: bool) -> Vec<(Range<usize>, Token)> {
    let mut pieces: Vec<(Range<usize>, Token)> = Vec::new();
    let mut at = 0;
    if in_comment {
        at = line.find("*/").map_or(line.len(), |end| end + 2);
        pieces.push((0..at, Token::Comment));
    }
    while let Some(first) = line[at..].chars().next() {
        let rest = &line[at..];
        let (length, token) = if rest.starts_with("//") {
            (rest.len(), Token::Comment)
        } else if let Some(inside) = rest.strip_prefix("/*") {
            (inside.find("*/").map_or(rest.len(), |end| end + 4), Token::Comment)
        } else if first.is_ascii_digit() {
            (number(rest), Token::Number)
        } else if matches!(first, '@' | '#') {
            (1 + word(&rest[1..]), Token::Attribute)
        } else if is_word(first) {
            let length = word(rest);
            (length, kind(&rest[..length], &rest[length..]))
        } else {
            let length = rest
                .find(|c: char| is_word(c) || matches!(c, '@' | '#' | '/'))
                .unwrap_or(rest.len());
            // A lone slash is no comment.
            (length.max(first.len_utf8()), Token::Plain)
        };
        pieces.push((at..at + length, token));
        at += length;
    }
    pieces
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn word(text: &str) -> usize {
    text.find(|c: char| !is_word(c)).unwrap_or(text.len())
}

fn number(text: &str) -> usize {
    let mut before = ' ';
    let end = text.find(|c: char| {
        let signed = matches!(c, '+' | '-') && matches!(before, 'e' | 'E') && !text.starts_with("0x");
        before = c;
        !(is_word(c) || c == '.' || signed)
    });
    end.unwrap_or(text.len())
}

fn kind(word: &str, after: &str) -> Token {
    let listed = |list: &str| list.split_ascii_whitespace().any(|known| known == word);
    let is_shaped = ["vec", "mat", "texture_", "float", "int", "uint", "metal"].iter().any(|start| {
        word.strip_prefix(start)
            .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()) || *start == "texture_")
    });
    if listed(KEYWORDS) {
        Token::Keyword
    } else if is_shaped || listed(TYPES) {
        Token::Type
    } else if after.starts_with('(') {
        Token::Function
    } else {
        Token::Plain
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(line: &str, in_comment: bool) -> Vec<(&str, Token)> {
        let pieces = pieces(line, in_comment);
        assert!(pieces.windows(2).all(|pair| pair[0].0.end == pair[1].0.start), "{pieces:?}");
        assert_eq!(pieces.last().map_or(0, |(range, _)| range.end), line.len());
        pieces.into_iter().map(|(range, token)| (&line[range], token)).collect()
    }

    /// Catches text that is lost, an endless loop at a slash, and a number that ends at its exponent.
    #[test]
    fn lines_are_cut_into_their_pieces() {
        use Token::*;
        assert_eq!(
            told("let x = f(1.5e-3f) / y; // z", false),
            [
                ("let", Keyword),
                (" ", Plain),
                ("x", Plain),
                (" = ", Plain),
                ("f", Function),
                ("(", Plain),
                ("1.5e-3f", Number),
                (") ", Plain),
                ("/", Plain),
                (" ", Plain),
                ("y", Plain),
                ("; ", Plain),
                ("// z", Comment)
            ]
        );
        assert_eq!(
            told("c */ @group(0)", true),
            [
                ("c */", Comment),
                (" ", Plain),
                ("@group", Attribute),
                ("(", Plain),
                ("0", Number),
                (")", Plain)
            ]
        );
        assert_eq!(told("/* é */é/", false), [("/* é */", Comment), ("é", Plain), ("/", Plain)]);
        assert_eq!(told("", true), [("", Comment)]);
        assert_eq!(
            told("vec3f mat4x4<f32>", false).iter().filter(|(_, token)| *token == Type).count(),
            3
        );
    }
}
