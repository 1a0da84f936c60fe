//! Errors of the model, estimated with the factor (B-11).
//!
//! A model's natural frequencies are some tenths of a per cent off, its mode shapes and the factors of its known parts some per cent. A factor that is
//! fitted to each frequency by itself swallows all of that. Over a band the two are told apart: each mode has one real error over its whole resonance,
//! a material has one smooth complex modulus. With a smooth ln E(ω; θ) (a law, or a spline), relative errors δ_i = e + d_i of natural frequencies, a_mi of mode shapes at
//! the sensors and ν_t of known factors,
//! $$ \sum_{k,m} \frac{|u_m - x_m(\omega_k; \theta, \delta, a, \nu)|^2}{\sigma_m^2} + \frac{e^2 + \sum_i d_i^2}{s^2} + \frac{\sum a_{mi}^2}{s_a^2} + \frac{\sum \nu_t^2}{s_\nu^2} $$
//! is made least on the reduced model, with the noise approached from above; s and s_a are those of largest evidence. Whether there are errors at all is decided by
//! the evidence of three explanations: a smooth modulus and a right model, a modulus that scatters from line to line and a right model, a smooth modulus and errors.
//!
//! # Source
//! M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63 (2001) 425–464 (errors of a model beside its parameters); D. J. C. MacKay, Neural Comput. 4 (1992) 415–447
//! (evidence, and the number of well-determined parameters).

mod curve;
mod found;
mod search;

use super::Line;
use crate::c64;
use crate::for_each::ForEach;
use crate::frequency::omega_rad_s;
use crate::laws::Parametrization;
use crate::median::median;
use crate::model::ModelAt;
use crate::subspace::{ModalErrors, Modes, Point, Projection};
pub use found::{FactorError, ModeError, ModelErrorsFound};

use curve::{Curve, Spline};
use frfit_linalg::dense::Cholesky;
use search::{COMMON, Fitting, Found, Place, Sizes};

/// What is known of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Deviations {
    /// σ is that of the noise.
    Known,
    /// σ is what the noise is in proportion to.
    Relative,
}

/// What was measured, and where to begin.
pub(super) struct Measured<'t, 'a> {
    pub(super) at: &'t [ModelAt<'a>],
    pub(super) measured: &'t [Vec<c64>],
    /// Of real and imaginary part each, `[frequency][sensor]`; infinite of a sensor that is left out.
    pub(super) sigma: &'t [Vec<f64>],
    /// The responses themselves, as deviations.
    pub(super) size: &'t [Vec<f64>],
    pub(super) deviations: Deviations,
    /// What each frequency says by itself, and noise over σ by that.
    pub(super) free: &'t [Line],
    pub(super) alone: Option<f64>,
    pub(super) real: bool,
}

/// The errors of a model, and how well they are known.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Estimated {
    pub(super) modes: Modes,
    pub(super) errors: ModalErrors,
    /// Of δ (own and common together), ν, then a of each sensor: n × n.
    pub(super) covariance: Vec<f64>,
    pub(super) sizes: [f64; 2],
    /// χ² at σ times `level`, and how many numbers it has.
    pub(super) chi_squared: f64,
    pub(super) numbers: usize,
    pub(super) level: f64,
    /// By how many nats errors of the model explain the band better than a right model does.
    pub(super) evidence: f64,
    highest_rad_s: f64,
    curve: Curve,
    /// θ and its covariance, n × n.
    theta: Vec<f64>,
    theta_covariance: Vec<f64>,
    /// The errors as the search has them.
    place: Place,
}

impl Estimated {
    /// Variances of the real and the imaginary part of the smooth modulus at a line, and their covariance.
    pub(super) fn modulus_covariance(&self, line: usize, frequency_hz: f64) -> Option<[f64; 3]> {
        let (_, slopes) = self.curve.modulus(&self.theta, line, omega_rad_s(frequency_hz))?;
        Some(covariance(&self.theta_covariance, &slopes))
    }

    /// The covariance of the coordinates of the curve, row after row.
    pub(super) fn coordinates(&self) -> Vec<Vec<f64>> {
        self.theta_covariance.chunks_exact(self.theta.len().max(1)).map(<[f64]>::to_vec).collect()
    }
}

/// Variances of the real and the imaginary part of Σ g_n ξ_n, and their covariance.
pub(super) fn covariance(covariance: &[f64], g: &[c64]) -> [f64; 3] {
    let n = g.len();
    let mut sum = [0.0; 3];
    for (column, g_column) in covariance.chunks_exact(n.max(1)).zip(g) {
        let times: c64 = column.iter().zip(g).map(|(c, g)| *c * g).sum();
        sum[0] += times.re * g_column.re;
        sum[1] += times.im * g_column.im;
        sum[2] += times.re * g_column.im;
    }
    sum
}

/// Modes up to this many times the highest frequency, and so many at most.
const ABOVE: f64 = 4.0;
const MOST_MODES: usize = 30;

/// Noise that is added to begin with, relative to the response.
const FROM_ABOVE: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.01, 0.003];

/// Steps at each level of the noise, and at the last.
const STEPS: usize = 5;
const LAST_STEPS: usize = 5;

/// Rounds in which sizes and errors are found in turn.
const ROUNDS: usize = 8;

/// Before the data: natural frequencies are good to a half per cent, shapes and known factors to two.
const FREQUENCY: f64 = 0.005;
const SHAPE: f64 = 0.02;
const FACTOR: f64 = 0.02;

/// What all modes have in common is larger than their scatter: a mesh errs in one sense.
const COMMON_RATIO: f64 = 2.0;

/// What the data have to tell of a size counts from this many modes on.
const PRIOR_MODES: f64 = 0.05;

/// No measured response is better than this part of itself: what is smaller is no reason to doubt a model.
const LEAST_LEVEL: f64 = 5e-4;

/// The same of a single sensor, whose noise nobody told: it cannot contradict itself.
const OF_ONE_SENSOR: f64 = 5e-3;

impl Sizes {
    /// Before the data.
    fn prior() -> Self {
        Self { frequency: FREQUENCY, common: COMMON_RATIO * FREQUENCY, shape: SHAPE, factor: FACTOR }
    }
}

/// A fit at a level of the noise.
struct Explained {
    found: Found,
    sizes: Sizes,
    level: f64,
    /// −2 ln of the evidence, up to what all explanations share.
    evidence: f64,
}

/// The errors of a model by the data of a band; `None` where a right model explains them as well, or no small errors do.
pub(super) fn estimate(
    model: &Projection,
    data: &Measured<'_, '_>,
    for_each: ForEach<'_>,
) -> Option<Estimated> {
    let omegas = data.omegas();
    let curve = Curve::Spline(Spline::new(&omegas, data.real));
    let starts = data.starts(&curve);
    let search = Search::new(model, data, &curve, starts.first()?, for_each)?;

    // Far from the answer a rough model is as good.
    let points: Vec<Point<'_>> = starts.iter().flat_map(|start| search.points(start)).collect();
    let rough = search.smaller(&points, ROUGH);
    let none = Modes::none(&rough.0);
    let right_model = Fitting { terms: &[], ..search.fitting(&rough.0, &none, &search.lines) };
    let right = data.explain(&right_model, right_model.start(&starts[0]), &starts[0], &FROM_ABOVE[2..])?;
    if data.is_noise(&right, data.numbers(&search.lines)) {
        return None;
    }
    let coarse = search.fitting(&rough.0, &rough.1, &search.some);
    let ends = starts.iter().filter_map(|start| data.approach(&coarse, start));
    let (_, place) = ends.min_by(|a, b| a.0.total_cmp(&b.0))?;

    let near = search.smaller(&search.points(&place), NEIGHBOURHOOD);
    let fine = search.fitting(&near.0, &near.1, &search.lines);
    let centre = place[..curve.count()].to_vec();
    let wrong = data.explain(&fine, place, &centre, &FROM_ABOVE[NEAR..])?;
    let scattered = data.scattered(&search.lines, &curve, &starts[0], wrong.level);
    let least = scattered.map_or(right.evidence, |scattered| scattered.min(right.evidence));
    let evidence = 0.5 * (least - wrong.evidence);
    let small = wrong.sizes.frequency <= LARGEST_FREQUENCY && wrong.sizes.shape <= LARGEST_SHAPE;
    let estimated = (evidence > NATS && small).then(|| data.posterior(&fine, wrong, evidence)).flatten()?;
    Some(Estimated { modes: search.modes, ..estimated })
}

/// The errors of a model once more, with a law in place of a smooth modulus: it says more of what they are.
pub(super) fn estimate_with_law(
    model: &Projection,
    data: &Measured<'_, '_>,
    before: &Estimated,
    (law, theta): (&Parametrization, &[f64]),
    for_each: ForEach<'_>,
) -> Option<Estimated> {
    let curve = Curve::Law(*law);
    let search =
        Search { modes: before.modes.in_larger(model), ..Search::new(model, data, &curve, theta, for_each)? };
    let near = search.smaller(&search.points(theta), NEIGHBOURHOOD);
    let fitting = search.fitting(&near.0, &near.1, &search.lines);
    let place: Place = theta.iter().chain(&before.place[before.theta.len()..]).copied().collect();
    let found = data.explain(&fitting, place, theta, &FROM_ABOVE[NEAR..])?;
    let estimated = data.posterior(&fitting, found, before.evidence)?;
    Some(Estimated { modes: search.modes, ..estimated })
}

/// What all fits of a band have in common.
struct Search<'t, 'a> {
    model: &'t Projection,
    data: &'t Measured<'t, 'a>,
    curve: &'t Curve,
    for_each: ForEach<'t>,
    omegas: Vec<f64>,
    /// Lines that are used, some of them, and those about which a smaller model is made.
    lines: Vec<usize>,
    some: Vec<usize>,
    about: Vec<usize>,
    /// Of the whole reduced model.
    modes: Modes,
    /// Known terms whose factor may be in error.
    known: Vec<usize>,
}

impl<'t, 'a> Search<'t, 'a> {
    /// With the modes that the model has at a curve in the middle of the band.
    fn new(
        model: &'t Projection,
        data: &'t Measured<'t, 'a>,
        curve: &'t Curve,
        theta: &[f64],
        for_each: ForEach<'t>,
    ) -> Option<Self> {
        let all: Vec<usize> = (0..data.at.len()).filter(|&i| data.at[i].frequency_hz > 0.0).collect();
        let of = |most: usize| -> Vec<usize> { super::band::thinned(&all, most).copied().collect() };
        let (lines, omegas) = (of(LINES), data.omegas());
        let middle = lines[lines.len() / 2];
        let at = &data.at[middle];
        let (modulus, _) = curve.modulus(theta, middle, omegas[middle])?;
        let highest = ABOVE * omegas.last()?;
        let modes = model.modes(at, modulus - at.parameters[0].nominal, highest, MOST_MODES).ok()?;
        let (some, about, known) = (of(FEW_LINES), of(POINTS), data.known_terms());
        Some(Self { model, data, curve, for_each, omegas, lines, some, about, modes, known })
    }

    /// Points along a curve.
    fn points(&self, theta: &[f64]) -> Vec<Point<'a>> {
        let point = |&i: &usize| {
            let at = self.data.at[i].clone();
            let (modulus, _) = self.curve.modulus(theta, i, self.omegas[i])?;
            Some(Point { correction: modulus - at.parameters[0].nominal, at })
        };
        self.about.iter().filter_map(point).collect()
    }

    /// A smaller model of the modes and of what is near some points, with its modes; the same where it would be no smaller.
    fn smaller(&self, points: &[Point<'_>], tolerance: f64) -> (Projection, Modes) {
        let smaller = self.model.about_modes(&self.modes, points, tolerance);
        smaller.unwrap_or_else(|| (self.model.clone(), self.modes.clone()))
    }

    fn fitting<'f>(&'f self, model: &'f Projection, modes: &'f Modes, lines: &'f [usize]) -> Fitting<'f, 'a> {
        Fitting {
            model,
            modes,
            at: self.data.at,
            measured: self.data.measured,
            lines,
            curve: self.curve,
            highest_rad_s: self.omegas[self.omegas.len() - 1],
            terms: &self.known,
            for_each: self.for_each,
        }
    }
}

/// Lines on which the search begins, and at most.
const FEW_LINES: usize = 60;
const LINES: usize = 240;

/// Levels of added noise until all lines are used.
const NEAR: usize = 4;

/// Points of the band at which a model of the neighbourhood is made good, and to which error.
const POINTS: usize = 24;
const NEIGHBOURHOOD: f64 = 1e-6;
const ROUGH: f64 = 1e-4;

/// What is left is noise up to so many standard deviations of χ².
const CHANCE: f64 = 3.0;

/// By how much a modulus may scatter from line to line.
const SCATTER: [f64; 7] = [1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3];

/// Errors larger than these are no small errors of this model: it is another one.
const LARGEST_FREQUENCY: f64 = 0.03;
const LARGEST_SHAPE: f64 = 0.3;

/// Nats by which errors of the model have to explain a band better: sizes were fitted too.
const NATS: f64 = 6.0;

impl Measured<'_, '_> {
    /// Known terms whose factor may be in error.
    fn known_terms(&self) -> Vec<usize> {
        let at = &self.at[0];
        let unknown = |term: usize| at.parameters.iter().any(|one| one.enters(term));
        (0..at.model.terms().len()).filter(|&term| !unknown(term)).collect()
    }

    /// Real numbers that were measured.
    fn numbers(&self, lines: &[usize]) -> usize {
        2 * lines.iter().flat_map(|&i| &self.sigma[i]).filter(|sigma| sigma.is_finite()).count()
    }

    /// θ to begin with: through what each frequency says by itself, and the nominal.
    fn starts(&self, curve: &Curve) -> Vec<Vec<f64>> {
        let nominal = |i: usize| self.at[i].parameters[0].nominal;
        let answered = |(i, line): (usize, &Line)| {
            let factor = line.factor().filter(|factor| line.on_path && factor.re > 0.0)?;
            let std = line.values[0].uncertainty.map_or(1.0, |bars| bars.correction_std / factor.norm());
            Some((i, factor, 1.0 / (std * std + 1e-4)))
        };
        let free: Vec<(usize, c64, f64)> = self.free.iter().enumerate().filter_map(answered).collect();
        let given = (0..self.at.len()).filter(|&i| nominal(i).re > 0.0).map(|i| (i, nominal(i), 1e4));
        let mut starts = Vec::new();
        if free.len() > 2 {
            starts.extend(curve.through(&free));
            // Where modes are narrow most lines are right and some are far off.
            let middle =
                |part: &dyn Fn(c64) -> f64| median(free.iter().map(|one| part(one.1.ln())).collect());
            if let (Some(size), Some(phase)) = (middle(&|log| log.re), middle(&|log| log.im)) {
                let usual = c64::new(size, phase).exp();
                starts.extend(curve.through(&free.iter().map(|one| (one.0, usual, 1e4)).collect::<Vec<_>>()));
            }
        }
        starts.extend(curve.through(&given.collect::<Vec<_>>()));
        starts
    }

    /// σ of the noise at a level, with some part of the response added.
    fn sigma_at(&self, lines: &[usize], level: f64, added: f64) -> Vec<Vec<f64>> {
        let one = |&i: &usize| {
            let each = self.sigma[i].iter().zip(&self.size[i]);
            each.map(|(sigma, size)| (level * sigma).hypot(added.max(LEAST_LEVEL) * size)).collect()
        };
        lines.iter().map(one).collect()
    }

    fn omegas(&self) -> Vec<f64> {
        self.at.iter().map(|at| omega_rad_s(at.frequency_hz)).collect()
    }

    /// From a start to where all lines are used: the cost and the place.
    fn approach(&self, coarse: &Fitting<'_, '_>, start: &[f64]) -> Option<(f64, Place)> {
        let precision = coarse.precision(&Sizes::prior());
        let own = if self.known() { 1.0 } else { 0.0 };
        let mut end = (f64::INFINITY, coarse.start(start));
        for added in &FROM_ABOVE[..NEAR] {
            let sigma = self.sigma_at(coarse.lines, own, *added);
            let found = coarse.descend(end.1, &sigma, &precision, start, STEPS)?;
            end = (found.normal.chi_squared + found.prior, found.place);
        }
        Some(end)
    }

    fn known(&self) -> bool {
        self.deviations == Deviations::Known
    }

    /// Whether noise is all that a smooth modulus leaves.
    fn is_noise(&self, right: &Explained, numbers: usize) -> bool {
        let n = numbers as f64;
        match self.known() {
            true => right.found.normal.chi_squared <= n + CHANCE * (2.0 * n).sqrt(),
            false => {
                let sensors = self.sigma[0].iter().filter(|sigma| sigma.is_finite()).count();
                let least = if sensors > 1 { LEAST_LEVEL } else { OF_ONE_SENSOR };
                let usual = self.alone.map_or(0.0, |alone| alone * (1.0 + CHANCE / n.sqrt()));
                right.level <= least.max(usual)
            }
        }
    }

    /// The least squares with the noise approached from above, and the sizes of largest evidence; the prior of θ is about `centre`.
    fn explain(
        &self,
        fitting: &Fitting<'_, '_>,
        mut place: Place,
        centre: &[f64],
        from_above: &[f64],
    ) -> Option<Explained> {
        let mean = centre;
        let known = self.known();
        let mut sizes = Sizes::prior();
        let numbers = self.numbers(fitting.lines) as f64;
        let mut level = 1.0;
        for &added in from_above {
            let sigma = self.sigma_at(fitting.lines, if known { 1.0 } else { 0.0 }, added);
            let found = fitting.descend(place, &sigma, &fitting.precision(&sizes), mean, STEPS)?;
            place = found.place;
            if !known {
                level = added;
                // The noise itself is larger than what would come next.
                if found.normal.chi_squared > numbers {
                    break;
                }
            }
        }
        let mut last = None;
        for _ in 0..ROUNDS {
            let sigma = self.sigma_at(fitting.lines, level, 0.0);
            let precision = fitting.precision(&sizes);
            let found = fitting.descend(place, &sigma, &precision, mean, LAST_STEPS)?;
            place = found.place.clone();
            let n = fitting.count();
            let whole: Vec<f64> =
                found.normal.information.iter().zip(&precision).map(|(a, b)| a + b).collect();
            let factor = Cholesky::new(n, &whole).ok()?;
            let inverse = factor.inverse();
            let variance = |i: usize| inverse[i * n + i];
            let logs: f64 = sigma.iter().flatten().filter(|s| s.is_finite()).map(|s| 4.0 * s.ln()).sum();
            let of_prior = Cholesky::new(n, &precision).ok()?.log_determinant();
            let evidence =
                logs + found.normal.chi_squared + found.prior + factor.log_determinant() - of_prior;
            let told: f64 =
                (0..n).map(|i| 1.0 - precision[i * n + i] * variance(i)).map(|t| t.clamp(0.0, 1.0)).sum();
            let chi_squared = found.normal.chi_squared;
            let before = (level, sizes);
            last = Some(Explained { found, sizes, level, evidence });
            if !known {
                level = (level * (chi_squared / (numbers - told).max(1.0)).sqrt()).max(LEAST_LEVEL);
            }
            if !fitting.shapes().is_empty() {
                let fresh = |range: std::ops::Range<usize>, size: f64, prior: f64| {
                    let squares: f64 = range.clone().map(|i| (place[i] / fitting.growth(i)).powi(2)).sum();
                    let share = |i: usize| variance(i) / (size * fitting.growth(i)).powi(2);
                    let told: f64 = range.map(|i| (1.0 - share(i)).clamp(0.0, 1.0)).sum();
                    ((squares + PRIOR_MODES * prior * prior) / (told + PRIOR_MODES)).sqrt()
                };
                sizes.frequency =
                    fresh(fitting.first_own()..fitting.first_factor(), sizes.frequency, FREQUENCY);
                sizes.common = COMMON_RATIO * sizes.frequency;
                sizes.shape = fresh(fitting.shapes(), sizes.shape, SHAPE);
            }
            let settled = |a: f64, b: f64| (a / b - 1.0).abs() < 0.03;
            if settled(level, before.0)
                && settled(sizes.frequency, before.1.frequency)
                && settled(sizes.shape, before.1.shape)
            {
                break;
            }
        }
        last
    }

    /// −2 ln of the evidence of a modulus that scatters about a smooth one from line to line, by what each frequency says; `None` where most say
    /// nothing. `level` is that of the noise where one sensor cannot show it.
    fn scattered(&self, lines: &[usize], curve: &Curve, theta: &[f64], level: f64) -> Option<f64> {
        struct Told {
            misfit: f64,
            /// Relative, at the noise of the lines by themselves.
            std: f64,
            off: f64,
        }
        let told = |&i: &usize| {
            let line = &self.free[i];
            let factor = line.factor().filter(|factor| line.on_path && factor.re > 0.0)?;
            let (smooth, _) = curve.modulus(theta, i, omega_rad_s(line.frequency_hz))?;
            let sigma = match self.known() {
                true => self.sigma_at(&[i], 1.0, 0.0).concat(),
                false => self.sigma[i].clone(),
            };
            let each = line.updated_response.iter().zip(&self.measured[i]).zip(&sigma);
            Some(Told {
                misfit: each.map(|((x, u), sigma)| (u - x).norm_sqr() / (sigma * sigma)).sum(),
                std: line.values[0].uncertainty?.storage_std / factor.norm(),
                off: (factor / smooth).ln().norm_sqr(),
            })
        };
        let told: Vec<Told> = lines.iter().filter_map(told).collect();
        if 2 * told.len() < lines.len() {
            return None;
        }
        // Lines that say nothing are as good as those that do.
        let share = lines.len() as f64 / told.len() as f64;
        let misfit = share * told.iter().map(|one| one.misfit).sum::<f64>();
        let free = self.numbers(lines) as f64 - 2.0 * lines.len() as f64;
        let own = match self.known() {
            true => 1.0,
            false if free > 0.0 => (misfit / free).sqrt().clamp(LEAST_LEVEL, level),
            false => level,
        };
        let std = |one: &Told| one.std * own / self.alone.unwrap_or(own);
        let sigma = self.sigma_at(lines, own, 0.0);
        let logs: f64 = sigma.iter().flatten().filter(|s| s.is_finite()).map(|s| 4.0 * s.ln()).sum();
        let of_scatter = |tau: f64| -> f64 {
            let one = |one: &Told| {
                let (noise, whole) = (std(one).powi(2), std(one).powi(2) + tau * tau);
                2.0 * (whole / noise).ln() + one.off / whole
            };
            share * told.iter().map(one).sum::<f64>()
        };
        let least = SCATTER.map(of_scatter).into_iter().fold(f64::INFINITY, f64::min);
        Some(logs + misfit / (own * own) + least)
    }

    fn posterior(&self, fitting: &Fitting<'_, '_>, wrong: Explained, evidence: f64) -> Option<Estimated> {
        let Explained { found, sizes, level, .. } = wrong;
        let n = fitting.count();
        let precision = fitting.precision(&sizes);
        let whole: Vec<f64> = found.normal.information.iter().zip(&precision).map(|(a, b)| a + b).collect();
        let inverse = Cholesky::new(n, &whole).ok()?.inverse();
        let errors = fitting.errors(&found.place);
        // δ_i = e + d_i.
        let first = fitting.first_own();
        let modes = errors.frequency.len();
        let kept = n - first;
        let common = first - COMMON;
        let of = |a: usize, b: usize| inverse[a * n + b];
        // What of each of the search's coordinates is in δ_i, ν_t, a_mi.
        let parts = |a: usize| -> Vec<(usize, f64)> {
            let own = std::iter::once((first + a, 1.0));
            let shared = (0..COMMON).filter(|_| a < modes).map(|p| (common + p, fitting.common(a)[p]));
            own.chain(shared).collect()
        };
        let parts: Vec<Vec<(usize, f64)>> = (0..kept).map(parts).collect();
        let entry = |a: usize, b: usize| {
            let row = |&(i, x): &(usize, f64)| parts[b].iter().map(|&(j, y)| x * y * of(i, j)).sum::<f64>();
            parts[a].iter().map(row).sum::<f64>()
        };
        let covariance = (0..kept * kept).map(|k| entry(k % kept, k / kept)).collect();
        Some(Estimated {
            modes: fitting.modes.clone(),
            errors,
            covariance,
            sizes: [sizes.frequency, sizes.shape],
            chi_squared: found.normal.chi_squared,
            numbers: self.numbers(fitting.lines),
            level,
            evidence,
            highest_rad_s: fitting.highest_rad_s,
            curve: fitting.curve.clone(),
            theta: found.place[..first - COMMON].to_vec(),
            theta_covariance: (0..common * common).map(|k| of(k % common, k / common)).collect(),
            place: found.place,
        })
    }
}
