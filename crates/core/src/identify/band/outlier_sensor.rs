//! A sensor that contradicts the others: found by leaving out each in turn.

use super::candidates::Candidates;
use super::neighbourhoods::Neighbourhoods;
use super::task::Task;
use crate::for_each::map;
use crate::frfs::Noise;
use crate::identify::context::Context;
use crate::identify::goodness_of_fit::MIN_DOUBTFUL_MISFIT;
use crate::identify::noise::{freedom, level_of, without};
use crate::response::{FullModel, Response, Work};
use crate::subspace::Projection;
use crate::thinned::thinned;

/// Frequencies at which it is tried: the median of their χ² is known to a third, and a sensor at fault changes it by a factor of ten.
pub(in crate::identify) const OUTLIER_FREQUENCIES: usize = 24;

/// A sensor is at fault if χ² without it is smaller by this factor than with it, and than without any other: its misfit is then more than
/// three times what all others show.
pub(in crate::identify) const OUTLIER_RATIO: f64 = 10.0;

/// The sensors that contradict the others, worst first, and the work of size N that it took to find them. Of two sensors
/// it cannot be known which is wrong. Those that are `hidden` are left out throughout.
pub(super) fn contradicting(
    task: &Task<'_, '_>,
    reduced: Option<&mut Neighbourhoods<'_, '_>>,
    hidden: &[usize],
) -> (Vec<usize>, Work) {
    let sensors = task.band.experiment.sensors.len();
    let mut trial = Trial { task, reduced, work: Work::default() };
    let mut out: Vec<usize> = hidden.to_vec();
    // A single sensor beside those that are left out explains everything.
    while sensors - out.len() > 2 {
        let with_all = trial.misfit(&out);
        let floor = match task.band.noise {
            Noise::Known(_) | Noise::Common(_) => 1.0,
            Noise::Unknown | Noise::Floor(_) | Noise::Relative(_) => {
                MIN_DOUBTFUL_MISFIT * MIN_DOUBTFUL_MISFIT
            }
        };
        if with_all <= OUTLIER_RATIO * floor {
            break;
        }
        let mut without: Vec<(f64, usize)> = (0..sensors)
            .filter(|m| !out.contains(m))
            .map(|m| (trial.misfit(&[&out[..], &[m]].concat()), m))
            .collect();
        without.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (least, worst) = without[0];
        if OUTLIER_RATIO * least.max(floor) < with_all.min(without[1].0) {
            out.push(worst);
        } else {
            break;
        }
    }
    (out.split_off(hidden.len()), trial.work)
}

struct Trial<'t, 'a, 's, 'b, 'o> {
    task: &'t Task<'t, 'a>,
    reduced: Option<&'s mut Neighbourhoods<'b, 'o>>,
    work: Work,
}

impl Trial<'_, '_, '_, '_, '_> {
    /// χ² over its usual size without some sensors: the median over some frequencies of the best solution at each. Infinite where most have none.
    fn misfit(&mut self, out: &[usize]) -> f64 {
        let task = self.task;
        let all: Vec<usize> = (0..task.at.len()).collect();
        let which: Vec<usize> = thinned(&all, OUTLIER_FREQUENCIES).copied().collect();
        let sigma = without(task.sigma, out);
        let task = Task { sigma: &sigma, ..*task };
        let quiet = Context { progress: &|_, _, _| {}, ..task.context };
        let best = |explored: &Candidates| {
            let misfits = explored.solutions.iter().map(|solution| solution.misfit);
            misfits.min_by(f64::total_cmp).unwrap_or(f64::INFINITY)
        };
        let misfits = match &mut self.reduced {
            Some(reduced) => {
                let find =
                    |i: usize, model: &Projection| best(&task.fit(i).explore_reduced(model, &task.at[i]));
                reduced.find(&which, quiet, find)
            }
            None => {
                let find = |k: usize| {
                    let i = which[k];
                    match FullModel::new(task.at[i].clone(), task.band.experiment) {
                        Ok(system) => {
                            (best(&task.fit(i).explore(&system, task.options.order)), system.work())
                        }
                        Err(_) => (f64::INFINITY, Work { factorisations: 1, solves: 0 }),
                    }
                };
                let found = map(task.context.for_each, which.len(), find);
                found.iter().for_each(|(_, own)| self.work += *own);
                found.into_iter().map(|(misfit, _)| misfit).collect()
            }
        };
        let left = task.band.experiment.sensors.len() - out.len();
        level_of(misfits, freedom(left, task.band.unknown.real)).map_or(0.0, |level| level * level)
    }
}
