//! All frequencies and all sensors together.

use super::explore::{Explored, Fit};
use super::on_space::on_space;
use super::space::Space;
use super::verdict::{Evidence, verdict};
use super::{Band, BandOutcome, Hooks, Noise, Stage};
use crate::c64;
use crate::for_each::map;
use crate::identify::{Identified, Options};
use crate::model::ModelAt;
use crate::response::{FullModel, Response, Work};
use crate::select::{Choice, Node, SelectOptions, choose};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Where no deviation is given, sensors count by their own size, but not below this fraction of their median over the band: an antiresonance is
/// not measured any better than the rest.
const RELATIVE_FLOOR: f64 = 0.1;

/// No instrument is better than this fraction of the largest response: a smaller deviation, or none at all, is not believed.
const LEAST_STD: f64 = 1e-9;

/// What is to be done, and with what.
pub(super) struct Task<'t, 'a> {
    pub(super) band: &'t Band<'a>,
    pub(super) at: &'t [ModelAt<'a>],
    pub(super) sigma: &'t [Vec<f64>],
    pub(super) options: &'t Options,
    pub(super) hooks: Hooks<'t>,
}

/// The choice at each of some frequencies, and noise over σ.
pub(super) type Selected = (Vec<Choice>, Option<f64>);

/// What was found at every frequency, at how many of them all solutions were looked for, and what was chosen.
pub(super) struct Solved {
    pub(super) found: Vec<Explored>,
    pub(super) explored: usize,
    pub(super) selected: Selected,
}

impl Task<'_, '_> {
    /// What is to be explained at a frequency.
    pub(super) fn fit(&self, i: usize) -> Fit<'_> {
        let nominal = self.at[i].parameters[0].nominal;
        Fit { measured: &self.band.measured[i], sigma: &self.sigma[i], nominal, options: self.options }
    }

    /// The choice among what was found at some frequencies.
    pub(super) fn select<'e>(&self, which: &[usize], found: impl Iterator<Item = &'e Explored>) -> Selected {
        (self.hooks.progress)(Stage::Selection, 0, self.at.len());
        let frequency_hz: Vec<f64> = which.iter().map(|&i| self.band.frequency_hz[i]).collect();
        let nodes: Vec<Vec<Node>> = which
            .iter()
            .zip(found)
            .map(|(&i, found)| nodes(found, self.at[i].parameters[0].nominal))
            .collect();
        let options = SelectOptions {
            sensors: self.band.experiment.sensors.len(),
            sigma_known: matches!(self.band.noise, Noise::Known(_)),
            ..SelectOptions::default()
        };
        (choose(&frequency_hz, &nodes, &options), noise_level(&nodes, self.band))
    }
}

pub(super) fn identify<'a>(
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    space: &mut Option<Space<'a, '_>>,
    options: &Options,
    hooks: Hooks<'_>,
) -> BandOutcome {
    let sigma = deviations(band);
    let task = Task { band, at, sigma: &sigma, options, hooks };
    let (solved, mut work) = match space {
        Some(space) => (on_space(&task, space), Work::default()),
        None => {
            let (found, work) = on_full_model(&task);
            let all: Vec<usize> = (0..at.len()).collect();
            (Solved { explored: all.len(), selected: task.select(&all, found.iter()), found }, work)
        }
    };
    let Solved { found, explored, selected: (choices, noise) } = solved;
    let outcomes: Vec<Identified> = map(hooks.for_each, at.len(), |i| {
        let chosen = choices[i].chosen.map(|k| found[i].solutions[k].correction);
        let assessment = space.as_ref().zip(chosen).and_then(|(space, c)| space.assess(i, c));
        let evidence = Evidence { at: &at[i], measured: &band.measured[i], noise, assessment };
        verdict(&evidence, &found[i], &choices[i], options)
    });
    if let Some(space) = space {
        work += space.work();
    }
    BandOutcome { outcomes, work, subspace_size: space.as_ref().map(|space| space.size()), explored }
}

fn on_full_model(task: &Task<'_, '_>) -> (Vec<Explored>, Work) {
    let Task { band, at, sigma, options, hooks } = *task;
    let done = AtomicUsize::new(0);
    let found = map(hooks.for_each, at.len(), |i| {
        let explored = match FullModel::new(at[i].clone(), band.experiment) {
            Ok(system) => {
                let mut explored = task.fit(i).explore(&system, options.order);
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
pub(super) fn deviations(band: &Band<'_>) -> Vec<Vec<f64>> {
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
