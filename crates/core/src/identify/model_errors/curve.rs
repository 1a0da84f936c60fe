//! A factor over the band with few numbers: a law, or a smooth curve.

use crate::c64;
use crate::laws::Parametrization;

/// E(ω; θ).
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Curve {
    /// A law of the modulus.
    Law(Parametrization),
    /// ln E as a natural cubic spline over ln ω.
    Spline(Spline),
}

/// A natural cubic spline of ln E over ln ω by its values at knots: θ is ln|E| at the knots, then the phase at the knots unless E is real.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spline {
    /// What each knot has at each line, `[line][knot]`.
    weights: Vec<Vec<f64>>,
    /// Distance of the knots in ln ω.
    step: f64,
    real: bool,
}

/// Knots at most this far apart, in ln ω, and so many at least.
const KNOT_DISTANCE: f64 = 0.5;
const LEAST_KNOTS: usize = 8;

/// Second differences of ln|E| and of the phase over knots that are `KNOT_DISTANCE` apart: a viscoelastic transition
/// changes its slope by that over half an octave.
const BEND: [f64; 2] = [0.3, 0.15];

/// What is known of ln|E| and of the phase before anything is measured.
const WIDTH: [f64; 2] = [3.0, 1.0];

/// What is known of a law's coordinates, logarithms and logits, before anything is measured.
const LAW_WIDTH: f64 = 10.0;

impl Spline {
    pub(super) fn new(omegas: &[f64], real: bool) -> Self {
        let x: Vec<f64> = {
            let least = omegas.iter().copied().find(|&omega| omega > 0.0).unwrap_or(1.0);
            omegas.iter().map(|omega| omega.max(least).ln()).collect()
        };
        let (first, last) = (x[0], x[x.len() - 1].max(x[0] + 1e-6));
        let knots = (1 + ((last - first) / KNOT_DISTANCE).ceil() as usize).max(LEAST_KNOTS);
        let step = (last - first) / (knots - 1) as f64;
        let bends = (0..knots).map(|k| bends(knots, k)).collect::<Vec<_>>();
        let at = |x: &f64| {
            let u = ((x - first) / step).clamp(0.0, (knots - 1) as f64);
            let j = (u as usize).min(knots - 2);
            let (b, a) = (u - j as f64, 1.0 - (u - j as f64));
            let value = |k: usize| {
                let on = |i: usize| if i == k { 1.0 } else { 0.0 };
                let bend = |i: usize| bends[k][i];
                a * on(j) + b * on(j + 1) + ((a * a * a - a) * bend(j) + (b * b * b - b) * bend(j + 1)) / 6.0
            };
            (0..knots).map(value).collect()
        };
        Self { weights: x.iter().map(at).collect(), step, real }
    }

    fn knots(&self) -> usize {
        self.weights[0].len()
    }

    /// ln E at a line.
    fn log(&self, theta: &[f64], line: usize) -> c64 {
        let sum = |part: &[f64]| self.weights[line].iter().zip(part).map(|(w, t)| w * t).sum::<f64>();
        let n = self.knots();
        c64::new(sum(&theta[..n]), if self.real { 0.0 } else { sum(&theta[n..]) })
    }
}

/// Second derivatives, in units of the knots' distance, of the natural spline that is one at the k-th of n knots.
fn bends(n: usize, k: usize) -> Vec<f64> {
    let value = |i: usize| if i == k { 1.0 } else { 0.0 };
    // M_{i−1} + 4M_i + M_{i+1} = 6(y_{i−1} − 2y_i + y_{i+1}), M = 0 at the ends (Thomas's elimination).
    let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        let rest = 6.0 * (value(i - 1) - 2.0 * value(i) + value(i + 1));
        let pivot = 4.0 - upper[i - 1];
        upper[i] = 1.0 / pivot;
        right[i] = (rest - right[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        right[i] -= upper[i] * right[i + 1];
    }
    right
}

impl Curve {
    /// How many numbers.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Law(law) => law.family.count(),
            Self::Spline(spline) => spline.knots() * if spline.real { 1 } else { 2 },
        }
    }

    /// E at a line, and ∂E/∂θ; `None` where a number is not finite.
    pub(super) fn modulus(&self, theta: &[f64], line: usize, omega: f64) -> Option<(c64, Vec<c64>)> {
        match self {
            Self::Law(law) => law.modulus(theta, omega),
            Self::Spline(spline) => {
                let modulus = spline.log(theta, line).exp();
                let of = |unit: c64| spline.weights[line].iter().map(move |&w| modulus * unit * w);
                let mut slopes: Vec<c64> = of(c64::new(1.0, 0.0)).collect();
                if !spline.real {
                    slopes.extend(of(c64::I));
                }
                modulus.is_finite().then_some((modulus, slopes))
            }
        }
    }

    /// The prior's precision, n × n, about the same θ as that of the other fits of this curve.
    pub(super) fn precision(&self) -> Vec<f64> {
        let n = self.count();
        let mut precision = vec![0.0; n * n];
        let Self::Spline(spline) = self else {
            (0..n).for_each(|i| precision[i * n + i] = LAW_WIDTH.powi(-2));
            return precision;
        };
        let knots = spline.knots();
        // An integrated Wiener process: second differences grow with the 3/2 power of the distance.
        let scale = (spline.step / KNOT_DISTANCE).powf(1.5);
        for part in 0..n / knots {
            let first = part * knots;
            (first..first + knots).for_each(|i| precision[i * n + i] += WIDTH[part].powi(-2) / knots as f64);
            for k in first + 1..first + knots - 1 {
                let bend = [(k - 1, 1.0), (k, -2.0), (k + 1, 1.0)];
                for (i, a) in bend {
                    for (j, b) in bend {
                        precision[i * n + j] += a * b / (scale * BEND[part]).powi(2);
                    }
                }
            }
        }
        precision
    }

    /// θ nearest to moduli with weights (inverse variances of ln E) at some lines; of a spline.
    pub(super) fn through(&self, data: &[(usize, c64, f64)]) -> Option<Vec<f64>> {
        let Self::Spline(spline) = self else { return None };
        let n = self.count();
        let knots = spline.knots();
        let mut normal = self.precision();
        let mut right = vec![0.0; n];
        // The prior is about the mean of the data, not about one.
        let total: f64 = data.iter().map(|(_, _, weight)| weight).sum();
        let mean: c64 = data.iter().map(|(_, modulus, weight)| modulus.ln() * *weight).sum::<c64>() / total;
        for &(line, modulus, weight) in data {
            let rest = modulus.ln() - mean;
            for (part, value) in [rest.re, rest.im].into_iter().enumerate().take(n / knots) {
                for (i, a) in spline.weights[line].iter().enumerate() {
                    right[part * knots + i] += weight * a * value;
                    for (j, b) in spline.weights[line].iter().enumerate() {
                        normal[(part * knots + i) * n + part * knots + j] += weight * a * b;
                    }
                }
            }
        }
        frfit_linalg::dense::Cholesky::new(n, &normal).ok()?.solve(&mut right);
        for (k, theta) in right.iter_mut().enumerate() {
            *theta += if k < knots { mean.re } else { mean.im };
        }
        right.iter().all(|theta| theta.is_finite()).then_some(right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cubics with no bend at the ends are their own natural splines; slopes are those of finite differences.
    #[test]
    fn straight_lines_are_kept_and_slopes_are_right() {
        let omegas: Vec<f64> = (1..=200).map(|k| 10.0 * f64::from(k)).collect();
        let curve = Curve::Spline(Spline::new(&omegas, false));
        let data: Vec<(usize, c64, f64)> =
            (0..200).map(|k| (k, (c64::new(0.1, 0.2) * omegas[k].ln() + 3.0).exp(), 1e6)).collect();
        let theta = curve.through(&data).unwrap();
        for &(k, modulus, _) in &data {
            let (found, slopes) = curve.modulus(&theta, k, omegas[k]).unwrap();
            assert!((found / modulus - 1.0).norm() < 1e-4, "{k}: {found} {modulus}");
            for j in 0..theta.len() {
                let mut moved = theta.clone();
                moved[j] += 1e-6;
                let (there, _) = curve.modulus(&moved, k, omegas[k]).unwrap();
                assert!(((there - found) / 1e-6 - slopes[j]).norm() < 1e-4 * found.norm());
            }
        }
    }
}
