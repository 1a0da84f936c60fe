//! Smooth curves through scattered observations, no smoother than these say: an integrated Wiener process (the cubic smoothing spline) whose
//! curvature, and where it is not known the level of the noise, have the posterior that the marginal likelihood gives them.
//!
//! | file | contents |
//! |---|---|
//! | `process` | filter, smoother and likelihood at a given curvature |
//!
//! # Source
//! G. Wahba, J. R. Stat. Soc. B 40 (1978) 364–372, for the process behind the spline; C. F. Ansley, R. Kohn, Ann. Statist. 13 (1985) 1286–1316, for its
//! likelihood; J. E. Potter's square root, A. Andrews, AIAA J. 6 (1968) 1165–1166; H. E. Rauch, F. Tung, C. T. Striebel, AIAA J. 3 (1965) 1445–1450.

mod process;

use crate::median::median;
use process::Likelihood;
pub(crate) use process::{Curve, Observation, Process, State, roughness};

/// How many numbers were observed, and what is known of their noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Evidence {
    /// Numbers of each observation: one or two.
    pub(crate) numbers: usize,
    /// Whether the weights are the noise's own, or up to a factor.
    pub(crate) known: bool,
    /// Squares, and how many, that determine that factor beside the observations.
    pub(crate) beside: (f64, usize),
}

/// A smooth curve, its curvature and the noise averaged over their posterior.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Smoothed {
    /// Mean, and variance in units of `level` squared.
    pub(crate) curve: Curve,
    /// The likeliest curvature κ², in the same units.
    pub(crate) curvature: f64,
    /// Noise over what the weights say.
    pub(crate) level: f64,
}

/// Curvatures are a factor of e apart: their likelihood changes little over that.
const LN_CURVATURE_STEP: f64 = 1.0;

/// The least curvature moves the curve off a line, over the whole range, by a tenth of the line's own standard deviation (a Wiener process's bridge has
/// T³/192 in its middle), so that it is the same as none.
const STRAIGHT_CURVATURE: f64 = 1.0;

/// At the largest every observation stands alone: a step of the median length has a hundred times the variance of the median observation.
const LARGEST_STEP_VARIANCE: f64 = 1e2;

/// The prior of the curvature grows with its eighth root (with κ^¼), which is between one that is flat over ln κ and one that is flat over κ. With the first, curves so little
/// curved that a straight line is nearly as likely have the truth outside their bars too often (91 of 100 within two standard deviations for a sandwich at 5 % noise); with the second, straight
/// lines have bars that are too wide (all of 100, for a plate of which a few frequencies know all).
const CURVATURE_PRIOR_POWER: f64 = 0.125;

/// Posterior below this part of the largest changes no digit that counts.
const NEGLIGIBLE_POSTERIOR: f64 = 1e-4;

impl Process<'_> {
    /// The curvatures among which the posterior is.
    fn curvatures(&self, observations: &[Observation]) -> Vec<f64> {
        let observed: Vec<&Observation> = observations.iter().filter(|o| o.weight > 0.0).collect();
        let middle = |values: Vec<f64>| median(values).unwrap_or_default();
        let range = observed[observed.len() - 1].x - observed[0].x;
        let step = middle(observed.windows(2).map(|pair| pair[1].x - pair[0].x).collect()).max(1e-6 * range);
        let variance = middle(observed.iter().map(|o| 1.0 / o.weight).collect());
        let low = (STRAIGHT_CURVATURE * self.line_variance().0 / range.powi(3)).ln();
        let high = (3.0 * LARGEST_STEP_VARIANCE * variance / step.powi(3)).ln().max(low + LN_CURVATURE_STEP);
        (0..=((high - low) / LN_CURVATURE_STEP).ceil() as usize)
            .map(|k| (low + k as f64 * LN_CURVATURE_STEP).exp())
            .collect()
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
    let logs: Vec<f64> = likelihoods
        .iter()
        .zip(&curvatures)
        .map(|(l, curvature)| log(l) + CURVATURE_PRIOR_POWER * curvature.ln())
        .collect();
    let best = (0..logs.len()).max_by(|&a, &b| logs[a].total_cmp(&logs[b]))?;
    let shares: Vec<f64> = logs.iter().map(|log| (log - logs[best]).exp()).collect();
    let kept: Vec<usize> = (0..shares.len()).filter(|&k| shares[k] > NEGLIGIBLE_POSTERIOR).collect();
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
            let apart: f64 =
                (0..evidence.numbers).map(|c| (curve.states[i][0][c] - mean.states[i][0][c]).powi(2)).sum();
            // Of each number, on average.
            let between = apart / (evidence.numbers as f64 * unit);
            mean.variance[i] += share * (curve.variance[i] * squared / unit + between);
        }
    }
    Some(Smoothed { curve: mean, curvature: curvatures[best], level: unit.sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A x = b by elimination, and ln |A|.
    fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<Vec<f64>>) -> (Vec<Vec<f64>>, f64) {
        let n = a.len();
        let mut log = 0.0;
        for k in 0..n {
            log += a[k][k].ln();
            for i in k + 1..n {
                let by = a[i][k] / a[k][k];
                for rows in [&mut a, &mut b] {
                    let (above, below) = rows.split_at_mut(i);
                    below[0].iter_mut().zip(&above[k]).for_each(|(x, pivot)| *x -= by * pivot);
                }
            }
        }
        for k in (0..n).rev() {
            for j in 0..b[0].len() {
                let sum: f64 = (k + 1..n).map(|i| a[k][i] * b[i][j]).sum();
                b[k][j] = (b[k][j] - sum) / a[k][k];
            }
        }
        (b, log)
    }

    /// The smoothing spline in second differences: with y = Qᵀz the covariance of y is S = κ²R + QᵀW⁻¹Q, the curve z − W⁻¹Q S⁻¹y, its covariance W⁻¹ − W⁻¹Q S⁻¹QᵀW⁻¹
    /// (C. H. Reinsch, Numer. Math. 10 (1967) 177–183). Value and variance at each place, ln |S|, yᵀS⁻¹y.
    fn reinsch(observations: &[Observation], curvature: f64) -> (Vec<[f64; 2]>, Vec<f64>, f64, f64) {
        let n = observations.len();
        let h: Vec<f64> = observations.windows(2).map(|pair| pair[1].x - pair[0].x).collect();
        let q = |i: usize, j: usize| match i as isize - j as isize {
            0 => 1.0 / h[j],
            1 => -1.0 / h[j] - 1.0 / h[j + 1],
            2 => 1.0 / h[j + 1],
            _ => 0.0,
        };
        let r = |a: usize, b: usize| match a.abs_diff(b) {
            0 => (h[a] + h[a + 1]) / 3.0,
            1 => h[a.max(b)] / 6.0,
            _ => 0.0,
        };
        let inner = |a: usize, b: usize| {
            curvature * r(a, b) + (0..n).map(|i| q(i, a) * q(i, b) / observations[i].weight).sum::<f64>()
        };
        let s: Vec<Vec<f64>> = (0..n - 2).map(|a| (0..n - 2).map(|b| inner(a, b)).collect()).collect();
        let y = |a: usize, c: usize| (0..n).map(|i| q(i, a) * observations[i].value[c]).sum::<f64>();
        // Right-hand sides: y of both numbers, and QᵀW⁻¹ for the variances.
        let right = (0..n - 2).map(|a| {
            let mut row = vec![y(a, 0), y(a, 1)];
            row.extend((0..n).map(|i| q(i, a) / observations[i].weight));
            row
        });
        let (x, log) = solve(s, right.collect());
        let by = |i: usize, column: usize| (0..n - 2).map(|a| q(i, a) * x[a][column]).sum::<f64>();
        let value = |i: usize| [0, 1].map(|c| observations[i].value[c] - by(i, c) / observations[i].weight);
        let variance = |i: usize| (1.0 - by(i, 2 + i)) / observations[i].weight;
        let squares = (0..n - 2).map(|a| y(a, 0) * x[a][0] + y(a, 1) * x[a][1]).sum();
        ((0..n).map(value).collect(), (0..n).map(variance).collect(), log, squares)
    }

    fn scattered() -> impl Strategy<Value = Vec<Observation>> {
        let one = (0.05..1.0, -1.0..1.0, -1.0..1.0, -2.0..2.0);
        prop::collection::vec(one, 4..14).prop_map(|all| {
            let mut x = 0.0;
            let place = |(step, a, b, weight): (f64, f64, f64, f64)| {
                x += step;
                Observation { x, value: [a, b], weight: weight.exp() }
            };
            all.into_iter().map(place).collect()
        })
    }

    proptest! {
        #[test]
        fn the_curve_is_the_smoothing_spline(all in scattered(), log_curvature in -8.0..8.0f64) {
            let process = Process::new(&all).unwrap();
            let curvature = log_curvature.exp();
            let curve = process.smooth(curvature);
            let (value, variance, log, squares) = reinsch(&all, curvature);
            // The finite first variance is 1e-10 of what there is, times the ratio of the first state's variance (up to κ²h of its slope) to the line's: 1e5 or so here.
            for i in 0..all.len() {
                for (own, expected) in curve.states[i][0].iter().zip(value[i]) {
                    prop_assert!((own - expected).abs() < 1e-4);
                }
                prop_assert!((curve.variance[i] - variance[i]).abs() < 1e-4 * (1.0 + variance[i]));
            }
            // The likelihood is known up to what does not depend on the curvature.
            let other = process.likelihood(4.0 * curvature);
            let own = process.likelihood(curvature);
            let (.., other_log, other_squares) = reinsch(&all, 4.0 * curvature);
            let change = other.log_determinant - own.log_determinant - (other_log - log);
            prop_assert!(change.abs() < 1e-4, "{change}");
            prop_assert!((own.squares - squares).abs() < 1e-4 * (1.0 + squares));
            prop_assert!((other.squares - other_squares).abs() < 1e-4 * (1.0 + other_squares));
        }

        #[test]
        fn with_a_large_curvature_every_observation_stands_alone(all in scattered()) {
            let curve = Process::new(&all).unwrap().smooth(1e14);
            for (i, o) in all.iter().enumerate() {
                // The neighbours' pull is 1/(κ²h³w) or so: 1e-14 · 8000 · 8.
                prop_assert!((0..2).all(|c| (curve.states[i][0][c] - o.value[c]).abs() < 1e-6));
                prop_assert!((curve.variance[i] * o.weight - 1.0).abs() < 1e-6);
            }
        }

        #[test]
        fn a_straight_line_is_kept_whatever_the_weights(mut all in scattered(), slope in -2.0..2.0f64) {
            for o in &mut all {
                o.value = [1.0 + slope * o.x, -slope * o.x];
            }
            let found = smooth(&all, Evidence { numbers: 2, known: true, beside: (0.0, 0) }).unwrap();
            for (state, o) in found.curve.states.iter().zip(&all) {
                prop_assert!((0..2).all(|c| (state[0][c] - o.value[c]).abs() < 1e-6), "{:?} {o:?}", state);
                prop_assert!((state[1][0] - slope).abs() < 1e-6);
            }
        }

        /// Places without an observation change nothing at the others, and have the wider bars the farther they are.
        #[test]
        fn places_without_an_observation_are_bridged(all in scattered(), k in 0usize..3) {
            let (a, b) = (all[k], all[k + 1]);
            let between = |part: f64| Observation { x: a.x + part * (b.x - a.x), value: [9.0, 9.0], weight: 0.0 };
            let mut more = all.clone();
            more.splice(k + 1..k + 1, [0.25, 0.5].map(between));
            let evidence = Evidence { numbers: 2, known: true, beside: (0.0, 0) };
            let (own, bridged) = (smooth(&all, evidence).unwrap(), smooth(&more, evidence).unwrap());
            for i in 0..all.len() {
                let j = if i > k { i + 2 } else { i };
                prop_assert!((own.curve.states[i][0][0] - bridged.curve.states[j][0][0]).abs() < 1e-6);
                prop_assert!((own.curve.variance[i] - bridged.curve.variance[j]).abs() < 1e-5 * (1.0 + own.curve.variance[i]));
            }
            prop_assert!(bridged.curve.variance[k + 1] > 0.0);
            // Halfway the process has gained h³/192 of curvature that no observation has seen.
            let curve = Process::new(&more).unwrap().smooth(1e10);
            prop_assert!(curve.variance[k + 2] > curve.variance[k + 1]);
        }
    }

    #[test]
    fn fewer_than_three_observations_are_no_curve() {
        let at = |x: f64, weight: f64| Observation { x, value: [x, 0.0], weight };
        let evidence = Evidence { numbers: 2, known: true, beside: (0.0, 0) };
        assert_eq!(smooth(&[at(0.0, 1.0), at(1.0, 0.0), at(2.0, 1.0), at(3.0, 0.0)], evidence), None);
        assert!(smooth(&[at(0.0, 1.0), at(1.0, 0.0), at(2.0, 1.0), at(3.0, 2.0)], evidence).is_some());
    }
}
