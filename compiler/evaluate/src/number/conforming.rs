//! WGSL's operations on [`Allowed`]: the value as f32 has it, the interval as the accuracy table allows.

use half::f16;

use super::allowance::{Span, TINY, corners, down, sum, ulp, up, widen};
use super::allowed::Allowed;
use super::float::{MOST_I32, MOST_U32};
use super::{Number, Truth, Whole};
use crate::error::EvaluateError;
use crate::machine::Machine;

/// Where a cosine or sine has its peaks in [-pi, pi].
const SINE: [(f64, f64); 2] = [(-std::f64::consts::FRAC_PI_2, -1.0), (std::f64::consts::FRAC_PI_2, 1.0)];
const COSINE: [(f64, f64); 1] = [(0.0, 1.0)];
/// Units in the last place of `atan` and `atan2`.
const ATAN_ULPS: f64 = 4096.0;

/// Where both operands are bounded, what `bounds` makes of them, else anything.
#[inline]
fn both(value: f32, x: Allowed, y: Allowed, bounds: impl FnOnce(Span, Span) -> Allowed) -> Allowed {
    if x.is_bounded() && y.is_bounded() {
        bounds(x.span(), y.span())
    } else {
        Allowed::any(value)
    }
}

/// Where the operand is bounded, an exact function that never falls.
#[inline]
fn exact(value: f32, x: Allowed, function: impl Fn(f64) -> f64) -> Allowed {
    if x.is_bounded() {
        Allowed::of(value, (function(x.low), function(x.high)))
    } else {
        Allowed::any(value)
    }
}

/// An f16 and its neighbours, as f64.
fn half_down(x: f64) -> f64 {
    let near = f16::from_f64(x);
    if near.to_f64() <= x {
        return near.to_f64();
    }
    // One step toward minus infinity in sign and magnitude.
    let bits = near.to_bits();
    let below = if bits & 0x7fff == 0 {
        0x8001
    } else if bits & 0x8000 == 0 {
        bits - 1
    } else {
        bits + 1
    };
    f16::from_bits(below).to_f64()
}

impl Number for Allowed {
    const NAME: &'static str = "allowed";
    const SPREADS: bool = true;
    const ZERO: Self = Self {
        value: 0.0,
        low: 0.0,
        high: 0.0,
    };

    fn from_f32(x: f32) -> Self {
        let wide = f64::from(x);
        Self::of(x, (wide, wide))
    }
    fn from_i32(x: i32) -> Self {
        Self::rounded(f32::from_i32(x), (f64::from(x), f64::from(x)))
    }
    fn from_u32(x: u32) -> Self {
        Self::rounded(f32::from_u32(x), (f64::from(x), f64::from(x)))
    }
    fn to_f32(self) -> f32 {
        self.value
    }
    fn to_f64(self) -> f64 {
        f64::from(self.value)
    }
    fn bounds(self) -> (f64, f64) {
        self.span()
    }
    #[allow(clippy::cast_possible_truncation)] // saturates
    fn to_i32(self) -> Whole<i32> {
        self.whole(self.value.to_i32().value, |x| x.min(f64::from(MOST_I32)) as i32)
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    fn to_u32(self) -> Whole<u32> {
        self.whole(self.value.to_u32().value, |x| x.min(f64::from(MOST_U32)) as u32)
    }
    #[allow(clippy::cast_possible_truncation)] // f32 already
    fn bits(self) -> Whole<u32> {
        Whole {
            value: self.value.to_bits(),
            // A zero's sign may be any.
            sure: self.is_point() && self.low != 0.0,
        }
    }

    #[allow(clippy::cast_possible_truncation)] // the bounds are f32
    fn packs_as(self, pack: impl Fn(f32) -> u32, bits: u32) -> bool {
        // The intermediate value is rounded either way, which matters where it ends in a half: a neighbour decides then.
        let ends = [(self.low as f32).next_down(), (self.high as f32).next_up()];
        self.is_bounded() && ends.iter().all(|x| pack(*x) == bits)
    }

    #[inline]
    fn add(self, y: Self) -> Self {
        both(self.value + y.value, self, y, |a, b| {
            Self::rounded(self.value + y.value, (sum(a.0, b.0).0, sum(a.1, b.1).1))
        })
    }
    #[inline]
    fn sub(self, y: Self) -> Self {
        self.add(y.neg())
    }
    #[inline]
    fn mul(self, y: Self) -> Self {
        // Products of two f32 are exact in f64.
        both(self.value * y.value, self, y, |a, b| {
            Self::rounded(self.value * y.value, corners(a, b, |a, b| a * b))
        })
    }
    #[inline]
    fn square(self) -> Self {
        let mut result = self.abs().mul(self.abs());
        result.value = self.value * self.value;
        result
    }
    fn div(self, y: Self) -> Self {
        let value = self.value / y.value;
        let size = y.abs();
        // 2^-126 is the smallest normal f32; the accuracy is open where |y| is beyond 2^126.
        if !self.is_bounded() || !y.is_bounded() || size.low < TINY || size.high > 8.507_059_173_023_462e37 {
            return Self::any(value);
        }
        let (low, high) = corners(self.span(), y.span(), |a, b| a / b);
        // 2.5 ULP take nothing across zero, and leave a zero alone.
        let floor = if low >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
        let ceiling = if high <= 0.0 { 0.0 } else { f64::INFINITY };
        let bounds = (widen(low, -2.5 * ulp(low)).max(floor), widen(high, 2.5 * ulp(high)).min(ceiling));
        Self::within(value, bounds)
    }
    fn rem(self, y: Self) -> Self {
        Self::composed(self.value.rem(y.value), self.sub(y.mul(self.div(y).trunc())))
    }
    #[inline]
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            low: -self.high,
            high: -self.low,
        }
    }
    fn dot(x: &[Self], y: &[Self], same: bool) -> Self {
        let (mut low, mut high, mut size, mut value) = (0.0, 0.0, 0.0, 0.0);
        for (i, (a, b)) in x.iter().zip(y).enumerate() {
            let product = if same { a.square() } else { a.mul(*b) };
            value = if i == 0 { product.value } else { value + product.value };
            if !product.is_bounded() {
                low = f64::NEG_INFINITY;
                high = f64::INFINITY;
            }
            low += product.low;
            high += product.high;
            size += product.abs().high;
        }
        if !(low.is_finite() && high.is_finite()) {
            return Self::any(value);
        }
        // In whatever order: no sum on the way is larger than the sum of all magnitudes, and every addition after the first
        // rounds by a unit in the last place of that at most. The last one rounds what comes out.
        let additions = x.len().saturating_sub(2);
        #[allow(clippy::cast_precision_loss)] // four at most
        let error = additions as f64 * ulp(size);
        let floor = if same { 0.0 } else { f64::NEG_INFINITY };
        Self::rounded(value, (widen(low, -error).max(floor), widen(high, error)))
    }

    #[inline]
    fn less(self, y: Self) -> Truth {
        Truth {
            value: self.value < y.value,
            sure: self.is_bounded() && y.is_bounded() && (self.high < y.low || self.low >= y.high),
        }
    }
    #[inline]
    fn less_equal(self, y: Self) -> Truth {
        Truth {
            value: self.value <= y.value,
            sure: self.is_bounded() && y.is_bounded() && (self.high <= y.low || self.low > y.high),
        }
    }
    #[allow(clippy::float_cmp)] // that is what the shader asks
    fn equal(self, y: Self) -> Truth {
        let apart = self.high < y.low || y.high < self.low;
        let one = self.is_point() && y.is_point() && self.low == y.low;
        Truth {
            value: self.value == y.value,
            sure: self.is_bounded() && y.is_bounded() && (apart || one),
        }
    }
    fn is_nan(self) -> Truth {
        Truth {
            value: self.value.is_nan(),
            sure: self.is_bounded(),
        }
    }
    fn is_inf(self) -> Truth {
        Truth {
            value: self.value.is_infinite(),
            sure: self.is_bounded(),
        }
    }
    fn or_else(self, other: Self) -> Self {
        both(self.value, self, other, |a, b| Self {
            value: self.value,
            low: a.0.min(b.0),
            high: a.1.max(b.1),
        })
    }
    fn unspecified(self) -> Self {
        Self::any(self.value)
    }

    #[inline]
    fn abs(self) -> Self {
        let value = self.value.abs();
        if !self.is_bounded() {
            return Self::any(value);
        }
        let span = if self.low >= 0.0 {
            self.span()
        } else if self.high <= 0.0 {
            (-self.high, -self.low)
        } else {
            (0.0, self.high.max(-self.low))
        };
        Self::of(value, span)
    }
    fn min(self, y: Self) -> Self {
        let value = Number::min(self.value, y.value);
        both(value, self, y, |a, b| {
            // Of two subnormals it may be either.
            let mut span = (a.0.min(b.0), a.1.min(b.1));
            if let (Some(x), Some(y)) = (self.subnormals(), y.subnormals()) {
                span = (span.0.min(x.0).min(y.0), span.1.max(x.1).max(y.1));
            }
            Self::of(value, span)
        })
    }
    fn max(self, y: Self) -> Self {
        let mut result = self.neg().min(y.neg()).neg();
        result.value = Number::max(self.value, y.value);
        result
    }
    fn clamp(self, low: Self, high: Self) -> Self {
        let result = self.max(low).min(high);
        if low.less_equal(high).sure && low.value <= high.value {
            return result;
        }
        // The median of three is as good, and differs where low > high.
        result.or_else(self).or_else(low).or_else(high)
    }
    fn sign(self) -> Self {
        exact(Number::sign(self.value), self, Number::sign)
    }
    fn step(self, x: Self) -> Self {
        let truth = self.less_equal(x);
        let (one, zero) = (Self::from_f32(1.0), Self::ZERO);
        let (chosen, other) = if truth.value { (one, zero) } else { (zero, one) };
        if truth.sure {
            chosen
        } else {
            both(chosen.value, self, x, |_, _| chosen.or_else(other))
        }
    }
    fn floor(self) -> Self {
        exact(Number::floor(self.value), self, Number::floor)
    }
    fn ceil(self) -> Self {
        exact(Number::ceil(self.value), self, Number::ceil)
    }
    fn round(self) -> Self {
        exact(Number::round(self.value), self, Number::round)
    }
    fn trunc(self) -> Self {
        exact(Number::trunc(self.value), self, Number::trunc)
    }
    fn fract(self) -> Self {
        let value = Number::fract(self.value);
        if !self.is_bounded() {
            return Self::any(value);
        }
        let (low, high) = (self.low.floor(), self.high.floor());
        let span = if low == high {
            (self.low - low, self.high - high)
        } else {
            (0.0, 1.0)
        };
        Self::rounded(value, span)
    }
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        if !self.is_bounded() || self.low < 0.0 {
            return Self::any(value);
        }
        // 1 / inverseSqrt(x), so 2 ULP and then 2.5. That formula has no root of 0, but every driver has.
        let root = |x: f64, sign: f64| {
            if x == 0.0 {
                return 0.0;
            }
            let inverse = 1.0 / x.sqrt();
            let root = 1.0 / widen(inverse, -sign * 2.0 * ulp(inverse));
            widen(root, sign * 2.5 * ulp(root))
        };
        Self::within(value, (root(self.low, -1.0), root(self.high, 1.0)))
    }
    fn inverse_sqrt(self) -> Self {
        let value = Number::inverse_sqrt(self.value);
        if !self.is_bounded() || self.low <= 0.0 {
            return Self::any(value);
        }
        let at = |x: f64| 1.0 / x.sqrt();
        let (low, high) = (at(self.high), at(self.low));
        Self::within(value, (widen(low, -2.0 * ulp(low)), widen(high, 2.0 * ulp(high))))
    }
    fn exp(self) -> Self {
        let value = Number::exp(self.value);
        if !self.is_bounded() {
            return Self::any(value);
        }
        self.rises(value, libm::exp, |x| 3.0 + 2.0 * x.abs()).at_least(0.0)
    }
    fn exp2(self) -> Self {
        let value = Number::exp2(self.value);
        if !self.is_bounded() {
            return Self::any(value);
        }
        self.rises(value, libm::exp2, |x| 3.0 + 2.0 * x.abs()).at_least(0.0)
    }
    fn log(self) -> Self {
        self.logarithm(Number::log(self.value), libm::log)
    }
    fn log2(self) -> Self {
        self.logarithm(Number::log2(self.value), libm::log2)
    }
    fn pow(self, y: Self) -> Self {
        Self::composed(self.value.pow(y.value), y.mul(self.log2()).exp2())
    }
    fn sin(self) -> Self {
        self.wave(Number::sin(self.value), libm::sin, &SINE)
    }
    fn cos(self) -> Self {
        self.wave(Number::cos(self.value), libm::cos, &COSINE)
    }
    fn tan(self) -> Self {
        Self::composed(Number::tan(self.value), self.sin().div(self.cos()))
    }
    fn asin(self) -> Self {
        let value = Number::asin(self.value);
        if !self.is_bounded() || self.low < -1.0 || self.high > 1.0 {
            return Self::any(value);
        }
        let inherited = self.atan2(Self::from_f32(1.0).sub(self.square()).sqrt());
        self.or_absolute(value, libm::asin, 6.81e-5, inherited)
    }
    fn acos(self) -> Self {
        let value = Number::acos(self.value);
        if !self.is_bounded() || self.low < -1.0 || self.high > 1.0 {
            return Self::any(value);
        }
        let inherited = Self::from_f32(1.0).sub(self.square()).sqrt().atan2(self);
        self.or_absolute(value, libm::acos, 6.77e-5, inherited)
    }
    fn atan(self) -> Self {
        let value = Number::atan(self.value);
        if !self.is_bounded() {
            return Self::any(value);
        }
        self.rises(value, libm::atan, |_| ATAN_ULPS)
    }
    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        let (tall, wide) = (Number::abs(self), Number::abs(x));
        if !self.is_bounded() || !x.is_bounded() || tall.low < TINY || wide.low < TINY || wide.high > 8.507_059_173_023_462e37 {
            return Self::any(value);
        }
        // In one quadrant it rises or falls with either.
        let (low, high) = corners(self.span(), x.span(), libm::atan2);
        Self::within(value, (widen(low, -ATAN_ULPS * ulp(low)), widen(high, ATAN_ULPS * ulp(high))))
    }
    fn sinh(self) -> Self {
        let bounds = self.exp().sub(self.neg().exp()).mul(Self::from_f32(0.5));
        Self::composed(Number::sinh(self.value), bounds)
    }
    fn cosh(self) -> Self {
        let bounds = self.exp().add(self.neg().exp()).mul(Self::from_f32(0.5));
        Self::composed(Number::cosh(self.value), bounds)
    }
    fn tanh(self) -> Self {
        let value = Number::tanh(self.value);
        if !self.is_bounded() {
            return Self::any(value);
        }
        self.or_absolute(value, libm::tanh, 1e-5, self.sinh().div(self.cosh()))
    }
    fn asinh(self) -> Self {
        let bounds = self.add(self.square().add(Self::from_f32(1.0)).sqrt()).log();
        Self::composed(Number::asinh(self.value), bounds)
    }
    fn acosh(self) -> Self {
        let bounds = self.add(self.square().sub(Self::from_f32(1.0)).sqrt()).log();
        Self::composed(Number::acosh(self.value), bounds)
    }
    fn atanh(self) -> Self {
        let one = Self::from_f32(1.0);
        let bounds = one.add(self).div(one.sub(self)).log().mul(Self::from_f32(0.5));
        Self::composed(Number::atanh(self.value), bounds)
    }
    fn ldexp(self, e: i32) -> Self {
        let value = self.value.ldexp(e);
        if !self.is_bounded() || e > 128 {
            return Self::any(value);
        }
        // Beyond this everything is 0, and f64 still has it.
        let e64 = e.max(-600);
        let result = Self::rounded(value, (libm::ldexp(self.low, e64), libm::ldexp(self.high, e64)));
        if e <= -127 {
            result.or_else(Self { value, ..Self::ZERO })
        } else {
            result
        }
    }
    fn frexp(self) -> (Self, Whole<i32>) {
        let (fraction, exponent) = self.value.frexp();
        let ends = (libm::frexp(self.low), libm::frexp(self.high));
        // Correctly rounded where x is zero or normal.
        let normal = self.is_bounded() && (Number::abs(self).low >= TINY || self.is_point());
        if normal && ends.0.1 == exponent.value && ends.1.1 == exponent.value {
            return (Self::rounded(fraction, (ends.0.0, ends.1.0)), exponent);
        }
        let exponent = Whole {
            value: exponent.value,
            sure: false,
        };
        (Self::any(fraction), exponent)
    }
    fn quantize(self) -> Self {
        let value = self.value.quantize();
        if !self.is_bounded() || self.low < -65504.0 || self.high > 65504.0 {
            return Self::any(value);
        }
        let (low, high) = (half_down(self.low), -half_down(-self.high));
        // Subnormals of f16 may be flushed.
        let tiny = 6.103_515_625e-5;
        let low = if 0.0 < low && low < tiny { 0.0 } else { low };
        let high = if -tiny < high && high < 0.0 { 0.0 } else { high };
        Self::of(value, (low, high))
    }
    fn mix(self, y: Self, z: Self) -> Self {
        self.mul(Self::from_f32(1.0).sub(z)).add(y.mul(z))
    }
    fn unpacked(x: f32) -> Self {
        let wide = f64::from(x);
        if wide == 0.0 {
            return Self::from_f32(x);
        }
        Self::within(x, (widen(wide, -3.0 * ulp(wide)), widen(wide, 3.0 * ulp(wide))))
    }
    fn execute(machine: &mut Machine<'_, Self>, start: u32) -> Result<(), EvaluateError> {
        machine.execute(start)
    }
    fn fill(machine: &mut Machine<'_, Self>, index: usize, bytes: &[u8]) -> Result<(), EvaluateError> {
        machine.fill(index, bytes)
    }
    #[allow(clippy::cast_possible_truncation)] // a texel is an f32
    fn filtered(value: f64, low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::any(value as f32);
        }
        Self::of(value as f32, (down(low.min(value)), up(high.max(value))))
    }
}

impl Allowed {
    /// No lower than this.
    fn at_least(self, floor: f64) -> Self {
        if self.is_bounded() && self.low < floor {
            Self { low: floor, ..self }
        } else {
            self
        }
    }
}
