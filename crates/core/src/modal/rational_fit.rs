//! Poles that all responses share, fitted to all lines at once, with their covariance.
//!
//! With a window of decay α on the records, s = iω + α, x from −1 to 1 over the band, T_j Chebyshev's polynomials,
//! $$ H_m(s) = \sum_r \frac{R_{mr}}{s - s_r} + \frac{\bar R_{mr}}{s - \bar s_r} + \frac{l_m}{s^2} + \sum_{j=0}^{p} u_{mj} T_j(x) . $$
//! Residues, and what modes outside of the band leave in it, are linear and eliminated sensor by sensor (variable projection): the search is in the
//! poles alone, and its information is that of the poles with everything else free.
//!
//! # Source
//! G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413–432; L. Kaufman, BIT 15 (1975) 49–57 (slopes).

use crate::c64;
use crate::for_each::{ForEach, map};
use crate::frequency::{laplace_per_s, omega_rad_s};
use crate::least_squares::{Residuals, Search, descend_to, inverse_information};
use frfit_linalg::dense::real_triangle;

/// Responses with their weights 1/σ (σ of real and imaginary part each), `[frequency][sensor]`, under a window of this decay.
#[derive(Clone, Copy)]
pub(super) struct Measured<'a> {
    pub(super) frequency_hz: &'a [f64],
    pub(super) responses: &'a [Vec<c64>],
    pub(super) weights: &'a [Vec<f64>],
    pub(super) decay_per_s: f64,
}

/// Poles, and the order p of the polynomials beside them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fit {
    pub(super) poles: Vec<c64>,
    pub(super) degree: usize,
}

/// A fit with all that is linear.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fitted {
    /// Σ w²|H − fit|².
    pub(super) misfit: f64,
    /// The linear coefficients, `[sensor]`: real and imaginary part of the residue of each pole first.
    pub(super) coefficients: Vec<Vec<f64>>,
    /// By how much the misfit is larger without each pole.
    pub(super) gains: Vec<f64>,
}

impl Fitted {
    /// R_mr of each sensor.
    pub(super) fn residues(&self, r: usize) -> Vec<c64> {
        self.coefficients.iter().map(|own| c64::new(own[2 * r], own[2 * r + 1])).collect()
    }
}

/// Covariance of Re s and Im s of a pole: [Re Re, Re Im, Im Im].
pub(super) type PoleCovariance = [f64; 3];

/// A column that is the sum of those before it to this part of its length counts for nothing.
const DEPENDENT_COLUMN_RTOL: f64 = 1e-12;

/// Evaluations of the search for each coordinate.
const SEARCH_PATIENCE: usize = 2;

/// Lines that are added to a triangle at once, over its columns: enough for blocked kernels, few enough for the cache.
const LINES_OVER_COLUMNS: usize = 2;

/// The linear least squares of one sensor, by R of [Φ, slopes, response]: no column of the length of the data is kept.
struct Eliminated {
    /// R, column after column, and its number of columns.
    r: Vec<f64>,
    columns: usize,
    /// Columns of Φ, two of each pole first.
    count: usize,
    /// The linear coefficients.
    coefficients: Vec<f64>,
}

impl Measured<'_> {
    pub(super) fn sensors(&self) -> usize {
        self.responses.first().map_or(0, Vec::len)
    }

    /// Real numbers that were measured.
    pub(super) fn numbers(&self) -> usize {
        2 * self.frequency_hz.len() * self.sensors()
    }

    /// Linear and other unknowns of a fit.
    pub(super) fn unknowns(&self, fit: &Fit) -> usize {
        let own = 2 * fit.poles.len();
        own + self.sensors() * (own + 2 * (fit.degree + 2))
    }

    fn s(&self, k: usize) -> c64 {
        laplace_per_s(self.frequency_hz[k], self.decay_per_s)
    }

    /// Φ without weights, complex values of all lines column after column.
    fn basis(&self, fit: &Fit) -> Vec<Vec<c64>> {
        let n = self.frequency_hz.len();
        let mut columns = self.of_poles(fit, c64::inv);
        let lowest = self.s(0).norm_sqr();
        let [first, last] = [self.frequency_hz[0], self.frequency_hz[n - 1]];
        let x = |k: usize| (2.0 * self.frequency_hz[k] - first - last) / (last - first);
        let smooth = |k: usize, j: usize| match j {
            0 => lowest / self.s(k).powi(2),
            _ => c64::new(((j - 1) as f64 * x(k).clamp(-1.0, 1.0).acos()).cos(), 0.0),
        };
        for j in 0..fit.degree + 2 {
            columns.push((0..n).map(|k| smooth(k, j)).collect());
            columns.push((0..n).map(|k| c64::I * smooth(k, j)).collect());
        }
        columns
    }

    /// f(s − s_r) ± f(s − s̄_r), the second times i, of each pole: factors of the real and imaginary part of a residue.
    fn of_poles(&self, fit: &Fit, f: impl Fn(&c64) -> c64) -> Vec<Vec<c64>> {
        let mut columns = Vec::new();
        for &pole in &fit.poles {
            let both = |k: usize| [pole, pole.conj()].map(|pole| f(&(self.s(k) - pole)));
            let (sum, difference) = (0..self.frequency_hz.len())
                .map(both)
                .map(|[near, far]| (near + far, c64::I * (near - far)))
                .unzip();
            columns.extend([sum, difference]);
        }
        columns
    }

    /// R of some columns and the response of a sensor behind them, all with its weights, some lines after the others.
    fn triangle(&self, m: usize, columns: &[&[c64]]) -> Option<Vec<f64>> {
        let count = columns.len() + 1;
        let all: Vec<usize> = (0..self.frequency_hz.len()).collect();
        let mut r: Vec<f64> = Vec::new();
        for lines in all.chunks(LINES_OVER_COLUMNS * count) {
            let above = r.len() / count;
            let mut block = Vec::with_capacity((above + 2 * lines.len()) * count);
            for j in 0..count {
                block.extend_from_slice(&r[j * above..(j + 1) * above]);
                for &k in lines {
                    let value = columns.get(j).map_or(self.responses[k][m], |column| column[k]);
                    let value = self.weights[k][m] * value;
                    block.extend([value.re, value.im]);
                }
            }
            r = real_triangle(&block, count).ok()?;
        }
        Some(r)
    }

    fn eliminated(&self, m: usize, basis: &[Vec<c64>], slopes: &[Vec<c64>]) -> Option<Eliminated> {
        let columns: Vec<&[c64]> = basis.iter().chain(slopes).map(Vec::as_slice).collect();
        let (r, count, columns) = (self.triangle(m, &columns)?, basis.len(), columns.len() + 1);
        let inside = r[(columns - 1) * columns..][..count].to_vec();
        let coefficients = back_substituted(&r, [count, columns], inside);
        Some(Eliminated { r, columns, count, coefficients })
    }

    /// Residuals and their slopes by (Re s, Im s) of each pole, rotated into few rows: sums of squares and products are the same.
    fn residuals(&self, fit: &Fit, for_each: ForEach<'_>) -> Option<Residuals> {
        let count = 2 * fit.poles.len() + 1;
        let (basis, squares) = (self.basis(fit), self.of_poles(fit, |difference| difference.powi(-2)));
        // ∂(Φc)/∂(Re s_r) and by Im s_r with the linear coefficients held, what of them is not in Φ.
        let of_sensor = |m: usize| {
            let own = self.eliminated(m, &basis, &squares)?;
            let mut block = Vec::new();
            for r in 0..fit.poles.len() {
                let [a, b] = [own.coefficients[2 * r], own.coefficients[2 * r + 1]];
                let [sums, differences] = [2 * r, 2 * r + 1].map(|j| own.beyond(own.count + j));
                let pairs = || sums.iter().zip(differences);
                block.extend(pairs().map(|(sum, difference)| -(a * sum + b * difference)));
                block.extend(pairs().map(|(sum, difference)| -(a * difference - b * sum)));
            }
            block.extend(own.beyond(own.columns - 1));
            Some(block)
        };
        let each = map(for_each, self.sensors(), of_sensor).into_iter().collect::<Option<Vec<_>>>()?;
        let column = |j: usize| each.iter().flat_map(move |r| r[j * count..(j + 1) * count].iter().copied());
        Some((column(count - 1).collect(), (0..count - 1).flat_map(column).collect()))
    }

    /// The poles that fit best, from these on, until the misfit changes by less than this part.
    pub(super) fn refined(&self, fit: &Fit, rtol: f64, for_each: ForEach<'_>) -> Option<Fit> {
        let at = |theta: &[f64]| Fit { poles: poles(theta), degree: fit.degree };
        let is_damped = |fit: &Fit| fit.poles.iter().all(|pole| pole.re < 0.0 && pole.im > 0.0);
        let evaluate =
            |theta: &[f64]| Some(at(theta)).filter(is_damped).and_then(|fit| self.residuals(&fit, for_each));
        if fit.poles.is_empty() {
            return Some(fit.clone());
        }
        let start: Vec<f64> = fit.poles.iter().flat_map(|pole| [pole.re, pole.im]).collect();
        let search = Search { starts: 1, patience: SEARCH_PATIENCE, same: 0.0 };
        Some(at(&descend_to(&start, &evaluate, &search, rtol)?.theta)).filter(is_damped)
    }

    /// Everything linear at given poles.
    pub(super) fn fitted(&self, fit: &Fit, for_each: ForEach<'_>) -> Option<Fitted> {
        let basis = self.basis(fit);
        let each = map(for_each, self.sensors(), |m| self.eliminated(m, &basis, &[]))
            .into_iter()
            .collect::<Option<Vec<_>>>()?;
        let misfit = each.iter().flat_map(|own| own.beyond(own.columns - 1)).map(|r| r * r).sum();
        let gain = |r: usize| each.iter().map(|own| own.gain(2 * r)).sum();
        let gains = (0..fit.poles.len()).map(gain).collect();
        Some(Fitted { misfit, gains, coefficients: each.into_iter().map(|own| own.coefficients).collect() })
    }

    /// What is fitted, `[sensor][frequency]`.
    pub(super) fn responses_of(&self, fit: &Fit, fitted: &Fitted) -> Vec<Vec<c64>> {
        let basis = self.basis(fit);
        let of_sensor = |coefficients: &Vec<f64>| {
            let sum = |k: usize| basis.iter().zip(coefficients).map(|(column, c)| c * column[k]).sum();
            (0..self.frequency_hz.len()).map(sum).collect()
        };
        fitted.coefficients.iter().map(of_sensor).collect()
    }

    /// Covariance of each pole at σ: to be multiplied by the square of the level of the noise. `None` where poles depend on one another.
    pub(super) fn covariance(&self, fit: &Fit, for_each: ForEach<'_>) -> Option<Vec<PoleCovariance>> {
        let n = 2 * fit.poles.len();
        let (_, jacobian) = self.residuals(fit, for_each)?;
        // In units of each pole's distance from the axis: the inverse is of numbers of one size.
        let unit = |j: usize| -fit.poles[j / 2].re;
        let rows = jacobian.len() / n.max(1);
        let scaled: Vec<f64> =
            jacobian.iter().enumerate().map(|(at, slope)| slope * unit(at / rows)).collect();
        let inverse = inverse_information(&scaled, n)?;
        let of = |r: usize| {
            let (a, b, size) = (2 * r, 2 * r + 1, unit(2 * r).powi(2));
            [inverse[a][a], inverse[a][b], inverse[b][b]].map(|entry| entry * size)
        };
        Some((0..fit.poles.len()).map(of).collect())
    }

    /// s at the middle of the band, over which poles are compared.
    pub(super) fn is_in_band(&self, pole: c64) -> bool {
        let [first, last] =
            [self.frequency_hz[0], self.frequency_hz[self.frequency_hz.len() - 1]].map(omega_rad_s);
        (first..=last).contains(&pole.im)
    }
}

impl Eliminated {
    /// What a column has beside Φ.
    fn beyond(&self, j: usize) -> &[f64] {
        &self.r[j * self.columns..(j + 1) * self.columns][self.count..]
    }

    /// By how much the sum of squares is larger without the columns j and j + 1: cᵀ[(ΦᵀΦ)⁻¹]⁻¹c on these two.
    fn gain(&self, j: usize) -> f64 {
        let n = self.count;
        // Rows j and j + 1 of R⁻¹, by forward substitution with Rᵀ.
        let row = |j: usize| {
            let mut row = vec![0.0; n];
            for k in j..n {
                let sum: f64 = (j..k).map(|i| row[i] * self.r[i + k * self.columns]).sum();
                let unit = f64::from(u8::from(k == j));
                let diagonal = self.r[k + k * self.columns];
                row[k] = if is_dependent(&self.r, self.columns, k) { 0.0 } else { (unit - sum) / diagonal };
            }
            row
        };
        let [a, b] = [row(j), row(j + 1)];
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let (aa, ab, bb) = (dot(&a, &a), dot(&a, &b), dot(&b, &b));
        let [c, d] = [self.coefficients[j], self.coefficients[j + 1]];
        let determinant = aa * bb - ab * ab;
        if determinant > 0.0 { (c * c * bb - 2.0 * c * d * ab + d * d * aa) / determinant } else { 0.0 }
    }
}

fn poles(theta: &[f64]) -> Vec<c64> {
    theta.chunks_exact(2).map(|pair| c64::new(pair[0], pair[1])).collect()
}

fn is_dependent(r: &[f64], n: usize, k: usize) -> bool {
    let length: f64 = r[k * n..=k * n + k].iter().map(|r| r * r).sum::<f64>().sqrt();
    r[k + k * n].abs() <= DEPENDENT_COLUMN_RTOL * length
}

/// R⁻¹x of the first columns of R.
fn back_substituted(r: &[f64], [count, n]: [usize; 2], mut x: Vec<f64>) -> Vec<f64> {
    for k in (0..count).rev() {
        x[k] = if is_dependent(r, n, k) { 0.0 } else { x[k] / r[k + k * n] };
        for i in 0..k {
            x[i] -= x[k] * r[i + k * n];
        }
    }
    x
}
