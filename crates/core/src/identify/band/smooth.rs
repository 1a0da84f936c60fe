//! A modulus that is free at every frequency but smooth over them (B-9): all frequencies and all sensors in one penalised least squares.
//!
//! Each frequency is first identified alone: this trains the subspace, and gives the start. Then ln E(ln ω) is an integrated Wiener process, and
//! $$ \sum_{k,m} \frac{|u_m - x_m(E(\omega_k))|^2}{\sigma_m^2} + \frac 1 {\kappa^2} \int \Big| \frac{d^2 \ln E}{d(\ln\omega)^2} \Big|^2 d\ln\omega $$
//! is made least by Gauss and Newton's steps, each of them one smoother's sweep over all frequencies ([`crate::smooth`]); κ, and the level of the noise where it is not
//! given, are averaged over their posterior. x is holomorphic in ln E and noise circular, and by causality the fluctuations of ln |E| and of the loss angle are
//! of one size: real and imaginary part have one κ, one weight, and no correlation.

use super::candidates::{misfit, weighed};
use super::corrected::correct;
use super::fit::sensor_misfit;
use super::joint;
use super::laws::{MAX_TRAINING_ROUNDS, RIVAL_DISTANCE_STD, START_SHIFTS};
use super::neighbourhoods::{MAX_REDUCTION_ERROR, Neighbourhoods, reduction_error};
use super::outcome::BandOutcome;
use super::scaled::Scaled;
use super::search_box::{near_or_far, on_subspace};
use crate::c64;
use crate::for_each::map;
use crate::frequency::omega_rad_s;
use crate::frfs::{Noise, standard_deviations};
use crate::identify::context::{Context, Stage};
use crate::identify::goodness_of_fit::{MAX_ERROR, MAX_RMS_MISFIT, SensorFit, judge};
use crate::identify::measured::Band;
use crate::identify::model_errors::{Estimated, Split};
use crate::identify::noise::{MIN_NOISE_LEVEL, NoiseLevel, NoiseSource, without};
use crate::identify::options::Options;
use crate::identify::outcome::{Line, Status};
use crate::identify::uncertainty::Uncertainty;
use crate::material::{OutsideTable, at_real_frequency};
use crate::model::ModelAt;
use crate::response::relative_error_without;
use crate::smooth::{Evidence, Observation, Smoothed, State, roughness, smooth};
use crate::subspace::Subspace;

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct SmoothOutcome {
    /// Each frequency alone.
    pub free: BandOutcome,
    /// The smooth modulus at each frequency, with all work in it.
    pub band: BandOutcome,
    /// The curve; `None` where there is no subspace, or fewer than three frequencies have an answer of their own: none has a smooth one then.
    pub curve: Option<SmoothCurve>,
}

/// The smooth curve through a band.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothCurve {
    /// Numbers that the curve takes from the data for E′, and as many for η: two for a power law, as many as there are frequencies where none helps another.
    pub parameters: f64,
    /// The band's width over the parameters, in octaves: what is nearer than that to a frequency has a say in its modulus.
    pub width_octaves: f64,
    /// Whether Gauss and Newton's steps came to an end.
    pub converged: bool,
    /// Frequencies that no smooth modulus explains, and which were left out.
    pub outliers: usize,
    observations: Vec<Observation>,
    evidence: Evidence,
    level: f64,
    real: bool,
    /// The window through which the values are seen.
    decay_per_s: f64,
}

/// Steps of Gauss and Newton for each training of the subspace.
const MAX_CURVE_STEPS: usize = 30;

/// Halvings of a step that makes things worse.
const MAX_HALVINGS: usize = 8;

/// A step below this part of the error bar, or of the modulus, counts as zero.
const CURVE_STEP_TOL: f64 = 1e-3;
const CURVE_ROUNDOFF: f64 = 1e-11;

/// Frequencies that are not explained are left out, but not more than this part of the band: else it is the curve that is wrong.
const MAX_OUTLIER_SHARE: f64 = 0.25;

/// Identifies a modulus that is smooth over the band, and no smoother than the data say.
///
/// The selection is joint, and what answers is the subspace, whatever the options say. Statuses are those of a single frequency ([`super::identify_band`]), judged at the
/// smooth modulus and its error bars: `ambiguous` is where the path that it follows was; `no_root` where the modulus breaks the bounds; `unexplained` where it leaves more
/// than noise and an error of 1 % ([`MAX_ERROR`]): this frequency has no influence on the others.
///
/// # Errors
/// [`OutsideTable`] where a table does not reach a frequency.
///
/// # Limits
/// One κ for the whole band: a modulus that is a straight line in one half and has a narrow feature in the other is smoothed less than it could be in the first. Error bars are linear in the noise,
/// and hold the scatter of answers that belong together: neighbours have nearly the same error. The factor must not be zero; at 0 Hz the curve is not defined.
pub(in crate::identify) fn identify_smooth<'a>(
    band: &Band<'a>,
    trained: &mut Option<Subspace<'a>>,
    options: &Options,
    context: Context<'_>,
) -> Result<SmoothOutcome, OutsideTable> {
    let at = band.model.at_all(band.frequency_hz, std::slice::from_ref(band.parameter))?;
    let options = &on_subspace(options);
    let mut reduced = Neighbourhoods::if_wanted(band, &at, trained, options, context);
    let (mut free, (), options) =
        near_or_far((band, &at), options, &mut reduced, true, context, |options, reduced| {
            (joint::identify(band, &at, reduced.as_mut(), &[], options, context), ())
        });
    let options = &options;
    if let Some(reduced) = &mut reduced {
        free = correct((band, &[]), &at, free, reduced, options, context);
    }
    let wider = Scaled::new(band, &[]).with_rest(free.rest(), band.frequency_hz);
    let band = &wider.band(band);
    let assumed = standard_deviations(band.frequency_hz, band.measured, band.noise);
    let out = free.left_out();
    let sigma = without(&assumed, &out);
    let smoothing = Smoothing { band, at: &at, sigma: &sigma, out: &out, context };
    (context.progress)(Stage::Law, 0, 1);
    let found = reduced.and_then(|mut reduced| Some((smoothing.fit(&mut reduced, &free)?, reduced)));
    (context.progress)(Stage::Law, 1, 1);
    let Some((fitted, reduced)) = found else {
        let lines = free.lines.iter().map(Line::unanswered).collect();
        return Ok(SmoothOutcome {
            band: BandOutcome { lines, fit: None, ..free.clone() },
            free,
            curve: None,
        });
    };
    let noise = smoothing.noise(&free.noise, fitted.smoothed.level);
    let split = free.errors_in_bars().and_then(Estimated::split);
    let judged: Vec<Judged> = map(context.for_each, at.len(), |i| {
        smoothing.judged(&fitted, &noise, &reduced, i, (&free, split.as_ref()))
    });
    let explained = || judged.iter().enumerate().filter(|(i, _)| fitted.observations[*i].weight > 0.0);
    let chi_squared = explained().map(|(_, judged)| judged.chi_squared).sum();
    let freedom = explained().map(|(_, judged)| judged.freedom).sum::<f64>().round() as usize;
    let fit = judge(chi_squared, freedom, &noise, band.noise);
    let lines: Vec<Line> = judged.into_iter().map(|judged| judged.line).collect();
    let sensor = |(m, own): (usize, &SensorFit)| SensorFit {
        misfit: sensor_misfit(&lines, band.measured, &assumed, m, noise.level),
        ..*own
    };
    let sensors = free.sensors.iter().enumerate().map(sensor).collect();
    let mut work = free.work;
    work += reduced.work().since(fitted.before);
    let subspace_size = Some(reduced.size());
    Neighbourhoods::hand_back(Some(reduced), trained);
    let smoothed = BandOutcome { lines, work, subspace_size, noise, fit, sensors, ..free.clone() };
    Ok(SmoothOutcome {
        free: free.judged_by_fit(),
        band: smoothed.judged_by_fit(),
        curve: Some(smoothing.curve(fitted)),
    })
}

/// What is to be explained, and with what.
struct Smoothing<'t, 'a> {
    band: &'t Band<'a>,
    at: &'t [ModelAt<'a>],
    /// Of real and imaginary part each.
    sigma: &'t [Vec<f64>],
    /// Sensors that are left out.
    out: &'t [usize],
    context: Context<'t>,
}

/// A curve that was found.
struct Fitted {
    observations: Vec<Observation>,
    evidence: Evidence,
    smoothed: Smoothed,
    converged: bool,
    outliers: usize,
    /// Work before.
    before: crate::response::Work,
}

/// What the sensors say about a curve: what each frequency observes of ln E, the residual that no modulus explains, and the whole misfit.
struct Linearised {
    observations: Vec<Observation>,
    evidence: Evidence,
    misfit: f64,
}

/// One frequency at the curve.
struct Judged {
    line: Line,
    chi_squared: f64,
    freedom: f64,
}

impl Smoothing<'_, '_> {
    fn numbers(&self) -> usize {
        if self.band.unknown.real { 1 } else { 2 }
    }

    fn log_omega(&self, i: usize) -> f64 {
        omega_rad_s(self.band.frequency_hz[i]).ln()
    }

    fn sensors(&self, i: usize) -> usize {
        self.sigma[i].iter().filter(|sigma| sigma.is_finite()).count()
    }

    fn fit(&self, reduced: &mut Neighbourhoods<'_, '_>, free: &BandOutcome) -> Option<Fitted> {
        let before = reduced.work();
        let all: Vec<usize> = (0..self.at.len()).collect();
        reduced.localise(&all, self.context.for_each);
        let mut states = self.start(reduced, free)?;
        let mut used: Vec<bool> = all.iter().map(|&i| self.log_omega(i).is_finite()).collect();
        let mut round = 0;
        loop {
            let (linear, smoothed, converged) = self.descend(reduced, &used, states)?;
            states = smoothed.curve.states.clone();
            let correction = |i: usize| Some(modulus(&states[i]) - self.at[i].parameters[0].nominal);
            let lacking = reduced.lacking(correction, self.context.for_each);
            if round < MAX_TRAINING_ROUNDS
                && !lacking.is_empty()
                && reduced.refine(&lacking, self.context).unwrap_or(false)
            {
                reduced.localise(&all, self.context.for_each);
                round += 1;
                continue;
            }
            let odd: Vec<usize> = all
                .iter()
                .copied()
                .filter(|&i| used[i] && self.is_outlier(reduced, &states, smoothed.level, i))
                .collect();
            let outliers = all.iter().filter(|&&i| !used[i] && self.log_omega(i).is_finite()).count();
            let few = ((outliers + odd.len()) as f64) < MAX_OUTLIER_SHARE * all.len() as f64;
            if odd.is_empty() || !few {
                let Linearised { observations, evidence, .. } = linear;
                return Some(Fitted { observations, evidence, smoothed, converged, outliers, before });
            }
            odd.into_iter().for_each(|i| used[i] = false);
        }
    }

    /// The curve through the values of each frequency alone, moved to where it fits the sensors best.
    fn start(&self, reduced: &Neighbourhoods<'_, '_>, free: &BandOutcome) -> Option<Vec<State>> {
        let own = |i: usize| {
            let none = Observation { x: self.log_omega(i), value: [0.0; 2], weight: 0.0 };
            let line = &free.lines[i];
            let estimate = line
                .factor()
                .filter(|factor| factor.re > 0.0 && line.on_path && line.status != Status::Unexplained);
            let observed = estimate.and_then(|factor| {
                let (_, slope) =
                    reduced.model(i).respond_with_slope(&self.at[i], factor - line.nominal()).ok()?;
                let weight =
                    slope.iter().zip(&self.sigma[i]).map(|(s, sigma)| (factor * s / *sigma).norm_sqr()).sum();
                let log = factor.ln();
                Some(Observation { value: [log.re, log.im], weight, ..none })
            });
            observed.filter(|o| o.weight.is_finite() && o.x.is_finite()).unwrap_or(none)
        };
        let observations = self.placed((0..self.at.len()).map(own).collect());
        // Among them are wrong ones, so that their scatter does not follow from the noise.
        let evidence = Evidence { numbers: self.numbers(), known: false, beside: (0.0, 0) };
        let states = smooth(&observations, evidence)?.curve.states;
        let tried = std::iter::once(0.0).chain(START_SHIFTS).filter_map(|by: f64| {
            let moved: Vec<State> =
                states.iter().map(|[value, slope]| [[value[0] + by.ln_1p(), value[1]], *slope]).collect();
            let used = vec![true; moved.len()];
            let misfit = self.linearised(reduced, &used, &moved).misfit;
            misfit.is_finite().then_some((misfit, moved))
        });
        tried.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, moved)| moved)
    }

    /// At 0 Hz there is no ln ω: it stands beside its neighbour, with nothing to say.
    fn placed(&self, mut observations: Vec<Observation>) -> Vec<Observation> {
        for k in (0..observations.len().saturating_sub(1)).rev() {
            if !observations[k].x.is_finite() {
                observations[k].x = observations[k + 1].x;
            }
        }
        observations
    }

    /// What the sensors say in linear terms about a curve.
    fn linearised(&self, reduced: &Neighbourhoods<'_, '_>, used: &[bool], states: &[State]) -> Linearised {
        let one = |i: usize| -> (Observation, f64) {
            let log = c64::new(states[i][0][0], states[i][0][1]);
            let none = Observation { x: self.log_omega(i), value: states[i][0], weight: 0.0 };
            let modulus = log.exp();
            let correction = modulus - self.at[i].parameters[0].nominal;
            let Some((x, slope)) = Some(used[i])
                .filter(|used| *used)
                .and_then(|_| reduced.model(i).respond_with_slope(&self.at[i], correction).ok())
            else {
                return (none, 0.0);
            };
            let (mut weight, mut along, mut misfit) = (0.0, c64::default(), 0.0);
            for ((x, slope), (u, sigma)) in
                x.iter().zip(&slope).zip(self.band.measured[i].iter().zip(&self.sigma[i]))
            {
                let (a, rest) = (modulus * slope / *sigma, (u - x) / *sigma);
                weight += a.norm_sqr();
                along += a.conj() * rest;
                misfit += rest.norm_sqr();
            }
            if !(weight.is_finite() && weight > 0.0 && misfit.is_finite()) {
                return (none, 0.0);
            }
            let step = along / weight;
            let value = match self.band.unknown.real {
                true => [log.re + step.re, 0.0],
                false => [log.re + step.re, log.im + step.im],
            };
            (Observation { value, weight, ..none }, misfit)
        };
        let each = map(self.context.for_each, states.len(), one);
        let mut beside = (0.0, 0);
        let mut total = 0.0;
        for (i, (o, misfit)) in each.iter().enumerate().filter(|(_, (o, _))| o.weight > 0.0) {
            let step: f64 = (0..self.numbers()).map(|c| (o.value[c] - states[i][0][c]).powi(2)).sum();
            beside.0 += (misfit - o.weight * step).max(0.0);
            beside.1 += 2 * self.sensors(i) - self.numbers();
            total += misfit;
        }
        let observations = self.placed(each.into_iter().map(|(o, _)| o).collect());
        let known = self.band.noise.is_known();
        Linearised {
            observations,
            evidence: Evidence { numbers: self.numbers(), known, beside },
            misfit: total,
        }
    }

    /// Gauss and Newton's steps to the smooth curve.
    fn descend(
        &self,
        reduced: &Neighbourhoods<'_, '_>,
        used: &[bool],
        mut states: Vec<State>,
    ) -> Option<(Linearised, Smoothed, bool)> {
        let mut linear = self.linearised(reduced, used, &states);
        let x: Vec<f64> = linear.observations.iter().map(|o| o.x).collect();
        for step in 0.. {
            let smoothed = smooth(&linear.observations, linear.evidence)?;
            let largest = (0..states.len())
                .map(|i| {
                    let by = |c: usize| smoothed.curve.states[i][0][c] - states[i][0][c];
                    let size = by(0).hypot(by(1));
                    let bar = smoothed.level * smoothed.curve.variance[i].sqrt();
                    (size / bar).min(size / CURVE_ROUNDOFF * CURVE_STEP_TOL)
                })
                .fold(0.0, f64::max);
            if largest <= CURVE_STEP_TOL || step == MAX_CURVE_STEPS {
                return Some((linear, smoothed, largest <= CURVE_STEP_TOL));
            }
            let cost = |linear: &Linearised, states: &[State]| {
                linear.misfit + roughness(&x, states, smoothed.curvature)
            };
            let before = cost(&linear, &states);
            let mut part = 1.0;
            for halving in 0..=MAX_HALVINGS {
                let moved = between(&states, &smoothed.curve.states, part);
                let there = self.linearised(reduced, used, &moved);
                // A step within the error bars is where everything is linear.
                let good = largest * part < 1.0 || cost(&there, &moved) <= before;
                if (good && there.misfit.is_finite()) || halving == MAX_HALVINGS {
                    (states, linear) = (moved, there);
                    break;
                }
                part *= 0.5;
            }
        }
        None
    }

    /// Whether a frequency leaves more than noise at the curve.
    fn is_outlier(&self, reduced: &Neighbourhoods<'_, '_>, states: &[State], level: f64, i: usize) -> bool {
        let correction = modulus(&states[i]) - self.at[i].parameters[0].nominal;
        let Ok((x, _)) = reduced.model(i).respond_with_slope(&self.at[i], correction) else { return false };
        self.is_beyond_noise(i, &x, level.max(MIN_NOISE_LEVEL))
    }

    fn is_beyond_noise(&self, i: usize, x: &[c64], level: f64) -> bool {
        let rms = (self.misfit(i, x) / (2 * self.sensors(i)).max(1) as f64).sqrt();
        relative_error_without(self.out, &self.band.measured[i], x) > MAX_ERROR
            && rms > MAX_RMS_MISFIT * level
    }

    fn misfit(&self, i: usize, x: &[c64]) -> f64 {
        misfit(&self.band.measured[i], x, &self.sigma[i])
    }

    fn noise(&self, free: &NoiseLevel, level: f64) -> NoiseLevel {
        match self.band.noise {
            Noise::Known(_) | Noise::Common(_) => *free,
            _ => {
                let level = level.max(free.common.unwrap_or(0.0)).max(MIN_NOISE_LEVEL);
                NoiseLevel { level: Some(level), source: NoiseSource::Curve, ..*free }
            }
        }
    }

    fn judged(
        &self,
        fitted: &Fitted,
        noise: &NoiseLevel,
        reduced: &Neighbourhoods<'_, '_>,
        i: usize,
        (per_frequency, split): (&BandOutcome, Option<&Split>),
    ) -> Judged {
        let free = &per_frequency.lines;
        let (measured, own) = (&self.band.measured[i], &free[i]);
        let mut line = own.unanswered();
        let factor = modulus(&fitted.smoothed.curve.states[i]);
        let correction = factor - own.nominal();
        let Some(assessed) = reduced.assess(i, correction).filter(|_| self.log_omega(i).is_finite()) else {
            return Judged { line, chi_squared: 0.0, freedom: 0.0 };
        };
        let level = noise.level.unwrap_or(1.0);
        let certified = reduction_error(&assessed, factor, measured);
        let variance = fitted.smoothed.curve.variance[i];
        let second = reduced.second_derivative(i, correction);
        let second = second.map_or(f64::INFINITY, |second| weighed(&second, &self.sigma[i]));
        let part_std = factor.norm() * variance.sqrt();
        let mut bars = Uncertainty::new(factor, self.band.unknown.real, part_std, second, level);
        let frequency_hz = self.band.frequency_hz[i];
        // What the errors of the model add to the noise that is in the bars already.
        let noise = bars.storage_std.powi(2);
        let errors = per_frequency.model_errors.as_ref();
        let of_errors = errors.and_then(|errors| errors.covariance_at(0, i, frequency_hz));
        let of_errors = of_errors.map(|[re, im, both]| [(re - noise).max(0.0), (im - noise).max(0.0), both]);
        let small = per_frequency.small_errors.as_ref();
        let of_small = small.and_then(|small| small.beside_noise_at(0, i, frequency_hz));
        of_errors.or(of_small).into_iter().for_each(|added| bars.widen(factor, added));
        if let Some((errors, split)) = per_frequency.errors_in_bars().zip(split)
            && let Some(slopes) = errors.real_slopes(0, i, frequency_hz)
        {
            bars.divide(split.of(&slopes));
        }
        let error = relative_error_without(self.out, measured, &assessed.response);
        // Of 2M numbers, what the curve took from this frequency.
        let taken = (fitted.observations[i].weight * variance).min(1.0);
        let freedom = (2 * self.sensors(i)) as f64 - self.numbers() as f64 * taken;
        let chi_squared = self.misfit(i, &assessed.response) / (level * level);
        line.set_correction(correction);
        line.error = Some(error).filter(|error| error.is_finite());
        line.values[0].uncertainty = Some(bars).filter(|bars| bars.correction_std.is_finite());
        line.chi_squared = Some(chi_squared / freedom).filter(|chi_squared| chi_squared.is_finite());
        line.spectral_radius = line.radius.map(|radius| radius.at(correction));
        line.reduction_error = Some(certified.response).filter(|c| c.is_finite());
        let ambiguous = is_ambiguous(free, i);
        if ambiguous {
            let apart =
                |other: &&Vec<c64>| (other[0] - factor).norm() > RIVAL_DISTANCE_STD * bars.correction_std;
            line.rivals = own.rivals.iter().filter(apart).cloned().collect();
        }
        line.on_path = true;
        line.status = Status::of([
            (self.is_beyond_noise(i, &assessed.response, level), Status::Unexplained),
            (ambiguous, Status::Ambiguous),
            (!fitted.converged, Status::Failed),
            (!bars.is_known(factor) || !bars.is_linear(), Status::NotIdentifiable),
            (certified.factor > MAX_REDUCTION_ERROR, Status::Failed),
        ]);
        line.updated_response = assessed.response;
        if self.band.unknown.bounds.broken_by(factor).is_some() {
            line.forget_value(Status::NoRoot);
        }
        Judged { line, chi_squared, freedom }
    }

    fn curve(&self, fitted: Fitted) -> SmoothCurve {
        let Fitted { observations, evidence, smoothed, converged, outliers, .. } = fitted;
        let taken =
            observations.iter().zip(&smoothed.curve.variance).map(|(o, variance)| o.weight * variance);
        let parameters: f64 = taken.sum();
        let range = observations[observations.len() - 1].x - observations[0].x;
        let width_octaves = range / parameters / std::f64::consts::LN_2;
        let (level, real) = (smoothed.level, self.band.unknown.real);
        let decay_per_s = self.band.model.decay_per_s();
        SmoothCurve {
            parameters,
            width_octaves,
            converged,
            outliers,
            observations,
            evidence,
            level,
            real,
            decay_per_s,
        }
    }
}

impl SmoothCurve {
    /// The modulus with its error bars at other frequencies (ascending, above 0 Hz), as those between lines that were left out: the curve bridges them, and the bars are
    /// as wide as it may go astray there.
    pub fn bridged(&self, frequency_hz: &[f64]) -> Vec<(c64, Uncertainty)> {
        let mut all = self.observations.clone();
        all.extend(frequency_hz.iter().map(|&f| Observation {
            x: omega_rad_s(f).ln(),
            value: [0.0; 2],
            weight: 0.0,
        }));
        all.sort_by(|a, b| a.x.total_cmp(&b.x));
        let Some(smoothed) = smooth(&all, self.evidence) else { return Vec::new() };
        let at = |f: &f64| {
            let x = omega_rad_s(*f).ln();
            let k = all.partition_point(|o| o.x < x).min(all.len() - 1);
            let factor = at_real_frequency(modulus(&smoothed.curve.states[k]), *f, self.decay_per_s);
            let part_std = factor.norm() * smoothed.curve.variance[k].sqrt();
            // Nothing was measured there that could be far from linear.
            (
                factor,
                Uncertainty::new(
                    factor,
                    self.real,
                    part_std,
                    0.0,
                    self.level.max(if self.evidence.known { 0.0 } else { MIN_NOISE_LEVEL }),
                ),
            )
        };
        frequency_hz.iter().map(at).collect()
    }
}

fn modulus(state: &State) -> c64 {
    c64::new(state[0][0], state[0][1]).exp()
}

fn between(from: &[State], to: &[State], part: f64) -> Vec<State> {
    let mix = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|c| a[c] + part * (b[c] - a[c]));
    from.iter().zip(to).map(|(a, b)| [mix(a[0], b[0]), mix(a[1], b[1])]).collect()
}

/// Whether the path is ambiguous at a frequency; one that has no answer of its own is if the nearest that have one on either side are.
fn is_ambiguous(free: &[Line], i: usize) -> bool {
    let answered = |o: &&Line| o.on_path;
    let ambiguous = |o: &Line| o.status == Status::Ambiguous;
    if free[i].on_path {
        return ambiguous(&free[i]);
    }
    let before = free[..i].iter().rev().find(answered);
    let after = free[i + 1..].iter().find(answered);
    before.or(after).is_some() && before.is_none_or(ambiguous) && after.is_none_or(ambiguous)
}
