//! How far off the nominal value of a stiffness is, by the natural frequencies.
//!
//! The modes of the model at values all over a wide range are paired with those of the measurement. At the right one most of them have a partner at the same
//! frequency with the same shape, whatever small errors the model has; no solution of single frequencies says as much.

use super::shown_modes::ShownModes;
use crate::c64;
use crate::for_each::ForEach;
use crate::median::median;
use crate::modal::{MeasuredMode, PairedShape, best};
use crate::model::{DynamicStiffness, Role};
use crate::subspace::{Point, Projection};
use crate::thinned::thinned;
use frfit_linalg::vector::norm;
use std::f64::consts::TAU;

/// The logarithm of the factor on the nominal value that is tried, and how many to either side: up to thirty times. In steps so small that Rayleigh's quotient holds
/// between them.
const LOG_FACTOR_STEP: f64 = 0.2;
const STEPS: i32 = 17;

/// Steps beyond, for values that vary over the band.
const MORE_STEPS: i32 = 8;

/// How values may vary over the band beside the nominal law: as f to this power.
const SLOPES: [f64; 3] = [0.0, 0.25, 0.5];

/// Frequencies at which the nominal law is looked at.
const MAX_NOMINAL_VALUES: usize = 30;

/// Fewer pairs say nothing.
const MIN_PAIRS: usize = 3;

/// Factors farther apart than this, in logarithms, are two: the box about either does not have all that the other's has. The second one gains no more than this
/// part of the first.
const SAME_LOG_FACTOR: f64 = 0.7;
const MAX_RIVAL_GAIN: f64 = 0.75;

/// A mode with residues below this part of the usual ones may be hidden.
const MIN_VISIBLE: f64 = 0.2;

/// Modes up to this many times the highest frequency, and so many at most.
const MODES_ABOVE_BAND: f64 = 1.5;
const MAX_MODES: usize = 60;

/// A factor on the nominal value up to this, or down to one over it, is near: it is well within the box about the nominal.
const NEAR_FACTOR: f64 = 3.2;

/// The modes of a measurement, of which those of the model are to be partners.
pub(super) struct MeasuredShapes {
    sensors: Vec<usize>,
    shapes: Vec<PairedShape>,
    highest_rad_s: f64,
}

/// By how much a nominal value is off.
pub(super) struct Far {
    /// The true value over the nominal one.
    pub(super) factor: f64,
    /// How many modes of the model have a partner then, and how near those are.
    pub(super) gain: f64,
}

impl MeasuredShapes {
    /// Of what was measured at angular frequencies ω, with its standard deviations, both `[line][sensor]`; infinite of a sensor that is left out. The records may have a
    /// window of this decay.
    pub(super) fn new(
        omegas: &[f64],
        measured: (&[Vec<c64>], &[Vec<f64>]),
        decay_per_s: f64,
        for_each: ForEach<'_>,
    ) -> Option<Self> {
        let ShownModes { sensors, modes } = ShownModes::new(omegas, measured, decay_per_s, for_each)?;
        let shapes = modes.iter().filter_map(of_measured).collect();
        Some(Self { sensors, shapes, highest_rad_s: MODES_ABOVE_BAND * omegas.last()? })
    }

    /// The factor on some nominal values with which the model's modes are those of the measurement; `None` where they do not say, or where it is near one. `point` is the model in the
    /// middle of the band with that factor, `nominal` a frequency of the band and the nominal value there, of several.
    pub(super) fn far<'a>(
        &self,
        model: &Projection,
        nominal: &[(f64, c64)],
        point: &dyn Fn(f64) -> Option<Point<'a>>,
    ) -> Option<Far> {
        let model = self.scaled_modes(model, nominal, point)?;
        let mut tried: Vec<(f64, f64, usize)> = Vec::new();
        for slope in SLOPES {
            for k in -STEPS..=STEPS {
                let log_factor = f64::from(k) * LOG_FACTOR_STEP;
                let modes = model.with_factor(log_factor, slope);
                let found = best(&modes, &self.shapes, 0.5 * LOG_FACTOR_STEP);
                let pairs = found.pairs.len();
                let shown = visible(&modes, &self.shapes).max(pairs).max(1);
                let gain = found.gain * pairs as f64 / shown as f64;
                tried.push((log_factor + found.log_factor, gain, pairs));
            }
        }
        let &(log_factor, gain, pairs) = tried.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let rivals = tried.iter().filter(|other| (other.0 - log_factor).abs() > SAME_LOG_FACTOR);
        let rival = rivals.map(|other| other.1).fold(0.0, f64::max);
        let is_certain = pairs >= MIN_PAIRS && rival <= MAX_RIVAL_GAIN * gain;
        let is_far = log_factor.abs() > NEAR_FACTOR.ln();
        (is_certain && is_far).then_some(Far { factor: log_factor.exp(), gain })
    }

    fn scaled_modes<'a>(
        &self,
        model: &Projection,
        nominal: &[(f64, c64)],
        point: &dyn Fn(f64) -> Option<Point<'a>>,
    ) -> Option<ScaledModes> {
        let of_value = |k: i32| -> Option<Vec<PairedShape>> {
            let Point { at, correction } = point((f64::from(k) * LOG_FACTOR_STEP).exp())?;
            let modes = model.modes(&at, correction, self.highest_rad_s, MAX_MODES).ok()?;
            let one = |i: usize| -> Option<PairedShape> {
                let omega = modes.omega_rad_s[i];
                let energy_share = *modes.energy_shares[i].last()?;
                let residues = modes.residues(i, omega, &self.sensors);
                (omega > 0.0).then_some(PairedShape { frequency_hz: omega / TAU, residues, energy_share })
            };
            Some((0..modes.omega_rad_s.len()).filter_map(one).collect())
        };
        let modes = (-STEPS - MORE_STEPS..=STEPS + MORE_STEPS).map(of_value).collect::<Option<Vec<_>>>()?;
        let (middle_hz, middle) = nominal[nominal.len() / 2];
        let ln_ratio = |&(frequency_hz, value): &(f64, c64)| (frequency_hz, (value.re / middle.re).ln());
        let nominal: Vec<(f64, f64)> = thinned(nominal, MAX_NOMINAL_VALUES).map(ln_ratio).collect();
        let is_known = nominal.iter().all(|one| one.1.is_finite());
        is_known.then_some(ScaledModes { modes, nominal, middle_hz })
    }
}

/// Whether all of these terms are stiffnesses: natural frequencies grow with their factor.
pub(super) fn are_stiffnesses(model: &DynamicStiffness, mut terms: impl Iterator<Item = usize>) -> bool {
    terms.all(|term| model.terms()[term].role == Role::Stiffness)
}

/// The modes of a model with something unknown at values all over a range, constant over the band.
struct ScaledModes {
    /// The natural frequencies and shapes of each value, `[value][mode]`.
    modes: Vec<Vec<PairedShape>>,
    /// ln of the nominal value over that in the middle of the band, of each frequency of it.
    nominal: Vec<(f64, f64)>,
    middle_hz: f64,
}

impl ScaledModes {
    /// The modes where ln E is that of the nominal law, plus a factor, plus a slope times ln f: each at the value that E has at its frequency. What lies
    /// between two values is Rayleigh's quotient.
    fn with_factor(&self, log_factor: f64, slope: f64) -> Vec<PairedShape> {
        let value_at = |frequency_hz: f64| {
            let apart = |one: &&(f64, f64)| (one.0 - frequency_hz).abs();
            let nominal = self.nominal.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
            log_factor + nominal.map_or(0.0, |one| one.1) + slope * (frequency_hz / self.middle_hz).ln()
        };
        let count = self.modes.iter().map(Vec::len).max().unwrap_or(0);
        let one = |i: usize| -> Option<PairedShape> {
            let values = (-STEPS - MORE_STEPS..).map(|k| f64::from(k) * LOG_FACTOR_STEP);
            let there = self.modes.iter().zip(values).filter_map(|(modes, value)| {
                let mode = modes.get(i)?;
                Some((value_at(mode.frequency_hz) - value, mode))
            });
            let (rest, mode) = there.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
            let frequency_hz = mode.frequency_hz * (0.5 * mode.energy_share * rest).exp();
            (rest.abs() <= LOG_FACTOR_STEP).then(|| PairedShape { frequency_hz, ..mode.clone() })
        };
        (0..count).filter_map(one).collect()
    }
}

/// How many modes of the model the measurement should show: those between its lowest and its highest one whose residues are not far below the usual ones.
fn visible(model: &[PairedShape], measured: &[PairedShape]) -> usize {
    let size = |shape: &PairedShape| norm(&shape.residues);
    let frequencies = || measured.iter().map(|mode| mode.frequency_hz);
    let (first, last) = (frequencies().fold(f64::INFINITY, f64::min), frequencies().fold(0.0, f64::max));
    let in_band = |mode: &&PairedShape| first <= mode.frequency_hz && mode.frequency_hz <= last;
    let sizes: Vec<f64> = model.iter().filter(in_band).map(size).collect();
    let least = MIN_VISIBLE * median(sizes.clone()).unwrap_or(0.0);
    sizes.iter().filter(|size| **size >= least).count()
}

/// A measured mode with its natural frequency without damping: of a pole s = iω √(1 + iη) that is √(−Re s²).
fn of_measured(mode: &MeasuredMode) -> Option<PairedShape> {
    let square = -(mode.pole_per_s * mode.pole_per_s).re;
    let frequency_hz = square.sqrt() / TAU;
    (square > 0.0).then(|| PairedShape { frequency_hz, residues: mode.residues.clone(), energy_share: 1.0 })
}
