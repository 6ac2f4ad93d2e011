//! Where a function's statements stand in its author's text, and which stretch goes when one of them goes.
//!
//! The IR tells what is dead and, by its spans, where that stands. All that is found here is the same whatever the function is
//! linked to: linking chooses which of the cuts are made.

use std::ops::Range;

use naga::{Block, Expression, Function, Handle, Span, Statement};

use super::branches::{Choice, choice, leaves, reachable};
use super::lex::{Kind, Token, short_circuits};
use super::lines::whole_lines;
use super::scan::{Item, closing};
use super::unit::Unit;

/// A `let`, or an assignment to `_`.
#[derive(Debug)]
pub struct Let {
    /// First byte.
    pub start: usize,
    /// What goes with it.
    pub cut: Range<usize>,
    /// Whether it is an assignment to `_`.
    pub phony: bool,
    /// Whether its value acts whatever is linked.
    pub acts: bool,
    /// Functions that its value calls.
    pub callees: Vec<Handle<Function>>,
    /// First bytes of the words that may read it.
    pub uses: Vec<usize>,
    /// Its value.
    pub value: Value,
}

/// What the IR knows of the value of a `let`.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// This expression.
    Expression(Handle<Expression>),
    /// It is another name for an earlier one.
    Earlier(usize),
    /// Nothing.
    Unknown,
}

/// A constructor that may be a struct's.
#[derive(Debug)]
pub struct Constructor {
    /// The name that stands there.
    pub name: String,
    /// Tokens of the brackets and of the commas between the arguments.
    pub bounds: Vec<usize>,
}

/// The stretches of a function's text that may go.
#[derive(Debug, Default)]
pub struct Cuts {
    /// Sides of branches that are never taken, with the words around them, and what stands behind a statement that always leaves.
    /// They always go.
    pub branches: Vec<Range<usize>>,
    /// Stores, in the order of the facts.
    pub stores: Vec<Option<Range<usize>>>,
    /// Calls that are statements of their own, in the order of the facts.
    pub calls: Vec<Option<Range<usize>>>,
    /// In the order of the text.
    pub lets: Vec<Let>,
    /// In the order of the text.
    pub constructors: Vec<Constructor>,
}

/// Finds the cuts of a function.
pub fn cuts(unit: &Unit, function: &Function, item: &Item) -> Cuts {
    let mut finder = Finder {
        unit,
        function,
        item,
        text: &unit.file.text,
        tokens: &unit.scan.tokens,
        cuts: Cuts::default(),
    };
    finder.block(&function.body);
    finder.lets();
    finder.constructors();
    finder.cuts
}

struct Finder<'a> {
    unit: &'a Unit,
    function: &'a Function,
    item: &'a Item,
    text: &'a str,
    tokens: &'a [Token],
    cuts: Cuts,
}

impl Finder<'_> {
    fn block(&mut self, block: &Block) {
        let ir = &self.unit.ir;
        let mut last = None;
        let mut count = 0;
        for (statement, &span) in reachable(ir, self.function, block) {
            count += 1;
            self.statement(statement, span);
            last = Some((statement, span));
        }
        // What stands behind a statement that leaves, such as a branch that is always taken.
        if let Some((statement, span)) = last
            && count < block.len()
            && leaves(ir, self.function, statement)
        {
            self.rest_of_block(span);
        }
    }

    fn statement(&mut self, statement: &Statement, span: Span) {
        match statement {
            Statement::Block(inner) => self.block(inner),
            Statement::If { condition, accept, reject } => {
                let choice = choice(&self.unit.ir, self.function, *condition, accept, reject);
                if choice != Choice::Open {
                    self.branch(span, choice);
                }
                if choice != Choice::Reject {
                    self.block(accept);
                }
                if choice != Choice::Accept {
                    self.block(reject);
                }
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|c| self.block(&c.body)),
            Statement::Loop { body, continuing, .. } => {
                self.block(body);
                self.block(continuing);
            }
            Statement::Store { .. } => {
                let cut = self.token_at(span).and_then(|first| self.whole_statement(first));
                self.cuts.stores.push(cut);
            }
            Statement::Call { function: callee, .. } => {
                let cut = self.call_statement(span, *callee);
                self.cuts.calls.push(cut);
            }
            _ => {}
        }
    }

    /// A call that is a statement of its own goes with its semicolon; others go with the statement around them.
    fn call_statement(&self, span: Span, callee: Handle<Function>) -> Option<Range<usize>> {
        let first = self.token_at(span)?;
        let name = self.unit.ir.functions[callee].name.as_deref()?;
        let before = self.tokens.get(first.checked_sub(1)?)?;
        let starts = before.is(b';') || before.is(b'{') || before.is(b'}') || self.starts_for(first);
        if self.word(first) == name && starts {
            return self.whole_statement(first);
        }
        None
    }

    /// The token at the start of a span, if it is inside this function's body.
    fn token_at(&self, span: Span) -> Option<usize> {
        let start = span.to_range()?.start as u32;
        let first = self.item.body.start + self.tokens[self.item.body.clone()].partition_point(|t| t.start < start);
        (self.item.body.contains(&first) && self.tokens[first].start == start).then_some(first)
    }

    fn word(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |t| &self.text[t.range()])
    }

    /// Whether a statement is the first of a `for`'s header.
    fn starts_for(&self, first: usize) -> bool {
        first >= 2 && self.tokens[first - 1].is(b'(') && self.word(first - 2) == "for"
    }

    /// From the statement's first token to its semicolon. In the header of a `for` the marks stay.
    fn whole_statement(&self, first: usize) -> Option<Range<usize>> {
        let start = self.tokens[first].start as usize;
        let mut depth = 0usize;
        for at in first..self.item.body.end {
            match self.tokens[at].kind {
                Kind::Mark(b')') if depth == 0 => return Some(start..self.tokens[at].start as usize),
                Kind::Mark(b';') if depth == 0 && self.starts_for(first) => return Some(start..self.tokens[at].start as usize),
                Kind::Mark(b'(' | b'[' | b'{') => depth += 1,
                Kind::Mark(b')' | b']' | b'}') => depth = depth.saturating_sub(1),
                Kind::Mark(b';') if depth == 0 => return Some(self.lines(start..self.tokens[at].end as usize)),
                _ => {}
            }
        }
        None
    }

    /// The whole lines, with the comment above them, where nothing else stands on them.
    fn lines(&self, range: Range<usize>) -> Range<usize> {
        whole_lines(self.text, self.tokens, range)
    }

    /// `if c { A } else { B }` becomes `{ A }` or `{ B }`, or nothing.
    fn branch(&mut self, span: Span, choice: Choice) -> Option<()> {
        let first = self.token_at(span)?;
        let chained = self.word(first) == "else";
        let at = if chained { first + 1 } else { first };
        if self.word(at) != "if" {
            // The condition of a loop.
            return None;
        }
        let open = self.opening_brace(at + 1)?;
        let close = closing(self.tokens, open)?;
        let has_else = self.word(close + 1) == "else";
        let end = self.chain_end(close)?;
        let start_of = |at: usize| self.tokens[at].start as usize;
        let end_of = |at: usize| self.tokens[at].end as usize;
        match choice {
            Choice::Accept => {
                self.cuts.branches.push(start_of(at)..start_of(open));
                if end > close {
                    self.cuts.branches.push(end_of(close)..end_of(end));
                }
            }
            Choice::Reject if has_else => self.cuts.branches.push(start_of(at)..start_of(close + 2)),
            // Also the blank before `else`.
            Choice::Reject if chained => self.cuts.branches.push(end_of(first - 1)..end_of(end)),
            Choice::Reject => {
                let lines = self.lines(start_of(at)..end_of(end));
                self.cuts.branches.push(lines);
            }
            Choice::Open => {}
        }
        Some(())
    }

    fn opening_brace(&self, from: usize) -> Option<usize> {
        let mut at = from;
        while at < self.item.body.end {
            match self.tokens[at].kind {
                Kind::Mark(b'(' | b'[') => at = closing(self.tokens, at)?,
                Kind::Mark(b'{') => return Some(at),
                _ => {}
            }
            at += 1;
        }
        None
    }

    /// The last token of a chain of `else`s behind the brace at `close`.
    fn chain_end(&self, close: usize) -> Option<usize> {
        let mut end = close;
        while self.word(end + 1) == "else" {
            let open = self.opening_brace(end + 2)?;
            end = closing(self.tokens, open)?;
        }
        Some(end)
    }

    fn rest_of_block(&mut self, span: Span) -> Option<()> {
        let first = self.token_at(span)?;
        let end = match self.word(first) {
            "if" | "else" => self.chain_end(closing(self.tokens, self.opening_brace(first)?)?)?,
            "{" => closing(self.tokens, first)?,
            _ => (first..self.item.body.end).find(|&at| self.tokens[at].is(b';'))?,
        };
        let mut depth = 0usize;
        for at in end + 1..self.item.body.end {
            match self.tokens[at].kind {
                // Behind a `continue` it still runs, and it is there in the IR.
                Kind::Word if depth == 0 && self.word(at) == "continuing" => {
                    let cut = self.tokens[end].end as usize..self.tokens[at].start as usize;
                    self.cuts.branches.push(cut);
                    return Some(());
                }
                Kind::Mark(b'{') => depth += 1,
                Kind::Mark(b'}') if depth == 0 => {
                    let start = self.tokens[end].end as usize;
                    let line = self.text[start..].find('\n').map_or(start, |n| start + n);
                    let from = if self.text[start..line].trim().is_empty() { line } else { start };
                    let to = self.tokens[at - 1].end as usize;
                    if from < to {
                        self.cuts.branches.push(from..to);
                    }
                    return Some(());
                }
                Kind::Mark(b'}') => depth -= 1,
                _ => {}
            }
        }
        None
    }

    /// `S(a, b, c)` of what may be a struct.
    fn constructors(&mut self) {
        for reference in self.item.references.iter().filter(|r| self.item.body.contains(&r.token)) {
            let name = self.word(reference.token);
            let open = reference.token + 1;
            let is_item = self.unit.origin(name).is_some() && !self.unit.functions.contains_key(name);
            if !is_item || !self.tokens.get(open).is_some_and(|t| t.is(b'(')) {
                continue;
            }
            let Some(close) = closing(self.tokens, open) else { continue };
            let constructor = Constructor {
                name: name.to_owned(),
                bounds: self.commas(open, close),
            };
            self.cuts.constructors.push(constructor);
        }
    }

    fn commas(&self, open: usize, close: usize) -> Vec<usize> {
        let mut bounds = vec![open];
        let mut at = open + 1;
        while at < close {
            let token = self.tokens[at];
            match token.kind {
                Kind::Mark(b'(' | b'[') => at = closing(self.tokens, at).unwrap_or(at),
                Kind::Mark(b'<') if takes_template(self.word(at - 1)) => {
                    let mut depth = 1usize;
                    while depth > 0 && at + 1 < close {
                        at += 1;
                        match self.tokens[at].kind {
                            Kind::Mark(b'<') => depth += 1,
                            Kind::Mark(b'>') => depth -= 1,
                            _ => {}
                        }
                    }
                }
                Kind::Mark(b',') => bounds.push(at),
                _ => {}
            }
            at += 1;
        }
        // A comma behind the last argument closes it as well as the bracket does.
        if bounds.last().is_some_and(|&last| last + 1 == close && bounds.len() > 1) {
            bounds.pop();
        }
        bounds.push(close);
        bounds
    }

    fn lets(&mut self) {
        // By first token, with the last one.
        let mut found: Vec<(usize, usize)> = Vec::new();
        for at in self.item.body.clone() {
            let phony = self.word(at) == "_" && self.tokens.get(at + 1).is_some_and(|t| t.is(b'='));
            if phony || self.word(at) == "let" {
                found.extend((at..self.item.body.end).find(|&t| self.tokens[t].is(b';')).map(|end| (at, end)));
            }
        }
        for &(first, end) in &found {
            let Some(cut) = self.whole_statement(first) else { continue };
            let phony = self.word(first) == "_";
            let acting = |&t: &usize| {
                let acts = ["atomic", "subgroup", "quad", "workgroupUniformLoad", "ray"];
                self.is_call(t) && !self.unit.functions.contains_key(self.word(t)) && acts.iter().any(|p| self.word(t).starts_with(p))
            };
            let callees = (first..end).filter(|&t| self.is_call(t));
            let found_let = Let {
                start: self.tokens[first].start as usize,
                cut,
                phony,
                acts: short_circuits(&self.tokens[first..end]) || (first..end).any(|t| acting(&t)),
                callees: callees.filter_map(|t| self.unit.functions.get(self.word(t)).copied()).collect(),
                uses: if phony { Vec::new() } else { self.uses(first + 1, end) },
                value: if phony { Value::Unknown } else { self.value(first + 1, end) },
            };
            self.cuts.lets.push(found_let);
        }
    }

    fn is_call(&self, at: usize) -> bool {
        self.tokens[at].kind == Kind::Word && self.tokens.get(at + 1).is_some_and(|t| t.is(b'('))
    }

    /// Where the name declared at `name` is mentioned behind `end`.
    fn uses(&self, name: usize, end: usize) -> Vec<usize> {
        let word = self.word(name);
        (end..self.item.body.end)
            .filter(|&at| self.word(at) == word && self.tokens[at].kind == Kind::Word && !self.tokens[at - 1].is(b'.'))
            .map(|at| self.tokens[at].start as usize)
            .collect()
    }

    /// The value of the `let` whose name stands at `name` and which ends at `end`.
    ///
    /// It is found by its place, since naga keeps one name for a value: `let b = a;` takes the name of `a` away.
    fn value(&self, name: usize, end: usize) -> Value {
        let range = self.tokens[name].end..self.tokens[end].start;
        let mut values = self.function.named_expressions.keys().filter(|handle| {
            let span = self.function.expressions.get_span(**handle).to_range().unwrap_or_default();
            range.contains(&(span.start as u32))
        });
        if let Some(&value) = values.next() {
            return Value::Expression(value);
        }
        // Another name for an earlier `let`, perhaps with its type, or as `&*p`.
        let equals = (name + 1..end).find(|&t| self.tokens[t].is(b'=')).unwrap_or(end);
        let mut words = (equals..end).filter(|&t| self.tokens[t].kind == Kind::Word && !self.tokens[t - 1].is(b'.'));
        let earlier = words.find_map(|word| {
            let start = self.tokens[self.declaration(name - 1, self.word(word))?].start as usize;
            self.cuts.lets.iter().position(|l| l.start == start)
        });
        earlier.map_or(Value::Unknown, Value::Earlier)
    }

    /// The `let` before a token that declares a name which is in scope there; `None` where something else declares it.
    fn declaration(&self, before: usize, name: &str) -> Option<usize> {
        // Blocks that are closed before the token, seen backwards.
        let mut closed = 0usize;
        for at in (self.item.body.start..before).rev() {
            match self.tokens[at].kind {
                Kind::Mark(b'}') => closed += 1,
                Kind::Mark(b'{') => closed = closed.saturating_sub(1),
                Kind::Word if closed == 0 && self.word(at + 1) == name => match self.word(at) {
                    "let" => return Some(at),
                    "var" | "const" => return None,
                    _ => {}
                },
                _ => {}
            }
        }
        None
    }
}

/// Whether a `<` behind this word opens a template list: of what can stand in an expression, by the whole name, since a
/// variable may be called `material`.
fn takes_template(word: &str) -> bool {
    let size = |s: &str| matches!(s, "2" | "3" | "4");
    let matrix = |s: &str| s.split_once('x').is_some_and(|(columns, rows)| size(columns) && size(rows));
    matches!(word, "array" | "bitcast" | "ptr" | "atomic")
        || word.strip_prefix("vec").is_some_and(size)
        || word.strip_prefix("mat").is_some_and(matrix)
}
