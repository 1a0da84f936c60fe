//! How sure an FRF of some averages is.

use crate::c64;

/// Degrees of freedom, of complex numbers, that neighbouring lines are to have together.
const FREEDOM: f64 = 60.0;

/// Steps of the search for the noise about a line, and how often lines that it does not explain are left out.
const STEPS: usize = 6;
const PASSES: usize = 3;

/// Deviate of the normal distribution that one of a thousand exceeds.
const RARE: f64 = 3.09;

/// B-6, the variance of the real part of an FRF that has n averages, and as much of its imaginary part, at each of its lines.
///
/// The residual of n spectra after one response has n − 1 degrees of freedom, so a line by itself has
/// $$ s_k^2 = |H_k|^2 \\frac{1 - \\gamma_k^2}{2 (n - 1) \\gamma_k^2} . $$
/// Of a few averages it scatters: of three impacts the mean of 1/s² is twice that of the truth. So neighbouring lines share what they show. About each line noise is
/// $$ \\sigma_k^2 = a + b |H_k|^2 , \\quad a, b \\ge 0 , $$
/// of a part that is the same at all of them, as that of an accelerometer, and one in proportion to the response, as that of impacts that do not all hit the same point.
/// a and b have the largest likelihood of the s² of as many lines as have 60 degrees of freedom together. Values are larger by the share by which the
/// mean of 1/σ² would be too large. A line with more than that explains, as one with hum, keeps its own s².
///
/// Infinite where γ² = 0.
///
/// # Limits
/// Noise in the response that does not depend on the force, circular.
///
/// # Source
/// J. S. Bendat, A. G. Piersol, *Random Data*, 4th ed., Wiley 2010, section 9.2, with n for n − 1; P. McCullagh, J. A. Nelder, *Generalized Linear Models*, 2nd ed.,
/// Chapman & Hall 1989, chapter 8, for gamma distributed values whose mean is linear.
pub fn variances(response: &[c64], coherence: &[f64], averages: usize) -> Vec<f64> {
    // Of one average there is no coherence but one.
    let freedom = averages.saturating_sub(1).max(1) as f64;
    let own = |(&response, &coherence): (&c64, &f64)| relative_variance(response, coherence) / freedom;
    let own: Vec<f64> = response.iter().zip(coherence).map(own).collect();
    let lines = ((FREEDOM / freedom).ceil() as usize).min(own.len());
    if lines < 2 {
        return own.into_iter().map(|own| own * (1.0 + 1.0 / freedom)).collect();
    }
    let sizes: Vec<f64> = response.iter().map(|response| response.norm_sqr()).collect();
    let rare = rare_ratio(freedom);
    let shared = |k: usize| {
        let first = k.saturating_sub(lines / 2).min(own.len() - lines);
        let about = first..first + lines;
        let noise = Noise::about(&own[about.clone()], &sizes[about], rare);
        let longer = 1.0 + 2.0 / (freedom * lines as f64);
        match noise.map(|noise| noise.at(sizes[k])) {
            Some(noise) if own[k] <= rare * noise => longer * noise,
            _ => own[k],
        }
    };
    (0..own.len()).map(shared).collect()
}

/// The variance of the real part for a single degree of freedom: |H|² (1 − γ²)/2γ².
pub fn relative_variance(response: c64, coherence: f64) -> f64 {
    response.norm_sqr() * (1.0 - coherence) / (2.0 * coherence)
}

/// Of a mean square with so many complex degrees of freedom the ratio to its expectation that one of a thousand exceeds: the cube of a normal
/// variable, by Wilson and Hilferty.
fn rare_ratio(freedom: f64) -> f64 {
    let spread = 1.0 / (9.0 * freedom);
    (1.0 - spread + RARE * spread.sqrt()).powi(3)
}

/// Variances a + b·size.
#[derive(Debug, Clone, Copy)]
struct Noise {
    same: f64,
    proportional: f64,
}

impl Noise {
    fn at(self, size: f64) -> f64 {
        self.same + self.proportional * size
    }

    /// Of the largest likelihood for these values, without those that are far larger.
    fn about(values: &[f64], sizes: &[f64], rare: f64) -> Option<Self> {
        let mut kept: Vec<(f64, f64)> = values
            .iter()
            .copied()
            .zip(sizes.iter().copied())
            .filter(|(value, _)| value.is_finite())
            .collect();
        let mut noise = Self::of(&kept)?;
        for _ in 1..PASSES {
            let before = kept.len();
            kept.retain(|&(value, size)| value <= rare * noise.at(size));
            if kept.len() == before {
                break;
            }
            noise = Self::of(&kept)?;
        }
        Some(noise)
    }

    /// The least of Σ ln σ² + s²/σ², by reweighted least squares; the least on either bound where that has a negative part.
    fn of(kept: &[(f64, f64)]) -> Option<Self> {
        let count = kept.len() as f64;
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| kept.iter().map(of).sum::<f64>() / count;
        let same = Self { same: mean(&|(value, _)| *value), proportional: 0.0 };
        let proportional = Self { same: 0.0, proportional: mean(&|(value, size)| value / size) };
        let mut both = Self { same: 0.5 * same.same, proportional: 0.5 * proportional.proportional };
        for _ in 0..STEPS {
            // Normal equations of s² = a + b·size, weighed by 1/σ⁴.
            let [mut one, mut cross, mut square, mut with_one, mut with_size] = [0.0; 5];
            for &(value, size) in kept {
                let weight = both.at(size).powi(-2);
                one += weight;
                cross += weight * size;
                square += weight * size * size;
                with_one += weight * value;
                with_size += weight * value * size;
            }
            let determinant = one * square - cross * cross;
            both = Self {
                same: (square * with_one - cross * with_size) / determinant,
                proportional: (one * with_size - cross * with_one) / determinant,
            };
            if !(both.same > 0.0 && both.proportional > 0.0) {
                break;
            }
        }
        let misfit = |noise: &Self| {
            kept.iter().map(|&(value, size)| noise.at(size).ln() + value / noise.at(size)).sum::<f64>()
        };
        let all = [both, same, proportional]
            .into_iter()
            .filter(|noise| noise.same >= 0.0 && noise.proportional >= 0.0 && misfit(noise).is_finite());
        all.min_by(|a, b| misfit(a).total_cmp(&misfit(b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_without_coherence_has_no_variance_and_leaves_its_neighbours_theirs() {
        let response = [c64::new(1.0, 0.0); 9];
        let mut coherence = [0.9; 9];
        coherence[4] = 0.0;
        let found = variances(&response, &coherence, 3);
        let expected = (1.0 + 2.0 / 18.0) * 0.1 / (4.0 * 0.9);
        assert_eq!(found[4], f64::INFINITY);
        assert!(found.iter().enumerate().all(|(k, found)| k == 4 || (found / expected - 1.0).abs() < 1e-9));
    }
}
