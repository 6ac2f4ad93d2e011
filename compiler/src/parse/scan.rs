//! The module-scope items of WGSL text and the names they refer to.
//!
//! This is no parser: naga parses every module and judges it. The scanner finds out, of text that naga accepts,
//! where each item stands and which of its words refer to module-scope names, so that the authors' own text can be
//! linked. Of text that naga refuses it may say anything, but never panics.

use std::ops::Range;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use super::lex::{Kind, Token, lex};

/// What a module-scope item is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ItemKind {
    /// `enable`, `requires`, `diagnostic`
    Directive,
    /// `fn`
    Function,
    /// `struct`
    Struct,
    /// `alias`
    Alias,
    /// `const`
    Constant,
    /// `override`
    Override,
    /// `var`
    Variable,
    /// `const_assert`
    Assertion,
}

/// A word that refers to a module-scope or predeclared name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    /// Index into [`Scan::tokens`].
    pub token: usize,
}

/// A member of a struct or a parameter of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Tokens from its first attribute to the end of its type.
    pub tokens: Range<usize>,
    /// Tokens of its type.
    pub ty: Range<usize>,
}

/// A module-scope item.
#[derive(Clone, Debug)]
pub struct Item {
    /// What it is.
    pub kind: ItemKind,
    /// Declared name; empty for directives and assertions.
    pub name: String,
    /// Bytes of the name.
    pub name_span: Range<usize>,
    /// Tokens from the first attribute to the closing brace or semicolon.
    pub tokens: Range<usize>,
    /// Bytes of the same.
    pub span: Range<usize>,
    /// Line of its first byte, from 1.
    pub line: usize,
    /// First byte of the comment lines that stand directly above, or of the item where there are none.
    pub doc_start: usize,
    /// Words that refer to names outside the item.
    pub references: Vec<Reference>,
    /// Names declared inside the item (parameters, locals).
    pub locals: HashSet<String>,
    /// Members of a struct, parameters of a function.
    pub fields: Vec<Field>,
    /// Tokens of a function's result after `->` with its attributes; empty without.
    pub result: Range<usize>,
    /// Tokens of a function's body with its braces; empty for other items.
    pub body: Range<usize>,
    /// Whether a constant or override states its type.
    pub typed: bool,
}

/// Scanned text.
#[derive(Clone, Debug, Default)]
pub struct Scan {
    /// All tokens.
    pub tokens: Vec<Token>,
    /// Items in the order of the text.
    pub items: Vec<Item>,
    /// The first item of each name.
    by_name: HashMap<String, usize>,
}

impl Scan {
    /// The item that declares this name.
    pub fn item(&self, name: &str) -> Option<&Item> {
        self.by_name.get(name).map(|&index| &self.items[index])
    }

    /// Directives.
    pub fn directives(&self) -> impl Iterator<Item = &Item> {
        // They stand before everything else.
        self.items.iter().take_while(|item| item.kind == ItemKind::Directive)
    }

    /// Its index in [`Scan::items`].
    pub fn item_index(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Bytes of a range of tokens; empty for an empty range.
    pub fn bytes(&self, tokens: &Range<usize>) -> Range<usize> {
        match (
            self.tokens.get(tokens.start),
            tokens.end.checked_sub(1).and_then(|last| self.tokens.get(last)),
        ) {
            (Some(first), Some(last)) if first.start <= last.start => first.start as usize..last.end as usize,
            _ => 0..0,
        }
    }
}

/// Scans text.
pub fn scan(text: &str) -> Scan {
    let tokens = lex(text);
    let mut items: Vec<Item> = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if tokens[at].is(b';') {
            at += 1;
            continue;
        }
        let end = item_end(text, &tokens, at);
        if let Some(item) = scan_item(text, &tokens, at..end) {
            items.push(item);
        }
        at = end;
    }
    let (mut line, mut counted) = (1, 0);
    for item in &mut items {
        line += text[counted..item.span.start].bytes().filter(|&b| b == b'\n').count();
        counted = item.span.start;
        item.line = line;
    }
    let mut by_name = HashMap::default();
    for (index, item) in items.iter().enumerate().filter(|(_, i)| !i.name.is_empty()) {
        by_name.entry(item.name.clone()).or_insert(index);
    }
    Scan { tokens, items, by_name }
}

/// One past the item's last token: its semicolon, or the brace that closes its body.
fn item_end(text: &str, tokens: &[Token], from: usize) -> usize {
    let mut depth = 0usize;
    let braced = keyword_at(text, tokens, from).is_some_and(|(_, word)| matches!(word, "fn" | "struct"));
    for (index, token) in tokens.iter().enumerate().skip(from) {
        match token.kind {
            Kind::Mark(b'{' | b'(' | b'[') => depth += 1,
            Kind::Mark(b'}' | b')' | b']') => {
                depth = depth.saturating_sub(1);
                if braced && depth == 0 && token.is(b'}') {
                    return index + 1;
                }
            }
            Kind::Mark(b';') if depth == 0 => return index + 1,
            _ => {}
        }
    }
    tokens.len()
}

/// The item's keyword, after its attributes.
fn keyword_at<'t>(text: &'t str, tokens: &[Token], from: usize) -> Option<(usize, &'t str)> {
    let mut at = from;
    while tokens.get(at)?.is(b'@') {
        at += 2;
        if tokens.get(at)?.is(b'(') {
            at = closing(tokens, at)? + 1;
        }
    }
    let token = tokens.get(at)?;
    (token.kind == Kind::Word).then(|| (at, &text[token.range()]))
}

/// The token that closes the bracket at `open`.
pub fn closing(tokens: &[Token], open: usize) -> Option<usize> {
    let mut depth = 0usize;
    for (index, token) in tokens.iter().enumerate().skip(open) {
        match token.kind {
            Kind::Mark(b'{' | b'(' | b'[') => depth += 1,
            Kind::Mark(b'}' | b')' | b']') => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    return Some(index);
                }
            }
            _ => {}
        }
    }
    None
}

fn scan_item(text: &str, tokens: &[Token], range: Range<usize>) -> Option<Item> {
    let (keyword, word) = keyword_at(text, tokens, range.start)?;
    let kind = match word {
        "enable" | "requires" | "diagnostic" => ItemKind::Directive,
        "fn" => ItemKind::Function,
        "struct" => ItemKind::Struct,
        "alias" => ItemKind::Alias,
        "const" => ItemKind::Constant,
        "override" => ItemKind::Override,
        "var" => ItemKind::Variable,
        "const_assert" => ItemKind::Assertion,
        _ => return None,
    };
    let mut name_at = keyword + 1;
    if kind == ItemKind::Variable && tokens.get(name_at).is_some_and(|t| t.is(b'<')) {
        name_at = angle_end(tokens, name_at);
    }
    let named = !matches!(kind, ItemKind::Directive | ItemKind::Assertion);
    let name_token = tokens.get(name_at).filter(|t| named && t.kind == Kind::Word && name_at < range.end);
    let (name, name_span) = name_token.map_or((String::new(), 0..0), |t| (text[t.range()].to_owned(), t.range()));
    let span = tokens[range.start].start as usize..tokens[range.end - 1].end as usize;
    let mut item = Item {
        kind,
        name,
        name_span,
        line: 0,
        doc_start: doc_start(text, span.start),
        span,
        tokens: range.clone(),
        references: Vec::new(),
        locals: HashSet::default(),
        fields: Vec::new(),
        result: 0..0,
        body: 0..0,
        typed: tokens.get(name_at + 1).is_some_and(|t| t.is(b':')),
    };
    match kind {
        ItemKind::Function => scan_function(text, tokens, name_at, &mut item),
        ItemKind::Struct => {
            if let Some(close) = closing(tokens, name_at + 1).filter(|&c| c < range.end) {
                item.fields = fields(text, tokens, name_at + 2..close);
                for field in item.fields.clone() {
                    references(text, tokens, attribute_range(&field, tokens), &mut item.references);
                    references(text, tokens, field.ty, &mut item.references);
                }
            }
        }
        ItemKind::Directive => {}
        // The address space and access mode in `var<...>` are no references: skip to the name.
        _ => {
            references(text, tokens, range.start..keyword, &mut item.references);
            let first = if named { name_at + 1 } else { keyword + 1 };
            references(text, tokens, first.min(range.end)..range.end, &mut item.references);
        }
    }
    Some(item)
}

/// One past the `>` that closes the template list at `open`.
fn angle_end(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0usize;
    for (index, token) in tokens.iter().enumerate().skip(open) {
        match token.kind {
            Kind::Mark(b'<') => depth += 1,
            Kind::Mark(b'>') => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    return index + 1;
                }
            }
            Kind::Mark(b';' | b'{') => return index,
            _ => {}
        }
    }
    tokens.len()
}

/// First byte of the block of whole-line comments right above `start`.
fn doc_start(text: &str, start: usize) -> usize {
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

/// Members or parameters: `attributes name: type`, separated by commas.
fn fields(text: &str, tokens: &[Token], range: Range<usize>) -> Vec<Field> {
    let mut fields = Vec::new();
    let mut first = range.start;
    let mut depth = 0usize;
    let mut angle = 0usize;
    for at in range.start..=range.end {
        let ends = at == range.end || (depth == 0 && angle == 0 && tokens[at].is(b','));
        if ends {
            if let Some((name_at, name)) = keyword_at(text, tokens, first).filter(|&(n, _)| n < at) {
                fields.push(Field {
                    name: name.to_owned(),
                    tokens: first..at,
                    ty: (name_at + 2).min(at)..at,
                });
            }
            first = at + 1;
            continue;
        }
        match tokens[at].kind {
            Kind::Mark(b'(' | b'[') => depth += 1,
            Kind::Mark(b')' | b']') => depth = depth.saturating_sub(1),
            Kind::Mark(b'<') => angle += 1,
            Kind::Mark(b'>') => angle = angle.saturating_sub(1),
            _ => {}
        }
    }
    fields
}

/// A field's attributes: everything before its name.
fn attribute_range(field: &Field, tokens: &[Token]) -> Range<usize> {
    let mut end = field.tokens.start;
    while end < field.tokens.end && tokens[end].is(b'@') {
        end += 2;
        if tokens.get(end).is_some_and(|t| t.is(b'(')) {
            end = closing(tokens, end).map_or(field.tokens.end, |c| c + 1);
        }
    }
    field.tokens.start..end.min(field.tokens.end)
}

/// Words of a stretch without declarations that refer to names outside.
fn references(text: &str, tokens: &[Token], range: Range<usize>, out: &mut Vec<Reference>) {
    let mut walker = Walker {
        text,
        tokens,
        out,
        locals: None,
    };
    walker.walk(range);
}

fn scan_function(text: &str, tokens: &[Token], name_at: usize, item: &mut Item) {
    let range = item.tokens.clone();
    let Some(close) = closing(tokens, name_at + 1).filter(|&c| c < range.end) else {
        return;
    };
    // The attributes; the word before the name is `fn`.
    references(text, tokens, range.start..name_at - 1, &mut item.references);
    item.fields = fields(text, tokens, name_at + 2..close);
    for field in item.fields.clone() {
        references(text, tokens, attribute_range(&field, tokens), &mut item.references);
        references(text, tokens, field.ty, &mut item.references);
        item.locals.insert(field.name);
    }
    let Some(open) = (close + 1..range.end).find(|&at| tokens[at].is(b'{')) else {
        return;
    };
    item.body = open..range.end;
    if tokens[close + 1].is(b'-') {
        item.result = close + 3..open;
        references(text, tokens, item.result.clone(), &mut item.references);
    }
    let mut locals = Locals {
        scopes: vec![item.fields.iter().map(|f| f.name.clone()).collect()],
        all: std::mem::take(&mut item.locals),
    };
    let mut walker = Walker {
        text,
        tokens,
        out: &mut item.references,
        locals: Some(&mut locals),
    };
    walker.walk(item.body.clone());
    item.locals = locals.all;
}

/// Names declared so far in a function, scope by scope.
struct Locals {
    scopes: Vec<HashSet<String>>,
    all: HashSet<String>,
}

struct Walker<'a> {
    text: &'a str,
    tokens: &'a [Token],
    out: &'a mut Vec<Reference>,
    locals: Option<&'a mut Locals>,
}

impl Walker<'_> {
    fn walk(&mut self, range: Range<usize>) {
        // Declared at the next semicolon: an initialiser does not see its own name.
        let mut pending: Option<String> = None;
        // Braces opened so far: whether closing one also closes the scope of a `for` header.
        let mut braces: Vec<bool> = Vec::new();
        let mut for_header = false;
        let mut parens = 0usize;
        let mut at = range.start;
        while at < range.end {
            let token = self.tokens[at];
            match token.kind {
                Kind::Mark(b'@') => {
                    at = self.attribute(at, range.end);
                    continue;
                }
                Kind::Mark(b'.') => {
                    // The word behind it is a member.
                    at += 2;
                    continue;
                }
                Kind::Mark(b'(') => parens += 1,
                Kind::Mark(b')') => parens = parens.saturating_sub(1),
                Kind::Mark(b'{') => {
                    braces.push(for_header && parens == 0);
                    for_header = false;
                    self.push();
                }
                Kind::Mark(b'}') => {
                    self.pop();
                    if braces.pop() == Some(true) {
                        self.pop();
                    }
                }
                Kind::Mark(b';') => {
                    if let Some(name) = pending.take() {
                        self.declare(name);
                    }
                }
                Kind::Word => match &self.text[token.range()] {
                    "let" | "const" | "var" if self.locals.is_some() => {
                        let mut name_at = at + 1;
                        if self.tokens.get(name_at).is_some_and(|t| t.is(b'<')) {
                            name_at = angle_end(self.tokens, name_at);
                        }
                        if let Some(name) = self.tokens.get(name_at).filter(|t| t.kind == Kind::Word) {
                            pending = Some(self.text[name.range()].to_owned());
                        }
                        at = name_at + 1;
                        continue;
                    }
                    "for" if self.locals.is_some() => {
                        for_header = true;
                        self.push();
                    }
                    word => {
                        let local = self.locals.as_ref().is_some_and(|l| l.scopes.iter().any(|s| s.contains(word)));
                        if !local {
                            self.out.push(Reference { token: at });
                        }
                    }
                },
                _ => {}
            }
            at += 1;
        }
    }

    /// Skips an attribute's name, and its arguments where they are names of the language.
    fn attribute(&mut self, at: usize, end: usize) -> usize {
        let Some(name) = self.tokens.get(at + 1) else { return end };
        let fixed = matches!(&self.text[name.range()], "builtin" | "interpolate" | "diagnostic");
        if fixed && self.tokens.get(at + 2).is_some_and(|t| t.is(b'(')) {
            return closing(self.tokens, at + 2).map_or(end, |c| c + 1).min(end);
        }
        (at + 2).min(end)
    }

    fn push(&mut self) {
        if let Some(locals) = &mut self.locals {
            locals.scopes.push(HashSet::default());
        }
    }

    fn pop(&mut self) {
        if let Some(locals) = &mut self.locals
            && locals.scopes.len() > 1
        {
            locals.scopes.pop();
        }
    }

    fn declare(&mut self, name: String) {
        if let Some(locals) = &mut self.locals {
            locals.all.insert(name.clone());
            if let Some(scope) = locals.scopes.last_mut() {
                scope.insert(name);
            }
        }
    }
}

#[cfg(test)]
mod tests;
