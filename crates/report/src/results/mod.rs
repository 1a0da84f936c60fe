//! The files of an identification, read and checked.

mod band;
mod candidates;
mod columns;
mod error_map;
mod identifiability;
mod sensors;
mod summary;
mod unknown;

pub(crate) use band::Band;
pub(crate) use candidates::{Candidates, Verdict};
pub(crate) use error_map::ErrorMap;
pub(crate) use identifiability::Identifiability;
pub(crate) use sensors::Sensor;
pub(crate) use summary::Summary;
pub(crate) use unknown::{Number, Unknown};

use frfit_formats::FormatError;
use std::path::Path;

pub(crate) const SUMMARY: &str = "summary.json";
pub(crate) const IDENTIFIED: &str = "identified.csv";
pub(crate) const RESPONSE: &str = "response.csv";
pub(crate) const CANDIDATES: &str = "candidates.csv";
pub(crate) const REFERENCE: &str = "reference.csv";
pub(crate) const FREE: &str = "free.csv";
pub(crate) const ERROR_MAP: &str = "error_map.csv";

/// Everything that a page shows.
#[derive(Debug)]
pub(crate) struct Results {
    pub(crate) summary: Summary,
    /// At least one.
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) identifiability: Identifiability,
    pub(crate) band: Band,
    pub(crate) sensors: Vec<Sensor>,
    pub(crate) candidates: Candidates,
    /// What each frequency alone gives, where a law or a smooth curve answers.
    pub(crate) free: Option<Band>,
    /// ε over frequency and order, of the series.
    pub(crate) error_map: Option<ErrorMap>,
}

impl Results {
    /// Reads the summary, and the tables that it names: files of another run in the folder are not read.
    pub(crate) fn read(file: &dyn Fn(&str) -> Option<Vec<u8>>) -> Result<Self, FormatError> {
        let summary = of(SUMMARY, bytes(file, SUMMARY).and_then(|bytes| Summary::read(&bytes)))?;
        let tables = of(SUMMARY, summary.tables())?;
        let table =
            |name: &'static str| of(name, bytes(file, name).and_then(|bytes| columns::Columns::read(&bytes)));
        let named =
            |name: &'static str| tables.iter().any(|table| table == name).then(|| table(name)).transpose();
        let mut unknowns = of(SUMMARY, Unknown::read(&summary))?;
        let columns = band::COLUMNS.map(str::to_owned).into_iter();
        let columns: Vec<String> = columns.chain(unknowns.iter().flat_map(Unknown::columns)).collect();
        let band = of(IDENTIFIED, Band::read(&table(IDENTIFIED)?, &columns))?;
        let sensors = of(SUMMARY, summary.sensors())?;
        let sensors = of(RESPONSE, Sensor::read(&table(RESPONSE)?, &sensors, &band.frequency_hz))?;
        let reference = table(REFERENCE)?;
        of(REFERENCE, reference.at_frequencies(&band.frequency_hz))?;
        of(REFERENCE, unknowns.iter_mut().try_for_each(|one| one.compare(&reference)))?;
        let read_free = |table| of(FREE, Band::read(&table, &columns));
        let read_map = |table| of(ERROR_MAP, ErrorMap::read(&table));
        Ok(Self {
            identifiability: of(SUMMARY, Identifiability::read(&summary))?,
            candidates: of(CANDIDATES, Candidates::read(&table(CANDIDATES)?, &unknowns))?,
            free: named(FREE)?.map(read_free).transpose()?,
            error_map: named(ERROR_MAP)?.map(read_map).transpose()?,
            summary,
            unknowns,
            band,
            sensors,
        })
    }

    /// Whether the search settled.
    pub(crate) fn converged(&self) -> bool {
        self.summary.0.pointer("/search/converged") != Some(&serde_json::Value::Bool(false))
    }

    /// The curves over frequency, and what is behind their plots' names.
    pub(crate) fn curves(&self) -> impl Iterator<Item = (String, usize, &Unknown)> {
        let all = self.unknowns.iter().enumerate().filter(|(_, one)| one.is_curve()).enumerate();
        all.map(|(k, (j, one))| {
            let suffix = if self.unknowns.len() == 1 { String::new() } else { format!("-{}", k + 1) };
            (suffix, j, one)
        })
    }
}

fn bytes(file: &dyn Fn(&str) -> Option<Vec<u8>>, name: &str) -> Result<Vec<u8>, FormatError> {
    file(name)
        .ok_or_else(|| FormatError::whole("this file, as frfit identify of this version writes it", "none"))
}

/// The error with the name of the file.
fn of<T>(name: &str, result: Result<T, FormatError>) -> Result<T, FormatError> {
    result.map_err(|error| error.in_file(Path::new(name)))
}
