//! All frequencies and all sensors together.

use super::candidates::{Candidates, Fit, LinePoles};
use super::fit::{goodness, sensor_misfit};
use super::neighbourhoods::Neighbourhoods;
use super::on_reduced::{explored, on_reduced};
use super::outcome::BandOutcome;
use super::outlier_sensor::contradicting;
use super::task::{BandSolution, Task, led_to};
use super::verdict::{Evidence, verdict};
use crate::c64;
use crate::for_each::map;
use crate::frfs::standard_deviations;
use crate::identify::choice::MAX_TINY_MODEL_DOFS;
use crate::identify::context::{Context, Stage};
use crate::identify::dead_channel::dead_channels;
use crate::identify::goodness_of_fit::SensorFit;
use crate::identify::measured::Band;
use crate::identify::noise::without;
use crate::identify::options::Options;
use crate::identify::outcome::Line;
use crate::model::ModelAt;
use crate::response::{FullModel, Response, Work};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Chooses at every frequency; of the `hidden` sensors nothing is asked, nor of dead ones.
pub(super) fn identify<'a>(
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    mut reduced: Option<&mut Neighbourhoods<'_, '_>>,
    hidden: &[usize],
    options: &Options,
    context: Context<'_>,
) -> BandOutcome {
    let assumed = standard_deviations(band.frequency_hz, band.measured, band.noise);
    let sensors = band.experiment.sensors.len();
    let dead = dead_channels(band.measured);
    let more: Vec<usize> = dead.iter().copied().filter(|m| !hidden.contains(m)).collect();
    let hidden = &[hidden, &more].concat();
    let task = Task { band, at, sigma: &assumed, sensors, options, context };
    let (suspects, spent) = contradicting(&task, reduced.as_deref_mut(), hidden);
    let out = [hidden.as_slice(), if options.reject_outliers { &suspects[..] } else { &[] }].concat();
    let sigma = without(&assumed, &out);
    let task = Task { sigma: &sigma, sensors: sensors - out.len(), ..task };
    let (solved, mut work) = match reduced.as_deref_mut() {
        Some(reduced) => (on_reduced(&task, reduced), Work::default()),
        None => {
            let (found, work) = on_full_model(&task);
            let all: Vec<usize> = (0..at.len()).collect();
            (BandSolution { explored: all.len(), selected: task.select(&all, found.iter()), found }, work)
        }
    };
    work += spent;
    let BandSolution { found, explored, selected } = solved;
    let path = selected.path(&found, |i| at[i].parameters[0].nominal);
    let choices = selected.choices;
    let noise = task.noise_level(&found, &choices);
    let lines: Vec<Line> = map(context.for_each, at.len(), |i| {
        let solution = choices[i].chosen.or_else(|| likeliest(&task.fit(i), &found[i], &path, i));
        let chosen = solution.map(|k| &found[i].solutions[k]);
        let on_space = reduced.as_deref().zip(chosen.map(|solution| solution.correction));
        let weighed = |second: Vec<c64>| task.fit(i).weighed(&second);
        // The poles have it without another factorisation; how nearly linear something is takes few digits.
        let poles = found[i].poles.as_ref().map(LinePoles::get);
        let second = match (poles.as_ref().zip(chosen), on_space) {
            (Some((poles, solution)), _) => Some(weighed(poles.second_derivative(solution.correction))),
            (None, Some((reduced, c))) => reduced.second_derivative(i, c).map(weighed),
            (None, None) => chosen.map(|solution| solution.second),
        };
        let evidence = Evidence {
            at: &at[i],
            measured: &band.measured[i],
            is_real: band.unknown.real,
            solution,
            left_out: &out,
            noise: noise.level,
            freedom: task.freedom(),
            assessment: on_space.and_then(|(reduced, c)| reduced.assess(i, c)),
            // Where it is not known, the bar is not linear.
            second: second.unwrap_or(f64::INFINITY),
            poles: poles.as_deref(),
        };
        verdict(&evidence, &found[i], &choices[i])
    });
    if let Some(reduced) = &reduced {
        work += reduced.work();
    }
    let fit = goodness(&lines, task.freedom(), 0, &noise, band);
    let sensor = |m: usize| SensorFit {
        misfit: sensor_misfit(&lines, band.measured, &assumed, m, noise.level),
        contradicts: suspects.contains(&m),
        dead: dead.contains(&m),
        left_out: out.contains(&m),
    };
    let sensors = (0..sensors).map(sensor).collect();
    let subspace_size = reduced.as_ref().map(|reduced| reduced.size());
    BandOutcome { noise, fit, sensors, ..BandOutcome::of_lines(lines, work, subspace_size, explored) }
}

/// At how many of some frequencies over the whole band one of the solutions is chosen.
pub(super) fn answered_pilots(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    reduced: &mut Neighbourhoods<'_, '_>,
    options: &Options,
    context: Context<'_>,
) -> usize {
    let dead = dead_channels(band.measured);
    let sigma = without(&standard_deviations(band.frequency_hz, band.measured, band.noise), &dead);
    let sensors = band.experiment.sensors.len() - dead.len();
    let task = Task { band, at, sigma: &sigma, sensors, options, context };
    let pilots = reduced.pilots();
    let (_, selected) = explored(&task, reduced, &pilots);
    selected.choices.iter().filter(|choice| choice.chosen.is_some()).count()
}

fn on_full_model(task: &Task<'_, '_>) -> (Vec<Candidates>, Work) {
    let Task { band, at, sigma, options, context, .. } = *task;
    let done = AtomicUsize::new(0);
    let found = map(context.for_each, at.len(), |i| {
        let explored = match FullModel::new(at[i].clone(), band.experiment) {
            Ok(system) => {
                // Of a tiny model the whole space costs nothing, and nothing is left out then.
                let order = options.order.max(system.dim().min(MAX_TINY_MODEL_DOFS));
                let mut explored = task.fit(i).explore(&system, order);
                explored.confirm(&system, &band.measured[i], &sigma[i]);
                (explored, system.work())
            }
            Err(breakdown) => (Candidates::broken(breakdown), Work { factorisations: 1, solves: 0 }),
        };
        (context.progress)(Stage::Solutions, done.fetch_add(1, Ordering::Relaxed) + 1, at.len());
        explored
    });
    let mut work = Work::default();
    found.iter().for_each(|(_, own)| work += *own);
    (found.into_iter().map(|(explored, _)| explored).collect(), work)
}

/// Standard deviation of ln E between neighbouring lines by which solutions of a line off the path are compared.
const OFF_PATH_LN_STD: f64 = 0.1;

/// Of the solutions at a line that the path leaves out the likeliest: by the sensors' misfit, and by the way from the path between
/// its neighbours.
fn likeliest(fit: &Fit<'_>, found: &Candidates, path: &[(usize, c64)], i: usize) -> Option<usize> {
    let between = led_to(path, i);
    let least = found.solutions.iter().map(|s| s.misfit).min_by(f64::total_cmp)?;
    let scale = (least / fit.measured.len().max(1) as f64).max(f64::MIN_POSITIVE);
    let cost = |k: &usize| {
        let solution = &found.solutions[*k];
        let way = between.map_or(0.0, |log| ((fit.nominal + solution.correction).ln() - log).norm());
        // With one sensor every solution fits: the distance from the path alone decides.
        let misfit = if fit.measured.len() > 1 { solution.misfit / scale } else { 0.0 };
        misfit + (way / OFF_PATH_LN_STD).powi(2)
    };
    (0..found.solutions.len()).min_by(|a, b| cost(a).total_cmp(&cost(b)))
}
