//! All solutions at one frequency, from every sensor, fitted to all sensors (B-2, B-5).

use crate::c64;
use crate::identify::options::Options;
use crate::identify::rational::{RESPONSE_MATCH_RTOL, ROOT_RESIDUAL_TOL};
use crate::identify::unknown::Unknown;
use crate::model::ModelAt;
use crate::rational::{Poles, PolesBetween, RationalResponse};
use crate::response::Response;
use crate::roots::{Candidate, Refusal};
use crate::subspace::{Assessment, Projection};
use frfit_linalg::dense::NoConvergence;
use frfit_linalg::solve::Breakdown;
use std::borrow::Cow;
use std::sync::Arc;

/// What was found at a frequency, and how.
#[derive(Debug, Clone)]
pub(super) struct LineCandidates {
    /// The frequency (index).
    pub(super) index: usize,
    pub(super) explored: Candidates,
    /// Corrections at which the model that found them is good enough for an answer.
    pub(super) certain: Vec<(c64, Assessment)>,
    /// Whether all solutions were searched.
    pub(super) whole: bool,
}

/// A correction that the measurement does not exclude at this frequency.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct Solution {
    pub(in crate::identify) correction: c64,
    /// Σ |u_m − x_m|²/σ_m².
    pub(super) misfit: f64,
    /// (Σ |∂x_m/∂c|²/σ_m²)^{−1/2}: standard deviation of the correction.
    pub(super) std: f64,
    /// x_m.
    pub(super) response: Vec<c64>,
    /// ‖F − D(c)x‖/‖F‖ of the rational response; infinite where the full model has another response.
    pub(super) residual: f64,
    /// (Σ |∂²x_m/∂c²|²/σ_m²)^{1/2} of a rational response without poles; infinite where none did find the solution.
    pub(super) second: f64,
}

/// What was found at one frequency.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::identify) struct Candidates {
    pub(in crate::identify) solutions: Vec<Solution>,
    /// Solutions a little outside the bounds: at the next frequency they may be within.
    pub(super) beyond: Vec<Solution>,
    /// What solves the equations but not the user's conditions.
    pub(super) refused: Vec<Candidate>,
    /// x_m with the nominal factor.
    pub(super) nominal_response: Vec<c64>,
    /// `None` for a parameter with powers.
    pub(super) poles: Option<LinePoles>,
    /// Order of the rational response.
    pub(super) order: usize,
    pub(super) breakdown: Option<Breakdown>,
}

/// The poles of a line. Of a line that was followed they are made where they are asked for: a long band has no room for all of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LinePoles {
    Own(Poles),
    Between {
        /// The poles at the lines on either side that were explored.
        stops: Arc<PolesBetween>,
        /// The part of the way from one stop to the other, in ω².
        t: f64,
        nominal: c64,
    },
}

impl LinePoles {
    pub(super) fn get(&self) -> Cow<'_, Poles> {
        match self {
            Self::Own(poles) => Cow::Borrowed(poles),
            Self::Between { stops, t, nominal } => Cow::Owned(stops.at(*t, *nominal)),
        }
    }
}

impl Solution {
    /// Whether it may be none.
    pub(super) fn is_unsure(&self) -> bool {
        self.residual > ROOT_RESIDUAL_TOL
    }
}

impl Candidates {
    pub(super) fn broken(breakdown: Breakdown) -> Self {
        Self { breakdown: Some(breakdown), ..Self::default() }
    }

    /// Whether a solution is left that may be none.
    pub(super) fn is_unsure(&self) -> bool {
        self.solutions.iter().any(Solution::is_unsure)
    }

    /// All solutions, those within the bounds first.
    pub(super) fn all_near(&self) -> impl Iterator<Item = &Solution> {
        self.solutions.iter().chain(&self.beyond)
    }

    /// Some of them, by their place.
    pub(super) fn near(&self, which: &[usize]) -> impl Iterator<Item = &Solution> {
        which.iter().filter_map(|&k| self.all_near().nth(k))
    }

    /// Solves the system again at each solution: its response is then beyond doubt, and so is whether it is a solution.
    pub(super) fn confirm(&mut self, system: &impl Response, measured: &[c64], sigma: &[f64]) {
        for solution in &mut self.solutions {
            solution.residual = f64::INFINITY;
            let Ok(response) = system.solve_at(&[solution.correction]) else { continue };
            let moved: f64 = solution.response.iter().zip(&response).map(|(a, b)| (a - b).norm()).sum();
            if moved <= RESPONSE_MATCH_RTOL * response.iter().map(|x| x.norm()).sum::<f64>() {
                solution.residual = 0.0;
            }
            let rest = measured.iter().zip(&response).zip(sigma);
            solution.misfit = rest.map(|((u, x), sigma)| (u - x).norm_sqr() / (sigma * sigma)).sum();
            solution.response = response;
        }
    }
}

/// Order of the first attempt; each further one doubles it, so that the last costs more than all before.
const FIRST_ORDER: usize = 16;

/// Sensors whose own solutions are starts: each is an eigenproblem, and the truth is a solution of every one.
const START_SENSORS: usize = 2;

/// Steps of Gauss and Newton. From an eigenvalue a handful is enough; more show that it leads nowhere.
const MAX_STEPS: usize = 30;

/// Steps of a short way.
const MAX_SHORT_STEPS: usize = 6;

/// A step of this part of the factor is likely the last: Newton's next is the square of it.
const LAST_STEP_RTOL: f64 = 1e-5;

/// The error after the last step, relative to the factor: beyond the digits that an answer has, whatever the noise.
const STEP_RTOL: f64 = 1e-11;

/// Solutions nearer than this, relative to the factor, are one.
const SOLUTION_MERGE_RTOL: f64 = 1e-7;

/// A start this far outside the box (relative to the factor) may still be pulled inside by the other sensors.
const START_BOX_MARGIN: f64 = 0.2;

/// x_m and ∂x_m/∂c.
pub(super) type Evaluated = Result<(Vec<c64>, Vec<c64>), NoConvergence>;

/// What is to be explained at one frequency, and how.
pub(in crate::identify) struct Fit<'a> {
    pub(in crate::identify) measured: &'a [c64],
    pub(in crate::identify) sigma: &'a [f64],
    pub(in crate::identify) nominal: c64,
    pub(in crate::identify) unknown: &'a Unknown,
    pub(in crate::identify) options: &'a Options,
}

impl Fit<'_> {
    /// Finds all solutions within the bounds, `order` bounding the Krylov space.
    pub(super) fn explore(&self, system: &impl Response, order: usize) -> Candidates {
        self.try_explore(system, order).unwrap_or_else(Candidates::broken)
    }

    fn try_explore(&self, system: &impl Response, order: usize) -> Result<Candidates, Breakdown> {
        let broken = |NoConvergence| Breakdown::NotFinite;
        let mut reached = FIRST_ORDER.min(order);
        let mut response = RationalResponse::new(system, 0, reached)?;
        loop {
            let mut explored = self.solutions(&response).map_err(broken)?;
            // The whole space leaves nothing but roundoff.
            let whole = response.is_complete() || response.size() == system.dim();
            for solution in explored.solutions.iter_mut().chain(&mut explored.beyond) {
                let residual = || response.residual(solution.correction).unwrap_or(f64::INFINITY);
                solution.residual = if whole { 0.0 } else { residual() };
            }
            // That a low order has no solution is no proof that no solution exists, and what is beyond the bounds may be within them.
            let open = explored.solutions.is_empty() || explored.beyond.iter().any(Solution::is_unsure);
            let settled = !explored.is_unsure() && (whole || !open);
            if settled || reached >= order {
                let powers = explored.poles.is_none();
                for solution in explored.solutions.iter_mut().filter(|_| powers) {
                    let second = response.second_derivative(solution.correction);
                    solution.second = second.map_or(f64::INFINITY, |second| self.weighed(&second));
                }
                explored.order = response.size().saturating_sub(1);
                explored.nominal_response = response.respond(c64::default()).map_err(broken)?;
                return Ok(explored);
            }
            reached = (2 * reached).min(order);
            response = response.extended(system, 0, reached)?;
        }
    }

    /// Moves each solution to where another, better model of the same system has it.
    pub(super) fn settle(&self, mut found: Candidates, respond: impl Fn(c64) -> Evaluated) -> Candidates {
        let before = std::mem::take(&mut found.solutions);
        for old in before {
            // One that a better model does not have was none.
            if let Some(new) = self.descend(&respond, old.correction) {
                merge(
                    &mut found.solutions,
                    Solution { residual: old.residual, second: old.second, ..new },
                    self.nominal,
                );
            }
        }
        if let Ok((response, _)) = respond(c64::default()) {
            found.nominal_response = response;
        }
        found
    }

    fn solutions(&self, response: &RationalResponse) -> Result<Candidates, NoConvergence> {
        let poles = response.poles()?;
        let mut explored = Candidates::default();
        let roots = self.unknown.roots();
        // The sum over the poles leads there, the matrices have the last digits.
        let last = |c: c64| response.respond_with_slope(c);
        let way = |c: c64| match &poles {
            Some(poles) => Ok(poles.respond_with_slope(c)),
            None => response.respond_with_slope(c),
        };
        let mut found: Vec<Solution> = Vec::new();
        for sensor in self.starting_sensors() {
            for start in response.starts(sensor, self.measured[sensor])? {
                if !self.near_box(start) {
                    let refusal = roots.refuse(self.nominal, start).or(Some(Refusal::Far));
                    explored.refused.push(Candidate { correction: start, drift: f64::INFINITY, refusal });
                    continue;
                }
                if let Some(solution) = self.descend(way, start) {
                    merge(&mut found, solution, self.nominal);
                }
            }
        }
        for rough in found {
            let Some(solution) = self.descend(last, rough.correction) else { continue };
            // Real where it has to be: the descent saw to that.
            match self.unknown.bounds.broken_by(self.nominal + solution.correction) {
                None => merge(&mut explored.solutions, solution, self.nominal),
                Some(bound) => {
                    let (correction, refusal) = (solution.correction, Some(Refusal::OutOfBounds(bound)));
                    explored.refused.push(Candidate { correction, drift: f64::INFINITY, refusal });
                    merge(&mut explored.beyond, solution, self.nominal);
                }
            }
        }
        explored.poles = poles.map(LinePoles::Own);
        explored.solutions.sort_by(|a, b| a.correction.norm().total_cmp(&b.correction.norm()));
        Ok(explored)
    }

    /// (Σ |v_m|²/σ_m²)^{1/2}.
    pub(super) fn weighed(&self, values: &[c64]) -> f64 {
        weighed(values, self.sigma)
    }

    /// The sensors with the largest response over their standard deviation.
    fn starting_sensors(&self) -> Vec<usize> {
        let mut sensors: Vec<usize> = (0..self.measured.len()).collect();
        let size = |&m: &usize| self.measured[m].norm() / self.sigma[m];
        sensors.sort_by(|a, b| size(b).total_cmp(&size(a)));
        sensors.truncate(START_SENSORS);
        sensors
    }

    fn near_box(&self, correction: c64) -> bool {
        let factor = self.nominal + correction;
        let wide = |bound: Option<[f64; 2]>, value: f64, margin: f64| {
            bound.is_none_or(|[low, high]| low - margin <= value && value <= high + margin)
        };
        factor.is_finite()
            && wide(
                self.options.search_box(self.unknown, self.nominal),
                factor.re,
                START_BOX_MARGIN * factor.norm(),
            )
            && wide(self.unknown.bounds.loss_factor, crate::material::loss_factor(factor), START_BOX_MARGIN)
    }

    /// Explores a reduced model. What is certified is this model's response, not that of a Krylov space within: that is where the solutions settle.
    pub(in crate::identify) fn explore_reduced(&self, model: &Projection, at: &ModelAt<'_>) -> Candidates {
        let found = match model.at(at) {
            // Vectors of this length cost nothing: the order bounds those of the full model.
            Ok(system) => self.explore(&system, system.dim()),
            Err(breakdown) => Candidates::broken(breakdown),
        };
        self.settle(found, self.on(model, at))
    }

    /// The response of a reduced model.
    pub(super) fn on<'m>(
        &self,
        model: &'m Projection,
        at: &'m ModelAt<'_>,
    ) -> impl Fn(c64) -> Evaluated + 'm {
        |c| model.respond_with_slope(at, c).map_err(|_| NoConvergence)
    }

    /// Gauss–Newton on Σ |u_m − x_m(c)|²/σ_m², B-5: for one sensor Newton's method on x(c) = u. `None` where it does not settle.
    pub(super) fn descend(&self, respond: impl Fn(c64) -> Evaluated, start: c64) -> Option<Solution> {
        let evaluated = |c: c64| self.solution_at(respond(c), c);
        let (mut best, mut step) = evaluated(self.within_bounds(start)).ok()?;
        for _ in 0..MAX_STEPS {
            let size = (self.nominal + best.correction).norm();
            let (next, further) = evaluated(self.within_bounds(best.correction + step)).ok()?;
            let better = next.misfit < best.misfit;
            // A step of roundoff, or no better point though not far from one: this is it.
            let done = step.norm() <= f64::EPSILON * size || (!better && step.norm() <= 1e-6 * size);
            if better {
                (best, step) = (next, further);
            } else {
                step *= 0.5;
            }
            if done || (better && step.norm() <= f64::EPSILON * size) {
                let own = self.measured.len() > 1 || self.matched(&best);
                return own.then_some(best);
            }
        }
        None
    }

    /// As [`Self::descend`] where the way is short: the point that is likely the last is assessed where it is evaluated. Where it is not short, how far it came.
    pub(super) fn arrive(
        &self,
        respond: impl Fn(c64) -> Evaluated,
        assess: impl Fn(c64) -> Option<Assessment>,
        start: c64,
    ) -> Result<(Solution, Assessment), c64> {
        let size = (self.nominal + start).norm();
        let start = self.within_bounds(start);
        let (mut best, mut step) = self.solution_at(respond(start), start).map_err(|_| start)?;
        for _ in 0..MAX_SHORT_STEPS {
            let correction = self.within_bounds(best.correction + step);
            let stopped = best.correction;
            if step.norm() > LAST_STEP_RTOL * size {
                let (next, further) =
                    self.solution_at(respond(correction), correction).map_err(|_| stopped)?;
                (best, step) = if next.misfit < best.misfit { (next, further) } else { return Err(stopped) };
                continue;
            }
            let assessed = assess(correction).ok_or(stopped)?;
            let evaluated = (assessed.response.clone(), assessed.slope.clone());
            let (last, further) = self.solution_at(Ok(evaluated), correction).map_err(|_| stopped)?;
            // What the step after the next would be, at the rate of these two.
            let settled = further.norm_sqr() <= STEP_RTOL * size * step.norm();
            let own = self.measured.len() > 1 || self.matched(&last);
            if settled && own {
                return Ok((last, assessed));
            }
            (best, step) = if last.misfit < best.misfit { (last, further) } else { return Err(stopped) };
        }
        Err(best.correction)
    }

    /// Whether a single sensor's response is the measured one: a solution is known to roundoff of a response, and where it sits on a flat
    /// segment, to the square root of that.
    fn matched(&self, solution: &Solution) -> bool {
        self.unknown.real || solution.misfit.sqrt() * self.sigma[0] <= 1e-7 * self.measured[0].norm()
    }

    fn within_bounds(&self, correction: c64) -> c64 {
        if self.unknown.real {
            c64::new((self.nominal + correction).re, 0.0) - self.nominal
        } else {
            correction
        }
    }

    /// The solution's record at c, where the model was evaluated, and the step from there.
    fn solution_at(&self, evaluated: Evaluated, correction: c64) -> Result<(Solution, c64), NoConvergence> {
        let (values, slopes) = evaluated?;
        let (mut misfit, mut curvature, mut gradient) = (0.0, 0.0, c64::default());
        for (m, (x, slope)) in values.iter().zip(&slopes).enumerate() {
            let weight = self.sigma[m].powi(-2);
            let rest = self.measured[m] - x;
            misfit += weight * rest.norm_sqr();
            curvature += weight * slope.norm_sqr();
            gradient += weight * slope.conj() * rest;
        }
        let step = gradient / curvature;
        let step = if self.unknown.real { c64::new(step.re, 0.0) } else { step };
        let finite = misfit.is_finite() && step.is_finite();
        let (std, response) = (curvature.powf(-0.5), values);
        let solution =
            Solution { correction, misfit, std, response, residual: f64::NAN, second: f64::INFINITY };
        if finite { Ok((solution, step)) } else { Err(NoConvergence) }
    }
}

/// (Σ |v_m|²/σ_m²)^{1/2}.
pub(super) fn weighed(values: &[c64], sigma: &[f64]) -> f64 {
    values.iter().zip(sigma).map(|(v, sigma)| (v / sigma).norm_sqr()).sum::<f64>().sqrt()
}

/// Σ |u_m − x_m|²/σ_m².
pub(super) fn misfit(measured: &[c64], x: &[c64], sigma: &[f64]) -> f64 {
    let rest = measured.iter().zip(x).zip(sigma);
    rest.map(|((u, x), sigma)| ((u - x) / sigma).norm_sqr()).sum()
}

/// Adds a solution, or takes the better of two that are one.
fn merge(solutions: &mut Vec<Solution>, new: Solution, nominal: c64) {
    let near = |other: &Solution| {
        (other.correction - new.correction).norm() <= SOLUTION_MERGE_RTOL * (nominal + new.correction).norm()
    };
    match solutions.iter_mut().find(|other| near(other)) {
        Some(other) if new.misfit < other.misfit => *other = new,
        Some(_) => {}
        None => solutions.push(new),
    }
}
