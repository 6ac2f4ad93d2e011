//! The loop over instructions.

use naga::{AtomicFunction, BinaryOperator as B, UnaryOperator};

use super::memory::Slot;
use super::{Machine, integer};
use crate::code::{At, Convert, Op, Pointer, Product, Test};
use crate::error::{EvaluateError, unsupported};
use crate::number::{Number, Truth};
use crate::tree::Leaf;

/// Numbers that one step copies.
const COPIES: u32 = 16;

impl<N: Number> Machine<'_, N> {
    /// Runs code from an instruction to the return that nobody called for.
    pub(crate) fn execute(&mut self, start: u32) -> Result<(), EvaluateError> {
        let program = self.program;
        self.calls.clear();
        self.steps = program.limits.steps;
        let mut pc = start as usize;
        loop {
            self.spend(1)?;
            let op = program.code[pc];
            pc += 1;
            match op {
                Op::Copy { to, from, n } => {
                    if n > COPIES {
                        self.spend(n / COPIES)?;
                    }
                    self.copy(to, from, n);
                }
                Op::Fill { to, from, n } => {
                    let slot = self.memory[from as usize];
                    self.memory[to as usize..(to + n) as usize].fill(slot);
                }
                Op::Clear { to, n } => {
                    self.spend(n / COPIES)?;
                    self.clear(to, n);
                }
                Op::Swizzle { to, from, n, pattern } => {
                    for (i, component) in (0..n).zip(pattern) {
                        self.copy(to + i, from + component as u32, 1);
                    }
                }
                Op::Pick {
                    to,
                    base,
                    index,
                    stride,
                    count,
                } => {
                    self.spend(stride / COPIES)?;
                    let index = self.int(index).min(count.saturating_sub(1));
                    self.copy(to, base + index * stride, stride);
                }
                Op::Unary { op, leaf, to, a, n } => self.unary(op, leaf, to, a, n),
                Op::Binary {
                    op,
                    leaf,
                    to,
                    a,
                    b,
                    n,
                    steps,
                } => self.binary(op, leaf, to, (a, steps[0]), (b, steps[1]), n),
                Op::Product { to, a, b, shape } => self.product(to, a, b, shape),
                Op::Select {
                    to,
                    condition,
                    accept,
                    reject,
                    n,
                    step,
                } => {
                    for i in 0..n {
                        let truth = self.truth(condition + i * u32::from(step));
                        let slot = self.choose(truth, accept + i, reject + i);
                        self.set(to + i, slot);
                    }
                }
                Op::Test { test, to, a, n } => self.test(test, to, a, n),
                Op::Convert { convert, to, a, n } => {
                    for i in 0..n {
                        let slot = self.convert(convert, a + i);
                        self.set(to + i, slot);
                    }
                }
                Op::Math {
                    fun,
                    leaf,
                    to,
                    args,
                    n,
                    steps,
                } => self.math(fun, leaf, to, args, n, steps)?,
                Op::Load { to, pointer, offset, n } => {
                    self.spend(n / COPIES)?;
                    let from = self.pointer(pointer).at.saturating_add(offset);
                    self.check(from, n)?;
                    self.copy(to, from, n);
                }
                Op::Store { pointer, offset, from, n } => {
                    self.spend(n / COPIES)?;
                    let to = self.pointer(pointer).at.saturating_add(offset);
                    self.check(to, n)?;
                    self.copy(to, from, n);
                }
                Op::Index {
                    to,
                    pointer,
                    offset,
                    index,
                    stride,
                    count,
                } => {
                    let pointer = self.pointer(pointer);
                    let count = if count == 0 { pointer.elements } else { count };
                    let index = self.int(index).min(count.saturating_sub(1));
                    let at = pointer.at.saturating_add(offset).saturating_add(index.saturating_mul(stride));
                    self.set(to, Slot::Pointer(Pointer { at, elements: 0 }));
                }
                Op::Offset { to, pointer, offset } => {
                    let Pointer { at, elements } = self.pointer(pointer);
                    let at = at.saturating_add(offset);
                    self.set(to, Slot::Pointer(Pointer { at, elements }));
                }
                Op::Length { to, pointer } => {
                    let elements = self.pointer(pointer).elements;
                    self.set(to, Slot::Uint(elements));
                }
                Op::Atomic {
                    fun,
                    leaf,
                    pointer,
                    offset,
                    value,
                    compare,
                    result,
                } => {
                    let at = self.pointer(pointer).at.saturating_add(offset);
                    self.check(at, 1)?;
                    self.atomic(fun, leaf, at, value, compare, result)?;
                }
                Op::Image { image, to } => self.image(&program.images[image as usize], to)?,
                Op::Jump { to } => pc = to as usize,
                Op::JumpUnless { condition, to } => {
                    let truth = self.truth(condition);
                    self.undecided |= !truth.sure;
                    if !truth.value {
                        pc = to as usize;
                    }
                }
                Op::Switch { selector, table } => {
                    let bits = self.int(selector);
                    let table = &program.tables[table as usize];
                    self.spend(u32::try_from(table.cases.len()).unwrap_or(u32::MAX) / COPIES)?;
                    let case = table.cases.iter().find(|(value, _)| *value == bits);
                    pc = case.map_or(table.default, |(_, to)| *to) as usize;
                }
                Op::Call { to } => {
                    self.calls.push(u32::try_from(pc).unwrap_or(u32::MAX));
                    pc = to as usize;
                }
                Op::Return => match self.calls.pop() {
                    Some(to) => pc = to as usize,
                    None => return Ok(()),
                },
                Op::Discard => {
                    self.discarded = true;
                    return Ok(());
                }
                Op::Tally(tally) => self.visits[tally as usize] += 1,
                Op::Trap(trap) => return Err(program.traps[trap as usize].clone()),
            }
        }
    }

    #[inline]
    fn spend(&mut self, steps: u32) -> Result<(), EvaluateError> {
        match self.steps.checked_sub(u64::from(steps)) {
            Some(left) => {
                self.steps = left;
                Ok(())
            }
            None => Err(EvaluateError::Steps {
                limit: self.program.limits.steps,
            }),
        }
    }

    /// Whether these numbers are in memory. Indices are clamped, so they are.
    fn check(&self, at: At, n: u32) -> Result<(), EvaluateError> {
        if at as usize + n as usize <= self.memory.len() {
            Ok(())
        } else {
            Err(unsupported("an access outside of its variable"))
        }
    }

    /// One of two, or what covers both where the choice is not sure.
    #[inline]
    fn choose(&mut self, truth: Truth, accept: At, reject: At) -> Slot<N> {
        let (accept, reject) = (self.memory[accept as usize], self.memory[reject as usize]);
        let (chosen, other) = if truth.value { (accept, reject) } else { (reject, accept) };
        if truth.sure {
            return chosen;
        }
        match (chosen, other) {
            (Slot::Float(chosen), Slot::Float(other)) => Slot::Float(chosen.or_else(other)),
            (Slot::Bool(chosen), Slot::Bool(other)) => Slot::Bool(Truth {
                value: chosen.value,
                sure: chosen.sure && other.sure && chosen.value == other.value,
            }),
            _ => {
                self.undecided |= chosen != other;
                chosen
            }
        }
    }

    fn unary(&mut self, op: UnaryOperator, leaf: Leaf, to: At, a: At, n: u32) {
        for i in 0..n {
            let slot = match (op, leaf) {
                (UnaryOperator::Negate, Leaf::Float) => Slot::Float(self.float(a + i).neg()),
                (UnaryOperator::LogicalNot, _) => Slot::Bool(self.truth(a + i).not()),
                (UnaryOperator::Negate, _) => Slot::Int(self.int(a + i).cast_signed().wrapping_neg()),
                (UnaryOperator::BitwiseNot, Leaf::Int) => Slot::Int(!self.int(a + i).cast_signed()),
                (UnaryOperator::BitwiseNot, _) => Slot::Uint(!self.int(a + i)),
            };
            self.set(to + i, slot);
        }
    }

    #[inline]
    fn floats(&mut self, to: At, a: (At, u8), b: (At, u8), n: u32, f: impl Fn(N, N) -> N) {
        for i in 0..n {
            let x = self.float(a.0 + i * u32::from(a.1));
            let y = self.float(b.0 + i * u32::from(b.1));
            self.set(to + i, Slot::Float(f(x, y)));
        }
    }

    #[inline]
    fn compare(&mut self, to: At, a: (At, u8), b: (At, u8), n: u32, f: impl Fn(N, N) -> Truth) {
        for i in 0..n {
            let x = self.float(a.0 + i * u32::from(a.1));
            let y = self.float(b.0 + i * u32::from(b.1));
            self.set(to + i, Slot::Bool(f(x, y)));
        }
    }

    fn binary(&mut self, op: B, leaf: Leaf, to: At, a: (At, u8), b: (At, u8), n: u32) {
        match (leaf, op) {
            (Leaf::Float, B::Add) => self.floats(to, a, b, n, N::add),
            (Leaf::Float, B::Subtract) => self.floats(to, a, b, n, N::sub),
            // One value with itself is a square, which an interval knows never to be negative.
            (Leaf::Float, B::Multiply) if a == b => self.floats(to, a, b, n, |x, _| x.square()),
            (Leaf::Float, B::Multiply) => self.floats(to, a, b, n, N::mul),
            (Leaf::Float, B::Divide) => self.floats(to, a, b, n, N::div),
            (Leaf::Float, B::Modulo) => self.floats(to, a, b, n, N::rem),
            (Leaf::Float, B::Equal) => self.compare(to, a, b, n, N::equal),
            (Leaf::Float, B::NotEqual) => self.compare(to, a, b, n, |x, y| x.equal(y).not()),
            (Leaf::Float, B::Less) => self.compare(to, a, b, n, N::less),
            (Leaf::Float, B::LessEqual) => self.compare(to, a, b, n, N::less_equal),
            (Leaf::Float, B::Greater) => self.compare(to, a, b, n, |x, y| y.less(x)),
            (Leaf::Float, B::GreaterEqual) => self.compare(to, a, b, n, |x, y| y.less_equal(x)),
            (Leaf::Bool, _) => {
                for i in 0..n {
                    let x = self.truth(a.0 + i * u32::from(a.1));
                    let y = self.truth(b.0 + i * u32::from(b.1));
                    let truth = match op {
                        B::And | B::LogicalAnd => x.and(y),
                        B::InclusiveOr | B::LogicalOr => x.or(y),
                        B::Equal => x.equals(y),
                        _ => x.equals(y).not(),
                    };
                    self.set(to + i, Slot::Bool(truth));
                }
            }
            _ => {
                for i in 0..n {
                    let x = self.int(a.0 + i * u32::from(a.1));
                    let y = self.int(b.0 + i * u32::from(b.1));
                    match integer::compare(op, leaf == Leaf::Int, x, y) {
                        Some(truth) => self.set(to + i, Slot::Bool(Truth::sure(truth))),
                        None => self.set_int(to + i, leaf, integer::binary(op, leaf == Leaf::Int, x, y)),
                    }
                }
            }
        }
    }

    fn product(&mut self, to: At, a: At, b: At, shape: Product) {
        let (rows, inner) = (u32::from(shape.rows), u32::from(shape.inner));
        for column in 0..u32::from(shape.columns) {
            for row in 0..rows {
                let (mut x, mut y) = ([N::ZERO; 4], [N::ZERO; 4]);
                for k in 0..inner.min(4) {
                    x[k as usize] = self.float(a + k * rows + row);
                    y[k as usize] = self.float(b + column * inner + k);
                }
                let n = inner.min(4) as usize;
                let dot = N::dot(&x[..n], &y[..n], false);
                self.set(to + column * rows + row, Slot::Float(dot));
            }
        }
    }

    fn test(&mut self, test: Test, to: At, a: At, n: u32) {
        match test {
            Test::All | Test::Any => {
                let all = (0..n).map(|i| self.truth(a + i));
                let truth = if test == Test::All {
                    all.fold(Truth::sure(true), Truth::and)
                } else {
                    all.fold(Truth::sure(false), Truth::or)
                };
                self.set(to, Slot::Bool(truth));
            }
            Test::IsNan => (0..n).for_each(|i| self.set(to + i, Slot::Bool(self.float(a + i).is_nan()))),
            Test::IsInf => (0..n).for_each(|i| self.set(to + i, Slot::Bool(self.float(a + i).is_inf()))),
        }
    }

    fn convert(&mut self, convert: Convert, a: At) -> Slot<N> {
        let from = self.memory[a as usize];
        let (slot, sure) = match (convert, from) {
            (Convert::Value(Leaf::Int), Slot::Float(x)) => {
                let whole = x.to_i32();
                (Slot::Int(whole.value), whole.sure)
            }
            (Convert::Value(Leaf::Uint), Slot::Float(x)) => {
                let whole = x.to_u32();
                (Slot::Uint(whole.value), whole.sure)
            }
            (Convert::Value(Leaf::Bool), Slot::Float(x)) => (Slot::Bool(x.equal(N::ZERO).not()), true),
            (Convert::Value(Leaf::Float), Slot::Int(x)) => (Slot::Float(N::from_i32(x)), true),
            (Convert::Value(Leaf::Float), Slot::Uint(x)) => (Slot::Float(N::from_u32(x)), true),
            (Convert::Value(Leaf::Float), Slot::Bool(x)) => {
                let (one, zero) = (N::from_f32(1.0), N::ZERO);
                let (chosen, other) = if x.value { (one, zero) } else { (zero, one) };
                (Slot::Float(if x.sure { chosen } else { chosen.or_else(other) }), true)
            }
            (Convert::Value(Leaf::Int), Slot::Bool(x)) => (Slot::Int(i32::from(x.value)), x.sure),
            (Convert::Value(Leaf::Uint), Slot::Bool(x)) => (Slot::Uint(u32::from(x.value)), x.sure),
            (Convert::Value(Leaf::Bool), Slot::Int(x)) => (Slot::Bool(Truth::sure(x != 0)), true),
            (Convert::Value(Leaf::Bool), Slot::Uint(x)) => (Slot::Bool(Truth::sure(x != 0)), true),
            (Convert::Bits(Leaf::Float), Slot::Int(x)) => (Slot::Float(N::from_f32(f32::from_bits(x.cast_unsigned()))), true),
            (Convert::Bits(Leaf::Float), Slot::Uint(x)) => (Slot::Float(N::from_f32(f32::from_bits(x))), true),
            (Convert::Bits(leaf), Slot::Float(x)) => {
                let bits = x.bits();
                let slot = if leaf == Leaf::Int {
                    Slot::Int(bits.value.cast_signed())
                } else {
                    Slot::Uint(bits.value)
                };
                (slot, bits.sure)
            }
            (Convert::Value(Leaf::Int) | Convert::Bits(Leaf::Int), Slot::Uint(x)) => (Slot::Int(x.cast_signed()), true),
            (Convert::Value(Leaf::Uint) | Convert::Bits(Leaf::Uint), Slot::Int(x)) => (Slot::Uint(x.cast_unsigned()), true),
            (_, same) => (same, true),
        };
        self.undecided |= !sure;
        slot
    }

    fn atomic(
        &mut self,
        fun: AtomicFunction,
        leaf: Leaf,
        at: At,
        value: At,
        compare: Option<At>,
        result: Option<At>,
    ) -> Result<(), EvaluateError> {
        if leaf == Leaf::Float {
            return Err(unsupported("an atomic operation on a float"));
        }
        let (old, given) = (self.int(at), self.int(value));
        let is_signed = leaf == Leaf::Int;
        let new = match fun {
            AtomicFunction::Add => old.wrapping_add(given),
            AtomicFunction::Subtract => old.wrapping_sub(given),
            AtomicFunction::And => old & given,
            AtomicFunction::ExclusiveOr => old ^ given,
            AtomicFunction::InclusiveOr => old | given,
            AtomicFunction::Min => integer::min(is_signed, old, given),
            AtomicFunction::Max => integer::max(is_signed, old, given),
            AtomicFunction::Exchange { .. } => match compare {
                Some(compare) if self.int(compare) != old => old,
                _ => given,
            },
        };
        self.set_int(at, leaf, new);
        if let Some(result) = result {
            self.set_int(result, leaf, old);
            if let Some(compare) = compare {
                let exchanged = self.int(compare) == old;
                self.set(result + 1, Slot::Bool(Truth::sure(exchanged)));
            }
        }
        Ok(())
    }
}
