//! Sensors and loads that are on other rows than the case says: one solve answers for every row at once, and by reciprocity for every load.

use super::data_hypothesis::{Change, DataHypothesis, DofMismatch, Edit};
use super::misfit::{misfit_at, wrapped};
use super::moduli::{Moduli, Parametrization};
use super::responses::{Responses, trained};
use super::search::{Fitted, Search, Start, Written};
use crate::c64;
use crate::for_each::map;
use crate::identify::{Options, Problem};
use crate::material::OutsideTable;
use crate::model::{Experiment, Sensor};
use crate::subspace::Drive;

/// Frequencies at which all rows are looked at.
const ROW_FREQUENCIES: usize = 12;

/// Moduli at which they are, at most; fewer on large models, so that all rows cost no more than this many products.
const MAX_ROW_MODULI: usize = 60;
const MAX_ROW_PRODUCTS: f64 = 4e8;

/// Rows that are looked at more closely for a sensor or the load, of each kind of comparison.
const MAX_CLOSE_ROWS: usize = 4;

/// Rows with a change of values beside them that are fitted.
const MAX_PAIRS: usize = 20;

/// Scale at which rows are compared: away from the sensors the basis is good to some hundredths.
const ROW_SCALE: f64 = 0.3;

/// How far the sizes of several unknowns are tried to either side, in ln a.
const ROW_LN_RANGE: f64 = 0.5;

/// How far to either side of the moduli of candidates a model is trained, in ln a, and of how many at most.
const TRAINED_LN_RANGE: f64 = 0.05;
const MAX_TRAINED_MODULI: usize = 3;

/// A row that is not better than the case's own by this (nats, at the scale of [`ROW_SCALE`]) is not looked at.
const MIN_ROUGH_GAIN: f64 = 2.0;

/// A dof mismatch that was tried, with what came of it.
pub(super) struct Tried {
    pub(super) what: DofMismatch,
    pub(super) sensors: Vec<usize>,
    /// A change of values beside it.
    pub(super) second: Option<Edit>,
    pub(super) fitted: Fitted,
}

/// The best rows for every sensor and for the load, alone and beside each of some changes of values, each fitted on a model that was trained for it.
pub(super) fn dof_mismatch(
    search: &Search<'_, '_>,
    problem: &Problem<'_>,
    experiment: &Experiment,
    options: &Options,
    (data_hypothesis, changes): (&DataHypothesis, &[Edit]),
    moduli: &[(Option<usize>, Vec<Moduli>)],
) -> Result<Vec<Tried>, OutsideTable> {
    let sensors = experiment.sensors.len();
    let driven: Vec<usize> =
        (0..experiment.load.len()).filter(|&row| experiment.load[row] != c64::default()).collect();
    // What is at which of the candidates' rows: (sensor, or none for the load, row, moduli).
    let mut wanted: Vec<(Option<usize>, usize, Moduli)> = Vec::new();
    for (place, moduli) in moduli {
        let all: Vec<usize> = (0..sensors).collect();
        let best = match (place, &driven[..]) {
            (Some(m), _) => {
                let own = experiment.sensors[*m].row;
                best_rows(search, experiment, data_hypothesis, &[*m], false, moduli, own)
            }
            (None, [row]) => best_rows(search, experiment, data_hypothesis, &all, true, moduli, *row),
            (None, _) => Vec::new(),
        };
        wanted.extend(best.into_iter().map(|(row, moduli)| (*place, row, moduli)));
    }
    if wanted.is_empty() {
        return Ok(Vec::new());
    }
    let sign = |m: Option<usize>| m.map_or(1.0, |m| experiment.sensors[m].sign);
    let places = wanted.iter().map(|(m, row, _)| Sensor { row: *row, sign: sign(*m) });
    let wider = Experiment {
        load: experiment.load.clone(),
        sensors: experiment.sensors.iter().copied().chain(places).collect(),
    };
    let frequency_hz = &search.responses.frequency_hz;
    let Some(parametrization) = Parametrization::new(problem, frequency_hz, options)? else {
        return Ok(Vec::new());
    };
    let near = near_candidates(&parametrization, wanted.iter().map(|(.., moduli)| moduli));
    let subspace = trained(problem, &wider, frequency_hz, &parametrization, &near, search.for_each)?;
    let about = parametrization.nominal();
    let responses = subspace.as_ref().and_then(|subspace| {
        let all = (0..wider.sensors.len()).collect();
        let about = wanted.first().map_or(&about, |(.., moduli)| moduli);
        Responses::new(problem, subspace, all, (parametrization, about), frequency_hz, search.for_each)
    });
    let Some(mut responses) = responses else { return Ok(Vec::new()) };
    let force = driven.first().map_or(c64::default(), |&row| experiment.load[row]);
    let mut edits = Vec::with_capacity(wanted.len());
    for (k, (m, row, moduli)) in wanted.iter().enumerate() {
        let there = sensors + k;
        let (sensors, columns, what) = match *m {
            Some(m) => (vec![m], vec![there], DofMismatch::Response(*row)),
            None => {
                let all: Vec<usize> = (0..sensors).collect();
                let columns = all.iter().map(|&m| responses.add(m, Drive::Sensor(there), force)).collect();
                (all, columns, DofMismatch::Load(*row))
            }
        };
        edits.push((what, Edit { change: Change::Column(columns), sensors }, moduli));
    }
    let close = Search { responses: &responses, ..*search };
    let starts = |moduli: &Moduli| -> Vec<Start> {
        let moved = |by: f64| (responses.parametrization.moved(moduli, by), 0.0, 0.0);
        [0.0, -0.03, 0.03].map(moved).to_vec()
    };
    let mut tried = map(search.for_each, edits.len(), |k| {
        let (what, edit, moduli) = &edits[k];
        let fitted = close.follow(&data_hypothesis.with(edit), starts(moduli));
        Tried { what: *what, sensors: edit.sensors.clone(), second: None, fitted }
    });
    let seconds: Vec<(usize, &Edit)> =
        (0..edits.len()).flat_map(|k| changes.iter().map(move |second| (k, second))).collect();
    let both = |k: usize, second: &Edit| data_hypothesis.with(&edits[k].1).with(second);
    let scored = map(search.for_each, seconds.len(), |s| {
        let (k, second) = seconds[s];
        close.likeliest_start(&both(k, second), starts(edits[k].2))
    });
    let mut order: Vec<usize> = (0..seconds.len()).collect();
    order.sort_by(|&a, &b| scored[a].0.total_cmp(&scored[b].0));
    order.truncate(MAX_PAIRS);
    tried.extend(map(search.for_each, order.len(), |s| {
        let (k, second) = seconds[order[s]];
        let (what, edit, _) = &edits[k];
        let fitted = close.follow(&both(k, second), vec![scored[order[s]].1.clone()]);
        Tried { what: *what, sensors: edit.sensors.clone(), second: Some(second.clone()), fitted }
    }));
    Ok(tried)
}

/// Where a model is trained that serves some moduli and what is near by: at most [`MAX_TRAINED_MODULI`] of them, and to either side.
fn near_candidates<'m>(
    parametrization: &Parametrization,
    candidates: impl Iterator<Item = &'m Moduli>,
) -> Vec<Moduli> {
    let mut apart: Vec<&Moduli> = Vec::new();
    for moduli in candidates {
        let is_near = |other: &&Moduli| other.ln_size_distance(moduli) < 2.0 * TRAINED_LN_RANGE;
        if !apart.iter().any(is_near) {
            apart.push(moduli);
        }
    }
    apart.truncate(MAX_TRAINED_MODULI);
    let sides =
        |moduli: &&Moduli| [-1.0, 1.0].map(|side| parametrization.moved(moduli, side * TRAINED_LN_RANGE));
    apart.iter().flat_map(sides).collect()
}

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

/// The rows that explain some sensors best: as their own, or (`is_load`) as that of the load.
///
/// Each comes with the moduli that suit it best. They are the best by magnitude and phase, and the best by the shape of the magnitude alone, which a factor, a sign, a conjugate or a delay leaves as it is.
fn best_rows(
    search: &Search<'_, '_>,
    experiment: &Experiment,
    data_hypothesis: &DataHypothesis,
    sensors: &[usize],
    is_load: bool,
    moduli: &[Moduli],
    own: usize,
) -> Vec<(usize, Moduli)> {
    let responses = search.responses;
    let Written(written) = search.written;
    let count = written.len().min(ROW_FREQUENCIES);
    let picked: Vec<usize> = (0..count).map(|k| k * (written.len() - 1) / (count - 1).max(1)).collect();
    let force = experiment.load[experiment.load.iter().position(|f| *f != c64::default()).unwrap_or(0)];
    let rows = experiment.load.len();
    let scores = map(search.for_each, moduli.len(), |l| {
        let mut scores = vec![[0.0; 2]; rows];
        for &m in sensors {
            // The deviation of ln|measured/model| from its mean.
            let mut sums = vec![[0.0; 2]; rows];
            let mut values = 0.0;
            for &i in &picked {
                let Some(value) = written[i][m] else { continue };
                values += 1.0;
                let read = data_hypothesis.reading(m, responses.frequency_hz[i], value).receptance(0.0, 0.0);
                let (drive, by) = match is_load {
                    true => (Drive::Sensor(responses.sensors[m]), force),
                    false => (Drive::Load, c64::new(experiment.sensors[m].sign, 0.0)),
                };
                for (row, x) in responses.everywhere(drive, &moduli[l], i).into_iter().enumerate() {
                    let rest = wrapped(read - (by * x).ln());
                    scores[row][0] += misfit_at(std::iter::once(rest), ROW_SCALE);
                    sums[row][0] += rest.re;
                    sums[row][1] += rest.re * rest.re;
                }
            }
            for (score, [sum, squares]) in scores.iter_mut().zip(sums) {
                let about_mean: f64 = squares - sum * sum / values;
                score[1] += values * (about_mean / values + ROW_SCALE * ROW_SCALE).ln();
            }
        }
        scores
    });
    let mut best: Vec<(usize, Moduli)> = Vec::new();
    for kind in [|score: &[f64; 2]| score[0], |score: &[f64; 2]| score[1]] {
        let least = |row: usize| {
            let of_moduli = |l: usize| (row, kind(&scores[l][row]), l);
            (0..moduli.len()).map(of_moduli).min_by(|a, b| a.1.total_cmp(&b.1))
        };
        let of_own = least(own).map_or(f64::INFINITY, |(_, score, _)| score);
        let is_better = |(_, score, _): &(usize, f64, usize)| *score < of_own - MIN_ROUGH_GAIN;
        let mut likeliest: Vec<(usize, f64, usize)> =
            (0..rows).filter(|&row| row != own).filter_map(least).filter(is_better).collect();
        likeliest.sort_by(|a, b| a.1.total_cmp(&b.1));
        likeliest.truncate(MAX_CLOSE_ROWS);
        for (row, _, l) in likeliest {
            if best.iter().all(|(other, _)| *other != row) {
                best.push((row, moduli[l].clone()));
            }
        }
    }
    best
}
