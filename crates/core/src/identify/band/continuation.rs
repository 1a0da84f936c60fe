//! Solutions between frequencies at which all of them are known: followed as long as nothing speaks against it.

use super::candidates::{Candidates, Fit, LineCandidates, LinePoles, Solution};
use super::matching::{is_same, pairs};
use super::neighbourhoods::{Neighbourhoods, is_certain};
use super::path_model::{PathModel, fraction};
use crate::c64;
use crate::for_each::map;
use crate::frequency::omega_rad_s;
use crate::identify::context::{Context, Stage};
use crate::model::ModelAt;
use crate::rational::PolesBetween;
use crate::roots::{Candidate, Refusal};
use crate::subspace::Projection;
use crate::thinned::thinned;
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What it takes to follow.
pub(super) struct Continuation<'a, F> {
    pub(super) at: &'a [ModelAt<'a>],
    /// What is to be explained at a frequency.
    pub(super) fit: F,
    /// A misfit up to this one is noise.
    pub(super) usual: f64,
}

/// A solution whose misfit is larger by this factor than at both of its neighbours may not be the right one.
const MAX_MISFIT_OVER_NEIGHBOURS: f64 = 4.0;

/// Frequencies that are worth a model of their own.
const MIN_MODEL_FREQUENCIES: usize = 12;

/// Frequencies at which it is seen how far noise scatters solutions about their curve.
const SCATTER_FREQUENCIES: usize = 16;

/// The same solution at several frequencies (index).
type Curve<'e> = Vec<(usize, &'e Solution)>;

/// Frequencies between two stops, with what is known there.
struct Segment<'e, 'a> {
    model: &'e Projection,
    left: &'e LineCandidates,
    right: &'e LineCandidates,
    /// Each solution's misfit at the worse of the stops.
    misfits: Vec<f64>,
    path_models: &'e [PathModel<'e, 'a>],
    nominal: &'e PathModel<'e, 'a>,
    poles: Option<Arc<PolesBetween>>,
}

/// How far a solution was off its curve at the last frequency and at the one before. Where the line through both led to the last one better than the curve did, it goes on: to nearly where the
/// next one is if frequencies are dense and without noise, which a line multiplies.
#[derive(Debug, Clone, Copy, Default)]
struct Predictor {
    last: c64,
    before: c64,
    straight: bool,
}

impl Predictor {
    fn line(self) -> c64 {
        2.0 * self.last - self.before
    }

    fn expected(self) -> c64 {
        if self.straight { self.line() } else { c64::default() }
    }

    fn found(&mut self, off: c64) {
        let straight = (off - self.line()).norm_sqr() < off.norm_sqr();
        *self = Self { last: off, before: self.last, straight };
    }
}

impl<'a, F: Fn(usize) -> Fit<'a>> Continuation<'a, F> {
    /// Everything between frequencies (ascending, of one neighbourhood) that were explored on its model.
    pub(super) fn between(&self, model: &Projection, known: &[(usize, &Candidates)]) -> Vec<LineCandidates> {
        let mut stops: Vec<LineCandidates> = Vec::new();
        for &(index, explored) in known {
            let stop = LineCandidates { index, explored: explored.clone(), certain: Vec::new(), whole: true };
            if let Some(before) = stops.last().cloned() {
                self.close(model, &before, &stop, &mut stops);
            }
            stops.push(stop);
        }
        let mut found = Vec::new();
        let mut rest = &stops[..];
        while let [first, _, ..] = rest {
            // As far as the same solutions go on.
            let (mut curves, mut own): (Vec<Curve<'_>>, Vec<usize>) = (Vec::new(), Vec::new());
            let mut end = 0;
            while let Some(pairs) =
                rest.get(end + 1).and_then(|next| pairs(self.at, &rest[end], next, self.usual))
            {
                if end == 0 {
                    own = pairs.iter().map(|&(left, _)| left).collect();
                    curves =
                        first.explored.near(&own).map(|solution| vec![(first.index, solution)]).collect();
                }
                let mut carried = own.clone();
                carried.sort_unstable();
                if !carried.iter().eq(pairs.iter().map(|(left, _)| left)) {
                    break;
                }
                end += 1;
                for own in &mut own {
                    *own = pairs[carried.binary_search(own).unwrap_or_default()].1;
                }
                let next = rest[end].explored.near(&own);
                curves
                    .iter_mut()
                    .zip(next)
                    .for_each(|(curve, solution)| curve.push((rest[end].index, solution)));
            }
            found.extend(self.run(model, &rest[..=end], &curves));
            rest = &rest[end.max(1)..];
        }
        stops.retain(|stop| known.iter().all(|&(index, _)| index != stop.index));
        found.extend(stops);
        found
    }

    /// Explores half-way between two frequencies until neighbours have the same solutions, or nothing between them.
    fn close(
        &self,
        model: &Projection,
        left: &LineCandidates,
        right: &LineCandidates,
        stops: &mut Vec<LineCandidates>,
    ) {
        if right.index - left.index < 2 || pairs(self.at, left, right, self.usual).is_some() {
            return;
        }
        let middle = self.explore(model, left.index.midpoint(right.index));
        self.close(model, left, &middle, stops);
        stops.push(middle.clone());
        self.close(model, &middle, right, stops);
    }

    fn explore(&self, model: &Projection, index: usize) -> LineCandidates {
        let explored = (self.fit)(index).explore_reduced(model, &self.at[index]);
        LineCandidates { index, explored, certain: Vec::new(), whole: true }
    }

    /// What is between stops that have the same solutions.
    fn run(&self, model: &Projection, stops: &[LineCandidates], curves: &[Curve<'_>]) -> Vec<LineCandidates> {
        let (first, last) = (stops[0].index, stops[stops.len() - 1].index);
        if last - first < stops.len() {
            return Vec::new();
        }
        let own = last - first >= MIN_MODEL_FREQUENCIES + stops.len();
        let nominal_at = |i: usize| self.at[i].parameters[0].nominal;
        let path_model = |curve: &Curve<'_>| {
            let points = curve.iter().map(|&(i, solution)| (i, nominal_at(i) + solution.correction));
            let path_model = PathModel::along(self.at, points.collect(), model, own);
            let estimate = |&i: &usize| {
                let start = path_model.factor(i) - nominal_at(i);
                let estimate = (self.fit)(i).descend(|c| path_model.respond_with_slope(i, c), start)?;
                Some((i, estimate.correction))
            };
            let all: Vec<usize> = (first..=last).collect();
            let answers: Vec<(usize, c64)> =
                thinned(&all, SCATTER_FREQUENCIES).filter_map(estimate).collect();
            path_model.widened(model, &answers)
        };
        let path_models: Vec<PathModel<'_, 'a>> = curves.iter().map(path_model).collect();
        let nominal =
            PathModel::along(self.at, (first..=last).map(|i| (i, nominal_at(i))).collect(), model, own);
        let mut found = Vec::with_capacity(last - first);
        for (k, pair) in stops.windows(2).enumerate() {
            let [left, right] = pair else { continue };
            if right.index - left.index < 2 {
                continue;
            }
            let ends = left.explored.poles.as_ref().zip(right.explored.poles.as_ref());
            let poles = ends.map(|(a, b)| {
                let omega_squared = |i: usize| omega_rad_s(self.at[i].frequency_hz).powi(2);
                let both = [left.index, right.index];
                let ends = [&*a.get(), &*b.get()];
                Arc::new(PolesBetween::new(ends, both.map(nominal_at), both.map(omega_squared)))
            });
            let misfits = curves.iter().map(|curve| curve[k].1.misfit.max(curve[k + 1].1.misfit)).collect();
            let segment =
                Segment { model, left, right, misfits, path_models: &path_models, nominal: &nominal, poles };
            let mut off = vec![Predictor::default(); path_models.len()];
            for i in left.index + 1..right.index {
                found.push(self.follow(&segment, i, &mut off).unwrap_or_else(|| self.explore(model, i)));
            }
        }
        found
    }

    /// The same solutions at a frequency between; `None` where one is not found beyond doubt.
    fn follow(
        &self,
        segment: &Segment<'_, 'a>,
        index: usize,
        off: &mut [Predictor],
    ) -> Option<LineCandidates> {
        let (fit, at) = ((self.fit)(index), &self.at[index]);
        let nominal = at.parameters[0].nominal;
        let starts: Vec<c64> =
            segment.path_models.iter().map(|path_model| path_model.factor(index)).collect();
        let (left, right) = (&segment.left.explored, &segment.right.explored);
        let mut explored = Candidates { order: left.order.max(right.order), ..Candidates::default() };
        let mut certain = Vec::new();
        let residuals = [left, right].into_iter().flat_map(|end| &end.solutions).map(|s| s.residual);
        let residual = residuals.fold(0.0, f64::max);
        for (k, path_model) in segment.path_models.iter().enumerate() {
            let start = starts[k] + off[k].expected() - nominal;
            let (respond, assess) =
                (|c| path_model.respond_with_slope(index, c), |c| path_model.assess(index, c));
            let (mut solution, assessed) = match fit.arrive(respond, assess, start) {
                Ok((solution, assessed)) => (solution, Some(assessed)),
                Err(stopped) => {
                    let solution = fit.descend(respond, stopped)?;
                    let assessed = assess(solution.correction);
                    (solution, assessed)
                }
            };
            match assessed.filter(|assessed| is_certain(at, solution.correction, assessed)) {
                Some(assessed) => certain.push((solution.correction, assessed)),
                // The curve's model leads there; the neighbourhood's has the last digits.
                None => solution = fit.descend(fit.on(segment.model, at), solution.correction)?,
            }
            let factor = nominal + solution.correction;
            off[k].found(factor - starts[k]);
            if !is_same(&starts, k, factor)
                || solution.misfit > self.usual.max(MAX_MISFIT_OVER_NEIGHBOURS * segment.misfits[k])
            {
                return None;
            }
            match fit.unknown.bounds.broken_by(factor) {
                None => explored.solutions.push(Solution { residual, ..solution }),
                Some(bound) => {
                    let (correction, refusal) = (solution.correction, Some(Refusal::OutOfBounds(bound)));
                    explored.refused.push(Candidate { correction, drift: f64::INFINITY, refusal });
                }
            }
        }
        explored.solutions.sort_by(|a, b| a.correction.norm().total_cmp(&b.correction.norm()));
        explored.nominal_response = segment.nominal.respond(index).ok()?;
        let t = fraction(self.at, segment.left.index, index, segment.right.index);
        let between = |stops: &Arc<PolesBetween>| LinePoles::Between { stops: Arc::clone(stops), t, nominal };
        explored.poles = segment.poles.as_ref().map(between);
        Some(LineCandidates { index, explored, certain, whole: false })
    }
}

/// Frequencies that are followed together, about: a model for a curve takes as long as some dozens of them.
const FREQUENCIES_PER_PIECE: usize = 200;

/// The whole band (ascending) from anchors on the models of the space.
pub(super) fn continued<'a, F: Fn(usize) -> Fit<'a> + Sync>(
    reduced: &mut Neighbourhoods<'_, '_>,
    continuation: &Continuation<'a, F>,
    explored_lines: &[usize],
    explored: Vec<Candidates>,
    context: Context<'_>,
) -> Vec<LineCandidates> {
    let n = continuation.at.len();
    reduced.localise(&(0..n).collect::<Vec<_>>(), context.for_each);
    let groups = groups(explored_lines, reduced.neighbourhoods());
    let done = AtomicUsize::new(explored_lines.len());
    let lent = &*reduced;
    let between = map(context.for_each, groups.len(), |g| {
        let known: Vec<(usize, &Candidates)> =
            groups[g].clone().map(|k| (explored_lines[k], &explored[k])).collect();
        let found = continuation.between(lent.model(known[0].0), &known);
        (context.progress)(Stage::Solutions, done.fetch_add(found.len(), Ordering::Relaxed) + found.len(), n);
        found
    });
    let known = explored_lines.iter().zip(explored);
    let known =
        known.map(|(&index, explored)| LineCandidates { index, explored, certain: Vec::new(), whole: true });
    let mut all: Vec<LineCandidates> = between.into_iter().flatten().chain(known).collect();
    all.sort_by_key(|found| found.index);
    for found in &mut all {
        found
            .certain
            .drain(..)
            .for_each(|(correction, assessed)| reduced.remember(found.index, correction, assessed));
    }
    all
}

/// Anchors (by their place among all) that are followed together: neighbours, of one neighbourhood.
fn groups(
    explored_lines: &[usize],
    neighbourhoods: impl Iterator<Item = [usize; 2]>,
) -> Vec<RangeInclusive<usize>> {
    let mut groups = Vec::new();
    for [first, last] in neighbourhoods {
        let mut from = explored_lines.partition_point(|&i| i < first);
        let end = explored_lines.partition_point(|&i| i <= last);
        while from + 1 < end {
            let reach = explored_lines.partition_point(|&i| i < explored_lines[from] + FREQUENCIES_PER_PIECE);
            let to = reach.clamp(from + 1, end - 1);
            groups.push(from..=to);
            from = to;
        }
    }
    groups
}
