//! What must change in the text of a function that keeps only its living parts.
//!
//! The IR tells what is dead and, by its spans, where that stands in the author's text.

use std::ops::Range;

use naga::{Block, Handle, Span, Statement};

use crate::parse::lex::{Kind, Token};
use crate::parse::scan::{Item, ItemKind, closing, whole_lines};
use crate::parse::{Choice, Origin, Unit, choice, leaves, reachable};
use crate::plan::{Plan, Planned, is_dead_store};

/// A stretch of text and what stands there instead.
pub type Edit = (Range<usize>, String);

/// Text that goes away. Stretches may nest.
pub struct Dead<'a> {
    plan: &'a Plan,
    planned: &'a Planned,
    item: &'a Item,
    text: &'a str,
    tokens: &'a [Token],
    /// Found so far.
    pub ranges: Vec<Range<usize>>,
}

/// Finds the dead text of a function.
pub fn dead_text(plan: &Plan, planned: &Planned, item: &Item) -> Vec<Range<usize>> {
    let unit = &plan.homes[planned.home].unit;
    let Some(function) = planned.ir(&plan.homes) else {
        return Vec::new();
    };
    let mut dead = Dead {
        plan,
        planned,
        item,
        text: &unit.file.text,
        tokens: &unit.scan.tokens,
        ranges: Vec::new(),
    };
    dead.block(function, &function.body);
    dead.constructor_arguments();
    dead.unread_lets(function);
    dead.ranges
}

impl Dead<'_> {
    fn block(&mut self, function: &naga::Function, block: &Block) {
        let ir = &self.plan.homes[self.planned.home].unit.ir;
        let mut last = None;
        let mut count = 0;
        for (statement, &span) in reachable(ir, function, block) {
            count += 1;
            self.statement(function, statement, span);
            last = Some((statement, span));
        }
        // What stands behind a branch that is always taken and leaves.
        if let Some((statement @ Statement::If { .. }, span)) = last
            && count < block.len()
            && leaves(ir, function, statement)
        {
            self.rest_of_block(span);
        }
    }

    fn statement(&mut self, function: &naga::Function, statement: &Statement, span: Span) {
        let unit = &self.plan.homes[self.planned.home].unit;
        match statement {
            Statement::Block(inner) => self.block(function, inner),
            Statement::If { condition, accept, reject } => {
                let choice = choice(&unit.ir, function, *condition, accept, reject);
                if choice != Choice::Open {
                    self.branch(span, choice);
                }
                if choice != Choice::Reject {
                    self.block(function, accept);
                }
                if choice != Choice::Accept {
                    self.block(function, reject);
                }
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|c| self.block(function, &c.body)),
            Statement::Loop { body, continuing, .. } => {
                self.block(function, body);
                self.block(function, continuing);
            }
            Statement::Store { pointer, .. } => {
                if is_dead_store(self.planned, &self.plan.structs, unit, function, *pointer)
                    && let Some(first) = self.token_at(span)
                {
                    self.remove_statement(first);
                }
            }
            Statement::Call {
                function: callee, result, ..
            } => {
                let unread = result.is_none_or(|r| !self.planned.live[r.index()]);
                if unread && !self.is_kept(*callee) {
                    self.call_statement(unit, span, *callee);
                }
            }
            _ => {}
        }
    }

    /// A call that is a statement of its own goes with its semicolon; others go with the statement around them.
    fn call_statement(&mut self, unit: &Unit, span: Span, callee: Handle<naga::Function>) -> Option<()> {
        let first = self.token_at(span)?;
        let name = unit.ir.functions[callee].name.as_deref()?;
        let before = self.tokens.get(first.checked_sub(1)?)?;
        let starts = before.is(b';') || before.is(b'{') || before.is(b'}') || self.starts_for(first);
        if self.word(first) == name && starts {
            self.remove_statement(first);
        }
        Some(())
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
    fn remove_statement(&mut self, first: usize) {
        let start = self.tokens[first].start as usize;
        let mut depth = 0usize;
        for at in first..self.item.body.end {
            match self.tokens[at].kind {
                Kind::Mark(b')') if depth == 0 => {
                    self.ranges.push(start..self.tokens[at].start as usize);
                    return;
                }
                Kind::Mark(b';') if depth == 0 && self.starts_for(first) => {
                    self.ranges.push(start..self.tokens[at].start as usize);
                    return;
                }
                Kind::Mark(b'(' | b'[' | b'{') => depth += 1,
                Kind::Mark(b')' | b']' | b'}') => depth = depth.saturating_sub(1),
                Kind::Mark(b';') if depth == 0 => {
                    self.remove_lines(start..self.tokens[at].end as usize);
                    return;
                }
                _ => {}
            }
        }
    }

    /// Takes the whole lines, with the comment above them, where nothing else stands on them.
    fn remove_lines(&mut self, range: Range<usize>) {
        self.ranges.push(whole_lines(self.text, self.tokens, range));
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
                self.ranges.push(start_of(at)..start_of(open));
                if end > close {
                    self.ranges.push(end_of(close)..end_of(end));
                }
            }
            Choice::Reject if has_else => self.ranges.push(start_of(at)..start_of(close + 2)),
            Choice::Reject if chained => {
                // Also the blank before `else`.
                let before = end_of(first - 1);
                self.ranges.push(before..end_of(end));
            }
            Choice::Reject => self.remove_lines(start_of(at)..end_of(end)),
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
        let open = self.opening_brace(first)?;
        let end = self.chain_end(closing(self.tokens, open)?)?;
        let mut depth = 0usize;
        for at in end + 1..self.item.body.end {
            match self.tokens[at].kind {
                // Behind a `continue` it still runs, and it is there in the IR.
                Kind::Word if depth == 0 && self.word(at) == "continuing" => {
                    self.ranges.push(self.tokens[end].end as usize..self.tokens[at].start as usize);
                    return Some(());
                }
                Kind::Mark(b'{') => depth += 1,
                Kind::Mark(b'}') if depth == 0 => {
                    let start = self.tokens[end].end as usize;
                    let line = self.text[start..].find('\n').map_or(start, |n| start + n);
                    let from = if self.text[start..line].trim().is_empty() { line } else { start };
                    let to = self.tokens[at - 1].end as usize;
                    if from < to {
                        self.ranges.push(from..to);
                    }
                    return Some(());
                }
                Kind::Mark(b'}') => depth -= 1,
                _ => {}
            }
        }
        None
    }

    /// `S(a, b, c)` of a struct that lost members loses their arguments.
    fn constructor_arguments(&mut self) {
        let plan = self.plan;
        let unit = &plan.homes[self.planned.home].unit;
        for reference in self.item.references.iter().filter(|r| self.item.body.contains(&r.token)) {
            let name = unaliased(plan, unit, &self.text[self.tokens[reference.token].range()]);
            let declared = match unit.origin(name) {
                Some(Origin::Interface(category)) => plan.interface_home(category),
                Some(Origin::Own) => Some(plan.homes[self.planned.home].first),
                _ => None,
            };
            let Some(id) = declared.and_then(|home| plan.structs.named(home, name)) else {
                continue;
            };
            let open = reference.token + 1;
            if !self.tokens.get(open).is_some_and(|t| t.is(b'(')) {
                continue;
            }
            let Some(close) = closing(self.tokens, open) else { continue };
            self.arguments(id, open, close);
        }
    }

    fn arguments(&mut self, id: usize, open: usize, close: usize) {
        let bounds = self.commas(open, close);
        for (member, pair) in bounds.windows(2).enumerate() {
            if pair[0] + 1 == pair[1] || self.plan.structs.is_live(id, member as u32) {
                continue;
            }
            // With the comma behind it, or, of the last one, the comma before it.
            let range = if pair[1] == close {
                let kept_before = (0..member).any(|m| self.plan.structs.is_live(id, m as u32));
                let from = if kept_before {
                    self.tokens[pair[0]].start
                } else {
                    self.tokens[pair[0]].end
                };
                from as usize..self.tokens[close].start as usize
            } else {
                let to = self.tokens.get(pair[1] + 1).map_or(self.tokens[pair[1]].end, |t| t.start);
                self.tokens[pair[0] + 1].start as usize..to as usize
            };
            self.ranges.push(range);
        }
    }

    /// Tokens of the brackets and of the commas between the arguments.
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

    /// `let`s whose value nobody needs, and assignments to `_`: unless they call something.
    fn unread_lets(&mut self, function: &naga::Function) {
        // Removing one may leave another without readers.
        loop {
            let before = self.ranges.len();
            for at in self.item.body.clone() {
                let phony = self.word(at) == "_" && self.tokens.get(at + 1).is_some_and(|t| t.is(b'='));
                if !(phony || self.word(at) == "let") || self.is_dead(at) {
                    continue;
                }
                let Some(end) = (at..self.item.body.end).find(|&t| self.tokens[t].is(b';')) else {
                    continue;
                };
                let value = &self.text[self.tokens[at].end as usize..self.tokens[end].start as usize];
                let calls = value.contains("&&") || value.contains("||") || (at..end).any(|t| self.calls(t));
                if !calls && (phony || !self.is_read(at + 1, end) || self.is_unneeded(function, at + 1, end)) {
                    self.remove_statement(at);
                }
            }
            if self.ranges.len() == before {
                return;
            }
        }
    }

    fn is_dead(&self, token: usize) -> bool {
        let start = self.tokens[token].start as usize;
        self.ranges.iter().any(|r| r.contains(&start))
    }

    /// Whether a token calls a function of a module, or one of the language that does more than give a value.
    fn calls(&self, at: usize) -> bool {
        let word = self.word(at);
        if self.tokens[at].kind != Kind::Word || !self.tokens.get(at + 1).is_some_and(|t| t.is(b'(')) {
            return false;
        }
        let acts = ["atomic", "subgroup", "quad", "workgroupUniformLoad", "ray"]
            .iter()
            .any(|p| word.starts_with(p));
        let unit = &self.plan.homes[self.planned.home].unit;
        acts || unit.functions.get(word).is_some_and(|&f| self.is_kept(f))
    }

    /// Whether a call of this function stays, whoever reads its result.
    fn is_kept(&self, callee: Handle<naga::Function>) -> bool {
        let unit = &self.plan.homes[self.planned.home].unit;
        self.planned.is_kept(&self.plan.functions, unit, callee)
    }

    /// Whether the name declared at `name` is mentioned in living text elsewhere.
    fn is_read(&self, name: usize, end: usize) -> bool {
        let word = self.word(name);
        (end..self.item.body.end)
            .any(|at| self.word(at) == word && self.tokens[at].kind == Kind::Word && !self.tokens[at - 1].is(b'.') && !self.is_dead(at))
    }

    /// Whether the IR knows the value of the `let` whose name stands at `name` and which ends at `end`, and knows it to be dead.
    ///
    /// The value is found by its place, since naga keeps one name for a value: `let b = a;` takes the name of `a` away.
    fn is_unneeded(&self, function: &naga::Function, name: usize, end: usize) -> bool {
        let range = self.tokens[name].end..self.tokens[end].start;
        let mut values = function.named_expressions.keys().filter(|handle| {
            let span = function.expressions.get_span(**handle).to_range().unwrap_or_default();
            range.contains(&(span.start as u32))
        });
        if let Some(value) = values.next() {
            return !self.planned.live[value.index()];
        }
        // Another name for an earlier `let`: needed if that is.
        let mut words = (name + 1..end).filter(|&t| !matches!(self.tokens[t].kind, Kind::Mark(b'=' | b'(' | b')')));
        let (Some(word), None) = (words.next(), words.next()) else {
            return false;
        };
        let Some(earlier) = self.declaration(name - 1, self.word(word)) else {
            return false;
        };
        let end = (earlier..name).find(|&t| self.tokens[t].is(b';'));
        end.is_some_and(|end| self.is_unneeded(function, earlier + 1, end))
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

/// What `alias A = S;` of a module or of an interface stands for; other names as they are.
fn unaliased<'p>(plan: &'p Plan, unit: &'p Unit, mut name: &'p str) -> &'p str {
    // An alias cannot lead to itself: naga has accepted the unit.
    loop {
        let declares = match unit.origin(name) {
            Some(Origin::Interface(category)) => plan.interface_home(category).map_or(unit, |home| &plan.homes[home].unit),
            _ => unit,
        };
        match declares
            .scan
            .item(name)
            .filter(|i| i.kind == ItemKind::Alias && i.tokens.len() == 5)
        {
            Some(item) => name = &declares.file.text[declares.scan.tokens[item.tokens.start + 3].range()],
            None => return name,
        }
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
