//! Numbers in memory, and buffers that become numbers.

use super::{Machine, other};
use crate::code::{At, Cell, Pointer, Resource};
use crate::error::EvaluateError;
use crate::number::{Number, Truth};
use crate::tree::Leaf;

/// A number in memory. Memory is typed: what stands at a place never changes its kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Slot<N> {
    Float(N),
    Int(i32),
    Uint(u32),
    Bool(Truth),
    Pointer(Pointer),
}

/// A program's number as this machine has it.
pub(super) fn slot_of<N: Number>(cell: Cell) -> Slot<N> {
    match cell {
        Cell::Float(x) => Slot::Float(N::from_f32(x)),
        Cell::Int(x) => Slot::Int(x),
        Cell::Uint(x) => Slot::Uint(x),
        Cell::Bool(x) => Slot::Bool(Truth::sure(x)),
        Cell::Pointer(x) => Slot::Pointer(x),
    }
}

impl<N: Number> Machine<'_, N> {
    /// The float at a place.
    #[inline]
    pub(super) fn float(&self, at: At) -> N {
        match self.memory[at as usize] {
            Slot::Float(x) => x,
            _ => N::ZERO,
        }
    }

    /// The bits of the integer at a place.
    #[inline]
    pub(super) fn int(&self, at: At) -> u32 {
        match self.memory[at as usize] {
            Slot::Uint(x) => x,
            Slot::Int(x) => x.cast_unsigned(),
            _ => 0,
        }
    }

    /// The truth at a place.
    #[inline]
    pub(super) fn truth(&self, at: At) -> Truth {
        match self.memory[at as usize] {
            Slot::Bool(x) => x,
            _ => Truth::sure(false),
        }
    }

    /// The pointer at a place.
    #[inline]
    pub(super) fn pointer(&self, at: At) -> Pointer {
        match self.memory[at as usize] {
            Slot::Pointer(x) => x,
            _ => Pointer { at: 0, elements: 0 },
        }
    }

    #[inline]
    pub(super) fn set(&mut self, at: At, slot: Slot<N>) {
        self.memory[at as usize] = slot;
    }

    /// An integer of this kind.
    #[inline]
    pub(super) fn set_int(&mut self, at: At, leaf: Leaf, bits: u32) {
        self.memory[at as usize] = if leaf == Leaf::Int {
            Slot::Int(bits.cast_signed())
        } else {
            Slot::Uint(bits)
        };
    }

    #[inline]
    pub(super) fn copy(&mut self, to: At, from: At, n: u32) {
        let from = from as usize;
        if n == 1 {
            self.memory[to as usize] = self.memory[from];
        } else {
            self.memory.copy_within(from..from + n as usize, to as usize);
        }
    }

    /// Makes numbers zero, each of its kind.
    pub(super) fn clear(&mut self, to: At, n: u32) {
        for slot in &mut self.memory[to as usize..to as usize + n as usize] {
            *slot = match slot {
                Slot::Float(_) => Slot::Float(N::ZERO),
                Slot::Int(_) => Slot::Int(0),
                Slot::Uint(_) => Slot::Uint(0),
                Slot::Bool(_) => Slot::Bool(Truth::sure(false)),
                Slot::Pointer(pointer) => Slot::Pointer(*pointer),
            };
        }
    }

    /// Decodes a buffer by the layout of its type.
    pub(crate) fn fill(&mut self, index: usize, bytes: &[u8]) -> Result<(), EvaluateError> {
        let bound = &self.program.bound[index];
        let Resource::Buffer(tree) = &bound.resource else {
            return Err(other(bound, "buffer"));
        };
        if (bytes.len() as u64) < tree.bytes() {
            return Err(EvaluateError::BufferSize {
                name: bound.name.clone(),
                needed: tree.bytes(),
                found: bytes.len() as u64,
            });
        }
        let elements = tree.open().map_or(0, |(_, stride, at)| {
            let rest = (bytes.len() as u64).saturating_sub(u64::from(at));
            u32::try_from(rest / u64::from(stride)).unwrap_or(u32::MAX)
        });
        let len = tree.len_with(elements);
        let too_large = || EvaluateError::TooLarge {
            what: bound.name.clone(),
            limit: self.program.limits.numbers,
        };
        if len > self.program.limits.numbers as u64 {
            return Err(too_large());
        }
        let len = usize::try_from(len).map_err(|_| too_large())?;
        let mut at = self.pointer(bound.at).at as usize;
        if self.room[index] < len || at == 0 {
            at = self.memory.len();
            self.memory.resize(at + len, Slot::Uint(0));
            self.room[index] = len;
        }
        let mut slots = self.memory[at..at + len].iter_mut();
        tree.decode(bytes, elements, &mut |leaf, word| {
            let bits = u32::from_le_bytes(word);
            if let Some(slot) = slots.next() {
                *slot = match leaf {
                    Leaf::Float => Slot::Float(N::from_f32(f32::from_bits(bits))),
                    Leaf::Int => Slot::Int(bits.cast_signed()),
                    Leaf::Uint => Slot::Uint(bits),
                    Leaf::Bool => Slot::Bool(Truth::sure(bits != 0)),
                };
            }
        });
        let place = bound.at;
        let at = u32::try_from(at).map_err(|_| EvaluateError::TooLarge {
            what: bound.name.clone(),
            limit: self.program.limits.numbers,
        })?;
        self.set(place, Slot::Pointer(Pointer { at, elements }));
        Ok(())
    }
}
