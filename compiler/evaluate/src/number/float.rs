//! f32 as a correctly rounding machine has it, and f64 as the same formula in double precision. The functions are libm's: the
//! same bits on every platform.

use half::f16;

use super::{Number, Truth, Whole};
use crate::error::EvaluateError;
use crate::machine::Machine;

/// Largest f32 that an i32 holds.
pub(super) const MOST_I32: f32 = 2_147_483_520.0;
/// Largest f32 that a u32 holds.
pub(super) const MOST_U32: f32 = 4_294_967_040.0;

macro_rules! number {
    ($float:ident, $name:literal, $($method:ident $function:ident,)*; $pow:ident $atan2:ident $ldexp:ident $frexp:ident) => {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, clippy::cast_lossless)] // WGSL's conversions
        impl Number for $float {
            const NAME: &'static str = $name;
            const SPREADS: bool = false;
            const ZERO: Self = 0.0;

            #[inline]
            fn from_f32(x: f32) -> Self {
                x as Self
            }
            #[inline]
            fn from_i32(x: i32) -> Self {
                x as Self
            }
            #[inline]
            fn from_u32(x: u32) -> Self {
                x as Self
            }
            #[inline]
            fn to_f32(self) -> f32 {
                self as f32
            }
            #[inline]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline]
            fn bounds(self) -> (f64, f64) {
                (self as f64, self as f64)
            }
            #[inline]
            fn to_i32(self) -> Whole<i32> {
                Whole { value: self.min(MOST_I32 as Self) as i32, sure: true }
            }
            #[inline]
            fn to_u32(self) -> Whole<u32> {
                Whole { value: self.min(MOST_U32 as Self) as u32, sure: true }
            }
            #[inline]
            fn bits(self) -> Whole<u32> {
                Whole { value: (self as f32).to_bits(), sure: true }
            }

            #[inline]
            fn packs_as(self, _pack: impl Fn(f32) -> u32, _bits: u32) -> bool {
                true
            }

            #[inline]
            fn add(self, y: Self) -> Self {
                self + y
            }
            #[inline]
            fn sub(self, y: Self) -> Self {
                self - y
            }
            #[inline]
            fn mul(self, y: Self) -> Self {
                self * y
            }
            #[inline]
            fn square(self) -> Self {
                self * self
            }
            #[inline]
            fn div(self, y: Self) -> Self {
                self / y
            }
            #[inline]
            fn rem(self, y: Self) -> Self {
                self - y * (self / y).trunc()
            }
            #[inline]
            fn neg(self) -> Self {
                -self
            }
            #[inline]
            fn dot(x: &[Self], y: &[Self], _same: bool) -> Self {
                let mut products = x.iter().zip(y).map(|(x, y)| x * y);
                let first = products.next().unwrap_or(0.0);
                products.fold(first, |sum, product| sum + product)
            }

            #[inline]
            fn less(self, y: Self) -> Truth {
                Truth::sure(self < y)
            }
            #[inline]
            fn less_equal(self, y: Self) -> Truth {
                Truth::sure(self <= y)
            }
            #[inline]
            #[allow(clippy::float_cmp)] // that is what the shader asks
            fn equal(self, y: Self) -> Truth {
                Truth::sure(self == y)
            }
            #[inline]
            fn is_nan(self) -> Truth {
                Truth::sure(<$float>::is_nan(self))
            }
            #[inline]
            fn is_inf(self) -> Truth {
                Truth::sure(self.is_infinite())
            }
            #[inline]
            fn or_else(self, _other: Self) -> Self {
                self
            }
            #[inline]
            fn unspecified(self) -> Self {
                self
            }

            #[inline]
            fn abs(self) -> Self {
                <$float>::abs(self)
            }
            #[inline]
            fn min(self, y: Self) -> Self {
                if y < self || <$float>::is_nan(self) { y } else { self }
            }
            #[inline]
            fn max(self, y: Self) -> Self {
                if self < y || <$float>::is_nan(self) { y } else { self }
            }
            #[inline]
            fn clamp(self, low: Self, high: Self) -> Self {
                Number::min(Number::max(self, low), high)
            }
            #[inline]
            fn sign(self) -> Self {
                if self > 0.0 {
                    1.0
                } else if self < 0.0 {
                    -1.0
                } else {
                    0.0
                }
            }
            #[inline]
            fn step(self, x: Self) -> Self {
                if self <= x { 1.0 } else { 0.0 }
            }
            #[inline]
            fn floor(self) -> Self {
                <$float>::floor(self)
            }
            #[inline]
            fn ceil(self) -> Self {
                <$float>::ceil(self)
            }
            #[inline]
            fn round(self) -> Self {
                self.round_ties_even()
            }
            #[inline]
            fn trunc(self) -> Self {
                <$float>::trunc(self)
            }
            #[inline]
            fn fract(self) -> Self {
                self - <$float>::floor(self)
            }
            #[inline]
            fn sqrt(self) -> Self {
                <$float>::sqrt(self)
            }
            #[inline]
            fn inverse_sqrt(self) -> Self {
                1.0 / <$float>::sqrt(self)
            }
            $(
                #[inline]
                fn $method(self) -> Self {
                    libm::$function(self)
                }
            )*
            #[inline]
            fn pow(self, y: Self) -> Self {
                libm::$pow(self, y)
            }
            #[inline]
            fn atan2(self, x: Self) -> Self {
                libm::$atan2(self, x)
            }
            #[inline]
            fn ldexp(self, e: i32) -> Self {
                libm::$ldexp(self, e)
            }
            fn frexp(self) -> (Self, Whole<i32>) {
                if self == 0.0 || !self.is_finite() {
                    return (self, Whole { value: 0, sure: true });
                }
                let (fraction, value) = libm::$frexp(self);
                (fraction, Whole { value, sure: true })
            }
            fn quantize(self) -> Self {
                f16::from_f32(self as f32).to_f32() as Self
            }
            #[inline]
            fn mix(self, y: Self, z: Self) -> Self {
                self * (1.0 - z) + y * z
            }
            #[inline]
            fn unpacked(x: f32) -> Self {
                x as Self
            }
            fn execute(machine: &mut Machine<'_, Self>, start: u32) -> Result<(), EvaluateError> {
                machine.execute(start)
            }
            fn fill(machine: &mut Machine<'_, Self>, index: usize, bytes: &[u8]) -> Result<(), EvaluateError> {
                machine.fill(index, bytes)
            }
            #[inline]
            fn filtered(value: f64, _low: f64, _high: f64) -> Self {
                value as Self
            }
        }
    };
}

number!(f32, "f32", exp expf, exp2 exp2f, log logf, log2 log2f, sin sinf, cos cosf, tan tanf, asin asinf, acos acosf, atan atanf,
    sinh sinhf, cosh coshf, tanh tanhf, asinh asinhf, acosh acoshf, atanh atanhf,; powf atan2f ldexpf frexpf);
number!(f64, "f64", exp exp, exp2 exp2, log log, log2 log2, sin sin, cos cos, tan tan, asin asin, acos acos, atan atan,
    sinh sinh, cosh cosh, tanh tanh, asinh asinh, acosh acosh, atanh atanh,; pow atan2 ldexp frexp);
