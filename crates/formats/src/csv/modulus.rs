//! Tables of a complex modulus: frequency_hz, storage, and loss_factor or loss.

use num_complex::Complex64 as c64;

use super::Table;
use super::frf::ascending_frequencies;
use crate::FormatError;

/// A complex modulus E′ + iE″ over frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct ModulusTable {
    /// Frequencies in hertz, strictly ascending.
    pub frequency_hz: Vec<f64>,
    /// E′ + iE″ at each frequency, in the unit of the table.
    pub modulus: Vec<c64>,
}

/// Reads a table of a modulus: columns frequency_hz, storage (E′), and either loss_factor (η = E″/E′) or loss
/// (E″). Other columns are passed over, so that an `identified.csv` can be read; rows in which both
/// cells of the modulus are empty (no answer at this frequency) are left out.
///
/// # Errors
/// What [`Table::read`] refuses; a column that is missing, or both loss_factor and loss; no row with a modulus;
/// a negative or repeated frequency; a cell that is no finite number.
pub fn read_modulus(bytes: &[u8]) -> Result<ModulusTable, FormatError> {
    let table = Table::read(bytes)?;
    let (frequency, storage) = (table.column("frequency_hz")?, table.column("storage")?);
    let (loss, is_factor) = match (table.find("loss_factor")?, table.find("loss")?) {
        (Some(_), Some(second)) => {
            let found = "a second one".into();
            return Err(table.name_error(second, "one of the columns loss_factor and loss".into(), found));
        }
        (None, Some(loss)) => (loss, false),
        _ => (table.column("loss_factor")?, true),
    };
    let rows = (0..table.rows()).filter(|&row| !(table.is_empty(row, storage) && table.is_empty(row, loss)));
    let (frequency_hz, order) = ascending_frequencies(&table, frequency, rows)?;
    if order.is_empty() {
        let expected = "at least one line with a modulus below the names";
        return Err(FormatError::line(table.names_line(), expected, "none"));
    }
    let modulus = order.into_iter().map(|row| {
        let (re, loss_value) = (table.number(row, storage)?, table.number(row, loss)?);
        let im = if is_factor { re * loss_value } else { loss_value };
        match im.is_finite() {
            true => Ok(c64::new(re, im)),
            false => Err(table.error(row, loss, "a finite storage * loss_factor", im.to_string())),
        }
    });
    Ok(ModulusTable { modulus: modulus.collect::<Result<_, FormatError>>()?, frequency_hz })
}
