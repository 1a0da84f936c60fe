//! The header of the file: which signs it uses.

use super::fields::fields;
use super::{DecimalSign, Lvm, Separator};
use crate::FormatError;
use crate::text::{Line, Lines, quoted};

/// The first line of every file.
pub(super) const MAGIC: &[u8] = b"LabVIEW Measurement";

pub(crate) fn is_first_line(line: &[u8]) -> bool {
    line.starts_with(MAGIC)
}

/// The line that ends a header.
pub(super) const END: &[u8] = b"***End_of_Header***";

/// Which columns hold the abscissa.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum XColumns {
    /// None: the first column is empty.
    No,
    /// The first, for all channels.
    One,
    /// One before each channel.
    Multi,
}

/// Reads up to the end of the header.
pub(super) fn file_header(lines: &mut Lines<'_>) -> Result<(Lvm, XColumns), FormatError> {
    let first = lines.next().filter(|line| is_first_line(line.bytes));
    if first.is_none() {
        let expected = "\"LabVIEW Measurement\" in the first line";
        return Err(FormatError::line(1, expected, "something else"));
    }
    let separator = separator(lines.clone())?;
    let mut file = Lvm { separator, ..Lvm::default() };
    // A column that is not announced would be taken for a channel; an announced one that is missing is an error later.
    let mut x_columns = XColumns::No;
    for line in lines.by_ref() {
        let mut fields = fields(line, separator.byte());
        let key = fields.next().map_or(String::new(), |key| key.text());
        if key.as_bytes() == END {
            if file.decimal == DecimalSign::Comma && file.separator == Separator::Comma {
                let found = "a comma for both";
                return Err(FormatError::line(
                    line.number,
                    "different signs for columns and decimals",
                    found,
                ));
            }
            return Ok((file, x_columns));
        }
        let Some(value) = fields.next() else {
            if key.is_empty() {
                continue;
            }
            return Err(FormatError::line(line.number, "a key and its value", quoted(line.bytes)));
        };
        match key.as_str() {
            "Separator" | "" => {}
            // Where a comma separates the columns it cannot be the decimal sign: it would be an empty value.
            "Decimal_Separator" => {
                file.decimal = match (value.bytes, file.separator) {
                    (b".", _) => DecimalSign::Point,
                    (b",", _) => DecimalSign::Comma,
                    (b"", Separator::Comma) => DecimalSign::Comma,
                    _ => return Err(value.error("a decimal point or a decimal comma")),
                }
            }
            "X_Columns" => {
                x_columns = match value.bytes {
                    b"No" => XColumns::No,
                    b"One" => XColumns::One,
                    b"Multi" => XColumns::Multi,
                    _ => return Err(value.error("No, One or Multi")),
                }
            }
            _ => file.header.push((key, value.text())),
        }
    }
    Err(FormatError::line(lines.taken, "***End_of_Header***", "the end of the file"))
}

/// The line `Separator` says what separates it; without it columns are separated by tabs.
fn separator(lines: Lines<'_>) -> Result<Separator, FormatError> {
    let is_key = |line: &Line<'_>| line.bytes.starts_with(b"Separator");
    let mut header = lines.take_while(|line| !line.bytes.starts_with(END));
    let Some(line) = header.find(is_key) else { return Ok(Separator::Tab) };
    let said = line.bytes["Separator".len()..].trim_ascii();
    match said {
        b"Tab" => Ok(Separator::Tab),
        [b',', name @ ..] if name.trim_ascii() == b"Comma" => Ok(Separator::Comma),
        _ => Err(line.error("Separator".len(), "a tab and Tab, or a comma and Comma", quoted(said))),
    }
}
