//! All frequencies and all sensors together.

use super::explore::{Explored, explore};
use super::space::Space;
use super::verdict::{Evidence, verdict};
use super::{Band, BandOutcome, Hooks, Noise, Stage};
use crate::c64;
use crate::for_each::map;
use crate::identify::{Identified, Options, relative_error};
use crate::model::ModelAt;
use crate::response::{FullModel, Response, Work};
use crate::select::{Node, SelectOptions, choose};
use crate::subspace::ReducedModel;
use frfit_linalg::solve::Breakdown;
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
    let (explored, mut work) = match &mut space {
        Some(space) => (on_subspace(band, space, &sigma, options, hooks), Work::default()),
        None => on_full_model(band, at, &sigma, options, hooks),
    };
    (hooks.progress)(Stage::Selection, 0, at.len());
    let nominal = |i: usize| at[i].parameters[0].nominal;
    let nodes: Vec<Vec<Node>> =
        explored.iter().enumerate().map(|(i, found)| nodes(found, nominal(i))).collect();
    let known =
        SelectOptions { sigma_known: matches!(band.noise, Noise::Known(_)), ..SelectOptions::default() };
    let choices = choose(band.frequency_hz, &nodes, &known);
    let noise = noise_level(&nodes, band);
    let outcomes: Vec<Identified> = (0..at.len())
        .map(|i| {
            let chosen = choices[i].chosen.map(|k| explored[i].solutions[k].correction);
            let assessment =
                space.as_ref().zip(chosen).and_then(|(space, c)| space.model(i).assess(&at[i], c).ok());
            let evidence = Evidence { at: &at[i], measured: &band.measured[i], noise, assessment };
            verdict(&evidence, &explored[i], &choices[i], options)
        })
        .collect();
    if let Some(space) = &space {
        work += space.work();
    }
    BandOutcome { outcomes, work, subspace_size: space.map(|space| space.size()) }
}

fn on_subspace(
    band: &Band<'_>,
    space: &mut Space<'_, '_>,
    sigma: &[Vec<f64>],
    options: &Options,
    hooks: Hooks<'_>,
) -> Vec<Explored> {
    let find = |i: usize, system: Result<ReducedModel<'_>, Breakdown>| match system {
        // Vectors of this length cost nothing: the order bounds those of the full model.
        Ok(system) => {
            let mut explored = explore(&system, &band.measured[i], &sigma[i], options, system.dim());
            // What is certified is the subspace's own response, not that of the Krylov space within.
            explored.confirm(&system, &band.measured[i], &sigma[i]);
            explored
        }
        Err(breakdown) => Explored::broken(breakdown),
    };
    space.solve(hooks, find, |i, found| relevant(found, &band.measured[i]))
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
                let mut explored = explore(&system, &band.measured[i], &sigma[i], options, options.order);
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

/// The corrections that may be the answer: those that explain all sensors about as well as the best one does. Beside the right one the others are
/// off by many times that; where it is not found, the best is wrong too, and nothing is lost.
fn relevant(found: &Explored, measured: &[c64]) -> Vec<c64> {
    let errors: Vec<f64> = found.solutions.iter().map(|s| relative_error(measured, &s.response)).collect();
    let best = errors.iter().copied().fold(f64::INFINITY, f64::min);
    // The subspace's first errors are 1e-6 of the response, more on antiresonances.
    let near = |error: &f64| *error <= 100.0 * best + 1e-3;
    found.solutions.iter().zip(&errors).filter(|(_, error)| near(error)).map(|(s, _)| s.correction).collect()
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
