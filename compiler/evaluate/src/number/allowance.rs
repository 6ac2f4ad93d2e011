//! Rounding outward and inward to f32, units in the last place, and intervals of real functions: what the accuracy table of the
//! WGSL specification (section Floating Point Accuracy) is written in.
//!
//! Intervals are pairs of f64. What f64 itself rounds, 2^-53, is covered by a slack of 2^-40, far below an f32's 2^-24.

/// Smallest normal f32.
pub(super) const TINY: f64 = f32::MIN_POSITIVE as f64;
/// Largest f32.
pub(super) const HUGE: f64 = f32::MAX as f64;

/// A closed interval.
pub(super) type Span = (f64, f64);

/// The largest f32 at or below.
#[allow(clippy::cast_possible_truncation)] // corrected where it went up
pub(super) fn down(x: f64) -> f64 {
    let near = x as f32;
    f64::from(if f64::from(near) > x { near.next_down() } else { near })
}

/// The smallest f32 at or above.
pub(super) fn up(x: f64) -> f64 {
    -down(-x)
}

/// Sum of two numbers, below and above what it is exactly (Knuth's two-sum finds the rounding's sign).
pub(super) fn sum(x: f64, y: f64) -> Span {
    let s = x + y;
    let other = s - x;
    let error = (x - (s - other)) + (y - other);
    if error < 0.0 {
        (s.next_down(), s)
    } else if error > 0.0 {
        (s, s.next_up())
    } else {
        (s, s)
    }
}

/// A unit in the last place of an f32 of this magnitude; where the next power of 2 is within 2^-20, of that one, so that
/// x - n ulp(x) and x + n ulp(x) bound what they bound for every number between x and its neighbours.
#[allow(clippy::cast_possible_truncation)] // the exponent of an f64 fits
pub(super) fn ulp(x: f64) -> f64 {
    let magnitude = (x.abs() * (1.0 + 1.0 / 1_048_576.0)).clamp(TINY, HUGE);
    let exponent = ((magnitude.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    libm::ldexp(1.0, exponent - 23)
}

/// The span of a rising function over an interval, widened at each end by the error there.
pub(super) fn rising(over: Span, function: impl Fn(f64) -> f64, error: impl Fn(f64, f64) -> f64) -> Span {
    let (low, high) = (function(over.0), function(over.1));
    (widen(low, -error(over.0, low)), widen(high, error(over.1, high)))
}

/// A bound moved by an error, and by the slack for what f64 rounds.
pub(super) fn widen(x: f64, error: f64) -> f64 {
    let slack = x.abs() * 9.1e-13;
    if error < 0.0 { x + error - slack } else { x + error + slack }
}

/// The span of what a function of two numbers has at the corners.
pub(super) fn corners(x: Span, y: Span, function: impl Fn(f64, f64) -> f64) -> Span {
    let all = [function(x.0, y.0), function(x.0, y.1), function(x.1, y.0), function(x.1, y.1)];
    all.iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}
