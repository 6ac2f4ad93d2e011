//! What of the reached functions is alive: expressions that something depends on, struct members that somebody reads.
//!
//! A store into a member that nobody reads is dead, and so is what only it needed; a vertex stage's outputs are alive
//! where the fragment stage reads them. The analysis starts with no member alive and repeats until nothing is added.

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use std::ops::Range;

use naga::{Binding, Block, Expression, Handle, ShaderStage, Statement, Type, TypeInner};

use super::operands::{expression_operands, statement_operands};
use super::{Body, Choice, Home, Plan, Planned, Structs, can_go, choice, is_dead_store, reachable, struct_of};

/// Finds out what is alive and writes it into the plan.
pub fn analyse(plan: &mut Plan) {
    keep_local_constants(plan);
    loop {
        settle(plan);
        if !keep_one_member(plan) {
            break;
        }
    }
    drop_unneeded(plan);
}

/// A `const` inside a function leaves no trace in the IR, but stays in the text: its structs keep all their members.
fn keep_local_constants(plan: &mut Plan) {
    let mut kept = HashSet::default();
    for planned in &plan.functions {
        let unit = &plan.homes[planned.home].unit;
        let Some(item) = unit.scan.item(planned.source_name(&plan.homes)) else {
            continue;
        };
        let word = |at: usize| &unit.file.text[unit.scan.tokens[at].range()];
        for reference in item.references.iter().filter(|r| item.body.contains(&r.token)) {
            let mut statement = (item.body.start..reference.token).rev().take_while(|&at| word(at) != ";");
            if !statement.any(|at| word(at) == "const") {
                continue;
            }
            for (&ty, _) in unit.structs.iter().filter(|(_, key)| key.name == word(reference.token)) {
                used_structs(&plan.structs, &unit.ir, planned.home, ty, &mut kept);
            }
        }
    }
    kept.into_iter().for_each(|id| plan.structs.list[id].fixed = true);
}

/// Takes out the functions that only dead calls reached, puts the others into the order in which living calls reach them
/// (a dead call leaves no trace in the order either), and says who calls them first.
fn drop_unneeded(plan: &mut Plan) {
    let mut order = Vec::with_capacity(plan.functions.len());
    let mut index = vec![None; plan.functions.len()];
    for root in 0..plan.functions.len() {
        if matches!(plan.functions[root].body, Body::Entry(_)) {
            by_calls(plan, root, &mut index, &mut order);
        }
    }
    let mut functions: Vec<Option<Planned>> = std::mem::take(&mut plan.functions).into_iter().map(Some).collect();
    plan.functions = order.iter().filter_map(|&old| functions[old].take()).collect();
    for caller in 0..plan.functions.len() {
        let planned = &mut plan.functions[caller];
        planned.calls.retain(|_, id| index[*id].is_some());
        let ids = planned.calls.values_mut().chain(&mut planned.targets);
        ids.for_each(|id| *id = index[*id].unwrap_or(*id));
        let mut callees: Vec<usize> = planned.calls.values().chain(&planned.targets).copied().collect();
        callees.sort_unstable();
        for callee in callees {
            plan.functions[callee].caller.get_or_insert(caller);
        }
    }
}

/// Callees before callers, in the order of the living calls.
fn by_calls(plan: &Plan, id: usize, index: &mut [Option<usize>], order: &mut Vec<usize>) {
    if index[id].is_some() {
        return;
    }
    let planned = &plan.functions[id];
    let mut called = planned.targets.clone();
    if let Some(function) = planned.ir(&plan.homes) {
        living_calls(plan, planned, function, &function.body, &mut called);
    }
    for callee in called {
        by_calls(plan, callee, index, order);
    }
    index[id] = Some(order.len());
    order.push(id);
}

/// What the calls that stay lead to, in the order of the text.
fn living_calls(plan: &Plan, planned: &Planned, function: &naga::Function, block: &Block, called: &mut Vec<usize>) {
    let unit = &plan.homes[planned.home].unit;
    for (statement, _) in reachable(&unit.ir, function, block) {
        match statement {
            Statement::Call { function, result, .. } => {
                let read = result.is_some_and(|r| planned.live[r.index()]);
                if read || !can_go(&plan.functions, planned, unit, *function) {
                    called.extend(planned.calls.get(function));
                }
            }
            Statement::Block(inner) => living_calls(plan, planned, function, inner, called),
            Statement::If { condition, accept, reject } => {
                let choice = choice(&unit.ir, function, *condition, accept, reject);
                if choice != Choice::Reject {
                    living_calls(plan, planned, function, accept, called);
                }
                if choice != Choice::Accept {
                    living_calls(plan, planned, function, reject, called);
                }
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|c| living_calls(plan, planned, function, &c.body, called)),
            Statement::Loop { body, continuing, .. } => {
                living_calls(plan, planned, function, body, called);
                living_calls(plan, planned, function, continuing, called);
            }
            _ => {}
        }
    }
}

fn settle(plan: &mut Plan) {
    loop {
        let mut changed = false;
        // Callers first: callees precede them, so whatever a living call reaches is looked at in the same round.
        for index in (0..plan.functions.len()).rev() {
            if !plan.functions[index].needed {
                continue;
            }
            if plan.functions[index].ir(&plan.homes).is_none() {
                for target in plan.functions[index].targets.clone() {
                    plan.functions[target].needed = true;
                }
            }
            let Some(function) = plan.functions[index].ir(&plan.homes) else {
                continue;
            };
            let Some(info) = plan.functions[index].info(&plan.homes) else {
                continue;
            };
            let mut walker = Walker {
                homes: &plan.homes,
                functions: &plan.functions,
                planned: &plan.functions[index],
                pure_calls: HashMap::default(),
                called: Vec::new(),
                function,
                results: plan.functions[index].results(&plan.homes),
                info,
                structs: &mut plan.structs,
                params: &mut plan.live_params,
                live: vec![false; function.expressions.len()],
                read: vec![false; function.expressions.len()],
                reached: vec![false; function.expressions.len()],
                stack: Vec::new(),
                changed: false,
            };
            walker.block(&function.body);
            walker.keep_lets_with_calls();
            changed |= walker.changed;
            let (live, called) = (walker.live, walker.called);
            plan.functions[index].live = live;
            for callee in called {
                plan.functions[callee].needed = true;
            }
        }
        changed |= link_stages(plan);
        if !changed {
            break;
        }
    }
}

/// Vertex outputs are alive where a fragment entry point of the plan reads their location.
fn link_stages(plan: &mut Plan) -> bool {
    let mut wanted = HashSet::default();
    let mut outputs = Vec::new();
    let mut changed = false;
    for planned in &plan.functions {
        let Body::Entry(index) = planned.body else { continue };
        let unit = &plan.homes[planned.home].unit;
        let entry = &unit.ir.entry_points[index];
        if entry.stage == ShaderStage::Fragment {
            for argument in &entry.function.arguments {
                for (id, member, binding) in bound_members(plan, planned.home, argument.ty) {
                    if let (Some(Binding::Location { location, .. }), true) = (binding, plan.structs.is_live(id, member)) {
                        wanted.insert(location);
                    }
                }
            }
        }
        if let Some(result) = &entry.function.result {
            let members = bound_members(plan, planned.home, result.ty);
            outputs.extend(members.into_iter().map(|(id, member, binding)| (entry.stage, id, member, binding)));
        }
    }
    for (stage, id, member, binding) in outputs {
        let unread =
            matches!(binding, Some(Binding::Location { location, .. }) if stage == ShaderStage::Vertex && !wanted.contains(&location));
        if !unread {
            changed |= plan.structs.enliven(id, member);
        }
    }
    changed
}

fn bound_members(plan: &Plan, home: usize, ty: Handle<Type>) -> Vec<(usize, u32, Option<Binding>)> {
    let unit = &plan.homes[home].unit;
    match (&unit.ir.types[ty].inner, plan.structs.id(home, ty)) {
        (TypeInner::Struct { members, .. }, Some(id)) => members
            .iter()
            .enumerate()
            .map(|(index, m)| (id, index as u32, m.binding.clone()))
            .collect(),
        _ => Vec::new(),
    }
}

/// WGSL has no empty structs: one that is used keeps a member, a built-in value rather than a location.
fn keep_one_member(plan: &mut Plan) -> bool {
    let mut used = HashSet::default();
    for planned in plan.functions.iter().filter(|f| f.needed) {
        let unit = &plan.homes[planned.home].unit;
        let Some(function) = planned.ir(&plan.homes) else { continue };
        let types = function.arguments.iter().map(|a| a.ty).chain(function.result.iter().map(|r| r.ty));
        for ty in types.chain(function.local_variables.iter().map(|(_, l)| l.ty)) {
            used_structs(&plan.structs, &unit.ir, planned.home, ty, &mut used);
        }
        for (handle, expression) in function.expressions.iter() {
            let ty = match *expression {
                Expression::GlobalVariable(global) => unit.ir.global_variables[global].ty,
                Expression::Compose { ty, .. } | Expression::ZeroValue(ty) => ty,
                _ => continue,
            };
            if planned.live[handle.index()] {
                used_structs(&plan.structs, &unit.ir, planned.home, ty, &mut used);
            }
        }
    }
    let mut changed = false;
    let mut used: Vec<usize> = used.into_iter().collect();
    used.sort_unstable();
    for id in used {
        let s = &plan.structs.list[id];
        if s.fixed || s.live.iter().any(|&l| l) {
            continue;
        }
        let ir = &plan.homes[s.home].unit.ir;
        let declared = ir.types.iter().find_map(|(_, t)| match &t.inner {
            TypeInner::Struct { members, .. } if t.name.as_deref() == Some(&s.name) => Some(members),
            _ => None,
        });
        let builtin = declared.and_then(|m| m.iter().position(|m| matches!(m.binding, Some(Binding::BuiltIn(_)))));
        changed |= plan.structs.enliven(id, builtin.unwrap_or(0) as u32);
    }
    changed
}

fn used_structs(structs: &Structs, ir: &naga::Module, home: usize, ty: Handle<Type>, used: &mut HashSet<usize>) {
    match &ir.types[ty].inner {
        TypeInner::Struct { members, .. } => {
            if let Some(id) = structs.id(home, ty) {
                used.insert(id);
            }
            members.iter().for_each(|m| used_structs(structs, ir, home, m.ty, used));
        }
        TypeInner::Array { base, .. } | TypeInner::Pointer { base, .. } => used_structs(structs, ir, home, *base, used),
        _ => {}
    }
}

/// Callee and arguments of a call that can go.
type PureCall<'a> = (Handle<naga::Function>, &'a [Handle<Expression>]);

struct Walker<'a> {
    homes: &'a [Home],
    functions: &'a [Planned],
    planned: &'a Planned,
    /// Calls of pure functions by their result: they are alive where that is.
    pure_calls: HashMap<Handle<Expression>, PureCall<'a>>,
    /// Functions that living calls reach.
    called: Vec<usize>,
    function: &'a naga::Function,
    results: &'a [(Handle<Expression>, Range<usize>)],
    info: &'a naga::valid::FunctionInfo,
    structs: &'a mut Structs,
    params: &'a mut HashSet<(usize, u32)>,
    /// Needed in the linked function.
    live: Vec<bool>,
    /// Its value is needed, not only its address for a store.
    read: Vec<bool>,
    /// Results of statements, and expressions, that stand in branches that may be taken.
    reached: Vec<bool>,
    stack: Vec<Handle<Expression>>,
    changed: bool,
}

impl<'a> Walker<'a> {
    /// Something that acts beside giving a value stays where it stands, and so does the `let` around it, whoever reads it.
    /// Comes behind the walk over the statements, which finds the pure calls that such a `let` also holds.
    fn keep_lets_with_calls(&mut self) {
        for &named in self.function.named_expressions.keys() {
            if self.reached[named.index()] && self.holds_action(named) {
                self.read(named);
            }
        }
    }

    /// Whether the text of an expression holds a call that cannot go, an atomic operation or the like.
    fn holds_action(&self, handle: Handle<Expression>) -> bool {
        let Some(span) = self.function.expressions.get_span(handle).to_range() else {
            return false;
        };
        // `a && f()` is a branch in the IR, which stays with all that it calls.
        let text = self.homes[self.planned.home]
            .unit
            .composed
            .text
            .get(span.clone())
            .unwrap_or_default();
        if text.contains("&&") || text.contains("||") {
            return true;
        }
        self.results.iter().any(|(result, place)| {
            let inside =
                self.reached[result.index()] && result.index() <= handle.index() && span.start <= place.start && place.end <= span.end;
            inside
                && match self.function.expressions[*result] {
                    Expression::CallResult(callee) => !self.can_go(callee),
                    _ => true,
                }
        })
    }

    fn can_go(&self, callee: Handle<naga::Function>) -> bool {
        can_go(self.functions, self.planned, &self.homes[self.planned.home].unit, callee)
    }

    fn call(&mut self, callee: Handle<naga::Function>) {
        self.called.extend(self.planned.calls.get(&callee));
    }

    fn block(&mut self, block: &'a Block) {
        for (statement, _) in reachable(&self.homes[self.planned.home].unit.ir, self.function, block) {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &'a Statement) {
        match statement {
            Statement::Emit(range) => range.clone().for_each(|h| self.reached[h.index()] = true),
            Statement::Break | Statement::Continue | Statement::Kill | Statement::ControlBarrier(_) | Statement::MemoryBarrier(_) => {}
            Statement::Block(inner) => self.block(inner),
            Statement::If { condition, accept, reject } => {
                match choice(&self.homes[self.planned.home].unit.ir, self.function, *condition, accept, reject) {
                    Choice::Accept => self.block(accept),
                    Choice::Reject => self.block(reject),
                    Choice::Open => {
                        self.read(*condition);
                        self.block(accept);
                        self.block(reject);
                    }
                }
            }
            Statement::Switch { selector, cases } => {
                self.read(*selector);
                cases.iter().for_each(|c| self.block(&c.body));
            }
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => {
                self.block(body);
                self.block(continuing);
                break_if.iter().for_each(|&b| self.read(b));
            }
            Statement::Return { value } => value.iter().for_each(|&v| self.read(v)),
            Statement::Store { pointer, value } => {
                let ir = &self.homes[self.planned.home].unit.ir;
                if is_dead_store(self.planned.home, self.structs, self.function, self.info, ir, *pointer) {
                    if !self.holds_action(*value) && !self.holds_action(*pointer) {
                        return;
                    }
                    self.enliven_path(*pointer);
                }
                self.address(*pointer);
                self.read(*value);
            }
            Statement::Call {
                function,
                arguments,
                result,
            } => {
                result.iter().for_each(|r| self.reached[r.index()] = true);
                if self.can_go(*function) {
                    // Alive where its result is read, which is after this.
                    if let Some(result) = result {
                        self.pure_calls.insert(*result, (*function, arguments));
                        if arguments.iter().any(|&a| self.holds_action(a)) {
                            self.read(*result);
                        }
                    }
                    return;
                }
                self.call(*function);
                arguments.iter().for_each(|&a| self.read(a));
                result.iter().for_each(|&r| self.read(r));
            }
            other => statement_operands(other, &mut |&h| {
                self.reached[h.index()] = true;
                self.read(h);
            }),
        }
    }

    /// The pointer of a store: its members are written, not read.
    fn address(&mut self, mut handle: Handle<Expression>) {
        loop {
            self.live[handle.index()] = true;
            match self.function.expressions[handle] {
                Expression::AccessIndex { base, .. } => handle = base,
                Expression::Access { base, index } => {
                    self.read(index);
                    handle = base;
                }
                Expression::LocalVariable(local) => {
                    self.function.local_variables[local].init.iter().for_each(|&i| self.read(i));
                    return;
                }
                // A pointer from elsewhere: an argument, a variable of the module.
                _ => return,
            }
        }
    }

    /// All members on the way of a pointer.
    fn enliven_path(&mut self, mut pointer: Handle<Expression>) {
        loop {
            match self.function.expressions[pointer] {
                Expression::AccessIndex { base, index } => {
                    let ir = &self.homes[self.planned.home].unit.ir;
                    if let Some(id) = struct_of(self.planned.home, self.structs, self.info, ir, base) {
                        self.changed |= self.structs.enliven(id, index);
                    }
                    pointer = base;
                }
                Expression::Access { base, .. } => pointer = base,
                _ => return,
            }
        }
    }

    fn read(&mut self, handle: Handle<Expression>) {
        self.stack.push(handle);
        while let Some(handle) = self.stack.pop() {
            if std::mem::replace(&mut self.read[handle.index()], true) {
                continue;
            }
            self.live[handle.index()] = true;
            self.expression(handle);
        }
    }

    fn expression(&mut self, handle: Handle<Expression>) {
        let home = self.planned.home;
        let expression = &self.function.expressions[handle];
        match expression {
            Expression::AccessIndex { base, index } => {
                let unit = &self.homes[home].unit;
                if let Expression::GlobalVariable(global) = self.function.expressions[*base]
                    && super::bindings::is_params(unit, global)
                    && self.params.insert((home, *index))
                {
                    self.changed = true;
                }
                if let Some(id) = struct_of(home, self.structs, self.info, &unit.ir, *base) {
                    self.changed |= self.structs.enliven(id, *index);
                }
                self.stack.push(*base);
            }
            Expression::LocalVariable(local) => self.stack.extend(self.function.local_variables[*local].init),
            Expression::Compose { ty, components } => {
                let id = self.structs.id(home, *ty);
                for (index, &component) in components.iter().enumerate() {
                    let dead = id.filter(|&id| !self.structs.is_live(id, index as u32));
                    if let Some(id) = dead {
                        if !self.holds_action(component) {
                            continue;
                        }
                        self.changed |= self.structs.enliven(id, index as u32);
                    }
                    self.stack.push(component);
                }
            }
            Expression::CallResult(_) => {
                if let Some((callee, arguments)) = self.pure_calls.remove(&handle) {
                    self.call(callee);
                    self.stack.extend(arguments);
                }
            }
            other => expression_operands(other, &mut |&h| self.stack.push(h)),
        }
    }
}
