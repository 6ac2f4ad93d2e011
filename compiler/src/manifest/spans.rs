//! Where things stand in a RON text. ron's deserializer gives values without places; this finds the place of a value by its path.

use std::ops::Range;

/// One step from a value to a value inside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step<'a> {
    /// Field of a struct, of a variant or of a map.
    Key(&'a str),
    /// Element of a list, a tuple or a variant.
    Index(usize),
}

/// The places of all values of a RON text.
///
/// It presumes text that ron accepts. On other text it finds less, or things in odd places, but neither panics nor hangs.
#[derive(Clone, Debug)]
pub struct Locator {
    values: Vec<Value>,
    root: Option<usize>,
    unclosed: Option<usize>,
}

#[derive(Clone, Debug)]
struct Value {
    span: Range<usize>,
    entries: Vec<Entry>,
    depth: usize,
}

#[derive(Clone, Debug)]
struct Entry {
    key: Option<(String, Range<usize>)>,
    value: usize,
}

/// A bracket that is still open.
struct Open {
    start: usize,
    /// Name before the bracket: of a struct or a variant.
    name: String,
    entries: Vec<Entry>,
    key: Option<(String, Range<usize>)>,
    last: Option<Last>,
}

/// The value read last, until a comma or bracket tells what it was.
struct Last {
    value: usize,
    /// Its text if it may turn out to be a key or a variant's name.
    text: Option<String>,
}

impl Open {
    fn new(start: usize, name: String) -> Self {
        Self {
            start,
            name,
            entries: Vec::new(),
            key: None,
            last: None,
        }
    }

    /// The value read last is complete.
    fn finish_entry(&mut self) {
        let key = self.key.take();
        if let Some(last) = self.last.take() {
            self.entries.push(Entry { key, value: last.value });
        }
    }
}

impl Locator {
    /// Scans a text.
    pub fn new(text: &str) -> Self {
        let mut values: Vec<Value> = Vec::new();
        let mut open = vec![Open::new(0, String::new())];
        for (token, span) in (Scanner { text, at: 0 }) {
            let depth = open.len();
            // The text's own level is never closed, so there is always a last one.
            let Some(top) = open.last_mut() else { break };
            match token {
                Token::Atom(text) => {
                    values.push(Value {
                        span,
                        entries: Vec::new(),
                        depth: depth - 1,
                    });
                    top.last = Some(Last {
                        value: values.len() - 1,
                        text: Some(text),
                    });
                }
                Token::Colon => {
                    if let Some(Last { value, text: Some(text) }) = top.last.take() {
                        top.key = Some((text, values[value].span.clone()));
                    }
                }
                Token::Comma => top.finish_entry(),
                Token::Open(bracket) => {
                    // `Name(`: the value begins with the name.
                    let named = top.last.take_if(|last| bracket == b'(' && last.text.is_some());
                    let opened = match named {
                        Some(Last { value, text }) => Open::new(values[value].span.start, text.unwrap_or_default()),
                        None => Open::new(span.start, String::new()),
                    };
                    open.push(opened);
                }
                Token::Close if depth > 1 => {
                    let Some(mut closed) = open.pop() else { break };
                    closed.finish_entry();
                    let value = match closed.entries.as_slice() {
                        // An explicit `Some(...)` is as good as its content.
                        [Entry { key: None, value }] if closed.name == "Some" => *value,
                        _ => {
                            values.push(Value {
                                span: closed.start..span.end,
                                entries: closed.entries,
                                depth: depth - 1,
                            });
                            values.len() - 1
                        }
                    };
                    if let Some(top) = open.last_mut() {
                        top.last = Some(Last { value, text: None });
                    }
                }
                Token::Close => {}
            }
        }
        let unclosed = open.last().filter(|_| open.len() > 1).map(|bracket| bracket.start);
        // Brackets left open reach to the end of the text.
        while open.len() > 1 {
            let Some(mut unclosed) = open.pop() else { break };
            unclosed.finish_entry();
            values.push(Value {
                span: unclosed.start..text.len(),
                entries: unclosed.entries,
                depth: open.len(),
            });
            if let Some(top) = open.last_mut() {
                top.last = Some(Last {
                    value: values.len() - 1,
                    text: None,
                });
            }
        }
        // Attributes (`#![enable(...)]`) come before, so that the last value is the one.
        let root = open.first().and_then(|file| file.last.as_ref()).map(|last| last.value);
        Self { values, root, unclosed }
    }

    /// Place of the value at the end of the path, seen from the outermost value.
    pub fn find(&self, path: &[Step]) -> Option<Range<usize>> {
        self.value(path).map(|value| value.span.clone())
    }

    /// Place of the key by which the path's last step is written; `None` where that step is an index.
    pub fn find_key(&self, path: &[Step]) -> Option<Range<usize>> {
        let (Step::Key(name), parent) = path.split_last()? else {
            return None;
        };
        let keys = self.value(parent)?.entries.iter().filter_map(|entry| entry.key.as_ref());
        keys.rev().find(|(key, _)| key == name).map(|(_, span)| span.clone())
    }

    /// Place of the value at the end of the path, or of the last step of the path that is there.
    pub fn find_near(&self, path: &[Step]) -> Range<usize> {
        (0..=path.len()).rev().find_map(|steps| self.find(&path[..steps])).unwrap_or(0..0)
    }

    fn value(&self, path: &[Step]) -> Option<&Value> {
        let mut value = &self.values[self.root?];
        for step in path {
            let next = match step {
                // As in serde's maps, the last one of equal keys counts.
                Step::Key(name) => value
                    .entries
                    .iter()
                    .rev()
                    .find(|e| e.key.as_ref().is_some_and(|(key, _)| key == name)),
                Step::Index(index) => value.entries.get(*index).filter(|entry| entry.key.is_none()),
            };
            value = &self.values[next?.value];
        }
        Some(value)
    }

    /// Place of the outermost value that begins at this byte.
    pub fn starting_at(&self, byte: usize) -> Option<Range<usize>> {
        let here = self.values.iter().filter(|value| value.span.start == byte);
        here.max_by_key(|value| value.span.end).map(|value| value.span.clone())
    }

    /// The byte at which the innermost bracket (or its name) stands that is never closed.
    pub fn unclosed(&self) -> Option<usize> {
        self.unclosed
    }

    /// Path of the innermost value that holds this byte, written for people: `slots.ndf.default[1]`.
    pub fn path_at(&self, byte: usize) -> String {
        let mut path = String::new();
        let mut value = self.root.map(|root| &self.values[root]);
        while let Some(at) = value {
            value = None;
            for (index, entry) in at.entries.iter().enumerate() {
                let inner = &self.values[entry.value];
                let start = entry.key.as_ref().map_or(inner.span.start, |(_, key)| key.start);
                if (start..inner.span.end).contains(&byte) {
                    match &entry.key {
                        Some((key, _)) if path.is_empty() => path.clone_from(key),
                        Some((key, _)) => path = format!("{path}.{key}"),
                        None => path = format!("{path}[{index}]"),
                    }
                    value = Some(inner);
                    break;
                }
            }
        }
        path
    }

    /// Keys that stand twice in one struct or map: name, first and second place. In the order of the second places.
    pub fn duplicates(&self) -> Vec<(&str, Range<usize>, Range<usize>)> {
        let mut found = Vec::new();
        for value in &self.values {
            let mut seen = std::collections::HashMap::new();
            for (key, span) in value.entries.iter().filter_map(|entry| entry.key.as_ref()) {
                match seen.get(key.as_str()) {
                    Some(first) => found.push((key.as_str(), Range::clone(first), span.clone())),
                    None => {
                        seen.insert(key.as_str(), span.clone());
                    }
                }
            }
        }
        found.sort_by_key(|(_, _, second)| second.start);
        found
    }

    /// Place where brackets are first nested deeper than this.
    pub(crate) fn deeper_than(&self, depth: usize) -> Option<Range<usize>> {
        let deep = self.values.iter().filter(|value| value.depth > depth);
        deep.map(|value| value.span.start).min().map(|start| start..start + 1)
    }

    /// First list, map or struct with more elements than this.
    pub(crate) fn longer_than(&self, length: usize) -> Option<Range<usize>> {
        let long = self.values.iter().filter(|value| value.entries.len() > length);
        long.map(|value| value.span.clone()).min_by_key(|span| span.start)
    }
}

enum Token {
    Open(u8),
    Close,
    Comma,
    Colon,
    /// Anything else, with the text of a string or identifier.
    Atom(String),
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

impl Iterator for Scanner<'_> {
    type Item = (Token, Range<usize>);

    fn next(&mut self) -> Option<Self::Item> {
        self.at += blank(&self.text[self.at..]);
        let rest = &self.text[self.at..];
        let first = rest.chars().next()?;
        let (token, width) = match first {
            '(' | '[' | '{' => (Token::Open(rest.as_bytes()[0]), 1),
            ')' | ']' | '}' => (Token::Close, 1),
            ',' => (Token::Comma, 1),
            ':' => (Token::Colon, 1),
            '"' => string(rest),
            '\'' => (Token::Atom(String::new()), character(rest)),
            _ => raw_string(rest).unwrap_or_else(|| word(rest)),
        };
        let span = self.at..self.at + width;
        self.at = span.end;
        Some((token, span))
    }
}

/// Width of the white space and comments that the text begins with.
pub(super) fn blank(text: &str) -> usize {
    let mut at = 0;
    loop {
        let rest = &text[at..];
        let space = rest.len() - rest.trim_start_matches(is_space).len();
        let comment = comment(&rest[space..]);
        at += space + comment;
        if comment == 0 {
            return at;
        }
    }
}

/// RON's white space: Unicode's pattern white space.
fn is_space(c: char) -> bool {
    matches!(c, ' ' | '\t'..='\r' | '\u{85}' | '\u{200E}' | '\u{200F}' | '\u{2028}' | '\u{2029}')
}

fn comment(text: &str) -> usize {
    if text.starts_with("//") {
        return text.find('\n').unwrap_or(text.len());
    }
    if !text.starts_with("/*") {
        return 0;
    }
    let bytes = text.as_bytes();
    let (mut level, mut at) = (0usize, 0);
    while at < bytes.len() {
        match bytes.get(at..at + 2) {
            Some(b"/*") => {
                level += 1;
                at += 2;
            }
            Some(b"*/") => {
                level -= 1;
                at += 2;
                if level == 0 {
                    return at;
                }
            }
            _ => at += 1,
        }
    }
    text.len()
}

fn string(text: &str) -> (Token, usize) {
    let mut escaped = false;
    for (index, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => {
                let quoted = &text[..=index];
                let plain = &quoted[1..quoted.len() - 1];
                // ron undoes the escapes; names rarely have any.
                let escaped = plain.contains('\\').then(|| ron::from_str::<String>(quoted));
                let content = escaped.and_then(Result::ok).unwrap_or_else(|| plain.to_owned());
                return (Token::Atom(content), index + 1);
            }
            _ => {}
        }
    }
    (Token::Atom(String::new()), text.len())
}

fn raw_string(text: &str) -> Option<(Token, usize)> {
    let after = text.strip_prefix("br").or_else(|| text.strip_prefix('r'))?;
    let hashes = after.len() - after.trim_start_matches('#').len();
    let content = after[hashes..].strip_prefix('"')?;
    let start = text.len() - content.len();
    let end = format!("\"{}", "#".repeat(hashes));
    let length = content.find(&end).unwrap_or(content.len());
    let width = (start + length + end.len()).min(text.len());
    Some((Token::Atom(content[..length].to_owned()), width))
}

fn character(text: &str) -> usize {
    let mut escaped = false;
    for (index, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            // `'''` is the character of a quote.
            '\'' if index > 1 || text[1..].starts_with("''") => return index + 1 + usize::from(index == 1),
            '\n' => return index,
            _ => {}
        }
    }
    text.len()
}

fn word(text: &str) -> (Token, usize) {
    let ends = |(index, c): &(usize, char)| {
        is_space(*c)
            || matches!(c, '(' | ')' | '[' | ']' | '{' | '}' | ',' | ':' | '"')
            || *c == '/' && (text[*index..].starts_with("//") || text[*index..].starts_with("/*"))
    };
    let first = text.chars().next().map_or(0, char::len_utf8);
    let width = text
        .char_indices()
        .skip(1)
        .find(ends)
        .map_or(text.len(), |(index, _)| index)
        .max(first);
    let name = text[..width].strip_prefix("r#").unwrap_or(&text[..width]);
    (Token::Atom(name.to_owned()), width)
}

#[cfg(test)]
mod tests;
