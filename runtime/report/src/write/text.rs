//! Texts from manifests and inputs, on their way into files: names of files, commands, tables.

use std::collections::BTreeSet;

use serde_json::Value;

use super::number::{MISSING, number};
use crate::data::{Fit, Worst};

/// The command that evaluates a recipe's function at one input, for a POSIX shell.
pub fn replay(recipe: &str, function: &str, input: &Value) -> String {
    let row = format!("[{input}]");
    let [row, recipe, function] = [&row, recipe, function].map(|text| shell_words::quote(text));
    format!("printf '%s\\n' {row} | shadewright probe {recipe} {function} --inputs -")
}

/// A value of the module or of the truth: a number with all its digits, or the name of what is not finite.
pub fn value(value: &Value) -> String {
    match value {
        Value::Null => MISSING.to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// `diffuse.y = NaN, should be 0.5`.
pub fn happened(worst: &Worst) -> String {
    let name = if worst.component.is_empty() { "value" } else { &worst.component };
    let got = value(&worst.got);
    match worst.expected {
        Value::Null => format!("{name} = {got}"),
        _ => format!("{name} = {got}, should be {}", value(&worst.expected)),
    }
}

/// What a fit found: `s.alpha 0.2, s.f0 (0.9, 0.7, 0.3)`, with `*` behind what is at an end of its range.
pub fn parameters(fit: &Fit) -> String {
    let one = |fitted: &crate::data::Fitted| {
        let values: Vec<String> = fitted.values.iter().map(|value| number(*value)).collect();
        let end = if fitted.at_end { "*" } else { "" };
        match &values[..] {
            [one] => format!("{} {one}{end}", fitted.name),
            all => format!("{} ({}){end}", fitted.name, all.join(", ")),
        }
    };
    if fit.parameters.is_empty() {
        return "nothing is free".to_owned();
    }
    fit.parameters.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Without the characters that no XML may hold, and on one line.
pub fn clean(text: &str) -> String {
    text.chars()
        .map(|letter| match letter {
            '\t' | '\n' | '\r' => ' ',
            control if control.is_control() => char::REPLACEMENT_CHARACTER,
            other => other,
        })
        .collect()
}

/// At most so many letters, the last of them an ellipsis where some are gone.
pub fn short(text: &str, most: usize) -> String {
    let text = clean(text);
    if text.chars().count() <= most {
        return text;
    }
    let start: String = text.chars().take(most.saturating_sub(1)).collect();
    format!("{}…", start.trim_end())
}

/// Names for files and anchors: lower-case ASCII letters, digits, `-` and `_`, each given once.
#[derive(Default)]
pub struct Names {
    given: BTreeSet<String>,
}

impl Names {
    /// A name that says what `text` says, as far as its letters allow.
    pub fn give(&mut self, text: &str) -> String {
        let allowed = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '-' | '_');
        let letters = text.to_lowercase();
        let parts = letters.split(|letter| !allowed(letter)).filter(|part| !part.is_empty());
        let mut stem = parts.collect::<Vec<_>>().join("-");
        stem.truncate(80);
        if stem.is_empty() {
            stem = "unnamed".to_owned();
        }
        let mut name = stem.clone();
        let mut number = 2;
        while !self.given.insert(name.clone()) {
            name = format!("{stem}-{number}");
            number += 1;
        }
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches two things with one file name (also on a system where case does not count), and names that leave the folder.
    #[test]
    fn names_are_given_once() {
        let mut names = Names::default();
        let given = ["brdf/ggx", "brdf-ggx", "BRDF/GGX", "../../etc/passwd", "", "…", "brdf-ggx-2"].map(|text| names.give(text));
        assert_eq!(
            given,
            [
                "brdf-ggx",
                "brdf-ggx-2",
                "brdf-ggx-3",
                "etc-passwd",
                "unnamed",
                "unnamed-2",
                "brdf-ggx-2-2"
            ]
        );
    }

    /// Catches letters cut in two, and characters that make a drawing no XML.
    #[test]
    fn texts_are_short_and_clean() {
        assert_eq!(short("äöü", 3), "äöü");
        assert_eq!(short("äöüß", 3), "äö…");
        assert_eq!(clean("a\u{0}b\nc\u{1b}"), "a\u{fffd}b c\u{fffd}");
    }
}
