//! Channels whose calibration nobody knows: one real scale for the whole band, found together with the moduli.

use super::contradiction::without;
use super::joint;
use super::noise::deviations;
use super::space::Space;
use super::{Band, BandOutcome, Hooks, Noise, near_and_far, near_or_far};
use crate::c64;
use crate::for_each::map;
use crate::identify::{Options, Selection, Space as Where, Status};
use crate::material::{OutsideTable, loss_factor};
use crate::median::median;
use crate::model::ModelAt;
use frfit_linalg::dense::symmetric_eigen;

/// The factor by which a channel's values have to be multiplied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Its value; negative where the channel's sense is reversed.
    pub value: f64,
    /// Its standard deviation; `None` where nothing tells the noise.
    pub std: Option<f64>,
}

/// Selections among all solutions, each at better scales; they change what is selected hardly ever after the first.
const ROUNDS: usize = 6;

/// Steps of Gauss and Newton on moduli and scales together.
const STEPS: usize = 30;

/// A change of a scale by this part of its deviation, or of itself, is none.
const SETTLED: f64 = 1e-3;
const ROUNDOFF: f64 = 1e-10;

/// What of a scale the moduli leave, and what is left of it by the other scales, relative to the channel's size: below this there is no digit.
const UNTOLD: f64 = 1e-12;

/// As [`super::identify_band`], with channels whose scale s_m is unknown: u_m = s_m times what was measured.
///
/// The misfit Σ |y_m − x_m(c)/s_m|²/σ_m² over the band is made least in all moduli and scales together (y_m as measured, with its own deviation): the channels
/// of known scale alone give the first moduli, the medians of x_m/y_m the first scales; then every frequency is selected anew from all channels, and Gauss and
/// Newton's steps with the moduli eliminated, frequency by frequency, move the scales. Error bars of the factor have what those of the scales put into them.
/// The selection is joint, and what answers is the subspace, whatever the options say; the scales are `None`, and their channels left out, where there is no
/// subspace, or where what was found does not tell them.
///
/// # Errors
/// [`OutsideTable`] where a table does not reach a frequency.
///
/// # Panics
/// Where not one channel has a known scale: one channel and a free modulus at each frequency explain every scale. A law is needed then
/// ([`super::identify_laws_scaled`]).
pub fn identify_band_scaled(
    band: &Band<'_>,
    unknown: &[bool],
    options: &Options,
    hooks: Hooks<'_>,
) -> Result<(BandOutcome, Vec<Option<Scale>>), OutsideTable> {
    assert!(!band.frequency_hz.is_empty() && band.measured.len() == band.frequency_hz.len());
    assert!(unknown.len() == band.experiment.sensors.len() && unknown.contains(&false));
    let at = band.model.at_all(band.frequency_hz, std::slice::from_ref(band.parameter))?;
    let near = Options { space: Where::Subspace, selection: Selection::Joint, ..*options };
    let run = |options: &Options| {
        let mut space = super::space(band, &at, options, hooks);
        with_scales(band, &at, &mut space, unknown, options, hooks)
    };
    Ok(near_or_far(&near_and_far(&near), run))
}

/// Moduli and scales on a subspace.
pub(super) fn with_scales<'a>(
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    space: &mut Option<Space<'a, '_>>,
    unknown: &[bool],
    options: &Options,
    hooks: Hooks<'_>,
) -> (BandOutcome, Vec<Option<Scale>>) {
    let hidden: Vec<usize> = (0..unknown.len()).filter(|&m| unknown[m]).collect();
    let first = joint::identify(band, at, space, &hidden, options, hooks);
    let none = vec![None; unknown.len()];
    let Some(mut scales) = space.as_ref().and_then(|space| starting(band, at, space, &first, unknown)) else {
        return (first, none);
    };
    for round in 0..ROUNDS {
        let scaled = Scaled::new(band, &scales);
        let view = scaled.band(band);
        let mut outcome = joint::identify(&view, at, space, &[], options, hooks);
        let told = space.as_ref().and_then(|space| settle(&view, at, space, &outcome, unknown, hooks));
        let Some(told) = told else { return (first, none) };
        let settled = |p: usize| (told.gains[p] - 1.0).abs() <= (SETTLED * told.std(p)).max(ROUNDOFF);
        if (0..hidden.len()).all(settled) || round + 1 == ROUNDS {
            told.widen(&mut outcome);
            let known = outcome.noise.level;
            let mut found = none;
            for (p, &m) in hidden.iter().enumerate() {
                let value = scales[m] / told.gains[p];
                found[m] = Some(Scale { value, std: known.map(|level| level * told.std(p) * value.abs()) });
            }
            return (outcome, found);
        }
        hidden.iter().zip(&told.gains).for_each(|(&m, gain)| scales[m] /= gain);
    }
    (first, none)
}

/// What was measured, each channel times a scale, and its deviations with it.
pub(super) struct Scaled {
    measured: Vec<Vec<c64>>,
    std: Vec<Vec<f64>>,
}

impl Scaled {
    pub(super) fn new(band: &Band<'_>, scales: &[f64]) -> Self {
        let measured = band.measured.iter().map(|u| u.iter().zip(scales).map(|(u, s)| s * u).collect());
        let scaled = |rows: &[Vec<f64>]| {
            rows.iter().map(|row| row.iter().zip(scales).map(|(std, s)| std * s.abs()).collect()).collect()
        };
        let std = match band.noise {
            Noise::Unknown => Vec::new(),
            Noise::Relative(std) | Noise::Known(std) => scaled(std),
        };
        Self { measured: measured.collect(), std }
    }

    pub(super) fn band<'s>(&'s self, band: &Band<'s>) -> Band<'s> {
        let noise = match band.noise {
            Noise::Unknown => Noise::Unknown,
            Noise::Relative(_) => Noise::Relative(&self.std),
            Noise::Known(_) => Noise::Known(&self.std),
        };
        Band { measured: &self.measured, noise, ..*band }
    }
}

/// The frequencies whose answers are beyond doubt but for their size: (frequency, correction).
fn answers(outcome: &BandOutcome) -> Vec<(usize, c64)> {
    let trusted = |status| matches!(status, Status::Ok | Status::IllConditioned);
    let linear = |bars: Option<crate::identify::Uncertainty>| bars.is_none_or(|bars| bars.is_linear());
    let all = outcome.outcomes.iter().enumerate();
    all.filter(|(_, o)| trusted(o.status) && linear(o.uncertainty))
        .filter_map(|(i, o)| Some((i, o.correction?)))
        .collect()
}

/// The median of x/y of each channel of unknown scale, as far as it is real: a wrong solution here and there does not move it.
fn starting(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    space: &Space<'_, '_>,
    outcome: &BandOutcome,
    unknown: &[bool],
) -> Option<Vec<f64>> {
    let mut ratios: Vec<Vec<f64>> = vec![Vec::new(); unknown.len()];
    for (i, correction) in answers(outcome) {
        let Ok((x, _)) = space.model(i).respond_with_slope(&at[i], correction) else { continue };
        for (m, ratios) in ratios.iter_mut().enumerate() {
            let ratio = (x[m] / band.measured[i][m]).re;
            ratios.extend(Some(ratio).filter(|ratio| ratio.is_finite()));
        }
    }
    let scale = |(ratios, &unknown): (Vec<f64>, &bool)| match unknown {
        true => median(ratios).filter(|&median| median != 0.0),
        false => Some(1.0),
    };
    ratios.into_iter().zip(unknown).map(scale).collect()
}

/// Scales at the least misfit about given answers.
struct Told {
    /// x_m/u_m of each unknown channel, by which its scale is to be divided.
    gains: Vec<f64>,
    /// Covariance of the gains in units of the noise's level squared.
    covariance: Vec<Vec<f64>>,
    /// (frequency, ∂c/∂γ_p).
    moved: Vec<(usize, Vec<c64>)>,
}

/// Minimises Σ |u_m − γ_m x_m(c_i)|²/σ_m² over all c_i and the γ of unknown channels; `None` where the data do not tell them.
fn settle(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    space: &Space<'_, '_>,
    outcome: &BandOutcome,
    unknown: &[bool],
    hooks: Hooks<'_>,
) -> Option<Told> {
    let out: Vec<usize> = (0..unknown.len()).filter(|&m| outcome.sensors[m].left_out).collect();
    let sigma = without(&deviations(band), &out);
    let channels: Vec<usize> = (0..unknown.len()).filter(|&m| unknown[m]).collect();
    let n = channels.len();
    let mut answers = answers(outcome);
    let mut gains = vec![1.0; n];
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let system = |k: usize| -> Option<Local> {
            let (i, correction) = answers[k];
            let (x, slope) = space.model(i).respond_with_slope(&at[i], correction).ok()?;
            let gain = |m: usize| channels.iter().position(|&c| c == m).map_or(1.0, |p| gains[p]);
            let weighed = |m: usize, value: c64| value / sigma[i][m];
            let sensors = 0..x.len();
            let a: Vec<c64> = sensors.clone().map(|m| weighed(m, gain(m) * slope[m])).collect();
            let rest: Vec<c64> = sensors.map(|m| weighed(m, band.measured[i][m] - gain(m) * x[m])).collect();
            let b = channels.iter().map(|&m| weighed(m, x[m])).collect();
            Some(Local { a, rest, b })
        };
        let local: Vec<Local> =
            map(hooks.for_each, answers.len(), system).into_iter().collect::<Option<_>>()?;
        let (mut normal, mut right, mut whole) = (vec![vec![0.0; n]; n], vec![0.0; n], vec![0.0; n]);
        for one in &local {
            one.accumulate(&channels, &mut normal, &mut right, &mut whole);
        }
        let covariance = inverse(&normal, &whole)?;
        let step: Vec<f64> =
            covariance.iter().map(|row| row.iter().zip(&right).map(|(a, b)| a * b).sum()).collect();
        if step.iter().any(|step| !step.is_finite()) {
            return None;
        }
        let size = step.iter().zip(&gains).map(|(step, gain)| (step / gain).abs()).fold(0.0, f64::max);
        let moved = local.iter().map(|one| one.moved(&channels)).collect::<Vec<_>>();
        // No more to gain: roundoff does not fall further.
        if size <= 1e-13 || (size <= ROUNDOFF && size >= last) {
            let moved = answers.iter().zip(moved).map(|(&(i, _), moved)| (i, moved)).collect();
            return Some(Told { gains, covariance, moved });
        }
        // A scale that jumps by half is far from where the slopes hold.
        let shortened = (0.5 / size).min(1.0);
        for ((answer, one), moved) in answers.iter_mut().zip(&local).zip(&moved) {
            let other: c64 = moved.iter().zip(&step).map(|(v, d)| v * d).sum();
            answer.1 += shortened * (one.own() + other);
        }
        gains.iter_mut().zip(&step).for_each(|(gain, step)| *gain += shortened * step);
        last = size;
    }
    None
}

/// What one frequency has to say, everything over σ.
struct Local {
    /// ∂(γx)/∂c.
    a: Vec<c64>,
    /// u − γx.
    rest: Vec<c64>,
    /// ∂(γx)/∂γ_p, at the channel p alone.
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

    /// ∂c/∂γ_p.
    fn moved(&self, channels: &[usize]) -> Vec<c64> {
        let of = |(&m, b): (&usize, &c64)| -self.a[m].conj() * b / self.information();
        channels.iter().zip(&self.b).map(of).collect()
    }

    /// Normal equations with the correction eliminated: b_pᴴ P b_q and b_pᴴ P r, P = I − aaᴴ/aᴴa.
    fn accumulate(&self, channels: &[usize], normal: &mut [Vec<f64>], right: &mut [f64], whole: &mut [f64]) {
        let (own, moved) = (self.own(), self.moved(channels));
        for (p, (&m, b)) in channels.iter().zip(&self.b).enumerate() {
            whole[p] += b.norm_sqr();
            right[p] += (b.conj() * (self.rest[m] - self.a[m] * own)).re;
            for (q, moved) in moved.iter().enumerate() {
                let direct = if p == q { *b } else { c64::default() };
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
    if values.iter().any(|&value| value < UNTOLD) {
        return None;
    }
    let sum = |p: usize, q: usize| {
        let sum: f64 = (0..n).map(|k| vectors[k * n + p] * vectors[k * n + q] / values[k]).sum();
        sum / (whole[p] * whole[q]).sqrt()
    };
    Some((0..n).map(|p| (0..n).map(|q| sum(p, q)).collect()).collect())
}

impl Told {
    /// Relative deviation of a scale in units of the noise's level.
    fn std(&self, p: usize) -> f64 {
        self.covariance[p][p].max(0.0).sqrt() / self.gains[p].abs()
    }

    /// Adds to the error bars of the factor what those of the scales make of it.
    fn widen(&self, outcome: &mut BandOutcome) {
        let Some(level) = outcome.noise.level else { return };
        for (i, moved) in &self.moved {
            let own = &mut outcome.outcomes[*i];
            let (Some(factor), Some(bars)) = (own.factor(), own.uncertainty.as_mut()) else { continue };
            let eta = loss_factor(factor);
            let form = |g: &dyn Fn(&c64) -> f64, h: &dyn Fn(&c64) -> f64| {
                let row = |(p, v): (usize, &c64)| {
                    moved.iter().zip(&self.covariance[p]).map(|(w, c)| g(v) * c * h(w)).sum::<f64>()
                };
                level * level * moved.iter().enumerate().map(row).sum::<f64>()
            };
            let storage = |v: &c64| v.re;
            let loss = |v: &c64| (v.im - eta * v.re) / factor.re;
            let imaginary = |v: &c64| v.im;
            let extra = form(&storage, &storage);
            bars.correction_std =
                (bars.correction_std.powi(2) + extra + form(&imaginary, &imaginary)).max(0.0).sqrt();
            let before = bars.storage_std;
            bars.storage_std = (before.powi(2) + extra).max(0.0).sqrt();
            if let (Some(std), Some(correlation)) = (bars.loss_factor_std, bars.correlation) {
                let wider = (std * std + form(&loss, &loss)).max(0.0).sqrt();
                let common = correlation * before * std + form(&storage, &loss);
                bars.loss_factor_std = Some(wider);
                bars.correlation = Some(common / (bars.storage_std * wider)).filter(|c| c.is_finite());
            }
            if own.status == Status::Ok && !bars.is_known(factor) {
                own.status = Status::IllConditioned;
            }
        }
    }
}
