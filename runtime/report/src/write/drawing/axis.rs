//! A logarithmic axis that also has places for what a logarithm has none: 0 and infinity.

/// Pixels beside the scale for zeros, and for infinities.
const STRIP: f64 = 26.0;
/// Least decades that a scale shows, so that values which hardly differ don't look far apart.
const LEAST: f64 = 0.6;
/// Most labels.
const MOST_LABELS: f64 = 7.0;

/// Where values are on a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Decimal logarithms at the ends of the scale.
    low: f64,
    high: f64,
    /// Pixels there.
    from: f64,
    to: f64,
    /// Middle of the strip of zeros, and of infinities.
    pub zero: Option<f64>,
    pub infinite: Option<f64>,
    /// No value is on the scale.
    is_empty: bool,
}

/// A place with a line of the grid, and a label where there is room.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    pub at: f64,
    pub label: Option<String>,
}

impl Axis {
    /// An axis from `from` to `to` pixels that shows all these values. What is negative or NaN has no place.
    pub fn new(values: impl IntoIterator<Item = f64>, from: f64, to: f64) -> Axis {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut zero, mut infinite) = (false, false);
        for value in values.into_iter().filter(|value| *value >= 0.0) {
            if value == 0.0 {
                zero = true;
            } else if value.is_infinite() {
                infinite = true;
            } else {
                low = low.min(value.log10());
                high = high.max(value.log10());
            }
        }
        let is_empty = low > high;
        if is_empty {
            (low, high) = (-0.5, 0.5);
        }
        let missing = (LEAST - (high - low)).max(0.0) / 2.0;
        let margin = missing + (high - low + missing) * 0.06;
        let step = STRIP.copysign(to - from);
        Axis {
            low: low - margin,
            high: high + margin,
            from: if zero { from + step } else { from },
            to: if infinite { to - step } else { to },
            zero: zero.then_some(from + step / 2.0),
            infinite: infinite.then_some(to - step / 2.0),
            is_empty,
        }
    }

    /// Pixels of a value; none where it has no place.
    pub fn place(&self, value: f64) -> Option<f64> {
        if value == 0.0 {
            self.zero
        } else if value == f64::INFINITY {
            self.infinite
        } else {
            (value > 0.0).then(|| self.place_of_log(value.log10()))
        }
    }

    fn place_of_log(&self, log: f64) -> f64 {
        self.from + (log - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// Where the strips are cut off from the scale.
    pub fn cuts(&self) -> impl Iterator<Item = f64> {
        let zero = self.zero.map(|_| self.from);
        zero.into_iter().chain(self.infinite.map(|_| self.to))
    }

    /// Lines of the grid on the scale, from the low end; none where no value is on it.
    pub fn ticks(&self) -> Vec<Tick> {
        if self.is_empty {
            return Vec::new();
        }
        let decades = self.high - self.low;
        // Between 1 and 2 decades 1, 2 and 5 have room; less are told apart by every digit.
        let labelled: &[u8] = match decades {
            less if less < 1.0 => &[1, 2, 3, 4, 5, 6, 8],
            less if less < 2.4 => &[1, 2, 5],
            _ => &[1],
        };
        let every = every(decades, MOST_LABELS);
        let mut ticks = Vec::new();
        // The logarithm of an f64 is within -324 and 309.
        for exponent in self.low.floor() as i32..=self.high.ceil() as i32 {
            for digit in 1..=9_u8 {
                let log = f64::from(exponent) + f64::from(digit).log10();
                if log < self.low || log > self.high || (digit > 1 && decades > 4.5) || (digit == 1 && exponent % every != 0) {
                    continue;
                }
                ticks.push(Tick {
                    at: self.place_of_log(log),
                    label: labelled.contains(&digit).then(|| label(digit, exponent)),
                });
            }
        }
        ticks
    }
}

/// A round number of decades between labels, of which there is room for `most`.
pub fn every(decades: f64, most: f64) -> i32 {
    let steps = [1, 2, 5, 10, 20, 50, 100];
    steps.into_iter().find(|step| f64::from(*step) * most >= decades).unwrap_or(200)
}

/// `0.02`, `300`, `2e-6`.
pub fn label(digit: u8, exponent: i32) -> String {
    match exponent {
        0..=4 => format!("{digit}{}", "0".repeat(exponent.unsigned_abs() as usize)),
        -3..0 => format!("0.{}{digit}", "0".repeat((exponent.unsigned_abs() - 1) as usize)),
        _ => format!("{digit}e{exponent}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches values outside the sheet, out of order, and the strips of zeros and infinities within the scale.
    #[test]
    fn every_value_has_its_place() {
        let values = [0.0, 5e-324, 1e-9, 1.0, 1e300, f64::INFINITY];
        let axis = Axis::new(values, 400.0, 100.0);
        let places: Vec<f64> = values.iter().filter_map(|value| axis.place(*value)).collect();
        assert_eq!(places.len(), values.len());
        assert!(places.iter().all(|place| (100.0..=400.0).contains(place)), "{places:?}");
        assert!(places.is_sorted_by(|a, b| a > b), "{places:?}");
        let cuts: Vec<f64> = axis.cuts().collect();
        assert!(
            places[0] > cuts[0] && cuts[0] > places[1] && places[4] > cuts[1] && cuts[1] > places[5],
            "{places:?} {cuts:?}"
        );
        assert_eq!(axis.place(f64::NAN), None);
        assert_eq!(axis.place(-1.0), None);
        assert_eq!(Axis::new([1.0], 0.0, 1.0).place(0.0), None);
    }

    /// Catches a scale without labels, with too many, or with wrong ones.
    #[test]
    fn ticks_are_round_and_few() {
        let labels = |values: &[f64]| -> Vec<String> {
            let ticks = Axis::new(values.iter().copied(), 0.0, 100.0).ticks();
            assert!(ticks.iter().is_sorted_by(|a, b| a.at < b.at));
            ticks.into_iter().filter_map(|tick| tick.label).collect()
        };
        assert_eq!(labels(&[100.0]), ["50", "60", "80", "100", "200"]);
        assert_eq!(labels(&[10.0, 300.0]), ["10", "20", "50", "100", "200"]);
        assert_eq!(labels(&[1e-4, 0.1]), ["1e-4", "0.001", "0.01", "0.1"]);
        assert_eq!(labels(&[5e-324, 1.7e308]), ["1e-200", "1", "1e200"]);
        assert_eq!(labels(&[0.0, f64::INFINITY]), Vec::<String>::new());
    }
}
