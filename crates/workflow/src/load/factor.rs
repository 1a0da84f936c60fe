//! Factors and their tables.

use super::dimension::PartOf;
use super::files::Files;
use crate::case::{CaseFile, FactorEntry, Located};
use crate::error::{InputError, Place};
use frfit::material::{Law, Table};
use frfit::model::DynamicStiffness;
use frfit_formats::{FormatError, csv};
use frfit_linalg::sparse::Values;

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

/// Sizes of numbers that can be computed with: squares of them, and sums of some thousand of these, are numbers still, and so are their inverses.
const SIZES: [f64; 2] = [1e-100, 1e100];

/// Refuses matrices of which the norm of a vector would be infinite, or zero: every answer would be lost, for a reason that its status does not show.
pub(super) fn sizes(
    case: &CaseFile,
    model: &DynamicStiffness,
    of: &[PartOf],
    frequencies_hz: &[f64],
) -> Result<(), InputError> {
    let Some(&frequency_hz) = frequencies_hz.first() else { return Ok(()) };
    let mut largest: Option<(f64, &str)> = None;
    for (term, part) in model.terms().iter().zip(of) {
        let entry = match term.matrix.values() {
            Values::Real(values) => values.iter().map(|value| value.abs()).fold(0.0, f64::max),
            Values::Complex(values) => values.iter().map(|value| value.norm()).fold(0.0, f64::max),
        };
        let size = entry * term.factor.at(frequency_hz).map_or(0.0, |factor| factor.norm());
        if largest.is_none_or(|(other, _)| size > other) {
            largest = Some((size, &part.matrix));
        }
    }
    let Some((size, name)) = largest.filter(|&(size, _)| size > 0.0) else { return Ok(()) };
    if (SIZES[0]..=SIZES[1]).contains(&size) {
        return Ok(());
    }
    let place = case.matrices.iter().find(|entry| entry.name.value == name);
    let place = place.map_or_else(|| Place::option("matrix"), |entry| entry.factor.place.clone());
    let expected = format!(
        "matrices whose largest entry with its factor is from {:e} to {:e}, in some units",
        SIZES[0], SIZES[1]
    );
    Err(InputError::at(&place, expected, format!("{size:.1e} in matrix {name:?}")))
}
