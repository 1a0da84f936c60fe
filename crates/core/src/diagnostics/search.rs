//! The likeliest modulus for a way to read the data: a grid over all moduli, then a simplex search from the best of it.

use super::data_hypothesis::DataHypothesis;
use super::misfit::{Misfit, misfit, misfit_at, weight, wrapped};
use super::responses::{Law, Responses};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::frequency::omega_rad_s;
use crate::identify::{DELAY_PHASE_STEP_RAD, MAX_DELAY_PHASE_RAD};
use crate::median::median;
use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::neldermead::NelderMead;
use frfit_linalg::dense::{Matrix, solve};

/// Step of ln a: a natural frequency moves by half of it, and the valley of a coincidence of twenty measured and computed resonances in log|H| is as wide as a twentieth.
const LN_SIZE_STEP: f64 = 0.025;

/// Angles of loss in the middle of the band that are tried: of glass to that of rubber in transition.
const LOSS_ANGLES: [f64; 6] = [1e-5, 1e-3, 1e-2, 5e-2, 0.2, 0.8];

/// Slopes β that are tried beside the nominal's: a modulus rises with frequency, if more slowly than the nominal may say.
const LOG_SLOPES: [f64; 4] = [0.0, 0.2, 0.45, -0.2];

/// Slopes beyond this are none of a solid.
const MAX_LOG_SLOPE: f64 = 0.8;

/// Scale at which starts are compared: valleys of this width in ln H are wide enough to be found on the grid.
const START_SCALE: f64 = 0.3;

/// Starts that are followed, and how far apart they are in ln a.
const FOLLOWED_MODULI: usize = 3;
const START_SEPARATION: f64 = 0.04;

/// Steps of a simplex for each unknown.
const SIMPLEX_STEPS_PER_UNKNOWN: u64 = 45;

/// Of a bound that is overstepped by one in ln a or β: enough to come back.
const BOUND_PENALTY: f64 = 1e4;

/// Values as they were written: ln of the complex value at `[frequency][sensor]`, `None` where it is zero or no number.
pub(super) struct Written(pub(super) Vec<Vec<Option<c64>>>);

/// Everything a search needs.
pub(super) struct Search<'s, 'a> {
    pub(super) responses: &'s Responses<'a>,
    pub(super) written: &'s Written,
    pub(super) for_each: ForEach<'s>,
}

/// The modulus, the factor and the delay of least misfit.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub(super) law: Law,
    pub(super) ln_factor: f64,
    pub(super) delay_s: f64,
    pub(super) misfit: Misfit,
    /// −ln likelihood, and half the logarithm of the number of values for each free number (BIC/2).
    pub(super) nats: f64,
}

/// ln x at the points of the grid, `[point][frequency · sensor]`.
pub(super) struct Grid {
    laws: Vec<Law>,
    ln: Vec<Vec<c64>>,
}

impl Search<'_, '_> {
    /// Responses at all points of the grid, at the sensors as the case gives them.
    pub(super) fn grid(&self, sensors: usize) -> Grid {
        let parametrization = &self.responses.parametrization;
        let [low, high] = parametrization.ln_size;
        let steps = ((high - low) / LN_SIZE_STEP).ceil().max(1.0) as usize;
        let (angles, slopes) = if parametrization.is_real {
            (&LOSS_ANGLES[..1], &LOG_SLOPES[..1])
        } else {
            (&LOSS_ANGLES[..], &LOG_SLOPES[..])
        };
        let mut laws = Vec::with_capacity((steps + 1) * angles.len() * slopes.len());
        for k in 0..=steps {
            let ln_size = low + (high - low) * k as f64 / steps as f64;
            for &angle in angles {
                laws.extend(slopes.iter().map(|&slope| [ln_size, parametrization.ln_loss(angle), slope]));
            }
        }
        let columns: Vec<usize> = (0..sensors).collect();
        let ln = map(self.for_each, laws.len(), |p| {
            (0..self.written.0.len()).flat_map(|i| self.responses.ln(laws[p], i, &columns)).collect()
        });
        Grid { laws, ln }
    }

    /// Residuals ln(measured/model) with the model's logarithms given, `None` where nothing was measured.
    fn residuals<'r>(
        &'r self,
        data_hypothesis: &'r DataHypothesis,
        ln: &'r [c64],
        ln_factor: f64,
        delay_s: f64,
    ) -> impl Iterator<Item = (usize, c64)> + 'r {
        let sensors = data_hypothesis.sensors();
        self.written.0.iter().enumerate().flat_map(move |(i, values)| {
            values.iter().enumerate().filter_map(move |(m, value)| {
                let f = self.responses.frequency_hz[i];
                let read = data_hypothesis.receptance(m, f, (*value)?, ln_factor, delay_s);
                Some((m, wrapped(read - ln[i * sensors + m])))
            })
        })
    }

    /// The likeliest modulus from the best of the grid and from a start that is known.
    pub(super) fn fit(
        &self,
        data_hypothesis: &DataHypothesis,
        grid: &Grid,
        known: Option<&Fitted>,
    ) -> Fitted {
        let scored = map(self.for_each, grid.laws.len(), |p| self.score(data_hypothesis, &grid.ln[p]));
        let mut order: Vec<usize> = (0..scored.len()).collect();
        order.sort_by(|&a, &b| scored[a].0.total_cmp(&scored[b].0));
        let mut starts: Vec<(Law, f64, f64)> =
            known.iter().map(|known| (known.law, known.ln_factor, known.delay_s)).collect();
        let first = starts.len();
        for &p in &order {
            let law = grid.laws[p];
            if starts[first..].iter().all(|(other, ..)| (other[0] - law[0]).abs() > START_SEPARATION) {
                starts.push((law, scored[p].1, 0.0));
            }
            if starts.len() == first + FOLLOWED_MODULI {
                break;
            }
        }
        if data_hypothesis.free()[1] {
            let from = std::mem::take(&mut starts);
            starts = from.into_iter().map(|start| self.with_delay(data_hypothesis, start)).collect();
        }
        self.follow(data_hypothesis, &starts)
    }

    /// The best that a search from each of some starts comes to.
    pub(super) fn follow(&self, data_hypothesis: &DataHypothesis, starts: &[(Law, f64, f64)]) -> Fitted {
        let found = map(self.for_each, starts.len(), |k| self.polished(data_hypothesis, starts[k]));
        let best = found.into_iter().min_by(|a, b| a.nats.total_cmp(&b.nats));
        best.unwrap_or_else(|| self.at(data_hypothesis, &[0.0; 5]))
    }

    /// Misfit of a point of the grid at a broad scale, and the logarithm of the factor there.
    fn score(&self, data_hypothesis: &DataHypothesis, ln: &[c64]) -> (f64, f64) {
        let [factor, delay] = data_hypothesis.free();
        let mut ln_factor = 0.0;
        if factor {
            let of = self
                .residuals(data_hypothesis, ln, 0.0, 0.0)
                .filter(|&(m, _)| data_hypothesis.concerned(m)[0]);
            ln_factor = median(of.map(|(_, r)| r.re).collect()).unwrap_or(0.0);
        }
        // A phase that a delay may have turned is not used yet.
        let weighed = |(m, r): (usize, c64)| {
            if delay && data_hypothesis.concerned(m)[1] { c64::new(r.re, 0.0) } else { r }
        };
        let score = misfit_at(self.residuals(data_hypothesis, ln, ln_factor, 0.0).map(weighed), START_SCALE);
        (score, ln_factor)
    }

    /// A start with the best of all delays.
    fn with_delay(
        &self,
        data_hypothesis: &DataHypothesis,
        (law, ln_factor, delay_s): (Law, f64, f64),
    ) -> (Law, f64, f64) {
        let ln = self.ln(data_hypothesis, law);
        let top = self.top();
        let steps = (MAX_DELAY_PHASE_RAD / DELAY_PHASE_STEP_RAD) as i64;
        let delays =
            (-steps..=steps).map(|k| k as f64 * DELAY_PHASE_STEP_RAD / top).chain(std::iter::once(delay_s));
        let scored = delays.map(|tau| {
            (misfit_at(self.residuals(data_hypothesis, &ln, ln_factor, tau).map(|r| r.1), START_SCALE), tau)
        });
        let best = scored.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, tau)| tau);
        (law, ln_factor, best)
    }

    fn ln(&self, data_hypothesis: &DataHypothesis, law: Law) -> Vec<c64> {
        (0..self.written.0.len()).flat_map(|i| self.responses.ln(law, i, &data_hypothesis.column)).collect()
    }

    /// ω at the top of the band.
    fn top(&self) -> f64 {
        omega_rad_s(self.responses.frequency_hz.last().copied().unwrap_or(1.0))
    }

    /// Coordinates of a start: of the modulus, then of factor and delay where they are looked for.
    fn coordinates(
        &self,
        data_hypothesis: &DataHypothesis,
        (law, ln_factor, delay_s): (Law, f64, f64),
    ) -> Vec<f64> {
        let [factor, delay] = data_hypothesis.free();
        let mut at = if self.responses.parametrization.is_real { law[..1].to_vec() } else { law.to_vec() };
        at.extend(factor.then_some(ln_factor));
        at.extend(delay.then_some(delay_s * self.top()));
        at
    }

    fn parts(&self, data_hypothesis: &DataHypothesis, at: &[f64]) -> (Law, f64, f64) {
        let [factor, delay] = data_hypothesis.free();
        let mut rest = at.iter().copied();
        let mut next = || rest.next().unwrap_or(0.0);
        let law = if self.responses.parametrization.is_real {
            [next(), 0.0, 0.0]
        } else {
            [next(), next(), next()]
        };
        let ln_factor = if factor { next() } else { 0.0 };
        (law, ln_factor, if delay { next() / self.top() } else { 0.0 })
    }

    fn at(&self, data_hypothesis: &DataHypothesis, at: &[f64]) -> Fitted {
        let (law, ln_factor, delay_s) = self.parts(data_hypothesis, at);
        let ln = self.ln(data_hypothesis, law);
        let rest: Vec<c64> = self.residuals(data_hypothesis, &ln, ln_factor, delay_s).map(|r| r.1).collect();
        let misfit = misfit(&rest);
        let [low, high] = self.responses.parametrization.ln_size;
        let beyond = (low - law[0]).max(law[0] - high).max(law[2].abs() - MAX_LOG_SLOPE).max(0.0);
        let penalty = 0.5 * at.len() as f64 * (2.0 * rest.len().max(1) as f64).ln();
        Fitted {
            law,
            ln_factor,
            delay_s,
            misfit,
            nats: misfit.nats + penalty + BOUND_PENALTY * beyond * beyond,
        }
    }

    fn polished(&self, data_hypothesis: &DataHypothesis, start: (Law, f64, f64)) -> Fitted {
        let begin = self.coordinates(data_hypothesis, start);
        // First lengths: half a step of the grid, a third of that of the angle, and so on.
        let lengths = [0.5 * LN_SIZE_STEP, 0.7, 0.07];
        let size = if self.responses.parametrization.is_real { 1 } else { 3 };
        let length = |j: usize| if j < size { lengths[j] } else { 0.1 };
        let mut simplex = vec![begin.clone()];
        for j in 0..begin.len() {
            let mut vertex = begin.clone();
            vertex[j] += length(j);
            simplex.push(vertex);
        }
        let cost = Cost { search: self, data_hypothesis };
        let fallback = self.at(data_hypothesis, &begin);
        let Ok(solver) = NelderMead::new(simplex).with_sd_tolerance(1e-3) else { return fallback };
        let steps = SIMPLEX_STEPS_PER_UNKNOWN * begin.len() as u64;
        let run = Executor::new(cost, solver).configure(|state| state.max_iters(steps)).run();
        match run.ok().and_then(|run| run.state().get_best_param().cloned()) {
            Some(best) => self.at(data_hypothesis, &best),
            None => fallback,
        }
    }

    /// Standard deviations of the factor's logarithm and of the delay, the modulus free beside them: weighted least squares about the answer.
    pub(super) fn standard_deviations(
        &self,
        data_hypothesis: &DataHypothesis,
        fitted: &Fitted,
    ) -> [Option<f64>; 2] {
        let at = self.coordinates(data_hypothesis, (fitted.law, fitted.ln_factor, fitted.delay_s));
        let rest = |at: &[f64]| -> Vec<c64> {
            let (law, ln_factor, delay_s) = self.parts(data_hypothesis, at);
            let ln = self.ln(data_hypothesis, law);
            self.residuals(data_hypothesis, &ln, ln_factor, delay_s).map(|r| r.1).collect()
        };
        let about = rest(&at);
        const DIFFERENCE_STEP: f64 = 1e-5;
        let slopes: Vec<Vec<c64>> = (0..at.len())
            .map(|j| {
                let mut moved = at.clone();
                moved[j] += DIFFERENCE_STEP;
                rest(&moved).iter().zip(&about).map(|(b, a)| wrapped(b - a) / DIFFERENCE_STEP).collect()
            })
            .collect();
        let sigma = fitted.misfit.sigma;
        let product = |a: &[c64], b: &[c64]| -> f64 {
            let terms = a.iter().zip(b).zip(&about);
            terms.map(|((a, b), r)| weight(*r, sigma) * (a.re * b.re + a.im * b.im)).sum::<f64>()
                / (sigma * sigma)
        };
        let size = if self.responses.parametrization.is_real { 1 } else { 3 };
        // A number that the data do not know at all shall not make the others unknown.
        let ridge = |j: usize| if j < size { 1e-6 } else { 0.0 };
        let normal = Matrix::from_fn(at.len(), at.len(), |i, j| {
            c64::new(product(&slopes[i], &slopes[j]) + if i == j { ridge(j) } else { 0.0 }, 0.0)
        });
        let std = |j: usize| {
            let mut unit = vec![c64::default(); at.len()];
            unit[j] = c64::new(1.0, 0.0);
            let variance = solve(&normal, &unit).ok()?[j].re;
            (variance > 0.0).then(|| variance.sqrt())
        };
        let [factor, delay] = data_hypothesis.free();
        let of_factor = if factor { std(size) } else { None };
        let of_delay = if delay { std(size + usize::from(factor)) } else { None };
        [of_factor, of_delay.map(|phase| phase / self.top())]
    }

    /// Slope of ln|measured/model| over ln ω of some sensors and its standard deviation, as the data are read and the modulus was found.
    pub(super) fn slope(
        &self,
        data_hypothesis: &DataHypothesis,
        fitted: &Fitted,
        sensors: &[usize],
    ) -> Option<(f64, f64)> {
        let ln = self.ln(data_hypothesis, fitted.law);
        let width = data_hypothesis.sensors();
        let mut points = Vec::new();
        for (i, values) in self.written.0.iter().enumerate() {
            let f = self.responses.frequency_hz[i];
            for &m in sensors {
                let Some(value) = values[m] else { continue };
                let read = data_hypothesis.receptance(m, f, value, fitted.ln_factor, fitted.delay_s);
                points.push((omega_rad_s(f).ln(), read.re - ln[i * width + m].re));
            }
        }
        line_slope(&points)
    }
}

/// Slope of a straight line through points, least squares, with its standard deviation.
fn line_slope(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let (x0, y0) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let sxx: f64 = points.iter().map(|p| (p.0 - x0).powi(2)).sum();
    let slope = points.iter().map(|p| (p.0 - x0) * (p.1 - y0)).sum::<f64>() / sxx;
    let rest: f64 = points.iter().map(|p| (p.1 - y0 - slope * (p.0 - x0)).powi(2)).sum();
    let std = (rest / (n - 2.0) / sxx).sqrt();
    (points.len() > 2 && sxx > 0.0).then_some((slope, std))
}

struct Cost<'c, 's, 'a> {
    search: &'c Search<'s, 'a>,
    data_hypothesis: &'c DataHypothesis,
}

impl CostFunction for Cost<'_, '_, '_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
        let nats = self.search.at(self.data_hypothesis, at).nats;
        Ok(if nats.is_finite() { nats } else { f64::MAX })
    }
}
