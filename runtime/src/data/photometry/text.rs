//! Lines and numbers of a photometric file.

use super::{MAX_INTENSITIES, PhotometryError};

/// A file's lines. Bytes beyond ASCII, which only descriptions have, are taken for Latin-1.
pub(super) struct Text {
    lines: Vec<String>,
}

/// A number and the line that it stands on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    pub value: f64,
    pub line: usize,
}

impl Number {
    pub fn wrong(self, message: impl Into<String>) -> PhotometryError {
        wrong(self.line, message)
    }

    /// The number, if it is within these bounds.
    pub fn within(self, what: &str, low: f64, high: f64) -> Result<f64, PhotometryError> {
        if (low..=high).contains(&self.value) {
            return Ok(self.value);
        }
        Err(self.wrong(format!("{what} is {}, not from {low} to {high}", self.value)))
    }

    /// The number as a count within these bounds.
    pub fn count(self, what: &str, low: usize, high: usize) -> Result<usize, PhotometryError> {
        let value = self.within(what, low as f64, high as f64)?;
        if value.fract() != 0.0 {
            return Err(self.wrong(format!("{what} is {value}, no whole number")));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the bounds and whole
        Ok(value as usize)
    }
}

pub(super) fn wrong(line: usize, message: impl Into<String>) -> PhotometryError {
    PhotometryError {
        line,
        message: message.into(),
    }
}

/// A finite number that is written so. A comma may stand for the point where no list can be meant.
fn parse(word: &str, line: usize, what: &str) -> Result<Number, PhotometryError> {
    let plain = word.bytes().all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b));
    match word.parse::<f64>() {
        Ok(value) if plain && value.is_finite() => Ok(Number { value, line }),
        _ => {
            let shown: String = word.chars().take(24).collect();
            Err(wrong(line, format!("{what} should be a number, not `{shown}`")))
        }
    }
}

impl Text {
    pub fn new(bytes: &[u8]) -> Self {
        // A mark of UTF-8 says nothing that Latin-1 would need to know.
        let bytes = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
        let text: String = bytes.iter().map(|&byte| char::from(byte)).collect();
        // Line ends of all systems; the last line's own end begins no further line.
        let text = text.replace("\r\n", "\n").replace('\r', "\n");
        Self {
            lines: text.lines().map(str::to_owned).collect(),
        }
    }

    /// Whether a line begins with `TILT=`, which every IES file has and no EULUMDAT file.
    pub fn is_ies(&self) -> bool {
        self.lines.iter().any(|line| is_tilt(line))
            || self
                .lines
                .first()
                .is_some_and(|line| line.starts_with("IESNA") || line.starts_with("IES:"))
    }

    /// Line with this number, counted from 1, without spaces around it.
    pub fn line(&self, number: usize) -> Option<&str> {
        self.lines.get(number.checked_sub(1)?).map(|line| line.trim())
    }

    /// Number of the last line; 1 of an empty file.
    pub fn end(&self) -> usize {
        self.lines.len().max(1)
    }

    /// The line with the tilt, and what it says.
    pub fn tilt(&self) -> Option<(usize, &str)> {
        let at = self.lines.iter().position(|line| is_tilt(line))?;
        let (_, tilt) = self.lines[at].split_once('=')?;
        Some((at + 1, tilt.trim()))
    }

    /// All numbers after a line, separated by white space or commas.
    pub fn numbers_after(&self, line: usize) -> Numbers<'_> {
        let words = self.lines.iter().enumerate().skip(line).flat_map(|(at, line)| {
            line.split(|c: char| c.is_whitespace() || c == ',')
                .filter(|word| !word.is_empty())
                .map(move |word| (at + 1, word))
        });
        Numbers {
            words: Box::new(words),
            end: self.end(),
        }
    }

    /// The number that is alone on a line. Its decimals may be after a comma.
    pub fn number(&self, line: usize, what: &str) -> Result<Number, PhotometryError> {
        let Some(text) = self.line(line) else {
            return Err(wrong(self.end(), format!("the file ends before {what}")));
        };
        // Comments after the number are not of the format, but blanks and units are found there.
        let word = text.split_whitespace().next().unwrap_or_default();
        parse(&word.replace(',', "."), line, what)
    }
}

fn is_tilt(line: &str) -> bool {
    line.trim_start().starts_with("TILT=")
}

/// The numbers of a part of a file, one after another.
pub(super) struct Numbers<'a> {
    words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    end: usize,
}

impl Numbers<'_> {
    pub fn next(&mut self, what: &str) -> Result<Number, PhotometryError> {
        match self.words.next() {
            Some((line, word)) => parse(word, line, what),
            None => Err(wrong(self.end, format!("the file ends before {what}"))),
        }
    }

    /// As many as that; the caller has bounded the count.
    pub fn list(&mut self, count: usize, what: &str) -> Result<Vec<Number>, PhotometryError> {
        let mut list = Vec::with_capacity(count.min(MAX_INTENSITIES));
        for index in 1..=count {
            let number = self.next(&format!("{what} {index} of {count}"))?;
            list.push(number);
        }
        Ok(list)
    }
}

/// Values of angles, if they increase and are within these bounds.
pub(super) fn increasing(angles: &[Number], what: &str, low: f64, high: f64) -> Result<Vec<f64>, PhotometryError> {
    for angle in angles {
        angle.within(what, low, high)?;
    }
    for pair in angles.windows(2) {
        if pair[1].value <= pair[0].value {
            return Err(pair[1].wrong(format!("{what} is {}, but the one before is {}", pair[1].value, pair[0].value)));
        }
    }
    Ok(angles.iter().map(|angle| angle.value).collect())
}

/// Values of intensities times a factor, if none is negative.
pub(super) fn intensities(numbers: &[Number], factor: f64) -> Result<Vec<f64>, PhotometryError> {
    numbers
        .iter()
        .map(|number| {
            let candela = number.value * factor;
            // What a shader adds up must be finite: 1e30 cd are brighter than any star.
            if (0.0..=1e30).contains(&candela) {
                Ok(candela)
            } else {
                Err(number.wrong(format!("an intensity of {candela} cd")))
            }
        })
        .collect()
}
