//! The recordings of a file of any kind.

use super::raw::{Raw, RawChannel, common_step_s, step_s};
use super::uff;
use crate::error::InputError;
use crate::terminal::one_line;
use frfit_formats::lvm::{self, Abscissa};
use frfit_formats::{FileKind, FormatError, csv, detect};
use std::path::Path;

pub(super) fn raw(path: &Path, bytes: &[u8]) -> Result<Vec<Raw>, InputError> {
    let in_file = |error| InputError::in_file(path, error);
    let found = match detect(bytes) {
        Some(FileKind::Uff) => return uff::raw(path, bytes),
        Some(FileKind::Lvm) => return of_lvm(path, bytes),
        Some(FileKind::Csv) => return of_table(path, bytes).map(|raw| vec![raw]),
        Some(other) => other.to_string(),
        None if bytes.is_empty() => "an empty file".into(),
        None => "none of them".into(),
    };
    let expected = "time records: a UFF file, a LabVIEW measurement file (.lvm) or a table (CSV)";
    Err(in_file(FormatError::whole(expected, found)))
}

/// One recording a segment.
fn of_lvm(path: &Path, bytes: &[u8]) -> Result<Vec<Raw>, InputError> {
    let file = lvm::read(bytes).map_err(|error| InputError::in_file(path, error))?;
    let raw = |segment: lvm::Segment| {
        let step = |channel: &lvm::Channel| match &channel.abscissa {
            Abscissa::Even { step, .. } => Ok(*step),
            Abscissa::Listed(instants) => step_s(instants).map_err(|error| FormatError {
                position: frfit_formats::Position::Line { line: segment.line, column: None },
                ..error
            }),
        };
        let step_s = common_step_s(path, segment.channels.iter().map(step))?;
        let channel = |channel: lvm::Channel| RawChannel {
            name: one_line(&channel.name).into_owned(),
            unit: channel.unit,
            said: None,
            dof: None,
            samples: channel.values,
        };
        let channels = segment.channels.into_iter().map(channel).collect();
        Ok(Raw { file: path.to_path_buf(), step_s, channels })
    };
    file.segments.into_iter().map(raw).collect()
}

fn of_table(path: &Path, bytes: &[u8]) -> Result<Raw, InputError> {
    let in_file = |error| InputError::in_file(path, error);
    let table = csv::read_time_records(bytes).map_err(in_file)?;
    let channel = |channel: csv::TimeChannel| RawChannel {
        name: one_line(&channel.name).into_owned(),
        unit: channel.unit,
        said: None,
        dof: None,
        samples: channel.values,
    };
    Ok(Raw {
        file: path.to_path_buf(),
        step_s: step_s(&table.time_s).map_err(in_file)?,
        channels: table.channels.into_iter().map(channel).collect(),
    })
}
