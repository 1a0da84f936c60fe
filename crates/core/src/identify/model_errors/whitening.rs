//! What noise and errors leave of a response, made white.
//!
//! Noise differs from line to line. What the model lacks beside its errors, the rest, is often alike at neighbouring lines: then these say one thing, and not many. It is
//! a random function of the frequency with r times the level ℓ of the response as its standard deviation,
//! $$ u_m(\omega_k) - x_m(\omega_k) = r \ell_{mk} z_m(\omega_k) + \sigma_{mk} n_{mk}, \quad \langle z_m(\omega) z_m(\omega') \rangle = e^{-|\omega - \omega'| / L} $$
//! for the real and the imaginary part each. Over the lines of a sensor a Kalman filter makes independent numbers of variance 1 of that. It is linear, so that slopes are
//! made white in the same way.
//!
//! # Source
//! M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63 (2001) 425–464 (a random function beside the errors of parameters); R. E. Kalman, J. Basic Eng. 82 (1960) 35–45.

use crate::c64;
use crate::median::median;

/// From a rest that is not seen beside noise to a response at a wrong place, and halvings of the logarithm: to a thousandth of it.
const RESTS: [f64; 2] = [1e-4, 0.5];
const REST_HALVINGS: usize = 13;

/// Over how many lines a rest may be alike.
const REST_LENGTHS: [f64; 8] = [0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];

/// What the response has beside noise and errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rest {
    /// Standard deviation of real and imaginary part each, relative to the level of the response.
    pub(super) std: f64,
    /// The difference of ω over which it is alike; 0 where it differs from line to line.
    pub(super) length_rad_s: f64,
}

impl Rest {
    pub(super) const NONE: Self = Self { std: 0.0, length_rad_s: 0.0 };
}

/// Standard deviations of lines: noise and rest.
#[derive(Debug, Clone)]
pub(super) struct Deviations {
    pub(super) omegas: Vec<f64>,
    /// Of the noise, `[line][sensor]`; infinite of a sensor that is left out.
    pub(super) noise: Vec<Vec<f64>>,
    /// The levels of the responses, of which the rest is a part.
    pub(super) levels: Vec<Vec<f64>>,
}

impl Deviations {
    /// The likeliest of the rests with which χ² of residuals `[line][sensor]` is what n numbers have.
    pub(super) fn likeliest_rest(&self, residuals: &[Vec<c64>], n: f64) -> Rest {
        let apart = self.omegas.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let apart = median(apart.collect()).unwrap_or(0.0);
        let over = |lines: f64| -> Rest {
            let rest = |log_std: f64| Rest { std: log_std.exp(), length_rad_s: lines * apart };
            let [mut low, mut high] = RESTS.map(f64::ln);
            for _ in 0..REST_HALVINGS {
                let middle = 0.5 * (low + high);
                let chi_squared = self.whitening(rest(middle)).chi_squared(residuals);
                *(if chi_squared > n { &mut low } else { &mut high }) = middle;
            }
            rest(high)
        };
        let improbability = |rest: Rest| {
            let whitening = self.whitening(rest);
            whitening.chi_squared(residuals) + whitening.log_determinant()
        };
        let each = REST_LENGTHS.map(over).map(|rest| (improbability(rest), rest));
        each.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(Rest::NONE, |(_, rest)| rest)
    }

    /// What makes residuals of noise and this rest white.
    pub(super) fn whitening(&self, rest: Rest) -> Whitening {
        let of_sensor = |m: usize| {
            let mut filters: Vec<Filter> = Vec::with_capacity(self.noise.len());
            // The variance of z by the lines before.
            let mut variance = 1.0;
            for (line, of_line) in self.noise.iter().enumerate().filter(|(_, of_line)| of_line[m].is_finite())
            {
                let since = filters.last().map(|last| (self.omegas[line] - self.omegas[last.line]).abs());
                let is_alike = rest.length_rad_s > 0.0;
                let kept = since.filter(|_| is_alike).map_or(0.0, |since| (-since / rest.length_rad_s).exp());
                variance = 1.0 - kept * kept * (1.0 - variance);
                let of_rest = rest.std * self.levels[line][m];
                let std = of_line[m].hypot(of_rest * variance.sqrt());
                let gain = variance * of_rest / (std * std);
                variance *= 1.0 - gain * of_rest;
                filters.push(Filter { line, kept, of_rest, gain, std });
            }
            filters
        };
        Whitening { sensors: (0..self.noise.first().map_or(0, Vec::len)).map(of_sensor).collect() }
    }
}

/// The step of a Kalman filter at a line.
#[derive(Debug, Clone, Copy)]
struct Filter {
    line: usize,
    /// What of z is left since the line before.
    kept: f64,
    /// r ℓ.
    of_rest: f64,
    /// By how much a part of the residual that the lines before do not say changes z.
    gain: f64,
    /// Standard deviation of that part.
    std: f64,
}

impl Filter {
    /// Makes the residual of a line white, and z what the lines up to here say.
    fn whiten(&self, residual: &mut c64, z: &mut c64) {
        *z *= self.kept;
        *residual -= self.of_rest * *z;
        *z += self.gain * *residual;
        *residual /= self.std;
    }
}

/// Of each sensor the lines that are used.
#[derive(Debug, Clone)]
pub(super) struct Whitening {
    sensors: Vec<Vec<Filter>>,
}

impl Whitening {
    /// Of noise alone: its standard deviations `[line][sensor]`, infinite of a sensor that is left out.
    pub(super) fn of_noise(noise: Vec<Vec<f64>>) -> Self {
        Deviations { omegas: vec![0.0; noise.len()], levels: noise.clone(), noise }.whitening(Rest::NONE)
    }

    /// The rows of a sensor at the lines that are used, made white, with these lines.
    pub(super) fn rows<'r>(
        &'r self,
        sensor: usize,
        row: impl Fn(usize) -> Vec<c64> + 'r,
    ) -> impl Iterator<Item = (usize, Vec<c64>)> + 'r {
        let mut each_z = Vec::new();
        self.sensors.get(sensor).into_iter().flatten().map(move |filter| {
            let mut row = row(filter.line);
            each_z.resize(row.len(), c64::default());
            row.iter_mut().zip(&mut each_z).for_each(|(x, z)| filter.whiten(x, z));
            (filter.line, row)
        })
    }

    /// χ² of residuals `[line][sensor]`.
    pub(super) fn chi_squared(&self, residuals: &[Vec<c64>]) -> f64 {
        let of_sensor = |(m, filters): (usize, &Vec<Filter>)| -> f64 {
            let mut z = c64::default();
            let white = |filter: &Filter| {
                let mut residual = residuals[filter.line][m];
                filter.whiten(&mut residual, &mut z);
                residual.norm_sqr()
            };
            filters.iter().map(white).sum()
        };
        self.sensors.iter().enumerate().map(of_sensor).sum()
    }

    /// ln det of the covariance of real and imaginary parts together: Σ 4 ln σ where there is no rest.
    pub(super) fn log_determinant(&self) -> f64 {
        self.sensors.iter().flatten().map(|filter| 4.0 * filter.std.ln()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::simulated::normal_numbers;
    use frfit_linalg::dense::Cholesky;

    /// A rest of 3 % beside noise of 0.5 %, that differs from line to line, or that is alike over eight of them.
    #[test]
    fn the_likeliest_rest_is_the_one_that_was_made() {
        let (count, std, noise) = (400, 0.03, 0.005);
        for over in [0.0, 8.0] {
            let mut random = normal_numbers(7);
            let kept: f64 = if over > 0.0 { f64::exp(-1.0 / over) } else { 0.0 };
            let mut z = random();
            let residual = |_| {
                z = kept * z + (1.0 - kept * kept).sqrt() * random();
                vec![std * z + noise * random()]
            };
            let residuals: Vec<Vec<c64>> = (0..count).map(residual).collect();
            let deviations = Deviations {
                omegas: (0..count).map(|k| 10.0 + 0.5 * k as f64).collect(),
                noise: vec![vec![noise]; count],
                levels: vec![vec![1.0]; count],
            };
            let found = deviations.likeliest_rest(&residuals, 2.0 * count as f64);
            assert!((0.8 * std..1.25 * std).contains(&found.std), "{over} {found:?}");
            let lines = found.length_rad_s / 0.5;
            assert!(if over > 0.0 { (4.0..=16.0).contains(&lines) } else { lines == 0.0 }, "{found:?}");
        }
    }

    /// Against the inverse and the determinant of the covariance, of unequal distances and a line that is left out.
    #[test]
    fn white_residuals_are_those_of_the_whole_covariance() {
        let noise = [0.3, 0.1, f64::INFINITY, 0.2, 0.15].map(|std| vec![std]);
        let omegas = vec![10.0, 11.0, 11.5, 14.0, 14.2];
        let levels = [1.0, 0.5, 3.0, 2.0, 0.7].map(|level| vec![level]);
        let residuals = [0.4, -0.2, 5.0, 0.9, 0.1].map(|x| vec![c64::new(x, 0.5 - x)]);
        let deviations = Deviations { omegas, noise: noise.to_vec(), levels: levels.to_vec() };
        for rest in [Rest::NONE, Rest { std: 0.4, length_rad_s: 0.0 }, Rest { std: 0.4, length_rad_s: 2.0 }] {
            let used = [0, 1, 3, 4];
            let covariance = |k: usize| {
                let (i, j) = (used[k / 4], used[k % 4]);
                let apart = (deviations.omegas[i] - deviations.omegas[j]).abs();
                let alike = if i == j { 1.0 } else { (-apart / rest.length_rad_s).exp() };
                let of_noise = if i == j { noise[i][0].powi(2) } else { 0.0 };
                rest.std.powi(2) * levels[i][0] * levels[j][0] * alike + of_noise
            };
            let covariance: Vec<f64> = (0..16).map(covariance).collect();
            let factor = Cholesky::new(4, &covariance).unwrap();
            let part = |of: &dyn Fn(c64) -> f64| used.map(|i| of(residuals[i][0])).to_vec();
            let [re, im] = [part(&|x| x.re), part(&|x| x.im)];
            let product = |a: &[f64], b: &[f64]| -> f64 {
                let mut solved = b.to_vec();
                factor.solve(&mut solved);
                a.iter().zip(&solved).map(|(a, b)| a * b).sum()
            };
            let whitening = deviations.whitening(rest);
            let chi_squared = whitening.chi_squared(&residuals);
            let expected = product(&re, &re) + product(&im, &im);
            assert!((chi_squared / expected - 1.0).abs() < 1e-12, "{rest:?} {chi_squared} {expected}");
            let log_determinant = whitening.log_determinant();
            let expected = 2.0 * factor.log_determinant();
            assert!((log_determinant - expected).abs() < 1e-12, "{rest:?} {log_determinant} {expected}");
            // Rows are made white together, and products of their columns are those with the inverse.
            let row = |i: usize| vec![c64::from(residuals[i][0].re), c64::from(residuals[i][0].im)];
            let rows: Vec<(usize, Vec<c64>)> = whitening.rows(0, row).collect();
            assert_eq!(rows.iter().map(|(line, _)| *line).collect::<Vec<_>>(), used);
            let found: f64 = rows.iter().map(|(_, row)| (row[0] * row[1]).re).sum();
            assert!((found - product(&re, &im)).abs() < 1e-12, "{rest:?} {found}");
        }
    }
}
