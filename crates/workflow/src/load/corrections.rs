//! What measured values have by the way they were measured: leakage of a Hann window, which is removed; natural frequencies that differ from sensor to sensor, and what the
//! end of a record cuts off, which are in their standard deviations.

use super::band::{raw_std, row_of};
use super::measurement::Curve;
use crate::case::{Located, RandomWindow};
use crate::error::InputError;
use crate::run::in_parallel;
use frfit::c64;
use frfit::identify::{Frfs, Noise};
use frfit::modal::{
    FrequencyShifts, HANN_LEAKAGE_RSTD, cut_off, frequency_shifts, hann_evidence, hann_leakage,
};

/// What was found in measured values.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Corrections {
    /// The Hann window; `None` without one.
    pub hann: Option<HannWindow>,
    /// How natural frequencies differ from sensor to sensor; `None` where they do not.
    pub shifts: Option<SensorShifts>,
    /// The most that the end of the records cuts off a value, over its size; `None` where the responses have decayed.
    pub cut_off: Option<f64>,
}

/// Natural frequencies that differ from sensor to sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorShifts {
    /// By how many nats the values are likelier with them than without.
    pub nats: f64,
    /// Their standard deviation, relative.
    pub relative_std: f64,
}

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
    /// Neither the case nor the measured values decide: its leakage is in their standard deviations.
    Undecided,
}

/// From so many nats on, values that nobody says a window of have one. Of 75 simulated and 14 real measurements without a Hann window the largest had 12; of
/// 26 with one and a coherence, 22 have more.
const MIN_NATS: f64 = 20.0;

/// From so many nats on, natural frequencies differ from sensor to sensor. Of 190 simulated cases in which they do not the largest had 2.
const MIN_NATS_OF_SHIFTS: f64 = 10.0;

/// Standard deviation because of shifts over what they do to a value. Nothing is subtracted: two modes side by side that are taken for one look like
/// shifts too.
const SHIFTS_RSTD: f64 = 1.0;

/// The root mean square of a leakage that is there or not, over its size.
const UNDECIDED_RSTD: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Without standard deviations, less than this part of a value is nothing.
const MATTERS_RTOL: f64 = 0.01;

/// Lines beyond the ends of the band that are fitted too: modes there leak into it.
const LINES_BEYOND: f64 = 20.0;

/// Lines of a transform are at whole multiples of their spacing, but for rounding in a file.
const OFF_GRID_LINES: f64 = 0.1;

/// Values of a band, to be corrected.
pub(super) struct Corrected {
    pub(super) corrections: Corrections,
    frequency_hz: Vec<f64>,
    /// What is to be subtracted, and its standard deviation, `[frequency][sensor]`.
    removed: Vec<Vec<(c64, f64)>>,
}

impl Corrected {
    /// What a sensor's value has too much at a frequency, and the standard deviation of that.
    pub(super) fn removed(&self, frequency_hz: f64, sensor: usize) -> (c64, f64) {
        let line = self.frequency_hz.binary_search_by(|f| f.total_cmp(&frequency_hz));
        line.map_or((c64::default(), 0.0), |line| self.removed[line][sensor])
    }

    /// Adds the values of one cause: their standard deviation, and themselves where they are to be subtracted.
    fn add(&mut self, values: &[Vec<c64>], std: impl Fn(c64) -> f64, is_subtracted: bool) {
        for (row, values) in self.removed.iter_mut().zip(values) {
            for ((sum, deviation), value) in row.iter_mut().zip(values) {
                *sum += if is_subtracted { *value } else { c64::default() };
                *deviation = deviation.hypot(std(*value));
            }
        }
    }
}

/// What is to be removed from a band of these curves, which have an exponential window of this decay.
pub(super) fn corrected(
    curves: &[&Curve],
    decay_per_s: f64,
    band_hz: [f64; 2],
) -> Result<Corrected, InputError> {
    let record_s = record_s(curves, decay_per_s)?;
    let beyond = record_s.map_or(0.0, |record_s| LINES_BEYOND / record_s);
    let near = |f: &f64| *f > 0.0 && (band_hz[0] - beyond..=band_hz[1] + beyond).contains(f);
    let rows_of = |f: f64| curves.iter().map(|curve| row_of(curve, f).ok()).collect::<Option<Vec<usize>>>();
    let lines = curves.first().map_or(&[][..], |first| &first.frf.frequency_hz).iter().copied().filter(near);
    let (frequency_hz, rows): (Vec<f64>, Vec<Vec<usize>>) =
        lines.filter_map(|f| Some((f, rows_of(f)?))).unzip();
    let value = |(&row, curve): (&usize, &&Curve)| curve.frf.response[row];
    let values: Vec<Vec<c64>> =
        rows.iter().map(|rows| rows.iter().zip(curves).map(value).collect()).collect();
    let std = curves.iter().map(|curve| raw_std(curve)).collect::<Option<Vec<_>>>();
    let of_line =
        |std: &[Vec<f64>], rows: &[usize]| rows.iter().zip(std).map(|(&row, std)| std[row]).collect();
    let std: Option<Vec<Vec<f64>>> = std.map(|std| rows.iter().map(|rows| of_line(&std, rows)).collect());
    let noise = std.as_ref().map_or(Noise::Unknown, |std| Noise::Known(std));
    let mut found = Corrected {
        corrections: Corrections::default(),
        removed: vec![vec![(c64::default(), 0.0); curves.len()]; frequency_hz.len()],
        frequency_hz: frequency_hz.clone(),
    };
    let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &values, noise };
    if let Some(record_s) = record_s
        && let Some((window, leakage)) = hann_window(frfs, record_s, curves[0].window.is_some())
    {
        match window.source {
            WindowSource::Undecided => found.add(&leakage, |value| UNDECIDED_RSTD * value.norm(), false),
            _ => found.add(&leakage, |value| HANN_LEAKAGE_RSTD * value.norm(), true),
        }
        found.corrections.hann = Some(window);
    }
    // An exponential window says that there was an impact.
    if let Some(record_s) = curves.first().and_then(|first| first.lines_of_a_transform_s())
        && decay_per_s > 0.0
        && let Ok(sizes) = cut_off(frfs, decay_per_s, record_s, &in_parallel)
    {
        let sizes: Vec<Vec<c64>> =
            sizes.iter().map(|row| row.iter().map(|&size| size.into()).collect()).collect();
        if matters(&sizes, frfs) {
            found.add(&sizes, |value| value.norm(), false);
            found.corrections.cut_off = Some(largest(&sizes, &values));
        }
    }
    // Shifts are those of values without leakage.
    let difference = |(value, (removed, _)): (&c64, &(c64, f64))| value - removed;
    let rows = values.iter().zip(&found.removed);
    let values: Vec<Vec<c64>> =
        rows.map(|(values, removed)| values.iter().zip(removed).map(difference).collect()).collect();
    // Values that are not finite were refused when the file was read.
    if let Ok(shifts) = frequency_shifts(Frfs { receptance: &values, ..frfs }, decay_per_s, &in_parallel)
        && shifts.nats >= MIN_NATS_OF_SHIFTS
        && matters(&shifts.values, frfs)
    {
        let FrequencyShifts { nats, relative_std, values } = shifts;
        found.add(&values, |value| SHIFTS_RSTD * value.norm(), false);
        found.corrections.shifts = Some(SensorShifts { nats, relative_std });
    }
    Ok(found)
}

/// Whether something is larger than the standard deviation of a value, or than this part of it where none is known.
fn matters(values: &[Vec<c64>], frfs: Frfs<'_>) -> bool {
    let mut each =
        values.iter().enumerate().flat_map(|(i, row)| row.iter().enumerate().map(move |(m, x)| (i, m, x)));
    each.any(|(i, m, value)| {
        let std = match frfs.noise {
            Noise::Known(std) => std[i][m],
            _ => MATTERS_RTOL * frfs.receptance[i][m].norm(),
        };
        value.norm() > std
    })
}

/// The largest of some parts of values, over the size of the value.
fn largest(parts: &[Vec<c64>], values: &[Vec<c64>]) -> f64 {
    let sizes = parts.iter().flatten().zip(values.iter().flatten());
    sizes.map(|(part, value)| part.norm() / value.norm()).fold(0.0, f64::max)
}

/// The Hann window of values that it is said of or that show it, with its leakage.
fn hann_window(frfs: Frfs<'_>, record_s: f64, is_given: bool) -> Option<(HannWindow, Vec<Vec<c64>>)> {
    let nats = hann_evidence(frfs, record_s, &in_parallel).ok()?;
    let source = match frfs.noise {
        _ if is_given => WindowSource::Given,
        _ if nats >= MIN_NATS => WindowSource::Shown,
        Noise::Known(_) if nats > -MIN_NATS => WindowSource::Undecided,
        _ => return None,
    };
    let leakage = hann_leakage(frfs, record_s, &in_parallel).ok()?;
    let largest = largest(&leakage, frfs.receptance);
    if source == WindowSource::Undecided && !matters(&leakage, frfs) {
        return None;
    }
    Some((HannWindow { record_s, nats, source, largest }, leakage))
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
