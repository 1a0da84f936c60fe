//! The fields of a line.

use super::DecimalSign;
use crate::FormatError;
use crate::text::{FINITE, Line, number, quoted};

/// A field and where it starts in its line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field<'a> {
    pub(super) line: Line<'a>,
    pub(super) start: usize,
    pub(super) bytes: &'a [u8],
}

/// The fields of a line without the blanks around them.
pub(super) fn fields(line: Line<'_>, separator: u8) -> impl Iterator<Item = Field<'_>> {
    let mut at = 0;
    line.bytes.split(move |&byte| byte == separator).map(move |raw| {
        let blanks = raw.iter().take_while(|&&byte| byte == b' ').count();
        let start = at + blanks;
        at += raw.len() + 1;
        Field { line, start, bytes: raw.trim_ascii() }
    })
}

/// Whether there is nothing in a line but blanks and separators.
pub(super) fn is_empty(line: &Line<'_>, separator: u8) -> bool {
    line.bytes.iter().all(|&byte| byte == separator || byte.is_ascii_whitespace())
}

impl Field<'_> {
    /// As text; bytes that are no UTF-8 are shown as �, since older files are in the code page of their machine.
    pub(super) fn text(&self) -> String {
        String::from_utf8_lossy(self.bytes).into_owned()
    }

    pub(super) fn error(&self, expected: impl Into<String>) -> FormatError {
        self.line.error(self.start, expected, quoted(self.bytes))
    }

    /// A finite number with the file's decimal sign.
    pub(super) fn number(&self, decimal: DecimalSign) -> Result<f64, FormatError> {
        let value = match decimal {
            DecimalSign::Point => number(self.bytes),
            DecimalSign::Comma if self.bytes.contains(&b'.') => None,
            DecimalSign::Comma => {
                let point = |&byte: &u8| if byte == b',' { b'.' } else { byte };
                number(&self.bytes.iter().map(point).collect::<Vec<_>>())
            }
        };
        let sign = match decimal {
            DecimalSign::Point => "decimal point",
            DecimalSign::Comma => "decimal comma",
        };
        value.ok_or_else(|| self.error(format!("{FINITE} with a {sign}")))
    }
}
