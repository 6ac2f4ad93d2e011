//! Numbers for people: three significant digits.

/// What stands where there is no value.
pub const MISSING: &str = "–";

/// `0`, `0.0123`, `12.3`, `12300`, `1.23e-7`, `∞`, `NaN`.
pub fn number(value: f64) -> String {
    if value.is_nan() {
        return "NaN".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "-∞" }.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    // Rounded first: 9.999 is 10.0, not 9.999 with the digits of 9.
    let rounded = format!("{value:.2e}");
    let exponent = rounded.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        Some(exponent @ -3..=2) => format!("{value:.*}", usize::try_from(2 - exponent).unwrap_or(0)),
        Some(3..=4) => format!("{:.0}", rounded.parse::<f64>().unwrap_or(value)),
        _ => rounded,
    }
}

/// The same, and an en dash where there is none.
pub fn optional(value: Option<f64>) -> String {
    value.map_or_else(|| MISSING.to_owned(), number)
}

/// The same with its sign, also above 0.
pub fn signed(value: f64) -> String {
    let text = number(value);
    if value > 0.0 { format!("+{text}") } else { text }
}

/// A count with its thing: `1 row`, `2 rows`.
pub fn count(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches digits too many or too few, also where rounding carries into a new digit, and values without digits.
    #[test]
    fn three_digits() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1.00"),
            (9.999, "10.0"),
            (0.099_96, "0.100"),
            (0.001_234_5, "0.00123"),
            (0.000_999_9, "0.00100"),
            (0.000_123_45, "1.23e-4"),
            (-12.345, "-12.3"),
            (999.9, "1000"),
            (12_345.0, "12300"),
            (99_999.0, "1.00e5"),
            (5e-324, "4.94e-324"),
            (f64::MAX, "1.80e308"),
            (f64::INFINITY, "∞"),
            (f64::NEG_INFINITY, "-∞"),
            (f64::NAN, "NaN"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text, "{value:e}");
        }
        assert_eq!(signed(0.5), "+0.500");
        assert_eq!(signed(-0.5), "-0.500");
        assert_eq!(signed(0.0), "0");
        assert_eq!(optional(None), "–");
        assert_eq!(count(1, "row") + ", " + &count(0, "fault"), "1 row, 0 faults");
    }
}
