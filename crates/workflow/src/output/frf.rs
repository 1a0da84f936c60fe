//! `frf.uff`: a forward response as other programs read it.

use crate::convert::frf_dataset;
use crate::load::{Case, SensorInfo};
use crate::run::RespondRun;
use frfit::dof::DofName;
use frfit_formats::FormatError;
use frfit_formats::uff::{Dof, Endian, Form, FunctionHeader, Units, write};

/// Units and one binary dataset 58 per sensor, every value bit for bit; frequencies without an answer are left out.
///
/// A sensor without a name is the node of its row, without direction.
///
/// # Errors
/// [`FormatError`] where a node label does not fit the format.
pub fn respond_uff(case: &Case, run: &RespondRun) -> Result<Vec<u8>, FormatError> {
    let mut file = write::units(&Units::default())?;
    for (m, sensor) in case.sensors.iter().enumerate() {
        let answered = run.frequency_hz.iter().zip(&run.receptance).filter_map(|(&frequency_hz, x)| {
            let receptance = *x.as_ref().ok()?.get(m)?;
            Some((frequency_hz, sensor.quantity.from_receptance(frequency_hz, receptance)))
        });
        let (frequency_hz, response): (Vec<f64>, Vec<_>) = answered.unzip();
        let title = case.title.chars().filter(|c| !c.is_control()).take(80).collect();
        let header = FunctionHeader {
            id: [title, sensor.label.clone(), String::new(), String::new(), String::new()],
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
