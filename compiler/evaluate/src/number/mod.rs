//! What an evaluation computes with: f32, f64, or f32 with what a driver may make of it.

mod allowance;
mod allowed;
mod conforming;
mod float;

use std::fmt::Debug;

pub use allowed::Allowed;

use crate::error::EvaluateError;
use crate::machine::Machine;

/// What a comparison says. Not sure where another conforming driver may say the opposite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Truth {
    /// What the evaluation goes on with.
    pub value: bool,
    /// Whether every conforming driver says so.
    pub sure: bool,
}

impl Truth {
    /// A sure one.
    pub const fn sure(value: bool) -> Self {
        Self { value, sure: true }
    }

    /// `!`.
    #[must_use]
    pub fn not(self) -> Self {
        Self {
            value: !self.value,
            ..self
        }
    }

    /// `&`: sure where one is surely false.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let is_false = |t: Self| t.sure && !t.value;
        Self {
            value: self.value && other.value,
            sure: self.sure && other.sure || is_false(self) || is_false(other),
        }
    }

    /// `|`: sure where one is surely true.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        self.not().and(other.not()).not()
    }

    /// `==` of two truths.
    #[must_use]
    pub fn equals(self, other: Self) -> Self {
        Self {
            value: self.value == other.value,
            sure: self.sure && other.sure,
        }
    }
}

/// An integer that came from a number, and whether every conforming driver has the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Whole<T> {
    /// What the evaluation goes on with.
    pub value: T,
    /// Whether every conforming driver has it.
    pub sure: bool,
}

/// A number type that shaders can be evaluated with. The operations are WGSL's.
pub trait Number: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// Its name for people.
    const NAME: &'static str;
    /// Whether it has bounds that are apart.
    const SPREADS: bool;
    /// 0.
    const ZERO: Self;

    /// A value as a shader or a buffer has it.
    fn from_f32(x: f32) -> Self;
    /// A converted integer.
    fn from_i32(x: i32) -> Self;
    /// A converted integer.
    fn from_u32(x: u32) -> Self;
    /// The nearest f32.
    fn to_f32(self) -> f32;
    /// The nearest f64.
    fn to_f64(self) -> f64;
    /// Lowest and highest that it may be.
    fn bounds(self) -> (f64, f64);
    /// Toward zero, saturating at the largest f32 that the integer holds.
    fn to_i32(self) -> Whole<i32>;
    /// Toward zero, saturating at 0 and at the largest f32 that the integer holds.
    fn to_u32(self) -> Whole<u32>;
    /// Bits of the nearest f32.
    fn bits(self) -> Whole<u32>;

    /// Whether all f32 that it may be are packed into these bits; packing never falls.
    fn packs_as(self, pack: impl Fn(f32) -> u32, bits: u32) -> bool;

    /// x + y
    fn add(self, y: Self) -> Self;
    /// x - y
    fn sub(self, y: Self) -> Self;
    /// x y
    fn mul(self, y: Self) -> Self;
    /// x^2: of one value, so never negative.
    fn square(self) -> Self;
    /// x / y
    fn div(self, y: Self) -> Self;
    /// x - y trunc(x / y)
    fn rem(self, y: Self) -> Self;
    /// -x
    fn neg(self) -> Self;
    /// x y + z, fused or not.
    fn fma(self, y: Self, z: Self) -> Self {
        self.mul(y).add(z)
    }
    /// Sum of x\[i\] y\[i\]; squares where `same` says that both lists are one.
    fn dot(x: &[Self], y: &[Self], same: bool) -> Self;

    /// Whether x < y.
    fn less(self, y: Self) -> Truth;
    /// Whether x <= y.
    fn less_equal(self, y: Self) -> Truth;
    /// Whether x == y.
    fn equal(self, y: Self) -> Truth;
    /// Whether it is no number.
    fn is_nan(self) -> Truth;
    /// Whether it is infinite.
    fn is_inf(self) -> Truth;
    /// This one, where the other might as well have been chosen.
    #[must_use]
    fn or_else(self, other: Self) -> Self;
    /// This value of an operation whose accuracy WGSL leaves open.
    #[must_use]
    fn unspecified(self) -> Self;

    /// |x|
    fn abs(self) -> Self;
    /// The smaller.
    fn min(self, y: Self) -> Self;
    /// The larger.
    fn max(self, y: Self) -> Self;
    /// min(max(x, low), high)
    fn clamp(self, low: Self, high: Self) -> Self;
    /// -1, 0 or 1
    fn sign(self) -> Self;
    /// 1 where this edge <= x, else 0.
    fn step(self, x: Self) -> Self;
    /// The next integer below or at.
    fn floor(self) -> Self;
    /// The next integer above or at.
    fn ceil(self) -> Self;
    /// The nearest integer, the even one of two.
    fn round(self) -> Self;
    /// The next integer toward zero.
    fn trunc(self) -> Self;
    /// x - floor(x)
    fn fract(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// 1 / square root.
    fn inverse_sqrt(self) -> Self;
    /// e^x
    fn exp(self) -> Self;
    /// 2^x
    fn exp2(self) -> Self;
    /// Natural logarithm.
    fn log(self) -> Self;
    /// Logarithm to base 2.
    fn log2(self) -> Self;
    /// x^y
    fn pow(self, y: Self) -> Self;
    /// Sine.
    fn sin(self) -> Self;
    /// Cosine.
    fn cos(self) -> Self;
    /// Tangent.
    fn tan(self) -> Self;
    /// Arc sine.
    fn asin(self) -> Self;
    /// Arc cosine.
    fn acos(self) -> Self;
    /// Arc tangent.
    fn atan(self) -> Self;
    /// Angle of (x, this).
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Its inverse.
    fn asinh(self) -> Self;
    /// Its inverse.
    fn acosh(self) -> Self;
    /// Its inverse.
    fn atanh(self) -> Self;
    /// x 2^e
    fn ldexp(self, e: i32) -> Self;
    /// Fraction in \[0.5, 1) and exponent.
    fn frexp(self) -> (Self, Whole<i32>);
    /// As an f16 has it.
    fn quantize(self) -> Self;
    /// x (1 - z) + y z
    fn mix(self, y: Self, z: Self) -> Self;
    /// A value read from a normalised integer: within 3 ULP.
    fn unpacked(x: f32) -> Self;
    /// Runs a machine's code. It is compiled here for each type, optimised as this package is, whoever calls it.
    ///
    /// # Errors
    /// As for [`Machine::run`].
    #[doc(hidden)]
    fn execute(machine: &mut Machine<'_, Self>, start: u32) -> Result<(), EvaluateError>;
    /// Decodes a buffer, like [`Number::execute`].
    ///
    /// # Errors
    /// As for [`Machine::bind_buffer`].
    #[doc(hidden)]
    fn fill(machine: &mut Machine<'_, Self>, index: usize, bytes: &[u8]) -> Result<(), EvaluateError>;
    /// A texture's value that is made of these texels; the first is what a nearest or exactly weighted read gives.
    fn filtered(value: f64, low: f64, high: f64) -> Self;
}
