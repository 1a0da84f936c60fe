//! The writer.

use crate::FormatError;

/// A cell to be written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell<'a> {
    /// Nothing: there is no answer.
    Empty,
    /// A number; one that is not finite is no answer, and written as nothing.
    Number(f64),
    /// A whole number.
    Count(usize),
    /// A word, quoted where it needs quotes.
    Text(&'a str),
}

impl From<f64> for Cell<'_> {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<Option<f64>> for Cell<'_> {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::Empty, Self::Number)
    }
}

impl<'a> From<&'a str> for Cell<'a> {
    fn from(text: &'a str) -> Self {
        Self::Text(text)
    }
}

/// Writes a table with a comma between cells: the names of its columns, then its rows.
///
/// Numbers have the shortest digits that read back to the same bits.
///
/// # Errors
/// A row with more or fewer cells than there are columns; no columns; text with a line break.
pub fn write<'a, R: AsRef<[Cell<'a>]>>(
    columns: &[&str],
    rows: impl IntoIterator<Item = R>,
) -> Result<String, FormatError> {
    if columns.is_empty() {
        return Err(FormatError::whole("at least one column", "none"));
    }
    let mut out = String::new();
    let names: Vec<Cell<'_>> = columns.iter().map(|name| Cell::Text(name)).collect();
    push_line(&mut out, &names)?;
    for (k, row) in rows.into_iter().enumerate() {
        let row = row.as_ref();
        if row.len() != columns.len() {
            let expected = format!("{} cells in each row", columns.len());
            return Err(FormatError::line(k + 2, expected, row.len().to_string()));
        }
        push_line(&mut out, row)?;
    }
    Ok(out)
}

fn push_line(out: &mut String, cells: &[Cell<'_>]) -> Result<(), FormatError> {
    let start = out.len();
    for (k, cell) in cells.iter().enumerate() {
        if k > 0 {
            out.push(',');
        }
        match cell {
            Cell::Number(value) if value.is_finite() => out.push_str(&format!("{value:?}")),
            Cell::Number(_) | Cell::Empty => {}
            Cell::Count(count) => out.push_str(&count.to_string()),
            Cell::Text(text) if text.contains(['\n', '\r']) => {
                return Err(FormatError::whole("text on one line", format!("{text:?}")));
            }
            Cell::Text(text) if needs_quotes(text) => {
                out.push('"');
                out.push_str(&text.replace('"', "\"\""));
                out.push('"');
            }
            Cell::Text(text) => out.push_str(text),
        }
    }
    if out.len() == start {
        out.push_str("\"\""); // a blank line would be no row
    }
    out.push('\n');
    Ok(())
}

fn needs_quotes(text: &str) -> bool {
    text.contains([',', ';', '\t', '"', '#']) || text.trim() != text || text.starts_with('\u{feff}')
}
