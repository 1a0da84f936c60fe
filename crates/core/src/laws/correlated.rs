//! What a law leaves is not always noise: neighbouring lines that leave the same carry less information than independent ones.
//!
//! What a line k leaves of ln E beside the law is taken for the sum of noise that is its own, as large as the weights say times s, and a deviation
//! δ that the lines share, of the size τ and the correlation φ^{|k−l|}:
//! $$ d_k = \delta_k + e_k, \qquad \mathrm E\\,\delta_k \delta_l = \tau^2 \varphi^{|k-l|}, \qquad \mathrm E\\,e_k^2 = s^2/w_k. $$
//! s, τ and φ are the likeliest (Kalman's filter gives the likelihood); θ̂ remains that of least squares, and its covariance becomes
//! $$ \mathrm{Cov}\\,\theta = \sigma^2 H^{-1} + H^{-1} \Big( \sum_{kl} a_k \\, \tau^2 \varphi^{|k-l|} a_l^T \Big) H^{-1}, \qquad H = J^T J, \quad a_k = J_k^T \\, \partial r_k/\partial\delta_k. $$
//!
//! # Source
//! The sandwich of correlated scores: W. K. Newey, K. D. West, Econometrica 55 (1987) 703–708; a model's own error as a process:
//! M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63 (2001) 425–464.

/// One line of the data: a frequency of a band, or a row of a table. Each of the two numbers of ln E is treated separately.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LineResidual {
    /// Inverse variance of the line, up to the common factor s².
    pub(crate) weight: [f64; 2],
    /// What the law leaves, d.
    pub(crate) rest: [f64; 2],
    /// a: how a deviation there pulls the coordinates, before H⁻¹.
    pub(crate) pull: [Vec<f64>; 2],
}

/// Residuals that neighbouring lines share.
#[derive(Debug, Clone, PartialEq)]
pub struct Correlated {
    /// Over so many lines: −1/ln φ, at which the correlation has fallen to 1/e.
    pub lines: f64,
    /// τ: the size of what they share, relative to the modulus.
    pub size: f64,
    /// By how much the standard deviation of each parameter is wider than it would be without; `None` where that is not identifiable.
    pub widened: Vec<Option<f64>>,
}

/// The likeliest correlation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Process {
    /// φ.
    pub(super) persistence: f64,
    /// τ².
    pub(super) variance: f64,
}

/// Twice the logarithm of the likelihoods' ratio that two more numbers have to gain: noise alone does so once in a hundred times or less.
const MIN_LOG_LIKELIHOOD_GAIN: f64 = 10.0;

/// τ² is searched as far as this below and above the variance of the separate lines, in steps of a factor of two.
const MIN_VARIANCE_RATIO: f64 = 1e-4;
const MAX_VARIANCE_RATIO: f64 = 1e6;

/// Lines from which on a correlation may be estimated.
const MIN_LINES: usize = 12;

/// The likeliest correlation of what lines leave; `None` where noise of their own explains it as well.
pub(super) fn correlation(lines: &[LineResidual]) -> Option<Process> {
    let known: Vec<(usize, [f64; 2], [f64; 2])> = (lines.iter().enumerate())
        .filter(|(_, line)| line.weight.iter().all(|w| w.is_finite() && *w > 0.0))
        .filter(|(_, line)| line.rest.iter().all(|d| d.is_finite()))
        .map(|(k, line)| (k, line.weight, line.rest))
        .collect();
    if known.len() < MIN_LINES {
        return None;
    }
    let mut variances: Vec<f64> = known.iter().map(|(_, weight, _)| 1.0 / weight[0]).collect();
    variances.sort_by(f64::total_cmp);
    let usual = variances[variances.len() / 2];
    let (without, _) = deviance(&known, 0.0, 0.0);
    let mut best = (without - MIN_LOG_LIKELIHOOD_GAIN, None);
    let mut length = 1f64;
    while length <= known.len() as f64 {
        let persistence = (-1.0 / length).exp();
        let mut ratio = MIN_VARIANCE_RATIO * usual;
        while ratio <= MAX_VARIANCE_RATIO * usual {
            let (deviance, level) = deviance(&known, persistence, ratio);
            if deviance < best.0 {
                best = (deviance, Some(Process { persistence, variance: level * ratio }));
            }
            ratio *= 2.0;
        }
        length *= 2f64.sqrt();
    }
    best.1
}

/// −2 ln of the likelihood at its likeliest s², up to a constant, and that s²; `ratio` is τ²/s².
fn deviance(lines: &[(usize, [f64; 2], [f64; 2])], persistence: f64, ratio: f64) -> (f64, f64) {
    let (mut squares, mut log) = (0.0, 0.0);
    for c in 0..2 {
        let (mut mean, mut variance, mut before) = (0.0, ratio, lines[0].0);
        for (k, weight, rest) in lines {
            let kept = persistence.powi((k - before) as i32);
            (mean, variance) = (kept * mean, kept * kept * variance + (1.0 - kept * kept) * ratio);
            let whole = variance + 1.0 / weight[c];
            let innovation = rest[c] - mean;
            squares += innovation * innovation / whole;
            log += (whole * weight[c]).ln();
            let gain = variance / whole;
            (mean, variance, before) = (mean + gain * innovation, (1.0 - gain) * variance, *k);
        }
    }
    let count = 2.0 * lines.len() as f64;
    let level = (squares / count).max(f64::MIN_POSITIVE);
    (log + count * level.ln(), level)
}

/// Σ z_k τ²φ^{|k−l|} z_lᵀ of both numbers with z = H⁻¹a: what the shared deviation makes of the covariance.
pub(super) fn shared_covariance(
    lines: &[LineResidual],
    process: Process,
    inverse: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let n = inverse.len();
    // Coordinates on which no residual depends have no finite row, and no pull.
    let product = |row: &[f64], pull: &[f64]| -> f64 {
        row.iter().zip(pull).filter(|(h, a)| h.is_finite() && a.is_finite()).map(|(h, a)| h * a).sum()
    };
    let mut sum = vec![vec![0.0; n]; n];
    for c in 0..2 {
        let mut behind = vec![0.0; n];
        for line in lines {
            behind.iter_mut().for_each(|b| *b *= process.persistence);
            let own: Vec<f64> = inverse.iter().map(|row| product(row, &line.pull[c])).collect();
            for (i, row) in sum.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += own[i] * own[j] + own[i] * behind[j] + behind[i] * own[j];
                }
            }
            behind.iter_mut().zip(&own).for_each(|(b, own)| *b += own);
        }
    }
    sum.iter_mut().flatten().for_each(|entry| *entry *= process.variance);
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(rest: impl Fn(usize) -> f64, count: usize) -> Vec<LineResidual> {
        let line = |k: usize| LineResidual {
            weight: [4.0; 2],
            rest: [rest(2 * k), rest(2 * k + 1)],
            pull: [vec![1.0], vec![0.0]],
        };
        (0..count).map(line).collect()
    }

    /// Two numbers in ±√3 that fill the interval evenly.
    fn even(k: usize) -> f64 {
        3f64.sqrt() * (2.0 * ((k + 1) as f64 * 0.754_877_666_246_692_7).fract() - 1.0)
    }

    #[test]
    fn noise_of_each_line_is_not_correlated_and_a_wave_is() {
        assert_eq!(correlation(&lines(|k| 0.5 * even(k), 200)), None);
        assert_eq!(correlation(&lines(|k| 0.5 * even(k), MIN_LINES - 1)), None);
        let wave = lines(|k| 0.05 * even(k) + (k as f64 / 40.0).sin(), 200);
        let found = correlation(&wave).unwrap();
        let length = -1.0 / found.persistence.ln();
        // A wave of 126 lines, of which a sixth is alike.
        assert!((8.0..200.0).contains(&length), "{length}");
        assert!((0.1..10.0).contains(&found.variance), "{found:?}");
    }

    #[test]
    fn the_sum_over_pairs_is_that_of_the_pairs() {
        let all = lines(|_| 0.0, 7);
        let process = Process { persistence: 0.6, variance: 2.0 };
        let found = shared_covariance(&all, process, &[vec![0.5]]);
        let pairs = (0..7).flat_map(|k| (0..7usize).map(move |l| 0.6f64.powi(l.abs_diff(k) as i32)));
        let expected = 0.25 * 2.0 * pairs.sum::<f64>();
        assert!((found[0][0] - expected).abs() < 1e-12 * expected, "{found:?} {expected}");
    }
}
