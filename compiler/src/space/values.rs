//! The values that a frozen parameter of a space may have.

use crate::diagnostics::{Diagnostic, Report, codes};
use crate::limits::LIST_LENGTH;
use crate::manifest::{Param, ParamType, Typed, Value, typed};
use crate::resolve::Place;

use super::format::{Scale, ValueRange, Values};

/// The values with their constants.
///
/// # Errors
/// There are none or too many, or one does not fit the parameter.
pub fn values(name: &str, param: &Param, said: &Values, place: &Place) -> Result<Vec<(Value, Typed)>, Report> {
    let fitting = |value: Value, at: &Place| {
        let found = typed(param, &value).map_err(|error| Report::from(error.diagnostic(name, &at.file, at.span())))?;
        Ok((value, found))
    };
    match said {
        Values::One(value) => Ok(vec![fitting(value.clone(), place)?]),
        Values::Many(values) => {
            let at = place.keys(&["values"]);
            if values.is_empty() {
                return Err(wrong(name, &at, "none is here", "name at least one value"));
            }
            let element = |(index, value): (usize, &Value)| fitting(value.clone(), &at.then(crate::resolve::Way::Index(index)));
            values.iter().enumerate().map(element).collect()
        }
        Values::Range(range) => {
            let whole = matches!(param.ty, ParamType::U32 | ParamType::I32);
            let mut found: Vec<(Value, Typed)> = Vec::new();
            for number in numbers(name, range, place)? {
                let number = if whole { number.round() } else { number };
                let next = fitting(Value::Number(number), place)?;
                // Whole numbers that several steps are rounded to count once.
                if found.last().is_none_or(|(_, last)| *last != next.1) {
                    found.push(next);
                }
            }
            Ok(found)
        }
    }
}

fn numbers(name: &str, range: &ValueRange, place: &Place) -> Result<Vec<f64>, Report> {
    let &ValueRange {
        from,
        to,
        step,
        steps,
        scale,
    } = range;
    let refuse = |label: &str| {
        Err(wrong(
            name,
            place,
            label,
            "a range is (from: a, to: b, steps: n) or (from: a, to: b, step: d), a below b",
        ))
    };
    if !(from.is_finite() && to.is_finite() && from < to) {
        return refuse("`from` must be below `to`");
    }
    if scale == Scale::Log && from <= 0.0 {
        return refuse("logarithms need a positive `from`");
    }
    let most = LIST_LENGTH as f64 - 1.0;
    let steps = match (step, steps) {
        (None, Some(0)) => return refuse("`steps` must be at least 1"),
        (None, Some(steps)) => f64::from(steps),
        (Some(_), None) if scale == Scale::Log => return refuse("a logarithmic range wants `steps`"),
        (Some(step), None) if step.is_finite() && step > 0.0 => {
            // The last step is taken where rounding alone keeps it from the end.
            let steps = ((to - from) / step * (1.0 + 1e-12)).floor();
            if steps > most {
                return refuse("too many values");
            }
            return Ok((0..=steps as u32).map(|k| (from + f64::from(k) * step).min(to)).collect());
        }
        (Some(_), None) => return refuse("`step` must be positive"),
        _ => return refuse("either `step` or `steps` is needed"),
    };
    if steps > most {
        return refuse("too many values");
    }
    let value = |k: u32| match (f64::from(k) / steps, scale) {
        // The ends are as they are written, whatever rounding makes of the rest.
        (0.0, _) => from,
        (1.0, _) => to,
        (share, Scale::Linear) => from + (to - from) * share,
        (share, Scale::Log) => from * (to / from).powf(share),
    };
    Ok((0..=steps as u32).map(value).collect())
}

fn wrong(name: &str, place: &Place, label: &str, note: &str) -> Report {
    Diagnostic::new(codes::BAD_VALUES, format!("these are no values for `{name}`"))
        .at(&place.file, place.span(), label)
        .note(note)
        .into()
}

/// A value as people read it in a list of choices.
pub fn shown(value: &Value) -> String {
    match value {
        Value::Bool(b) => b.to_string(),
        Value::Number(number) => number.to_string(),
        Value::Text(text) => text.clone(),
        Value::List(list) => format!("({})", list.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")),
    }
}
