//! A whole band on the subspace: everything at some frequencies, what is between them followed, and all answers certified.

use super::candidates::{Candidates, LineCandidates};
use super::continuation::{Continuation, continued};
use super::exploration_grid::exploration_grid;
use super::neighbourhoods::Neighbourhoods;
use super::task::{BandSolution, PathSelection, Task, led_to};
use crate::c64;
use crate::select::Choice;
use crate::subspace::Projection;

pub(super) fn on_reduced(task: &Task<'_, '_>, reduced: &mut Neighbourhoods<'_, '_>) -> BandSolution {
    let (at, context) = (task.at, task.context);
    // A subspace that was trained at answers is good at most others.
    if !reduced.has_answers() {
        let pilots = reduced.pilots();
        explored(task, reduced, &pilots);
    }
    let all: Vec<usize> = (0..at.len()).collect();
    let grid = if task.options.everywhere {
        all.clone()
    } else {
        exploration_grid(task.band.frequency_hz, reduced.neighbourhoods())
    };
    let found = explored(task, reduced, &grid);
    let (found, selected) = along_path(task, reduced, &grid, found);
    if grid.len() == all.len() {
        return BandSolution { explored: all.len(), found, selected };
    }

    let usual = usual(selected.level, task.freedom());
    let continuation = Continuation { at, fit: |i| task.fit(i), usual };
    let mut found = continued(reduced, &continuation, &grid, found, context);
    let mut ready = Some(task.select(&all, found.iter().map(|found| &found.explored)));
    // Where there is nothing to choose, something may have been lost on the way.
    let nothing = |i: usize| ready.as_ref().is_some_and(|selected| selected.choices[i].chosen.is_none());
    let lost: Vec<usize> = all.iter().copied().filter(|&i| !found[i].whole && nothing(i)).collect();
    if !lost.is_empty() {
        for (&index, explored) in lost.iter().zip(found_at(task, reduced, &lost)) {
            found[index] = LineCandidates { index, explored, certain: Vec::new(), whole: true };
        }
        ready = None;
    }
    let explored = found.iter().filter(|found| found.whole).count();
    let found = found.into_iter().map(|found| found.explored).collect();
    let found = certified(task, reduced, &all, found, ready);
    let (found, selected) = along_path(task, reduced, &all, found);
    BandSolution { found, explored, selected }
}

/// Times that a path is made longer at most.
const MAX_EXTENSIONS: usize = 3;

/// Where the path has nothing, the models of neighbourhoods are made good at the values to which it leads, and everything is searched again: in a dense band a mode
/// between the values that a model was made for is missing in it, and with it the solution.
fn along_path(
    task: &Task<'_, '_>,
    reduced: &mut Neighbourhoods<'_, '_>,
    grid: &[usize],
    (mut found, mut selected): (Vec<Candidates>, PathSelection),
) -> (Vec<Candidates>, PathSelection) {
    for _ in 0..MAX_EXTENSIONS {
        let nominal = |k: usize| task.at[grid[k]].parameters[0].nominal;
        let path = selected.path(&found, nominal);
        // A path through little of the band may be a wrong one.
        if 2 * path.len() < grid.len() {
            break;
        }
        let lost: Vec<usize> = (0..grid.len()).filter(|&k| selected.choices[k].chosen.is_none()).collect();
        let led = |k: usize| Some((grid[k], led_to(&path, k)?.exp() - nominal(k)));
        let led: Vec<(usize, c64)> = lost.iter().filter_map(|&k| led(k)).collect();
        let correction = |i: usize| led.binary_search_by_key(&i, |&(i, _)| i).ok().map(|k| led[k].1);
        let lacking = reduced.lacking(correction, task.context.for_each);
        if lacking.is_empty() || !reduced.refine(&lacking, task.context).unwrap_or(false) {
            break;
        }
        let which: Vec<usize> = lost.iter().map(|&k| grid[k]).collect();
        let again = found_at(task, reduced, &which);
        lost.iter().zip(again).for_each(|(&k, again)| found[k] = again);
        (found, selected) = certified(task, reduced, grid, found, None);
        if selected.choices.iter().filter(|choice| choice.chosen.is_some()).count() <= path.len() {
            break;
        }
    }
    (found, selected)
}

/// What there is at some frequencies (ascending), certified, and the choice among that.
pub(super) fn explored(
    task: &Task<'_, '_>,
    reduced: &mut Neighbourhoods<'_, '_>,
    which: &[usize],
) -> (Vec<Candidates>, PathSelection) {
    let found = found_at(task, reduced, which);
    certified(task, reduced, which, found, None)
}

/// What there is at some frequencies (ascending).
fn found_at(task: &Task<'_, '_>, reduced: &mut Neighbourhoods<'_, '_>, which: &[usize]) -> Vec<Candidates> {
    let find = |i: usize, model: &Projection| task.fit(i).explore_reduced(model, &task.at[i]);
    reduced.find(which, task.context, find)
}

/// What was found at some frequencies (ascending), certified, and the choice among that; `ready` is the choice among what was found, where it was made already.
fn certified(
    task: &Task<'_, '_>,
    reduced: &mut Neighbourhoods<'_, '_>,
    which: &[usize],
    found: Vec<Candidates>,
    mut ready: Option<PathSelection>,
) -> (Vec<Candidates>, PathSelection) {
    let settle = |i: usize, model: &Projection, before: &Candidates| {
        let fit = task.fit(i);
        fit.settle(before.clone(), fit.on(model, &task.at[i]))
    };
    // The choice that the last answers were taken by.
    let mut selected = None;
    let found = reduced.certify(which, found, task.context, settle, |found| {
        let again = || task.select(which, found.iter());
        let PathSelection { choices, .. } = selected.insert(ready.take().unwrap_or_else(again));
        taken(choices, found)
    });
    let selected = selected.unwrap_or_else(|| task.select(which, found.iter()));
    (found, selected)
}

/// A misfit with this many nats more than noise has on average is not noise: one in a hundred thousand.
const NOISE_NATS: f64 = 12.0;

/// The misfit up to which all is noise of that level; a single sensor has none.
fn usual(level: Option<f64>, freedom: usize) -> f64 {
    let freedom = freedom as f64;
    // As the selection does, a millionth of the response is taken for roundoff near a resonance.
    level.map_or(f64::INFINITY, |level| (freedom + 2.0 * NOISE_NATS) * level.max(1e-6).powi(2))
}

/// The corrections (k, c) that are chosen at the k-th frequency, or may have to be.
fn taken(choices: &[Choice], found: &[Candidates]) -> Vec<(usize, c64)> {
    let of = |(k, choice): (usize, &Choice)| {
        let taken = choice.chosen.into_iter().chain(choice.rivals.iter().copied());
        taken.map(|s| (k, found[k].solutions[s].correction)).collect::<Vec<_>>()
    };
    choices.iter().enumerate().flat_map(of).collect()
}
