//! The numbers that hold for the band, with what each frequency has of its own eliminated.

use super::Task;
use super::at_frequency::{Solution, eliminate};
use super::coordinates::Coordinates;
use super::information::Information;
use super::neighbourhoods::{Answer, Neighbourhoods, ROUGH_MODEL_TOL, between, in_box};
use super::path::Chosen;
use crate::c64;
use crate::for_each::map;
use crate::identify::band::{Fit, MAX_TRAINING_ROUNDS, nearest};
use crate::identify::context::Stage;
use crate::identify::unknown::Dependence;
use crate::identify::unknown::Unknown;
use crate::laws::{Datum, Parametrization};
use crate::least_squares::{Minimum, Search, descend};
use crate::subspace::Projection;
use crate::thinned::thinned;

/// Frequencies at most at which logarithms are compared.
const LOG_RESPONSE_FREQUENCIES: usize = 160;

/// On which model, and for which θ, a frequency is looked at.
pub(super) struct At<'t, 'a> {
    pub(super) reduced: &'t Neighbourhoods<'a>,
    pub(super) coordinates: &'t Coordinates,
    pub(super) theta: &'t [f64],
}

/// What was found at some frequencies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BandSolution {
    pub(super) coordinates: Coordinates,
    pub(super) theta: Vec<f64>,
    /// All solutions at each frequency, for that θ.
    pub(super) solutions: Vec<Vec<Solution>>,
    pub(super) chosen: Vec<Chosen>,
    /// Whether the search ended because there was nothing more to gain.
    pub(super) converged: bool,
    /// Starts that were compared, the one that was taken first, and how many ended where it did.
    pub(super) starts: Vec<Begin>,
    pub(super) agreeing: usize,
}

/// Frequencies at which starts are compared.
const START_FREQUENCIES: usize = 48;

/// Points of the box for each unknown that a frequency has of its own.
const BOX_POINTS_PER_UNKNOWN: usize = 8;

/// Values of one of two unknowns of a frequency at which all of the other are searched: to an octave, or in all where the range is not positive.
const SCAN_VALUES_PER_OCTAVE: f64 = 8.0;
const SCAN_VALUES: usize = 16;

/// Starts that are followed on the whole model at once.
const WHOLE_MODEL_STARTS: usize = 4;

/// Frequencies at which solutions are searched all over the box: so many at least, and every so-many-th at least. Between them those of both sides are followed.
const MIN_GRID_LINES: usize = 12;
const MAX_GRID_STRIDE: usize = 8;

/// Choices among the solutions, each at better θ; they change what is chosen hardly ever after the first.
const MAX_CHOICE_ROUNDS: usize = 4;

/// A change of θ, whose coordinates are of size one, that changes no choice.
const THETA_STEP_TOL: f64 = 1e-7;

/// Evaluations for each coordinate.
const EVALUATIONS_PER_COORDINATE: usize = 25;

/// Starts whose misfits agree to this part are one.
const AGREEING_MISFIT_RTOL: f64 = 1e-3;

/// Searches for θ, each about where the one before ended.
const MAX_THETA_SEARCHES: usize = 8;

/// How far a search may lead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// Little: models of a few vectors are as good.
    Near,
    /// Anywhere.
    Far,
}

/// Where a search begins.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Begin {
    pub(super) coordinates: Coordinates,
    pub(super) theta: Vec<f64>,
}

/// Where solutions are searched at a frequency.
pub(super) enum Guess<'g> {
    /// Near some values, and all over the box.
    Everywhere(&'g [c64]),
    /// Where they were.
    Known(&'g [Vec<Solution>]),
}

impl Task<'_, '_> {
    /// Everything, on a subspace that is good where it ends.
    pub(super) fn search(&self, reduced: &mut Neighbourhoods<'_>) -> BandSolution {
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        let part: Vec<usize> = thinned(&all, START_FREQUENCIES).copied().collect();
        reduced.widen(self.context.for_each);
        (self.context.progress)(Stage::Solutions, 0, all.len());
        let mut tried = self.tried(reduced, &part, LOG_RESPONSE_FREQUENCIES);
        // Where no start explains the sensors, residuals can be small because resonances coincide by chance. Logarithms are large there.
        if self.is_unexplained(&tried[0].1) {
            let logs: Vec<f64> = tried.iter().map(|(_, found, _)| self.log_misfit(&part, found)).collect();
            let least = (0..logs.len()).min_by(|&a, &b| logs[a].total_cmp(&logs[b])).unwrap_or(0);
            tried.swap(0, least);
        }
        let starts = tried.iter().flat_map(|(_, found, _)| found.starts.clone()).collect();
        let (least, first, values) = tried.swap_remove(0);
        let agreeing =
            1 + tried.iter().filter(|other| other.0 <= least * (1.0 + AGREEING_MISFIT_RTOL)).count();
        let found = match part.len() == all.len() {
            true => first,
            false => self.follow(reduced, &all, first.begin(), &Guess::Everywhere(&values)),
        };
        reduced.narrow(found.answers(), self.context.for_each);
        let found = self.refined(reduced, found);
        (self.context.progress)(Stage::Solutions, all.len(), all.len());
        BandSolution { starts, agreeing, ..found }
    }

    /// Σ |ln(x_m/u_m)|² of the chosen solutions, a frequency without one counts as the worst of them.
    fn log_misfit(&self, which: &[usize], found: &BandSolution) -> f64 {
        let at = |k: usize| -> Option<f64> {
            let u = &self.problem.frfs.receptance[which[k]];
            let each = found.at(k)?.response.iter().zip(u).zip(&self.sigma[which[k]]);
            let used = each.filter(|((x, u), sigma)| sigma.is_finite() && x.norm() * u.norm() > 0.0);
            Some(used.map(|((x, u), _)| (x / u).ln().norm_sqr()).sum())
        };
        let each: Vec<Option<f64>> = (0..which.len()).map(at).collect();
        let worst = each.iter().flatten().copied().fold(0.0, f64::max);
        each.into_iter().map(|one| one.unwrap_or(worst)).sum()
    }

    /// The same from one start, and values of all unknowns there.
    pub(super) fn search_from(
        &self,
        reduced: &mut Neighbourhoods<'_>,
        begin: Begin,
        values: &[c64],
    ) -> BandSolution {
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        let found = self.follow(reduced, &all, begin, &Guess::Everywhere(values));
        self.refined(reduced, found)
    }

    /// The same on a subspace that is good at its answers.
    fn refined(&self, reduced: &mut Neighbourhoods<'_>, mut found: BandSolution) -> BandSolution {
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        for _ in 0..MAX_TRAINING_ROUNDS {
            if !reduced.refine(&found.answers(), self.context) {
                break;
            }
            let known = std::mem::take(&mut found.solutions);
            found = self.follow(reduced, &all, found.begin(), &Guess::Known(&known));
        }
        found
    }

    /// Where each start leads at some frequencies, least misfit first: (misfit, solution, start); at least one. Starts are found by so many frequencies at most.
    pub(super) fn tried(
        &self,
        reduced: &Neighbourhoods<'_>,
        which: &[usize],
        most: usize,
    ) -> Vec<(f64, BandSolution, Vec<c64>)> {
        let mut begin = self.starts(reduced, most);
        if self.coordinates().count == 0 {
            // Nothing holds for the band: every frequency is searched for itself, wherever it begins.
            begin.truncate(1);
        }
        let mut tried = Vec::with_capacity(begin.len());
        for values in begin {
            let begin = self.begin(reduced, which, &values);
            let starts = vec![begin.clone()];
            let found = self.follow(reduced, which, begin, &Guess::Everywhere(&values));
            tried.push((found.misfit(), BandSolution { starts, ..found }, values));
        }
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        tried
    }

    /// The frequencies, and the window through which they are seen.
    pub(super) fn seen(&self) -> (&[f64], f64) {
        (&self.omegas, self.problem.model.decay_per_s())
    }

    /// What holds for the band, as it varies.
    pub(super) fn coordinates(&self) -> Coordinates {
        let middle = &self.nominal[self.nominal.len() / 2];
        Coordinates::new(self.problem.unknowns, |one| one.varies.clone(), middle, self.seen())
            .with_channels(self.problem.channels, &self.omegas)
    }

    /// θ that begins with these constants and calibrated channels; a law with the shape of its nominal.
    pub(super) fn theta(&self, coordinates: &Coordinates, values: &[c64]) -> Vec<f64> {
        let middle = &self.nominal[self.nominal.len() / 2];
        let law = |parametrization: &Parametrization, j: usize| {
            let ratio = values[j] / middle[j];
            let data: Vec<Datum> = self
                .omegas
                .iter()
                .zip(self.nominal)
                .filter(|(_, nominal)| (nominal[j] * ratio).re > 0.0)
                .map(|(&omega, nominal)| Datum::relative(omega, nominal[j] * ratio))
                .collect();
            nearest(parametrization, &data)
                .map_or_else(|| vec![0.0; parametrization.kind.count()], |near| near.best.theta)
        };
        coordinates.of(values, law)
    }

    /// All unknowns at a frequency, those that it has of its own at some given values; and ∂p/∂θ: (unknown, coordinate, slope).
    pub(super) fn given(
        &self,
        coordinates: &Coordinates,
        theta: &[f64],
        i: usize,
        own: &[c64],
    ) -> Option<Given> {
        let mut values = own.to_vec();
        let mut slopes = Vec::with_capacity(theta.len());
        for one in &coordinates.each {
            let (value, of_theta) = one.value(theta, self.omegas[i])?;
            values[one.unknowns] = value;
            slopes.extend(of_theta.into_iter().map(|slope| (one.unknowns, slope)));
        }
        Some((values, slopes))
    }

    /// Solutions, the choice among them and θ in turn, until the choice stays.
    pub(super) fn follow(
        &self,
        reduced: &Neighbourhoods<'_>,
        which: &[usize],
        begin: Begin,
        guess: &Guess<'_>,
    ) -> BandSolution {
        let mut found = self.found(reduced, which, begin, guess);
        for _ in 0..MAX_CHOICE_ROUNDS {
            if found.theta.is_empty() {
                break;
            }
            let before = found.theta.clone();
            let Some((theta, converged)) = self.descend(reduced, which, &found) else { break };
            let moved = super::at_frequency::distance(&before, &theta);
            let known = std::mem::take(&mut found.solutions);
            let begin = Begin { theta, ..found.begin() };
            found = self.found(reduced, which, begin, &Guess::Known(&known));
            found.converged = converged;
            if moved <= THETA_STEP_TOL {
                break;
            }
        }
        found
    }

    fn found(
        &self,
        reduced: &Neighbourhoods<'_>,
        which: &[usize],
        Begin { coordinates, theta }: Begin,
        guess: &Guess<'_>,
    ) -> BandSolution {
        let at = At { reduced, coordinates: &coordinates, theta: &theta };
        let n = which.len();
        let per_frequency = self.problem.unknowns.iter().any(|one| one.per_frequency() > 0);
        let from = |solutions: &[Vec<Solution>], k: usize, beside: &[usize]| -> Vec<Solution> {
            let problem = self.at_frequency(which[k]);
            let starts =
                beside.iter().flat_map(|&b| &solutions[b]).map(|one| problem.coordinates(&one.values));
            self.settled(&at, which[k], &starts.collect::<Vec<_>>(), None)
        };
        let mut solutions = match guess {
            Guess::Known(known) => map(self.context.for_each, n, |k| from(known, k, &[k])),
            Guess::Everywhere(_) if !per_frequency => {
                map(self.context.for_each, n, |k| self.settled(&at, which[k], &[Vec::new()], None))
            }
            Guess::Everywhere(values) => {
                let grid: Vec<usize> =
                    (0..n).step_by((n / MIN_GRID_LINES).clamp(1, MAX_GRID_STRIDE)).collect();
                let found =
                    map(self.context.for_each, grid.len(), |a| self.everywhere(&at, which[grid[a]], values));
                let beside = |k: usize| {
                    let after = grid.partition_point(|&explored| explored <= k);
                    [after.saturating_sub(1), after.min(grid.len() - 1)]
                };
                map(self.context.for_each, n, |k| from(&found, k, &beside(k)))
            }
        };
        if per_frequency && matches!(guess, Guess::Everywhere(_)) {
            // What one frequency has, its neighbours may have too.
            let before = solutions;
            let beside = |k: usize| [k.saturating_sub(1), k, (k + 1).min(n - 1)];
            solutions = map(self.context.for_each, n, |k| from(&before, k, &beside(k)));
        }
        let mut chosen = self.choose(which, &solutions);
        if let Guess::Everywhere(values) = guess {
            let lost: Vec<usize> =
                (0..n).filter(|&k| per_frequency && chosen[k].solution.is_none()).collect();
            if !lost.is_empty() {
                let again =
                    map(self.context.for_each, lost.len(), |l| self.everywhere(&at, which[lost[l]], values));
                lost.into_iter().zip(again).for_each(|(k, again)| solutions[k] = again);
                chosen = self.choose(which, &solutions);
            }
        }
        BandSolution::new(Begin { coordinates, theta }, solutions, chosen)
    }

    /// The solutions at a frequency that some values, the nominal ones and points all over the box lead to. Of one unknown that stands for a factor, all there are; of two, those that
    /// begin at all solutions for one of them while the other goes through its range, in either part: every solution of both is one of those at the other's value.
    pub(super) fn everywhere(&self, at: &At<'_, '_>, i: usize, values: &[c64]) -> Vec<Solution> {
        let Some((given, _)) = self.given(at.coordinates, at.theta, i, &self.nominal[i]) else {
            return Vec::new();
        };
        let problem = self.at_frequency(i);
        let mut rough = None;
        let factors: Vec<usize> =
            (0..self.problem.unknowns.len()).filter(|&j| self.is_own_factor(j)).collect();
        let others =
            self.problem.unknowns.iter().filter(|one| one.per_frequency() > 0).count() - factors.len();
        let found = match (factors.as_slice(), others) {
            (&[j], 0) => self.all_of(at, at.reduced.model(i), (i, j), &given),
            (&[a, b], 0) => {
                let rough = rough.insert(at.reduced.rough(i, ROUGH_MODEL_TOL));
                let along = |a: usize, b: usize| {
                    let grid = in_turn(&self.problem.unknowns[b], given[b]).into_iter();
                    let with = |value: c64| {
                        let mut values = given.clone();
                        values[b] = value;
                        self.all_of(at, rough, (i, a), &values)
                    };
                    grid.flat_map(with).collect::<Vec<_>>()
                };
                [along(a, b), along(b, a)].concat()
            }
            (_, others) => (1..=BOX_POINTS_PER_UNKNOWN * (factors.len() + others))
                .map(|k| in_box(&at.reduced.composite, &self.nominal[i], k))
                .collect(),
        };
        let starts = [values, &self.nominal[i]].into_iter().chain(found.iter().map(Vec::as_slice));
        let starts: Vec<Vec<f64>> = starts.map(|values| problem.coordinates(values)).collect();
        self.settled(at, i, &starts, rough)
    }

    /// The solutions that some starts lead to. Most of many lead nowhere, or where another one does: a model of few vectors, which may be there already, shows which.
    fn settled(
        &self,
        at: &At<'_, '_>,
        i: usize,
        starts: &[Vec<f64>],
        rough: Option<Projection>,
    ) -> Vec<Solution> {
        let Some((given, _)) = self.given(at.coordinates, at.theta, i, &self.nominal[i]) else {
            return Vec::new();
        };
        let on = |model: &Projection, starts: &[Vec<f64>]| {
            let shown = |x| at.coordinates.channels.shown(at.theta, self.problem.frfs.frequency_hz[i], x);
            self.at_frequency(i)
                .solutions(starts, &given, |values| at.reduced.respond_on(model, i, values).map(shown))
        };
        if starts.len() <= WHOLE_MODEL_STARTS {
            return on(at.reduced.model(i), starts);
        }
        let rough = on(&rough.unwrap_or_else(|| at.reduced.rough(i, ROUGH_MODEL_TOL)), starts);
        on(at.reduced.model(i), &rough.into_iter().map(|solution| solution.own).collect::<Vec<_>>())
    }

    /// Whether a frequency has a value of its own of this unknown, in place of a factor.
    fn is_own_factor(&self, j: usize) -> bool {
        let one = &self.problem.unknowns[j];
        one.per_frequency() > 0 && matches!(one.dependence, Dependence::Factor(_))
    }

    /// All values of one unknown that stands for a factor (B-2), the others as given: where all sensors' misfit is least.
    fn all_of(
        &self,
        at: &At<'_, '_>,
        model: &Projection,
        (i, j): (usize, usize),
        given: &[c64],
    ) -> Vec<Vec<c64>> {
        let frequency_hz = self.problem.frfs.frequency_hz[i];
        let channels = &at.coordinates.channels;
        let measured = channels.calibrated(at.theta, frequency_hz, &self.problem.frfs.receptance[i]);
        let sigma = channels.calibrated_sigma(at.theta, &self.sigma[i]);
        let Ok(at) = at.reduced.composite.about_one(frequency_hz, given, j) else { return Vec::new() };
        let unknown = &self.problem.unknowns[j];
        let fit =
            Fit { measured: &measured, sigma: &sigma, nominal: given[j], unknown, options: self.options };
        let values = |correction: c64| {
            let mut values = given.to_vec();
            values[j] += correction;
            values
        };
        let explored = fit.explore_reduced(model, &at);
        explored.solutions.iter().map(|solution| values(solution.correction)).collect()
    }

    /// θ of least misfit with the chosen solutions, and whether the search settled. A direction that is not identifiable is left where it began: there is nothing to gain along it,
    /// and no end.
    ///
    /// Each search is on models of a few vectors about where it begins, which are made again where it ends; one that gains nothing there is made on the whole ones.
    fn descend(
        &self,
        reduced: &Neighbourhoods<'_>,
        which: &[usize],
        found: &BandSolution,
    ) -> Option<(Vec<f64>, bool)> {
        let theta = found.coordinates.within_bounds(&found.theta);
        let on_solutions = theta == found.theta;
        let mut place = match on_solutions {
            true => Place { eliminated: self.eliminated(which, found, &theta, None)?, theta },
            false => {
                let eliminated = self.eliminated(which, found, &found.theta, None)?;
                let beyond = Place { theta: found.theta.clone(), eliminated };
                self.moved_to(reduced, which, (found, &beyond), theta)?
            }
        };
        let mut held = found.coordinates.binding(&place.theta, &place.eliminated.gradient());
        loop {
            let (end, converged) = self.descend_free(reduced, which, (found, place), &held)?;
            let theta = found.coordinates.within_bounds(&end.theta);
            if theta == end.theta {
                return Some((end.theta, converged));
            }
            // A coordinate that leaves its bounds is held at them, and the others are searched again.
            held.extend((0..theta.len()).filter(|&c| theta[c] != end.theta[c]));
            place = self.moved_to(reduced, which, (found, &end), theta)?;
        }
    }

    /// The same with some coordinates held, and no regard to bounds.
    fn descend_free(
        &self,
        reduced: &Neighbourhoods<'_>,
        which: &[usize],
        (found, mut place): (&BandSolution, Place),
        held: &[usize],
    ) -> Option<(Place, bool)> {
        let basis = Information::identifiable_with(&place.eliminated.jacobian, found.theta.len(), held)?;
        if basis.is_empty() {
            return Some((place, true));
        }
        let rest = vec![0.0; basis.len()];
        for _ in 0..MAX_THETA_SEARCHES {
            let plane = Plane { origin: &place.theta.clone(), basis: &basis };
            let near = self.search_in(reduced, which, (found, &place), &plane, &rest, Reach::Near)?;
            let end = plane.at(&near.theta);
            let moved = super::at_frequency::distance(&end, plane.origin);
            match self.moved_to(reduced, which, (found, &place), end) {
                Some(next) if next.eliminated.sum() <= place.eliminated.sum() => place = next,
                _ if moved <= THETA_STEP_TOL => {}
                _ => {
                    let end = self.search_in(reduced, which, (found, &place), &plane, &rest, Reach::Far)?;
                    let next = self.moved_to(reduced, which, (found, &place), plane.at(&end.theta))?;
                    return Some((next, end.converged));
                }
            }
            if moved <= THETA_STEP_TOL {
                return Some((place, near.converged));
            }
        }
        Some((place, false))
    }

    /// The least misfit with θ on a plane, its own coordinates the search's.
    pub(super) fn search_in(
        &self,
        reduced: &Neighbourhoods<'_>,
        which: &[usize],
        (found, place): (&BandSolution, &Place),
        plane: &Plane<'_>,
        from: &[f64],
        reach: Reach,
    ) -> Option<Minimum> {
        let n = found.theta.len();
        let models = match reach {
            Reach::Near => map(self.context.for_each, which.len(), |k| {
                self.model_about(reduced, which[k], k, (found, place))
            }),
            Reach::Far => vec![None; which.len()],
        };
        let evaluate = |t: &[f64]| {
            let theta = plane.at(t);
            let model = |k: usize| models[k].as_ref().unwrap_or(reduced.model(which[k]));
            let start = |k: usize| place.own_at(k, &theta);
            let on = On { reduced, model: &model, start: &start };
            let here = self.eliminated(which, found, &theta, Some(&on))?;
            let m = here.residuals.len();
            let along = |v: &Vec<f64>| -> Vec<f64> {
                (0..m).map(|r| (0..n).map(|c| here.jacobian[c * m + r] * v[c]).sum()).collect()
            };
            let jacobian = plane.basis.iter().flat_map(along).collect();
            Some((here.residuals, jacobian))
        };
        let search = Search { starts: 1, patience: EVALUATIONS_PER_COORDINATE, same: 0.0 };
        descend(from, &evaluate, &search)
    }

    /// A model of a few vectors about the k-th solution.
    fn model_about(
        &self,
        reduced: &Neighbourhoods<'_>,
        i: usize,
        k: usize,
        (found, place): (&BandSolution, &Place),
    ) -> Option<Projection> {
        let (own, _) = place.eliminated.own[k].as_ref()?;
        let (given, _) = self.given(&found.coordinates, &place.theta, i, &found.at(k)?.values)?;
        reduced.about(i, &self.at_frequency(i).values(own, &given))
    }

    /// The place at another θ, on the whole models.
    pub(super) fn moved_to(
        &self,
        reduced: &Neighbourhoods<'_>,
        which: &[usize],
        (found, place): (&BandSolution, &Place),
        theta: Vec<f64>,
    ) -> Option<Place> {
        let on = On { reduced, model: &|k| reduced.model(which[k]), start: &|k| place.own_at(k, &theta) };
        let eliminated = self.eliminated(which, found, &theta, Some(&on))?;
        Some(Place { theta, eliminated })
    }

    /// Residuals at θ with each frequency's own at its best, and their slopes by θ with that eliminated: of the chosen solutions, or of those to which they lead on some models.
    pub(super) fn eliminated(
        &self,
        which: &[usize],
        found: &BandSolution,
        theta: &[f64],
        on: Option<&On<'_, '_>>,
    ) -> Option<Eliminated> {
        let one = |k: usize| -> Option<Option<Part>> {
            let Some(solution) = found.at(k) else { return Some(None) };
            let i = which[k];
            let (given, slopes) = self.given(&found.coordinates, theta, i, &solution.values)?;
            let problem = self.at_frequency(i);
            let channels = &found.coordinates.channels;
            let here = match on {
                None => solution.clone(),
                Some(on) => problem.settle(&(on.start)(k)?, &given, |values| {
                    let responded = on.reduced.respond_on((on.model)(k), i, values)?;
                    Some(channels.shown(theta, self.problem.frfs.frequency_hz[i], responded))
                })?,
            };
            let m = here.residuals.len();
            let column = |(j, slope): &(usize, c64)| {
                here.of_values[*j]
                    .iter()
                    .flat_map(|v| {
                        let v = v * slope;
                        [v.re, v.im]
                    })
                    .collect::<Vec<f64>>()
            };
            let mut columns: Vec<f64> = slopes.iter().flat_map(column).collect();
            columns.extend(channels.columns(&here.response, self.omegas[i], &self.sigma[i]));
            let contained = eliminate(&here.of_own, &mut columns, m);
            let moved = contained.into_iter().map(|x| x.into_iter().map(|x| -x).collect()).collect();
            Some(Some(Part { residuals: here.residuals, columns, own: here.own, moved }))
        };
        let parts = map(self.context.for_each, which.len(), one).into_iter().collect::<Option<Vec<_>>>()?;
        let n = theta.len();
        let mut residuals: Vec<f64> = Vec::new();
        let mut jacobian: Vec<f64> = Vec::new();
        for part in parts.iter().flatten() {
            residuals.extend(&part.residuals);
        }
        for c in 0..n {
            for part in parts.iter().flatten() {
                let m = part.residuals.len();
                jacobian.extend(&part.columns[c * m..(c + 1) * m]);
            }
        }
        let own = parts.into_iter().map(|part| part.map(|part| (part.own, part.moved))).collect();
        let finite = residuals.iter().chain(&jacobian).all(|value| value.is_finite());
        finite.then_some(Eliminated { residuals, jacobian, own })
    }
}

/// Values through the range of an unknown, with the loss factor of a given one.
fn in_turn(one: &Unknown, given: c64) -> Vec<c64> {
    let [low, high] = one.range(given);
    let steps =
        if low > 0.0 { (SCAN_VALUES_PER_OCTAVE * (high / low).log2()).ceil() as usize } else { SCAN_VALUES };
    let eta = if given.re == 0.0 { 0.0 } else { given.im / given.re };
    let value = |k: usize| {
        let real = between([low, high], k as f64 / steps.max(1) as f64);
        c64::new(1.0, if one.real { 0.0 } else { eta }) * real
    };
    (0..=steps).map(value).collect()
}

/// θ = origin + Σ t_k v_k.
pub(super) struct Plane<'p> {
    pub(super) origin: &'p [f64],
    pub(super) basis: &'p [Vec<f64>],
}

impl Plane<'_> {
    pub(super) fn at(&self, t: &[f64]) -> Vec<f64> {
        let along = |c: usize| self.basis.iter().zip(t).map(|(v, t)| t * v[c]).sum::<f64>();
        self.origin.iter().enumerate().map(|(c, origin)| origin + along(c)).collect()
    }
}

/// Where a search for θ is.
#[derive(Clone)]
pub(super) struct Place {
    pub(super) theta: Vec<f64>,
    pub(super) eliminated: Eliminated,
}

impl Place {
    /// The k-th frequency's own coordinates at another θ, where their slopes have them.
    fn own_at(&self, k: usize, theta: &[f64]) -> Option<Vec<f64>> {
        let (own, slopes) = self.eliminated.own[k].as_ref()?;
        let by = |a: usize| -> f64 {
            slopes.iter().zip(theta.iter().zip(&self.theta)).map(|(slope, (t, t0))| slope[a] * (t - t0)).sum()
        };
        Some((0..own.len()).map(|a| own[a] + by(a)).collect())
    }
}

/// On which models solutions are settled, and where they begin.
pub(super) struct On<'o, 'a> {
    reduced: &'o Neighbourhoods<'a>,
    model: &'o (dyn Fn(usize) -> &'o Projection + Sync),
    start: &'o (dyn Fn(usize) -> Option<Vec<f64>> + Sync),
}

/// Values of all unknowns at a frequency, and (unknown, ∂p/∂θ) for each coordinate of θ.
pub(super) type Given = (Vec<c64>, Vec<(usize, c64)>);

/// A frequency's own coordinates y, and ∂y/∂θ as `[coordinate of θ][own]`.
pub(super) type Moving = (Vec<f64>, Vec<Vec<f64>>);

/// One frequency's part of [`Eliminated`].
struct Part {
    residuals: Vec<f64>,
    columns: Vec<f64>,
    own: Vec<f64>,
    moved: Vec<Vec<f64>>,
}

/// Residuals of the chosen solutions as functions of θ alone.
#[derive(Clone)]
pub(super) struct Eliminated {
    pub(super) residuals: Vec<f64>,
    /// Column after column.
    pub(super) jacobian: Vec<f64>,
    /// At each frequency that has a solution.
    pub(super) own: Vec<Option<Moving>>,
}

impl Eliminated {
    /// ∂(Σ r²/2)/∂θ.
    pub(super) fn gradient(&self) -> Vec<f64> {
        let columns = self.jacobian.chunks_exact(self.residuals.len().max(1));
        columns.map(|column| column.iter().zip(&self.residuals).map(|(j, r)| j * r).sum()).collect()
    }

    /// Σ r².
    pub(super) fn sum(&self) -> f64 {
        self.residuals.iter().map(|r| r * r).sum()
    }
}

impl BandSolution {
    /// Of one start, with what was chosen among the solutions.
    pub(super) fn new(
        Begin { coordinates, theta }: Begin,
        solutions: Vec<Vec<Solution>>,
        chosen: Vec<Chosen>,
    ) -> Self {
        Self { coordinates, theta, solutions, chosen, converged: true, starts: Vec::new(), agreeing: 1 }
    }

    /// Another search from where this one ended.
    fn begin(&self) -> Begin {
        Begin { coordinates: self.coordinates.clone(), theta: self.theta.clone() }
    }

    /// The values at each frequency that has any.
    pub(super) fn answers(&self) -> Vec<Answer> {
        let at = |k: usize| Some((k, self.at(k)?.values.clone()));
        (0..self.solutions.len()).filter_map(at).collect()
    }

    /// The chosen solution at the k-th frequency.
    pub(super) fn at(&self, k: usize) -> Option<&Solution> {
        self.solutions[k].get(self.chosen[k].solution?)
    }

    /// The misfit, with the least that a frequency without an answer would leave: nothing is gained by leaving frequencies out.
    fn misfit(&self) -> f64 {
        let each: Vec<f64> = (0..self.chosen.len()).filter_map(|k| Some(self.at(k)?.misfit)).collect();
        let worst = each.iter().copied().fold(0.0, f64::max);
        let missing = self.chosen.len() - each.len();
        if each.is_empty() {
            f64::INFINITY
        } else {
            each.iter().sum::<f64>() + 10.0 * missing as f64 * worst.max(1.0)
        }
    }
}
