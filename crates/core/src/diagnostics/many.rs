//! More sensors than can be fitted together at a price that grows with their number alone.
//!
//! A change of one sensor is fitted with all others beside it: of M sensors that is M fits to M sensors' values. So at most [`MAX_FITTED_SENSORS`] are fitted together. What is wrong with
//! all sensors is wrong with these. Then every sensor is compared with the modulus that they agree on, and each of those that differ most is looked at beside [`SENSORS_BESIDE_SUSPECT`] of those that
//! differ least.
//!
//! # Limits
//! Of sensors that are wrong each in a way of its own, [`MAX_SUSPECTS`] are looked at: the worst.

use super::data_hypothesis::{DataHypothesis, Edit};
use super::few::{Agreed, Measured, Model, Part, look, noise, written};
use super::finding::Diagnosis;
use super::misfit::{misfit, wrapped};
use crate::c64;
use crate::for_each::ForEach;
use crate::identify::Options;
use crate::material::OutsideTable;
use crate::median::median;
use crate::model::Sensor;
use crate::subspace::Drive;

/// Sensors that are fitted together: with twelve frequencies of each there are 240 values.
pub(super) const MAX_FITTED_SENSORS: usize = 20;

/// Sensors that are looked at one by one.
const MAX_SUSPECTS: usize = 3;

/// Sensors beside each of them: three others that agree are a majority.
const SENSORS_BESIDE_SUSPECT: usize = 3;

/// Misfit of one sensor, over that of most, from which on it is looked at. Noise alone seldom doubles it with twelve values.
const SUSPECT_MISFIT_RATIO: f64 = 2.0;

/// [`super::diagnose`] of more than [`MAX_FITTED_SENSORS`] sensors.
pub(super) fn diagnose(
    model: &Model<'_>,
    measured: Measured<'_>,
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, OutsideTable> {
    let count = measured.quantities.len();
    let panel: Vec<usize> =
        (0..MAX_FITTED_SENSORS).map(|k| k * (count - 1) / (MAX_FITTED_SENSORS - 1)).collect();
    let own = |agreed: Agreed<'_, '_>| own_misfits(model, measured, &agreed);
    let part = Part::of(measured, &panel);
    let of = |few: &[usize]| {
        let sensors = few.iter().map(|&m| model.sensors[m]).collect();
        Model { sensors, ..model.clone() }
    };
    let (mut diagnosis, own) = look(&of(&panel), part.measured(), options, for_each, &own)?;
    diagnosis.of_sensors(|k| panel[k]);
    // What is wrong with all of these is wrong with all.
    for (_, sensors) in diagnosis.faults_mut() {
        if sensors.len() == panel.len() {
            *sensors = (0..count).collect();
        }
    }
    let Some(own) = own else { return Ok(diagnosis) };
    let mut order: Vec<usize> = (0..count).filter(|&m| own[m].is_finite()).collect();
    order.sort_by(|&a, &b| own[a].total_cmp(&own[b]));
    let usual = median(order.iter().map(|&m| own[m]).collect()).unwrap_or(0.0);
    let is_found = |m: usize| diagnosis.findings.iter().any(|finding| finding.sensors == [m]);
    let suspects = order.iter().rev().take_while(|&&m| own[m] > SUSPECT_MISFIT_RATIO * usual);
    let suspects: Vec<usize> = suspects.copied().filter(|&m| !is_found(m)).take(MAX_SUSPECTS).collect();
    let mut found = Vec::new();
    for suspect in suspects {
        let mut few: Vec<usize> = order.iter().copied().take(SENSORS_BESIDE_SUSPECT).collect();
        few.push(suspect);
        let part = Part::of(measured, &few);
        let (single, _) = look(&of(&few), part.measured(), options, for_each, &|_| ())?;
        diagnosis.work += single.work;
        let of_it = single.findings.into_iter().filter(|finding| finding.sensors == [SENSORS_BESIDE_SUSPECT]);
        found.extend(of_it.map(|mut finding| {
            finding.sensors = vec![suspect];
            finding
        }));
    }
    // The mesh comes last.
    let values = diagnosis.findings.iter().take_while(|finding| finding.evidence.is_some()).count();
    diagnosis.findings.splice(values..values, found);
    Ok(diagnosis)
}

/// Misfit of every sensor for itself, by the moduli that some agree on and the changes of all.
fn own_misfits(model: &Model<'_>, measured: Measured<'_>, agreed: &Agreed<'_, '_>) -> Vec<f64> {
    let Agreed { responses, picked, fitted, edits } = agreed;
    let Measured { quantities, experiment, .. } = measured;
    let all: Vec<usize> = (0..quantities.len()).collect();
    let as_given = DataHypothesis::as_given(quantities, model.problem.model().decay_per_s());
    let data_hypothesis = edits.iter().fold(as_given, |data_hypothesis, edit| {
        data_hypothesis.with(&Edit { change: edit.change.clone(), sensors: all.clone() })
    });
    let mut residuals: Vec<(Vec<c64>, Vec<f64>)> = vec![Default::default(); quantities.len()];
    for (k, &i) in picked.iter().enumerate() {
        let x = responses.everywhere(Drive::Load, &fitted.moduli, &[k]).concat();
        let (values, noise) = (written(model.problem, measured, i), noise(measured, i));
        for (m, (value, &Sensor { row, sign })) in values.into_iter().zip(&experiment.sensors).enumerate() {
            let Some(value) = value else { continue };
            let f = responses.frequency_hz[k];
            let read = data_hypothesis.reading(m, f, value).receptance(fitted.ln_factor, fitted.delay_s);
            residuals[m].0.push(wrapped(read - (sign * x[row]).ln()));
            residuals[m].1.push(noise[m]);
        }
    }
    // Of fewer than half of the values nothing is said.
    let is_enough = |rest: &Vec<c64>| 2 * rest.len() >= picked.len();
    let own = |(rest, noise): &(Vec<c64>, Vec<f64>)| match is_enough(rest) {
        true => misfit(rest, noise).sigma,
        false => f64::NAN,
    };
    residuals.iter().map(own).collect()
}
