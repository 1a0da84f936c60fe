//! Line 4: the Fortran formats of pointers, indices, values and right-hand sides.

use super::fortran::Format;
use crate::FormatError;
use crate::text::{Line, quoted};

/// The Fortran formats of line 4, one parenthesis after the other.
pub(super) struct Formats<'a> {
    line: Line<'a>,
    at: usize,
}

impl<'a> Formats<'a> {
    pub(super) fn new(line: Line<'a>) -> Self {
        Self { line, at: 0 }
    }

    /// The next format; `None` where the line has no more.
    pub(super) fn next(&mut self, name: &str) -> Result<Option<Format>, FormatError> {
        let rest = &self.line.bytes[self.at..];
        let start = self.at + rest.len() - rest.trim_ascii_start().len();
        let mut depth = 0_usize;
        let is_end = |&byte: &u8| {
            depth = match byte {
                b'(' => depth + 1,
                b')' => depth.saturating_sub(1),
                _ => depth,
            };
            depth == 0
        };
        let rest = &self.line.bytes[start..];
        if rest.is_empty() {
            return Ok(None);
        }
        let length = rest.iter().position(is_end).map_or(rest.len(), |end| end + 1);
        self.at = start + length;
        match Format::parse(&rest[..length]) {
            Ok(format) => Ok(Some(format)),
            Err(expected) => Err(self.line.error(start, format!("{name}: {expected}"), quoted(rest))),
        }
    }

    /// The next format, which has to be one of whole numbers.
    pub(super) fn integers(&mut self, name: &str) -> Result<Format, FormatError> {
        let format = self.required(name)?;
        match format.fields.iter().all(|field| field.is_integer) {
            true => Ok(format),
            false => Err(self.line.error(0, format!("{name}, a format of whole numbers (I)"), "another")),
        }
    }

    /// The next format, which has to be there.
    pub(super) fn required(&mut self, name: &str) -> Result<Format, FormatError> {
        let missing = |formats: &Self| {
            let found = "the end of the line";
            formats.line.error(formats.at, format!("{name}, a Fortran format"), found)
        };
        self.next(name)?.ok_or_else(|| missing(self))
    }
}
