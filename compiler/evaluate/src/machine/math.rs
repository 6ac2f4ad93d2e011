//! The built-in functions.

use half::f16;
use naga::MathFunction as M;

use super::memory::Slot;
use super::{Machine, integer};
use crate::code::At;
use crate::error::{EvaluateError, unsupported};
use crate::number::Number;
use crate::tree::Leaf;

/// Up to four numbers.
type Four<N> = [N; 4];

impl<N: Number> Machine<'_, N> {
    pub(super) fn math(&mut self, fun: M, leaf: Leaf, to: At, args: [At; 4], n: u32, steps: [u8; 4]) -> Result<(), EvaluateError> {
        if leaf != Leaf::Float {
            return self.integers(fun, leaf, to, args, n, steps);
        }
        let one = |m: &mut Self, f: fn(N) -> N| {
            for i in 0..n {
                let x = m.float(args[0] + i);
                m.set(to + i, Slot::Float(f(x)));
            }
        };
        let two = |m: &mut Self, f: fn(N, N) -> N| {
            for i in 0..n {
                let [x, y] = [0, 1].map(|k| m.float(args[k] + i * u32::from(steps[k])));
                m.set(to + i, Slot::Float(f(x, y)));
            }
        };
        let three = |m: &mut Self, f: fn(N, N, N) -> N| {
            for i in 0..n {
                let [x, y, z] = [0, 1, 2].map(|k| m.float(args[k] + i * u32::from(steps[k])));
                m.set(to + i, Slot::Float(f(x, y, z)));
            }
        };
        match fun {
            M::Abs => one(self, N::abs),
            M::Min => two(self, N::min),
            M::Max => two(self, N::max),
            M::Clamp => three(self, N::clamp),
            M::Saturate => one(self, |x| x.clamp(N::ZERO, N::from_f32(1.0))),
            M::Cos => one(self, N::cos),
            M::Cosh => one(self, N::cosh),
            M::Sin => one(self, N::sin),
            M::Sinh => one(self, N::sinh),
            M::Tan => one(self, N::tan),
            M::Tanh => one(self, N::tanh),
            M::Acos => one(self, N::acos),
            M::Asin => one(self, N::asin),
            M::Atan => one(self, N::atan),
            M::Atan2 => two(self, N::atan2),
            M::Asinh => one(self, N::asinh),
            M::Acosh => one(self, N::acosh),
            M::Atanh => one(self, N::atanh),
            M::Radians => one(self, |x| x.mul(N::from_f32(std::f32::consts::PI / 180.0))),
            M::Degrees => one(self, |x| x.mul(N::from_f32(180.0 / std::f32::consts::PI))),
            M::Ceil => one(self, N::ceil),
            M::Floor => one(self, N::floor),
            M::Round => one(self, N::round),
            M::Fract => one(self, N::fract),
            M::Trunc => one(self, N::trunc),
            M::Modf => {
                for i in 0..n {
                    let x = self.float(args[0] + i);
                    let whole = x.trunc();
                    self.set(to + i, Slot::Float(x.sub(whole)));
                    self.set(to + n + i, Slot::Float(whole));
                }
            }
            M::Frexp => {
                for i in 0..n {
                    let (fraction, exponent) = self.float(args[0] + i).frexp();
                    self.undecided |= !exponent.sure;
                    self.set(to + i, Slot::Float(fraction));
                    self.set(to + n + i, Slot::Int(exponent.value));
                }
            }
            M::Ldexp => {
                for i in 0..n {
                    let e = self.int(args[1] + i * u32::from(steps[1])).cast_signed();
                    let x = self.float(args[0] + i);
                    self.set(to + i, Slot::Float(x.ldexp(e)));
                }
            }
            M::Exp => one(self, N::exp),
            M::Exp2 => one(self, N::exp2),
            M::Log => one(self, N::log),
            M::Log2 => one(self, N::log2),
            M::Pow => two(self, N::pow),
            M::Sign => one(self, N::sign),
            M::Fma => three(self, N::fma),
            M::Mix => three(self, N::mix),
            M::Step => two(self, N::step),
            M::SmoothStep => three(self, |low, high, x| {
                let (zero, one) = (N::ZERO, N::from_f32(1.0));
                let t = x.sub(low).div(high.sub(low)).clamp(zero, one);
                t.square().mul(N::from_f32(3.0).sub(N::from_f32(2.0).mul(t)))
            }),
            M::Sqrt => one(self, N::sqrt),
            M::InverseSqrt => one(self, N::inverse_sqrt),
            M::QuantizeToF16 => one(self, N::quantize),
            M::Dot | M::Cross | M::Distance | M::Length | M::Normalize | M::FaceForward | M::Reflect | M::Refract => {
                self.geometry(fun, to, args, n);
            }
            M::Outer => {
                let (columns, rows) = (n & 0xff, n >> 8);
                for c in 0..columns {
                    for r in 0..rows {
                        let x = self.float(args[0] + r).mul(self.float(args[1] + c));
                        self.set(to + c * rows + r, Slot::Float(x));
                    }
                }
            }
            M::Transpose => {
                let (columns, rows) = (n & 0xff, n >> 8);
                for c in 0..columns {
                    (0..rows).for_each(|r| self.copy(to + r * columns + c, args[0] + c * rows + r, 1));
                }
            }
            M::Determinant => {
                let size = n & 0xff;
                let mut m = [[N::ZERO; 4]; 4];
                for c in 0..size.min(4) {
                    for r in 0..size.min(4) {
                        m[c as usize][r as usize] = self.float(args[0] + c * size + r);
                    }
                }
                let value = determinant(&m, size.min(4) as usize);
                self.set(to, Slot::Float(value.unspecified()));
            }
            M::Pack4x8snorm => self.pack(to, args[0], 4, |x| (snorm(x, 127.0) & 0xff, 8)),
            M::Pack4x8unorm => self.pack(to, args[0], 4, |x| (unorm(x, 255.0), 8)),
            M::Pack2x16snorm => self.pack(to, args[0], 2, |x| (snorm(x, 32767.0) & 0xffff, 16)),
            M::Pack2x16unorm => self.pack(to, args[0], 2, |x| (unorm(x, 65535.0), 16)),
            M::Pack2x16float => self.pack(to, args[0], 2, |x| (u32::from(f16::from_f32(x).to_bits()), 16)),
            _ => return Err(unsupported(format!("{fun:?} of floats"))),
        }
        Ok(())
    }

    fn four(&self, at: At, n: u32) -> Four<N> {
        let mut list = [N::ZERO; 4];
        for (i, x) in (0..n.min(4)).zip(&mut list) {
            *x = self.float(at + i);
        }
        list
    }

    fn put(&mut self, to: At, list: &[N]) {
        for (i, x) in (to..).zip(list) {
            self.set(i, Slot::Float(*x));
        }
    }

    fn geometry(&mut self, fun: M, to: At, args: [At; 4], count: u32) {
        let n = count.min(4) as usize;
        let x = self.four(args[0], count);
        let length = |x: &Four<N>| {
            if n == 1 {
                x[0].square().sqrt()
            } else {
                N::dot(&x[..n], &x[..n], true).sqrt()
            }
        };
        let y = || self.four(args[1], count);
        match fun {
            M::Dot => {
                let dot = N::dot(&x[..n], &y()[..n], args[0] == args[1]);
                self.set(to, Slot::Float(dot));
            }
            M::Cross => {
                let y = y();
                let cross = [1, 2, 0].map(|i| {
                    let j = (i + 1) % 3;
                    x[i].mul(y[j]).sub(x[j].mul(y[i]))
                });
                self.put(to, &cross);
            }
            M::Length => self.set(to, Slot::Float(length(&x))),
            M::Distance => {
                let y = y();
                let difference = std::array::from_fn(|i| x[i].sub(y[i]));
                self.set(to, Slot::Float(length(&difference)));
            }
            M::Normalize => {
                let by = length(&x);
                let unit = x.map(|x| x.div(by));
                self.put(to, &unit[..n]);
            }
            M::FaceForward => {
                let z = self.four(args[2], count);
                let truth = N::dot(&z[..n], &y()[..n], false).less(N::ZERO);
                let turned = x.map(|x| {
                    let (chosen, other) = if truth.value { (x, x.neg()) } else { (x.neg(), x) };
                    if truth.sure { chosen } else { chosen.or_else(other) }
                });
                self.put(to, &turned[..n]);
            }
            M::Reflect => {
                let y = y();
                let twice = N::from_f32(2.0).mul(N::dot(&x[..n], &y[..n], false));
                let reflected: Four<N> = std::array::from_fn(|i| x[i].sub(twice.mul(y[i])));
                self.put(to, &reflected[..n]);
            }
            _ => {
                let (y, z) = (y(), self.float(args[2]));
                let dot = N::dot(&y[..n], &x[..n], false);
                let one = N::from_f32(1.0);
                let k = one.sub(z.square().mul(one.sub(dot.square())));
                let (below, root) = (k.less(N::ZERO), k.max(N::ZERO).sqrt());
                let refracted: Four<N> = std::array::from_fn(|i| {
                    let bent = z.mul(x[i]).sub(z.mul(dot).add(root).mul(y[i]));
                    let (chosen, other) = if below.value { (N::ZERO, bent) } else { (bent, N::ZERO) };
                    if below.sure { chosen } else { chosen.or_else(other) }
                });
                self.put(to, &refracted[..n]);
            }
        }
    }

    /// Packs the f32 of some numbers. Where a number's bounds pack otherwise, the run hangs on a rounding.
    fn pack(&mut self, to: At, from: At, n: u32, one: impl Fn(f32) -> (u32, u32)) {
        let mut word = 0;
        for i in 0..n {
            let x = self.float(from + i);
            let (bits, width) = one(x.to_f32());
            self.undecided |= !x.packs_as(|x| one(x).0, bits);
            word |= bits << (i * width);
        }
        self.set(to, Slot::Uint(word));
    }

    fn integers(&mut self, fun: M, leaf: Leaf, to: At, args: [At; 4], n: u32, steps: [u8; 4]) -> Result<(), EvaluateError> {
        let signed = leaf == Leaf::Int;
        let is = |m: &Self, k: usize, i: u32| m.int(args[k] + i * u32::from(steps[k]));
        // Functions of a whole vector, and unpacking.
        match fun {
            M::Dot => {
                let sum = (0..n).fold(0_u32, |sum, i| sum.wrapping_add(is(self, 0, i).wrapping_mul(is(self, 1, i))));
                self.set_int(to, leaf, sum);
                return Ok(());
            }
            M::Dot4I8Packed | M::Dot4U8Packed => {
                let (x, y) = (is(self, 0, 0).to_le_bytes(), is(self, 1, 0).to_le_bytes());
                if fun == M::Dot4I8Packed {
                    let products = x
                        .iter()
                        .zip(y)
                        .map(|(x, y)| i32::from(x.cast_signed()) * i32::from(y.cast_signed()));
                    self.set(to, Slot::Int(products.sum()));
                } else {
                    self.set(to, Slot::Uint(x.iter().zip(y).map(|(x, y)| u32::from(*x) * u32::from(y)).sum()));
                }
                return Ok(());
            }
            M::Pack4xI8 | M::Pack4xU8 | M::Pack4xI8Clamp | M::Pack4xU8Clamp => {
                let byte = |x: u32| match fun {
                    M::Pack4xI8Clamp => x.cast_signed().clamp(-128, 127).cast_unsigned() & 0xff,
                    M::Pack4xU8Clamp => x.min(255),
                    _ => x & 0xff,
                };
                let word = (0..4).fold(0, |word, i| word | byte(is(self, 0, i)) << (8 * i));
                self.set(to, Slot::Uint(word));
                return Ok(());
            }
            M::Unpack4x8snorm | M::Unpack4x8unorm | M::Unpack2x16snorm | M::Unpack2x16unorm | M::Unpack2x16float => {
                self.unpack(fun, to, is(self, 0, 0));
                return Ok(());
            }
            M::Unpack4xI8 | M::Unpack4xU8 => {
                for (i, byte) in (to..).zip(is(self, 0, 0).to_le_bytes()) {
                    let slot = if fun == M::Unpack4xI8 {
                        Slot::Int(i32::from(byte.cast_signed()))
                    } else {
                        Slot::Uint(u32::from(byte))
                    };
                    self.set(i, slot);
                }
                return Ok(());
            }
            _ => {}
        }
        for i in 0..n {
            let x = is(self, 0, i);
            let value = match fun {
                M::Abs if signed => x.cast_signed().wrapping_abs().cast_unsigned(),
                M::Abs => x,
                M::Sign => x.cast_signed().signum().cast_unsigned(),
                M::Min => integer::min(signed, x, is(self, 1, i)),
                M::Max => integer::max(signed, x, is(self, 1, i)),
                M::Clamp => integer::min(signed, integer::max(signed, x, is(self, 1, i)), is(self, 2, i)),
                M::CountTrailingZeros => x.trailing_zeros(),
                M::CountLeadingZeros => x.leading_zeros(),
                M::CountOneBits => x.count_ones(),
                M::ReverseBits => x.reverse_bits(),
                M::ExtractBits => integer::extract(signed, x, self.int(args[1]), self.int(args[2])),
                M::InsertBits => integer::insert(x, is(self, 1, i), self.int(args[2]), self.int(args[3])),
                M::FirstTrailingBit => integer::first_trailing(x),
                M::FirstLeadingBit => integer::first_leading(signed, x),
                _ => return Err(unsupported(format!("{fun:?} of integers"))),
            };
            self.set_int(to + i, leaf, value);
        }
        Ok(())
    }

    fn unpack(&mut self, fun: M, to: At, word: u32) {
        let bytes = word.to_le_bytes();
        let [low, high] = [word & 0xffff, word >> 16].map(|half| half as u16);
        match fun {
            M::Unpack2x16float => {
                for (i, half) in (to..).zip([low, high]) {
                    self.set(i, Slot::Float(N::from_f32(f16::from_bits(half).to_f32())));
                }
            }
            M::Unpack4x8snorm => self.unpacked(to, &bytes.map(|b| (f32::from(b.cast_signed()) / 127.0).max(-1.0))),
            M::Unpack4x8unorm => self.unpacked(to, &bytes.map(|b| f32::from(b) / 255.0)),
            M::Unpack2x16snorm => self.unpacked(to, &[low, high].map(|h| (f32::from(h.cast_signed()) / 32767.0).max(-1.0))),
            _ => self.unpacked(to, &[low, high].map(|h| f32::from(h) / 65535.0)),
        }
    }

    fn unpacked(&mut self, to: At, list: &[f32]) {
        for (i, x) in (to..).zip(list) {
            self.set(i, Slot::Float(N::unpacked(*x)));
        }
    }
}

/// Of the first rows and columns.
fn determinant<N: Number>(m: &[[N; 4]; 4], size: usize) -> N {
    let two = |a: usize, b: usize, c: usize, d: usize| m[a][c].mul(m[b][d]).sub(m[a][d].mul(m[b][c]));
    match size {
        2 => two(0, 1, 0, 1),
        3 => {
            let part = |i: usize, j: usize, k: usize| m[0][i].mul(two(1, 2, j, k));
            part(0, 1, 2).sub(part(1, 0, 2)).add(part(2, 0, 1))
        }
        _ => {
            // Laplace along the first two columns.
            let pairs = [
                (0, 1, 2, 3, false),
                (0, 2, 1, 3, true),
                (0, 3, 1, 2, false),
                (1, 2, 0, 3, false),
                (1, 3, 0, 2, true),
                (2, 3, 0, 1, false),
            ];
            pairs.iter().fold(N::ZERO, |sum, &(i, j, k, l, minus)| {
                let product = two(0, 1, i, j).mul(two(2, 3, k, l));
                if minus { sum.sub(product) } else { sum.add(product) }
            })
        }
    }
}

/// A number in [-1, 1] as an integer, its bits.
#[allow(clippy::cast_possible_truncation)] // it is clamped
fn snorm(x: f32, scale: f32) -> u32 {
    ((0.5 + scale * x.clamp(-1.0, 1.0)).floor() as i32).cast_unsigned()
}

/// A number in [0, 1] as an integer.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it is clamped
fn unorm(x: f32, scale: f32) -> u32 {
    (0.5 + scale * x.clamp(0.0, 1.0)).floor() as u32
}
