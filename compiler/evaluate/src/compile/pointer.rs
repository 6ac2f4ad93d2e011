//! Parts of values and of variables.

use naga::{ArraySize, Expression, Handle, TypeInner};

use super::Place;
use super::function::Body;
use crate::code::{At, Cell, Op, Pointer};
use crate::error::{EvaluateError, unsupported};

/// How the parts of a composite are found.
struct Parts {
    /// Numbers of one.
    stride: u32,
    /// How many; none where the buffer says.
    count: Option<u32>,
}

impl Body<'_, '_> {
    /// What a pointer points at.
    fn pointee<'t>(&'t self, inner: &'t TypeInner) -> Option<TypeInner> {
        match *inner {
            TypeInner::Pointer { base, .. } => Some(self.compiler.module.types[base].inner.clone()),
            TypeInner::ValuePointer {
                size: Some(size), scalar, ..
            } => Some(TypeInner::Vector { size, scalar }),
            TypeInner::ValuePointer { size: None, scalar, .. } => Some(TypeInner::Scalar(scalar)),
            _ => None,
        }
    }

    fn parts(&self, inner: &TypeInner) -> Result<Parts, EvaluateError> {
        Ok(match *inner {
            TypeInner::Vector { size, .. } => Parts {
                stride: 1,
                count: Some(size as u32),
            },
            TypeInner::Matrix { columns, rows, .. } => Parts {
                stride: rows as u32,
                count: Some(columns as u32),
            },
            TypeInner::Array { base, size, .. } => Parts {
                stride: self.compiler.len_of(base)?,
                count: match size {
                    ArraySize::Constant(count) => Some(count.get()),
                    ArraySize::Dynamic => None,
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
                    ArraySize::Pending(handle) => Some(self.compiler.numbers[handle.index()].map_or(1, |x| x as u32)),
                },
            },
            TypeInner::BindingArray { .. } => return Err(unsupported("an array of bindings")),
            _ => return Err(unsupported("an index into such a type")),
        })
    }

    /// `base[index]` with an index that is computed.
    pub fn access(&mut self, base: Handle<Expression>, index: Handle<Expression>) -> Result<Place, EvaluateError> {
        let inner = self.type_of(base).clone();
        let index = self.value(index)?;
        self.access_at(base, &inner, index)
    }

    fn access_at(&mut self, base: Handle<Expression>, inner: &TypeInner, index: At) -> Result<Place, EvaluateError> {
        if let Some(pointee) = self.pointee(inner) {
            let parts = self.parts(&pointee)?;
            let (pointer, offset) = match self.place(base)? {
                Place::Fixed(at) => (self.pointer_to(at)?, 0),
                Place::Behind(pointer, offset) => (pointer, offset),
                Place::Value(pointer) => (pointer, 0),
                Place::Nothing | Place::Trap(_) => return Err(unsupported("such a pointer")),
            };
            let to = self.compiler.alloc(1)?;
            self.compiler.code.push(Op::Index {
                to,
                pointer,
                offset,
                index,
                stride: parts.stride,
                count: parts.count.unwrap_or(0),
            });
            return Ok(Place::Behind(to, 0));
        }
        let parts = self.parts(inner)?;
        let to = self.compiler.alloc(parts.stride)?;
        let base = self.value(base)?;
        self.compiler.code.push(Op::Pick {
            to,
            base,
            index,
            stride: parts.stride,
            count: parts.count.unwrap_or(1),
        });
        Ok(Place::Value(to))
    }

    /// `base.member`, or `base[2]`: no code, but for elements of runtime-sized arrays, which may be fewer.
    pub fn access_index(&mut self, base: Handle<Expression>, index: u32) -> Result<Place, EvaluateError> {
        let inner = self.type_of(base).clone();
        let pointee = self.pointee(&inner);
        let composite = pointee.as_ref().unwrap_or(&inner);
        let skip = match composite {
            TypeInner::Struct { members, .. } => {
                let before = members.iter().take(index as usize);
                before.map(|m| self.compiler.len_of(m.ty)).sum::<Result<u32, _>>()?
            }
            _ => {
                let parts = self.parts(composite)?;
                let Some(count) = parts.count else {
                    let index = self.compiler.put([Cell::Uint(index)].into_iter(), 1)?;
                    return self.access_at(base, &inner, index);
                };
                index.min(count.saturating_sub(1)) * parts.stride
            }
        };
        Ok(match self.place(base)? {
            Place::Value(pointer) if pointee.is_some() => Place::Behind(pointer, skip),
            Place::Value(at) => Place::Value(at + skip),
            Place::Fixed(at) => Place::Fixed(at + skip),
            Place::Behind(pointer, offset) => Place::Behind(pointer, offset + skip),
            Place::Nothing | Place::Trap(_) => return Err(unsupported("such a part")),
        })
    }

    /// A cell that points at a place.
    fn pointer_to(&mut self, at: At) -> Result<At, EvaluateError> {
        self.compiler.put([Cell::Pointer(Pointer { at, elements: 0 })].into_iter(), 1)
    }

    /// The cell of a pointer, made where it has none.
    pub fn pointer(&mut self, expression: Handle<Expression>) -> Result<At, EvaluateError> {
        match self.place(expression)? {
            Place::Fixed(at) => self.pointer_to(at),
            Place::Behind(pointer, 0) | Place::Value(pointer) => Ok(pointer),
            Place::Behind(pointer, offset) => {
                let to = self.compiler.alloc(1)?;
                self.compiler.code.push(Op::Offset { to, pointer, offset });
                Ok(to)
            }
            Place::Nothing | Place::Trap(_) => Err(unsupported("such a pointer")),
        }
    }

    /// Numbers behind a pointer.
    pub fn pointee_len(&self, pointer: Handle<Expression>) -> Result<u32, EvaluateError> {
        match *self.type_of(pointer) {
            TypeInner::Pointer { base, .. } => self.compiler.len_of(base),
            TypeInner::ValuePointer { size, .. } => Ok(size.map_or(1, |size| size as u32)),
            _ => Err(unsupported("such a pointer")),
        }
    }

    /// Reads a variable. What is written later does not change what was read.
    pub fn load(&mut self, pointer: Handle<Expression>) -> Result<Place, EvaluateError> {
        let n = self.pointee_len(pointer)?;
        let to = self.compiler.alloc(n)?;
        let op = match self.place(pointer)? {
            Place::Fixed(from) => Op::Copy { to, from, n },
            Place::Behind(pointer, offset) => Op::Load { to, pointer, offset, n },
            Place::Value(pointer) => Op::Load { to, pointer, offset: 0, n },
            Place::Nothing | Place::Trap(_) => return Err(unsupported("such a pointer")),
        };
        self.compiler.code.push(op);
        Ok(Place::Value(to))
    }

    /// Writes a variable.
    pub fn store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) -> Result<(), EvaluateError> {
        let n = self.pointee_len(pointer)?;
        let from = self.value(value)?;
        let op = match self.place(pointer)? {
            Place::Fixed(to) => Op::Copy { to, from, n },
            Place::Behind(pointer, offset) => Op::Store { pointer, offset, from, n },
            Place::Value(pointer) => Op::Store {
                pointer,
                offset: 0,
                from,
                n,
            },
            Place::Nothing | Place::Trap(_) => return Err(unsupported("such a pointer")),
        };
        self.compiler.code.push(op);
        Ok(())
    }
}
