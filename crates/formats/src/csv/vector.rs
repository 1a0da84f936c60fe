//! Sparse vectors such as a load: row, re[, im].

use num_complex::Complex64 as c64;

use super::Table;
use crate::FormatError;

/// Reads a vector: columns row (from 1), re, and im if there is one; in the order of the file.
///
/// # Errors
/// What [`Table::read`] refuses; a column that is missing or unknown; no line of data; row 0; a row given
/// twice; a cell that is no finite number.
pub fn read_vector(bytes: &[u8]) -> Result<Vec<(usize, c64)>, FormatError> {
    let table = Table::read(bytes)?;
    table.only(&["row", "re", "im"])?;
    let (row, re, im) = (table.column("row")?, table.column("re")?, table.find("im")?);
    table.at_least_one_row()?;
    let rows = distinct_rows(&table, row)?;
    let imaginary = |k| im.map_or(Ok(0.0), |im| table.number(k, im));
    rows.into_iter()
        .enumerate()
        .map(|(k, row)| Ok((row, c64::new(table.number(k, re)?, imaginary(k)?))))
        .collect()
}

/// The column with row numbers from 1, each of them once.
pub(super) fn distinct_rows(table: &Table, column: usize) -> Result<Vec<usize>, FormatError> {
    let rows = (0..table.rows())
        .map(|k| {
            let row = table.whole(k, column, 1)?;
            let beyond = || table.error(k, column, "a row number that fits this machine", row.to_string());
            usize::try_from(row).map_err(|_| beyond())
        })
        .collect::<Result<Vec<_>, _>>()?;
    once(table, column, &rows, "each row once")?;
    Ok(rows)
}

/// Refuses keys (one for each row of the table) that are given twice.
pub(super) fn once<K: Ord>(
    table: &Table,
    column: usize,
    keys: &[K],
    expected: &str,
) -> Result<(), FormatError> {
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by_key(|&k| &keys[k]);
    match order.windows(2).find(|pair| keys[pair[0]] == keys[pair[1]]) {
        Some(&[first, second]) => {
            let found = format!("{} again, first in line {}", table.shown(second, column), table.line(first));
            Err(table.error(second, column, expected, found))
        }
        _ => Ok(()),
    }
}
