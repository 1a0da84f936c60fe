//! The likeliest moduli for a way to read the data: a grid of starts, then least squares of the misfit from the best of them.

use super::data_hypothesis::{DataHypothesis, Reading};
use super::misfit::{Misfit, START_SCALE, beside_noise, misfit, misfit_at, robust, weight, wrapped};
use super::moduli::Moduli;
use super::responses::Responses;
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::frequency::omega_rad_s;
use crate::halton;
use crate::identify::{DELAY_PHASE_STEP_RAD, MAX_DELAY_PHASE_RAD};
use crate::least_squares::{self, descend};
use crate::median::median;
use frfit_linalg::dense::{Matrix, solve};
use std::f64::consts::FRAC_1_SQRT_2;

/// Step of ln a: a natural frequency moves by half of it, and the valley of a coincidence of twenty measured and computed resonances in log|H| is as wide as a twentieth.
const LN_SIZE_STEP: f64 = 0.025;

/// Angles of loss in the middle of the band that are tried: of glass to that of rubber in transition.
const LOSS_ANGLES: [f64; 6] = [1e-5, 1e-3, 1e-2, 5e-2, 0.2, 0.8];

/// Slopes β that are tried beside the nominal's: a modulus rises with frequency, if more slowly than the nominal may say.
const LOG_SLOPES: [f64; 4] = [0.0, 0.2, 0.45, -0.2];

/// No solid has a slope beyond this; that of its loss is no larger than of a dashpot.
const MAX_LOG_SLOPE: f64 = 0.8;
const MAX_LOSS_SLOPE: f64 = 1.0;

/// How large the slope of a loss usually is.
const LOSS_SLOPE_STD: f64 = 0.4;

/// Points of the box of several unknowns, for each of them.
const POINTS_PER_UNKNOWN: usize = 300;

/// Starts that are followed for each unknown and two more, and how far apart they are in ln a.
const FOLLOWED_STARTS: usize = 2;
const START_SEPARATION: f64 = 0.04;

/// Evaluations of a first descent for each number, and how many starts are then followed to the end.
const FIRST_EVALUATIONS_PER_NUMBER: usize = 2;
const POLISHED_STARTS: usize = 2;

/// Evaluations of a further descent for each number, and descents at most: each with the scale that the one before left.
const EVALUATIONS_PER_NUMBER: usize = 4;
const MAX_DESCENTS: usize = 4;

/// A scale that changes by less than this is the last.
const SCALE_RTOL: f64 = 0.05;

/// Of a bound that is overstepped by one in ln a or β: enough to come back.
const BOUND_PENALTY: f64 = 1e4;

/// How well nominal values are known, in ln a: to a factor of two. Where data do not know the unknowns from each other or from a factor, this does.
const NOMINAL_LN_STD: f64 = 0.7;

/// Step of a coordinate for the slope of how far it is beyond its bounds.
const DIFFERENCE_STEP: f64 = 1e-6;

/// Values as they were written, `[frequency][sensor]`.
pub(super) struct Written {
    /// ln of the complex value, `None` where it is zero or no number.
    pub(super) values: Vec<Vec<Option<c64>>>,
    /// The variance that noise gives the real and the imaginary part of that logarithm, zero where it is not known.
    pub(super) noise: Vec<Vec<f64>>,
}

impl Written {
    /// All values but those of one sensor.
    pub(super) fn without(&self, sensor: usize) -> Self {
        let blanked = |values: &Vec<Option<c64>>| {
            values.iter().enumerate().map(|(m, value)| value.filter(|_| m != sensor)).collect()
        };
        Self { values: self.values.iter().map(blanked).collect(), noise: self.noise.clone() }
    }
}

/// A measured value beside the model's.
struct Compared {
    /// Which of all values `[frequency][sensor]`, one after the other.
    at: usize,
    measured: Reading,
    /// Variance of its noise.
    noise: f64,
}

impl Compared {
    /// ln(measured/model), with the model's logarithms given.
    fn residual(&self, ln: &[c64], ln_factor: f64, delay_s: f64) -> c64 {
        wrapped(self.measured.receptance(ln_factor, delay_s) - ln[self.at])
    }

    /// The same, as large at [`START_SCALE`] as it is beside its noise.
    fn rough(&self, ln: &[c64], ln_factor: f64, delay_s: f64) -> c64 {
        beside_noise(self.residual(ln, ln_factor, delay_s), self.noise, START_SCALE)
    }
}

/// How far least squares go.
#[derive(Clone, Copy)]
struct Descent {
    /// Of the misfit.
    scale: f64,
    /// Evaluations for each number.
    patience: usize,
    /// Whether the slope of the loss is free.
    with_loss_slope: bool,
}

/// Everything a search needs.
pub(super) struct Search<'s, 'a> {
    pub(super) responses: &'s Responses<'a>,
    pub(super) written: &'s Written,
    pub(super) for_each: ForEach<'s>,
}

/// The moduli, the factor and the delay of least misfit.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub(super) moduli: Moduli,
    pub(super) ln_factor: f64,
    pub(super) delay_s: f64,
    /// By how much the delay turns the phase at the top of the band.
    pub(super) delay_phase_rad: f64,
    pub(super) misfit: Misfit,
    /// How many values there are.
    pub(super) values: usize,
    /// The misfit of each sensor for itself: the one of all leaves out a sensor that differs from most.
    pub(super) own: Vec<f64>,
    /// −ln likelihood, and half the logarithm of the number of values for each free number (BIC/2).
    pub(super) nats: f64,
}

impl Fitted {
    /// The largest misfit of any sensor.
    pub(super) fn worst(&self) -> f64 {
        self.own.iter().copied().fold(self.misfit.sigma, f64::max)
    }

    /// The misfit of some sensors: root mean square of theirs.
    pub(super) fn misfit_of(&self, sensors: &[usize]) -> f64 {
        let sum: f64 = sensors.iter().map(|&m| self.own[m] * self.own[m]).sum();
        (sum / sensors.len().max(1) as f64).sqrt()
    }
}

/// Where a search begins: moduli, ln of the factor, delay in s.
pub(super) type Start = (Moduli, f64, f64);

/// ln x at the points of the grid, `[point][frequency · sensor]`.
pub(super) struct Grid {
    moduli: Vec<Moduli>,
    ln: Vec<Vec<c64>>,
}

impl Search<'_, '_> {
    /// Responses at all points of the grid, at the sensors as the case gives them.
    ///
    /// Of one unknown sizes, losses and slopes; of several the same with all sizes by one ratio, and points of the box.
    pub(super) fn grid(&self, sensors: usize) -> Grid {
        let parametrization = &self.responses.parametrization;
        let [low, high] = parametrization.common();
        let steps = ((high - low) / LN_SIZE_STEP).ceil().max(1.0) as usize;
        let [has_loss, has_slope] = parametrization.has_loss();
        let angles = if has_loss { &LOSS_ANGLES[..] } else { &LOSS_ANGLES[..1] };
        let slopes = if has_slope { &LOG_SLOPES[..] } else { &LOG_SLOPES[..1] };
        let mut moduli = Vec::new();
        for k in 0..=steps {
            let ln_size = low + (high - low) * k as f64 / steps as f64;
            for &angle in angles {
                let of = |&slope| parametrization.all_by(ln_size, parametrization.ln_loss(angle), slope);
                moduli.extend(slopes.iter().map(of));
            }
        }
        let count = parametrization.free().count();
        let points = if count > 1 { POINTS_PER_UNKNOWN * count } else { 0 };
        moduli.extend((1..=points).map(|k| {
            let mut moduli = Moduli { ln_loss: parametrization.usual_loss(), ..parametrization.nominal() };
            for ((j, [low, high]), part) in parametrization.free().zip(halton::point(k)) {
                moduli.ln_sizes[j] = low + (high - low) * part;
            }
            moduli
        }));
        let columns: Vec<usize> = (0..sensors).collect();
        let ln = map(self.for_each, moduli.len(), |p| {
            (0..self.written.values.len()).flat_map(|i| self.responses.ln(&moduli[p], i, &columns)).collect()
        });
        Grid { moduli, ln }
    }

    /// What was measured, as it is read.
    fn compared(&self, data_hypothesis: &DataHypothesis) -> Vec<Compared> {
        let sensors = data_hypothesis.sensors();
        let one = |at: usize| {
            let (i, m) = (at / sensors, at % sensors);
            let written = self.written.values[i][m]?;
            Some(Compared {
                at,
                measured: data_hypothesis.reading(m, self.responses.frequency_hz[i], written),
                noise: self.written.noise[i][m],
            })
        };
        (0..self.written.values.len() * sensors).filter_map(one).collect()
    }

    /// The likeliest moduli from the best of the grid and from starts that are known.
    pub(super) fn fit(&self, data_hypothesis: &DataHypothesis, grid: &Grid, known: &[&Fitted]) -> Fitted {
        let values = self.compared(data_hypothesis);
        let scored = map(self.for_each, grid.moduli.len(), |p| score(&values, &grid.ln[p]));
        let mut order: Vec<usize> = (0..scored.len()).collect();
        order.sort_by(|&a, &b| scored[a].0.total_cmp(&scored[b].0));
        let mut starts: Vec<Start> =
            known.iter().map(|known| (known.moduli.clone(), known.ln_factor, known.delay_s)).collect();
        if self.responses.is_modal() {
            let about = &self.responses.about;
            starts.push((about.clone(), score(&values, &self.ln(data_hypothesis, about)).1, 0.0));
        }
        let first = starts.len();
        let followed = FOLLOWED_STARTS + self.responses.parametrization.free().count();
        for &p in &order {
            let moduli = &grid.moduli[p];
            if starts[first..].iter().all(|(other, ..)| other.ln_size_distance(moduli) > START_SEPARATION) {
                starts.push((moduli.clone(), scored[p].1, 0.0));
            }
            if starts.len() == first + followed {
                break;
            }
        }
        self.follow(data_hypothesis, starts)
    }

    /// So many points of the grid that are best for a way to read the data.
    pub(super) fn best_points(
        &self,
        data_hypothesis: &DataHypothesis,
        grid: &Grid,
        most: usize,
    ) -> Vec<usize> {
        let values = self.compared(data_hypothesis);
        let scored = map(self.for_each, grid.ln.len(), |p| score(&values, &grid.ln[p]).0);
        let mut order: Vec<usize> = (0..scored.len()).collect();
        order.sort_by(|&a, &b| scored[a].total_cmp(&scored[b]));
        order.truncate(most);
        order
    }

    /// The least misfit at some points of the grid, at a broad scale.
    pub(super) fn best_score(&self, data_hypothesis: &DataHypothesis, grid: &Grid, points: &[usize]) -> f64 {
        let values = self.compared(data_hypothesis);
        let scores = points.iter().map(|&p| score(&values, &grid.ln[p]).0);
        scores.fold(f64::INFINITY, f64::min)
    }

    /// The start of least misfit at a broad scale, with the factor and the delay that are best there.
    pub(super) fn likeliest_start(
        &self,
        data_hypothesis: &DataHypothesis,
        starts: Vec<Start>,
    ) -> (f64, Start) {
        let values = self.compared(data_hypothesis);
        let scored = starts.into_iter().map(|(moduli, _, delay_s)| {
            let ln = self.ln(data_hypothesis, &moduli);
            let ln_factor = score(&values, &ln).1;
            let mut start = (moduli, ln_factor, delay_s);
            if data_hypothesis.free()[1] {
                start = self.with_delay(data_hypothesis, &values, start);
            }
            let residuals = values.iter().map(|value| value.rough(&ln, start.1, start.2));
            (misfit_at(residuals, START_SCALE), start)
        });
        let best = scored.min_by(|a, b| a.0.total_cmp(&b.0));
        best.unwrap_or_else(|| (f64::INFINITY, (self.responses.parametrization.nominal(), 0.0, 0.0)))
    }

    /// The best that a search from each of some starts comes to: all are followed a little way, and the best of them to the end.
    pub(super) fn follow(&self, data_hypothesis: &DataHypothesis, mut starts: Vec<Start>) -> Fitted {
        if data_hypothesis.free()[1] {
            let values = self.compared(data_hypothesis);
            starts =
                starts.into_iter().map(|start| self.with_delay(data_hypothesis, &values, start)).collect();
        }
        let mut found = map(self.for_each, starts.len(), |k| {
            let theta = self.coordinates(data_hypothesis, &starts[k]);
            let descent = Descent {
                scale: START_SCALE,
                patience: FIRST_EVALUATIONS_PER_NUMBER,
                with_loss_slope: false,
            };
            self.descended(data_hypothesis, &theta, descent)
        });
        found.extend(starts.iter().map(|start| self.at(data_hypothesis, start)));
        found.sort_by(|a, b| a.nats.total_cmp(&b.nats));
        let polished = map(self.for_each, found.len().min(POLISHED_STARTS), |k| {
            self.polished(data_hypothesis, found[k].clone(), false)
        });
        let best = polished.into_iter().min_by(|a, b| a.nats.total_cmp(&b.nats));
        let best = best.unwrap_or_else(|| {
            self.at(data_hypothesis, &(self.responses.parametrization.nominal(), 0.0, 0.0))
        });
        // The slope of the loss is known only where everything else nearly is.
        self.polished(data_hypothesis, best, true)
    }

    /// A start with the best of all delays.
    fn with_delay(
        &self,
        data_hypothesis: &DataHypothesis,
        values: &[Compared],
        (moduli, ln_factor, delay_s): Start,
    ) -> Start {
        let ln = self.ln(data_hypothesis, &moduli);
        let top = self.top();
        let steps = (MAX_DELAY_PHASE_RAD / DELAY_PHASE_STEP_RAD) as i64;
        let delays =
            (-steps..=steps).map(|k| k as f64 * DELAY_PHASE_STEP_RAD / top).chain(std::iter::once(delay_s));
        let scored = delays.map(|tau| {
            let residuals = values.iter().map(|value| value.rough(&ln, ln_factor, tau));
            (misfit_at(residuals, START_SCALE), tau)
        });
        let best = scored.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, tau)| tau);
        (moduli, ln_factor, best)
    }

    fn ln(&self, data_hypothesis: &DataHypothesis, moduli: &Moduli) -> Vec<c64> {
        let at = |i| self.responses.ln(moduli, i, &data_hypothesis.column);
        (0..self.written.values.len()).flat_map(at).collect()
    }

    /// ω at the top of the band.
    fn top(&self) -> f64 {
        omega_rad_s(self.responses.frequency_hz.last().copied().unwrap_or(1.0))
    }

    /// Coordinates of a start: of the moduli, then of factor and delay where they are unknown.
    fn coordinates(
        &self,
        data_hypothesis: &DataHypothesis,
        (moduli, ln_factor, delay_s): &Start,
    ) -> Vec<f64> {
        let [factor, delay] = data_hypothesis.free();
        let mut at = self.responses.parametrization.coordinates(moduli);
        at.extend(factor.then_some(*ln_factor));
        at.extend(delay.then_some(delay_s * self.top()));
        at
    }

    fn parts(&self, data_hypothesis: &DataHypothesis, at: &[f64]) -> Start {
        let [factor, delay] = data_hypothesis.free();
        let (moduli, rest) = self.responses.parametrization.of(at);
        let mut rest = rest.iter().copied();
        let mut next = |is_free: bool| if is_free { rest.next().unwrap_or(0.0) } else { 0.0 };
        let ln_factor = next(factor);
        (moduli, ln_factor, next(delay) / self.top())
    }

    /// How far each size, and the slope of the loss, is from what is expected; its square is its share of −ln likelihood.
    fn far(&self, moduli: &Moduli) -> impl Iterator<Item = f64> {
        let expected = self.responses.parametrization.expected_ln_size;
        let sizes: Vec<f64> =
            self.responses.parametrization.free().map(|(j, _)| moduli.ln_sizes[j]).collect();
        let far = sizes.into_iter().map(move |ln| (ln - expected) / NOMINAL_LN_STD);
        far.chain([moduli.loss_slope / LOSS_SLOPE_STD]).map(|far| FRAC_1_SQRT_2 * far)
    }

    /// By how much each number is beyond its bounds.
    fn beyond(&self, moduli: &Moduli) -> Vec<f64> {
        let outside = |value: f64, [low, high]: [f64; 2]| (value - value.clamp(low, high)).abs();
        let sizes = self.responses.parametrization.free();
        let sizes = sizes.map(|(j, range)| outside(moduli.ln_sizes[j], range));
        let slopes = [(moduli.slope, MAX_LOG_SLOPE), (moduli.loss_slope, MAX_LOSS_SLOPE)];
        sizes.chain(slopes.map(|(slope, most)| outside(slope, [-most, most]))).collect()
    }

    fn at(&self, data_hypothesis: &DataHypothesis, start: &Start) -> Fitted {
        let (moduli, ln_factor, delay_s) = start;
        let ln = self.ln(data_hypothesis, moduli);
        let sensors = data_hypothesis.sensors();
        let mut by_sensor: Vec<(Vec<c64>, Vec<f64>)> = vec![Default::default(); sensors];
        for value in self.compared(data_hypothesis) {
            let (rest, noise) = &mut by_sensor[value.at % sensors];
            rest.push(value.residual(&ln, *ln_factor, *delay_s));
            noise.push(value.noise);
        }
        let own = by_sensor.iter().map(|(rest, noise)| misfit(rest, noise).sigma).collect();
        let (rest, noise): (Vec<Vec<c64>>, Vec<Vec<f64>>) = by_sensor.into_iter().unzip();
        let rest = rest.concat();
        let misfit = misfit(&rest, &noise.concat());
        let beyond: f64 = self.beyond(moduli).iter().map(|b| b * b).sum();
        let far: f64 = self.far(moduli).map(|far| far * far).sum();
        let count = self.coordinates(data_hypothesis, start).len();
        let penalty = 0.5 * count as f64 * (2.0 * rest.len().max(1) as f64).ln();
        Fitted {
            moduli: moduli.clone(),
            ln_factor: *ln_factor,
            delay_s: *delay_s,
            delay_phase_rad: delay_s * self.top(),
            misfit,
            values: rest.len(),
            own,
            nats: misfit.nats + penalty + far + BOUND_PENALTY * beyond,
        }
    }

    /// Residuals with their slopes by all coordinates, `[value]` and `[coordinate][value]`.
    fn with_slopes(
        &self,
        data_hypothesis: &DataHypothesis,
        values: &[Compared],
        at: &[f64],
    ) -> (Vec<c64>, Vec<Vec<c64>>) {
        let (moduli, ln_factor, delay_s) = self.parts(data_hypothesis, at);
        let parametrization = &self.responses.parametrization;
        let sensors = data_hypothesis.sensors();
        let of_moduli = parametrization.coordinates(&moduli).len();
        let mut ln = Vec::with_capacity(self.written.values.len() * sensors);
        let mut of_ln: Vec<Vec<c64>> = vec![Vec::with_capacity(ln.capacity()); of_moduli];
        for i in 0..self.written.values.len() {
            let (own, by_value) = self.responses.ln_with_slopes(&moduli, i, &data_hypothesis.column);
            for (of_ln, by) in of_ln.iter_mut().zip(parametrization.slopes(&moduli, i)) {
                of_ln.extend(
                    (0..sensors)
                        .map(|m| -> c64 { by_value.iter().zip(&by).map(|(slope, by)| slope[m] * by).sum() }),
                );
            }
            ln.extend(own);
        }
        let residuals = values.iter().map(|value| value.residual(&ln, ln_factor, delay_s)).collect();
        let of_values = |slope: &Vec<c64>| values.iter().map(|value| -slope[value.at]).collect();
        let mut slopes: Vec<Vec<c64>> = of_ln.iter().map(of_values).collect();
        let [factor, delay] = data_hypothesis.free();
        if factor {
            slopes.push(values.iter().map(|value| c64::new(-value.measured.factor, 0.0)).collect());
        }
        if delay {
            let by_delay = |value: &Compared| c64::new(0.0, value.measured.turn / self.top());
            slopes.push(values.iter().map(by_delay).collect());
        }
        (residuals, slopes)
    }

    /// Least squares with the scale that is left, until it stays.
    fn polished(&self, data_hypothesis: &DataHypothesis, start: Fitted, with_loss_slope: bool) -> Fitted {
        let mut best = start;
        for _ in 0..MAX_DESCENTS {
            let scale = best.misfit.sigma;
            let from = (best.moduli.clone(), best.ln_factor, best.delay_s);
            let theta = self.coordinates(data_hypothesis, &from);
            let descent = Descent { scale, patience: EVALUATIONS_PER_NUMBER, with_loss_slope };
            let there = self.descended(data_hypothesis, &theta, descent);
            if there.nats >= best.nats {
                break;
            }
            best = there;
            if (best.misfit.sigma / scale).ln().abs() < SCALE_RTOL {
                break;
            }
        }
        best
    }

    /// Where least squares of what the misfit is at a scale lead to.
    fn descended(
        &self,
        data_hypothesis: &DataHypothesis,
        theta: &[f64],
        Descent { scale, patience, with_loss_slope }: Descent,
    ) -> Fitted {
        let compared = self.compared(data_hypothesis);
        let held = self.responses.parametrization.loss_slope_at().filter(|_| !with_loss_slope);
        let evaluate = |theta: &[f64]| {
            let (residuals, slopes) = self.with_slopes(data_hypothesis, &compared, theta);
            let turned: Vec<_> = residuals
                .iter()
                .zip(&compared)
                .map(|(&r, value)| robust(r, scale.hypot(value.noise.sqrt())))
                .collect();
            let beyond = self.beyond(&self.parts(data_hypothesis, theta).0);
            let bounds = beyond.iter().map(|b| BOUND_PENALTY.sqrt() * b);
            let far = |theta: &[f64]| self.far(&self.parts(data_hypothesis, theta).0).collect::<Vec<f64>>();
            let values: Vec<f64> = turned
                .iter()
                .flat_map(|one| [one.value.re, one.value.im])
                .chain(bounds)
                .chain(far(theta))
                .collect();
            let mut jacobian: Vec<f64> = Vec::with_capacity(values.len() * theta.len());
            for (j, slope) in slopes.iter().enumerate() {
                if held == Some(j) {
                    jacobian.resize(jacobian.len() + values.len(), 0.0);
                    continue;
                }
                let of_values = turned.iter().zip(slope).map(|(one, by)| one.slope(*by));
                jacobian.extend(of_values.flat_map(|slope| [slope.re, slope.im]));
                let mut moved = theta.to_vec();
                moved[j] += DIFFERENCE_STEP;
                let there = self.beyond(&self.parts(data_hypothesis, &moved).0);
                let change = there.iter().zip(&beyond).map(|(b, a)| (b - a) / DIFFERENCE_STEP);
                jacobian.extend(change.map(|slope| BOUND_PENALTY.sqrt() * slope));
                let here = far(theta);
                jacobian.extend(far(&moved).iter().zip(here).map(|(b, a)| (b - a) / DIFFERENCE_STEP));
            }
            let finite = values.iter().chain(&jacobian).all(|value| value.is_finite());
            finite.then_some((values, jacobian))
        };
        let search = least_squares::Search { starts: 1, patience, same: 0.0 };
        let end = descend(theta, &evaluate, &search);
        let theta = end.as_ref().map_or(theta, |end| &end.theta);
        self.at(data_hypothesis, &self.parts(data_hypothesis, theta))
    }

    /// Standard deviations of the factor's logarithm and of the delay, the moduli free beside them: weighted least squares about the answer.
    pub(super) fn standard_deviations(
        &self,
        data_hypothesis: &DataHypothesis,
        fitted: &Fitted,
    ) -> [Option<f64>; 2] {
        let start = (fitted.moduli.clone(), fitted.ln_factor, fitted.delay_s);
        let at = self.coordinates(data_hypothesis, &start);
        let compared = self.compared(data_hypothesis);
        let (about, slopes) = self.with_slopes(data_hypothesis, &compared, &at);
        let sigma = fitted.misfit.sigma;
        let product = |a: &[c64], b: &[c64]| -> f64 {
            let terms = a.iter().zip(b).zip(about.iter().zip(&compared));
            let term = |((a, b), (r, value)): ((&c64, &c64), (&c64, &Compared))| {
                let variance = sigma * sigma + value.noise;
                weight(*r, variance.sqrt()) * (a.re * b.re + a.im * b.im) / variance
            };
            terms.map(term).sum()
        };
        let [factor, delay] = data_hypothesis.free();
        let size = at.len() - usize::from(factor) - usize::from(delay);
        let sizes = self.responses.parametrization.free().count();
        // A number that the data do not know at all shall not make the others unknown.
        let ridge = |j: usize| match j {
            _ if j < sizes => NOMINAL_LN_STD.powi(-2),
            _ if j < size => 1e-6,
            _ => 0.0,
        };
        let normal = Matrix::from_fn(at.len(), at.len(), |i, j| {
            c64::new(product(&slopes[i], &slopes[j]) + if i == j { ridge(j) } else { 0.0 }, 0.0)
        });
        let std = |j: usize| {
            let mut unit = vec![c64::default(); at.len()];
            unit[j] = c64::new(1.0, 0.0);
            let variance = solve(&normal, &unit).ok()?[j].re;
            (variance > 0.0).then(|| variance.sqrt())
        };
        let of_factor = if factor { std(size) } else { None };
        let of_delay = if delay { std(size + usize::from(factor)) } else { None };
        [of_factor, of_delay.map(|phase| phase / self.top())]
    }

    /// Slope of ln|measured/model| over ln ω of some sensors and its standard deviation, as the data are read and the moduli were found.
    pub(super) fn slope(
        &self,
        data_hypothesis: &DataHypothesis,
        fitted: &Fitted,
        sensors: &[usize],
    ) -> Option<(f64, f64)> {
        let ln = self.ln(data_hypothesis, &fitted.moduli);
        let count = data_hypothesis.sensors();
        let values = self.compared(data_hypothesis).into_iter();
        let of_sensors = values.filter(|value| sensors.contains(&(value.at % count)));
        let point = |value: Compared| {
            let omega = omega_rad_s(self.responses.frequency_hz[value.at / count]);
            (omega.ln(), value.residual(&ln, fitted.ln_factor, fitted.delay_s).re)
        };
        let points: Vec<(f64, f64)> = of_sensors.map(point).collect();
        line_slope(&points)
    }
}

/// Misfit of a point of the grid at a broad scale, and the logarithm of the factor there.
fn score(values: &[Compared], ln: &[c64]) -> (f64, f64) {
    let of_factor = values.iter().filter(|value| value.measured.factor > 0.0);
    let ln_factor = median(of_factor.map(|value| value.residual(ln, 0.0, 0.0).re).collect()).unwrap_or(0.0);
    let residual = |value: &Compared| {
        let residual = value.rough(ln, ln_factor, 0.0);
        // A phase that a delay may have turned is not used yet.
        if value.measured.turn > 0.0 { c64::new(residual.re, 0.0) } else { residual }
    };
    (misfit_at(values.iter().map(residual), START_SCALE), ln_factor)
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
