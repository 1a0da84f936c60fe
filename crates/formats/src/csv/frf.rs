//! Frequency response functions: frequency_hz, re, im[, coherence][, std], and `# decay_per_s = 6` of a windowed one.

use num_complex::Complex64 as c64;

use super::Table;
use crate::FormatError;
use crate::text::{Lines, number};

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
    /// What a comment line `# decay_per_s = 6` says: the decay rate in 1/s of an exponential window on both channels.
    pub decay_per_s: Option<f64>,
}

/// Reads a frequency response function: columns frequency_hz, re, im, and coherence and std if there are any.
///
/// # Errors
/// What [`Table::read`] refuses; a column that is missing or unknown; no line of data; a negative or repeated
/// frequency; a coherence outside 0…1; a negative std; a cell that is no finite number; a comment `decay_per_s =` without a number from 0 on, or two that differ.
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
        decay_per_s: decay(bytes)?,
        coherence: optional("coherence", "a number from 0 to 1", 1.0)?,
        std: optional("std", "a number from 0 on", f64::MAX)?,
        response: order
            .iter()
            .map(|&row| Ok(c64::new(table.number(row, re)?, table.number(row, im)?)))
            .collect::<Result<_, FormatError>>()?,
    })
}

/// What comment lines `# decay_per_s = 6` say.
fn decay(bytes: &[u8]) -> Result<Option<f64>, FormatError> {
    let mut found = None;
    for line in Lines::new(bytes) {
        let Some(comment) = line.bytes.trim_ascii_start().strip_prefix(b"#") else { continue };
        let Some(said) = decay_said(comment) else { continue };
        let of_line = |expected: &str, found: String| FormatError::line(line.number, expected, found);
        let shown = || String::from_utf8_lossy(comment.trim_ascii()).into_owned();
        let value = said.ok_or_else(|| of_line(DECAY, shown()))?;
        if let Some(before) = found.replace(value).filter(|before| *before != value) {
            return Err(of_line("one decay_per_s", format!("{value} after {before}")));
        }
    }
    Ok(found)
}

const DECAY: &str = "decay_per_s = a number of 1/s from 0 on";

/// What a line of text says about the decay rate of an exponential window: `decay_per_s = 6`, in 1/s. `None` where it says nothing of it, `Some(None)` where what it says is no number from 0 on.
pub fn decay_said(text: &[u8]) -> Option<Option<f64>> {
    let rest = text.trim_ascii().strip_prefix(b"decay_per_s")?.trim_ascii_start().strip_prefix(b"=")?;
    Some(number(rest.trim_ascii()).filter(|value| *value >= 0.0))
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
