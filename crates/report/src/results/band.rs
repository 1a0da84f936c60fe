//! `identified.csv`, and `free.csv`, which has the same columns.

use super::columns::Columns;
use frfit::identify::Status;
use frfit_formats::FormatError;

/// The columns of numbers of a frequency; beside them stand those of each unknown.
pub(super) const COLUMNS: [&str; 7] = [
    "error",
    "chi2",
    "candidate_count",
    "spectral_radius",
    "convergence_radius",
    "required_order",
    "reduction_error",
];

/// One row a frequency.
#[derive(Debug)]
pub(crate) struct Band {
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) status: Vec<Status>,
    /// Names and numbers of the columns that were asked for.
    pub(crate) numbers: Vec<(String, Vec<Option<f64>>)>,
}

impl Band {
    pub(crate) fn read(table: &Columns, columns: &[String]) -> Result<Self, FormatError> {
        let frequency_hz = table.all_numbers("frequency_hz")?;
        let at = table.column("frequency_hz")?;
        if frequency_hz.is_empty() {
            return Err(FormatError::whole("at least one frequency", "none"));
        }
        if let Some(row) = (1..frequency_hz.len()).find(|&row| frequency_hz[row] <= frequency_hz[row - 1]) {
            let found = format!("{:?} after {:?}", frequency_hz[row], frequency_hz[row - 1]);
            return Err(table.error(row, at, "ascending frequencies", found));
        }
        let column = table.column("status")?;
        let known = Status::ALL.map(|status| (status.name(), status));
        let status =
            (0..table.rows()).map(|row| table.word(row, column, &known)).collect::<Result<_, _>>()?;
        let numbers = columns.iter().map(|name| Ok((name.clone(), table.numbers(name)?)));
        let numbers = numbers.collect::<Result<_, FormatError>>()?;
        Ok(Self { frequency_hz, status, numbers })
    }

    /// The columns that were asked for.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.numbers.iter().map(|(name, _)| name.as_str())
    }

    /// A column by its name; empty where it was not asked for.
    pub(crate) fn column(&self, name: &str) -> &[Option<f64>] {
        self.numbers.iter().find(|(column, _)| column == name).map_or(&[], |(_, numbers)| numbers)
    }

    /// A number of a row.
    pub(crate) fn at(&self, name: &str, row: usize) -> Option<f64> {
        self.column(name).get(row).copied().flatten()
    }

    /// Whether a column has any number.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.column(name).iter().any(Option::is_some)
    }

    pub(crate) fn len(&self) -> usize {
        self.frequency_hz.len()
    }

    /// How many frequencies have a status.
    pub(crate) fn count(&self, status: Status) -> usize {
        self.status.iter().filter(|&&other| other == status).count()
    }

    /// The rows with a status.
    pub(crate) fn rows(&self, status: Status) -> impl Iterator<Item = usize> {
        (0..self.len()).filter(move |&row| self.status[row] == status)
    }

    /// The position of a row's status in [`Status::ALL`].
    pub(crate) fn class(&self, row: usize) -> usize {
        Status::ALL.iter().position(|&status| status == self.status[row]).unwrap_or(0)
    }
}
