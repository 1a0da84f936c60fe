//! Records of a hammer test read from files, in SI units: what [`frfit::signal`] takes.

mod raw;
mod read;
mod roles;
mod uff;

pub use roles::{ChannelOptions, Sensor};

use crate::error::{InputError, Place};
use crate::load::{InputFile, load_bytes};
use crate::reads::Reads;
use frfit::signal::Recording;
use raw::Raw;
use std::path::{Path, PathBuf};

/// The recordings of all files, in their order, and what their channels are.
#[derive(Debug, Clone, PartialEq)]
pub struct Records {
    /// What was recorded.
    pub recordings: Vec<Recording>,
    /// The file of each recording.
    pub origins: Vec<PathBuf>,
    /// The hammer.
    pub force: Sensor,
    /// The sensors, in the order of [`Recording::responses`].
    pub responses: Vec<Sensor>,
    /// The files that were read.
    pub inputs: Vec<InputFile>,
    /// Where they are, so that nothing is written over them.
    pub reads: Reads,
}

/// Reads the records of a hammer test: UFF (time functions), LabVIEW measurement files, tables with a column of time.
///
/// # Errors
/// A file that cannot be read or holds no time records; instants that are not equally spaced; no channel of force or of response, or
/// none in a known unit; an option that no channel fits.
pub fn read_records(files: &[PathBuf], options: &ChannelOptions) -> Result<Records, InputError> {
    let mut raw: Vec<Raw> = Vec::new();
    let (mut inputs, mut reads) = (Vec::new(), Reads::default());
    for path in files {
        let bytes = load_bytes(path, &mut reads)?;
        raw.extend(read::raw(path, &bytes)?);
        inputs.push(InputFile::of(path, &bytes));
    }
    let first = files.first().map_or(Path::new(""), PathBuf::as_path);
    if raw.is_empty() {
        return Err(InputError::at(&Place::file(first), "time records", "none"));
    }
    let (force, responses) = roles::roles(&raw, first, options)?;
    let recording = |raw: &Raw| Recording {
        step_s: raw.step_s,
        force: force.samples(raw),
        responses: responses.iter().map(|response| response.samples(raw)).collect(),
    };
    Ok(Records {
        recordings: raw.iter().map(recording).collect(),
        origins: raw.iter().map(|raw| raw.file.clone()).collect(),
        force,
        responses,
        inputs,
        reads,
    })
}
