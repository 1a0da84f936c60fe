//! Where a structure is driven and where it is measured.

use crate::c64;

/// A measured degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Row of the model, from 0.
    pub row: usize,
    /// +1 or −1: the sense in which motion counts as positive.
    pub sign: f64,
}

/// The load F and the sensors, the same at every frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// F, one entry for each degree of freedom, N (or N·m).
    pub load: Vec<c64>,
    /// Measured degrees of freedom.
    pub sensors: Vec<Sensor>,
}

impl Experiment {
    /// Unit force on one row, with sign, measured at the sensors.
    ///
    /// # Panics
    /// Where `driven` is outside the model.
    pub fn driven_at(dim: usize, driven: Sensor, sensors: Vec<Sensor>) -> Self {
        let mut load = vec![c64::default(); dim];
        load[driven.row] = c64::new(driven.sign, 0.0);
        Self { load, sensors }
    }

    /// ℓ_m: the unit force at a sensor, along it; ℓ_mᵀ x is what it measures.
    ///
    /// # Panics
    /// Where there is no such sensor.
    pub fn unit_force(&self, sensor: usize) -> Vec<c64> {
        let mut force = vec![c64::default(); self.load.len()];
        let Sensor { row, sign } = self.sensors[sensor];
        force[row] = c64::new(sign, 0.0);
        force
    }

    /// x at the sensors, with their signs.
    pub fn observe(&self, x: &[c64]) -> Vec<c64> {
        self.sensors.iter().map(|sensor| sensor.sign * x[sensor.row]).collect()
    }
}
