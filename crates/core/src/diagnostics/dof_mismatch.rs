//! Sensors and loads that are on other rows than the case says: one solve answers for every row at once, and by reciprocity for every load.

use super::data_hypothesis::{Change, DataHypothesis, DofMismatch, Edit};
use super::misfit::{misfit_at, wrapped};
use super::responses::{Law, Parametrization, Responses, trained};
use super::search::{Fitted, Search, Written};
use crate::c64;
use crate::for_each::map;
use crate::identify::{Band, Options};
use crate::model::{Experiment, ModelAt, Sensor};
use crate::subspace::Drive;

/// Frequencies at which all rows are looked at.
const ROW_FREQUENCIES: usize = 12;

/// Moduli at which they are, at most; fewer on large models, so that all rows cost no more than this many products.
const MAX_ROW_MODULI: usize = 60;
const MAX_ROW_PRODUCTS: f64 = 4e8;

/// Rows that are looked at more closely, for a sensor or the load.
const MAX_CLOSE_ROWS: usize = 6;

/// Scale at which rows are compared: away from the sensors the basis is good to some hundredths.
const ROW_SCALE: f64 = 0.3;

/// A dof mismatch that was tried, with what came of it.
pub(super) struct Tried {
    pub(super) what: DofMismatch,
    pub(super) edit: Edit,
    pub(super) fitted: Fitted,
}

/// A row, its score, and the modulus with which it had it.
type Scored = (usize, f64, Law);

/// The best rows for every sensor and for the load, each fitted on a model that was trained for it.
pub(super) fn dof_mismatch<'a>(
    search: &Search<'_, '_>,
    band: &Band<'_>,
    at: &[ModelAt<'a>],
    options: &Options,
    data_hypothesis: &DataHypothesis,
    laws: &[Vec<Law>],
) -> Vec<Tried> {
    let experiment = band.experiment;
    let sensors = experiment.sensors.len();
    let driven: Vec<usize> =
        (0..experiment.load.len()).filter(|&row| experiment.load[row] != c64::default()).collect();
    // What is at which of the candidates' rows: (sensor or none for the load, row, modulus).
    let mut wanted: Vec<(Option<usize>, usize, Law)> = Vec::new();
    for (m, (sensor, laws)) in experiment.sensors.iter().zip(laws).enumerate() {
        let best = best_rows(search, experiment, data_hypothesis, &[m], false, laws, sensor.row);
        wanted.extend(best.into_iter().map(|(row, _, law)| (Some(m), row, law)));
    }
    if let [row] = driven[..] {
        let all: Vec<usize> = (0..sensors).collect();
        let best = best_rows(search, experiment, data_hypothesis, &all, true, &laws[sensors], row);
        wanted.extend(best.into_iter().map(|(row, _, law)| (None, row, law)));
    }
    let sign = |m: Option<usize>| m.map_or(1.0, |m| experiment.sensors[m].sign);
    let places = wanted.iter().map(|&(m, row, _)| Sensor { row, sign: sign(m) });
    let wider = Experiment {
        load: experiment.load.clone(),
        sensors: experiment.sensors.iter().copied().chain(places).collect(),
    };
    let Some(parametrization) = Parametrization::about(at, band.unknown, options) else { return Vec::new() };
    let subspace = trained(&wider, at, &parametrization, search.for_each);
    let responses = subspace.as_ref().and_then(|subspace| {
        let all = (0..wider.sensors.len()).collect();
        Responses::new(subspace, all, parametrization, at, search.for_each)
    });
    let Some(mut responses) = responses else { return Vec::new() };
    let force = driven.first().map_or(c64::default(), |&row| experiment.load[row]);
    let mut edits = Vec::with_capacity(wanted.len());
    for (k, &(m, row, law)) in wanted.iter().enumerate() {
        let there = sensors + k;
        let (sensors, columns, what) = match m {
            Some(m) => (vec![m], vec![there], DofMismatch::Response(row)),
            None => {
                let by = |m: usize| {
                    responses.add(|poles| {
                        let unit = poles.residues(m, Drive::Sensor(there));
                        unit.into_iter().map(|rho| rho * force).collect()
                    })
                };
                let all: Vec<usize> = (0..sensors).collect();
                let columns = all.iter().copied().map(by).collect();
                (all, columns, DofMismatch::Load(row))
            }
        };
        edits.push((what, Edit { change: Change::Column(columns, what), sensors }, law));
    }
    let close = Search { responses: &responses, ..*search };
    map(search.for_each, edits.len(), |k| {
        let (what, edit, law) = &edits[k];
        let moved = |by: f64| ([law[0] + by, law[1], law[2]], 0.0, 0.0);
        let fitted = close.follow(&data_hypothesis.with(edit), &[moved(0.0), moved(-0.03), moved(0.03)]);
        Tried { what: *what, edit: edit.clone(), fitted }
    })
}

/// Moduli over the box at which rows are compared, as many as a model of this size allows.
pub(super) fn sweep(responses: &Responses<'_>) -> Vec<Law> {
    let products = (responses.subspace.size() * responses.rows * ROW_FREQUENCIES) as f64;
    let count = ((MAX_ROW_PRODUCTS / products) as usize).clamp(5, MAX_ROW_MODULI);
    let [low, high] = responses.parametrization.ln_size;
    let size = |k: usize| low + (high - low) * k as f64 / (count - 1) as f64;
    (0..count).map(|k| [size(k), responses.parametrization.usual_loss(), 0.0]).collect()
}

/// The rows that explain some sensors best: as their own, or (`is_load`) as that of the load.
fn best_rows(
    search: &Search<'_, '_>,
    experiment: &Experiment,
    data_hypothesis: &DataHypothesis,
    sensors: &[usize],
    is_load: bool,
    laws: &[Law],
    own: usize,
) -> Vec<Scored> {
    let responses = search.responses;
    let Written(written) = search.written;
    let count = written.len().min(ROW_FREQUENCIES);
    let picked: Vec<usize> = (0..count).map(|k| k * (written.len() - 1) / (count - 1).max(1)).collect();
    let force = experiment.load[experiment.load.iter().position(|f| *f != c64::default()).unwrap_or(0)];
    let scores = map(search.for_each, laws.len(), |l| {
        let mut scores = vec![0.0; experiment.load.len()];
        for &i in &picked {
            let correction = responses.correction(laws[l], i);
            for &m in sensors {
                let Some(value) = written[i][m] else { continue };
                let read = data_hypothesis.receptance(m, responses.frequency_hz[i], value, 0.0, 0.0);
                let (drive, by) = match is_load {
                    true => (Drive::Sensor(responses.sensors[m]), force),
                    false => (Drive::Load, c64::new(experiment.sensors[m].sign, 0.0)),
                };
                let x =
                    responses.subspace.everywhere(&responses.pole_residues[i].coordinates(drive, correction));
                for (score, x) in scores.iter_mut().zip(x) {
                    *score += misfit_at(std::iter::once(wrapped(read - (by * x).ln())), ROW_SCALE);
                }
            }
        }
        scores
    });
    let rows = (0..experiment.load.len()).filter(|&row| row != own);
    let mut best: Vec<Scored> = rows
        .filter_map(|row| {
            let of_law = |l: usize| (row, scores[l][row], laws[l]);
            (0..laws.len()).map(of_law).min_by(|a, b| a.1.total_cmp(&b.1))
        })
        .filter(|(_, score, _)| score.is_finite())
        .collect();
    best.sort_by(|a, b| a.1.total_cmp(&b.1));
    best.truncate(MAX_CLOSE_ROWS);
    best
}
