//! Tables of a measured modulus, row by row, with what is said of each.

use super::Table;
use super::frf::{ascending_frequencies, checked};
use super::modulus_data::Columns;
use crate::FormatError;

/// A modulus at one frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct ModulusRow {
    /// Hertz.
    pub frequency_hz: f64,
    /// E′ in pascal, or in the unit of the table where it names none.
    pub storage: f64,
    /// η = E″/E′.
    pub loss_factor: f64,
    /// Standard deviations of E′ and η, where the table has both.
    pub std: Option<[f64; 2]>,
    /// The status; empty in a table without any.
    pub status: String,
}

/// The rows of a table, those with a modulus and those without.
#[derive(Debug, Clone, PartialEq)]
pub struct ModulusRows {
    /// Those with a modulus, by frequency, strictly ascending.
    pub answered: Vec<ModulusRow>,
    /// Frequency in hertz and status of those without, in the order of the table.
    pub empty: Vec<(f64, String)>,
    /// Whether the table names its unit of E′, which then is in pascal.
    pub names_unit: bool,
}

/// Reads every row of a table of a measured modulus, whatever its status; names and units are those of [`read_modulus_data`](super::read_modulus_data).
///
/// # Errors
/// What [`Table::read`] refuses; a column that is missing, or given twice under two names; an unknown unit; a repeated frequency; a cell that is no finite number; a negative standard deviation.
pub fn read_modulus_rows(bytes: &[u8]) -> Result<ModulusRows, FormatError> {
    let table = Table::read(bytes)?;
    let columns = Columns::of(&table)?;
    let Columns { frequency, storage, loss, is_factor, .. } = columns;
    let is_empty = |row: usize| table.is_empty(row, storage) && table.is_empty(row, loss);
    let status = |row: usize| columns.status.map_or("", |column| table.text(row, column)).to_owned();
    let all = columns.first..table.rows();
    let empty = all.clone().filter(|&row| is_empty(row));
    let empty = empty.map(|row| Ok((columns.hz * table.number(row, frequency)?, status(row))));
    let empty = empty.collect::<Result<_, FormatError>>()?;
    let (frequency_hz, order) = ascending_frequencies(&table, frequency, all.filter(|&row| !is_empty(row)))?;
    let answered = frequency_hz.into_iter().zip(order).map(|(f, row)| {
        let e = columns.pascal * table.number(row, storage)?;
        let value = table.number(row, loss)?;
        let deviation = |column| checked(&table, row, column, "a number from 0 on", |x| x >= 0.0);
        let std = match columns.deviations {
            Some([a, b]) if !table.is_empty(row, a) && !table.is_empty(row, b) => {
                Some([columns.pascal * deviation(a)?, deviation(b)?])
            }
            _ => None,
        };
        let loss_factor = if is_factor { value } else { columns.loss_unit * value / e };
        if !loss_factor.is_finite() {
            return Err(table.error(row, loss, "a finite loss / storage", loss_factor.to_string()));
        }
        Ok(ModulusRow { frequency_hz: columns.hz * f, storage: e, loss_factor, std, status: status(row) })
    });
    let names_unit = columns.first > 0;
    Ok(ModulusRows { answered: answered.collect::<Result<_, FormatError>>()?, empty, names_unit })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_told_with_its_status() {
        let text = "frequency_hz,storage,loss_factor,status,storage_std,loss_factor_std\nHz,MPa,1,,MPa,1\n\
                    20,2,0.1,ok,0.5,0.01\n10,1,0.2,ambiguous,,\n30,,,no_root,,\n";
        let rows = read_modulus_rows(text.as_bytes()).unwrap();
        let row = |frequency_hz, storage, loss_factor, std, status: &str| ModulusRow {
            frequency_hz,
            storage,
            loss_factor,
            std,
            status: status.into(),
        };
        let second = row(20.0, 2e6, 0.1, Some([5e5, 0.01]), "ok");
        assert_eq!(rows.answered, [row(10.0, 1e6, 0.2, None, "ambiguous"), second]);
        assert_eq!(rows.empty, [(30.0, "no_root".into())]);
        assert!(rows.names_unit);
    }

    #[test]
    fn broken_rows_are_refused_at_their_place() {
        for (text, expected) in [
            ("f,storage,eta\n1,2,x\n", "input:2:5: expected a finite number in column \"eta\", found \"x\""),
            (
                "f,storage,loss\n1,0,3\n",
                "input:2:5: expected a finite loss / storage in column \"loss\", found inf",
            ),
            (
                "f,storage,eta,storage_std,loss_factor_std\n1,2,3,-1,1\n",
                "input:2:7: expected a number from 0 on in column \"storage_std\", found \"-1\"",
            ),
        ] {
            assert_eq!(read_modulus_rows(text.as_bytes()).unwrap_err().to_string(), expected);
        }
    }
}
