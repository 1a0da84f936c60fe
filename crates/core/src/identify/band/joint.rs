//! All frequencies and all sensors together.

use super::anchors::anchors;
use super::explore::{Explored, Fit};
use super::follow::{Follower, follow};
use super::space::Space;
use super::verdict::{Evidence, verdict};
use super::{Band, BandOutcome, Hooks, Noise, Stage};
use crate::c64;
use crate::for_each::map;
use crate::identify::{Identified, Options};
use crate::model::ModelAt;
use crate::response::{FullModel, Response, Work};
use crate::select::{Choice, Node, SelectOptions, choose};
use crate::subspace::Projection;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Where no deviation is given, sensors count by their own size, but not below this fraction of their median over the band: an antiresonance is
/// not measured any better than the rest.
const RELATIVE_FLOOR: f64 = 0.1;

/// No instrument is better than this fraction of the largest response: a smaller deviation, or none at all, is not believed.
const LEAST_STD: f64 = 1e-9;

pub(super) fn identify<'a>(
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    mut space: Option<Space<'a, '_>>,
    options: &Options,
    hooks: Hooks<'_>,
) -> BandOutcome {
    let sigma = deviations(band);
    let nominal = |i: usize| at[i].parameters[0].nominal;
    let select = SelectOptions {
        sensors: band.experiment.sensors.len(),
        sigma_known: matches!(band.noise, Noise::Known(_)),
        ..SelectOptions::default()
    };
    let select = |which: &[usize], found: &[Explored]| {
        (hooks.progress)(Stage::Selection, 0, at.len());
        let frequency_hz: Vec<f64> = which.iter().map(|&i| band.frequency_hz[i]).collect();
        let nodes: Vec<Vec<Node>> = which.iter().zip(found).map(|(&i, f)| nodes(f, nominal(i))).collect();
        (choose(&frequency_hz, &nodes, &select), noise_level(&nodes, band))
    };
    // The choice that the last answers were taken by.
    let mut selected = None;
    let fit = |i: usize| Fit { measured: &band.measured[i], sigma: &sigma[i], nominal: nominal(i), options };
    let (explored, whole, mut work) = match &mut space {
        Some(space) => {
            let find = |i: usize, model: &Projection| fit(i).explore_reduced(model, &at[i]);
            let settle = |i: usize, model: &Projection, before: &Explored| {
                let fit = fit(i);
                fit.settle(before.clone(), fit.on(model, &at[i]))
            };
            let pilots = space.pilots();
            let found = space.find(&pilots, hooks, find);
            space.certify(&pilots, found, hooks, settle, |found| taken(&select(&pilots, found).0, found));
            let anchors = anchors(band.frequency_hz, space.neighbourhoods());
            let found = space.find(&anchors, hooks, find);
            let mut level = None;
            let found = space.certify(&anchors, found, hooks, settle, |found| {
                let (choices, noise) = selected.insert(select(&anchors, found));
                level = *noise;
                taken(choices, found)
            });
            if anchors.len() == at.len() {
                (found, at.len(), Work::default())
            } else {
                let follower = Follower { at, fit, usual: usual(level, band.experiment.sensors.len()) };
                let found = follow(space, &follower, &anchors, found, hooks);
                let whole = found.iter().filter(|found| found.whole).count();
                let all: Vec<usize> = (0..at.len()).collect();
                let explored = found.into_iter().map(|found| found.explored).collect();
                let explored = space.certify(&all, explored, hooks, settle, |found| {
                    let (choices, _) = selected.insert(select(&all, found));
                    taken(choices, found)
                });
                (explored, whole, Work::default())
            }
        }
        None => {
            let (found, work) = on_full_model(band, at, &sigma, options, hooks);
            (found, at.len(), work)
        }
    };
    let (choices, noise) = selected.unwrap_or_else(|| select(&(0..at.len()).collect::<Vec<_>>(), &explored));
    let outcomes: Vec<Identified> = map(hooks.for_each, at.len(), |i| {
        let chosen = choices[i].chosen.map(|k| explored[i].solutions[k].correction);
        let assessment = space.as_ref().zip(chosen).and_then(|(space, c)| space.assess(i, c));
        let evidence = Evidence { at: &at[i], measured: &band.measured[i], noise, assessment };
        verdict(&evidence, &explored[i], &choices[i], options)
    });
    if let Some(space) = &space {
        work += space.work();
    }
    BandOutcome { outcomes, work, subspace_size: space.map(|space| space.size()), explored: whole }
}

/// A misfit with this many nats more than noise has on average is not noise: one in a hundred thousand.
const NATS: f64 = 12.0;

/// The misfit up to which all is noise of that level; a single sensor has none.
fn usual(level: Option<f64>, sensors: usize) -> f64 {
    let freedom = 2.0 * (sensors as f64 - 1.0);
    // As the selection does, a millionth of the response is taken for roundoff near a resonance.
    level.map_or(f64::INFINITY, |level| (freedom + 2.0 * NATS) * level.max(1e-6).powi(2))
}

/// The corrections (k, c) that are chosen at the k-th frequency, or may have to be.
fn taken(choices: &[Choice], found: &[Explored]) -> Vec<(usize, c64)> {
    let of = |(k, choice): (usize, &Choice)| {
        let taken = choice.chosen.into_iter().chain(choice.alternatives.iter().copied());
        taken.map(|s| (k, found[k].solutions[s].correction)).collect::<Vec<_>>()
    };
    choices.iter().enumerate().flat_map(of).collect()
}

fn on_full_model(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    sigma: &[Vec<f64>],
    options: &Options,
    hooks: Hooks<'_>,
) -> (Vec<Explored>, Work) {
    let done = AtomicUsize::new(0);
    let found = map(hooks.for_each, at.len(), |i| {
        let explored = match FullModel::new(at[i].clone(), band.experiment) {
            Ok(system) => {
                let fit = Fit {
                    measured: &band.measured[i],
                    sigma: &sigma[i],
                    nominal: system.nominal(0),
                    options,
                };
                let mut explored = fit.explore(&system, options.order);
                explored.confirm(&system, &band.measured[i], &sigma[i]);
                (explored, system.work())
            }
            Err(breakdown) => (Explored::broken(breakdown), Work { factorisations: 1, solves: 0 }),
        };
        (hooks.progress)(Stage::Solutions, done.fetch_add(1, Ordering::Relaxed) + 1, at.len());
        explored
    });
    let mut work = Work::default();
    found.iter().for_each(|(_, own)| work += *own);
    (found.into_iter().map(|(explored, _)| explored).collect(), work)
}

/// σ of real and imaginary part each, `[frequency][sensor]`: as given, or in proportion to the response.
fn deviations(band: &Band<'_>) -> Vec<Vec<f64>> {
    let sensors = 0..band.experiment.sensors.len();
    let sorted = |m: usize| {
        let mut sizes: Vec<f64> = band.measured.iter().map(|u| u[m].norm()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    };
    let sizes: Vec<Vec<f64>> = sensors.map(sorted).collect();
    let row = |(i, u): (usize, &Vec<c64>)| {
        let of = |(m, u): (usize, &c64)| match band.noise {
            Noise::Known(std) | Noise::Relative(std) => {
                (std[i][m] / 2f64.sqrt()).max(LEAST_STD * sizes[m][sizes[m].len() - 1])
            }
            Noise::Unknown => u.norm().max(RELATIVE_FLOOR * sizes[m][sizes[m].len() / 2]),
        };
        u.iter().enumerate().map(of).collect()
    };
    band.measured.iter().enumerate().map(row).collect()
}

fn nodes(found: &Explored, nominal: c64) -> Vec<Node> {
    let node =
        |s: &super::explore::Solution| Node { factor: nominal + s.correction, misfit: s.misfit, std: s.std };
    found.solutions.iter().map(node).collect()
}

/// Noise over σ: 1 where σ was given; otherwise from how well the best solutions explain the sensors, and `None` for a single sensor, which
/// everything explains.
fn noise_level(nodes: &[Vec<Node>], band: &Band<'_>) -> Option<f64> {
    if matches!(band.noise, Noise::Known(_)) {
        return Some(1.0);
    }
    let freedom = 2.0 * (band.experiment.sensors.len() as f64 - 1.0);
    let best = |nodes: &Vec<Node>| nodes.iter().map(|node| node.misfit).min_by(f64::total_cmp);
    let mut least: Vec<f64> = nodes.iter().filter_map(best).collect();
    least.sort_by(f64::total_cmp);
    let median = least.get(least.len() / 2).filter(|_| freedom > 0.0)?;
    Some((median / freedom).sqrt())
}
