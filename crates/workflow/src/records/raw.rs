//! A recording as its file has it.

use crate::error::InputError;
use frfit::dof::DofName;
use frfit::signal::Unit;
use frfit_formats::FormatError;
use std::path::{Path, PathBuf};

/// Channels sampled together.
#[derive(Debug)]
pub(super) struct Raw {
    pub(super) file: PathBuf,
    pub(super) step_s: f64,
    pub(super) channels: Vec<RawChannel>,
}

/// A channel, its unit not yet understood.
#[derive(Debug, Clone)]
pub(super) struct RawChannel {
    /// Its name; two channels of one recording differ in name or in degree of freedom.
    pub(super) name: String,
    /// The unit as the file has it.
    pub(super) unit: String,
    /// What the file says the samples are by other means than the unit's name.
    pub(super) said: Option<Unit>,
    /// Where it was taken, where the file says.
    pub(super) dof: Option<DofName>,
    pub(super) samples: Vec<f64>,
}

/// How far an instant may lie beside an equally spaced one, in steps: the rounding of the digits that programs write.
const UNEVEN: f64 = 0.01;

/// The step of equally spaced instants.
pub(super) fn step_s(instants: &[f64]) -> Result<f64, FormatError> {
    let &[first, .., last] = instants else {
        return Err(FormatError::whole("at least two instants", instants.len().to_string()));
    };
    let step = (last - first) / (instants.len() - 1) as f64;
    let off = |(k, t): (usize, &f64)| (t - (first + k as f64 * step)).abs() > UNEVEN * step;
    // Written so that NaN fails too.
    if !(step > 0.0 && step.is_finite()) {
        return Err(FormatError::whole("ascending instants", format!("{first} s to {last} s")));
    }
    match instants.iter().enumerate().position(off) {
        None => Ok(step),
        Some(k) => {
            let found = format!("{} s as number {}, where the mean step is {step} s", instants[k], k + 1);
            Err(FormatError::whole("equally spaced instants", found))
        }
    }
}

/// One step for all channels of a recording.
pub(super) fn common_step_s(
    file: &Path,
    steps: impl IntoIterator<Item = Result<f64, FormatError>>,
) -> Result<f64, InputError> {
    let in_file = |error| InputError::in_file(file, error);
    let mut common: Option<f64> = None;
    for step in steps {
        let step = step.map_err(in_file)?;
        let first = *common.get_or_insert(step);
        // Six digits of a step are all that some programs write.
        if (step - first).abs() > 1e-6 * first {
            let expected = format!("one sampling interval for all channels, {first} s");
            return Err(in_file(FormatError::whole(expected, format!("{step} s"))));
        }
    }
    common.ok_or_else(|| in_file(FormatError::whole("at least one channel", "none")))
}
