//! The noise of measured responses, whatever the model: what a rational function leaves of a few neighbouring lines.
//!
//! About each line, with t from −1 to 1 over its neighbourhood,
//! $$ H(t) \approx \frac{a_0 + a_1 t + a_2 t^2}{1 + b_1 t + b_2 t^2} $$
//! two resonances at the most, wherever they are and however narrow. The residual is noise, which differs from line to line.
//!
//! # Source
//! T. McKelvey, G. Guérin, Non-parametric frequency response estimation using a local rational model, IFAC Proc. Vol. 45(16) (2012) 49–54.

use super::noise::level_of;
use crate::c64;
use crate::thinned::thinned;
use frfit_linalg::dense::{Matrix, least_squares};

/// Lines of a neighbourhood: twice as many numbers as are fitted, and a few more.
pub(super) const LINES: usize = 11;

/// Numbers of numerator and denominator.
const NUMERATOR: usize = 3;
const DENOMINATOR: usize = 2;

/// Degrees of freedom of what is left of a neighbourhood.
pub(super) const FREEDOM: usize = 2 * (LINES - NUMERATOR - DENOMINATOR);

/// The equation is linear once the denominator is on the other side; its weights then are those of the last one.
const ROUNDS: usize = 3;

/// Neighbourhoods that are looked at, at most, and of how many sensors. Of fewer a median is an accident.
const MAX_NEIGHBOURHOODS: usize = 600;
const MAX_SENSORS: usize = 20;
const MIN_NEIGHBOURHOODS: usize = 12;

/// Noise over σ, the same for all sensors whose σ is finite; `None` where lines are too few. Where more than two modes share a neighbourhood it is too
/// large.
pub(super) fn of_responses((omegas, measured): (&[f64], &[Vec<c64>]), sigma: &[Vec<f64>]) -> Option<f64> {
    let counted: Vec<usize> = (0..sigma.first()?.len()).filter(|&m| sigma[0][m].is_finite()).collect();
    let sensors: Vec<usize> = thinned(&counted, MAX_SENSORS).copied().collect();
    let first: Vec<usize> = (0..(measured.len() + 1).saturating_sub(LINES)).collect();
    let most = MAX_NEIGHBOURHOODS / sensors.len().max(1);
    let left = |m: usize| {
        let fitted = move |&from: &usize| what_is_left(&neighbourhood((omegas, measured), sigma, m, from));
        thinned(&first, most).filter_map(fitted)
    };
    let squares: Vec<f64> = sensors.into_iter().flat_map(left).collect();
    if squares.len() < MIN_NEIGHBOURHOODS {
        return None;
    }
    level_of(squares, FREEDOM)
}

/// The lines (frequency, response, σ) of a sensor's neighbourhood, from its first line on.
pub(super) fn neighbourhood(
    (frequencies, measured): (&[f64], &[Vec<c64>]),
    sigma: &[Vec<f64>],
    sensor: usize,
    first: usize,
) -> Vec<(f64, c64, f64)> {
    let line = |i: usize| (frequencies[i], measured[i][sensor], sigma[i][sensor]);
    (first..first + LINES).map(line).collect()
}

/// χ² of the lines of a neighbourhood; `None` where they do not determine the function.
pub(super) fn what_is_left(lines: &[(f64, c64, f64)]) -> Option<f64> {
    Some(residuals(lines)?.iter().map(|r| r.norm_sqr()).sum())
}

/// What the function leaves of each line over its σ.
pub(super) fn residuals(lines: &[(f64, c64, f64)]) -> Option<Vec<c64>> {
    let [first, last] = [lines[0].0, lines[lines.len() - 1].0];
    let t = |k: usize| (2.0 * lines[k].0 - first - last) / (last - first);
    let mut denominator = vec![1.0; lines.len()];
    let mut left: Option<Vec<c64>> = None;
    for _ in 0..ROUNDS {
        let weight = |k: usize| 1.0 / (lines[k].2 * denominator[k]);
        let a =
            Matrix::from_fn(lines.len(), NUMERATOR + DENOMINATOR, |k, j| match j.checked_sub(NUMERATOR) {
                None => c64::new(weight(k) * t(k).powi(j as i32), 0.0),
                Some(j) => -weight(k) * t(k).powi(j as i32 + 1) * lines[k].1,
            });
        let b: Vec<c64> = lines.iter().enumerate().map(|(k, line)| weight(k) * line.1).collect();
        let fit = least_squares(&a, &b).ok()?;
        left = Some(a.multiply(&fit.solution).iter().zip(&b).map(|(fitted, b)| b - fitted).collect());
        for (k, size) in denominator.iter_mut().enumerate() {
            let own = &fit.solution[NUMERATOR..];
            let sum = own.iter().enumerate().map(|(j, b)| b * t(k).powi(j as i32 + 1)).sum::<c64>();
            *size = (1.0 + sum).norm();
        }
    }
    left.filter(|left| left.iter().all(|r| r.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frequency::linear_hz;
    use crate::identify::simulated::normal_numbers;

    /// Noise of a known size on a structure with narrow and wide modes, and a response that has no noise.
    #[test]
    fn noise_is_what_a_local_rational_function_leaves() {
        let frequency_hz = linear_hz(20.0, 500.0, 240);
        let mut normal = normal_numbers(7);
        let modes = [
            (47.0, 2e-3, 1.0),
            (130.0, 0.05, -0.7),
            (141.0, 5e-4, 0.2),
            (260.0, 0.3, 2.0),
            (433.0, 0.01, 1.0),
        ];
        let exact = |f: f64, m: f64| -> c64 {
            let one = |&(own, loss, share): &(f64, f64, f64)| {
                (1.0 + m * share) / (own * own * c64::new(1.0, loss) - f * f)
            };
            modes.iter().map(one).sum()
        };
        let exact: Vec<Vec<c64>> = frequency_hz.iter().map(|&f| vec![exact(f, 0.0), exact(f, 1.0)]).collect();
        for noise in [0.0, 1e-3, 0.02] {
            let mut measured = exact.clone();
            measured.iter_mut().flatten().for_each(|x| *x *= 1.0 + noise * normal());
            let sigma: Vec<Vec<f64>> =
                measured.iter().map(|u| u.iter().map(|u| u.norm()).collect()).collect();
            let found = of_responses((&frequency_hz, &measured), &sigma).unwrap();
            // Neighbourhoods overlap: some fifty of them are independent.
            assert!((found - noise).abs() <= 0.15 * noise + 2e-5, "{found} {noise}");
        }
        let few = of_responses((&frequency_hz[..15], &exact[..15]), &vec![vec![1.0; 2]; 15]);
        assert_eq!(few, None);
    }
}
