//! Leakage of a Hann window, removed from measured values.

use super::band::{raw_std, row_of};
use super::measurement::Curve;
use crate::case::{Located, RandomWindow};
use crate::error::InputError;
use crate::run::in_parallel;
use frfit::c64;
use frfit::identify::{Frfs, Noise};
use frfit::modal::{HANN_LEAKAGE_RSTD, hann_evidence, hann_leakage};

/// A Hann window on the records that values were measured from.
#[derive(Debug, Clone, PartialEq)]
pub struct HannWindow {
    /// The length of the records, s.
    pub record_s: f64,
    /// By how many nats the values are likelier with it than without.
    pub nats: f64,
    /// Who says so.
    pub source: WindowSource,
    /// The largest leakage of a value, over its size.
    pub largest: f64,
}

/// Who says that there was a Hann window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindowSource {
    /// The measurements of the case: its leakage is removed.
    Given,
    /// The measured values: its leakage is removed.
    Shown,
    /// Nobody, and the values do not tell either: its leakage is in their standard deviations.
    Undecided,
}

/// What was removed, or may be there.
pub(super) struct Leakage {
    pub(super) window: HannWindow,
    frequency_hz: Vec<f64>,
    /// `[frequency][sensor]`.
    values: Vec<Vec<c64>>,
}

/// From so many nats on, values that nobody says a window of have one. Of 75 simulated and 14 real measurements without a Hann window the largest had 12; of
/// 26 with one and a coherence, 22 have more.
const MIN_NATS: f64 = 20.0;

/// The root mean square of a leakage that is there or not, over its size.
const UNDECIDED_RSTD: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Lines beyond the ends of the band that are fitted too: modes there leak into it.
const LINES_BEYOND: f64 = 20.0;

/// Lines of a transform are at whole multiples of their spacing, but for rounding in a file.
const OFF_GRID_LINES: f64 = 0.1;

impl Leakage {
    /// What a sensor's value has too much at a frequency, and the standard deviation of that.
    pub(super) fn at(&self, frequency_hz: f64, sensor: usize) -> (c64, f64) {
        let line = self.frequency_hz.partition_point(|&f| f < frequency_hz);
        let value = self.values.get(line).map_or(c64::default(), |row| row[sensor]);
        match self.window.source {
            WindowSource::Given | WindowSource::Shown => (value, HANN_LEAKAGE_RSTD * value.norm()),
            WindowSource::Undecided => (c64::default(), UNDECIDED_RSTD * value.norm()),
        }
    }
}

/// The leakage in a band of these curves; `None` where there is no window, or an exponential one.
pub(super) fn leakage(
    curves: &[&Curve],
    decay_per_s: f64,
    band_hz: [f64; 2],
) -> Result<Option<Leakage>, InputError> {
    let Some(record_s) = record_s(curves, decay_per_s)? else { return Ok(None) };
    let beyond = LINES_BEYOND / record_s;
    let near = |f: &f64| *f > 0.0 && (band_hz[0] - beyond..=band_hz[1] + beyond).contains(f);
    let rows_of = |f: f64| curves.iter().map(|curve| row_of(curve, f).ok()).collect::<Option<Vec<usize>>>();
    let lines = curves[0].frf.frequency_hz.iter().copied().filter(near);
    let (frequency_hz, rows): (Vec<f64>, Vec<Vec<usize>>) =
        lines.filter_map(|f| Some((f, rows_of(f)?))).unzip();
    let by_line = |of: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
        rows.iter().map(|rows| rows.iter().enumerate().map(|(m, &row)| of(m, row)).collect()).collect()
    };
    let std = curves.iter().map(|curve| raw_std(curve)).collect::<Option<Vec<_>>>();
    let std = std.map(|std| by_line(&|m, row| std[m][row]));
    let receptance: Vec<Vec<c64>> = rows
        .iter()
        .map(|rows| rows.iter().zip(curves).map(|(&row, curve)| curve.frf.response[row]).collect())
        .collect();
    let noise = std.as_ref().map_or(Noise::Unknown, |std| Noise::Known(std));
    let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &receptance, noise };
    // Values that are not finite were refused when the file was read.
    let Ok(nats) = hann_evidence(frfs, record_s, &in_parallel) else { return Ok(None) };
    let source = match &curves[0].window {
        Some(_) => WindowSource::Given,
        None if nats >= MIN_NATS => WindowSource::Shown,
        None if nats > -MIN_NATS && std.is_some() => WindowSource::Undecided,
        None => return Ok(None),
    };
    let Ok(values) = hann_leakage(frfs, record_s, &in_parallel) else { return Ok(None) };
    let sizes = values.iter().flatten().zip(receptance.iter().flatten());
    let largest = sizes.map(|(leakage, value)| leakage.norm() / value.norm()).fold(0.0, f64::max);
    let std = std.iter().flatten().flatten();
    let matters = values.iter().flatten().zip(std).any(|(leakage, std)| leakage.norm() > *std);
    if source == WindowSource::Undecided && !matters {
        return Ok(None);
    }
    let window = HannWindow { record_s, nats, source, largest };
    Ok(Some(Leakage { window, frequency_hz, values }))
}

/// The length of the records of a Hann window; `None` where there cannot be one.
fn record_s(curves: &[&Curve], decay_per_s: f64) -> Result<Option<f64>, InputError> {
    let Some(first) = curves.first() else { return Ok(None) };
    let word = |curve: &Curve| curve.window.as_ref().map(|window| window.value);
    for curve in curves {
        if word(curve) != word(first) {
            let place = curve.window.as_ref().or(first.window.as_ref()).map(|window| &window.place);
            let expected = "the window of all measurements to be the same";
            return Err(InputError::at(place.unwrap_or(&curve.file.named_by), expected, "another one"));
        }
    }
    let by_lines = || first.lines_of_a_transform_s();
    match &first.window {
        Some(Located { value: RandomWindow::Hann, place }) if decay_per_s > 0.0 => {
            Err(InputError::at(place, "one of window = \"hann\" and decay_per_s", "both"))
        }
        Some(Located { value: RandomWindow::Hann, place }) => {
            let found = first.record_s.or_else(by_lines);
            let expected = "record_s, because the frequencies are no whole multiples of their spacing";
            found.map(Some).ok_or_else(|| InputError::at(place, expected, "none"))
        }
        Some(Located { value: RandomWindow::None, .. }) => Ok(None),
        None => Ok(by_lines().filter(|_| decay_per_s == 0.0)),
    }
}

impl Curve {
    /// The length of the records that the lines are a transform of: 1 over their spacing. `None` where they are no whole multiples of it.
    fn lines_of_a_transform_s(&self) -> Option<f64> {
        let lines = &self.frf.frequency_hz;
        let spacings: Vec<f64> = lines.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let least = spacings.iter().copied().reduce(f64::min)?;
        // Lines may be missing, and files round: the mean of all spacings of one line.
        let single: Vec<f64> = spacings.into_iter().filter(|spacing| *spacing < 1.5 * least).collect();
        let spacing = single.iter().sum::<f64>() / single.len() as f64;
        let off_grid = |f: &f64| (f / spacing - (f / spacing).round()).abs();
        lines.iter().all(|f| off_grid(f) < OFF_GRID_LINES).then(|| spacing.recip())
    }
}
