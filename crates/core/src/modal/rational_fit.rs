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
use crate::least_squares::{Residuals, Search, descend, inverse_information};
use frfit_linalg::dense::{RealQr, real_qr};

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
    /// R_mr, `[pole][sensor]`.
    pub(super) residues: Vec<Vec<c64>>,
    /// By how much the misfit is larger without each pole.
    pub(super) gains: Vec<f64>,
    /// What is left of each sensor's responses, weighted: real parts, then imaginary parts.
    rests: Vec<Vec<f64>>,
}

/// Covariance of Re s and Im s of a pole: [Re Re, Re Im, Im Im].
pub(super) type PoleCovariance = [f64; 3];

/// A column that is the sum of those before it to this part of its length counts for nothing.
const DEPENDENT_COLUMN_RTOL: f64 = 1e-12;

/// Evaluations of the search for each coordinate.
const SEARCH_PATIENCE: usize = 20;

/// What the linear least squares of one sensor leave.
struct Eliminated {
    /// Of Φ, 2K rows (real parts, then imaginary parts).
    qr: RealQr,
    count: usize,
    /// The linear coefficients, two of each pole first.
    coefficients: Vec<f64>,
    /// What is left.
    rest: Vec<f64>,
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

    /// Complex values of a line in two real rows.
    fn column(&self, m: usize, value: impl Fn(usize) -> c64) -> Vec<f64> {
        let n = self.frequency_hz.len();
        let mut column = vec![0.0; 2 * n];
        for k in 0..n {
            let value = self.weights[k][m] * value(k);
            (column[k], column[n + k]) = (value.re, value.im);
        }
        column
    }

    fn eliminated(&self, m: usize, fit: &Fit) -> Option<Eliminated> {
        let n = self.frequency_hz.len();
        let mut columns = Vec::new();
        for &pole in &fit.poles {
            let pair = |k: usize| [(self.s(k) - pole).inv(), (self.s(k) - pole.conj()).inv()];
            columns.extend(self.column(m, |k| pair(k)[0] + pair(k)[1]));
            columns.extend(self.column(m, |k| c64::I * (pair(k)[0] - pair(k)[1])));
        }
        let lowest = self.s(0).norm_sqr();
        let [first, last] = [self.frequency_hz[0], self.frequency_hz[n - 1]];
        let x = |k: usize| (2.0 * self.frequency_hz[k] - first - last) / (last - first);
        let smooth = |k: usize, j: usize| match j {
            0 => lowest / self.s(k).powi(2),
            j => c64::new(((j - 1) as f64 * x(k).clamp(-1.0, 1.0).acos()).cos(), 0.0),
        };
        for j in 0..fit.degree + 2 {
            columns.extend(self.column(m, |k| smooth(k, j)));
            columns.extend(self.column(m, |k| c64::I * smooth(k, j)));
        }
        let count = columns.len() / (2 * n);
        let qr = real_qr(&columns, count).ok()?;
        let mut rest = self.column(m, |k| self.responses[k][m]);
        let inside = taken_out(&qr.q, &mut rest);
        let coefficients = back_substituted(&qr.r, count, inside);
        Some(Eliminated { qr, count, coefficients, rest })
    }

    /// ∂(Φc)/∂(Re s_r) and by Im s_r with the linear coefficients held, what of them is not in Φ.
    fn slopes(&self, m: usize, fit: &Fit, own: &Eliminated) -> Vec<f64> {
        let mut slopes = Vec::new();
        for (r, &pole) in fit.poles.iter().enumerate() {
            let residue = c64::new(own.coefficients[2 * r], own.coefficients[2 * r + 1]);
            let pair = |k: usize| {
                let [near, far] = [self.s(k) - pole, self.s(k) - pole.conj()];
                [residue / (near * near), residue.conj() / (far * far)]
            };
            slopes.extend(self.column(m, |k| pair(k)[0] + pair(k)[1]));
            slopes.extend(self.column(m, |k| c64::I * (pair(k)[0] - pair(k)[1])));
        }
        let rows = own.rest.len();
        slopes.chunks_exact_mut(rows).for_each(|column| drop(taken_out(&own.qr.q, column)));
        slopes
    }

    /// Residuals and their slopes by (Re s, Im s) of each pole, rotated into few rows: sums of squares and products are the same.
    fn residuals(&self, fit: &Fit, for_each: ForEach<'_>) -> Option<Residuals> {
        let count = 2 * fit.poles.len() + 1;
        let of_sensor = |m: usize| {
            let own = self.eliminated(m, fit)?;
            let mut block = self.slopes(m, fit, &own);
            block.iter_mut().for_each(|slope| *slope = -*slope);
            block.extend(own.rest);
            Some(real_qr(&block, count).ok()?.r)
        };
        let each = map(for_each, self.sensors(), of_sensor).into_iter().collect::<Option<Vec<_>>>()?;
        let column = |j: usize| each.iter().flat_map(move |r| r[j * count..(j + 1) * count].iter().copied());
        Some((column(count - 1).collect(), (0..count - 1).flat_map(column).collect()))
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
        let each = map(for_each, self.sensors(), |m| self.eliminated(m, fit))
            .into_iter()
            .collect::<Option<Vec<_>>>()?;
        let misfit = each.iter().flat_map(|own| &own.rest).map(|r| r * r).sum();
        let residue =
            |r: usize, own: &Eliminated| c64::new(own.coefficients[2 * r], own.coefficients[2 * r + 1]);
        let residues =
            (0..fit.poles.len()).map(|r| each.iter().map(|own| residue(r, own)).collect()).collect();
        let gain = |r: usize| each.iter().map(|own| own.gain(2 * r)).sum();
        Some(Fitted {
            misfit,
            residues,
            gains: (0..fit.poles.len()).map(gain).collect(),
            rests: each.into_iter().map(|own| own.rest).collect(),
        })
    }

    /// What is fitted, `[sensor][frequency]`: what was measured without what is left.
    pub(super) fn responses_of(&self, fitted: &Fitted) -> Vec<Vec<c64>> {
        let n = self.frequency_hz.len();
        let of_sensor = |(m, rest): (usize, &Vec<f64>)| {
            let at = |k: usize| self.responses[k][m] - c64::new(rest[k], rest[n + k]) / self.weights[k][m];
            (0..n).map(at).collect()
        };
        fitted.rests.iter().enumerate().map(of_sensor).collect()
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

impl Eliminated {
    /// By how much the sum of squares is larger without the columns j and j + 1: cᵀ[(ΦᵀΦ)⁻¹]⁻¹c on these two.
    fn gain(&self, j: usize) -> f64 {
        let n = self.count;
        // Rows j and j + 1 of R⁻¹, by forward substitution with Rᵀ.
        let row = |j: usize| {
            let mut row = vec![0.0; n];
            for k in j..n {
                let sum: f64 = (j..k).map(|i| row[i] * self.qr.r[i + k * n]).sum();
                let unit = f64::from(u8::from(k == j));
                let diagonal = self.qr.r[k + k * n];
                row[k] = if is_dependent(&self.qr.r, n, k) { 0.0 } else { (unit - sum) / diagonal };
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

/// Takes out of x what the columns of Q have of it; returns how much.
fn taken_out(q: &[f64], x: &mut [f64]) -> Vec<f64> {
    let mut overlaps = Vec::new();
    for column in q.chunks_exact(x.len()) {
        let overlap: f64 = column.iter().zip(x.iter()).map(|(q, x)| q * x).sum();
        x.iter_mut().zip(column).for_each(|(x, q)| *x -= overlap * q);
        overlaps.push(overlap);
    }
    overlaps
}

fn is_dependent(r: &[f64], n: usize, k: usize) -> bool {
    let length: f64 = r[k * n..=k * n + k].iter().map(|r| r * r).sum::<f64>().sqrt();
    r[k + k * n].abs() <= DEPENDENT_COLUMN_RTOL * length
}

/// R⁻¹x.
fn back_substituted(r: &[f64], n: usize, mut x: Vec<f64>) -> Vec<f64> {
    for k in (0..n).rev() {
        x[k] = if is_dependent(r, n, k) { 0.0 } else { x[k] / r[k + k * n] };
        for i in 0..k {
            x[i] -= x[k] * r[i + k * n];
        }
    }
    x
}
