//! Poles that all responses share, fitted to all lines at once, with their covariance.
//!
//! With a window of decay α on the records, s = iω + α, x from −1 to 1 over the band, T_j Chebyshev's polynomials,
//! $$ H_m(s) = \sum_r \frac{R_{mr}}{s - s_r} + \frac{\bar R_{mr}}{s - \bar s_r} + \frac{l_m}{s^2} + \sum_{j=0}^{p} u_{mj} T_j(x) . $$
//! Residues, and what modes outside of the band leave in it, are linear and eliminated sensor by sensor (variable projection): the search is in the
//! poles alone, and its information is that of the poles with everything else free.
//!
//! Through a Hann window 1/(s − s_r) is another function of s − s_r (`hann`).
//!
//! # Source
//! G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413–432; L. Kaufman, BIT 15 (1975) 49–57 (slopes).

use super::hann::hann_resonance;
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::frequency::{laplace_per_s, omega_rad_s};
use crate::least_squares::{Residuals, Search, descend, inverse_information};
use frfit_linalg::dense::upper_triangle;
use frfit_linalg::vector::transpose_dot;

/// Responses with their weights 1/σ (σ of real and imaginary part each), `[frequency][sensor]`, under a window of this decay.
#[derive(Clone, Copy)]
pub(super) struct Measured<'a> {
    pub(super) frequency_hz: &'a [f64],
    pub(super) responses: &'a [Vec<c64>],
    pub(super) weights: &'a [Vec<f64>],
    pub(super) decay_per_s: f64,
    /// T of the records that had a Hann window, s; `None` without one.
    pub(super) hann_record_s: Option<f64>,
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
    /// R_mr, `[pole][sensor]`.
    pub(super) residues: Vec<Vec<c64>>,
    /// By how much the misfit is larger without each pole.
    pub(super) gains: Vec<f64>,
    /// What is fitted, `[sensor][frequency]`.
    pub(super) responses: Vec<Vec<c64>>,
}

/// Covariance of Re s and Im s of a pole: [Re Re, Re Im, Im Im].
pub(super) type PoleCovariance = [f64; 3];

/// A column that is the sum of those before it to this part of its length counts for nothing.
const DEPENDENT_COLUMN_RTOL: f64 = 1e-12;

/// Evaluations of the search for each coordinate.
const SEARCH_PATIENCE: usize = 20;

/// Linear least squares of one sensor.
struct Eliminated {
    /// R of the weighted [Φ, h], (n + 1) × (n + 1): its last entry is the length of the residual.
    triangle: Triangle,
    /// The linear coefficients c, two of each pole first.
    coefficients: Vec<f64>,
}

/// An upper triangle, column after column.
struct Triangle {
    entries: Vec<f64>,
    size: usize,
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

    /// Φ at every line, column after column: of each pole those of Re R and Im R, then those of the polynomials.
    fn functions(&self, fit: &Fit) -> Vec<Vec<c64>> {
        let n = self.frequency_hz.len();
        let mut functions = self.pole_functions(fit, |z| self.resonance(z)[0]);
        let lowest = self.s(0).norm_sqr();
        let [first, last] = [self.frequency_hz[0], self.frequency_hz[n - 1]];
        let x = |k: usize| (2.0 * self.frequency_hz[k] - first - last) / (last - first);
        let mut smooth = vec![(0..n).map(|k| lowest / self.s(k).powi(2)).collect::<Vec<c64>>()];
        for j in 0..=fit.degree {
            let next = |k: usize| match j {
                0 => c64::new(1.0, 0.0),
                1 => c64::new(x(k), 0.0),
                j => 2.0 * x(k) * smooth[j][k] - smooth[j - 1][k],
            };
            smooth.push((0..n).map(next).collect());
        }
        for function in smooth {
            let turned = function.iter().map(|value| c64::I * value).collect();
            functions.extend([function, turned]);
        }
        functions
    }

    /// 1/z, or what a Hann window makes of it, and its slope by the pole; z = s − s_r.
    fn resonance(&self, z: c64) -> [c64; 2] {
        match self.hann_record_s {
            Some(record_s) => hann_resonance(z, record_s),
            None => [z.inv(), z.powi(-2)],
        }
    }

    /// f(s − s_r) + f(s − s̄_r) and i times their difference, of each pole.
    fn pole_functions(&self, fit: &Fit, f: impl Fn(c64) -> c64) -> Vec<Vec<c64>> {
        let both = |pole: &c64| {
            let pair = (0..self.frequency_hz.len()).map(|k| {
                let [near, far] = [*pole, pole.conj()].map(|pole| f(self.s(k) - pole));
                (near + far, c64::I * (near - far))
            });
            let (sum, difference) = pair.unzip();
            [sum, difference]
        };
        fit.poles.iter().flat_map(both).collect()
    }

    /// R of what a sensor weighs: of these functions, and its responses last.
    fn triangle(&self, m: usize, functions: &[Vec<c64>]) -> Option<Triangle> {
        let n = self.frequency_hz.len();
        let size = functions.len() + 1;
        let mut columns = vec![0.0; 2 * n * size];
        for (j, column) in columns.chunks_exact_mut(2 * n).enumerate() {
            for k in 0..n {
                let value = functions.get(j).map_or(self.responses[k][m], |function| function[k]);
                let value = self.weights[k][m] * value;
                (column[k], column[n + k]) = (value.re, value.im);
            }
        }
        Some(Triangle { entries: upper_triangle(&columns, size).ok()?, size })
    }

    fn eliminated(&self, m: usize, functions: &[Vec<c64>]) -> Option<Eliminated> {
        let triangle = self.triangle(m, functions)?;
        let coefficients = triangle.coefficients(functions.len());
        Some(Eliminated { triangle, coefficients })
    }

    /// Residuals and their slopes by (Re s, Im s) of each pole, rotated into few rows: sums of squares and products are the same.
    ///
    /// With Ψ = ∂Φ/∂s of the poles, R of [Φ, Ψ, h] has below the rows of Φ what of Ψ and of h is not in Φ. The slopes are those with c held.
    fn residuals(&self, fit: &Fit, for_each: ForEach<'_>) -> Option<Residuals> {
        let own = 2 * fit.poles.len();
        let mut functions = self.functions(fit);
        let count = functions.len();
        functions.extend(self.pole_functions(fit, |z| self.resonance(z)[1]));
        let of_sensor = |m: usize| {
            let triangle = self.triangle(m, &functions)?;
            let residues = triangle.coefficients(count);
            let below = |j: usize| triangle.column(count + j)[count..].iter();
            let mut block = Vec::with_capacity((own + 1) * (own + 1));
            for r in (0..own).step_by(2) {
                let [re, im] = [residues[r], residues[r + 1]];
                let pair = || below(r).zip(below(r + 1));
                block.extend(pair().map(|(a, b)| -(re * a + im * b)));
                block.extend(pair().map(|(a, b)| -(re * b - im * a)));
            }
            block.extend(below(own));
            Some(block)
        };
        let each = map(for_each, self.sensors(), of_sensor).into_iter().collect::<Option<Vec<_>>>()?;
        let rows = own + 1;
        let column = |j: usize| each.iter().flat_map(move |r| r[j * rows..(j + 1) * rows].iter().copied());
        Some((column(own).collect(), (0..own).flat_map(column).collect()))
    }

    /// What everything linear leaves of a sensor's slopes by relative shifts of its poles, and of its responses with these shifts taken out to first order:
    /// columns, the responses last. And its residues.
    pub(super) fn shift_slopes(
        &self,
        m: usize,
        fit: &Fit,
        shifts: &[f64],
    ) -> Option<(Vec<Vec<f64>>, Vec<c64>)> {
        let mut functions = self.functions(fit);
        let (count, modes) = (functions.len(), fit.poles.len());
        let residues = self.eliminated(m, &functions)?.residues(modes);
        for (&pole, residue) in fit.poles.iter().zip(&residues) {
            let turned = residue * c64::I * pole.norm();
            let slope = |s: c64| turned / (s - pole).powi(2) + turned.conj() / (s - pole.conj()).powi(2);
            functions.push((0..self.frequency_hz.len()).map(|k| slope(self.s(k))).collect());
        }
        let triangle = self.triangle(m, &functions)?;
        let mut left: Vec<Vec<f64>> =
            (count..=count + modes).map(|j| triangle.column(j)[count..].to_vec()).collect();
        let (responses, slopes) = left.split_last_mut()?;
        for (slope, shift) in slopes.iter().zip(shifts) {
            responses.iter_mut().zip(slope).for_each(|(response, slope)| *response += slope * shift);
        }
        Some((left, residues))
    }

    /// The poles that fit best, from these on.
    pub(super) fn refined(&self, fit: &Fit, for_each: ForEach<'_>) -> Option<Fit> {
        let at = |theta: &[f64]| Fit { poles: poles(theta), degree: fit.degree };
        let is_damped = |fit: &Fit| fit.poles.iter().all(|pole| pole.re < 0.0 && pole.im > 0.0);
        let evaluate =
            |theta: &[f64]| Some(at(theta)).filter(is_damped).and_then(|fit| self.residuals(&fit, for_each));
        if fit.poles.is_empty() {
            return Some(fit.clone());
        }
        let start: Vec<f64> = fit.poles.iter().flat_map(|pole| [pole.re, pole.im]).collect();
        let search = Search { starts: 1, patience: SEARCH_PATIENCE, same: 0.0 };
        Some(at(&descend(&start, &evaluate, &search)?.theta)).filter(is_damped)
    }

    /// Everything linear at given poles.
    pub(super) fn fitted(&self, fit: &Fit, for_each: ForEach<'_>) -> Option<Fitted> {
        let functions = self.functions(fit);
        let each = map(for_each, self.sensors(), |m| self.eliminated(m, &functions))
            .into_iter()
            .collect::<Option<Vec<_>>>()?;
        let of_sensors: Vec<Vec<c64>> = each.iter().map(|own| own.residues(fit.poles.len())).collect();
        let residues = (0..fit.poles.len()).map(|r| of_sensors.iter().map(|own| own[r]).collect()).collect();
        let gain = |r: usize| each.iter().map(|own| own.gain(2 * r)).sum();
        let response = |own: &Eliminated| {
            let term = |k: usize, (c, function): (&f64, &Vec<c64>)| *c * function[k];
            let at = |k: usize| own.coefficients.iter().zip(&functions).map(|each| term(k, each)).sum();
            (0..self.frequency_hz.len()).map(at).collect()
        };
        Some(Fitted {
            misfit: each.iter().map(Eliminated::misfit).sum(),
            residues,
            gains: (0..fit.poles.len()).map(gain).collect(),
            responses: each.iter().map(response).collect(),
        })
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

    /// Whether the damped natural frequency of a pole is in the band.
    pub(super) fn is_in_band(&self, pole: c64) -> bool {
        let [first, last] =
            [self.frequency_hz[0], self.frequency_hz[self.frequency_hz.len() - 1]].map(omega_rad_s);
        (first..=last).contains(&pole.im)
    }
}

impl Triangle {
    fn column(&self, j: usize) -> &[f64] {
        &self.entries[j * self.size..(j + 1) * self.size]
    }

    /// R⁻¹ of the first n columns times the last one.
    fn coefficients(&self, n: usize) -> Vec<f64> {
        let mut c = self.column(self.size - 1)[..n].to_vec();
        for k in (0..n).rev() {
            let column = self.column(k);
            c[k] = if self.is_dependent(k) { 0.0 } else { c[k] / column[k] };
            for i in 0..k {
                c[i] -= c[k] * column[i];
            }
        }
        c
    }

    fn is_dependent(&self, k: usize) -> bool {
        let column = &self.column(k)[..=k];
        column[k].abs() <= DEPENDENT_COLUMN_RTOL * transpose_dot(column, column).sqrt()
    }
}

impl Eliminated {
    /// Those of the first poles.
    fn residues(&self, poles: usize) -> Vec<c64> {
        self.coefficients[..2 * poles].chunks_exact(2).map(|pair| c64::new(pair[0], pair[1])).collect()
    }

    /// Σ w²|h − Φc|².
    fn misfit(&self) -> f64 {
        self.triangle.entries[self.triangle.entries.len() - 1].powi(2)
    }

    /// By how much the sum of squares is larger without the columns j and j + 1: cᵀ[(ΦᵀΦ)⁻¹]⁻¹c on these two.
    fn gain(&self, j: usize) -> f64 {
        let n = self.coefficients.len();
        // Rows j and j + 1 of R⁻¹, by forward substitution with Rᵀ.
        let row = |j: usize| {
            let mut row = vec![0.0; n];
            for k in j..n {
                let column = self.triangle.column(k);
                let unit = f64::from(u8::from(k == j));
                let left = unit - transpose_dot(&row[j..k], &column[j..k]);
                row[k] = if self.triangle.is_dependent(k) { 0.0 } else { left / column[k] };
            }
            row
        };
        let [a, b] = [row(j), row(j + 1)];
        let (aa, ab, bb) = (transpose_dot(&a, &a), transpose_dot(&a, &b), transpose_dot(&b, &b));
        let [c, d] = [self.coefficients[j], self.coefficients[j + 1]];
        let determinant = aa * bb - ab * ab;
        if determinant > 0.0 { (c * c * bb - 2.0 * c * d * ab + d * d * aa) / determinant } else { 0.0 }
    }
}

fn poles(theta: &[f64]) -> Vec<c64> {
    theta.chunks_exact(2).map(|pair| c64::new(pair[0], pair[1])).collect()
}
