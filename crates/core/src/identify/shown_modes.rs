//! The modes that some lines and sensors of a band show.

use crate::c64;
use crate::for_each::ForEach;
use crate::frfs::Frfs;
use crate::frfs::Noise;
use crate::modal::{MeasuredMode, PoleOptions, measured_modes};
use crate::thinned::thinned;
use std::f64::consts::TAU;

/// Lines and sensors whose poles are searched, at most.
const MAX_LINES: usize = 1000;
const MAX_SENSORS: usize = 6;

/// Measured modes, with residues at some of the sensors.
pub(crate) struct ShownModes {
    pub(crate) sensors: Vec<usize>,
    pub(crate) modes: Vec<MeasuredMode>,
}

impl ShownModes {
    /// Of what was measured at angular frequencies ω, with its standard deviations, both `[line][sensor]`; of a sensor whose deviations are infinite
    /// nothing is asked. The records may have a window of this decay. `None` where no poles can be fitted.
    pub(crate) fn new(
        omegas: &[f64],
        (measured, std): (&[Vec<c64>], &[Vec<f64>]),
        decay_per_s: f64,
        for_each: ForEach<'_>,
    ) -> Option<Self> {
        let counted: Vec<usize> = (0..std.first()?.len()).filter(|&m| std[0][m].is_finite()).collect();
        let sensors: Vec<usize> = thinned(&counted, MAX_SENSORS).copied().collect();
        let all: Vec<usize> = (0..omegas.len()).filter(|&i| omegas[i] > 0.0).collect();
        let lines: Vec<usize> = thinned(&all, MAX_LINES).copied().collect();
        let frequency_hz: Vec<f64> = lines.iter().map(|&i| omegas[i] / TAU).collect();
        let receptance: Vec<Vec<c64>> =
            lines.iter().map(|&i| sensors.iter().map(|&m| measured[i][m]).collect()).collect();
        let std: Vec<Vec<f64>> =
            lines.iter().map(|&i| sensors.iter().map(|&m| std[i][m]).collect()).collect();
        // The fit finds the level itself.
        let noise = Noise::Relative(&std);
        let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &receptance, noise };
        let options = PoleOptions::default().with_decay_per_s(decay_per_s);
        Some(Self { sensors, modes: measured_modes(frfs, &options, for_each).ok()?.modes })
    }
}
