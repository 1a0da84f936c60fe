//! Channels of unknown calibration: one real scale, one delay or both for the whole band, found together with the moduli.

use super::corrected::correct;
use super::initial_calibration::aligned;
use super::joint;
use super::neighbourhoods::Neighbourhoods;
use super::outcome::BandOutcome;
use super::scaled::Scaled;
use super::search_box::{near_or_far, on_subspace};
use crate::c64;
use crate::for_each::map;
use crate::frequency::omega_rad_s;
use crate::frfs::standard_deviations;
use crate::identify::channel::{
    Calibrated, Calibration, Channel, ChannelNumber, ChannelUnknowns, numbers_of,
};
use crate::identify::context::Context;
use crate::identify::measured::Band;
use crate::identify::noise::without;
use crate::identify::options::Options;
use crate::identify::outcome::Status;
use crate::identify::uncertainty::Uncertainty;
use crate::material::OutsideTable;
use crate::model::ModelAt;
use crate::subspace::Subspace;
use frfit_linalg::dense::symmetric_eigen;

/// Selections among all solutions, each at better scales; they change what is selected hardly ever after the first.
const MAX_SELECTIONS: usize = 6;

/// Steps of Gauss and Newton on moduli and scales together.
const MAX_CALIBRATION_STEPS: usize = 30;

/// A scale that changes by less than this part of its standard deviation, or of itself, has settled.
const CALIBRATION_STEP_TOL: f64 = 1e-3;
const CALIBRATION_ROUNDOFF: f64 = 1e-10;

/// The part of a scale that the moduli do not take up, and the part that the other scales do not take up either, relative to the channel's size: below this there is no digit.
const CALIBRATION_INFORMATION_RTOL: f64 = 1e-12;

/// As [`super::identify_band`], with channels whose scale s_m, or delay τ_m, is unknown: u_m = s_m e^{iωτ_m} times what was measured.
///
/// The misfit Σ |y_m − x_m(c) e^{−iωτ_m}/s_m|²/σ_m² over the band is made least in all moduli, scales and delays together (y_m as measured, with its own standard deviation): the
/// channels of which all is known alone give the first moduli; the first delays are those that turn most x_m/y_m to one phase, among the ones that the diagnostics tries too, the first
/// scales the medians then. Every frequency is selected again from all channels, and Gauss and Newton's steps with the moduli eliminated, frequency by
/// frequency, move scales and delays. Error bars of the factor have what those of the scales and delays put into them, and χ² as many degrees of freedom less.
/// The selection is joint, and what answers is the subspace, whatever the options say; no calibration is given, and the channels are left out, where there is no
/// subspace, or where they are not identifiable from the answers.
///
/// # Errors
/// [`OutsideTable`] where a table does not reach a frequency.
pub(in crate::identify) fn identify_band_scaled<'a>(
    band: &Band<'a>,
    trained: &mut Option<Subspace<'a>>,
    unknown: &[ChannelUnknowns],
    options: &Options,
    context: Context<'_>,
) -> Result<(BandOutcome, Vec<Calibration>), OutsideTable> {
    let at = band.model.at_all(band.frequency_hz, std::slice::from_ref(band.parameter))?;
    let options = &on_subspace(options);
    let mut reduced = Neighbourhoods::if_wanted(band, &at, trained, options, context);
    let (outcome, found, options) =
        near_or_far((band, &at), options, &mut reduced, false, context, |options, reduced| {
            with_scales(band, &at, reduced, unknown, options, context)
        });
    let options = &options;
    let (outcome, found) = match (reduced.as_mut(), found) {
        (Some(reduced), Some(found)) => {
            let first: Vec<Channel> = found.iter().map(Channel::of).collect();
            let scaled = Scaled::new(band, &first);
            let outcome = correct((&scaled.band(band), unknown), &at, outcome, reduced, options, context);
            let errors = outcome.model_errors.as_ref();
            let left = errors.map(|errors| errors.calibrations().into_iter().zip(&first));
            let better = left.map(|left| left.map(|(left, first)| left.after(first)).collect());
            (outcome, better.unwrap_or(found))
        }
        (_, found) => (outcome, found.unwrap_or_else(|| vec![Calibration::default(); unknown.len()])),
    };
    Neighbourhoods::hand_back(reduced, trained);
    Ok((outcome.judged_by_fit(), found))
}

/// Moduli and calibrations on a subspace; `None` where the latter are not identifiable.
pub(super) fn with_scales<'a>(
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    reduced: &mut Option<Neighbourhoods<'a, '_>>,
    unknown: &[ChannelUnknowns],
    options: &Options,
    context: Context<'_>,
) -> (BandOutcome, Option<Vec<Calibration>>) {
    let hidden: Vec<usize> = (0..unknown.len()).filter(|&m| unknown[m].any()).collect();
    let first = joint::identify(band, at, reduced.as_mut(), &hidden, options, context);
    let Some(mut channels) =
        reduced.as_ref().and_then(|reduced| starting(band, at, reduced, &first, unknown))
    else {
        return (first, None);
    };
    for round in 0..MAX_SELECTIONS {
        let scaled = Scaled::new(band, &channels);
        let view = scaled.band(band);
        let mut outcome = joint::identify(&view, at, reduced.as_mut(), &[], options, context);
        let estimated =
            reduced.as_ref().and_then(|reduced| settle(&view, at, reduced, &outcome, unknown, context));
        let Some(estimated) = estimated else { return (first, None) };
        if estimated.is_settled(top(band)) || round + 1 == MAX_SELECTIONS {
            estimated.widen(&mut outcome);
            let outcome = outcome.with_fitted(estimated.free.len(), &view);
            let found = estimated.calibrations(&channels, outcome.noise.level);
            return (outcome, Some(found));
        }
        channels = estimated.better(&channels);
    }
    (first, None)
}

/// ω at the top of the band.
pub(super) fn top(band: &Band<'_>) -> f64 {
    band.frequency_hz.last().map_or(1.0, |&f| omega_rad_s(f))
}

/// The frequencies whose answers are beyond doubt but for their size: (frequency, correction).
fn answers(outcome: &BandOutcome) -> Vec<(usize, c64)> {
    let trusted = |status| matches!(status, Status::Ok | Status::NotIdentifiable | Status::Failed);
    let linear = |bars: Option<Uncertainty>| bars.is_none_or(|bars| bars.is_linear());
    let all = outcome.lines.iter().enumerate();
    all.filter(|(_, o)| trusted(o.status) && linear(o.uncertainty()))
        .filter_map(|(i, o)| Some((i, o.correction().filter(|_| o.on_path)?)))
        .collect()
}

/// The first calibration of each channel, from the moduli that the others gave: a wrong solution here and there does not move it.
fn starting(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    reduced: &Neighbourhoods<'_, '_>,
    outcome: &BandOutcome,
    unknown: &[ChannelUnknowns],
) -> Option<Vec<Channel>> {
    let mut ratios: Vec<Vec<(f64, c64)>> = vec![Vec::new(); unknown.len()];
    for (i, correction) in answers(outcome) {
        let Ok((x, _)) = reduced.model(i).respond_with_slope(&at[i], correction) else { continue };
        for (m, ratios) in ratios.iter_mut().enumerate() {
            ratios.push((omega_rad_s(band.frequency_hz[i]), x[m] / band.measured[i][m]));
        }
    }
    ratios.iter().zip(unknown).map(|(ratios, &unknown)| aligned(ratios, unknown, top(band))).collect()
}

/// Calibrations at the least misfit about given answers.
struct CalibrationEstimate {
    free: Vec<ChannelNumber>,
    /// γ_m and t_m of the remaining calibration: u_m = γ_m e^{−iωt_m} x_m.
    left: Vec<(f64, f64)>,
    /// Covariance of the free ones of them, in units of the noise's level squared.
    covariance: Vec<Vec<f64>>,
    /// (frequency, ∂c/∂p of each free one).
    moved: Vec<(usize, Vec<c64>)>,
}

/// Minimises Σ |u_m − γ_m e^{−iωt_m} x_m(c_i)|²/σ_m² over all c_i and the unknown γ and t; `None` where they are not identifiable.
fn settle(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    reduced: &Neighbourhoods<'_, '_>,
    outcome: &BandOutcome,
    unknown: &[ChannelUnknowns],
    context: Context<'_>,
) -> Option<CalibrationEstimate> {
    let sigma =
        without(&standard_deviations(band.frequency_hz, band.measured, band.noise), &outcome.left_out());
    let free = numbers_of(unknown);
    let n = free.len();
    let top = top(band);
    let mut answers = answers(outcome);
    let mut left = vec![(1.0, 0.0); unknown.len()];
    let mut last = f64::INFINITY;
    for _ in 0..MAX_CALIBRATION_STEPS {
        let system = |k: usize| -> Option<Local> {
            let (i, correction) = answers[k];
            let omega = omega_rad_s(band.frequency_hz[i]);
            let (x, slope) = reduced.model(i).respond_with_slope(&at[i], correction).ok()?;
            let weighed = |m: usize, value: c64| value / sigma[i][m];
            let turn = |m: usize| c64::from_polar(1.0, -omega * left[m].1);
            let sensors = 0..x.len();
            let a: Vec<c64> = sensors.clone().map(|m| weighed(m, left[m].0 * turn(m) * slope[m])).collect();
            let rest = |m: usize| weighed(m, band.measured[i][m] - left[m].0 * turn(m) * x[m]);
            let of = |&ChannelNumber { channel: m, is_delay }: &ChannelNumber| {
                let by = if is_delay { c64::new(0.0, -omega * left[m].0) } else { c64::new(1.0, 0.0) };
                weighed(m, by * turn(m) * x[m])
            };
            Some(Local { a, rest: sensors.map(rest).collect(), b: free.iter().map(of).collect() })
        };
        let local: Vec<Local> =
            map(context.for_each, answers.len(), system).into_iter().collect::<Option<_>>()?;
        let (mut normal, mut right, mut whole) = (vec![vec![0.0; n]; n], vec![0.0; n], vec![0.0; n]);
        for one in &local {
            one.accumulate(&free, &mut normal, &mut right, &mut whole);
        }
        let covariance = inverse(&normal, &whole)?;
        let step: Vec<f64> =
            covariance.iter().map(|row| row.iter().zip(&right).map(|(a, b)| a * b).sum()).collect();
        if step.iter().any(|step| !step.is_finite()) {
            return None;
        }
        // A part of the scale, or radians at the top of the band.
        let part = |(free, step): (&ChannelNumber, &f64)| match free.is_delay {
            true => (step * top).abs(),
            false => (step / left[free.channel].0).abs(),
        };
        let size = free.iter().zip(&step).map(part).fold(0.0, f64::max);
        let moved = local.iter().map(|one| one.moved(&free)).collect::<Vec<_>>();
        // No more to gain: roundoff does not fall further.
        if size <= 1e-13 || (size <= CALIBRATION_ROUNDOFF && size >= last) {
            let moved = answers.iter().zip(moved).map(|(&(i, _), moved)| (i, moved)).collect();
            return Some(CalibrationEstimate { free, left, covariance, moved });
        }
        // A scale that jumps by half, or half a radian, is far from where the slopes hold.
        let shortened = (0.5 / size).min(1.0);
        for ((estimate, one), moved) in answers.iter_mut().zip(&local).zip(&moved) {
            let other: c64 = moved.iter().zip(&step).map(|(v, d)| v * d).sum();
            estimate.1 += shortened * (one.own() + other);
        }
        for (free, step) in free.iter().zip(&step) {
            let (gain, late) = &mut left[free.channel];
            *(if free.is_delay { late } else { gain }) += shortened * step;
        }
        last = size;
    }
    None
}

/// What one frequency has to say, everything over σ.
struct Local {
    /// ∂(γe^{−iωt}x)/∂c.
    a: Vec<c64>,
    /// u − γe^{−iωt}x.
    rest: Vec<c64>,
    /// ∂(γe^{−iωt}x)/∂p of each free number, at its channel alone.
    b: Vec<c64>,
}

impl Local {
    fn information(&self) -> f64 {
        self.a.iter().map(|a| a.norm_sqr()).sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// The correction's own step.
    fn own(&self) -> c64 {
        self.a.iter().zip(&self.rest).map(|(a, r)| a.conj() * r).sum::<c64>() / self.information()
    }

    /// ∂c/∂p.
    fn moved(&self, free: &[ChannelNumber]) -> Vec<c64> {
        let of = |(free, b): (&ChannelNumber, &c64)| -self.a[free.channel].conj() * b / self.information();
        free.iter().zip(&self.b).map(of).collect()
    }

    /// Normal equations with the correction eliminated: b_pᴴ P b_q and b_pᴴ P r, P = I − aaᴴ/aᴴa.
    fn accumulate(
        &self,
        free: &[ChannelNumber],
        normal: &mut [Vec<f64>],
        right: &mut [f64],
        whole: &mut [f64],
    ) {
        let (own, moved) = (self.own(), self.moved(free));
        for (p, (&ChannelNumber { channel: m, .. }, b)) in free.iter().zip(&self.b).enumerate() {
            whole[p] += b.norm_sqr();
            right[p] += (b.conj() * (self.rest[m] - self.a[m] * own)).re;
            for (q, moved) in moved.iter().enumerate() {
                let direct = if free[q].channel == m { self.b[q] } else { c64::default() };
                normal[p][q] += (b.conj() * (direct + self.a[m] * moved)).re;
            }
        }
    }
}

/// The inverse of a small information matrix; `None` where it has no digit beside what there is without the moduli.
fn inverse(normal: &[Vec<f64>], whole: &[f64]) -> Option<Vec<Vec<f64>>> {
    let n = whole.len();
    let entry = |p: usize, q: usize| 0.5 * (normal[p][q] + normal[q][p]) / (whole[p] * whole[q]).sqrt();
    let scaled: Vec<f64> =
        (0..n).flat_map(|p| (0..n).map(move |q| (p, q))).map(|(p, q)| entry(p, q)).collect();
    if scaled.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let (values, vectors) = symmetric_eigen(n, &scaled).ok()?;
    if values.iter().any(|&value| value < CALIBRATION_INFORMATION_RTOL) {
        return None;
    }
    let sum = |p: usize, q: usize| {
        let sum: f64 = (0..n).map(|k| vectors[k * n + p] * vectors[k * n + q] / values[k]).sum();
        sum / (whole[p] * whole[q]).sqrt()
    };
    Some((0..n).map(|p| (0..n).map(|q| sum(p, q)).collect()).collect())
}

impl CalibrationEstimate {
    /// Standard deviation of a free number in units of the noise's level.
    fn std(&self, p: usize) -> f64 {
        self.covariance[p][p].max(0.0).sqrt()
    }

    /// The remaining correction of a free number: of a scale as a part of it, of a delay in s.
    fn off(&self, p: usize) -> f64 {
        let (gain, late) = self.left[self.free[p].channel];
        if self.free[p].is_delay { late } else { gain - 1.0 }
    }

    fn is_settled(&self, top: f64) -> bool {
        let least = |free: &ChannelNumber| {
            if free.is_delay { CALIBRATION_ROUNDOFF / top } else { CALIBRATION_ROUNDOFF }
        };
        let settled = |(p, free): (usize, &ChannelNumber)| {
            self.off(p).abs() <= (CALIBRATION_STEP_TOL * self.std(p)).max(least(free))
        };
        self.free.iter().enumerate().all(settled)
    }

    fn better(&self, channels: &[Channel]) -> Vec<Channel> {
        channels.iter().zip(&self.left).map(|(own, &(gain, late))| own.better(gain, late)).collect()
    }

    /// What came out of each channel, at the level of the noise.
    fn calibrations(&self, channels: &[Channel], level: Option<f64>) -> Vec<Calibration> {
        let better = self.better(channels);
        let mut found = vec![Calibration::default(); channels.len()];
        for (p, &ChannelNumber { channel: m, is_delay }) in self.free.iter().enumerate() {
            let std = level.map(|level| level * self.std(p));
            let relative = |std: f64| std * (better[m].scale / self.left[m].0).abs();
            match is_delay {
                true => found[m].delay_s = Some(Calibrated { value: better[m].delay_s, std }),
                false => found[m].scale = Some(Calibrated { value: better[m].scale, std: std.map(relative) }),
            }
        }
        found
    }

    /// Adds to the error bars of the factor what those of scales and delays make of it.
    fn widen(&self, outcome: &mut BandOutcome) {
        let Some(level) = outcome.noise.level else { return };
        for (i, moved) in &self.moved {
            let own = &mut outcome.lines[*i];
            let (Some(factor), Some(bars)) = (own.factor(), own.values[0].uncertainty.as_mut()) else {
                continue;
            };
            let form = |g: &dyn Fn(&c64) -> f64, h: &dyn Fn(&c64) -> f64| {
                let row = |(p, v): (usize, &c64)| {
                    moved.iter().zip(&self.covariance[p]).map(|(w, c)| g(v) * c * h(w)).sum::<f64>()
                };
                level * level * moved.iter().enumerate().map(row).sum::<f64>()
            };
            let (real, imaginary) = (|v: &c64| v.re, |v: &c64| v.im);
            bars.widen(factor, [form(&real, &real), form(&imaginary, &imaginary), form(&real, &imaginary)]);
            if own.status == Status::Ok && !bars.is_known(factor) {
                own.status = Status::NotIdentifiable;
            }
        }
    }
}
