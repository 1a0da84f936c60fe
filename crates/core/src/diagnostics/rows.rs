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

/// The force on the driven row.
fn force(experiment: &Experiment) -> c64 {
    driven_row(experiment).map_or(c64::default(), |row| experiment.load[row])
}

/// Columns of the responses with the force on another place, which is one of the sensors of the reduced model.
pub(super) fn driven_at(
    place: usize,
    columns: impl IntoIterator<Item = usize>,
    experiment: &Experiment,
    responses: &mut Responses<'_>,
) -> Vec<usize> {
    let (drive, force) = (Drive::Sensor(place), force(experiment));
    columns.into_iter().map(|at| responses.add(at, drive, force)).collect()
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
    /// x at every row where a sensor or the load may be, `[frequency][row]`; with the load as the case says it is the same for all sensors.
    fn solutions(&self, m: usize, what: What, moduli: &Moduli) -> Vec<Vec<c64>> {
        let responses = self.search.responses;
        let drive = match what {
            What::Sensor => Drive::Load,
            What::SensorDrivenAt(place) => Drive::Sensor(place),
            What::Load => Drive::Sensor(responses.sensors[m]),
        };
        responses.everywhere(drive, moduli, &self.picked())
    }

    /// The frequencies at which rows are looked at.
    fn picked(&self) -> Vec<usize> {
        let all = self.search.written.values.len();
        let count = all.min(ROW_FREQUENCIES);
        (0..count).map(|k| k * (all - 1) / (count - 1).max(1)).collect()
    }

    /// ln(measured/model) of a sensor with every row in turn, `[frequency][row]`; smaller where its noise is known, as at [`ROW_SCALE`] beside it.
    fn rests(&self, m: usize, what: What, solutions: &[Vec<c64>]) -> Vec<Vec<c64>> {
        let Written { values, noise } = self.search.written;
        let sign = c64::new(self.experiment.sensors[m].sign, 0.0);
        let by = match what {
            What::Sensor => sign,
            What::SensorDrivenAt(_) => sign * force(self.experiment),
            What::Load => force(self.experiment),
        };
        let of = |(i, x): (usize, &Vec<c64>)| -> Option<Vec<c64>> {
            let value = values[i][m]?;
            let frequency_hz = self.search.responses.frequency_hz[i];
            let read = self.data_hypothesis.reading(m, frequency_hz, value).receptance(0.0, 0.0);
            let rest = |x: &c64| beside_noise(wrapped(read - (by * x).ln()), noise[i][m], ROW_SCALE);
            Some(x.iter().map(rest).collect())
        };
        self.picked().into_iter().zip(solutions).filter_map(of).collect()
    }

    /// How badly each row suits a sensor, by magnitude and phase.
    pub(super) fn misfits(&self, m: usize, what: What, moduli: &Moduli) -> Vec<f64> {
        misfits(&self.rests(m, what, &self.solutions(m, what, moduli)), self.rows())
    }

    /// The same of every sensor with the load as the case says.
    pub(super) fn misfits_of_sensors(&self, moduli: &Moduli) -> Vec<Vec<f64>> {
        let solutions = self.solutions(0, What::Sensor, moduli);
        let of = |m| misfits(&self.rests(m, What::Sensor, &solutions), self.rows());
        (0..self.experiment.sensors.len()).map(of).collect()
    }

    /// How badly each row suits a sensor with the load as the case says, by magnitude and phase and by the shape of the magnitude.
    pub(super) fn scan_sensor(&self, m: usize, moduli: &Moduli) -> [Vec<f64>; 2] {
        let rests = self.rests(m, What::Sensor, &self.solutions(m, What::Sensor, moduli));
        [misfits(&rests, self.rows()), misfits_of_shape(&rests, self.rows())]
    }

    /// How badly each row suits the load.
    pub(super) fn scan_load(&self, moduli: &Moduli) -> LoadScan {
        let rows = self.rows();
        let mut scan = LoadScan {
            scores: [vec![0.0; rows], vec![0.0; rows]],
            worst: vec![(f64::NEG_INFINITY, 0); rows],
        };
        for m in 0..self.experiment.sensors.len() {
            let rests = self.rests(m, What::Load, &self.solutions(m, What::Load, moduli));
            let own = [misfits(&rests, rows), misfits_of_shape(&rests, rows)];
            for (worst, &misfit) in scan.worst.iter_mut().zip(&own[0]) {
                if misfit > worst.0 {
                    *worst = (misfit, m);
                }
            }
            for (sums, own) in scan.scores.iter_mut().zip(own) {
                sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            }
        }
        scan
    }

    fn rows(&self) -> usize {
        self.search.responses.rows
    }
}

/// How badly each row suits the load, with some moduli.
pub(super) struct LoadScan {
    /// Of all sensors, by magnitude and phase and by the shape of the magnitude.
    pub(super) scores: [Vec<f64>; 2],
    /// What the sensor that it suits worst leaves by magnitude and phase, and which it is.
    pub(super) worst: Vec<(f64, usize)>,
}

/// The misfit of each row at [`ROW_SCALE`], by magnitude and phase.
fn misfits(rests: &[Vec<c64>], rows: usize) -> Vec<f64> {
    (0..rows).map(|row| misfit_at(rests.iter().map(|at| at[row]), ROW_SCALE)).collect()
}

/// The same by the shape of the magnitude alone, which a factor, a sign, a conjugate or a delay leaves as it is.
fn misfits_of_shape(rests: &[Vec<c64>], rows: usize) -> Vec<f64> {
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
    let Some(&of_own) = scores.get(own) else { return Vec::new() };
    let is_better = |row: &usize| *row != own && scores[*row] < of_own - MIN_ROUGH_GAIN;
    let mut rows: Vec<usize> = (0..scores.len()).filter(is_better).collect();
    rows.sort_by(|&a, &b| scores[a].total_cmp(&scores[b]));
    rows.truncate(most);
    rows
}
