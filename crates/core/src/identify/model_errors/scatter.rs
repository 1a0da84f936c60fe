//! The evidence of a right model whose unknowns scatter from line to line about smooth curves.

use super::band_search::Search;
use super::fit::Explained;
use super::measured::{MIN_NOISE_OVER_RESPONSE, Measured};
use crate::c64;
use frfit_linalg::dense::Cholesky;

/// By how much unknowns may scatter: standard deviations of ln p.
const SCATTER_STDS: [f64; 7] = [1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3];

/// By how much a modulus that is not causal has to explain a band better than a causal one or errors of the model, which are far more common.
const ACAUSAL_NATS: f64 = 50.0;

/// What a line says of the unknowns that have a value of their own there.
struct LineEstimate {
    line: usize,
    /// What the best values leave of the sensors.
    misfit: f64,
    /// Of each unknown: its value, and the relative standard deviation of that.
    unknowns: Vec<(c64, f64)>,
}

impl Measured<'_, '_> {
    /// −2 ln of the evidence of smooth unknowns that scatter from line to line, as [`Explained::evidence`] counts it; `None` where most lines say nothing, or no
    /// unknown has a value of its own. `level` is that of the noise where one sensor cannot show it.
    ///
    /// ln p of a line is the curve's with the variances of noise and scatter, v = s² + τ². With A = Σ Re(g gᴴ)/v + P, the precision P of the curves and the
    /// residuals r at θ, linear least squares have
    /// $$ \sum \ln \frac{v^2}{s^4} + \sum \frac{|r|^2}{v} - b^T A^{-1} b + \theta^T P \theta + \ln \det A - \ln \det P, \quad b = \sum \operatorname{Re} \frac{\bar g r}{v} - P \theta $$
    /// beside the misfit of the separate lines. Without scatter that is a right model. Where several sensors speak the curves need not be causal.
    pub(super) fn scattered(&self, search: &Search<'_, '_>, right: &Explained, level: f64) -> Option<f64> {
        let lines = &search.lines;
        if self.own.is_empty() {
            return None;
        }
        let estimates: Vec<LineEstimate> =
            lines.iter().filter_map(|&i| self.line_estimate(search, i)).collect();
        if 2 * estimates.len() < lines.len() {
            return None;
        }
        // Lines that say nothing are as good as those that do.
        let share = lines.len() as f64 / estimates.len() as f64;
        let misfit = share * estimates.iter().map(|one| one.misfit).sum::<f64>();
        let free = self.numbers(lines) as f64 - 2.0 * (self.own.len() * lines.len()) as f64;
        let own = match self.known() {
            true => 1.0,
            false if free > 0.0 => (misfit / free).sqrt().clamp(MIN_NOISE_OVER_RESPONSE, level),
            false => level,
        };
        let logs = self.noise_at(lines, own, 0.0).log_determinant();
        let at_own = own / self.level_per_frequency.unwrap_or(own);
        let least = |prior: Vec<f64>| {
            let of = |s: f64| self.about_curves((search, right), &estimates, (share, at_own), &prior, s);
            SCATTER_STDS.into_iter().filter_map(of).fold(f64::INFINITY, f64::min)
        };
        let mut least_of_all = least(search.curves.precision(search.centre, right.sizes.bend));
        if free > 0.0 {
            let acausal = least(search.curves.smoothness(right.sizes.bend));
            least_of_all = least_of_all.min(acausal + 2.0 * ACAUSAL_NATS);
        }
        Some(logs + misfit / (own * own) + least_of_all)
    }

    fn line_estimate(&self, search: &Search<'_, '_>, line: usize) -> Option<LineEstimate> {
        let own = &self.free[line];
        let sigma = match self.known() {
            true => self.sigma_at(&[line], 1.0, 0.0).concat(),
            false => self.sigma[line].clone(),
        };
        let shown = search.curves.shown(search.centre, self.omegas[line], &own.updated_response);
        let each = shown.iter().zip(&self.measured[line]).zip(&sigma);
        let unknown = |&j: &usize| {
            let value = own.values[j].value.filter(|value| own.on_path && value.re > 0.0)?;
            Some((value, own.values[j].uncertainty?.storage_std / value.norm()))
        };
        Some(LineEstimate {
            line,
            misfit: each.map(|((x, u), sigma)| (u - x).norm_sqr() / (sigma * sigma)).sum(),
            unknowns: self.own.iter().map(unknown).collect::<Option<_>>()?,
        })
    }

    /// The part of the curves and of the scatter about them. Each line counts as `share` lines, its noise is `level` times the assumed noise.
    fn about_curves(
        &self,
        (search, right): (&Search<'_, '_>, &Explained),
        estimates: &[LineEstimate],
        (share, level): (f64, f64),
        prior: &[f64],
        scatter: f64,
    ) -> Option<f64> {
        let Search { curves, centre, .. } = *search;
        let n = curves.count();
        let theta = &right.found.place[..n];
        let off: Vec<f64> = theta.iter().zip(centre).map(|(t, c)| t - c).collect();
        let pull: Vec<f64> =
            prior.chunks_exact(n).map(|row| row.iter().zip(&off).map(|(p, o)| p * o).sum()).collect();
        let mut sum: f64 = pull.iter().zip(&off).map(|(p, o)| p * o).sum();
        let mut gradient: Vec<f64> = pull.iter().map(|p| -p).collect();
        let mut matrix = prior.to_vec();
        for one in estimates {
            let (values, slopes) = curves.values(theta, one.line, self.omegas[one.line])?;
            for (&j, &(value, std)) in self.own.iter().zip(&one.unknowns) {
                let noise = (std * level).powi(2);
                let both = noise + scatter * scatter;
                let rest = (value / values[j]).ln();
                sum += share * (2.0 * (both / noise).ln() + rest.norm_sqr() / both);
                // ∂ ln p/∂θ, where it is not zero.
                let of_own = slopes.iter().enumerate().filter(|(_, (unknown, _))| *unknown == j);
                let of_log: Vec<(usize, c64)> =
                    of_own.map(|(a, (_, slope))| (a, slope / values[j])).collect();
                for &(a, x) in &of_log {
                    gradient[a] += share * (x.re * rest.re + x.im * rest.im) / both;
                    for &(b, y) in &of_log {
                        matrix[a * n + b] += share * (x.re * y.re + x.im * y.im) / both;
                    }
                }
            }
        }
        let factor = Cholesky::new(n, &matrix).ok()?;
        let mut step = gradient.clone();
        factor.solve(&mut step);
        let gained: f64 = gradient.iter().zip(&step).map(|(g, s)| g * s).sum();
        let of_prior = Cholesky::new(n, prior).ok()?.log_determinant();
        let of_channels = self.channel_volume(search, right, prior)?;
        Some(sum - gained + factor.log_determinant() - of_prior + of_channels)
    }

    /// What scales and delays of channels cost, by how well a right model has them: lines that scatter know them no better.
    fn channel_volume(&self, search: &Search<'_, '_>, right: &Explained, prior: &[f64]) -> Option<f64> {
        let (n, of_unknowns) = (search.curves.count(), search.curves.of_unknowns());
        let all = right.found.place.len();
        let whole = |i: usize, j: usize| right.found.normal.information[i * all + j] + prior[i * n + j];
        let volume = |m: usize| -> Option<f64> {
            let block: Vec<f64> = (0..m * m).map(|k| whole(k / m, k % m)).collect();
            Some(Cholesky::new(m, &block).ok()?.log_determinant())
        };
        let of_prior: f64 = (of_unknowns..n).map(|i| prior[i * n + i].ln()).sum();
        Some(volume(n)? - volume(of_unknowns)? - of_prior)
    }
}
