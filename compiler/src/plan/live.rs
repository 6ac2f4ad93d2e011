//! What of the reached functions is alive: expressions that something depends on, struct members that somebody reads.
//!
//! A store into a member that nobody reads is dead, and so is what only it needed. The analysis starts with no member alive. A
//! function is walked once, when a living call first reaches it; what depends on a member that is not alive waits for it, and is
//! looked at again when, and only when, something reads that member.

use naga::{Expression, Handle};
use rustc_hash::FxHashMap as HashMap;

use super::stages::{Output, outputs};
use super::{Body, Home, Plan, Planned, Structs, struct_of};
use crate::parse::{Action, Call, Facts, Store, Unit, expression_operands};

/// Finds out what is alive and writes it into the plan.
pub fn analyse(plan: &mut Plan) {
    let outputs = outputs(plan);
    let functions = std::mem::take(&mut plan.functions);
    let mut walk = Walk {
        homes: &plan.homes,
        functions: &functions,
        states: functions.iter().map(|_| State::default()).collect(),
        structs: &mut plan.structs,
        params: &mut plan.live_params,
        queue: Vec::new(),
        waiting: HashMap::default(),
        woken: Vec::new(),
        stack: Vec::new(),
    };
    for (id, planned) in functions.iter().enumerate() {
        if matches!(planned.body, Body::Entry(_)) {
            walk.need(id);
        }
    }
    loop {
        walk.settle();
        if !walk.link_stages(&outputs) && !walk.keep_one_member() {
            break;
        }
    }
    let states = walk.states;
    plan.functions = functions;
    for (planned, state) in plan.functions.iter_mut().zip(states) {
        planned.live = state.live;
    }
    drop_unneeded(plan);
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
    let mut callees = Vec::new();
    for caller in 0..plan.functions.len() {
        let planned = &mut plan.functions[caller];
        planned.calls.renumber(&index);
        planned.targets.iter_mut().for_each(|id| *id = index[*id].unwrap_or(*id));
        callees.clear();
        callees.extend(planned.calls.ids().chain(planned.targets.iter().copied()));
        callees.sort_unstable();
        for &callee in &callees {
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
    let unit = &plan.homes[planned.home].unit;
    for &target in &planned.targets {
        by_calls(plan, target, index, order);
    }
    for call in planned.facts(&plan.homes).iter().flat_map(|facts| &facts.calls) {
        let read = call.result.is_some_and(|r| planned.live[r.index()]);
        if let Some(callee) = planned.calls.get(call.callee)
            && (read || planned.is_kept(&plan.functions, unit, call.callee))
        {
            by_calls(plan, callee, index, order);
        }
    }
    index[id] = Some(order.len());
    order.push(id);
}

/// The structs in a type.
fn used_structs(structs: &Structs, ir: &naga::Module, home: usize, ty: Handle<naga::Type>, used: &mut impl FnMut(usize)) {
    match &ir.types[ty].inner {
        naga::TypeInner::Struct { members, .. } => {
            if let Some(id) = structs.id(home, ty) {
                used(id);
            }
            members.iter().for_each(|m| used_structs(structs, ir, home, m.ty, used));
        }
        naga::TypeInner::Array { base, .. } | naga::TypeInner::Pointer { base, .. } => used_structs(structs, ir, home, *base, used),
        _ => {}
    }
}

/// What is known so far of a function.
#[derive(Default)]
struct State {
    /// Whether a living call reaches it.
    needed: bool,
    /// Needed in the linked function.
    live: Vec<bool>,
    /// Its value is needed, not only its address for a store.
    read: Vec<bool>,
}

/// What waits for a struct's member to come alive.
enum Waiting<'p> {
    Store(usize, &'p Store),
    Component(usize, Handle<Expression>),
}

struct Walk<'p> {
    homes: &'p [Home],
    functions: &'p [Planned],
    states: Vec<State>,
    structs: &'p mut Structs,
    params: &'p mut rustc_hash::FxHashSet<(usize, u32)>,
    /// Functions that are needed and not walked yet.
    queue: Vec<usize>,
    /// By struct and member.
    waiting: HashMap<(usize, u32), Vec<Waiting<'p>>>,
    /// Whose member has come alive.
    woken: Vec<Waiting<'p>>,
    stack: Vec<Handle<Expression>>,
}

impl<'p> Walk<'p> {
    fn settle(&mut self) {
        loop {
            if let Some(id) = self.queue.pop() {
                self.function(id);
            } else if let Some(waiting) = self.woken.pop() {
                match waiting {
                    Waiting::Store(id, store) => self.store(id, store),
                    Waiting::Component(id, handle) => self.read(id, handle),
                }
            } else {
                return;
            }
        }
    }

    fn need(&mut self, id: usize) {
        if !std::mem::replace(&mut self.states[id].needed, true) {
            self.queue.push(id);
        }
    }

    fn enliven(&mut self, id: usize, member: u32) -> bool {
        let news = self.structs.enliven(id, member);
        if news && let Some(waiting) = self.waiting.remove(&(id, member)) {
            self.woken.extend(waiting);
        }
        news
    }

    fn unit(&self, id: usize) -> &'p Unit {
        &self.homes[self.functions[id].home].unit
    }

    fn facts(&self, id: usize) -> Option<&'p Facts> {
        self.functions[id].facts(self.homes)
    }

    fn function(&mut self, id: usize) {
        let planned = &self.functions[id];
        let (Some(facts), Some(function)) = (self.facts(id), planned.ir(self.homes)) else {
            planned.targets.iter().for_each(|&target| self.need(target));
            return;
        };
        for &ty in &facts.in_constants {
            self.keep_all_members(planned.home, ty);
        }
        let always = &facts.always;
        self.states[id].live.clone_from(&always.live);
        self.states[id].read.clone_from(&always.read);
        self.params.extend(always.params.iter().map(|&index| (planned.home, index)));
        for &(ty, member) in &always.members {
            if let Some(s) = self.structs.id(planned.home, ty) {
                self.enliven(s, member);
            }
        }
        for called in always.calls.iter().filter_map(|&callee| planned.calls.get(callee)) {
            self.need(called);
        }
        for &composed in &always.composed {
            self.expression(id, planned, function, composed);
            self.follow(id, planned, function);
        }
        let stores = facts.stores.iter().filter(|store| !store.path.is_empty());
        stores.for_each(|store| self.store(id, store));
        facts.calls.iter().for_each(|call| self.call(id, facts, call));
        for &named in &facts.lets {
            if self.acts(id, named) {
                self.read(id, named);
            }
        }
    }

    /// What constants are composed of is not trimmed.
    fn keep_all_members(&mut self, home: usize, ty: Handle<naga::Type>) {
        let mut kept = Vec::new();
        used_structs(self.structs, &self.homes[home].unit.ir, home, ty, &mut |id| kept.push(id));
        for id in kept {
            for member in 0..self.structs.list[id].live.len() as u32 {
                self.enliven(id, member);
            }
            self.structs.list[id].fixed = true;
        }
    }

    /// Something that acts beside giving a value stays where it stands, and so does the `let` around it, whoever reads it.
    fn acts(&self, id: usize, handle: Handle<Expression>) -> bool {
        match self.facts(id).and_then(|facts| facts.actions.get(&handle)) {
            None => false,
            Some(Action::Always) => true,
            Some(Action::Calls(callees)) => callees.iter().any(|&callee| !self.can_go(id, callee)),
        }
    }

    /// Whether a call may go where nobody reads its result.
    fn can_go(&self, id: usize, callee: Handle<naga::Function>) -> bool {
        let planned = self.functions[id].calls.get(callee);
        planned.is_some_and(|callee_id| self.unit(id).droppable[callee.index()] && self.functions[callee_id].pure)
    }

    fn call(&mut self, id: usize, facts: &Facts, call: &Call) {
        if self.can_go(id, call.callee) {
            // Alive where its result is read. Without a result it goes.
            if let Some(result) = call.result
                && !facts.actions.is_empty()
                && call.arguments.iter().any(|&a| self.acts(id, a))
            {
                self.read(id, result);
            }
            return;
        }
        if let Some(callee) = self.functions[id].calls.get(call.callee) {
            self.need(callee);
        }
        call.arguments.iter().chain(&call.result).for_each(|&h| self.read(id, h));
    }

    fn store(&mut self, id: usize, store: &'p Store) {
        let home = self.functions[id].home;
        let members = store
            .path
            .iter()
            .filter_map(|&(ty, member)| Some((self.structs.id(home, ty)?, member)));
        let dead = members.clone().find(|&(s, member)| !self.structs.is_live(s, member));
        if let Some(dead) = dead {
            if !self.acts(id, store.value) && !self.acts(id, store.pointer) {
                self.waiting.entry(dead).or_default().push(Waiting::Store(id, store));
                return;
            }
            // All members on the way.
            let members: Vec<_> = members.collect();
            for (s, member) in members {
                self.enliven(s, member);
            }
        }
        self.address(id, store.pointer);
        self.read(id, store.value);
    }

    /// The pointer of a store: its members are written, not read.
    fn address(&mut self, id: usize, mut handle: Handle<Expression>) {
        let Some(function) = self.functions[id].ir(self.homes) else {
            return;
        };
        loop {
            self.states[id].live[handle.index()] = true;
            match function.expressions[handle] {
                Expression::AccessIndex { base, .. } => handle = base,
                Expression::Access { base, index } => {
                    self.read(id, index);
                    handle = base;
                }
                Expression::LocalVariable(local) => {
                    function.local_variables[local].init.iter().for_each(|&i| self.read(id, i));
                    return;
                }
                // A pointer from elsewhere: an argument, a variable of the module.
                _ => return,
            }
        }
    }

    fn read(&mut self, id: usize, handle: Handle<Expression>) {
        let planned = &self.functions[id];
        let Some(function) = planned.ir(self.homes) else { return };
        // A read is never begun within another one.
        self.stack.push(handle);
        self.follow(id, planned, function);
    }

    /// Reads what is on the stack, and all that is needed for it.
    fn follow(&mut self, id: usize, planned: &Planned, function: &naga::Function) {
        while let Some(handle) = self.stack.pop() {
            let state = &mut self.states[id];
            if std::mem::replace(&mut state.read[handle.index()], true) {
                continue;
            }
            state.live[handle.index()] = true;
            self.expression(id, planned, function, handle);
        }
    }

    fn expression(&mut self, id: usize, planned: &Planned, function: &naga::Function, handle: Handle<Expression>) {
        let unit = self.unit(id);
        match &function.expressions[handle] {
            Expression::AccessIndex { base, index } => {
                if let Expression::GlobalVariable(global) = function.expressions[*base]
                    && unit.params == Some(global)
                {
                    self.params.insert((planned.home, *index));
                }
                if let Some(s) = struct_of(planned, self.structs, unit, *base) {
                    self.enliven(s, *index);
                }
                self.stack.push(*base);
            }
            Expression::LocalVariable(local) => self.stack.extend(function.local_variables[*local].init),
            Expression::Compose { ty, components } => {
                let Some(s) = self.structs.id(planned.home, *ty) else {
                    self.stack.extend(components);
                    return;
                };
                for (index, &component) in components.iter().enumerate() {
                    if !self.structs.is_live(s, index as u32) {
                        if !self.acts(id, component) {
                            let waiting = self.waiting.entry((s, index as u32)).or_default();
                            waiting.push(Waiting::Component(id, component));
                            continue;
                        }
                        self.enliven(s, index as u32);
                    }
                    self.stack.push(component);
                }
            }
            Expression::CallResult(callee) => {
                let call = self.facts(id).and_then(|facts| facts.calls.get(*facts.call_of.get(&handle)?));
                if let Some(call) = call
                    && self.can_go(id, *callee)
                {
                    if let Some(callee) = planned.calls.get(*callee) {
                        self.need(callee);
                    }
                    self.stack.extend(&call.arguments);
                }
            }
            other => expression_operands(other, &mut |&h| self.stack.push(h)),
        }
    }

    /// Stage outputs are alive, those of a vertex stage where a fragment stage reads their location.
    fn link_stages(&mut self, outputs: &[Output]) -> bool {
        let mut changed = false;
        for output in outputs {
            let wanted = match &output.readers {
                Some(readers) => readers.iter().any(|&(id, member)| self.structs.is_live(id, member)),
                None => true,
            };
            changed |= wanted && self.enliven(output.id, output.member);
        }
        changed
    }

    /// WGSL has no empty structs: one that is used keeps a member, a built-in value rather than a location.
    fn keep_one_member(&mut self) -> bool {
        let is_empty = |s: &super::structs::Struct| !s.fixed && !s.live.iter().any(|&l| l);
        let mut used = vec![false; self.structs.list.len()];
        for (planned, state) in self.functions.iter().zip(&self.states).filter(|(_, state)| state.needed) {
            let ir = &self.homes[planned.home].unit.ir;
            let Some(facts) = planned.facts(self.homes) else { continue };
            let living = facts.typed.iter().filter(|(h, _)| state.live[h.index()]).map(|&(_, ty)| ty);
            for ty in facts.types.iter().copied().chain(living) {
                used_structs(self.structs, ir, planned.home, ty, &mut |id| used[id] = true);
            }
        }
        let mut changed = false;
        for id in (0..used.len()).filter(|&id| used[id]) {
            let s = &self.structs.list[id];
            if is_empty(s) {
                let member = s.kept_when_empty(self.homes);
                changed |= self.enliven(id, member);
            }
        }
        changed
    }
}
