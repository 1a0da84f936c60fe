//! Fortran formats such as `(16I5)`, `(1P,3D25.17)` or `(3(1PE26.18))`.
//!
//! # Source
//! ISO/IEC 1539-1 (Fortran), clause "Input/output editing": data edit descriptors I, F, E, D, G, EN, ES;
//! control edit descriptors X and P; format reversion.

use crate::text::Decimal;

/// How a record is cut into fields.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Format {
    pub(super) fields: Vec<Field>,
    /// The scale factor k of kP.
    scale: i64,
}

/// One field of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Field {
    /// First column, from 0.
    pub(super) start: usize,
    pub(super) width: usize,
    /// Digits behind the point of a number that has none.
    decimals: i64,
    /// A whole number: descriptor I.
    pub(super) is_integer: bool,
}

impl Field {
    /// Whether a piece of a line stands in the columns of this field.
    pub(super) fn holds(self, start: usize, length: usize) -> bool {
        start >= self.start && start + length <= self.start + self.width
    }
}

/// More fields than this in one line are no file of this world.
const MAX_FIELDS: usize = 1000;

/// The header has 20 columns for a format; groups are read as often as they repeat, so there is an end.
const LONGEST: usize = 200;

impl Format {
    /// Reads a format; the error says what the format would have to have.
    pub(super) fn parse(text: &[u8]) -> Result<Self, &'static str> {
        if text.len() > LONGEST {
            return Err("a format of at most 200 characters");
        }
        let packed: Vec<u8> =
            text.iter().filter(|b| !b.is_ascii_whitespace()).map(u8::to_ascii_uppercase).collect();
        let rest = packed.strip_prefix(b"(").ok_or("a format in parentheses")?;
        let mut parser = Parser { rest, column: 0, scale: 0, format: Self { fields: Vec::new(), scale: 0 } };
        parser.group(0)?;
        if !parser.rest.is_empty() {
            return Err("nothing behind the closing parenthesis of a format");
        }
        if parser.format.fields.is_empty() {
            return Err("a format with at least one field");
        }
        Ok(parser.format)
    }

    /// The value of a field's characters, which are trimmed and not empty.
    pub(super) fn number(&self, field: Field, characters: &[u8]) -> Option<f64> {
        let decimal = Decimal::parse(characters)?;
        let implied_point = if decimal.has_point { 0 } else { field.decimals };
        let scale = if decimal.exponent.is_some() || field.is_integer { 0 } else { self.scale };
        decimal.value(-implied_point - scale)
    }
}

struct Parser<'a> {
    rest: &'a [u8],
    column: usize,
    scale: i64,
    format: Format,
}

impl Parser<'_> {
    /// The items of a group up to its closing parenthesis.
    fn group(&mut self, depth: usize) -> Result<(), &'static str> {
        if depth > 4 {
            return Err("a format with at most four nested groups");
        }
        loop {
            let sign = if self.take(b'-') { -1 } else { 1 };
            let number = self.number()?;
            let repeat = number.unwrap_or(1);
            match self.rest.first() {
                Some(b')') if number.is_none() => {
                    self.take(b')');
                    return Ok(());
                }
                Some(b',') if number.is_none() => _ = self.take(b','),
                Some(b'P') if number.is_some() => {
                    self.take(b'P');
                    self.scale = sign * repeat as i64;
                }
                _ if sign < 0 => return Err("a minus sign only in a scale factor (-1P)"),
                Some(b'X') => {
                    self.take(b'X');
                    self.column += repeat;
                }
                Some(b'(') => {
                    self.take(b'(');
                    self.repeated_group(repeat, depth)?;
                }
                Some(b'I' | b'F' | b'E' | b'D' | b'G') => self.descriptor(repeat)?,
                _ => return Err("a Fortran format of I, F, E, D, G, X and P"),
            }
        }
    }

    fn repeated_group(&mut self, repeat: usize, depth: usize) -> Result<(), &'static str> {
        // Format reversion repeats the last group only, so fields before it would not come again.
        if depth == 0 && self.column > 0 {
            return Err("a format without fields before a group");
        }
        let (inside, before) = (self.rest, self.format.fields.len());
        for _ in 0..repeat {
            self.rest = inside;
            self.group(depth + 1)?;
            if self.format.fields.len() == before {
                return Err("a group with at least one field");
            }
        }
        if repeat == 0 { Err(POSITIVE) } else { Ok(()) }
    }

    /// `rIw`, `rIw.m`, `rFw.d`, `rEw.d`, `rEw.dEe`, also D, G, EN and ES.
    fn descriptor(&mut self, repeat: usize) -> Result<(), &'static str> {
        let (is_integer, letters) = match self.rest {
            [b'I', ..] => (true, 1),
            [b'E', b'N' | b'S', ..] => (false, 2),
            _ => (false, 1),
        };
        self.rest = &self.rest[letters..];
        let width = self.number()?.filter(|&w| w > 0).ok_or("a field width of at least 1")?;
        let mut decimals = 0;
        if self.take(b'.') {
            decimals = self.number()?.ok_or("digits behind the point of a field width")?;
            if self.take(b'E') {
                self.number()?.ok_or("a width of the exponent")?;
            }
        }
        if repeat == 0 {
            return Err(POSITIVE);
        }
        if !self.format.fields.is_empty() && self.format.scale != self.scale {
            return Err("one scale factor (P) for all fields");
        }
        self.format.scale = self.scale;
        for _ in 0..repeat {
            if self.format.fields.len() == MAX_FIELDS {
                return Err("a format with at most 1000 fields a line");
            }
            let decimals = if is_integer { 0 } else { decimals as i64 };
            self.format.fields.push(Field { start: self.column, width, decimals, is_integer });
            self.column += width;
        }
        Ok(())
    }

    fn take(&mut self, byte: u8) -> bool {
        let taken = self.rest.strip_prefix(&[byte]);
        self.rest = taken.unwrap_or(self.rest);
        taken.is_some()
    }

    /// The digits that come next, if any; at most five.
    fn number(&mut self) -> Result<Option<usize>, &'static str> {
        let length = self.rest.iter().take_while(|b| b.is_ascii_digit()).count();
        let (digits, rest) = self.rest.split_at(length);
        self.rest = rest;
        match length {
            0 => Ok(None),
            1..=5 => Ok(Some(digits.iter().fold(0, |n, digit| 10 * n + usize::from(digit - b'0')))),
            _ => Err("numbers of at most five digits in a format"),
        }
    }
}

const POSITIVE: &str = "a repeat count of at least 1";

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(text: &str) -> (usize, usize, i64, i64) {
        let format = Format::parse(text.as_bytes()).unwrap();
        let last = format.fields[format.fields.len() - 1];
        assert_eq!(last.start, last.width * (format.fields.len() - 1), "{text}");
        (format.fields.len(), last.width, last.decimals, format.scale)
    }

    #[test]
    fn formats_seen_in_the_wild() {
        for (text, expected) in [
            ("(16I5)", (16, 5, 0, 0)),
            ("(10I8.1)", (10, 8, 0, 0)),
            ("(4E20.12)", (4, 20, 12, 0)),
            ("(1P,3D25.17)", (3, 25, 17, 1)),
            ("(1P3D25.17)", (3, 25, 17, 1)),
            ("(1P4E20.12)", (4, 20, 12, 1)),
            ("(10F7.1)", (10, 7, 1, 0)),
            ("(5E16.8)", (5, 16, 8, 0)),
            ("(3(1PE26.18))", (3, 26, 18, 1)),
            ("(1p, 3e25.16e3)", (3, 25, 16, 1)),
            ("(2(2(F8.2)))", (4, 8, 2, 0)),
            ("(-2P,4ES20.12)", (4, 20, 12, -2)),
            ("(E24.16)", (1, 24, 16, 0)),
        ] {
            assert_eq!(layout(text), expected, "{text}");
        }
    }

    #[test]
    fn blanks_between_fields_are_skipped() {
        let format = Format::parse(b"(1X,2(I4,1X))");
        assert_eq!(format, Err("a format without fields before a group"));
        let starts: Vec<_> =
            Format::parse(b"(2(1X,I4))").unwrap().fields.iter().map(|f| (f.start, f.width)).collect();
        assert_eq!(starts, [(1, 4), (6, 4)]);
    }

    #[test]
    fn other_formats_are_refused() {
        for text in [
            "",
            "16I5",
            "(16I5",
            "(16I5))",
            "()",
            "(16)",
            "(A8)",
            "(I0)",
            "(0I5)",
            "(1001I5)",
            "(99999(99999I1))",
            "(99999())",
            "(((((((I5)))))))",
            "(2E20.12,1P,2E20.12)",
            "(I5/I5)",
            "(-3I5)",
            "(1000000I5)",
            "(F8.)",
            "(3é)",
        ] {
            assert!(Format::parse(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_are_read_as_fortran_reads_them() {
        let read = |format: &str, text: &str| {
            let format = Format::parse(format.as_bytes()).unwrap();
            format.number(format.fields[0], text.as_bytes())
        };
        // No point: the last d digits stand behind it.
        assert_eq!(read("(F7.1)", "123"), Some(12.3));
        assert_eq!(read("(F7.1)", "12.34"), Some(12.34));
        assert_eq!(read("(4E20.12)", "5E12"), Some(5.0));
        // A scale factor divides what has no exponent, and leaves alone what has one.
        assert_eq!(read("(2P,F7.1)", "12.5"), Some(0.125));
        assert_eq!(read("(1P,E25.17)", "1.5E0"), Some(1.5));
        assert_eq!(read("(1P,E25.17)", "1.5-103"), Some(1.5e-103));
        assert_eq!(read("(10I8)", "-12"), Some(-12.0));
    }
}
