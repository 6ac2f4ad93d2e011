//! Tables of the results, and their place in the specification.

use std::path::Path;

/// What the benches are told: `--quick` for few rounds, `--write PATH` (from the workspace's root) to replace a section of that file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Arguments {
    /// Few rounds.
    pub quick: bool,
    /// The file with the markers.
    pub write: Option<String>,
    /// All else, for the benches' own use.
    pub rest: Vec<String>,
}

impl Arguments {
    /// The process's arguments. Cargo's own `--bench` is no matter of ours.
    ///
    /// # Errors
    /// `--write` without a path.
    pub fn read() -> Result<Self, String> {
        Self::parse(std::env::args().skip(1))
    }

    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut arguments = Self::default();
        while let Some(word) = words.next() {
            match word.as_str() {
                "--bench" => {}
                "--quick" => arguments.quick = true,
                "--write" => arguments.write = Some(words.next().ok_or("--write needs a path")?),
                _ => arguments.rest.push(word),
            }
        }
        Ok(arguments)
    }

    /// Prints a section, and writes it where `--write` says.
    ///
    /// # Errors
    /// The file cannot be read or written, or has no place for this section.
    #[allow(clippy::print_stdout, reason = "what a bench is for")]
    pub fn publish(&self, section: &str, body: &str) -> Result<(), String> {
        println!("{body}");
        let Some(path) = &self.write else { return Ok(()) };
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(path);
        let fail = |error: std::io::Error| format!("{}: {error}", path.display());
        let text = std::fs::read_to_string(&path).map_err(fail)?;
        let text = with_section(&text, section, body).ok_or_else(|| format!("{}: no markers of the section {section}", path.display()))?;
        let new = path.with_extension("new");
        std::fs::write(&new, text).map_err(fail)?;
        std::fs::rename(&new, &path).map_err(fail)
    }
}

/// The text with this between the section's two markers; `None` where they are not there.
pub fn with_section(text: &str, section: &str, body: &str) -> Option<String> {
    let (begin, end) = (format!("<!-- measured: {section} -->\n"), format!("<!-- end: {section} -->\n"));
    let start = text.find(&begin)? + begin.len();
    let stop = start + text[start..].find(&end)?;
    Some(format!("{}\n{}\n\n{}", &text[..start], body.trim(), &text[stop..]))
}

/// A table in Markdown.
pub fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let header: Vec<String> = header.iter().map(|&cell| cell.to_owned()).collect();
    let mut out = line(&header);
    out.push_str(&format!("|{}\n", "---|".repeat(header.len())));
    out.extend(rows.iter().map(|row| line(row)));
    out
}

/// A time with three digits: `1.23 ms`.
pub fn time(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s >= 1.0 => (s, "s"),
        s if s >= 1e-3 => (s * 1e3, "ms"),
        s => (s * 1e6, "us"),
    };
    format!("{} {unit}", digits(value))
}

/// An amount of memory with three digits: `1.23 MiB`.
pub fn bytes(bytes: f64) -> String {
    let kib = bytes / 1024.0;
    let (value, unit) = match kib {
        k if k >= 1024.0 * 1024.0 => (k / (1024.0 * 1024.0), "GiB"),
        k if k >= 1024.0 => (k / 1024.0, "MiB"),
        k => (k, "KiB"),
    };
    format!("{} {unit}", digits(value))
}

/// A number with three digits.
pub fn digits(value: f64) -> String {
    match value {
        v if v >= 99.95 => format!("{v:.0}"),
        v if v >= 9.995 => format!("{v:.1}"),
        v => format!("{v:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a section that grows with every writing, eats its neighbours, or lands in the wrong place.
    #[test]
    fn a_section_is_replaced_and_nothing_else() {
        let text = "before\n<!-- measured: a -->\nold\n<!-- end: a -->\n<!-- measured: b -->\n<!-- end: b -->\nafter\n";
        let once = with_section(text, "a", "new\n").unwrap();
        assert_eq!(
            once,
            "before\n<!-- measured: a -->\n\nnew\n\n<!-- end: a -->\n<!-- measured: b -->\n<!-- end: b -->\nafter\n"
        );
        assert_eq!(with_section(&once, "a", "new").unwrap(), once);
        assert!(
            with_section(&once, "b", "x")
                .unwrap()
                .ends_with("<!-- measured: b -->\n\nx\n\n<!-- end: b -->\nafter\n")
        );
        assert_eq!(with_section(text, "c", "x"), None);
    }

    /// Catches numbers rounded into four digits, and units off by a thousand.
    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(
            [0.0123, 1.5e-4, 2.0, 9.996e-3].map(time),
            ["12.3 ms", "150 us", "2.00 s", "10.0 ms"]
        );
        assert_eq!(
            [512.0, 1536.0 * 1024.0, 3.0 * 1024.0_f64.powi(3)].map(bytes),
            ["0.50 KiB", "1.50 MiB", "3.00 GiB"]
        );
        assert_eq!(
            table(&["a", "b"], &[vec!["1".into(), "2".into()]]),
            "| a | b |\n|---|---|\n| 1 | 2 |\n"
        );
    }

    /// Catches arguments that are lost, and cargo's own taken for one of ours.
    #[test]
    fn arguments() {
        let parse = |line: &str| Arguments::parse(line.split_whitespace().map(str::to_owned));
        let read = parse("--quick --write a.md --bench child 3").unwrap();
        assert_eq!(
            (read.quick, read.write.as_deref(), read.rest.join(" ")),
            (true, Some("a.md"), "child 3".into())
        );
        assert_eq!(parse("--write").unwrap_err(), "--write needs a path");
    }
}
