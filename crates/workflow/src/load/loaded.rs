//! A case with all of its files.

use super::corrections::Corrections;
use super::files::InputFile;
use super::identify::IdentifyCase;
use super::measurement::SensorInfo;
use super::measurement::measurement_argument;
use super::modes::ModesCase;
use super::sensitivities::SensitivitiesCase;
use crate::reads::Reads;
use crate::units::UnitSystem;
use frfit::c64;
use frfit::identify::CoarserMesh;
use frfit::model::{DynamicStiffness, Experiment};
use frfit::subspace::{KeptSubspace, Subspace};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A case read from its file, everything checked, nothing computed.
#[derive(Debug)]
pub struct Case {
    /// Its title, or the name of its file, in one line.
    pub title: String,
    /// Units of the model as the case has it.
    pub units: UnitSystem,
    /// D(ω), which acts on metres ([`crate::units`]), at the complex frequency that the measurements' window makes of ω; shared, because a program may ask one model more than once.
    pub model: Arc<DynamicStiffness>,
    /// Load and sensors.
    pub experiment: Experiment,
    /// The reduced model that was trained already, where the command line names one.
    pub reduced: Option<KeptSubspace>,
    /// The same structure on a coarser mesh, where the case names one and the purpose is to identify.
    pub coarser_mesh: Option<CoarserMesh>,
    /// The sensors' labels, quantities and files, in the order of the measurements.
    pub sensors: Vec<SensorInfo>,
    /// The names of rows (from 0), as `34+Z`; empty without `[dofs]` where the matrices' files name none either.
    pub row_names: BTreeMap<usize, String>,
    /// The number of the first row and of the first measurement in words and tables: 1 of case files, 0 of a program's arrays.
    pub first_number: usize,
    /// Every file that was read, the case file first.
    pub inputs: Vec<InputFile>,
    /// Where they are, so that nothing is written over them.
    pub reads: Reads,
    /// What to identify; `None` where the purpose is another.
    pub identify: Option<IdentifyCase>,
    /// What sensitivities need; `None` where the purpose is another.
    pub sensitivities: Option<SensitivitiesCase>,
    /// What the modal view needs; `None` where the purpose is another.
    pub modes: Option<ModesCase>,
    /// The frequencies of a response or of sensitivities: those of `[respond]`, or else those that were measured.
    pub respond_hz: Vec<f64>,
}

impl Case {
    /// `34+Z` where `[dofs]` or a matrix' file names the row (from 0); elsewhere `row 97`, counted from
    /// [`first_number`](Self::first_number).
    pub fn row_name(&self, row: usize) -> String {
        self.row_names.get(&row).cloned().unwrap_or_else(|| format!("row {}", self.row_number(row)))
    }

    /// The number of a row (from 0) in words and tables.
    pub fn row_number(&self, row: usize) -> usize {
        row + self.first_number
    }

    /// Measurement `m` (from 0) as its author wrote it: `[[measurement]] 1` of a case file, `measurements[0]` of a program.
    pub fn measurement_name(&self, m: usize) -> String {
        match self.first_number {
            0 => measurement_argument(m),
            first => format!("[[measurement]] {}", m + first),
        }
    }

    /// The reduced model that was trained already, to be trained further; `None` without one.
    pub(crate) fn subspace(&self) -> Option<Subspace<'_>> {
        // Whether it is of this model was checked when it was read.
        Subspace::of_kept(self.reduced.as_ref()?, &self.model, &self.experiment).ok()
    }

    /// The modal view of a case that was made to be identified: what was measured in its band, beside the model.
    #[must_use]
    pub fn with_modes(mut self) -> Self {
        self.modes = self.identify.as_ref().map(|wanted| ModesCase::of_identification(wanted, &self.model));
        self
    }

    /// The modal view of the model alone, over a band.
    #[must_use]
    pub fn with_modes_of_the_model(mut self, band_hz: [f64; 2]) -> Self {
        self.modes = Some(ModesCase::of_model(band_hz, &self.model));
        self
    }

    /// What was found in what was measured; `None` where nothing was measured.
    pub fn corrections(&self) -> Option<&Corrections> {
        let of_modes = || Some(&self.modes.as_ref()?.measured.as_ref()?.corrections);
        self.identify.as_ref().map(|identify| &identify.corrections).or_else(of_modes)
    }

    /// What a sensor's receptance is multiplied by to be in the quantity that it measures, under the measurements' window.
    pub(crate) fn over_receptance(&self, sensor: &SensorInfo, frequency_hz: f64) -> c64 {
        sensor.quantity.over_receptance_windowed(frequency_hz, self.model.decay_per_s())
    }
}
