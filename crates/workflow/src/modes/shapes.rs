//! `modes.uff`: shapes at the sensors.

use super::ModesRun;
use crate::load::Case;
use frfit::c64;
use frfit::dof::DofName;
use frfit_formats::FormatError;
use frfit_formats::uff::{Units, write};
use std::collections::BTreeMap;

/// Units, then a dataset 55 for each mode of the model but rigid bodies, and of the measurement, with the numbers that they have in `modes.csv`. Displacements are residues at the sensors, for a unit force at the load; a sensor
/// without a name is the node of its row, in the first direction.
///
/// # Errors
/// [`FormatError`] where a node label does not fit the format.
pub(super) fn uff(case: &Case, run: &ModesRun) -> Result<Vec<u8>, FormatError> {
    let mut file = write::units(&Units::default())?;
    let of_model = run.shown().map(|i| (i, &run.model.modes[i]));
    for (k, mode) in of_model.filter(|(_, mode)| !mode.is_rigid_body()) {
        file.extend(write::mode_shape(&shape(case, "model", k, mode.pole_per_s, &mode.residues()))?);
    }
    let measured = run.measured.iter().flat_map(|measured| &measured.modes.modes).enumerate();
    for (k, mode) in measured {
        file.extend(write::mode_shape(&shape(case, "measured", k, mode.pole_per_s, &mode.residues))?);
    }
    Ok(file)
}

fn shape(case: &Case, kind: &str, k: usize, pole_per_s: c64, residues: &[c64]) -> write::ModeShape {
    let mut nodes: BTreeMap<i64, [c64; 6]> = BTreeMap::new();
    for (m, (sensor, residue)) in case.sensors.iter().zip(residues).enumerate() {
        let (node, direction) = match sensor.label.parse::<DofName>() {
            Ok(name) => (name.node as i64, name.uff_direction()),
            Err(_) => (case.experiment.sensors[m].row as i64 + 1, 1),
        };
        // Directions are ±1 to ±6, 0 for a scalar.
        let place = (direction.unsigned_abs() as usize).clamp(1, 6) - 1;
        let sense = if direction < 0 { -1.0 } else { 1.0 };
        nodes.entry(node).or_default()[place] = sense * residue;
    }
    let title = case.title.chars().filter(|c| !c.is_control()).take(80).collect();
    write::ModeShape {
        id: [title, kind.to_owned(), String::new(), String::new(), String::new()],
        number: k as i64 + 1,
        eigenvalue: pole_per_s,
        modal_a: c64::new(1.0, 0.0),
        nodes: nodes.into_iter().collect(),
    }
}
