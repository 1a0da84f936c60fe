//! Dataset 164.

use crate::FormatError;
use crate::uff::units::Units;

use super::DELIMITER;
use super::fixed::{integer, real, text};

/// Units as dataset 164, factors with 17 significant digits, which is all they have.
///
/// # Errors
///
/// The description has more than 20 characters, or a code does not fit its columns.
pub fn units(units: &Units) -> Result<Vec<u8>, FormatError> {
    let code = integer(units.code.into(), 10, "a code of units")?;
    let description = text(&units.description, 20, "a description of units")?;
    let mode = integer(units.temperature_mode.into(), 10, "a temperature mode")?;
    let factors = [units.length, units.force, units.temperature, units.temperature_offset];
    let [length, force, temperature, offset] = factors.map(|factor| real(factor, 25, 16).replace('E', "D"));
    let first = format!("{code}{description}{mode}");
    let body = format!("{first}\n{length}{force}{temperature}\n{offset}\n");
    Ok(format!("{DELIMITER}{:6}\n{body}{DELIMITER}", 164).into_bytes())
}
