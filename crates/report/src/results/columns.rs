//! Columns of a table by their names.

use frfit_formats::FormatError;
use frfit_formats::csv::Table;

/// A table whose columns are asked for by name.
#[derive(Debug)]
pub(crate) struct Columns(Table);

/// Columns, or those of an unknown, that had another name: (old, new).
const RENAMED: [(&str, &str); 6] = [
    (".value", ".storage"),
    (".std", ".storage_std"),
    ("candidates", "candidate_count"),
    ("pole_distance", "convergence_radius"),
    ("series_order", "required_order"),
    ("certificate", "reduction_error"),
];

/// Whether a column has a name, or where that begins with a point, ends in it.
fn is_called(column: &str, name: &str) -> bool {
    column == name || (name.starts_with('.') && column.ends_with(name))
}

impl Columns {
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        let table = Table::read(bytes)?;
        match RENAMED.iter().find(|(old, _)| table.names().any(|name| is_called(name, old))) {
            Some((old, new)) => {
                let expected = format!("a column {new}, as {old} is called now: run frfit identify again");
                Err(FormatError::line(table.names_line(), expected, *old))
            }
            None => Ok(Self(table)),
        }
    }

    pub(crate) fn rows(&self) -> usize {
        self.0.rows()
    }

    pub(crate) fn column(&self, name: &str) -> Result<usize, FormatError> {
        self.0.names().position(|other| other == name).ok_or_else(|| {
            let line = self.0.names_line();
            FormatError::line(
                line,
                format!("a column {name}"),
                format!("{:?}", self.0.names().collect::<Vec<_>>()),
            )
        })
    }

    /// Numbers, `None` where a cell is empty.
    pub(crate) fn numbers(&self, name: &str) -> Result<Vec<Option<f64>>, FormatError> {
        let column = self.column(name)?;
        let cell =
            |row| if self.0.is_empty(row, column) { Ok(None) } else { self.0.number(row, column).map(Some) };
        (0..self.rows()).map(cell).collect()
    }

    /// Numbers, one in each row.
    pub(crate) fn all_numbers(&self, name: &str) -> Result<Vec<f64>, FormatError> {
        let column = self.column(name)?;
        (0..self.rows()).map(|row| self.0.number(row, column)).collect()
    }

    /// Numbers of so many rows as there are frequencies, each beside its frequency.
    pub(crate) fn at_frequencies(&self, frequency_hz: &[f64]) -> Result<(), FormatError> {
        let column = self.column("frequency_hz")?;
        if self.rows() != frequency_hz.len() {
            let expected = format!("{} rows, as identified.csv has frequencies", frequency_hz.len());
            return Err(FormatError::whole(expected, self.rows().to_string()));
        }
        for (row, expected) in frequency_hz.iter().enumerate() {
            let found = self.0.number(row, column)?;
            if found != *expected {
                return Err(self.0.error(
                    row,
                    column,
                    format!("{expected:?}, as in identified.csv"),
                    format!("{found:?}"),
                ));
            }
        }
        Ok(())
    }

    /// The word in a cell as one of several.
    pub(crate) fn word<T>(&self, row: usize, column: usize, known: &[(&str, T)]) -> Result<T, FormatError>
    where
        T: Copy,
    {
        let text = self.text(row, column);
        known.iter().find(|(word, _)| *word == text).map(|(_, value)| *value).ok_or_else(|| {
            let words = known.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
            self.error(row, column, format!("one of {words}"), format!("{text:?}"))
        })
    }

    pub(crate) fn text(&self, row: usize, column: usize) -> &str {
        self.0.text(row, column)
    }

    pub(crate) fn error(
        &self,
        row: usize,
        column: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> FormatError {
        self.0.error(row, column, expected, found)
    }
}
