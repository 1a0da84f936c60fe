//! Columns by their names.

use super::Table;
use crate::FormatError;
use crate::text::quoted;

impl Table {
    /// The column with this name (upper and lower case are the same); `None` if no column has it.
    ///
    /// # Errors
    /// Two columns with this name.
    pub fn find(&self, name: &str) -> Result<Option<usize>, FormatError> {
        let mut columns = self.names().enumerate().filter(|(_, n)| n.eq_ignore_ascii_case(name)).map(|c| c.0);
        match (columns.next(), columns.next()) {
            (_, Some(second)) => {
                Err(self.name_error(second, format!("one column {name:?}"), "a second one".into()))
            }
            (first, None) => Ok(first),
        }
    }

    /// The column with this name.
    ///
    /// # Errors
    /// No such column (the error names the one that is nearest), or two of them.
    pub fn column(&self, name: &str) -> Result<usize, FormatError> {
        self.find(name)?.ok_or_else(|| {
            let found = match nearest(name, self.names()) {
                Some(other) => format!("no such name; the nearest is {}", quoted(other.as_bytes())),
                None => format!("only {}", self.listed()),
            };
            FormatError::line(self.names_line(), format!("a column {name:?}"), found)
        })
    }

    /// Refuses a table with columns other than the known ones.
    ///
    /// # Errors
    /// The first unknown column, and the known name that is nearest to it.
    pub fn only(&self, known: &[&str]) -> Result<(), FormatError> {
        for (column, name) in self.names().enumerate() {
            if !known.iter().any(|k| k.eq_ignore_ascii_case(name)) {
                let expected = format!("one of the columns {}", known.join(", "));
                let hint = nearest(name, known.iter().copied())
                    .map_or(String::new(), |near| format!("; did you mean {near:?}?"));
                let found = match name {
                    "" => "a column without a name".into(),
                    _ => format!("{}{hint}", quoted(name.as_bytes())),
                };
                return Err(self.name_error(column, expected, found));
            }
        }
        Ok(())
    }

    /// The first few names, for an error.
    pub(super) fn listed(&self) -> String {
        const MAX_SHOWN: usize = 8;
        let names = || self.names().filter(|name| !name.is_empty());
        let shown: Vec<_> = names().take(MAX_SHOWN).map(|name| quoted(name.as_bytes())).collect();
        match shown.as_slice() {
            [] => "columns without names".into(),
            _ => {
                format!("{}{}", shown.join(", "), if names().nth(MAX_SHOWN).is_some() { ", ..." } else { "" })
            }
        }
    }

    /// Refuses a table without rows.
    pub(super) fn at_least_one_row(&self) -> Result<(), FormatError> {
        match self.rows() {
            0 => {
                Err(FormatError::line(self.names_line(), "at least one line of data below the names", "none"))
            }
            _ => Ok(()),
        }
    }
}

/// The name nearest to another by edit distance, if any is near at all.
pub(super) fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    let distance = |other: &str| strsim::levenshtein(&name.to_ascii_lowercase(), &other.to_ascii_lowercase());
    names
        .filter(|other| !other.is_empty() && other.len() <= LONGEST && name.len() <= LONGEST)
        .map(|other| (distance(other), other))
        // At least a third of the letters have to agree.
        .filter(|(distance, other)| 3 * distance <= 2 * other.chars().count().max(name.chars().count()))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, other)| other)
}
