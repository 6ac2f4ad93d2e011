//! Which bytes of a file fall away by `@if`, `@elif` and `@else`. wesl decides the same on its tree, but keeps no places of parameters and
//! cases, and no comments; what is found here is held against it in the end.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use super::tokens::Token;

/// Bytes of what the conditions take away, in order: dead nodes whole, with the comments above them, and the conditions of living ones.
pub(super) fn dead(text: &str, tokens: &[Token], features: &BTreeMap<String, bool>) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    // Whether a condition of the chain was true, by the depth at which it stands.
    let mut chains: HashMap<i32, bool> = HashMap::new();
    let mut depth = 0;
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        if token.text != "@" {
            depth += token.nesting;
            at += 1;
            continue;
        }
        let (attributes, node) = attributes(tokens, at);
        let condition = attributes
            .iter()
            .find(|a| matches!(tokens[a.start + 1].text, "if" | "elif" | "else"));
        let Some(condition) = condition else {
            at = node;
            continue;
        };
        let word = tokens[condition.start + 1].text;
        let chosen = word != "if" && chains.get(&depth).copied().unwrap_or_default();
        let holds = word == "else"
            || Conditions {
                tokens,
                features,
                at: condition.start + 2,
            }
            .any();
        chains.insert(depth, chosen || holds);
        if holds && !chosen {
            found.push(tokens[condition.start].span.start..tokens[condition.end - 1].span.end);
            at = node;
        } else {
            let end = end_of_node(tokens, node).max(node);
            let start = comment_above(text, tokens[at].span.start);
            found.push(start..tokens[end - 1].span.end);
            at = end;
        }
    }
    found.sort_by_key(|range| (range.start, range.end));
    found
}

/// The tokens of each of the attributes that begin here, and the index behind them.
fn attributes(tokens: &[Token], mut at: usize) -> (Vec<Range<usize>>, usize) {
    let mut found = Vec::new();
    while tokens.get(at).is_some_and(|t| t.text == "@") && tokens.len() > at + 1 {
        let start = at;
        at += 2;
        if tokens.get(at).is_some_and(|t| t.text == "(") {
            at = closing(tokens, at) + 1;
        }
        found.push(start..at.min(tokens.len()));
    }
    (found, at.min(tokens.len()))
}

/// Index of the token that closes what opens here; the last token where none does.
fn closing(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate().skip(open) {
        depth += token.nesting;
        if depth == 0 {
            return at;
        }
    }
    tokens.len() - 1
}

/// Index behind a declaration, statement, clause, member or parameter.
fn end_of_node(tokens: &[Token], node: usize) -> usize {
    let mut at = node;
    while let Some(token) = tokens.get(at) {
        match token.text {
            ";" | "," => return at + 1,
            "{" => {
                at = closing(tokens, at) + 1;
                if tokens.get(at).is_none_or(|t| t.text != "else") {
                    return at;
                }
            }
            // The bracket around the list in which it is the last.
            _ if token.nesting < 0 => return at,
            _ if token.nesting > 0 => at = closing(tokens, at) + 1,
            _ => at += 1,
        }
    }
    tokens.len()
}

/// Start of the comment lines directly above, or the place itself.
pub(super) fn comment_above(text: &str, place: usize) -> usize {
    let line = |end: usize| text[..end].rfind('\n').map_or(0, |newline| newline + 1);
    let mut start = line(place);
    if !text[start..place].trim().is_empty() {
        return place;
    }
    let mut first = place;
    while start > 0 {
        let above = line(start - 1);
        if !text[above..start].trim_start().starts_with("//") {
            break;
        }
        start = above;
        first = start;
    }
    first
}

/// Reads a condition: `||`, `&&`, `!`, brackets, `true`, `false`, features.
struct Conditions<'a> {
    tokens: &'a [Token<'a>],
    features: &'a BTreeMap<String, bool>,
    at: usize,
}

impl Conditions<'_> {
    fn next(&mut self, text: &str) -> bool {
        let is = self.tokens.get(self.at).is_some_and(|t| t.text == text);
        self.at += usize::from(is);
        is
    }

    fn any(&mut self) -> bool {
        let mut value = self.all();
        while self.next("||") {
            value |= self.all();
        }
        value
    }

    fn all(&mut self) -> bool {
        let mut value = self.one();
        while self.next("&&") {
            value &= self.one();
        }
        value
    }

    fn one(&mut self) -> bool {
        if self.next("!") {
            return !self.one();
        }
        if self.next("(") {
            let value = self.any();
            self.next(")");
            return value;
        }
        let name = self.tokens.get(self.at).map_or("", |t| t.text);
        self.at += 1;
        name == "true" || self.features.get(name).copied().unwrap_or_default()
    }
}
