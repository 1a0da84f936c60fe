//! Where a structure is driven and measured, by the names of its rows.

use frfit::dof::DofName;
use frfit::model::{DynamicStiffness, Experiment, Sensor};

/// What is driven and measured: the part that models with one unknown and with several have in common.
#[derive(Debug, Clone, Copy)]
pub struct Rig<'a> {
    /// The terms, each with its nominal factor.
    pub stiffness: &'a DynamicStiffness,
    /// Load and sensors.
    pub experiment: &'a Experiment,
    /// Name of each row; `None` where it is neither a displacement nor a rotation.
    pub dofs: &'a [Option<DofName>],
    /// First and last frequency.
    pub band_hz: [f64; 2],
    /// Distance of neighbouring frequencies.
    pub step_hz: f64,
}

impl Rig<'_> {
    /// The frequencies first + k · step up to the last.
    pub fn frequency_hz(&self) -> Vec<f64> {
        let [first, last] = self.band_hz;
        // Half a step beyond the last, so that rounding decides nothing.
        let steps = ((last - first) / self.step_hz + 0.5) as usize;
        (0..=steps).map(|k| first + k as f64 * self.step_hz).collect()
    }

    /// Name of the dof of a sensor.
    ///
    /// # Panics
    /// Where there is no such sensor, or its row has no name.
    pub fn measured_dof(&self, sensor: usize) -> DofName {
        let Sensor { row, sign } = self.experiment.sensors[sensor];
        let name = self.dofs[row].expect("a sensor at a displacement or a rotation");
        DofName { reversed: sign < 0.0, ..name }
    }

    /// Name of the dof that is driven; `None` where there are several, or it has no name.
    pub fn driven_at(&self) -> Option<DofName> {
        let mut driven = self.experiment.load.iter().enumerate().filter(|(_, force)| force.norm() > 0.0);
        match (driven.next(), driven.next()) {
            (Some((row, force)), None) => Some(DofName { reversed: force.re < 0.0, ..self.dofs[row]? }),
            _ => None,
        }
    }
}
