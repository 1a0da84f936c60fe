//! The header of a matrix and the numbers in its fields.

use super::card::Field;
use crate::FormatError;
use crate::assemble::MAX_ROWS;
use crate::label::{DofLabel, MAX_NODE};
use crate::text::{Decimal, whole};

/// What the header of a matrix says.
pub(super) struct Header {
    pub(super) name: String,
    pub(super) line: usize,
    pub(super) form: Form,
    pub(super) is_complex: bool,
    /// Whether complex values are amplitude and phase in degrees.
    pub(super) is_polar: bool,
}

/// IFO, and NCOL where it decides the columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Square,
    Symmetric,
    /// With the number of its columns, where these are numbered.
    Rectangular(Option<u64>),
}

/// The name of the matrix that a card belongs to.
pub(super) fn name(field: &Field<'_>) -> Result<String, FormatError> {
    let text = String::from_utf8_lossy(field.text).to_ascii_uppercase();
    if text.is_empty() || text.len() > 8 {
        return Err(field.refuse("the name of a matrix, of one to eight characters"));
    }
    Ok(text)
}

/// Whether the first fields of a card are those of a header.
pub(super) fn is_header(head: &[Field<'_>; 8]) -> bool {
    head[1].text == b"0"
}

impl Header {
    pub(super) fn read(head: &[Field<'_>; 8]) -> Result<Self, FormatError> {
        let [title, _, ifo, tin, tout, polar, blank, ncol] = head;
        let optional = |field: &Field<'_>, name: &str, most| match field.is_blank() {
            true => Ok(None),
            false => number(field, name, 0, most).map(Some),
        };
        let columns = optional(ncol, "NCOL", MAX_ROWS)?.filter(|&n| n > 0);
        let form = match number(ifo, "IFO", 1, 9)? {
            1 => Form::Square,
            6 => Form::Symmetric,
            2 => Form::Rectangular(None),
            9 => Form::Rectangular(columns),
            _ => return Err(ifo.refuse("IFO = 1 (square), 6 (symmetric), 2 or 9 (rectangular)")),
        };
        let is_complex = number(tin, "TIN", 1, 4)? > 2;
        optional(tout, "TOUT", 4)?;
        let is_polar = optional(polar, "POLAR", MAX_NODE)?.is_some_and(|polar| polar > 0);
        if !blank.is_blank() {
            return Err(blank.refuse("a blank field between POLAR and NCOL"));
        }
        Ok(Self { name: name(title)?, line: title.line.number, form, is_complex, is_polar })
    }
}

/// A whole number.
fn number(field: &Field<'_>, name: &str, least: u64, most: u64) -> Result<u64, FormatError> {
    let found = whole(field.text).filter(|n| (least..=most).contains(n));
    found.ok_or_else(|| field.refuse(format!("{name} from {least} to {most}")))
}

/// Grid and component.
pub(super) fn label(grid: &Field<'_>, component: &Field<'_>) -> Result<DofLabel, FormatError> {
    let node = number(grid, "a grid", 1, MAX_NODE)? as i64;
    let component = match component.is_blank() {
        true => 0,
        false => number(component, "a component", 0, 6)? as u8,
    };
    Ok(DofLabel { node, component })
}

/// A real number, which Nastran recognises by its decimal point.
pub(super) fn real(field: &Field<'_>) -> Result<f64, FormatError> {
    let decimal = Decimal::parse(field.text).filter(|decimal| decimal.has_point);
    let value = decimal.and_then(|decimal| decimal.value(0));
    value.ok_or_else(|| field.refuse("a finite number with a decimal point"))
}
