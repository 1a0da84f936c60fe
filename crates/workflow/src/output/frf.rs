//! Responses as other programs read them: UFF.

use crate::convert::frf_dataset;
use crate::load::{Case, SensorInfo, decay_line};
use crate::run::{IdentifyRun, RespondRun};
use frfit::c64;
use frfit::dof::DofName;
use frfit_formats::FormatError;
use frfit_formats::uff::{Dof, Endian, Form, FunctionHeader, Units, write};

/// `frf.uff`, a forward response: units and one binary dataset 58 per sensor, every value bit for bit; frequencies without an answer are left out.
///
/// Under a window of the measurements an ID line says so, as in an FRF of [`measured_uff`](super::measured_uff). A sensor without a name is the node of its row, without direction.
///
/// # Errors
/// [`FormatError`] where a node label does not fit the format.
pub fn respond_uff(case: &Case, run: &RespondRun) -> Result<Vec<u8>, FormatError> {
    let receptance = |row: usize, m: usize| run.receptance[row].as_ref().ok()?.get(m).copied();
    responses(case, &run.frequency_hz, &receptance, "")
}

/// `updated.uff`, the response with the identified factor, in the same form; a sensor without any answer has no dataset.
///
/// # Errors
/// As [`respond_uff`].
pub fn updated_uff(case: &Case, run: &IdentifyRun) -> Result<Vec<u8>, FormatError> {
    let frequency_hz: Vec<f64> = run.found.lines.iter().map(|line| line.frequency_hz).collect();
    let receptance = |row: usize, m: usize| run.found.lines[row].updated_response.get(m).copied();
    responses(case, &frequency_hz, &receptance, "updated")
}

/// What a receptance is, by frequency and sensor.
type Receptance<'a> = &'a dyn Fn(usize, usize) -> Option<c64>;

fn responses(
    case: &Case,
    frequency_hz: &[f64],
    receptance: Receptance<'_>,
    kind: &str,
) -> Result<Vec<u8>, FormatError> {
    let mut file = write::units(&Units::default())?;
    for (m, sensor) in case.sensors.iter().enumerate() {
        let answered = frequency_hz.iter().enumerate().filter_map(|(row, &frequency_hz)| {
            Some((frequency_hz, case.over_receptance(sensor, frequency_hz) * receptance(row, m)?))
        });
        let (frequency_hz, response): (Vec<f64>, Vec<_>) = answered.unzip();
        if frequency_hz.is_empty() {
            continue;
        }
        let title = case.title.chars().filter(|c| !c.is_control()).take(80).collect();
        let decay = Some(case.model.decay_per_s()).filter(|&decay| decay > 0.0);
        let header = FunctionHeader {
            id: [
                title,
                sensor.label.clone(),
                kind.into(),
                decay.map(decay_line).unwrap_or_default(),
                String::new(),
            ],
            response: dof(sensor, case.experiment.sensors[m].row),
            ..FunctionHeader::default()
        };
        let form = Form::Binary { endian: Endian::Little };
        file.extend(frf_dataset(&frequency_hz, response, header, sensor.quantity, form)?);
    }
    Ok(file)
}

fn dof(sensor: &SensorInfo, row: usize) -> Dof {
    match sensor.label.parse::<DofName>() {
        Ok(name) => Dof { node: name.node as i64, direction: name.uff_direction(), ..Dof::default() },
        Err(_) => Dof { node: row as i64 + 1, ..Dof::default() },
    }
}
