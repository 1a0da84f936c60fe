//! One of several unknowns of a table, as a table of its own.

use crate::error::{InputError, Place};
use frfit_formats::csv::{Cell, Table, write};
use std::path::Path;

/// The columns of a table of moduli.
const COLUMNS: [&str; 6] =
    ["frequency_hz", "status", "storage", "loss_factor", "storage_std", "loss_factor_std"];

/// Those of them that belong to the frequency.
const SHARED: [&str; 2] = ["frequency_hz", "status"];

/// The table of the unknown `name` alone; the bytes as they are where the table has no unknown with a name, and none is asked for.
///
/// # Errors
/// A name that is missing, or that no unknown of the table has: the error lists those that there are.
pub(crate) fn table_of_unknown(
    bytes: Vec<u8>,
    name: Option<&str>,
    file: &Path,
) -> Result<Vec<u8>, InputError> {
    let table = Table::read(&bytes).map_err(|error| InputError::in_file(file, error))?;
    let column = |wanted: &str| table.names().position(|other| other == wanted);
    let unknowns: Vec<&str> = table.names().filter_map(|column| column.strip_suffix(".storage")).collect();
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
    let columns: Vec<Option<usize>> =
        COLUMNS.iter().map(|name| if SHARED.contains(name) { column(name) } else { own(name) }).collect();
    let rows = (0..table.rows()).map(|row| {
        let cell = |at: &Option<usize>| Cell::Text(at.map_or("", |at| table.text(row, at)));
        columns.iter().map(cell).collect::<Vec<_>>()
    });
    let text = write(&COLUMNS, rows).map_err(|error| InputError::in_file(file, error))?;
    Ok(text.into_bytes())
}
