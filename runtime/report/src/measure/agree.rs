//! A device held against what WGSL allows: a second opinion on the driver, and on the evaluator.

use serde_json::Value as Json;
use shadewright_evaluate::Allowed;
use shadewright_runtime::probe::Evaluated;

use super::number;
use super::row::recipe_text;
use super::subject::Subject;
use crate::data::{Agreement, Worst};

/// Compares a device's results with the bounds of the same inputs.
pub(crate) fn agree(subject: &Subject, rows: &[Json], got: &[Vec<f64>], bounds: &Evaluated<Allowed>) -> Agreement {
    let names = subject.probe.components();
    let mut agreement = Agreement {
        module: format!("{}: {}", subject.experiment.name, subject.alternative.label),
        recipe: recipe_text(subject),
        function: subject.experiment.function.clone(),
        ..Agreement::default()
    };
    let mut most = -1.0;
    for (((row, got), allowed), undecided) in rows.iter().zip(got).zip(&bounds.values).zip(&bounds.undecided) {
        for (at, (got, allowed)) in got.iter().zip(allowed).enumerate() {
            agreement.results += 1;
            let value = f64::from(allowed.value());
            if got.to_bits() == value.to_bits() || got.is_nan() && value.is_nan() {
                agreement.equal += 1;
                continue;
            }
            if *undecided || !allowed.is_bounded() {
                agreement.undecided += 1;
                continue;
            }
            let is_inside = (allowed.low()..=allowed.high()).contains(got);
            let ulps = if is_inside { ulps(*got, value) } else { f64::INFINITY };
            if is_inside {
                agreement.ulps = agreement.ulps.max(ulps);
            } else {
                agreement.outside += 1;
            }
            if ulps > most {
                most = ulps;
                agreement.worst = Some(Worst {
                    input: subject.fitted(row),
                    component: names.get(at).cloned().unwrap_or_default(),
                    got: number(Some(got)),
                    expected: number(Some(&value)),
                });
            }
        }
    }
    agreement
}

/// Difference of two 32-bit numbers in units in the last place of the larger.
fn ulps(a: f64, b: f64) -> f64 {
    let larger = a.abs().max(b.abs()).max(f64::from(f32::MIN_POSITIVE));
    // Of a number in [2^e, 2^(e+1)) the last place is 2^(e-23).
    let unit = (larger.log2().floor() - 23.0).exp2();
    (a - b).abs() / unit
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a unit of the wrong binade.
    #[test]
    fn units_in_the_last_place() {
        let next = |x: f32| f64::from(f32::from_bits(x.to_bits() + 1));
        for x in [1.0_f32, 1.5, 0.1, 1e30, 3e-38] {
            assert_eq!(ulps(f64::from(x), next(x)), 1.0, "{x}");
        }
        assert_eq!(ulps(2.0, 2.0), 0.0);
    }
}
