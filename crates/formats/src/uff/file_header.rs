//! Dataset 151: who wrote the file, and when.

use crate::FormatError;

use super::columns::{Field, fields};
use super::lines::Lines;

/// What a file says about itself. Texts are empty and numbers 0 where it says nothing readable.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FileHeader {
    /// Name of the model file (80 characters).
    pub model: String,
    /// Description of it (80 characters).
    pub description: String,
    /// Program that created the database (80 characters).
    pub created_by: String,
    /// Date and time of the database (20 characters, usually `DD-MMM-YY HH:MM:SS`).
    pub created: String,
    /// Two version numbers of the database.
    pub versions: [i32; 2],
    /// 0: universal, 1: archive, 2: other.
    pub file_type: i32,
    /// Date and time at which the database was last saved (20 characters).
    pub saved: String,
    /// Program that wrote the file (80 characters).
    pub written_by: String,
    /// Date and time at which the file was written (20 characters).
    pub written: String,
}

/// Seven records: 3 × FORMAT(80A1), FORMAT(10A1,10A1,3I10), FORMAT(10A1,10A1), FORMAT(80A1), FORMAT(10A1,10A1).
/// Dates come in many spellings and widths, so that one is read over both of its fields.
pub(super) fn read(mut lines: Lines<'_>) -> Result<FileHeader, FormatError> {
    let (model, description, created_by) =
        (text(&mut lines, 80)?, text(&mut lines, 80)?, text(&mut lines, 80)?);
    let (creation, line) = next(&mut lines)?;
    let [created, version_1, version_2, file_type] = fields(&creation, line, [20, 10, 10, 10]);
    let number = |field: Field<'_>| field.integer("a number").unwrap_or_default();
    Ok(FileHeader {
        model,
        description,
        created_by,
        created: created.text(),
        versions: [number(version_1), number(version_2)],
        file_type: number(file_type),
        saved: text(&mut lines, 20)?,
        written_by: text(&mut lines, 80)?,
        written: text(&mut lines, 20)?,
    })
}

/// The text at the beginning of the next line.
fn text(lines: &mut Lines<'_>, width: usize) -> Result<String, FormatError> {
    let (text, line) = next(lines)?;
    let [field] = fields(&text, line, [width]);
    Ok(field.text())
}

fn next(lines: &mut Lines<'_>) -> Result<(String, usize), FormatError> {
    let line = lines.next();
    let missing = || FormatError::line(lines.next_number(), "seven records", "the end of the dataset");
    line.map(|line| (line.text(), line.number)).ok_or_else(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seven_records_some_of_them_blank() {
        let text = "model\n\nNONE\n29-Jan-16 14:48:16           1         2         x\n\nfrfit\n 3-Feb-23  22:10:15  453\n";
        let header = read(Lines::new(text.as_bytes(), 3)).expect("a header");
        assert_eq!((header.model.as_str(), header.created_by.as_str()), ("model", ""));
        assert_eq!((header.created.as_str(), header.versions), ("29-Jan-16 14:48:16", [1, 2]));
        assert_eq!((header.file_type, header.saved.as_str()), (0, ""));
        assert_eq!((header.written_by.as_str(), header.written.as_str()), ("frfit", "3-Feb-23  22:10:15"));
        assert!(read(Lines::new(b"model\n", 3)).is_err());
    }
}
