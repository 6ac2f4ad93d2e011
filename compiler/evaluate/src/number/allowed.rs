//! An f32 with all that a conforming driver may have in its place.

use super::allowance::{HUGE, Span, TINY, corners, down, rising, ulp, up, widen};
use super::{Number, Whole};

/// Absolute error of logarithms in [0.5, 2]: 2^-21.
const LOG_ERROR: f64 = 1.0 / 2_097_152.0;

/// The f32 that the evaluator computes, and an interval that holds every result a conforming WGSL implementation may give by the
/// accuracy table of the WGSL specification, without reassociation. `spec/evaluator.md` has the table as it is applied here.
///
/// The interval has no end on either side where the specification allows anything: NaN, infinities, indeterminate values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowed {
    pub(super) value: f32,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Allowed {
    /// What the evaluator computes.
    pub fn value(self) -> f32 {
        self.value
    }

    /// Lowest result; minus infinity where anything goes.
    pub fn low(self) -> f64 {
        self.low
    }

    /// Highest result; infinity where anything goes.
    pub fn high(self) -> f64 {
        self.high
    }

    /// Whether the specification bounds the result at all.
    pub fn is_bounded(self) -> bool {
        self.low > f64::NEG_INFINITY
    }

    /// Whether a driver may have this result.
    pub fn allows(self, x: f32) -> bool {
        !self.is_bounded() || (self.low..=self.high).contains(&f64::from(x))
    }

    /// Anything goes.
    pub(super) fn any(value: f32) -> Self {
        Self {
            value,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        }
    }

    pub(super) fn span(self) -> Span {
        (self.low, self.high)
    }

    /// Whether it is one value on every driver.
    pub(super) fn is_point(self) -> bool {
        self.low == self.high
    }

    pub(super) fn has(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// The part of it that is subnormal, with the zero that it may be flushed to; none of what is zero only.
    pub(super) fn subnormals(self) -> Option<Span> {
        let (low, high) = (self.low.max(-TINY), self.high.min(TINY));
        (low <= high && (low, high) != (0.0, 0.0)).then_some((low, high))
    }

    /// Bounds that are f32 already: overflow leaves everything open, and what is subnormal may be flushed to zero.
    pub(super) fn of(value: f32, (mut low, mut high): Span) -> Self {
        if !(-HUGE <= low && low <= high && high <= HUGE) {
            return Self::any(value);
        }
        if 0.0 < low && low < TINY {
            low = 0.0;
        }
        if -TINY < high && high < 0.0 {
            high = 0.0;
        }
        Self { value, low, high }
    }

    /// Correctly rounded, up or down.
    pub(super) fn rounded(value: f32, (low, high): Span) -> Self {
        Self::of(value, (down(low), up(high)))
    }

    /// An f32 between these bounds, which are wider than a unit in the last place.
    pub(super) fn within(value: f32, (low, high): Span) -> Self {
        // Rounding inward would hide an overflow.
        if !(-HUGE <= low && high <= HUGE) {
            return Self::any(value);
        }
        let inner = (up(low), down(high));
        if inner.0 > inner.1 {
            return Self::rounded(value, (low, high));
        }
        Self::of(value, inner)
    }

    /// Bounds from a composition, the value from the function itself.
    pub(super) fn composed(value: f32, bounds: Self) -> Self {
        if !bounds.is_bounded() || !value.is_finite() {
            return Self::any(value);
        }
        let x = f64::from(value);
        Self::of(value, (bounds.low.min(x), bounds.high.max(x)))
    }

    /// A function that rises with x, with its error in units in the last place.
    pub(super) fn rises(self, value: f32, function: impl Fn(f64) -> f64, ulps: impl Fn(f64) -> f64) -> Self {
        let error = |x: f64| ulps(x) * ulp(function(x));
        // Of e^x far below 0 the error grows with |x|, and e^x does not shrink any more: the upper end has the larger of both.
        let (low, high) = (error(self.low), error(self.low).max(error(self.high)));
        Self::within(value, (widen(function(self.low), -low), widen(function(self.high), high)))
    }

    /// A whole number that the bounds agree on, or not.
    pub(super) fn whole<T: PartialEq>(self, value: T, convert: impl Fn(f64) -> T) -> Whole<T> {
        let sure = self.is_bounded() && convert(self.low) == value && convert(self.high) == value;
        Whole { value, sure }
    }

    pub(super) fn logarithm(self, value: f32, function: impl Fn(f64) -> f64) -> Self {
        if !self.is_bounded() || self.low <= 0.0 {
            return Self::any(value);
        }
        // Absolute in [0.5, 2], where units in the last place shrink toward 0. Where the interval crosses an end of that, both.
        let inside = self.low <= 2.0 && self.high >= 0.5;
        let error = |x: f64, y: f64| {
            let ulps = if (0.5..=2.0).contains(&x) { 0.0 } else { 3.0 * ulp(y) };
            if inside { LOG_ERROR.max(ulps) } else { ulps }
        };
        Self::within(value, rising(self.span(), function, error))
    }

    /// Sine and cosine: within 2^-11 in [-pi, pi] (the f32 nearest to pi, a little more, counts as inside).
    pub(super) fn wave(self, value: f32, function: impl Fn(f64) -> f64, peaks: &[(f64, f64)]) -> Self {
        let pi = f64::from(std::f32::consts::PI);
        if !self.is_bounded() || self.low < -pi || self.high > pi {
            return Self::any(value);
        }
        let (mut low, mut high) = corners(self.span(), self.span(), |x, _| function(x));
        for &(at, peak) in peaks {
            if self.has(at) {
                (low, high) = (low.min(peak), high.max(peak));
            }
        }
        Self::within(value, (widen(low, -1.0 / 2048.0), widen(high, 1.0 / 2048.0)))
    }

    /// The worse of an absolute error around a rising or falling function, and a composition.
    pub(super) fn or_absolute(self, value: f32, function: impl Fn(f64) -> f64, error: f64, bounds: Self) -> Self {
        let (low, high) = corners(self.span(), self.span(), |x, _| function(x));
        let absolute = Self::within(value, (widen(low, -error), widen(high, error)));
        Self::composed(value, absolute.or_else(bounds))
    }
}
