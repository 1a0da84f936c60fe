//! How well every row of the model would suit a sensor or the load: one solution answers for all rows at once, and by reciprocity for every load.

use super::data_hypothesis::DataHypothesis;
use super::misfit::{beside_noise, misfit_at, wrapped};
use super::moduli::Moduli;
use super::responses::Responses;
use super::search::{Search, Written};
use crate::c64;
use crate::model::Experiment;
use crate::subspace::Drive;

/// Frequencies at which all rows are looked at.
const ROW_FREQUENCIES: usize = 12;

/// Moduli at which they are, at most; fewer on large models, so that all rows cost no more than this many products.
const MAX_ROW_MODULI: usize = 60;
const MAX_ROW_PRODUCTS: f64 = 4e8;

/// Scale at which rows are compared: away from the sensors the basis is good to some hundredths.
const ROW_SCALE: f64 = 0.3;

/// How far the sizes of several unknowns are tried to either side, in ln a.
const ROW_LN_RANGE: f64 = 0.5;

/// A row that is not better than the case's own by this (nats, at the scale of [`ROW_SCALE`]) is not looked at.
pub(super) const MIN_ROUGH_GAIN: f64 = 2.0;

/// Moduli over the box at which rows are compared, as many as a model of this size allows; of several unknowns about some.
pub(super) fn sweep(responses: &Responses<'_>, about: &Moduli) -> Vec<Moduli> {
    let products = (responses.subspace.size() * responses.rows * ROW_FREQUENCIES) as f64;
    let count = ((MAX_ROW_PRODUCTS / products) as usize).clamp(5, MAX_ROW_MODULI);
    let parametrization = &responses.parametrization;
    let [low, high] = parametrization.common();
    let part = |k: usize| k as f64 / (count - 1) as f64;
    let of = |k: usize| match responses.is_modal() {
        true => parametrization.moved(about, ROW_LN_RANGE * (2.0 * part(k) - 1.0)),
        false => parametrization.all_by(low + (high - low) * part(k), parametrization.usual_loss(), 0.0),
    };
    (0..count).map(of).collect()
}

/// The row that is driven, where it is one.
pub(super) fn driven_row(experiment: &Experiment) -> Option<usize> {
    let mut driven = (0..experiment.load.len()).filter(|&row| experiment.load[row] != c64::default());
    driven.next().filter(|_| driven.next().is_none())
}

/// What every row is compared with.
pub(super) struct Rows<'r, 'a> {
    pub(super) search: &'r Search<'r, 'a>,
    pub(super) experiment: &'r Experiment,
    pub(super) data_hypothesis: &'r DataHypothesis,
}

/// What is elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum What {
    /// The sensor, with the load as the case says.
    Sensor,
    /// The sensor, driven at another place: one of the sensors of the reduced model, which stands for the load's row.
    SensorDrivenAt(usize),
    /// The load.
    Load,
}

impl Rows<'_, '_> {
    /// The force on the driven row.
    pub(super) fn force(&self) -> c64 {
        self.experiment.load.iter().copied().find(|f| *f != c64::default()).unwrap_or_default()
    }

    /// ln(measured/model) of a sensor with every row in turn, `[frequency][row]`, at some of the frequencies; smaller where its noise is known, as at [`ROW_SCALE`] beside it.
    pub(super) fn rests(&self, m: usize, what: What, moduli: &Moduli) -> Vec<Vec<c64>> {
        let responses = self.search.responses;
        let Written(written, noise) = self.search.written;
        let count = written.len().min(ROW_FREQUENCIES);
        let picked = (0..count).map(|k| k * (written.len() - 1) / (count - 1).max(1));
        let picked: Vec<(usize, c64)> = picked.filter_map(|i| Some((i, written[i][m]?))).collect();
        let sign = c64::new(self.experiment.sensors[m].sign, 0.0);
        let (drive, by) = match what {
            What::Sensor => (Drive::Load, sign),
            What::SensorDrivenAt(place) => (Drive::Sensor(place), sign * self.force()),
            What::Load => (Drive::Sensor(responses.sensors[m]), self.force()),
        };
        let at: Vec<usize> = picked.iter().map(|&(i, _)| i).collect();
        let mut x = responses.everywhere(drive, moduli, &at);
        for (x, &(i, value)) in x.iter_mut().zip(&picked) {
            let read = self.data_hypothesis.reading(m, responses.frequency_hz[i], value).receptance(0.0, 0.0);
            let rest = |x: c64| beside_noise(wrapped(read - (by * x).ln()), noise[i][m], ROW_SCALE);
            x.iter_mut().for_each(|x| *x = rest(*x));
        }
        x
    }

    /// How badly each row suits a sensor, by magnitude and phase.
    pub(super) fn misfits(&self, m: usize, what: What, moduli: &Moduli) -> Vec<f64> {
        misfits(&self.rests(m, what, moduli), self.search.responses.rows)
    }
}

/// The misfit of each row at [`ROW_SCALE`], by magnitude and phase.
pub(super) fn misfits(rests: &[Vec<c64>], rows: usize) -> Vec<f64> {
    (0..rows).map(|row| misfit_at(rests.iter().map(|at| at[row]), ROW_SCALE)).collect()
}

/// The same by the shape of the magnitude alone, which a factor, a sign, a conjugate or a delay leaves as it is.
pub(super) fn misfits_of_shape(rests: &[Vec<c64>], rows: usize) -> Vec<f64> {
    let values = rests.len() as f64;
    let of_row = |row: usize| {
        let (sum, squares) = rests.iter().fold((0.0, 0.0), |(sum, squares), at| {
            let ln = at[row].re;
            (sum + ln, squares + ln * ln)
        });
        let about_mean: f64 = squares - sum * sum / values;
        values * (about_mean / values + ROW_SCALE * ROW_SCALE).ln()
    };
    (0..rows).map(|row| if rests.is_empty() { 0.0 } else { of_row(row) }).collect()
}

/// The rows of least score that are better than one's own.
pub(super) fn best(scores: &[f64], own: usize, most: usize) -> Vec<usize> {
    let mut rows: Vec<usize> =
        (0..scores.len()).filter(|&row| row != own && scores[row] < scores[own] - MIN_ROUGH_GAIN).collect();
    rows.sort_by(|&a, &b| scores[a].total_cmp(&scores[b]));
    rows.truncate(most);
    rows
}
