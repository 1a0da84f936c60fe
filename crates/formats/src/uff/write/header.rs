//! Dataset 151.

use crate::FormatError;
use crate::uff::file_header::FileHeader;

use super::DELIMITER;
use super::fixed::{integer, text};

/// What a file says about itself as dataset 151.
///
/// # Errors
///
/// A text or a number does not fit its columns.
pub fn file_header(header: &FileHeader) -> Result<Vec<u8>, FormatError> {
    let line = |value: &str| text(value, 80, "a header text");
    let date =
        |value: &str| if value.is_empty() { Ok(" ".repeat(20)) } else { text(value, 20, "date and time") };
    let [version_1, version_2] = header.versions.map(|version| integer(version.into(), 10, "a version"));
    let numbers = version_1? + &version_2? + &integer(header.file_type.into(), 10, "a file type")?;
    let records = [
        line(&header.model)?,
        line(&header.description)?,
        line(&header.created_by)?,
        date(&header.created)? + &numbers,
        date(&header.saved)?,
        line(&header.written_by)?,
        date(&header.written)?,
    ];
    Ok(format!("{DELIMITER}{:6}\n{}\n{DELIMITER}", 151, records.join("\n")).into_bytes())
}
