//! The authors' text with what wesl decided carried out on it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use shadewright_compiler::diagnostics::{Part, SourceFile};
use wesl::CompileResult;
use wesl::syntax::{GlobalDeclarationNode, TranslationUnit};
use wgsl_parse::SyntaxNode;

use super::conditions::{comment_above, dead};
use super::files::Files;
use super::names::Names;
use super::tokens::{Token, tokens};

/// A text that grows by parts.
#[derive(Default)]
struct Text {
    text: String,
    parts: Vec<Part>,
}

impl Text {
    /// Adds these bytes of a file with those replaced that edits say; edits are in order and apart.
    fn push(&mut self, file: &Arc<SourceFile>, span: Range<usize>, edits: &[(Range<usize>, String)]) {
        let mut at = span.start;
        for (range, new) in edits.iter().filter(|(r, _)| span.start <= r.start && r.end <= span.end) {
            if range.start < at {
                continue;
            }
            self.part(file, at..range.start, None);
            self.part(file, range.clone(), Some(new));
            at = range.end;
        }
        self.part(file, at..span.end, None);
    }

    fn part(&mut self, file: &Arc<SourceFile>, span: Range<usize>, new: Option<&str>) {
        let start = self.text.len();
        self.text.push_str(new.unwrap_or(&file.text[span.clone()]));
        if self.text.len() > start {
            self.parts.push(Part {
                text: start..self.text.len(),
                file: Arc::clone(file),
                span,
            });
        }
    }
}

/// A file that takes part, with what falls away of it.
struct Source<'a> {
    file: &'a Arc<SourceFile>,
    tokens: Vec<Token<'a>>,
    dead: Vec<Range<usize>>,
}

impl<'a> Source<'a> {
    fn new(file: &'a Arc<SourceFile>, features: &BTreeMap<String, bool>) -> Self {
        let tokens = tokens(&file.text);
        let dead = dead(&file.text, &tokens, features);
        Self { file, tokens, dead }
    }

    fn lives(&self, span: &Range<usize>) -> bool {
        !self.dead.iter().any(|d| d.start <= span.start && span.end <= d.end)
    }

    /// Living tokens within these bytes.
    fn within(&self, span: &Range<usize>) -> Vec<&Token<'a>> {
        let inside = |t: &&Token| span.start <= t.span.start && t.span.end <= span.end;
        self.tokens.iter().filter(inside).filter(|t| self.lives(&t.span)).collect()
    }

    /// Edits that take these bytes away, of the text within `span`: with the blanks between them, and a line of which nothing is left whole.
    fn without(&self, mut gone: Vec<Range<usize>>, span: &Range<usize>) -> Vec<(Range<usize>, String)> {
        let text = &self.file.text;
        gone.retain(|g| span.start <= g.start && g.end <= span.end);
        gone.sort_by_key(|g| (g.start, g.end));
        let mut merged: Vec<Range<usize>> = Vec::new();
        for range in gone {
            match merged.last_mut() {
                Some(last) if range.start <= last.end || text[last.end..range.start].trim().is_empty() => {
                    last.end = last.end.max(range.end)
                }
                _ => merged.push(range),
            }
        }
        for range in &mut merged {
            let start = text[..range.start].rfind('\n').map_or(0, |newline| newline + 1).max(span.start);
            let end = text[range.end..]
                .find('\n')
                .map_or(text.len(), |newline| range.end + newline + 1)
                .min(span.end);
            if text[start..range.start].trim().is_empty() && text[range.end..end].trim().is_empty() {
                *range = start..end;
            } else if text[start..range.start].ends_with(char::is_whitespace) || range.start == start {
                let blanks = text[range.end..end].len() - text[range.end..end].trim_start_matches([' ', '\t']).len();
                range.end += blanks;
            }
        }
        merged.into_iter().map(|range| (range, String::new())).collect()
    }

    /// Directives: each a word at the top level, up to its semicolon.
    fn directives(&self, before: usize) -> Vec<Range<usize>> {
        let head = self.within(&(0..before));
        let mut found = Vec::new();
        let mut at = 0;
        while let Some(token) = head.get(at) {
            let end = (at..head.len()).find(|&i| head[i].text == ";").unwrap_or(head.len() - 1);
            if matches!(token.text, "enable" | "requires" | "diagnostic") {
                found.push(token.span.start..head[end].span.end);
            }
            at = end + 1;
        }
        found
    }

    /// Edits that make of a declaration what wesl made of it. Where that fails, the declaration as wesl writes it, without its comments.
    fn edits(&self, declaration: &GlobalDeclarationNode) -> Vec<(Range<usize>, String)> {
        let span = declaration.span().range();
        let wanted = declaration.to_string();
        let mut edits = self.without(self.dead.clone(), &span);
        edits.extend(self.renames(&span, &wanted));
        edits.sort_by_key(|(range, _)| (range.start, range.end));
        let mut text = Text::default();
        text.push(self.file, span.clone(), &edits);
        if printed(&text.text) == Some(vec![wanted.clone()]) {
            return edits;
        }
        vec![(span, wanted)]
    }

    /// The words of a declaration that have another name in wesl's form of it. Both have the same words in the same order, paths apart.
    fn renames(&self, span: &Range<usize>, wanted: &str) -> Vec<(Range<usize>, String)> {
        let here = words(&self.within(span));
        let all = tokens(wanted);
        let there = words(&all.iter().collect::<Vec<_>>());
        if here.len() != there.len() {
            return Vec::new();
        }
        let pairs = here.into_iter().zip(there);
        pairs
            .filter(|((range, _), (_, name))| self.file.text[range.clone()] != **name)
            .map(|((range, _), (_, name))| (range, name.to_owned()))
            .collect()
    }
}

/// Words with their places; a path `a::b` is one, by its last word.
fn words<'a>(tokens: &[&Token<'a>]) -> Vec<(Range<usize>, &'a str)> {
    let mut found: Vec<(Range<usize>, &str)> = Vec::new();
    let mut goes_on = false;
    for token in tokens {
        if token.text == "::" {
            goes_on = true;
        } else if token.is_word() {
            match found.last_mut().filter(|_| goes_on) {
                Some((range, name)) => (range.end, *name) = (token.span.end, token.text),
                None => found.push((token.span.clone(), token.text)),
            }
            goes_on = false;
        } else {
            goes_on = false;
        }
    }
    found
}

/// Declarations of a text as wesl writes them; `None` where it is none.
fn printed(text: &str) -> Option<Vec<String>> {
    let unit: TranslationUnit = text.parse().ok()?;
    Some(unit.global_declarations.iter().map(ToString::to_string).collect())
}

/// What stands for a module's `NAME.wgsl`: imported directives, the module's own text, imported declarations.
pub(super) fn splice(
    path: String,
    files: &Files,
    names: &Names,
    result: &CompileResult,
    features: &BTreeMap<String, bool>,
) -> Arc<SourceFile> {
    let seen = files.seen();
    let sources: Vec<Source> = seen.iter().map(|(_, file)| Source::new(file, features)).collect();
    // By name; an assertion has none, and is by its text the first file's that has it.
    let home = |declaration: &GlobalDeclarationNode| {
        let by_name = declaration.ident().map(|id| {
            let path = names.home(&id.name());
            path.and_then(|path| seen.iter().position(|(p, _)| p.components == path))
                .unwrap_or(0)
        });
        by_name.or_else(|| {
            let same = |source: &Source| {
                let text = source.file.text.get(declaration.span().range());
                text.is_some_and(|text| text.contains("const_assert"))
            };
            sources.iter().position(same)
        })
    };
    let mut own = Vec::new();
    let mut imported = Vec::new();
    for declaration in &result.syntax.global_declarations {
        match home(declaration) {
            Some(0) => own.push(declaration),
            Some(file) => imported.push((file, declaration)),
            None => {}
        }
    }

    imported.sort_by_key(|(file, declaration)| (*file, declaration.span().start));

    let mut text = Text::default();
    for source in sources.iter().skip(1) {
        for directive in source.directives(source.first_declaration()) {
            text.push(source.file, directive, &[]);
            text.text.push('\n');
        }
    }
    // Sources are never empty: the module's own file is the first.
    let root = &sources[0];
    text.push(root.file, 0..root.file.text.len(), &root_edits(root, &own));
    for (index, declaration) in imported {
        let source = &sources[index];
        let span = declaration.span().range();
        text.text.push_str("\n\n");
        text.push(
            source.file,
            comment_above(&source.file.text, span.start)..span.end,
            &source.edits(declaration),
        );
    }
    text.text.push('\n');

    let mut wanted: Vec<String> = result.syntax.global_declarations.iter().map(ToString::to_string).collect();
    let mut got = printed(&text.text).unwrap_or_default();
    wanted.retain(|declaration| declaration != ";");
    got.retain(|declaration| declaration != ";");
    wanted.sort();
    got.sort();
    if wanted == got {
        return SourceFile::made(path, text.text, text.parts);
    }
    // wesl's own form: the same shader, without comments, and all of it at the module's file.
    let whole = result.syntax.to_string();
    let part = Part {
        text: 0..whole.len(),
        file: Arc::clone(root.file),
        span: 0..root.file.text.len(),
    };
    SourceFile::made(path, whole, vec![part])
}

impl Source<'_> {
    /// Where imports and directives end.
    fn first_declaration(&self) -> usize {
        let mut at = 0;
        let head = |word: &str| matches!(word, "import" | "enable" | "requires" | "diagnostic");
        let mut end = 0;
        while let Some(token) = self.tokens.get(at) {
            // Attributes of an import or directive stand before it.
            let first = (at..self.tokens.len()).find(|&i| head(self.tokens[i].text));
            let stop = (at..self.tokens.len()).find(|&i| self.tokens[i].text == ";");
            let (Some(first), Some(stop)) = (first, stop) else { break };
            if first > stop || (first != at && token.text != "@") {
                break;
            }
            end = self.tokens[stop].span.end;
            at = stop + 1;
        }
        end
    }
}

/// Edits of the module's own file: its declarations as wesl wants them, and nothing of what is neither one of them nor a directive nor a
/// comment.
fn root_edits(root: &Source, own: &[&GlobalDeclarationNode]) -> Vec<(Range<usize>, String)> {
    let mut kept: Vec<Range<usize>> = own.iter().map(|declaration| declaration.span().range()).collect();
    kept.extend(root.directives(root.first_declaration()));
    let outside = |span: &Range<usize>| !kept.iter().any(|k| k.start <= span.start && span.end <= k.end);
    let rest = root.tokens.iter().filter(|t| root.lives(&t.span)).map(|t| t.span.clone());
    let gone = root.dead.iter().cloned().chain(rest).filter(outside).collect();
    let mut edits = root.without(gone, &(0..root.file.text.len()));
    edits.extend(own.iter().flat_map(|declaration| root.edits(declaration)));
    edits.sort_by_key(|(range, _)| (range.start, std::cmp::Reverse(range.end)));
    edits
}
