//! Lines, tokens and decimal numbers: what the text formats have in common.

use crate::FormatError;

/// One line without its terminator, and its number from 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<'a> {
    pub(crate) number: usize,
    pub(crate) bytes: &'a [u8],
}

impl Line<'_> {
    /// An error at a byte of this line; the column is counted in characters.
    pub(crate) fn error(
        &self,
        offset: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> FormatError {
        let before = self.bytes.get(..offset).unwrap_or(self.bytes);
        FormatError::column(self.number, String::from_utf8_lossy(before).chars().count() + 1, expected, found)
    }

    pub(crate) fn is_blank(&self) -> bool {
        self.bytes.trim_ascii().is_empty()
    }
}

/// The lines of a file, ended by LF or CR LF; a byte order mark before the first is skipped.
#[derive(Debug, Clone)]
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    /// How many lines have been taken.
    pub(crate) taken: usize,
}

impl<'a> Lines<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), taken: 0 }
    }

    /// How many bytes are left: the bound for every allocation.
    pub(crate) fn bytes_left(&self) -> usize {
        self.rest.len()
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        let (line, rest) = match memchr::memchr(b'\n', self.rest) {
            Some(end) => (&self.rest[..end], &self.rest[end + 1..]),
            None => (self.rest, &[][..]),
        };
        self.rest = rest;
        self.taken += 1;
        Some(Line { number: self.taken, bytes: line.strip_suffix(b"\r").unwrap_or(line) })
    }
}

/// The blank-separated tokens of a line, taken one by one for what they ought to be.
#[derive(Debug, Clone)]
pub(crate) struct Tokens<'a> {
    line: Line<'a>,
    at: usize,
}

impl<'a> Tokens<'a> {
    pub(crate) fn new(line: Line<'a>) -> Self {
        Self { line, at: 0 }
    }

    /// The next token and where it starts; at the end of the line an empty one.
    pub(crate) fn take(&mut self) -> (usize, &'a [u8]) {
        let rest = &self.line.bytes[self.at..];
        let start = self.at + rest.len() - rest.trim_ascii_start().len();
        let rest = &self.line.bytes[start..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at = start + length;
        (start, &rest[..length])
    }

    /// The next token as a word in lower case.
    pub(crate) fn word(&mut self) -> (usize, String) {
        let (start, token) = self.take();
        (start, String::from_utf8_lossy(token).to_ascii_lowercase())
    }

    /// A whole number from `least` to `most`.
    pub(crate) fn whole(&mut self, name: &str, least: u64, most: u64) -> Result<u64, FormatError> {
        let (start, token) = self.take();
        match whole(token) {
            Some(n) if (least..=most).contains(&n) => Ok(n),
            _ => Err(self.line.error(start, format!("{name} from {least} to {most}"), quoted(token))),
        }
    }

    /// A finite number.
    pub(crate) fn number(&mut self) -> Result<(usize, f64), FormatError> {
        let (start, token) = self.take();
        match number(token) {
            Some(x) => Ok((start, x)),
            None => Err(self.line.error(start, FINITE, quoted(token))),
        }
    }

    /// Nothing more on this line.
    pub(crate) fn end(&mut self) -> Result<(), FormatError> {
        match self.take() {
            (_, []) => Ok(()),
            (start, token) => Err(self.line.error(start, "the end of the line", quoted(token))),
        }
    }
}

/// What a value has to be, in the words of an error.
pub(crate) const FINITE: &str = "a finite number";

/// A token as an error shows it: quoted, escaped and not too long.
pub(crate) fn quoted(token: &[u8]) -> String {
    const LONGEST: usize = 40;
    match token {
        [] => "the end of the line".into(),
        [start @ .., _] if start.len() >= LONGEST => {
            format!("{:?}...", String::from_utf8_lossy(&token[..LONGEST]))
        }
        _ => format!("{:?}", String::from_utf8_lossy(token)),
    }
}

/// Decimal digits as a whole number.
pub(crate) fn whole(token: &[u8]) -> Option<u64> {
    std::str::from_utf8(token).ok()?.parse().ok()
}

/// A finite number in the notation of C or of Fortran.
pub(crate) fn number(token: &[u8]) -> Option<f64> {
    Decimal::parse(token)?.value(0)
}

/// A decimal number in its parts: `-12.5D+03` is the mantissa `-12.5` and the exponent 3.
///
/// The exponent's letter is E, D or Q, or missing as in `1.5-103`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Decimal<'a> {
    mantissa: &'a str,
    pub(crate) has_point: bool,
    pub(crate) exponent: Option<i64>,
}

impl<'a> Decimal<'a> {
    pub(crate) fn parse(token: &'a [u8]) -> Option<Self> {
        let text = std::str::from_utf8(token).ok()?;
        let digits_from = usize::from(text.starts_with(['+', '-']));
        let is_mantissa = |c: char| c.is_ascii_digit() || c == '.';
        let end = text[digits_from..].find(|c| !is_mantissa(c)).map_or(text.len(), |n| digits_from + n);
        let (mantissa, exponent) = text.split_at(end);
        let points = mantissa.bytes().filter(|&b| b == b'.').count();
        if points > 1 || mantissa.len() == digits_from + points {
            return None;
        }
        Some(Self { mantissa, has_point: points == 1, exponent: exponent_of(exponent)? })
    }

    /// mantissa × 10^(exponent + shift), correctly rounded; `None` where that overflows.
    pub(crate) fn value(&self, shift: i64) -> Option<f64> {
        let value: f64 = match self.exponent.unwrap_or(0).saturating_add(shift) {
            0 => self.mantissa.parse().ok()?,
            exponent => format!("{}e{exponent}", self.mantissa).parse().ok()?,
        };
        value.is_finite().then_some(value)
    }
}

/// The exponent that follows a mantissa: `Some(None)` where there is no exponent, `None` where it is malformed.
fn exponent_of(text: &str) -> Option<Option<i64>> {
    if text.is_empty() {
        return Some(None);
    }
    let signed = text.strip_prefix(['e', 'E', 'd', 'D', 'q', 'Q']).unwrap_or(text);
    let digits = signed.strip_prefix(['+', '-']).unwrap_or(signed);
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    // Beyond nine digits every mantissa that fits into memory is zero or overflows.
    let size = if digits.trim_start_matches('0').len() > 9 { 999_999_999 } else { digits.parse().ok()? };
    Some(Some(if signed.starts_with('-') { -size } else { size }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_c_and_fortran_are_read_alike() {
        for (text, value) in [
            ("12", 12.0),
            ("-.5", -0.5),
            ("+5.", 5.0),
            ("1.5E3", 1500.0),
            ("1.5d-3", 0.0015),
            ("1.5Q+2", 150.0),
            ("1.5-103", 1.5e-103),
            ("-2+4", -2e4),
            ("1e-0000000000000000005", 1e-5),
            ("1e-99999999999999999999", 0.0),
            ("39411962.7427", 39_411_962.742_7),
        ] {
            assert_eq!(number(text.as_bytes()), Some(value), "{text}");
        }
        for text in
            ["", ".", "-", "nan", "inf", "1e", "1e+", "1.5.2", "1,5", "0x10", "1e999", "e5", "1 2", "1_000"]
        {
            assert_eq!(number(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn lines_end_with_lf_or_cr_lf_and_columns_count_characters() {
        let lines: Vec<_> = Lines::new("\u{feff}a\r\n\n°x y".as_bytes()).collect();
        assert_eq!(lines.iter().map(|l| l.bytes).collect::<Vec<_>>(), [&b"a"[..], b"", "°x y".as_bytes()]);
        assert_eq!(lines[2].error(3, "e", "f").to_string(), "input:3:3: expected e, found f");
    }
}
