//! Smooth curves through scattered observations, no smoother than these say: an integrated Wiener process (the cubic smoothing spline) whose
//! curvature, and where it is not known the level of the noise, have the posterior that the marginal likelihood gives them.
//!
//! | file | what is in it |
//! |---|---|
//! | `process` | filter, smoother and likelihood at a given curvature |
//!
//! # Source
//! G. Wahba, J. R. Stat. Soc. B 40 (1978) 364–372, for the process behind the spline; C. F. Ansley, R. Kohn, Ann. Statist. 13 (1985) 1286–1316, for its
//! likelihood; J. E. Potter's square root, A. Andrews, AIAA J. 6 (1968) 1165–1166; H. E. Rauch, F. Tung, C. T. Striebel, AIAA J. 3 (1965) 1445–1450.

mod process;

use process::Likelihood;
pub(crate) use process::{Curve, Observation, Process, State, roughness};

/// How many numbers were observed, and what is known of their noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Evidence {
    /// Numbers of each observation: one or two.
    pub(crate) numbers: usize,
    /// Whether the weights are the noise's own, or up to a factor.
    pub(crate) known: bool,
    /// Squares, and how many, that tell of that factor beside the observations.
    pub(crate) beside: (f64, usize),
}

/// A smooth curve, its curvature and the noise averaged over their posterior.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Smoothed {
    /// Mean, and variance in units of `level` squared.
    pub(crate) curve: Curve,
    /// The likeliest curvature, in the same units.
    pub(crate) curvature: f64,
    /// Noise over what the weights say.
    pub(crate) level: f64,
}

/// Curvatures are a factor of e apart: their likelihood changes little over that.
const STEP: f64 = 1.0;

/// The least curvature moves the curve off a line, over the whole range, by a tenth of the line's own deviation (a Wiener process's bridge has
/// T³/192 in its middle), so that it cannot be told from none.
const STRAIGHT: f64 = 1.0;

/// At the largest every observation stands alone: a step of the median length has a hundred times the variance of the median observation.
const ALONE: f64 = 1e2;

/// Posterior below this part of the largest changes no digit that counts.
const NEGLIGIBLE: f64 = 1e-4;

impl Process<'_> {
    /// The curvatures among which the posterior is.
    fn curvatures(&self, observations: &[Observation]) -> Vec<f64> {
        let told: Vec<&Observation> = observations.iter().filter(|o| o.weight > 0.0).collect();
        let middle = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        let range = told[told.len() - 1].x - told[0].x;
        let step = middle(told.windows(2).map(|pair| pair[1].x - pair[0].x).collect()).max(1e-6 * range);
        let variance = middle(told.iter().map(|o| 1.0 / o.weight).collect());
        let low = (STRAIGHT * self.line_variance().0 / range.powi(3)).ln();
        let high = (3.0 * ALONE * variance / step.powi(3)).ln().max(low + STEP);
        (0..=((high - low) / STEP).ceil() as usize).map(|k| (low + k as f64 * STEP).exp()).collect()
    }
}

/// The smooth curve through some observations; `None` with fewer than three that have a weight.
pub(crate) fn smooth(observations: &[Observation], evidence: Evidence) -> Option<Smoothed> {
    let count = observations.iter().filter(|o| o.weight > 0.0).count();
    let process = Process::new(observations).filter(|_| count > 2)?;
    // Level and slope of the line cost two each.
    let freedom = (evidence.beside.1 + evidence.numbers * (count - 2)) as f64;
    let level = |l: &Likelihood| ((evidence.beside.0 + l.squares) / freedom).sqrt().max(f64::MIN_POSITIVE);
    let curvatures = process.curvatures(observations);
    let likelihoods: Vec<Likelihood> = curvatures.iter().map(|&q| process.likelihood(q)).collect();
    let log = |l: &Likelihood| {
        let rest = if evidence.known { l.squares } else { 2.0 * freedom * level(l).ln() };
        -0.5 * (evidence.numbers as f64 * l.log_determinant + rest)
    };
    let logs: Vec<f64> = likelihoods.iter().map(log).collect();
    let best = (0..logs.len()).max_by(|&a, &b| logs[a].total_cmp(&logs[b]))?;
    let shares: Vec<f64> = logs.iter().map(|log| (log - logs[best]).exp()).collect();
    let kept: Vec<usize> = (0..shares.len()).filter(|&k| shares[k] > NEGLIGIBLE).collect();
    let total: f64 = kept.iter().map(|&k| shares[k]).sum();
    let squared = |k: usize| if evidence.known { 1.0 } else { level(&likelihoods[k]).powi(2) };
    let curves: Vec<(f64, f64, Curve)> =
        kept.iter().map(|&k| (shares[k] / total, squared(k), process.smooth(curvatures[k]))).collect();
    let unit: f64 = curves.iter().map(|(share, squared, _)| share * squared).sum();
    let n = observations.len();
    let mut mean = Curve { states: vec![[[0.0; 2]; 2]; n], variance: vec![0.0; n] };
    for (share, _, curve) in &curves {
        for (sum, state) in mean.states.iter_mut().zip(&curve.states) {
            for d in 0..2 {
                for c in 0..2 {
                    sum[d][c] += share * state[d][c];
                }
            }
        }
    }
    for (share, squared, curve) in &curves {
        for i in 0..n {
            let apart: f64 = (0..evidence.numbers).map(|c| (curve.states[i][0][c] - mean.states[i][0][c]).powi(2)).sum();
            // Of each number, on average.
            let between = apart / (evidence.numbers as f64 * unit);
            mean.variance[i] += share * (curve.variance[i] * squared / unit + between);
        }
    }
    Some(Smoothed { curve: mean, curvature: curvatures[best], level: unit.sqrt() })
}
