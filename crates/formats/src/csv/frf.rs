//! Frequency response functions: frequency_hz, re, im[, coherence][, std].

use num_complex::Complex64 as c64;

use super::Table;
use crate::FormatError;

/// A measured frequency response function, sorted by frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfTable {
    /// Frequencies in hertz, strictly ascending.
    pub frequency_hz: Vec<f64>,
    /// The complex response at each frequency.
    pub response: Vec<c64>,
    /// Coherence γ² of each value, from 0 to 1.
    pub coherence: Option<Vec<f64>>,
    /// Standard deviation of each complex value, √E|δH|².
    pub std: Option<Vec<f64>>,
}

/// Reads a frequency response function: columns frequency_hz, re, im, and coherence and std if there are any.
///
/// # Errors
/// What [`Table::read`] refuses; a column that is missing or unknown; no line of data; a negative or repeated
/// frequency; a coherence outside 0…1; a negative std; a cell that is no finite number.
pub fn read_frf(bytes: &[u8]) -> Result<FrfTable, FormatError> {
    let table = Table::read(bytes)?;
    table.only(&["frequency_hz", "re", "im", "coherence", "std"])?;
    let (frequency, re, im) = (table.column("frequency_hz")?, table.column("re")?, table.column("im")?);
    table.at_least_one_row()?;
    let (frequency_hz, order) = ascending_frequencies(&table, frequency, 0..table.rows())?;
    let optional = |name: &str, expected: &str, most: f64| match table.find(name)? {
        Some(column) => order
            .iter()
            .map(|&row| checked(&table, row, column, expected, |x| (0.0..=most).contains(&x)))
            .collect::<Result<Vec<_>, _>>()
            .map(Some),
        None => Ok(None),
    };
    Ok(FrfTable {
        frequency_hz,
        coherence: optional("coherence", "a number from 0 to 1", 1.0)?,
        std: optional("std", "a number from 0 on", f64::MAX)?,
        response: order
            .iter()
            .map(|&row| Ok(c64::new(table.number(row, re)?, table.number(row, im)?)))
            .collect::<Result<_, FormatError>>()?,
    })
}

/// The frequencies of some rows in ascending order, and the rows in that order.
pub(super) fn ascending_frequencies(
    table: &Table,
    column: usize,
    rows: impl Iterator<Item = usize>,
) -> Result<(Vec<f64>, Vec<usize>), FormatError> {
    let mut order = rows
        .map(|row| Ok((checked(table, row, column, "a number from 0 on", |x| x >= 0.0)?, row)))
        .collect::<Result<Vec<_>, FormatError>>()?;
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    for pair in order.windows(2) {
        if pair[0].0 == pair[1].0 {
            let (first, second) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
            let found = format!("{} again, first in line {}", table.shown(second, column), table.line(first));
            return Err(table.error(second, column, "each frequency once", found));
        }
    }
    Ok(order.into_iter().unzip())
}

/// A number with a property.
pub(super) fn checked(
    table: &Table,
    row: usize,
    column: usize,
    expected: &str,
    is_good: impl Fn(f64) -> bool,
) -> Result<f64, FormatError> {
    let value = table.number(row, column)?;
    match is_good(value) {
        true => Ok(value),
        false => Err(table.error(row, column, expected, table.shown(row, column))),
    }
}
