//! One of several unknowns of a table, as a table of its own.

use crate::error::{InputError, Place};
use frfit_formats::csv::{Cell, Table, write};
use std::path::Path;

/// The columns of a table of moduli.
const COLUMNS: [&str; 6] =
    ["frequency_hz", "status", "storage", "loss_factor", "storage_std", "loss_factor_std"];

/// The table of the unknown `name` alone; the bytes as they are where the table has no unknown with a name, and none is asked for.
///
/// # Errors
/// A name that is missing, or that no unknown of the table has: the error lists those that there are.
pub(super) fn of_unknown(bytes: Vec<u8>, name: Option<&str>, file: &Path) -> Result<Vec<u8>, InputError> {
    let table = Table::read(&bytes).map_err(|error| InputError::in_file(file, error))?;
    let column = |wanted: &str| table.names().position(|other| other == wanted);
    let unknowns: Vec<&str> = table
        .names()
        .filter_map(|column| column.strip_suffix(".storage").or(column.strip_suffix(".value")))
        .collect();
    let place = Place::option("--unknown");
    let listed = || unknowns.iter().map(|one| format!("{one:?}")).collect::<Vec<_>>().join(", ");
    let name = match name {
        None if unknowns.is_empty() => return Ok(bytes),
        Some(name) if unknowns.contains(&name) => name,
        found => {
            let expected = match unknowns.is_empty() {
                true => format!("no name: {} has one unknown", file.display()),
                false => format!("one of {}, the unknowns of {}", listed(), file.display()),
            };
            let found = found.map_or("none".to_owned(), |name| format!("{name:?}"));
            return Err(InputError::at(&place, expected, found));
        }
    };
    let own = |part: &str| column(&format!("{name}.{part}"));
    let real = own("value").is_some();
    let parts = match real {
        true => [own("value"), None, None, None],
        false => ["storage", "loss_factor", "storage_std", "loss_factor_std"].map(own),
    };
    let fixed = ["frequency_hz", "status"].map(column);
    let rows = (0..table.rows()).map(|row| {
        let cell = |at: Option<usize>| Cell::Text(at.map_or("", |at| table.text(row, at)));
        let mut cells: Vec<Cell<'_>> = fixed.into_iter().chain(parts).map(cell).collect();
        if real && !table.is_empty(row, parts[0].unwrap_or(0)) {
            // A real modulus has no loss.
            cells[3] = Cell::Text("0");
        }
        cells
    });
    let text = write(&COLUMNS, rows).map_err(|error| InputError::in_file(file, error))?;
    Ok(text.into_bytes())
}
