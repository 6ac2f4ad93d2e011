//! What can be said of a function whatever it is linked to: found once, when its unit is parsed, so that planning a
//! permutation looks at lists instead of walking statements.

use std::ops::Range;

use naga::{Block, Expression, Handle, Statement, TypeInner};
use rustc_hash::FxHashMap as HashMap;

use super::always::Always;
use super::branches::{Choice, choice, reachable};
use super::cuts::Cuts;
use super::lex::{Kind, Token, lex, short_circuits};
use super::operands::statement_operands;
use super::pure::writes_only_own;
use super::scan::{ItemKind, Reference};
use super::unit::Unit;

/// A store, and the struct members that its pointer leads through, the innermost first.
#[derive(Debug)]
pub struct Store {
    /// Where to.
    pub pointer: Handle<Expression>,
    /// What.
    pub value: Handle<Expression>,
    /// Struct type in the unit, member.
    pub path: Vec<(Handle<naga::Type>, u32)>,
}

/// A call.
#[derive(Debug)]
pub struct Call {
    /// Of what.
    pub callee: Handle<naga::Function>,
    /// With what.
    pub arguments: Vec<Handle<Expression>>,
    /// What it gives.
    pub result: Option<Handle<Expression>>,
}

/// What an expression's text does beside giving a value.
#[derive(Debug)]
pub enum Action {
    /// It acts whatever is linked: an atomic operation, or a branch such as `a && f()`.
    Always,
    /// It acts if one of these calls does.
    Calls(Vec<Handle<naga::Function>>),
}

/// Facts of one function. Statements behind a branch that is never taken have no part in them.
#[derive(Debug)]
pub struct Facts {
    /// Functions that it calls, in the order of the text, each once.
    pub callees: Vec<Handle<naga::Function>>,
    /// Whether it writes nothing but its own variables, apart from what it calls.
    pub writes_only_own: bool,
    /// Values that its statements need, whatever else is needed.
    pub reads: Vec<Handle<Expression>>,
    /// All that is read for these, and for its stores that lead through no struct.
    pub always: Always,
    /// Its stores.
    pub stores: Vec<Store>,
    /// Its calls, in the order of the text.
    pub calls: Vec<Call>,
    /// The call that gives a result.
    pub call_of: HashMap<Handle<Expression>, usize>,
    /// `let`s around something that may act.
    pub lets: Vec<Handle<Expression>>,
    /// What the texts of stored values, arguments, `let`s and members do. Most do nothing and are left out.
    pub actions: HashMap<Handle<Expression>, Action>,
    /// Module-scope variables that it names.
    pub globals: Vec<(Handle<Expression>, Handle<naga::GlobalVariable>)>,
    /// Types with structs in them, of its parameters, result and variables.
    pub types: Vec<Handle<naga::Type>>,
    /// The same of its expressions.
    pub typed: Vec<(Handle<Expression>, Handle<naga::Type>)>,
    /// Declared structs whose members it names or composes.
    pub structs: Vec<Handle<naga::Type>>,
    /// Types that keep all their members where this function stays: those that a `const` or `const_assert` among its statements names,
    /// since these leave no trace in the IR, but stay in the text, and those that constants at module scope are composed of.
    pub in_constants: Vec<Handle<naga::Type>>,
}

/// Facts of a unit's functions by handle, then of its entry points. The cuts of their texts are known already.
pub fn facts(unit: &Unit) -> Vec<Facts> {
    let functions = unit.ir.functions.iter().map(|(handle, function)| {
        let name = function.name.as_deref().unwrap_or_default();
        of_function(unit, function, &unit.info[handle], (name, handle.index()))
    });
    let entries = unit.ir.entry_points.iter().enumerate();
    let entries = entries.map(|(index, entry)| {
        let at = unit.ir.functions.len() + index;
        of_function(unit, &entry.function, unit.info.get_entry_point(index), (&entry.name, at))
    });
    functions.chain(entries).collect()
}

fn of_function(unit: &Unit, function: &naga::Function, info: &naga::valid::FunctionInfo, (name, at): (&str, usize)) -> Facts {
    let mut finder = Finder {
        unit,
        function,
        info,
        results: results(function),
        reached: vec![false; function.expressions.len()],
        facts: Facts {
            callees: Vec::new(),
            writes_only_own: writes_only_own(&unit.ir, function, &function.body),
            reads: Vec::new(),
            always: Always::default(),
            stores: Vec::new(),
            calls: Vec::new(),
            call_of: HashMap::default(),
            lets: Vec::new(),
            actions: HashMap::default(),
            globals: Vec::new(),
            types: Vec::new(),
            typed: Vec::new(),
            structs: Vec::new(),
            in_constants: in_constants(unit, name, &unit.cuts[at]),
        },
    };
    finder.block(&function.body);
    finder.actions();
    finder.types();
    let mut facts = finder.facts;
    facts.always = Always::new(unit, function, info, &facts);
    facts
}

struct Finder<'u> {
    unit: &'u Unit,
    function: &'u naga::Function,
    info: &'u naga::valid::FunctionInfo,
    /// Results of statements, with their places.
    results: Vec<(Handle<Expression>, Range<usize>)>,
    /// Expressions that stand in branches that may be taken.
    reached: Vec<bool>,
    facts: Facts,
}

impl Finder<'_> {
    fn block(&mut self, block: &Block) {
        for (statement, _) in reachable(&self.unit.ir, self.function, block) {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Emit(range) => range.clone().for_each(|h| self.reached[h.index()] = true),
            Statement::Break | Statement::Continue | Statement::Kill | Statement::ControlBarrier(_) | Statement::MemoryBarrier(_) => {}
            Statement::Block(inner) => self.block(inner),
            Statement::If { condition, accept, reject } => {
                let choice = choice(&self.unit.ir, self.function, *condition, accept, reject);
                if choice == Choice::Open {
                    self.facts.reads.push(*condition);
                }
                if choice != Choice::Reject {
                    self.block(accept);
                }
                if choice != Choice::Accept {
                    self.block(reject);
                }
            }
            Statement::Switch { selector, cases } => {
                self.facts.reads.push(*selector);
                cases.iter().for_each(|c| self.block(&c.body));
            }
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => {
                self.block(body);
                self.block(continuing);
                self.facts.reads.extend(break_if);
            }
            Statement::Return { value } => self.facts.reads.extend(value),
            Statement::Store { pointer, value } => {
                let path = self.path(*pointer);
                self.facts.stores.push(Store {
                    pointer: *pointer,
                    value: *value,
                    path,
                });
            }
            Statement::Call {
                function,
                arguments,
                result,
            } => {
                if !self.facts.callees.contains(function) {
                    self.facts.callees.push(*function);
                }
                if let Some(result) = result {
                    self.reached[result.index()] = true;
                    self.facts.call_of.insert(*result, self.facts.calls.len());
                }
                self.facts.calls.push(Call {
                    callee: *function,
                    arguments: arguments.clone(),
                    result: *result,
                });
            }
            other => statement_operands(other, &mut |&h| {
                self.reached[h.index()] = true;
                self.facts.reads.push(h);
            }),
        }
    }

    fn path(&self, mut pointer: Handle<Expression>) -> Vec<(Handle<naga::Type>, u32)> {
        let mut path = Vec::new();
        loop {
            match self.function.expressions[pointer] {
                Expression::AccessIndex { base, index } => {
                    path.extend(struct_type(self.unit, self.info, base).map(|ty| (ty, index)));
                    pointer = base;
                }
                Expression::Access { base, .. } => pointer = base,
                _ => return path,
            }
        }
    }

    fn actions(&mut self) {
        let mut asked: Vec<Handle<Expression>> = Vec::new();
        for store in &self.facts.stores {
            asked.extend([store.pointer, store.value]);
        }
        for call in &self.facts.calls {
            asked.extend(&call.arguments);
        }
        for (_, expression) in self.function.expressions.iter() {
            if let Expression::Compose { ty, components } = expression
                && self.unit.structs.contains_key(ty)
            {
                asked.extend(components);
            }
        }
        let lets = self.function.named_expressions.keys().copied();
        let lets: Vec<_> = lets.filter(|named| self.reached[named.index()]).collect();
        asked.extend(&lets);
        for handle in asked {
            if let Some(action) = self.action(handle) {
                self.facts.actions.insert(handle, action);
            }
        }
        self.facts.lets = lets.into_iter().filter(|named| self.facts.actions.contains_key(named)).collect();
    }

    /// Whether the text of an expression holds a call, an atomic operation or the like.
    fn action(&self, handle: Handle<Expression>) -> Option<Action> {
        let span = self.function.expressions.get_span(handle).to_range()?;
        // `a && f()` is a branch in the IR, which stays with all that it calls.
        let text = self.unit.composed.text.get(span.clone()).unwrap_or_default();
        if (text.contains("&&") || text.contains("||")) && short_circuits(&lex(text)) {
            return Some(Action::Always);
        }
        let mut calls = Vec::new();
        for (result, place) in &self.results {
            let inside =
                self.reached[result.index()] && result.index() <= handle.index() && span.start <= place.start && place.end <= span.end;
            if inside {
                match self.function.expressions[*result] {
                    Expression::CallResult(callee) => calls.push(callee),
                    _ => return Some(Action::Always),
                }
            }
        }
        (!calls.is_empty()).then_some(Action::Calls(calls))
    }

    fn types(&mut self) {
        let (ir, function) = (&self.unit.ir, self.function);
        let types = function.arguments.iter().map(|a| a.ty).chain(function.result.iter().map(|r| r.ty));
        let types = types.chain(function.local_variables.iter().map(|(_, l)| l.ty));
        self.facts.types = types.filter(|&ty| holds_struct(ir, ty)).collect();
        for (handle, expression) in function.expressions.iter() {
            let named = match *expression {
                Expression::AccessIndex { base, .. } => struct_type(self.unit, self.info, base),
                Expression::Compose { ty, .. } => Some(ty).filter(|ty| self.unit.structs.contains_key(ty)),
                _ => None,
            };
            self.facts.structs.extend(named);
            let ty = match *expression {
                Expression::GlobalVariable(global) => {
                    self.facts.globals.push((handle, global));
                    ir.global_variables[global].ty
                }
                Expression::Compose { ty, .. } | Expression::ZeroValue(ty) => ty,
                _ => continue,
            };
            if holds_struct(ir, ty) {
                self.facts.typed.push((handle, ty));
            }
        }
        self.facts.structs.sort_unstable();
        self.facts.structs.dedup();
    }
}

fn holds_struct(ir: &naga::Module, ty: Handle<naga::Type>) -> bool {
    match ir.types[ty].inner {
        TypeInner::Struct { .. } => true,
        TypeInner::Array { base, .. } | TypeInner::Pointer { base, .. } => holds_struct(ir, base),
        _ => false,
    }
}

/// The declared struct that an expression is, or points to.
pub fn struct_type(unit: &Unit, info: &naga::valid::FunctionInfo, handle: Handle<Expression>) -> Option<Handle<naga::Type>> {
    let resolution = &info[handle].ty;
    let ty = match *resolution.inner_with(&unit.ir.types) {
        TypeInner::Pointer { base, .. } => base,
        TypeInner::Struct { .. } => resolution.handle()?,
        _ => return None,
    };
    unit.structs.contains_key(&ty).then_some(ty)
}

fn in_constants(unit: &Unit, name: &str, cuts: &Cuts) -> Vec<Handle<naga::Type>> {
    let mut kept = Vec::new();
    let Some(item) = unit.scan.item(name) else { return kept };
    let word = |at: usize| &unit.file.text[unit.scan.tokens[at].range()];
    let is_cut = |r: &&Reference| {
        let start = unit.scan.tokens[r.token].start as usize;
        cuts.branches.iter().any(|range| range.contains(&start))
    };
    let living: Vec<&Reference> = item.references.iter().filter(|r| !is_cut(r)).collect();
    for reference in living.iter().filter(|r| item.body.contains(&r.token)) {
        let mut statement = (item.body.start..reference.token).rev().take_while(|&at| word(at) != ";");
        if statement.any(|at| matches!(word(at), "const" | "const_assert")) {
            named_structs(unit, word(reference.token), &mut kept);
        }
    }
    composed_for(unit, &living, &mut kept);
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// The types that are composed at module scope, where nothing is trimmed, for the constants and variables that words name, and for
/// those that these name.
fn composed_for(unit: &Unit, references: &[&Reference], kept: &mut Vec<Handle<naga::Type>>) {
    let text_of = |r: &Reference| &unit.file.text[unit.scan.tokens[r.token].range()];
    let mut queue: Vec<&str> = references.iter().map(|r| text_of(r)).collect();
    let mut seen: Vec<&str> = Vec::new();
    while let Some(word) = queue.pop() {
        if seen.contains(&word) {
            continue;
        }
        seen.push(word);
        let constant = unit
            .ir
            .constants
            .iter()
            .find(|(_, c)| c.name.as_deref() == Some(word))
            .map(|(_, c)| c.init);
        let mut variables = unit.ir.global_variables.iter();
        let variable = || variables.find(|(_, v)| v.name.as_deref() == Some(word)).and_then(|(_, v)| v.init);
        if let Some(init) = constant.or_else(variable) {
            composed(&unit.ir, init, kept);
        }
        if let Some(item) = unit
            .scan
            .item(word)
            .filter(|i| !matches!(i.kind, ItemKind::Function | ItemKind::Struct))
        {
            queue.extend(item.references.iter().map(text_of));
        }
    }
}

fn composed(ir: &naga::Module, expression: Handle<Expression>, kept: &mut Vec<Handle<naga::Type>>) {
    match &ir.global_expressions[expression] {
        Expression::Compose { ty, components } => {
            kept.push(*ty);
            components.iter().for_each(|&component| composed(ir, component, kept));
        }
        Expression::ZeroValue(ty) => kept.push(*ty),
        Expression::Constant(constant) => composed(ir, ir.constants[*constant].init, kept),
        _ => {}
    }
}

/// The structs that a name stands for, itself or as an alias of what holds them.
fn named_structs(unit: &Unit, name: &str, into: &mut Vec<Handle<naga::Type>>) {
    let named = unit.structs.iter().filter(|(_, key)| key.name == name);
    into.extend(named.map(|(&ty, _)| ty));
    let text = &unit.composed.text;
    if !text.contains("alias") {
        return;
    }
    let tokens = lex(text);
    let word = |token: &Token| text.get(token.range()).unwrap_or_default();
    let mut pairs = tokens.windows(2).enumerate();
    let Some((at, _)) = pairs.find(|(_, pair)| word(&pair[0]) == "alias" && word(&pair[1]) == name) else {
        return;
    };
    // An alias cannot lead to itself: naga has accepted the unit.
    let meant = tokens[at + 2..].iter().take_while(|t| !t.is(b';'));
    for token in meant.filter(|t| t.kind == Kind::Word) {
        named_structs(unit, word(token), into);
    }
}

fn results(function: &naga::Function) -> Vec<(Handle<Expression>, Range<usize>)> {
    use naga::Expression as E;
    let is_result = |e: &E| {
        matches!(
            e,
            E::CallResult(_)
                | E::AtomicResult { .. }
                | E::WorkGroupUniformLoadResult { .. }
                | E::RayQueryProceedResult
                | E::SubgroupBallotResult
                | E::SubgroupOperationResult { .. }
        )
    };
    let found = function.expressions.iter().filter(|(_, e)| is_result(e));
    found
        .map(|(h, _)| (h, function.expressions.get_span(h).to_range().unwrap_or_default()))
        .collect()
}
