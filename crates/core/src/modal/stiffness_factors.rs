//! Stiffnesses and loss factors by pairs of modes.

use super::pairing::LOG_FREQUENCY_STD;
use frfit_linalg::dense::Cholesky;

/// By how much one unknown may be off beside all of them, in its logarithm.
pub(crate) const LOG_FACTOR_STD: f64 = 0.5;

/// Student's degrees of freedom of the differences of partners: a few pairs may be wrong. How often their weights are found.
const DEGREES_OF_FREEDOM: f64 = 4.0;
const WEIGHT_ROUNDS: usize = 4;

/// ln of the factor on each unknown stiffness beside the one that all have in common, `common` in its logarithm, and the standard deviations. A pair has the shares of the unknowns in the
/// strain energy of its mode, and ln of the measured natural frequency over that of the model.
///
/// By Rayleigh's quotient a stiffness with the share w of the strain energy of a mode changes 2 ln ω by w of the change of its logarithm. `None` without pairs.
pub(crate) fn stiffness_factors<'p>(
    pairs: impl Iterator<Item = (&'p [f64], f64)> + Clone,
    common: f64,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let rest = |(shares, log_ratio): (&[f64], f64)| 2.0 * log_ratio - common * shares.iter().sum::<f64>();
    let rests: Vec<f64> = pairs.clone().map(rest).collect();
    by_shares(pairs.map(|(shares, _)| shares), &rests, [2.0 * LOG_FREQUENCY_STD, LOG_FACTOR_STD])
}

/// x with least Σ (r − Σ w x)²/s² + Σ x²/t², of pairs with shares w, whose rests r have Student's distribution, and the standard deviations of x. s and t are standard deviations.
/// `None` without pairs.
pub(crate) fn by_shares<'p>(
    shares: impl Iterator<Item = &'p [f64]> + Clone,
    rests: &[f64],
    [s, t]: [f64; 2],
) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = shares.clone().next()?.len();
    let (mut x, mut stds) = (vec![0.0; n], vec![t; n]);
    for _ in 0..WEIGHT_ROUNDS {
        let mut matrix = vec![0.0; n * n];
        (0..n).for_each(|i| matrix[i * n + i] = 1.0 / (t * t));
        let mut right = vec![0.0; n];
        for (shares, rest) in shares.clone().zip(rests) {
            let off = (rest - shares.iter().zip(&x).map(|(w, x)| w * x).sum::<f64>()) / s;
            let weight = (DEGREES_OF_FREEDOM + 1.0) / (DEGREES_OF_FREEDOM + off * off) / (s * s);
            for i in 0..n {
                right[i] += weight * shares[i] * rest;
                (0..n).for_each(|j| matrix[i * n + j] += weight * shares[i] * shares[j]);
            }
        }
        let factor = Cholesky::new(n, &matrix).ok()?;
        factor.solve(&mut right);
        x = right;
        stds = factor.inverse().iter().step_by(n + 1).map(|variance| variance.sqrt()).collect();
    }
    Some((x, stds))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two unknowns are off by different factors, and one of seven pairs is wrong: it is as if it were not there.
    #[test]
    fn unknowns_are_moved_apart_by_their_pairs() {
        let truth = [0.2, -0.3];
        let shares: [[f64; 2]; 7] = [0.9, 0.1, 0.5, 0.7, 0.3, 0.6, 0.4].map(|share| [share, 1.0 - share]);
        let right = |shares: &[f64; 2]| shares.iter().zip(truth).map(|(w, x)| w * x).sum();
        let mut rests: Vec<f64> = shares.iter().map(right).collect();
        rests[2] += 0.4;
        let (found, stds) = by_shares(shares.iter().map(|one| &one[..]), &rests, [0.04, 0.5]).unwrap();
        assert!(stds.iter().all(|std| (0.02..0.06).contains(std)), "{stds:?}");
        let off = found.iter().zip(truth).map(|(x, truth)| (x - truth).abs()).fold(0.0, f64::max);
        assert!(off < 0.02, "{found:?}");
    }
}
