//! The files of an identification, read and checked.

mod band;
mod candidates;
mod columns;
mod error_map;
mod reference;
mod sensors;
mod several;
mod summary;

pub(crate) use band::Band;
pub(crate) use candidates::{Candidates, Verdict};
pub(crate) use error_map::ErrorMap;
pub(crate) use reference::Reference;
pub(crate) use sensors::Sensor;
pub(crate) use several::{Number, Several, Unknown};
pub(crate) use summary::Summary;

use frfit_formats::{FormatError, Position};
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
    pub(crate) band: Band,
    pub(crate) sensors: Vec<Sensor>,
    pub(crate) candidates: Candidates,
    pub(crate) reference: Reference,
    /// What each frequency says by itself, where a law or a smooth curve answers.
    pub(crate) free: Option<Band>,
    /// ε over frequency and order, of the series.
    pub(crate) error_map: Option<ErrorMap>,
    /// Where several things were unknown, or one that does not vary: then there are no candidates, and the reference is each unknown's own.
    pub(crate) several: Option<Several>,
}

impl Results {
    /// Reads the summary, and the tables that it names: what another run has left in the folder is none of them.
    pub(crate) fn read(file: &dyn Fn(&str) -> Option<Vec<u8>>) -> Result<Self, FormatError> {
        let summary = of(SUMMARY, bytes(file, SUMMARY).and_then(|bytes| Summary::read(&bytes)))?;
        let tables = of(SUMMARY, summary.tables())?;
        let table =
            |name: &'static str| of(name, bytes(file, name).and_then(|bytes| columns::Columns::read(&bytes)));
        let named =
            |name: &'static str| tables.iter().any(|table| table == name).then(|| table(name)).transpose();
        let identified = table(IDENTIFIED)?;
        let is_several = summary.is_several();
        let columns = match is_several {
            true => Several::columns(&summary),
            false => band::COLUMNS.map(str::to_owned).to_vec(),
        };
        let band = of(IDENTIFIED, Band::read(&identified, &columns))?;
        let sensors = of(SUMMARY, summary.sensors())?;
        let response = table(RESPONSE)?;
        let sensors = of(RESPONSE, Sensor::read(&response, &sensors, &band.frequency_hz))?;
        if is_several {
            let reference = table(REFERENCE)?;
            of(REFERENCE, reference.at_frequencies(&band.frequency_hz))?;
            let several = Several::read(&summary, &reference).map_err(|error| match error.position {
                // What is wrong with the table has a place in it.
                Position::File => error.in_file(Path::new(SUMMARY)),
                _ => error.in_file(Path::new(REFERENCE)),
            })?;
            return Ok(Self {
                candidates: Candidates::default(),
                reference: Reference::none(band.len()),
                free: None,
                error_map: None,
                several: Some(several),
                summary,
                band,
                sensors,
            });
        }
        let candidates = of(CANDIDATES, Candidates::read(&table(CANDIDATES)?))?;
        let reference = of(REFERENCE, Reference::read(&table(REFERENCE)?, &band.frequency_hz))?;
        let free = match named(FREE)? {
            Some(table) => Some(of(FREE, Band::read(&table, &columns))?),
            None => None,
        };
        let error_map = match named(ERROR_MAP)? {
            Some(table) => Some(of(ERROR_MAP, ErrorMap::read(&table))?),
            None => None,
        };
        Ok(Self { summary, band, sensors, candidates, reference, free, error_map, several: None })
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
