//! Two rows at once that are others than the case says: of the load and a sensor, or of two sensors. Neither alone explains anything.
//!
//! Of N rows there are N² pairs, but they need not be tried. Where a sensor is elsewhere too, all others say where the load is: one is left out, and every row of the
//! load is compared at once. Driven there, every row of the sensor is compared at once. Two sensors say nothing of each other: at given moduli each has its best rows.
//!
//! # Limits
//! With one sensor, pairs are not searched: by reciprocity the data never know which of two rows is the load's.

use super::data_hypothesis::{Change, DataHypothesis, DofMismatch, Edit};
use super::dof_mismatch::{Case, MAX_PAIRS, Tried, least_of_all, starts, with_places};
use super::moduli::Moduli;
use super::rows::{LoadScan, MIN_ROUGH_GAIN, Rows, What, best, driven_at, driven_row};
use super::search::Search;
use crate::for_each::map;
use crate::material::OutsideTable;
use crate::model::Sensor;
use crate::response::Work;

/// Sensors that are left out, each in turn, for the load's row: those without which the others agree best.
const MAX_LEFT_OUT: usize = 2;

/// Rows of the load that are fitted for each sensor that is left out, and those of them with which its own row is searched.
const MAX_LOAD_ROWS: usize = 6;
const MAX_KEPT_LOAD_ROWS: usize = 2;

/// Rows of a sensor that are fitted beside another row: through a sandwich four nodes answer alike.
const MAX_SENSOR_ROWS: usize = 4;

/// Moduli with which two sensors' rows are fitted.
const MAX_MODULI_OF_SENSORS: usize = 3;

/// Two rows, and the moduli that suit them.
struct Pair {
    load: Option<usize>,
    /// Sensors with their rows.
    sensors: Vec<(usize, usize)>,
    moduli: Moduli,
}

/// The best pairs of rows, each fitted on a model that was trained for it. It costs two trainings near some moduli, whatever the number of rows, for at most
/// 12 places the one and 44 the other.
pub(super) fn row_pairs(
    search: &Search<'_, '_>,
    case: Case<'_>,
    data_hypothesis: &DataHypothesis,
    (moduli, loads): (&[Moduli], &[LoadScan]),
) -> Result<(Vec<Tried>, Work), OutsideTable> {
    let sensors = case.experiment.sensors.len();
    if sensors < 2 {
        return Ok(Default::default());
    }
    let rows = Rows { search, experiment: case.experiment, data_hypothesis };
    let mut pairs = pairs_of_sensors(&rows, moduli);
    let mut work = Work::default();
    if let Some(own) = driven_row(case.experiment) {
        let loads = loads_without_a_sensor((moduli, loads), sensors, own);
        if let Some((of_load, spent)) = pairs_of_load(search, case, data_hypothesis, &loads)? {
            pairs.extend(of_load);
            work += spent;
        }
    }
    let sign = |m: usize| case.experiment.sensors[m].sign;
    let mut places: Vec<Sensor> = Vec::new();
    // The number of a place, added where it is new.
    let mut number = |row: usize, sign: f64| {
        let place = Sensor { row, sign };
        let there = places.iter().position(|other| *other == place).unwrap_or(places.len());
        if there == places.len() {
            places.push(place);
        }
        sensors + there
    };
    let mut numbered: Vec<(Option<usize>, Vec<usize>)> = Vec::with_capacity(pairs.len());
    for pair in &pairs {
        let load = pair.load.map(|row| number(row, 1.0));
        numbered.push((load, pair.sensors.iter().map(|&(m, row)| number(row, sign(m))).collect()));
    }
    let near: Vec<&Moduli> = pairs.iter().map(|pair| &pair.moduli).collect();
    let fitted = with_places(search, case, &places, &near, &mut |mut responses| {
        let mut hypotheses = Vec::with_capacity(pairs.len());
        for (pair, (load, there)) in pairs.iter().zip(&numbered) {
            let mut columns: Vec<usize> = (0..sensors).collect();
            pair.sensors.iter().zip(there).for_each(|(&(m, _), &there)| columns[m] = there);
            if let Some(load) = load {
                columns = driven_at(*load, columns, case.experiment, &mut responses);
            }
            let edit = Edit { change: Change::Column(columns), sensors: (0..sensors).collect() };
            hypotheses.push(data_hypothesis.with(&edit));
        }
        let close = Search { responses: &responses, ..*search };
        let scored = map(search.for_each, pairs.len(), |k| {
            close.likeliest_start(&hypotheses[k], starts(&responses, &pairs[k].moduli))
        });
        let mut order: Vec<usize> = (0..pairs.len()).collect();
        order.sort_by(|&a, &b| scored[a].0.total_cmp(&scored[b].0));
        order.truncate(MAX_PAIRS);
        map(search.for_each, order.len(), |s| {
            let k = order[s];
            let of_sensor = |&(m, row): &(usize, usize)| (DofMismatch::Response(row), vec![m]);
            let of_load = pairs[k].load.map(|row| (DofMismatch::Load(row), (0..sensors).collect()));
            let places = of_load.into_iter().chain(pairs[k].sensors.iter().map(of_sensor)).collect();
            let fitted = close.follow(&hypotheses[k], vec![scored[k].1.clone()]);
            Tried { places, second: None, fitted }
        })
    })?;
    let (tried, spent) = fitted.unwrap_or_default();
    work += spent;
    Ok((tried, work))
}

/// The best rows of two sensors at the moduli with which these leave least.
fn pairs_of_sensors(rows: &Rows<'_, '_>, moduli: &[Moduli]) -> Vec<Pair> {
    let sensors = &rows.experiment.sensors;
    let mut found = map(rows.search.for_each, moduli.len(), |l| {
        let mut left = 0.0;
        // What each gains, and its rows.
        let mut gains: Vec<(f64, usize, Vec<usize>)> = Vec::with_capacity(sensors.len());
        let misfits = rows.misfits_of_sensors(&moduli[l]);
        for (m, (sensor, misfits)) in sensors.iter().zip(misfits).enumerate() {
            let best = best(&misfits, sensor.row, MAX_SENSOR_ROWS);
            left += misfits[sensor.row];
            gains.push((best.first().map_or(0.0, |&row| misfits[sensor.row] - misfits[row]), m, best));
        }
        gains.sort_by(|a, b| b.0.total_cmp(&a.0));
        gains.truncate(2);
        let is_pair = gains.iter().all(|(gain, ..)| *gain > MIN_ROUGH_GAIN);
        is_pair.then(|| (left - gains.iter().map(|(gain, ..)| gain).sum::<f64>(), l, gains))
    });
    found.sort_by(|a, b| {
        let left = |one: &Option<(f64, _, _)>| one.as_ref().map_or(f64::INFINITY, |(left, ..)| *left);
        left(a).total_cmp(&left(b))
    });
    let mut pairs = Vec::new();
    for (_, l, gains) in found.into_iter().flatten().take(MAX_MODULI_OF_SENSORS) {
        let [(_, a, rows_of_a), (_, b, rows_of_b)] = gains.as_slice() else { continue };
        for &row_of_a in rows_of_a {
            pairs.extend(rows_of_b.iter().map(|&row_of_b| Pair {
                load: None,
                sensors: vec![(*a, row_of_a), (*b, row_of_b)],
                moduli: moduli[l].clone(),
            }));
        }
    }
    pairs
}

/// A row of the load that suits all sensors but one: that sensor, the row, the moduli.
type LoadRow = (usize, usize, Moduli);

/// The rows of the load that suit all sensors but the one that suits worst.
fn loads_without_a_sensor(
    (moduli, loads): (&[Moduli], &[LoadScan]),
    sensors: usize,
    own: usize,
) -> Vec<LoadRow> {
    let dim = loads.first().map_or(0, |scan| scan.worst.len());
    let mut found: Vec<(f64, Vec<LoadRow>)> = Vec::new();
    for m in 0..sensors {
        let of_m = |scan: &LoadScan| -> Vec<f64> {
            let left = |(sum, &(misfit, worst)): (&f64, &(f64, usize))| {
                if worst == m { sum - misfit } else { f64::INFINITY }
            };
            scan.scores[0].iter().zip(&scan.worst).map(left).collect()
        };
        let of_m: Vec<Vec<f64>> = loads.iter().map(of_m).collect();
        let (least, which) = least_of_all(dim, of_m.iter());
        let best = best(&least, own, MAX_LOAD_ROWS);
        if let Some(&first) = best.first() {
            let rows = best.iter().map(|&row| (m, row, moduli[which[row]].clone())).collect();
            found.push((least[first], rows));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().take(MAX_LEFT_OUT).flat_map(|(_, rows)| rows).collect()
}

/// The best rows of the sensors that were left out, with the load on the rows that suit all others best when these are fitted.
fn pairs_of_load(
    search: &Search<'_, '_>,
    case: Case<'_>,
    data_hypothesis: &DataHypothesis,
    loads: &[LoadRow],
) -> Result<Option<(Vec<Pair>, Work)>, OutsideTable> {
    let sensors = case.experiment.sensors.len();
    let places: Vec<Sensor> = loads.iter().map(|&(_, row, _)| Sensor { row, sign: 1.0 }).collect();
    let near: Vec<&Moduli> = loads.iter().map(|(.., moduli)| moduli).collect();
    with_places(search, case, &places, &near, &mut |mut responses| {
        let mut hypotheses = Vec::with_capacity(loads.len());
        for k in 0..loads.len() {
            let columns = driven_at(sensors + k, 0..sensors, case.experiment, &mut responses);
            let edit = Edit { change: Change::Column(columns), sensors: (0..sensors).collect() };
            hypotheses.push(data_hypothesis.with(&edit));
        }
        let fitted = map(search.for_each, loads.len(), |k| {
            let (left_out, _, moduli) = &loads[k];
            let others = search.written.without(*left_out);
            let close = Search { responses: &responses, written: &others, for_each: search.for_each };
            close.follow(&hypotheses[k], starts(&responses, moduli))
        });
        let mut order: Vec<usize> = (0..loads.len()).collect();
        order.sort_by(|&a, &b| fitted[a].nats.total_cmp(&fitted[b].nats));
        let mut kept: Vec<usize> = Vec::new();
        for k in order {
            if kept.iter().filter(|&&other| loads[other].0 == loads[k].0).count() < MAX_KEPT_LOAD_ROWS {
                kept.push(k);
            }
        }
        let close = Search { responses: &responses, ..*search };
        let rows = Rows { search: &close, experiment: case.experiment, data_hypothesis };
        let pairs = map(search.for_each, kept.len(), |s| {
            let k = kept[s];
            let (m, load, _) = loads[k];
            let moduli = &fitted[k].moduli;
            let misfits = rows.misfits(m, What::SensorDrivenAt(sensors + k), moduli);
            let best = best(&misfits, case.experiment.sensors[m].row, MAX_SENSOR_ROWS);
            let pair = |row| Pair { load: Some(load), sensors: vec![(m, row)], moduli: moduli.clone() };
            best.into_iter().map(pair).collect::<Vec<Pair>>()
        });
        pairs.into_iter().flatten().collect()
    })
}
