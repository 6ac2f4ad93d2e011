//! What a function reads whatever it is linked to: followed once, when its unit is parsed.

use naga::valid::FunctionInfo;
use naga::{Expression, Function, Handle, Type};

use super::facts::{Facts, struct_type};
use super::operands::expression_operands;
use super::unit::Unit;

/// What a function reads as soon as a living call reaches it, up to where it depends on what is linked: which members of a struct
/// are alive decides what of its constructors is read.
#[derive(Debug, Default)]
pub struct Always {
    /// Expressions that are read.
    pub read: Vec<bool>,
    /// The same, and expressions whose address alone is needed.
    pub live: Vec<bool>,
    /// Members that are read: struct type in the unit, member.
    pub members: Vec<(Handle<Type>, u32)>,
    /// Members of `params` that are read.
    pub params: Vec<u32>,
    /// Functions whose results are read.
    pub calls: Vec<Handle<Function>>,
    /// Constructors of declared structs: their components have not been followed.
    pub composed: Vec<Handle<Expression>>,
}

impl Always {
    /// Of a function whose other facts are known.
    pub(super) fn new(unit: &Unit, function: &Function, info: &FunctionInfo, facts: &Facts) -> Self {
        let len = function.expressions.len();
        let mut always = Self {
            read: vec![false; len],
            live: vec![false; len],
            ..Self::default()
        };
        let mut stack = facts.reads.clone();
        for store in facts.stores.iter().filter(|store| store.path.is_empty()) {
            stack.push(store.value);
            always.address(function, store.pointer, &mut stack);
        }
        while let Some(handle) = stack.pop() {
            if std::mem::replace(&mut always.read[handle.index()], true) {
                continue;
            }
            always.live[handle.index()] = true;
            always.expression(unit, function, info, facts, handle, &mut stack);
        }
        always.members.sort_unstable();
        always.members.dedup();
        always.params.sort_unstable();
        always.params.dedup();
        always
    }

    /// The pointer of a store is not read itself.
    fn address(&mut self, function: &Function, mut handle: Handle<Expression>, stack: &mut Vec<Handle<Expression>>) {
        loop {
            self.live[handle.index()] = true;
            match function.expressions[handle] {
                Expression::AccessIndex { base, .. } => handle = base,
                Expression::Access { base, index } => {
                    stack.push(index);
                    handle = base;
                }
                Expression::LocalVariable(local) => {
                    stack.extend(function.local_variables[local].init);
                    return;
                }
                _ => return,
            }
        }
    }

    fn expression(
        &mut self,
        unit: &Unit,
        function: &Function,
        info: &FunctionInfo,
        facts: &Facts,
        handle: Handle<Expression>,
        stack: &mut Vec<Handle<Expression>>,
    ) {
        match &function.expressions[handle] {
            Expression::AccessIndex { base, index } => {
                if let Expression::GlobalVariable(global) = function.expressions[*base]
                    && unit.params == Some(global)
                {
                    self.params.push(*index);
                }
                self.members.extend(struct_type(unit, info, *base).map(|ty| (ty, *index)));
                stack.push(*base);
            }
            Expression::LocalVariable(local) => stack.extend(function.local_variables[*local].init),
            Expression::Compose { ty, .. } if unit.structs.contains_key(ty) => self.composed.push(handle),
            Expression::CallResult(callee) => {
                // A call that stays reads its arguments itself; one that may go reads them for its result.
                if let Some(&call) = facts.call_of.get(&handle) {
                    self.calls.push(*callee);
                    stack.extend(&facts.calls[call].arguments);
                }
            }
            other => expression_operands(other, &mut |&h| stack.push(h)),
        }
    }
}
