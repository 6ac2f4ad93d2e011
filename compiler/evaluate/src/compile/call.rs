//! Calls, and atomic operations.

use naga::{Expression, Function, Handle, TypeInner};

use super::Place;
use super::function::Body;
use crate::code::Op;
use crate::error::{EvaluateError, unsupported};

impl Body<'_, '_> {
    /// A call: arguments are copied, and the result is, so that the next call does not change it.
    pub fn call(
        &mut self,
        callee: Handle<Function>,
        arguments: &[Handle<Expression>],
        result: Option<Handle<Expression>>,
    ) -> Result<(), EvaluateError> {
        let module = self.compiler.module;
        let Some(frame) = self.compiler.functions.get(callee.index()).cloned() else {
            return Err(unsupported("a call of a later function"));
        };
        if let Some(trap) = frame.trap {
            return Err(self.compiler.traps[trap as usize].clone());
        }
        for ((argument, to), given) in module.functions[callee].arguments.iter().zip(frame.arguments).zip(arguments) {
            let (from, n) = match module.types[argument.ty].inner {
                TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } => (self.pointer(*given)?, 1),
                _ => (self.value(*given)?, self.compiler.len_of(argument.ty)?),
            };
            self.compiler.code.push(Op::Copy { to, from, n });
        }
        self.compiler.code.push(Op::Call { to: frame.entry });
        if let (Some(result), Some(of)) = (result, &module.functions[callee].result) {
            let n = self.compiler.len_of(of.ty)?;
            let to = self.compiler.alloc(n)?;
            self.compiler.code.push(Op::Copy { to, from: frame.result, n });
            self.places[result.index()] = Place::Value(to);
        }
        Ok(())
    }

    /// An atomic operation, of the one invocation.
    pub fn atomic(
        &mut self,
        pointer: Handle<Expression>,
        fun: &naga::AtomicFunction,
        value: Handle<Expression>,
        result: Option<Handle<Expression>>,
    ) -> Result<(), EvaluateError> {
        let leaf = self.leaf_of(value)?;
        let compare = match fun {
            naga::AtomicFunction::Exchange { compare: Some(compare) } => Some(self.value(*compare)?),
            _ => None,
        };
        let value = self.value(value)?;
        let (pointer, offset) = match self.place(pointer)? {
            Place::Behind(pointer, offset) => (pointer, offset),
            _ => (self.pointer(pointer)?, 0),
        };
        let mut to = None;
        if let Some(result) = result {
            let n = self.compiler.len(self.type_of(result))?;
            let at = self.compiler.alloc(n)?;
            self.places[result.index()] = Place::Value(at);
            to = Some(at);
        }
        self.compiler.code.push(Op::Atomic {
            fun: *fun,
            leaf,
            pointer,
            offset,
            value,
            compare,
            result: to,
        });
        Ok(())
    }
}
