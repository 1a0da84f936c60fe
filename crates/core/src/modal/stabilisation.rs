//! Poles of measured responses at growing orders: the least-squares complex frequency method.
//!
//! All sensors have one denominator, a polynomial in z = exp(iϑ) where ϑ runs over three quarters of a circle from the first frequency to the last:
//! $$ H_m(\omega) \approx \frac{\sum_{j=0}^{n} b_{mj} z^j}{1 + \sum_{j=1}^{n} a_j z^j}, \qquad
//! \min_{a,b} \sum_{m,k} w_{mk}^2 \Big| \sum_j b_{mj} z_k^j - H_{mk} \sum_j a_j z_k^j \Big|^2 . $$
//! The numerators are eliminated by an orthonormal basis of the powers, once for all orders. With the coefficient of z⁰ fixed, poles of the structure
//! are damped and those of the noise mostly are not. A pole that is there at one order after another is one of the structure.
//!
//! # Source
//! H. Van der Auweraer, P. Guillaume, P. Verboven, S. Vanlanduit, J. Dyn. Syst. Meas. Control 123 (2001) 651–658; B. Cauberghe, P. Guillaume,
//! P. Verboven, S. Vanlanduit, E. Parloo, Mech. Syst. Signal Process. 19 (2005) 989–1014 (which coefficient is fixed).

use super::rational_fit::Measured;
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::frequency::{damping_ratio, natural_frequency_hz, omega_rad_s};
use frfit_linalg::dense::{Matrix, NoConvergence, eigenvalues, least_squares, orthonormal};
use frfit_linalg::vector::dot;

/// A pole at one order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoleAtOrder {
    /// n.
    pub order: usize,
    /// s, 1/s: its imaginary part is the damped natural frequency, its real part less than zero.
    pub pole_per_s: c64,
    /// Whether the order before has it too: its frequency within 1 %, its damping ratio within 5 %.
    pub is_stable: bool,
}

impl PoleAtOrder {
    /// |s|/2π.
    pub fn frequency_hz(&self) -> f64 {
        natural_frequency_hz(self.pole_per_s)
    }

    /// −Re s/|s|.
    pub fn damping_ratio(&self) -> f64 {
        damping_ratio(self.pole_per_s)
    }
}

/// The part of a circle that the band covers: powers of z are nearly orthogonal, and the ends of the band are no neighbours.
const ARC_RAD: f64 = 1.5 * std::f64::consts::PI;

/// Steps of the order.
pub(super) const ORDER_STEP: usize = 2;

/// Differences of a pole between two orders up to which it is called stable, as is usual.
const STABLE_FREQUENCY_RTOL: f64 = 0.01;
const STABLE_DAMPING_RTOL: f64 = 0.05;

/// A pole with more damping than this does not belong to a structure: it stands for what polynomials leave.
pub(super) const MAX_DAMPING_RATIO: f64 = 0.5;

/// Poles of all sensors together at the orders 2, 4, … up to the largest. The orders of a short band end where unknowns are half as many as numbers.
///
/// # Errors
/// [`NoConvergence`] where a response is not finite.
///
/// # Limits
/// Noise biases damping by some per cent, more where a mode is weak: [`measured_modes`](super::measured_modes) refines what is found.
/// Poles of a hysteretic structure are those of positive frequency.
pub(super) fn stabilisation(
    measured: &Measured<'_>,
    max_order: usize,
    for_each: ForEach<'_>,
) -> Result<Vec<PoleAtOrder>, NoConvergence> {
    let Measured { frequency_hz, responses, weights, decay_per_s, .. } = *measured;
    let (n, sensors) = (frequency_hz.len(), measured.sensors());
    let max_order = max_order.min(n / 2);
    if sensors == 0 || max_order < ORDER_STEP || frequency_hz[n - 1] <= frequency_hz[0] {
        return Ok(Vec::new());
    }
    let [first, last] = [frequency_hz[0], frequency_hz[n - 1]].map(omega_rad_s);
    let radians = |f: f64| (omega_rad_s(f) - first) / (last - first) * ARC_RAD;
    let size = max_order + 1;
    let power = |k: usize, j: usize| c64::from_polar(1.0, radians(frequency_hz[k]) * j as f64);
    // Of each sensor YᴴY and QᴴY, with Y = H W z^j and Q an orthonormal basis of W z^j.
    let of_sensor = |m: usize| -> Result<[Matrix; 2], NoConvergence> {
        let own = Matrix::from_fn(n, size, |k, j| weights[k][m] * power(k, j));
        let times = Matrix::from_fn(n, size, |k, j| responses[k][m] * own[(k, j)]);
        let basis = orthonormal(&own)?;
        let product =
            |a: &Matrix, b: &Matrix| Matrix::from_fn(size, size, |i, j| dot(a.column(i), b.column(j)));
        Ok([product(&times, &times), product(&basis, &times)])
    };
    let of_sensors = map(for_each, sensors, of_sensor).into_iter().collect::<Result<Vec<_>, _>>()?;
    let orders: Vec<usize> = (ORDER_STEP..=max_order).step_by(ORDER_STEP).collect();
    let found = map(for_each, orders.len(), |k| {
        let z = roots_at(orders[k], &of_sensors)?;
        let pole = |z: c64| {
            let mut turn = z.arg();
            // The arc from 0 to its end, with half of the rest of the circle on either side.
            let before = 0.5 * (ARC_RAD - std::f64::consts::TAU);
            turn += if turn < before { std::f64::consts::TAU } else { 0.0 };
            let over_arc = (last - first) / ARC_RAD;
            c64::new(z.norm().ln() * over_arc + decay_per_s, first + turn * over_arc)
        };
        let is_structure =
            |s: &c64| s.re < 0.0 && (first..=last).contains(&s.im) && damping_ratio(*s) < MAX_DAMPING_RATIO;
        Ok(z.into_iter().map(pole).filter(is_structure).collect::<Vec<c64>>())
    });
    let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut diagram = Vec::new();
    for (k, poles) in found.iter().enumerate() {
        for &pole_per_s in poles {
            let near = |other: &c64| {
                let [own, other] = [pole_per_s, *other].map(|s| (s.norm(), damping_ratio(s)));
                (own.0 - other.0).abs() <= STABLE_FREQUENCY_RTOL * own.0
                    && (own.1 - other.1).abs() <= STABLE_DAMPING_RTOL * own.1
            };
            let is_stable = k > 0 && found[k - 1].iter().any(near);
            diagram.push(PoleAtOrder { order: orders[k], pole_per_s, is_stable });
        }
    }
    diagram.sort_by(|a, b| a.order.cmp(&b.order).then(a.pole_per_s.im.total_cmp(&b.pole_per_s.im)));
    Ok(diagram)
}

/// The roots of the denominator of one order.
fn roots_at(order: usize, of_sensors: &[[Matrix; 2]]) -> Result<Vec<c64>, NoConvergence> {
    let size = order + 1;
    let mut normal = Matrix::zeros(size, size);
    for [squares, inside] in of_sensors {
        for j in 0..size {
            for i in 0..size {
                let taken = dot(&inside.column(i)[..size], &inside.column(j)[..size]);
                normal[(i, j)] += squares[(i, j)] - taken;
            }
        }
    }
    // a_0 = 1.
    let rest = Matrix::from_fn(order, order, |i, j| normal[(i + 1, j + 1)]);
    let right: Vec<c64> = (1..size).map(|i| -normal[(i, 0)]).collect();
    let a = least_squares(&rest, &right)?.solution;
    // Roots of 1 + a_1 z + … + a_n zⁿ are the inverses of the eigenvalues of its companion matrix.
    let companion = Matrix::from_fn(order, order, |i, j| match (i, j) {
        (0, j) => -a[j],
        (i, j) if i == j + 1 => c64::new(1.0, 0.0),
        _ => c64::default(),
    });
    let inverses = eigenvalues(&companion)?;
    Ok(inverses.into_iter().filter(|z| z.norm() > 0.0).map(|z| 1.0 / z).collect())
}
