//! Small pieces of text that several commands write alike.

use shadewright::compiler::manifest::Value;

/// A value as it stands in RON.
pub fn value(value: &Value) -> String {
    match value {
        Value::Bool(truth) => truth.to_string(),
        Value::Number(number) => number.to_string(),
        Value::Text(text) => format!("{text:?}"),
        Value::List(components) => {
            let components: Vec<String> = components.iter().map(f64::to_string).collect();
            format!("({})", components.join(", "))
        }
    }
}

/// Lines of cells as columns, two spaces apart; nothing behind the last cell of a line.
pub fn columns(lines: &[Vec<String>], indent: &str) -> String {
    let width = |column: usize| {
        let cells = lines.iter().filter_map(|line| line.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..lines.iter().map(Vec::len).max().unwrap_or(0)).map(width).collect();
    let mut text = String::new();
    for line in lines {
        let cells: Vec<String> = line.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        text.push_str(format!("{indent}{}", cells.join("  ")).trim_end());
        text.push('\n');
    }
    text
}

/// The names nearest to a mistyped one, as the end of a sentence; empty where none is near.
pub fn nearest<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let mut near: Vec<(f64, &str)> = names
        .into_iter()
        .map(|name| (strsim::jaro_winkler(typed, name), name))
        .filter(|(likeness, _)| *likeness > 0.75)
        .collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    near.dedup();
    let names: Vec<String> = near.iter().take(3).map(|(_, name)| format!("`{name}`")).collect();
    match names.is_empty() {
        true => String::new(),
        false => format!("; the nearest: {}", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches ragged columns, and spaces at the ends of lines.
    #[test]
    fn columns_line_up() {
        let lines = [vec!["a".to_owned(), "first".to_owned()], vec!["longer".to_owned(), String::new()]];
        assert_eq!(columns(&lines, "  "), "  a       first\n  longer\n");
    }

    /// Catches advice that is far off, or misses what is near.
    #[test]
    fn nearest_names_are_near() {
        assert_eq!(nearest("lambrt", ["lambert", "microfacet"]), "; the nearest: `lambert`");
        assert_eq!(nearest("zzz", ["lambert"]), "");
    }
}
