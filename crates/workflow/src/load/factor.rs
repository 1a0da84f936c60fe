//! Factors and their tables.

use super::files::Files;
use crate::case::{FactorEntry, Located};
use crate::error::{InputError, Place};
use frfit::material::{Law, Table};
use frfit_formats::{FormatError, csv};

/// The law of a factor, its table read.
pub(super) fn law(factor: &Located<FactorEntry>, files: &mut Files) -> Result<Law, InputError> {
    let name = match &factor.value {
        FactorEntry::Law(law) => return Ok(law.clone()),
        FactorEntry::Table(name) => name,
    };
    let file = files.read(name)?;
    let table = csv::read_modulus(&file.bytes).map_err(|error| file.refuse(error))?;
    let table = Table::new(table.frequency_hz, table.modulus);
    // The reader leaves one thing unchecked: the table interpolates over log ω, and cannot begin at zero.
    table.map(Law::Table).map_err(|_| file.refuse(FormatError::whole("frequencies above 0 Hz", "0 Hz")))
}

/// Refuses a law without a finite value at one of the frequencies.
pub(super) fn covers(law: &Law, place: &Place, frequencies_hz: &[f64]) -> Result<(), InputError> {
    for &frequency_hz in frequencies_hz {
        let found = match law.at(frequency_hz) {
            Ok(value) if value.is_finite() => continue,
            Ok(value) => value.to_string(),
            Err(outside) => outside.to_string(),
        };
        return Err(InputError::at(place, format!("a factor with a value at {frequency_hz} Hz"), found));
    }
    Ok(())
}
