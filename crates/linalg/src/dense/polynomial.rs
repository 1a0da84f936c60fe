//! All roots of a polynomial whose coefficients may span hundreds of orders of magnitude.
//!
//! The roots of a truncated power series are the use: coefficients fall or grow like the k-th power of a
//! radius, companion eigenvalues of them lose everything. Here the variable is scaled first, starting
//! points come from the Newton polygon (one circle for each edge, which is what balancing is for), and all roots are
//! iterated together by the Ehrlich–Aberth correction until each satisfies the polynomial to roundoff.
//!
//! # Source
//! O. Aberth, Math. Comp. 27 (1973) 339–344; D. A. Bini, Numer. Algorithms 13 (1996) 179–200.

use crate::c64;

/// A root and how well it satisfies the polynomial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    /// z.
    pub value: c64,
    /// |p(z)| / Σ |a_k||z|^k: the relative change of the coefficients that makes z exact.
    pub backward_error: f64,
}

/// p(z) = Σ a_k z^k by Horner's rule; `coefficients[k]` is a_k.
pub fn evaluate(coefficients: &[c64], z: c64) -> c64 {
    coefficients.iter().rev().fold(c64::default(), |sum, &a| sum * z + a)
}

/// All finite roots of Σ a_k z^k; `coefficients[k]` is a_k.
///
/// Leading zero coefficients are dropped (their roots are at infinity), trailing ones give roots 0. A
/// polynomial of degree 0, or one with a coefficient that is not finite, has none.
///
/// # Limits
/// An m-fold root is found as m roots spread over ε^{1/m}; each of them still has a small backward error.
pub fn roots(coefficients: &[c64]) -> Vec<Root> {
    if !coefficients.iter().all(|a| a.re.is_finite() && a.im.is_finite()) {
        return Vec::new();
    }
    let Some(last) = coefficients.iter().rposition(|a| a.norm() > 0.0) else { return Vec::new() };
    let first = coefficients.iter().position(|a| a.norm() > 0.0).unwrap_or(last);
    let zeros = (0..first).map(|_| Root { value: c64::default(), backward_error: 0.0 });
    let scaled = Scaled::new(&coefficients[first..=last]);
    zeros.chain(scaled.roots()).collect()
}

/// Σ b_k w^k with z = γ w, |b₀| = |b_n| and max |b_k| = 1.
struct Scaled {
    gamma: f64,
    ascending: Vec<c64>,
    descending: Vec<c64>,
    log_modulus: Vec<f64>,
}

/// Iterations: from Newton-polygon starts simple roots need about ten; clusters more.
const MAX_SWEEPS: usize = 200;

impl Scaled {
    fn new(coefficients: &[c64]) -> Self {
        let degree = coefficients.len() - 1;
        let log = |a: c64| a.norm().ln();
        let log_gamma = if degree == 0 {
            0.0
        } else {
            (log(coefficients[0]) - log(coefficients[degree])) / degree as f64
        };
        let shifted: Vec<f64> =
            coefficients.iter().enumerate().map(|(k, &a)| log(a) + k as f64 * log_gamma).collect();
        let top = shifted.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let log_modulus: Vec<f64> = shifted.iter().map(|s| s - top).collect();
        let ascending: Vec<c64> = coefficients
            .iter()
            .zip(&log_modulus)
            .map(|(&a, &l)| if a.norm() > 0.0 { a / a.norm() * l.exp() } else { c64::default() })
            .collect();
        let descending = ascending.iter().rev().copied().collect();
        Self { gamma: log_gamma.exp(), ascending, descending, log_modulus }
    }

    fn roots(&self) -> Vec<Root> {
        let mut w = self.starts();
        let mut done = vec![false; w.len()];
        for _ in 0..MAX_SWEEPS {
            for i in 0..w.len() {
                if !done[i] {
                    (w[i], done[i]) = self.step(&w, i);
                }
            }
            if done.iter().all(|&d| d) {
                break;
            }
        }
        w.iter().map(|&w| Root { value: w * self.gamma, backward_error: self.backward_error(w) }).collect()
    }

    /// One Ehrlich–Aberth correction of root i: w − 1/(p′/p − Σ 1/(w − w_j)).
    fn step(&self, w: &[c64], i: usize) -> (c64, bool) {
        let here = w[i];
        let (value, bound, log_derivative) = self.near(here);
        // Below the roundoff of the evaluation itself nothing can be gained.
        if value <= 2.0 * f64::EPSILON * bound {
            return (here, true);
        }
        let repulsion: c64 =
            (0..w.len()).filter(|&j| j != i && w[j] != here).map(|j| (here - w[j]).inv()).sum();
        let step = (log_derivative - repulsion).inv();
        if !step.re.is_finite() || !step.im.is_finite() {
            // On a zero of the derivative: step aside by a fraction of its own size.
            return (here * c64::new(1.0, 1e-3), false);
        }
        let next = here - step;
        (next, step.norm() <= 0.5 * f64::EPSILON * next.norm())
    }

    /// |p|, Σ|b_k||w|^k and p′/p at w; outside the unit circle from the reversed polynomial, so that no power overflows.
    fn near(&self, w: c64) -> (f64, f64, c64) {
        let inside = w.norm() <= 1.0;
        let (coefficients, point) = if inside { (&self.ascending, w) } else { (&self.descending, w.inv()) };
        let (mut p, mut dp, mut bound) = (c64::default(), c64::default(), 0.0);
        for &b in coefficients.iter().rev() {
            dp = dp * point + p;
            p = p * point + b;
            bound = bound * point.norm() + b.norm();
        }
        let ratio = dp / p;
        let degree = (coefficients.len() - 1) as f64;
        let log_derivative = if inside { ratio } else { point * (c64::new(degree, 0.0) - point * ratio) };
        (p.norm(), bound, log_derivative)
    }

    fn backward_error(&self, w: c64) -> f64 {
        let (value, bound, _) = self.near(w);
        value / bound
    }

    /// Points on circles whose radii are the slopes of the upper hull of (k, log|b_k|).
    fn starts(&self) -> Vec<c64> {
        let hull = upper_hull(&self.log_modulus);
        let mut starts = Vec::new();
        for (edge, pair) in hull.windows(2).enumerate() {
            let (i, j) = (pair[0], pair[1]);
            let count = j - i;
            let radius = ((self.log_modulus[i] - self.log_modulus[j]) / count as f64).exp();
            for m in 0..count {
                // The offset keeps starts off every axis of symmetry that coefficients may have.
                let angle = std::f64::consts::TAU * (m as f64 + 0.35) / count as f64 + 0.7 * edge as f64;
                starts.push(c64::from_polar(radius, angle));
            }
        }
        starts
    }
}

/// Indices of the upper convex hull of the points (k, y_k); y_k = −∞ is skipped.
fn upper_hull(y: &[f64]) -> Vec<usize> {
    let mut hull: Vec<usize> = Vec::new();
    for k in (0..y.len()).filter(|&k| y[k] > f64::NEG_INFINITY) {
        while let [.., a, b] = hull[..] {
            let turn = (b - a) as f64 * (y[k] - y[a]) - (k - a) as f64 * (y[b] - y[a]);
            if turn < 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(k);
    }
    hull
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::{Matrix, eigen};
    use proptest::prelude::*;

    fn c(re: f64, im: f64) -> c64 {
        c64::new(re, im)
    }

    fn from_roots(roots: &[c64]) -> Vec<c64> {
        roots.iter().fold(vec![c(1.0, 0.0)], |p, &r| {
            let mut next = vec![c64::default(); p.len() + 1];
            for (k, &a) in p.iter().enumerate() {
                next[k + 1] += a;
                next[k] -= r * a;
            }
            next
        })
    }

    fn distance_to_nearest(root: c64, found: &[Root]) -> f64 {
        found.iter().map(|f| (f.value - root).norm()).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn degenerate_polynomials() {
        assert!(roots(&[]).is_empty());
        assert!(roots(&[c(0.0, 0.0); 3]).is_empty());
        assert!(roots(&[c(2.0, 0.0)]).is_empty());
        assert!(roots(&[c(1.0, 0.0), c(f64::NAN, 0.0)]).is_empty());
        // 0·z³ + z² + z = z(z + 1): one root at infinity is dropped.
        let found = roots(&[c(0.0, 0.0), c(1.0, 0.0), c(1.0, 0.0), c(0.0, 0.0)]);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].value, c(0.0, 0.0));
        assert!((found[1].value - c(-1.0, 0.0)).norm() < 1e-15);
    }

    #[test]
    fn coefficients_over_four_hundred_orders_of_magnitude() {
        // Σ z^k 10^{−20 k}: the geometric series at radius 1e20, roots on that circle.
        let coefficients: Vec<c64> = (0..=15).map(|k| c(10f64.powi(-20 * k), 0.0)).collect();
        let found = roots(&coefficients);
        assert_eq!(found.len(), 15);
        for root in &found {
            // Well-conditioned roots of unity: roundoff of 15 terms.
            assert!((root.value.norm() / 1e20 - 1.0).abs() < 1e-13 && root.backward_error < 1e-14);
        }
    }

    #[test]
    fn radii_of_very_different_size() {
        let planted = [c(1e-60, 1e-60), c(-3.0, 0.5), c(2e40, -1e40), c(0.0, 7e90)];
        let found = roots(&from_roots(&planted));
        for root in planted {
            assert!(distance_to_nearest(root, &found) < 1e-13 * root.norm());
        }
    }

    #[test]
    fn a_double_root_splits_by_the_square_root_of_roundoff() {
        let found = roots(&from_roots(&[c(1.0, 1.0), c(1.0, 1.0), c(-2.0, 0.0)]));
        assert_eq!(found.iter().filter(|f| (f.value - c(1.0, 1.0)).norm() < 1e-7).count(), 2);
        assert!(found.iter().all(|f| f.backward_error < 1e-14));
    }

    #[test]
    fn agrees_with_companion_eigenvalues() {
        // Well scaled, so the companion matrix is a fair and independent oracle.
        let coefficients: Vec<c64> =
            (0..=12).map(|k| c((k * k % 7) as f64 - 2.5, (k % 3) as f64 - 0.7)).collect();
        let lead = coefficients[12];
        let companion = Matrix::from_fn(12, 12, |i, j| {
            if j == 11 { -coefficients[i] / lead } else { c(f64::from(u8::from(i == j + 1)), 0.0) }
        });
        let found = roots(&coefficients);
        for value in eigen(&companion).unwrap().values {
            assert!(distance_to_nearest(value, &found) < 1e-10); // QR on a 12 × 12: ‖C‖ ε times condition
        }
    }

    proptest! {
        #[test]
        fn every_root_satisfies_the_polynomial(
            parts in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 2..40),
            log_scale in -8.0f64..8.0,
        ) {
            let coefficients: Vec<c64> = parts
                .iter()
                .enumerate()
                .map(|(k, &(re, im))| c(re, im) * 10f64.powf(log_scale * k as f64))
                .collect();
            prop_assume!(coefficients.iter().all(|a| a.norm() > 0.0));
            let found = roots(&coefficients);
            prop_assert_eq!(found.len(), coefficients.len() - 1);
            for root in &found {
                // A few units of roundoff for each of at most 40 terms.
                prop_assert!(root.backward_error < 1e-13, "{:?}", root);
            }
            // No root is reported twice for another: the product of all is ± a₀/a_n.
            let log_product: f64 = found.iter().map(|r| r.value.norm().ln()).sum();
            let expected = (coefficients[0].norm() / coefficients[coefficients.len() - 1].norm()).ln();
            prop_assert!((log_product - expected).abs() < 1e-6 * (1.0 + expected.abs()));
        }
    }
}
