//! Unknown scales beside a law: eliminated from the least squares, and where they begin.

use super::joint;
use super::laws::Fitting;
use super::scale::{Scale, Scaled, with_scales};
use super::space::{Space, thinned};
use super::{Band, BandOutcome, Hooks};
use crate::c64;
use crate::for_each::map;
use crate::identify::Options;
use crate::laws::{Chart, LawFit};
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
    /// γ at which Σ |u − γx|²/σ² over the band is least; one where the scale is known.
    pub(super) gain: f64,
    /// −∂γ/∂θ_j as far as residuals do not matter: what of γ ∂x/∂θ_j is along x. None where the scale is known.
    pub(super) moved: Vec<f64>,
    /// Σ |x|²/σ².
    size: f64,
}

impl Fitting<'_, '_> {
    /// Responses over the band at θ, and the best gain of each channel of unknown scale.
    pub(super) fn channels(
        &self,
        chart: &Chart,
        space: &Space<'_, '_>,
        theta: &[f64],
    ) -> Option<(Vec<Responded>, Vec<ChannelFit>)> {
        let one = |i: usize| -> Option<Responded> {
            let (modulus, of_theta) = chart.modulus(theta, self.omega(i))?;
            let correction = modulus - self.at[i].parameters[0].nominal;
            let (x, slope) = space.model(i).respond_with_slope(&self.at[i], correction).ok()?;
            Some(Responded { x, slope, of_theta })
        };
        let responses: Vec<Responded> =
            map(self.hooks.for_each, self.at.len(), one).into_iter().collect::<Option<_>>()?;
        let fits = (0..self.unknown.len()).map(|m| self.channel(&responses, m, theta.len())).collect();
        Some((responses, fits))
    }

    fn channel(&self, responses: &[Responded], m: usize, n: usize) -> ChannelFit {
        let weighed = |part: &dyn Fn(usize, &Responded) -> f64| {
            let terms = responses.iter().enumerate();
            terms.map(|(i, one)| part(i, one) / self.sigma[i][m].powi(2)).sum::<f64>()
        };
        let size = weighed(&|_, one| one.x[m].norm_sqr());
        if !self.unknown[m] || size == 0.0 {
            return ChannelFit { gain: 1.0, moved: Vec::new(), size };
        }
        let gain = weighed(&|i, one| (one.x[m].conj() * self.band.measured[i][m]).re) / size;
        let along =
            |j: usize| weighed(&|_, one| (one.x[m].conj() * gain * one.slope[m] * one.of_theta[j]).re) / size;
        ChannelFit { gain, moved: (0..n).map(along).collect(), size }
    }

    /// The gains at a law that was fitted, with what noise does to them directly and through the law.
    pub(super) fn gains_of(&self, law: &LawFit, space: &Space<'_, '_>) -> Option<Vec<Scale>> {
        let (chart, theta) = law.coordinates();
        let (_, fits) = self.channels(chart, space, theta)?;
        let level = if law.sigma_known { 1.0 } else { law.reduced_chi_squared()? };
        let told = |fit: &ChannelFit| {
            let through = law.covariance_of(&fit.moved, &fit.moved);
            let std = through.map(|through| (level / fit.size + through).max(0.0).sqrt());
            Scale { value: fit.gain, std: std.filter(|std| std.is_finite()) }
        };
        let gains: Vec<Scale> = fits.iter().map(told).collect();
        gains.iter().all(|gain| gain.value.is_finite() && gain.value != 0.0).then_some(gains)
    }
}

/// Each frequency by itself, at scales to begin with: one where they are known.
pub(super) fn at_scales<'a, 'o>(
    band: &Band<'a>,
    at: &'o [ModelAt<'a>],
    unknown: &[bool],
    options: &'o Options,
    hooks: Hooks<'_>,
) -> (BandOutcome, (Option<Space<'a, 'o>>, Vec<f64>)) {
    let mut space = super::space(band, at, options, hooks);
    let ones = vec![1.0; unknown.len()];
    if !unknown.contains(&true) {
        return (joint::identify(band, at, &mut space, &[], options, hooks), (space, ones));
    }
    if unknown.contains(&false) {
        let (outcome, scales) = with_scales(band, at, &mut space, unknown, options, hooks);
        let found = scales.iter().all(|scale| scale.is_none_or(|scale| scale.value.is_finite()));
        let scales = scales.iter().map(|scale| scale.filter(|_| found).map_or(1.0, |scale| scale.value));
        return (outcome, (space, scales.collect()));
    }
    let scales = space.as_ref().and_then(|space| shaped(band, at, space, options, hooks)).unwrap_or(ones);
    let scaled = Scaled::new(band, &scales);
    let outcome = joint::identify(&scaled.band(band), at, &mut space, &[], options, hooks);
    (outcome, (space, scales))
}

/// Factors of the box that are tried: 2 % apart, as shapes are told by logarithms, which resonances that miss one another by their width do not spoil.
const FACTORS: usize = 140;

/// Frequencies at which the shapes are compared.
const FREQUENCIES: usize = 300;

/// Scales at the factor whose response has the shape that was measured.
fn shaped(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    space: &Space<'_, '_>,
    options: &Options,
    hooks: Hooks<'_>,
) -> Option<Vec<f64>> {
    let all: Vec<usize> = (0..at.len()).collect();
    let which: Vec<usize> = thinned(&all, FREQUENCIES).copied().collect();
    let nominal = at[at.len() / 2].parameters[0].nominal;
    let [low, high] =
        options.box_about(nominal).filter(|[low, high]| 0.0 < *low && low < high && high.is_finite())?;
    let ratio = |k: usize| low * (high / low).powf(k as f64 / (FACTORS - 1) as f64) / nominal.re;
    let tried = map(hooks.for_each, FACTORS, |k| {
        let responses = which.iter().map(|&i| {
            let correction = at[i].parameters[0].nominal * (ratio(k) - 1.0);
            Some(space.model(i).respond_with_slope(&at[i], correction).ok()?.0)
        });
        let responses: Vec<Vec<c64>> = responses.collect::<Option<_>>()?;
        let sensors = 0..band.experiment.sensors.len();
        let fits = sensors.map(|m| shape(band, &which, &responses, m)).collect::<Option<Vec<_>>>()?;
        Some((fits.iter().map(|(misfit, _)| misfit).sum::<f64>(), fits))
    });
    let best = tried.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(best.1.into_iter().map(|(_, scale)| scale).collect())
}

/// How far ln|x| − ln|u| is from its median, on average, and the scale that the median is.
fn shape(band: &Band<'_>, which: &[usize], responses: &[Vec<c64>], m: usize) -> Option<(f64, f64)> {
    let pairs = || which.iter().zip(responses).map(|(&i, x)| (band.measured[i][m], x[m]));
    let logs = pairs().map(|(u, x)| x.norm().ln() - u.norm().ln());
    let logs: Vec<f64> = logs.filter(|log| log.is_finite()).collect();
    let median = median(logs.clone())?;
    let misfit = logs.iter().map(|log| (log - median).abs()).sum::<f64>() / logs.len() as f64;
    // The sense in which most of them move.
    let same = pairs().filter(|(u, x)| (u.conj() * x).re > 0.0).count();
    let sense = if 2 * same >= which.len() { 1.0 } else { -1.0 };
    Some((misfit, sense * median.exp()))
}
