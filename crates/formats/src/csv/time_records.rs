//! Time records: a column of time in seconds, and one a channel with its unit in brackets.

use super::Table;
use crate::FormatError;
use crate::text::quoted;

/// Channels that were recorded at the same instants.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeTable {
    /// Instants in seconds, strictly ascending.
    pub time_s: Vec<f64>,
    /// The other columns in the order of the file; at least one.
    pub channels: Vec<TimeChannel>,
}

/// A channel of a table of time records.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeChannel {
    /// The name of its column without the unit.
    pub name: String,
    /// What the brackets hold at the end of the column's name: `N` of `Force (N)` or `Force [N]`; empty without brackets.
    pub unit: String,
    /// One sample an instant.
    pub values: Vec<f64>,
}

/// The names that the column of time may have, a unit of seconds in brackets aside.
const TIME: [&str; 3] = ["time_s", "time", "t"];

/// Reads time records: a column time_s (or `time`, `t`, `Time (s)`, `time [s]`), and channels.
///
/// # Errors
/// What [`Table::read`] refuses; no column of time, or one that is not in seconds; no channel; no line of data; instants that do
/// not ascend; a cell that is no finite number.
pub fn read_time_records(bytes: &[u8]) -> Result<TimeTable, FormatError> {
    let table = Table::read(bytes)?;
    let names: Vec<(String, String)> = table.names().map(name_and_unit).collect();
    let is_time = |(name, _): &(String, String)| TIME.iter().any(|time| name.eq_ignore_ascii_case(time));
    let Some(time) = names.iter().position(is_time) else {
        let found: Vec<String> = table.names().take(8).map(|name| quoted(name.as_bytes())).collect();
        return Err(FormatError::line(table.names_line(), "a column \"time_s\"", found.join(", ")));
    };
    if !matches!(names[time].1.as_str(), "" | "s" | "sec" | "seconds") {
        let found = quoted(names[time].1.as_bytes());
        return Err(table.name_error(time, "a time in s".into(), found));
    }
    if names.len() < 2 {
        return Err(FormatError::line(table.names_line(), "at least one column beside the time", "none"));
    }
    table.at_least_one_row()?;
    let column = |column: usize| -> Result<Vec<f64>, FormatError> {
        (0..table.rows()).map(|row| table.number(row, column)).collect()
    };
    let time_s = column(time)?;
    if let Some(row) = (1..time_s.len()).find(|&row| time_s[row] <= time_s[row - 1]) {
        let found = format!("{} after {}", time_s[row], time_s[row - 1]);
        return Err(table.error(row, time, "ascending instants", found));
    }
    let others = names.into_iter().enumerate().filter(|(k, _)| *k != time);
    let channels = others
        .map(|(k, (name, unit))| Ok(TimeChannel { name, unit, values: column(k)? }))
        .collect::<Result<_, FormatError>>()?;
    Ok(TimeTable { time_s, channels })
}

/// `Force (N)` as `Force` and `N`.
pub(super) fn name_and_unit(name: &str) -> (String, String) {
    let inside = |open: char, close: char| {
        let (name, unit) = name.strip_suffix(close)?.rsplit_once(open)?;
        Some((name.trim().to_owned(), unit.trim().to_owned()))
    };
    inside('(', ')').or_else(|| inside('[', ']')).unwrap_or_else(|| (name.to_owned(), String::new()))
}
