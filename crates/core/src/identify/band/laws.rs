//! Laws fitted straight to the FRFs: all frequencies and all sensors in one least squares (B-7).
//!
//! Each frequency is first identified alone: this trains the subspace, and gives the start. Then Σ |u_m − x_m(E(ω; θ))|²/σ_m² over the band is made least in θ on the
//! models of the neighbourhoods, ∂x_m/∂θ = (∂x_m/∂c)(∂E/∂θ). The subspace is trained further where it is not good enough at the law that came out.

use super::candidates::misfit;
use super::channels::{Begin, Responded, at_scales};
use super::corrected::{Weights, correct, on_corrected, point};
use super::joint;
use super::law_fitting::Fitting;
use super::neighbourhoods::{MAX_REDUCTION_ERROR, Neighbourhoods, reduction_error};
use super::outcome::BandOutcome;
use super::scaled::Scaled;
use super::search_box::{near_or_far, on_subspace};
use crate::c64;
use crate::for_each::map;
use crate::frfs::standard_deviations;
use crate::identify::channel::{Calibrated, Calibration, Channel, ChannelUnknowns};
use crate::identify::channel_coordinates::ChannelCoordinates;
use crate::identify::context::{Context, Stage};
use crate::identify::form::Form;
use crate::identify::goodness_of_fit::{Explained, GoodnessOfFit, MAX_ERROR, MAX_RMS_MISFIT, judge};
use crate::identify::measured::Band;
use crate::identify::model_errors::{
    Curve, Curves, Estimated, Split, averaged_over_small_errors, estimate_beside_a_smooth_modulus,
    estimate_with_laws,
};
use crate::identify::noise::{NoiseLevel, NoiseSource, without};
use crate::identify::options::Options;
use crate::identify::outcome::{Line, Status};
use crate::identify::uncertainty::{Contributions, Uncertainty};
use crate::laws::{Datum, Evidence, LawFit, LawKind, LineResidual, Parametrization, best, starts};
use crate::least_squares::{LocalMinima, Residuals, Search, minimise};
use crate::material::{OutsideTable, loss_factor};
use crate::response::{Work, relative_error};
use crate::subspace::Subspace;

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct LawsOutcome {
    /// Each frequency alone.
    pub free: BandOutcome,
    /// One for each law with a finite misfit, in the order in which they were asked for; none where there is no subspace to fit on.
    pub fits: Vec<LawFit>,
    /// The law of least BIC at each frequency.
    pub lines: Vec<Line>,
    /// What was unknown of each sensor's channel, by the law of least BIC.
    pub channels: Vec<Calibration>,
    /// Whether noise is all that this law leaves: as large as was given, or without that as large as each frequency alone leaves; `None` where there is no law.
    pub fit: Option<GoodnessOfFit>,
    /// All work of size N.
    pub work: Work,
    /// Vectors of the subspace.
    pub subspace_size: Option<usize>,
}

/// Starts that are followed for each law: each costs some dozen responses of the whole band.
const BAND_LAW_STARTS: usize = 4;

/// Evaluations for each start and unknown.
const EVALUATIONS_PER_START_AND_PARAMETER: usize = 15;

/// By how much all moduli of a start are moved: on a lightly damped structure the misfit has a valley for each coincidence of measured and computed resonances.
pub(super) const START_SHIFTS: [f64; 8] = [-0.03, -0.01, -0.003, -0.001, 0.001, 0.003, 0.01, 0.03];

/// Rounds of training at a law or a curve before the remaining answers are called uncertain.
pub(in crate::identify) const MAX_TRAINING_ROUNDS: usize = 4;

/// No modulus from one frequency is better than this, relative: without noise, no frequency shall rule alone.
const MIN_RELATIVE_MODULUS_STD: f64 = 1e-6;

/// A modulus with a standard deviation of half of itself is not known.
const MAX_RELATIVE_MODULUS_STD: f64 = 0.5;

/// Another minimum, or another solution, this many standard deviations away is another answer.
pub(super) const RIVAL_DISTANCE_STD: f64 = 3.0;

/// Fits laws to a band, and takes the one of least BIC.
///
/// The selection is joint, and what answers is the subspace, whatever the options say: on the full model every step would take a factorisation at each frequency. Statuses
/// are those of the law at each frequency: `no_root` without a value where it breaks the bounds; `unexplained` where it leaves more than noise and an error of 1 % ([`MAX_ERROR`]), or
/// [`LawsOutcome::fit`] says "not explained"; `ambiguous` where another minimum that cannot be excluded has another modulus; `not_identifiable` where the standard deviation is half the
/// modulus; `failed` where the search did not converge or the reduced model is not good enough.
///
/// Channels may have an unknown scale or delay, all of them too (`unknown`, one for each sensor, or empty).
/// Where all have one, errors of the model are not searched. Both are eliminated: for given θ the best real gain of a channel is linear least squares over the band, the best delay near the first one Newton's, and the slopes
/// are those of what they leave, so that the error bars of the law have theirs in them. Where no channel is known, the first ones are those with which the nominal law,
/// times some factor of the box, has the shape that was measured: Σ |ln|u_m| − ln|x_m|| about its median, phases as far as a line over ω takes them.
///
/// # Errors
/// [`OutsideTable`] where a table does not reach a frequency.
pub(in crate::identify) fn identify_laws<'a>(
    band: &Band<'a>,
    trained: &mut Option<Subspace<'a>>,
    (unknown, kinds): (&[ChannelUnknowns], &[LawKind]),
    options: &Options,
    context: Context<'_>,
) -> Result<LawsOutcome, OutsideTable> {
    let calibrated = vec![ChannelUnknowns::default(); band.experiment.sensors.len()];
    let unknown = if unknown.is_empty() { &calibrated } else { unknown };
    let at = band.model.at_all(band.frequency_hz, std::slice::from_ref(band.parameter))?;
    let options = &on_subspace(options);
    let mut reduced = Neighbourhoods::if_wanted(band, &at, trained, options, context);
    let is_calibrated = |channel: &ChannelUnknowns| !channel.any();
    let all_calibrated = unknown.iter().all(is_calibrated);
    let (mut free, Begin { mut channels, ratio }, options) =
        near_or_far((band, &at), options, &mut reduced, all_calibrated, context, |options, reduced| {
            at_scales(band, &at, reduced, unknown, options, context)
        });
    let options = &options;
    // Where no channel says how large the response is, errors and scales stand in for one another.
    let any_calibrated = unknown.iter().any(is_calibrated);
    if let Some(reduced) = reduced.as_mut().filter(|_| any_calibrated) {
        let scaled = Scaled::new(band, &channels);
        free = correct((&scaled.band(band), unknown), &at, free, reduced, options, context);
        if let Some(errors) = &free.model_errors {
            let left = errors.calibrations();
            channels =
                left.iter().zip(&channels).map(|(left, first)| Channel::of(&left.after(first))).collect();
        }
    }
    let scaled = Scaled::new(band, &channels).with_rest(free.rest(), band.frequency_hz);
    let view = scaled.band(band);
    let out = free.left_out();
    let sigma = without(&standard_deviations(view.frequency_hz, view.measured, view.noise), &out);
    let fitting = Fitting { band: &view, at: &at, sigma: &sigma, unknown, ratio, options, context };
    let Some(mut reduced) = reduced else {
        let lines = free.lines.iter().map(|own| own.unanswered()).collect();
        let channels = vec![Calibration::default(); unknown.len()];
        return Ok(LawsOutcome {
            work: free.work,
            subspace_size: None,
            fits: Vec::new(),
            lines,
            channels,
            fit: None,
            free,
        });
    };
    let before = reduced.work();
    let all: Vec<usize> = (0..at.len()).collect();
    reduced.localise(&all, context.for_each);
    let mut fits: Vec<LawFit> = Vec::new();
    for &kind in kinds {
        (context.progress)(Stage::Law, fits.len(), kinds.len());
        fits.extend(fitting.fit(kind, &mut reduced, &free, best(&fits)));
    }
    let had_errors = free.model_errors.is_some();
    let of_law = if any_calibrated { fitting.with_errors(&mut fits, &mut reduced, &mut free) } else { None };
    if let Some((place, excess)) = fitting.excess(&fits, &free.noise) {
        fits[place] = fits[place].clone().with_noise(excess);
    }
    (context.progress)(Stage::Law, kinds.len(), kinds.len());
    let left = best(&fits).and_then(|law| fitting.calibrations_of(law, &reduced));
    let better: Vec<_> = match &left {
        Some(left) => {
            channels.iter().zip(left).map(|(own, [gain, late])| own.better(gain.value, late.value)).collect()
        }
        None => channels.clone(),
    };
    let of_errors = free.model_errors.as_ref().map(Estimated::calibrations);
    let calibration = |m: usize| {
        let Some([gain, late]) = left.as_ref().map(|left| left[m]) else { return Calibration::default() };
        let relative = |std: f64| (std * better[m].scale / gain.value).abs();
        // Errors of the model are in the standard deviations that were found with them.
        let with_errors = of_errors.as_ref().map(|found| found[m]).unwrap_or_default();
        let std_of = |found: Option<Calibrated>, size: f64| Some(found?.std? * size.abs());
        let scale_std = std_of(with_errors.scale, channels[m].scale).or(gain.std.map(relative));
        let delay_std = std_of(with_errors.delay_s, 1.0).or(late.std);
        let scale = Calibrated { value: better[m].scale, std: scale_std };
        let delay = Calibrated { value: better[m].delay_s, std: delay_std };
        Calibration { scale: unknown[m].scale.then_some(scale), delay_s: unknown[m].delay.then_some(delay) }
    };
    let calibrations = (0..unknown.len()).map(calibration).collect();
    let scaled = Scaled::new(band, &better).with_rest(free.rest(), band.frequency_hz);
    let view = scaled.band(band);
    let sigma = without(&standard_deviations(view.frequency_hz, view.measured, view.noise), &out);
    let judging = Fitting { band: &view, sigma: &sigma, ..fitting };
    if better != channels || free.model_errors.is_some() != had_errors {
        // The value of each frequency alone, at the calibrations and the errors that came out.
        let mut whole = Some(reduced);
        let spent = free.work;
        let errors = free.model_errors.take().zip(whole.as_mut());
        free = match errors {
            Some((errors, whole)) => on_corrected(&view, &at, whole, (errors, &free), options, context),
            None => BandOutcome {
                leverage: free.leverage,
                other_model: free.other_model,
                about: free.about,
                ..joint::identify(&view, &at, whole.as_mut(), &[], options, context)
            },
        };
        free.work += spent;
        let Some(again) = whole else { unreachable!("a space that was there stays") };
        reduced = again;
        reduced.localise(&all, context.for_each);
    }
    let split = of_law.as_ref().and_then(Estimated::split);
    let (lines, fit) = match best(&fits) {
        Some(law) => {
            let (fit, noise) = judging.goodness(law, &free.noise);
            let one = |i: usize| judging.outcome((law, split.as_ref()), noise, &reduced, i, &free.lines[i]);
            (map(context.for_each, at.len(), one), fit)
        }
        None => (free.lines.iter().map(|own| own.unanswered()).collect(), None),
    };
    let fit = fit.map(|fit| fit.of_model(free.other_model).beside(free.rest()));
    let mut work = free.work;
    work += reduced.work().since(before);
    let subspace_size = Some(reduced.size());
    let within = |line: Line| Line { status: line.status.within(fit), ..line };
    let lines = lines.into_iter().map(within).collect();
    let free = free.judged_by_fit();
    Neighbourhoods::hand_back(Some(reduced), trained);
    Ok(LawsOutcome { lines, fits, channels: calibrations, fit, work, subspace_size, free })
}

impl Fitting<'_, '_> {
    /// Finds the errors of the model once more with the law of least BIC, and that law with them; its error bars have both. A smooth modulus may hide errors that
    /// a law does not: where a right model explains the band with a smooth modulus and not with the law, the errors are searched with the law. Where a right model
    /// explains the band with the law too, the error bars hold small errors.
    fn with_errors(
        &self,
        fits: &mut [LawFit],
        reduced: &mut Neighbourhoods<'_, '_>,
        free: &mut BandOutcome,
    ) -> Option<Estimated> {
        if self.options.model_errors.is_exact(self.band.model) || free.other_model {
            return None;
        }
        let kind = best(fits)?.kind;
        let place = fits.iter().position(|fit| fit.kind == kind)?;
        let weights = Weights::new((self.band, self.unknown), self.at, &free.left_out());
        let point = point(self.at);
        let measured = weights.of(self.band, self.options, &point, free);
        let (law, theta) = fits[place].coordinates();
        let mut channels = ChannelCoordinates::new(self.unknown, theta.len(), weights.omegas());
        let mut theta = theta.to_vec();
        theta.resize(theta.len() + channels.count(), 0.0);
        let (_, left) = self.channels(law, reduced, fits[place].coordinates().1)?;
        let left: Vec<Channel> =
            left.iter().map(|left| Channel::CALIBRATED.better(left.gain, left.late_s)).collect();
        channels.begin_at(&left, &mut theta);
        let curves = Curves::new(vec![Curve::Form(Form::Law(*law))]).with_channels(channels);
        let (whole, for_each) = (reduced.whole(), self.context.for_each);
        let is_explained =
            |law: &LawFit| self.goodness(law, &free.noise).0.is_none_or(|fit| fit.verdict != Explained::No);
        let errors = match &free.model_errors {
            Some(before) => {
                // Beside errors the law that a right model has may be far from the smooth curve.
                let through = law_through(law, before, 0, self.band.frequency_hz);
                let through = through.map(|own| [&own[..], &theta[own.len()..]].concat());
                let starts: Vec<Vec<f64>> = [Some(theta.clone()), through].into_iter().flatten().collect();
                Some(estimate_with_laws(whole, &measured, before, &curves, &starts, for_each)?)
            }
            None if is_explained(&fits[place]) => None,
            None => {
                let smooth = weights.smooth(self.band, self.unknown);
                estimate_beside_a_smooth_modulus(whole, &measured, (&smooth, &curves), &theta, for_each)
            }
        };
        let Some(errors) = errors else {
            let averaged = averaged_over_small_errors(whole, &measured, &curves, &theta, for_each)?;
            fits[place] = fits[place].clone().with_larger_covariance(averaged.beside_noise());
            return Some(averaged.estimated);
        };
        let again = self.fit_corrected(&fits[place], &errors, reduced, free)?;
        // What was beside the noise before is in the standard deviations already.
        let errors = errors.beside(free.rest());
        fits[place] = again.with_covariance(errors.of_theta());
        free.model_errors = Some(errors.clone());
        Some(errors)
    }

    /// Fits a law again, on the model that is corrected for its errors. What they leave of the response counts as noise.
    fn fit_corrected(
        &self,
        before: &LawFit,
        errors: &Estimated,
        reduced: &mut Neighbourhoods<'_, '_>,
        free: &BandOutcome,
    ) -> Option<LawFit> {
        reduced.correct(&errors.modes, &errors.errors);
        let all: Vec<usize> = (0..self.at.len()).collect();
        reduced.localise(&all, self.context.for_each);
        let calibrated = vec![Channel::CALIBRATED; self.unknown.len()];
        let scaled = Scaled::new(self.band, &calibrated).with_rest(errors.rest, self.band.frequency_hz);
        let view = scaled.band(self.band);
        let sigma =
            without(&standard_deviations(view.frequency_hz, view.measured, view.noise), &free.left_out());
        let beside = Fitting { band: &view, sigma: &sigma, ..*self };
        beside.fit(before.kind, reduced, free, Some(before))
    }

    /// The best law, and by how much its bars are too short where the band is nearly explained.
    fn excess(&self, fits: &[LawFit], alone: &NoiseLevel) -> Option<(usize, f64)> {
        let law = best(fits)?;
        let excess = self.goodness(law, alone).0?.excess();
        let place = fits.iter().position(|fit| fit.kind == law.kind)?;
        Some((place, excess))
    }

    fn evidence(&self) -> Evidence {
        Evidence {
            // A sensor that is left out has an infinite standard deviation.
            residuals: (2 * self.sigma.iter().flatten().filter(|sigma| sigma.is_finite()).count())
                .saturating_sub(self.unknown.iter().map(|unknown| unknown.count()).sum()),
            sigma_known: self.band.noise.is_known(),
        }
    }

    /// Fits one law, and trains the subspace at it; `None` where there are fewer numbers than parameters, or nowhere a finite misfit.
    fn fit(
        &self,
        kind: LawKind,
        reduced: &mut Neighbourhoods<'_, '_>,
        free: &BandOutcome,
        so_far: Option<&LawFit>,
    ) -> Option<LawFit> {
        if self.evidence().residuals < kind.count() {
            return None;
        }
        let omegas: Vec<f64> = (0..self.at.len()).map(|i| self.omega(i)).collect();
        let parametrization =
            Parametrization::about(kind, &omegas).through_window(self.band.model.decay_per_s());
        let mut begin = self.starts(&parametrization, reduced, free, so_far);
        let all: Vec<usize> = (0..self.at.len()).collect();
        let mut first: Option<LocalMinima> = None;
        for round in 0..=MAX_TRAINING_ROUNDS {
            let search =
                Search { starts: BAND_LAW_STARTS, patience: EVALUATIONS_PER_START_AND_PARAMETER, same: 0.0 };
            let found = minimise(&begin, &|theta| self.residuals(&parametrization, reduced, theta), &search)?;
            // What the starts said is said once; later rounds move the one that was best.
            let minima = match first.take() {
                Some(before) => LocalMinima { best: found.best, ..before },
                None => found,
            };
            let theta = minima.best.theta.clone();
            begin = vec![theta.clone()];
            first = Some(minima);
            let correction = |i: usize| {
                let (modulus, _) = parametrization.modulus(&theta, self.omega(i))?;
                Some(modulus - self.at[i].parameters[0].nominal)
            };
            let lacking = reduced.lacking(correction, self.context.for_each);
            if lacking.is_empty()
                || round == MAX_TRAINING_ROUNDS
                || !reduced.refine(&lacking, self.context).unwrap_or(false)
            {
                break;
            }
            reduced.localise(&all, self.context.for_each);
        }
        let fit = LawFit::new(parametrization, first?, self.evidence());
        let lines = self.lines(&fit, reduced);
        Some(fit.widened(&lines))
    }

    /// What a law leaves of ln E at each frequency, by all sensors, and what that pulls.
    fn lines(&self, law: &LawFit, reduced: &Neighbourhoods<'_, '_>) -> Vec<LineResidual> {
        let (parametrization, theta) = law.coordinates();
        let Some((responses, fits)) = self.channels(parametrization, reduced, theta) else {
            return Vec::new();
        };
        let line = |(i, one): (usize, &Responded)| {
            let modulus =
                parametrization.modulus(theta, self.omega(i)).map_or(c64::default(), |(modulus, _)| modulus);
            let (mut weight, mut along, mut pull) = (0.0, c64::default(), vec![c64::default(); theta.len()]);
            for (m, fit) in fits.iter().enumerate() {
                let sigma = self.sigma[i][m];
                let (omega, factor) = (self.omega(i), fit.factor(self.omega(i)));
                let slope = factor * one.slope[m] / sigma;
                let of_log = slope * modulus;
                weight += of_log.norm_sqr();
                along += of_log.conj() * (self.band.measured[i][m] - factor * one.x[m]) / sigma;
                for (j, pull) in pull.iter_mut().enumerate() {
                    let column = slope * one.of_theta[j] - fit.followed(omega, j) * one.x[m] / sigma;
                    *pull += column.conj() * of_log;
                }
            }
            let rest = along / weight;
            LineResidual {
                weight: [weight; 2],
                rest: [rest.re, rest.im],
                // Re(J* a) for a deviation along the real axis, Re(J* a i) for one along the imaginary one.
                pull: [pull.iter().map(|p| p.re).collect(), pull.iter().map(|p| -p.im).collect()],
            }
        };
        responses.iter().enumerate().map(line).collect()
    }

    /// (x_m − u_m)/σ_m over the band and its slopes.
    fn residuals(
        &self,
        parametrization: &Parametrization,
        reduced: &Neighbourhoods<'_, '_>,
        theta: &[f64],
    ) -> Option<Residuals> {
        let (responses, fits) = self.channels(parametrization, reduced, theta)?;
        let (sensors, n) = (self.unknown.len(), theta.len());
        let each = || (0..responses.len()).flat_map(|i| (0..sensors).map(move |m| (i, m)));
        let parts = |value: c64| [value.re, value.im];
        let rest = |(i, m): (usize, usize)| {
            let sigma = self.sigma[i][m];
            parts((fits[m].factor(self.omega(i)) * responses[i].x[m] - self.band.measured[i][m]) / sigma)
        };
        let residuals: Vec<f64> = each().flat_map(rest).collect();
        let column = |j: usize, (i, m): (usize, usize)| {
            let (one, omega) = (&responses[i], self.omega(i));
            let own = fits[m].factor(omega) * one.slope[m] * one.of_theta[j];
            parts((own - fits[m].followed(omega, j) * one.x[m]) / self.sigma[i][m])
        };
        let jacobian: Vec<f64> =
            (0..n).flat_map(|j| each().map(move |at| (j, at))).flat_map(|(j, at)| column(j, at)).collect();
        let finite = residuals.iter().chain(&jacobian).all(|value| value.is_finite());
        finite.then_some((residuals, jacobian))
    }

    /// Where to begin: the law of what each frequency says and that of the shape that was measured, with the neighbourhoods of both, the law nearest to another law that fits, and that of the
    /// nominal.
    fn starts(
        &self,
        parametrization: &Parametrization,
        reduced: &Neighbourhoods<'_, '_>,
        free: &BandOutcome,
        so_far: Option<&LawFit>,
    ) -> Vec<Vec<f64>> {
        let all = 0..self.at.len();
        let answered: Vec<Datum> =
            all.clone().filter_map(|i| self.datum(reduced, i, &free.lines[i])).collect();
        let relative =
            |i: usize, modulus: c64| (modulus.re > 0.0).then(|| Datum::relative(self.omega(i), modulus));
        let nominal = |ratio: f64| -> Vec<Datum> {
            all.clone().filter_map(|i| relative(i, ratio * self.at[i].parameters[0].nominal)).collect()
        };
        let other =
            all.clone().filter_map(|i| relative(i, so_far?.at(self.band.frequency_hz[i])?.modulus)).collect();
        let mut begin: Vec<Vec<f64>> = Vec::new();
        let like_measured = if self.ratio == 1.0 { Vec::new() } else { nominal(self.ratio) };
        for (data, moved) in [(answered, true), (like_measured, true), (other, false), (nominal(1.0), false)]
        {
            let Some(near) = nearest(parametrization, &data) else { continue };
            if moved || begin.is_empty() {
                begin.extend(START_SHIFTS.map(|by| parametrization.scaled(&near.best.theta, by)));
            }
            begin.push(near.best.theta);
            begin.extend(near.others.into_iter().map(|other| other.theta));
        }
        begin
    }

    /// The value of a frequency alone, with its standard deviation: σ carried by the slope of the response.
    fn datum(&self, reduced: &Neighbourhoods<'_, '_>, i: usize, own: &Line) -> Option<Datum> {
        let correction = own.correction().filter(|_| own.status == Status::Ok)?;
        let modulus = own.nominal() + correction;
        let (_, slope) = reduced.model(i).respond_with_slope(&self.at[i], correction).ok()?;
        let information: f64 =
            slope.iter().zip(&self.sigma[i]).map(|(slope, sigma)| slope.norm_sqr() / (sigma * sigma)).sum();
        let std = information.powf(-0.5).max(MIN_RELATIVE_MODULUS_STD * modulus.norm());
        (std.is_finite() && modulus.re > 0.0).then(|| Datum::circular(self.omega(i), modulus, std))
    }

    /// Whether what a law leaves is noise, and noise over the assumed standard deviations: what the law leaves where that is noise, otherwise the least that sensors or scatter of the separate
    /// frequencies show.
    fn goodness(&self, law: &LawFit, per_frequency: &NoiseLevel) -> (Option<GoodnessOfFit>, f64) {
        let left = law.reduced_chi_squared().unwrap_or(0.0).sqrt();
        if law.sigma_known {
            let given = NoiseLevel { source: NoiseSource::Given, ..*per_frequency };
            return (judge(law.chi_squared, law.degrees_of_freedom(), &given, self.band.noise), 1.0);
        }
        // Of one kind of evidence the law's, of the other that without it.
        let noise = NoiseLevel { of_sensors: Some(left), of_scatter: per_frequency.level, ..*per_frequency };
        let level = per_frequency.level.unwrap_or(left);
        let chi_squared = law.chi_squared / (level * level);
        let fit = judge(chi_squared, law.degrees_of_freedom(), &noise, self.band.noise);
        let is_noise = fit.is_none_or(|fit| fit.verdict != Explained::No);
        let shown =
            [per_frequency.of_sensors, per_frequency.of_scatter].into_iter().flatten().reduce(f64::min);
        let level = if is_noise { left } else { shown.unwrap_or(0.0).min(left) };
        (fit, level.max(per_frequency.common.unwrap_or(0.0)))
    }

    /// The law at one frequency, judged there; noise over the assumed standard deviations.
    fn outcome(
        &self,
        (law, split): (&LawFit, Option<&Split>),
        noise: f64,
        reduced: &Neighbourhoods<'_, '_>,
        i: usize,
        own: &Line,
    ) -> Line {
        let measured = &self.band.measured[i];
        let found = law.at(self.band.frequency_hz[i]).and_then(|estimate| {
            let correction = estimate.modulus - own.nominal();
            Some((estimate, correction, reduced.assess(i, correction)?))
        });
        let Some((estimate, correction, assessed)) = found else { return own.unanswered() };
        let mut line = own.unanswered();
        let certified = reduction_error(&assessed, estimate.modulus, measured);
        let error = relative_error(measured, &assessed.response);
        let misfit = misfit(measured, &assessed.response, &self.sigma[i]);
        let counted = self.sigma[i].iter().filter(|sigma| sigma.is_finite()).count();
        let rms = (misfit / (2 * counted) as f64).sqrt();
        let size = estimate.modulus.norm();
        // |δE| of E′ and η together.
        let std = estimate
            .storage_std
            .zip(estimate.loss_factor_std)
            .map(|(storage, eta)| storage.hypot(eta * size));
        let parts = |storage_std: f64| {
            let slopes = split.and(law.real_slopes(self.band.frequency_hz[i]));
            let both = split.zip(slopes);
            both.map_or(Contributions::of_noise(storage_std), |(split, slopes)| {
                Contributions::in_ratio(storage_std, split.of(&slopes))
            })
        };
        line.set_correction(correction);
        line.values[0].uncertainty =
            std.zip(estimate.storage_std).map(|(correction_std, storage_std)| Uncertainty {
                correction_std,
                storage_std,
                loss_factor_std: estimate.loss_factor_std,
                correlation: estimate.correlation,
                contributions: parts(storage_std),
                // That the law is not linear in its parameters shows in its fit.
                nonlinearity: 0.0,
            });
        line.error = Some(error).filter(|error| error.is_finite());
        line.spectral_radius = line.radius.map(|radius| radius.at(correction));
        line.reduction_error = Some(certified.response).filter(|c| c.is_finite());
        line.updated_response = assessed.response;
        let apart = |rival: &c64| {
            (rival - estimate.modulus).norm() > RIVAL_DISTANCE_STD * std.unwrap_or(f64::INFINITY)
        };
        let rivals = law.rivals_at(self.band.frequency_hz[i]).into_iter().filter(apart);
        line.rivals = rivals.map(|rival| vec![rival]).collect();
        let unexplained = error > MAX_ERROR && rms > MAX_RMS_MISFIT * noise;
        let known = std.is_some_and(|std| std <= MAX_RELATIVE_MODULUS_STD * size);
        line.on_path = true;
        line.status = Status::of([
            (unexplained, Status::Unexplained),
            (!line.rivals.is_empty(), Status::Ambiguous),
            (!law.converged, Status::Failed),
            (!known, Status::NotIdentifiable),
            (certified.factor > MAX_REDUCTION_ERROR, Status::Failed),
        ]);
        if self.band.unknown.bounds.broken_by(estimate.modulus).is_some() {
            line.forget_value(Status::NoRoot);
        }
        line
    }
}

/// The law nearest to some moduli; `None` where there are too few.
pub(in crate::identify) fn nearest(parametrization: &Parametrization, data: &[Datum]) -> Option<LocalMinima> {
    let enough = 2 * data.len() >= parametrization.kind.count();
    let search = Search { starts: 3, patience: 30, same: 0.0 };
    let evaluate = |theta: &[f64]| parametrization.residuals(data, theta);
    if enough { minimise(&starts(parametrization, data), &evaluate, &search) } else { None }
}

/// What a smooth curve beside errors of the model is good to as a start for a law, relative. These tilt E′, so that of dispersion and damping the latter says
/// which law it is.
const STORAGE_OF_CURVE_STD: f64 = 0.05;
const LOSS_FACTOR_OF_CURVE_STD: f64 = 0.05;

/// The law nearest to the smooth curve of an unknown that was found with the errors of the model; `None` where too few lines have a value.
pub(in crate::identify) fn law_through(
    parametrization: &Parametrization,
    smooth: &Estimated,
    unknown: usize,
    frequency_hz: &[f64],
) -> Option<Vec<f64>> {
    let datum = |(line, &hz): (usize, &f64)| -> Option<Datum> {
        let value = smooth.values(line, hz)?[unknown];
        let eta = loss_factor(value);
        let std = [STORAGE_OF_CURVE_STD * value.re, LOSS_FACTOR_OF_CURVE_STD * eta];
        (value.re > 0.0 && eta > 0.0).then(|| Datum::storage_and_loss(hz, [value.re, eta], std, 0.0))
    };
    let data: Vec<Datum> = frequency_hz.iter().enumerate().filter_map(datum).collect();
    Some(nearest(parametrization, &data)?.best.theta)
}
