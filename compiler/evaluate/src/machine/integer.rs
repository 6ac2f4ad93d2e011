//! Integers: WGSL's rules where machines differ, on the bits of both kinds.

use naga::BinaryOperator as B;

/// The smaller.
pub(super) fn min(is_signed: bool, x: u32, y: u32) -> u32 {
    if less(is_signed, y, x) { y } else { x }
}

/// The larger.
pub(super) fn max(is_signed: bool, x: u32, y: u32) -> u32 {
    if less(is_signed, x, y) { y } else { x }
}

fn less(is_signed: bool, x: u32, y: u32) -> bool {
    if is_signed { x.cast_signed() < y.cast_signed() } else { x < y }
}

/// A comparison; none of an operator that is none.
pub(super) fn compare(op: B, is_signed: bool, x: u32, y: u32) -> Option<bool> {
    Some(match op {
        B::Equal => x == y,
        B::NotEqual => x != y,
        B::Less => less(is_signed, x, y),
        B::LessEqual => !less(is_signed, y, x),
        B::Greater => less(is_signed, y, x),
        B::GreaterEqual => !less(is_signed, x, y),
        _ => return None,
    })
}

/// Arithmetic that wraps. x / 0 is x and x % 0 is 0, as of the smallest number and -1; shifts take the low five bits of the distance.
pub(super) fn binary(op: B, is_signed: bool, x: u32, y: u32) -> u32 {
    let (a, b) = (x.cast_signed(), y.cast_signed());
    match op {
        B::Add => x.wrapping_add(y),
        B::Subtract => x.wrapping_sub(y),
        B::Multiply => x.wrapping_mul(y),
        B::Divide if is_signed => a.checked_div(b).unwrap_or(a).cast_unsigned(),
        B::Divide => x.checked_div(y).unwrap_or(x),
        B::Modulo if is_signed => a.checked_rem(b).unwrap_or(0).cast_unsigned(),
        B::Modulo => x.checked_rem(y).unwrap_or(0),
        B::And => x & y,
        B::ExclusiveOr => x ^ y,
        B::InclusiveOr => x | y,
        B::ShiftLeft => x.wrapping_shl(y),
        B::ShiftRight if is_signed => a.wrapping_shr(y).cast_unsigned(),
        B::ShiftRight => x.wrapping_shr(y),
        // Comparisons and logic are elsewhere.
        _ => x,
    }
}

/// Bits [offset, offset + count), of a signed number with its sign.
pub(super) fn extract(is_signed: bool, x: u32, offset: u32, count: u32) -> u32 {
    let offset = offset.min(32);
    let count = count.min(32 - offset);
    if count == 0 {
        return 0;
    }
    let high = x << (32 - offset - count);
    if is_signed {
        (high.cast_signed() >> (32 - count)).cast_unsigned()
    } else {
        high >> (32 - count)
    }
}

/// x with the low bits of y in [offset, offset + count).
pub(super) fn insert(x: u32, y: u32, offset: u32, count: u32) -> u32 {
    let offset = offset.min(32);
    let count = count.min(32 - offset);
    if count == 0 {
        return x;
    }
    let mask = (u32::MAX >> (32 - count)) << offset;
    x & !mask | (y << offset) & mask
}

/// The highest bit that is set, of a negative number that is not; all ones where there is none.
pub(super) fn first_leading(is_signed: bool, x: u32) -> u32 {
    let x = if is_signed && x.cast_signed() < 0 { !x } else { x };
    if x == 0 { u32::MAX } else { 31 - x.leading_zeros() }
}

/// The lowest bit that is set; all ones where there is none.
pub(super) fn first_trailing(x: u32) -> u32 {
    if x == 0 { u32::MAX } else { x.trailing_zeros() }
}
