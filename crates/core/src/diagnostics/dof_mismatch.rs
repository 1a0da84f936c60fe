//! Sensors and loads that are on other rows than the case says, one at a time.

use super::data_hypothesis::{Change, DataHypothesis, DofMismatch, Edit};
use super::moduli::{Moduli, Parametrization};
use super::responses::{Responses, trained};
use super::rows::{LoadScan, Rows, best, driven_at, driven_row};
use super::search::{Fitted, Search, Start};
use crate::for_each::map;
use crate::identify::{Options, Problem};
use crate::material::OutsideTable;
use crate::model::{Experiment, Sensor};
use crate::response::Work;

/// Rows that are looked at more closely for a sensor or the load, of each kind of comparison.
const MAX_CLOSE_ROWS: usize = 4;

/// Rows with a change of values or another row beside them that are fitted.
pub(super) const MAX_PAIRS: usize = 20;

/// How far to either side of the moduli of candidates a model is trained, in ln a, and of how many at most.
const TRAINED_LN_RANGE: f64 = 0.05;
const MAX_TRAINED_MODULI: usize = 3;

/// What is on another row, and which sensors it concerns.
pub(super) type Place = (DofMismatch, Vec<usize>);

/// Rows that were tried, with what came of them.
pub(super) struct Tried {
    pub(super) places: Vec<Place>,
    /// A change of values beside them.
    pub(super) second: Option<Edit>,
    pub(super) fitted: Fitted,
}

/// What a search for rows has to go by.
#[derive(Clone, Copy)]
pub(super) struct Case<'x> {
    pub(super) problem: &'x Problem<'x>,
    pub(super) experiment: &'x Experiment,
    pub(super) options: &'x Options,
}

/// The best rows for every sensor and for the load, alone and beside each of some changes of values, each fitted on a model that was trained for it.
///
/// Sensors come with the moduli that rows are compared with, the load with what came of all rows.
pub(super) fn dof_mismatch(
    search: &Search<'_, '_>,
    case: Case<'_>,
    (data_hypothesis, changes): (&DataHypothesis, &[Edit]),
    of_sensors: &[(usize, Vec<Moduli>)],
    (swept, loads): (&[Moduli], &[LoadScan]),
) -> Result<(Vec<Tried>, Work), OutsideTable> {
    let experiment = case.experiment;
    let sensors = experiment.sensors.len();
    let all: Vec<usize> = (0..sensors).collect();
    let rows = Rows { search, experiment, data_hypothesis };
    // What is at which of the candidates' rows: (sensor, or none for the load, row, moduli).
    let mut wanted: Vec<(Option<usize>, usize, Moduli)> = Vec::new();
    for (m, moduli) in of_sensors {
        let scores = map(search.for_each, moduli.len(), |l| rows.scan_sensor(*m, &moduli[l]));
        let best = best_rows(&scores.iter().collect::<Vec<_>>(), moduli, experiment.sensors[*m].row);
        wanted.extend(best.into_iter().map(|(row, moduli)| (Some(*m), row, moduli)));
    }
    if let Some(own) = driven_row(experiment) {
        let scores: Vec<&[Vec<f64>; 2]> = loads.iter().map(|scan| &scan.scores).collect();
        wanted.extend(best_rows(&scores, swept, own).into_iter().map(|(row, moduli)| (None, row, moduli)));
    }
    let places: Vec<Sensor> = wanted
        .iter()
        .map(|(m, row, _)| Sensor { row: *row, sign: m.map_or(1.0, |m| experiment.sensors[m].sign) })
        .collect();
    let near: Vec<&Moduli> = wanted.iter().map(|(.., moduli)| moduli).collect();
    let fitted = with_places(search, case, &places, &near, &mut |mut responses| {
        let mut edits = Vec::with_capacity(wanted.len());
        for (k, (m, row, moduli)) in wanted.iter().enumerate() {
            let there = sensors + k;
            let (sensors, columns, what) = match *m {
                Some(m) => (vec![m], vec![there], DofMismatch::Response(*row)),
                None => {
                    let columns = driven_at(there, 0..sensors, experiment, &mut responses);
                    (all.clone(), columns, DofMismatch::Load(*row))
                }
            };
            let edit = Edit { change: Change::Column(columns), sensors: sensors.clone() };
            edits.push((vec![(what, sensors)], edit, moduli));
        }
        let edits: Vec<(Vec<Place>, Edit, &Moduli)> = edits;
        let close = Search { responses: &responses, ..*search };
        let mut tried = map(search.for_each, edits.len(), |k| {
            let (places, edit, moduli) = &edits[k];
            let fitted = close.follow(&data_hypothesis.with(edit), starts(&responses, moduli));
            Tried { places: places.clone(), second: None, fitted }
        });
        let seconds: Vec<(usize, &Edit)> =
            (0..edits.len()).flat_map(|k| changes.iter().map(move |second| (k, second))).collect();
        let both = |k: usize, second: &Edit| data_hypothesis.with(&edits[k].1).with(second);
        let scored = map(search.for_each, seconds.len(), |s| {
            let (k, second) = seconds[s];
            close.likeliest_start(&both(k, second), starts(&responses, edits[k].2))
        });
        let mut order: Vec<usize> = (0..seconds.len()).collect();
        order.sort_by(|&a, &b| scored[a].0.total_cmp(&scored[b].0));
        order.truncate(MAX_PAIRS);
        tried.extend(map(search.for_each, order.len(), |s| {
            let (k, second) = seconds[order[s]];
            let fitted = close.follow(&both(k, second), vec![scored[order[s]].1.clone()]);
            Tried { places: edits[k].0.clone(), second: Some(second.clone()), fitted }
        }));
        tried
    })?;
    Ok(fitted.unwrap_or_default())
}

/// Where rows are fitted from: their moduli, and a little to either side.
pub(super) fn starts(responses: &Responses<'_>, moduli: &Moduli) -> Vec<Start> {
    let moved = |by: f64| (responses.parametrization.moved(moduli, by), 0.0, 0.0);
    [0.0, -0.03, 0.03].map(moved).to_vec()
}

/// Trains a model with some more places behind the sensors, near some moduli, and hands its responses over. `None` without places, or where no model can be trained.
pub(super) fn with_places<T>(
    search: &Search<'_, '_>,
    Case { problem, experiment, options }: Case<'_>,
    places: &[Sensor],
    moduli: &[&Moduli],
    found: &mut dyn FnMut(Responses<'_>) -> T,
) -> Result<Option<(T, Work)>, OutsideTable> {
    let (Some(&about), false) = (moduli.first(), places.is_empty()) else { return Ok(None) };
    let wider = Experiment {
        load: experiment.load.clone(),
        sensors: experiment.sensors.iter().chain(places).copied().collect(),
    };
    let frequency_hz = &search.responses.frequency_hz;
    let Some(parametrization) = Parametrization::new(problem, frequency_hz, options)? else {
        return Ok(None);
    };
    let near = near_candidates(&parametrization, moduli);
    let subspace = trained(problem, &wider, frequency_hz, &parametrization, &near, search.for_each)?;
    let Some(subspace) = subspace else { return Ok(None) };
    let all = (0..wider.sensors.len()).collect();
    let parametrization = (parametrization, about);
    let responses = Responses::new(problem, &subspace, all, parametrization, frequency_hz, search.for_each);
    Ok(responses.map(|responses| (found(responses), subspace.work())))
}

/// Where a model is trained that serves some moduli and what is near by: at most [`MAX_TRAINED_MODULI`] of them, and to either side.
fn near_candidates(parametrization: &Parametrization, candidates: &[&Moduli]) -> Vec<Moduli> {
    let mut apart: Vec<&Moduli> = Vec::new();
    for &moduli in candidates {
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

/// The rows of least scores, better than one's own, each with the moduli that suit it best.
///
/// They are the best by magnitude and phase, and the best by the shape of the magnitude alone, which a factor, a sign, a conjugate or a delay leaves as it is.
fn best_rows(scores: &[&[Vec<f64>; 2]], moduli: &[Moduli], own: usize) -> Vec<(usize, Moduli)> {
    let rows = scores.first().map_or(0, |scores| scores[0].len());
    let mut found: Vec<(usize, Moduli)> = Vec::new();
    for kind in 0..2 {
        let (least, which) = least_of_all(rows, scores.iter().map(|scores| &scores[kind]));
        for row in best(&least, own, MAX_CLOSE_ROWS) {
            if found.iter().all(|(other, _)| *other != row) {
                found.push((row, moduli[which[row]].clone()));
            }
        }
    }
    found
}

/// The least score of every row, and which of the lists has it.
pub(super) fn least_of_all<'s>(
    rows: usize,
    scores: impl Iterator<Item = &'s Vec<f64>>,
) -> (Vec<f64>, Vec<usize>) {
    let (mut least, mut which) = (vec![f64::INFINITY; rows], vec![0; rows]);
    for (l, scores) in scores.enumerate() {
        for (row, &score) in scores.iter().enumerate() {
            if score < least[row] {
                (least[row], which[row]) = (score, l);
            }
        }
    }
    (least, which)
}
