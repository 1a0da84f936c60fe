//! `reference.csv`: what the identified factor is compared with.

use super::columns::Columns;
use frfit::c64;
use frfit_formats::FormatError;

/// Factors by frequency, in the order of `identified.csv`.
#[derive(Debug)]
pub(crate) struct Reference {
    pub(crate) nominal: Vec<Option<c64>>,
    /// Where the case tells it.
    pub(crate) reference: Vec<Option<c64>>,
}

impl Reference {
    pub(crate) fn read(table: &Columns, frequency_hz: &[f64]) -> Result<Self, FormatError> {
        table.at_frequencies(frequency_hz)?;
        Ok(Self { nominal: factors(table, "nominal")?, reference: factors(table, "true")? })
    }

    /// Nothing to compare with.
    pub(crate) fn none(frequencies: usize) -> Self {
        Self { nominal: vec![None; frequencies], reference: vec![None; frequencies] }
    }
}

/// Columns `<what>_re` and `<what>_im`.
pub(super) fn factors(table: &Columns, what: &str) -> Result<Vec<Option<c64>>, FormatError> {
    let re = table.numbers(&format!("{what}_re"))?;
    let im = table.numbers(&format!("{what}_im"))?;
    Ok(re.into_iter().zip(im).map(|(re, im)| Some(c64::new(re?, im?))).collect())
}
