//! Unknown scales and delays beside a law: eliminated from the least squares, and where they begin.

use super::calibration::{top, with_scales};
use super::initial_calibration::by_shape;
use super::joint;
use super::law_fitting::Fitting;
use super::neighbourhoods::Neighbourhoods;
use super::outcome::BandOutcome;
use super::scaled::Scaled;
use crate::c64;
use crate::for_each::map;
use crate::frequency::omega_rad_s;
use crate::identify::channel::{Calibrated, Channel, ChannelUnknowns};
use crate::identify::context::Context;
use crate::identify::measured::Band;
use crate::identify::options::Options;
use crate::laws::{LawFit, Parametrization};
use crate::median::median;
use crate::model::ModelAt;

/// The response of a law at one frequency.
pub(super) struct Responded {
    /// x_m.
    pub(super) x: Vec<c64>,
    /// ∂x_m/∂c.
    pub(super) slope: Vec<c64>,
    /// ∂E/∂θ_j.
    pub(super) of_theta: Vec<c64>,
}

/// A channel at a law.
pub(super) struct ChannelFit {
    /// γ and t (s) at which Σ |u − γe^{−iωt}x|²/σ² over the band is least; one and zero where they are known.
    pub(super) gain: f64,
    pub(super) late_s: f64,
    /// −∂γ/∂θ_j as far as residuals do not matter: what of γ ∂x/∂θ_j is along x. None where the scale is known.
    gain_moved: Vec<f64>,
    /// −∂t/∂θ_j, what is along −iωγx. None where the delay is known.
    late_moved: Vec<f64>,
    /// Σ |x|²/σ² and Σ ω²|γx|²/σ²: the information on γ and on t. They have none in common, as x and iωx are at right angles.
    gain_information: f64,
    late_information: f64,
}

impl ChannelFit {
    /// γe^{−iωt}.
    pub(super) fn factor(&self, omega: f64) -> c64 {
        self.gain * c64::from_polar(1.0, -omega * self.late_s)
    }

    /// What γ and t of their own do to γe^{−iωt}x when θ_j moves, over x.
    pub(super) fn followed(&self, omega: f64, j: usize) -> c64 {
        let moved = |moved: &[f64]| moved.get(j).copied().unwrap_or(0.0);
        let by = moved(&self.gain_moved) - c64::new(0.0, omega * self.gain * moved(&self.late_moved));
        by * c64::from_polar(1.0, -omega * self.late_s)
    }
}

/// Newton's steps to the best delay, and the longest one in radians at the top of the band.
const MAX_DELAY_STEPS: usize = 50;
const MAX_DELAY_STEP_RAD: f64 = 0.5;

/// The best delay for w = Σ-terms (ω, x*u/σ²), nearest to none: Σ Re(w e^{iωt}) is largest in size where the gain is free, and largest where it is one.
fn best_delay(terms: &[(f64, c64)], gain_is_free: bool, top: f64) -> f64 {
    let derivatives = |t: f64| {
        terms.iter().fold([0.0; 3], |[value, first, second], (omega, w)| {
            let w = w * c64::from_polar(1.0, omega * t);
            [value + w.re, first - omega * w.im, second - omega * omega * w.re]
        })
    };
    let sense = if gain_is_free && derivatives(0.0)[0] < 0.0 { -1.0 } else { 1.0 };
    let mut t = 0.0;
    for _ in 0..MAX_DELAY_STEPS {
        let [_, first, second] = derivatives(t).map(|value| sense * value);
        let most = MAX_DELAY_STEP_RAD / top;
        // Uphill where it is not yet bent like a summit.
        let step = if second < 0.0 { (-first / second).clamp(-most, most) } else { most.copysign(first) };
        t += step;
        if (step * top).abs() <= 1e-13 {
            break;
        }
    }
    t
}

impl Fitting<'_, '_> {
    /// Responses over the band at θ, and the best calibration of each channel.
    pub(super) fn channels(
        &self,
        parametrization: &Parametrization,
        reduced: &Neighbourhoods<'_, '_>,
        theta: &[f64],
    ) -> Option<(Vec<Responded>, Vec<ChannelFit>)> {
        let one = |i: usize| -> Option<Responded> {
            let (modulus, of_theta) = parametrization.modulus(theta, self.omega(i))?;
            let correction = modulus - self.at[i].parameters[0].nominal;
            let (x, slope) = reduced.model(i).respond_with_slope(&self.at[i], correction).ok()?;
            Some(Responded { x, slope, of_theta })
        };
        let responses: Vec<Responded> =
            map(self.context.for_each, self.at.len(), one).into_iter().collect::<Option<_>>()?;
        let fits = (0..self.unknown.len()).map(|m| self.channel(&responses, m, theta.len())).collect();
        Some((responses, fits))
    }

    fn channel(&self, responses: &[Responded], m: usize, n: usize) -> ChannelFit {
        let unknown = self.unknown[m];
        let weight = |i: usize| self.sigma[i][m].powi(-2);
        let weighed = |part: &dyn Fn(usize, &Responded) -> f64| {
            responses.iter().enumerate().map(|(i, one)| part(i, one) * weight(i)).sum::<f64>()
        };
        let size = weighed(&|_, one| one.x[m].norm_sqr());
        let mut fit = ChannelFit {
            gain: 1.0,
            late_s: 0.0,
            gain_moved: Vec::new(),
            late_moved: Vec::new(),
            gain_information: size,
            late_information: 0.0,
        };
        if !unknown.any() || size == 0.0 {
            return fit;
        }
        let product = |i: usize, one: &Responded| one.x[m].conj() * self.band.measured[i][m];
        if unknown.delay {
            let term = |(i, one): (usize, &Responded)| (self.omega(i), product(i, one) * weight(i));
            let terms: Vec<(f64, c64)> = responses.iter().enumerate().map(term).collect();
            fit.late_s = best_delay(&terms, unknown.scale, top(self.band));
        }
        let turn = |i: usize| c64::from_polar(1.0, self.omega(i) * fit.late_s);
        if unknown.scale {
            fit.gain = weighed(&|i, one| (product(i, one) * turn(i)).re) / size;
        }
        let gain = fit.gain;
        fit.late_information = weighed(&|i, one| (self.omega(i) * gain).powi(2) * one.x[m].norm_sqr());
        let along = |j: usize, one: &Responded| one.x[m].conj() * gain * one.slope[m] * one.of_theta[j];
        if unknown.scale {
            fit.gain_moved = (0..n).map(|j| weighed(&|_, one| along(j, one).re) / size).collect();
        }
        if unknown.delay {
            // Re((−iωγx)* γ ∂x/∂θ).
            let part =
                |j: usize| weighed(&|i, one| -self.omega(i) * gain * along(j, one).im) / fit.late_information;
            fit.late_moved = (0..n).map(part).collect();
        }
        fit
    }

    /// The calibrations at a law that was fitted, γ and t each with what noise does to it directly and through the law.
    pub(super) fn calibrations_of(
        &self,
        law: &LawFit,
        reduced: &Neighbourhoods<'_, '_>,
    ) -> Option<Vec<[Calibrated; 2]>> {
        let (parametrization, theta) = law.coordinates();
        let (_, fits) = self.channels(parametrization, reduced, theta)?;
        let level = if law.sigma_known { 1.0 } else { law.reduced_chi_squared()? };
        let calibrated = |value: f64, information: f64, moved: &[f64]| {
            let through = law.covariance_of(moved, moved);
            let std = through.map(|through| (level / information + through).max(0.0).sqrt());
            Calibrated { value, std: std.filter(|std| std.is_finite()) }
        };
        let both = |fit: &ChannelFit| {
            let gain = calibrated(fit.gain, fit.gain_information, &fit.gain_moved);
            [gain, calibrated(fit.late_s, fit.late_information, &fit.late_moved)]
        };
        let usable = |fit: &ChannelFit| fit.gain.is_finite() && fit.gain != 0.0 && fit.late_s.is_finite();
        fits.iter().all(usable).then(|| fits.iter().map(both).collect())
    }
}

/// Where a fit begins: calibrations, and the factor over the nominal one whose response has the shape that was measured.
pub(super) struct Begin {
    pub(super) channels: Vec<Channel>,
    pub(super) ratio: f64,
}

/// Each frequency alone, at calibrations to begin with: right ones where they are known.
pub(super) fn at_scales<'a>(
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    reduced: &mut Option<Neighbourhoods<'a, '_>>,
    unknown: &[ChannelUnknowns],
    options: &Options,
    context: Context<'_>,
) -> (BandOutcome, Begin) {
    let right = vec![Channel::CALIBRATED; unknown.len()];
    let is_known = |unknown: &ChannelUnknowns| !unknown.any();
    if unknown.iter().all(is_known) {
        let outcome = joint::identify(band, at, reduced.as_mut(), &[], options, context);
        return (outcome, Begin { channels: right, ratio: 1.0 });
    }
    if unknown.iter().any(is_known) {
        let (outcome, found) = with_scales(band, at, reduced, unknown, options, context);
        let channels = found.map_or(right, |found| found.iter().map(Channel::of).collect());
        return (outcome, Begin { channels, ratio: 1.0 });
    }
    let shaped = reduced.as_ref().and_then(|reduced| shaped(band, at, reduced, unknown, options, context));
    let (channels, ratio) = shaped.unwrap_or((right, 1.0));
    let scaled = Scaled::new(band, &channels);
    let outcome = joint::identify(&scaled.band(band), at, reduced.as_mut(), &[], options, context);
    (outcome, Begin { channels, ratio })
}

/// Factors of the box that are tried: 2 % apart, as shapes are compared by logarithms, which resonances that miss one another by their width do not spoil.
const SHAPE_FACTORS: usize = 140;

/// Frequencies at which the shapes are compared.
const SHAPE_FREQUENCIES: usize = 300;

/// Calibrations at the factor whose response has the shape that was measured, and that factor over the nominal one.
fn shaped(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    reduced: &Neighbourhoods<'_, '_>,
    unknown: &[ChannelUnknowns],
    options: &Options,
    context: Context<'_>,
) -> Option<(Vec<Channel>, f64)> {
    let which = spread(band.frequency_hz);
    let nominal = at[at.len() / 2].parameters[0].nominal;
    let [low, high] = options
        .search_box(band.unknown, nominal)
        .filter(|[low, high]| 0.0 < *low && low < high && high.is_finite())?;
    let ratio = |k: usize| low * (high / low).powf(k as f64 / (SHAPE_FACTORS - 1) as f64) / nominal.re;
    let tried = map(context.for_each, SHAPE_FACTORS, |k| {
        let responses = which.iter().map(|&i| {
            let correction = at[i].parameters[0].nominal * (ratio(k) - 1.0);
            Some(reduced.model(i).respond_with_slope(&at[i], correction).ok()?.0)
        });
        let responses: Vec<Vec<c64>> = responses.collect::<Option<_>>()?;
        let misfits =
            unknown.iter().enumerate().map(|(m, unknown)| shape(band, &which, &responses, m, *unknown));
        Some((misfits.sum::<Option<f64>>()?, responses, ratio(k)))
    });
    let (_, responses, ratio) = tried.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let calibration = |(m, &unknown): (usize, &ChannelUnknowns)| {
        let ratios: Vec<(f64, c64)> = which
            .iter()
            .zip(&responses)
            .map(|(&i, x)| (omega_rad_s(band.frequency_hz[i]), x[m] / band.measured[i][m]))
            .collect();
        by_shape(&ratios, unknown, top(band))
    };
    let channels: Option<Vec<Channel>> = unknown.iter().enumerate().map(calibration).collect();
    Some((channels?, ratio))
}

/// Frequencies that are evenly spread over the band, wherever there are more of them: many at resonances, and shapes would have to meet there to their width.
fn spread(frequency_hz: &[f64]) -> Vec<usize> {
    let (first, last) = (frequency_hz[0], frequency_hz[frequency_hz.len() - 1]);
    let grid =
        (0..SHAPE_FREQUENCIES).map(|k| first + (last - first) * k as f64 / (SHAPE_FREQUENCIES - 1) as f64);
    let at_or_above = |f: f64| frequency_hz.partition_point(|&own| own < f).min(frequency_hz.len() - 1);
    let mut which: Vec<usize> = grid.map(at_or_above).collect();
    which.dedup();
    which
}

/// How far ln|x| − ln|u| is from its median, or from none where the scale is known, on average.
fn shape(
    band: &Band<'_>,
    which: &[usize],
    responses: &[Vec<c64>],
    m: usize,
    unknown: ChannelUnknowns,
) -> Option<f64> {
    let logs = which.iter().zip(responses).map(|(&i, x)| x[m].norm().ln() - band.measured[i][m].norm().ln());
    let logs: Vec<f64> = logs.filter(|log| log.is_finite()).collect();
    let middle = if unknown.scale { median(logs.clone())? } else { 0.0 };
    Some(logs.iter().map(|log| (log - middle).abs()).sum::<f64>() / logs.len() as f64)
}
