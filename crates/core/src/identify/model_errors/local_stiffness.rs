//! The compliance of the structure around an unknown spring or joint.
//!
//! A spring acts at a few points. The structure around them has a compliance that is a part x of the spring's. A beam or a plate in place of a solid, or a coarse mesh, lacks
//! it. The spring that is found has both, $\ln E_j - x \\, (1 + i (\eta_k - \eta_j))$ with the loss factor η_k of what is around. The error of |E_j| is in its bar, since
//! natural frequencies show it. That of the loss factor is in none: errors δ_i of natural frequencies keep their damping.

use super::curve::Curves;
use super::fitting::{Fitting, middle};
use crate::c64;
use crate::material::loss_factor;
use crate::model::Role;
use frfit_linalg::dense::Cholesky;
use frfit_linalg::sparse::{SymmetricMatrix, Values};

/// Standard deviation of x: of bricks in place of beams springs were found 5 to 20 % too soft.
const LOCAL_COMPLIANCE_STD: f64 = 0.1;

/// A stiffness with fewer entries than this, over the rows of the model, acts at a few points.
const MAX_LOCAL_ENTRIES: f64 = 0.2;

/// Adds to the covariance of θ and the errors, n × n, what x does to the phase of each unknown stiffness that acts at a few points. `None` where a value is not finite.
pub(super) fn add_local_compliance(
    covariance: &mut [f64],
    n: usize,
    fitting: &Fitting<'_, '_>,
    theta: &[f64],
) -> Option<()> {
    let line = middle(fitting.lines);
    let omega = fitting.omegas[line];
    let (values, slopes) = fitting.curves.values(theta, line, omega)?;
    let at = (fitting.point)(line, &values)?.at;
    let stiffnesses = (0..values.len()).filter(|&j| at.is_stiffness(j));
    let (local, around): (Vec<usize>, Vec<usize>) =
        stiffnesses.partition(|&j| at.terms_of(j).all(|(_, term)| is_local(&term.matrix)));
    let known =
        at.model.terms().iter().enumerate().filter(|(term, one)| {
            one.role == Role::Stiffness && !at.is_unknown(*term) && !is_local(&one.matrix)
        });
    let known = known.filter_map(|(_, one)| one.factor.at(at.frequency_hz).ok());
    let around: Vec<f64> = around.into_iter().map(|k| values[k]).chain(known).map(loss_factor).collect();
    for &j in &local {
        let difference = |other: &f64| (other - loss_factor(values[j])).abs();
        let largest = around.iter().map(difference).fold(0.0, f64::max);
        // ∂ ln E_j/∂θ.
        let log = |&(k, slope): &(usize, c64)| if k == j { slope / values[j] } else { c64::default() };
        let Some(turn) = turn(fitting.curves, j, &slopes.iter().map(log).collect::<Vec<_>>()) else {
            continue;
        };
        let variance = (LOCAL_COMPLIANCE_STD * largest).powi(2);
        for (a, b) in (0..turn.len()).flat_map(|a| (0..turn.len()).map(move |b| (a, b))) {
            covariance[a * n + b] += variance * turn[a] * turn[b];
        }
    }
    Some(())
}

fn is_local(matrix: &SymmetricMatrix) -> bool {
    let entries = match matrix.values() {
        Values::Real(values) => values.iter().filter(|value| **value != 0.0).count(),
        Values::Complex(values) => values.iter().filter(|value| value.norm() != 0.0).count(),
    };
    entries as f64 <= MAX_LOCAL_ENTRIES * matrix.dim() as f64
}

/// The step of θ that turns E_j by one radian and keeps |E_j|: of a curve at all knots, of what has few numbers the shortest one. `None` where E is real.
fn turn(curves: &Curves, unknown: usize, logs: &[c64]) -> Option<Vec<f64>> {
    let mut step = vec![0.0; logs.len()];
    if curves.smooth().contains(&unknown) {
        curves.set_phase(&mut step, unknown, 1.0);
        return Some(step);
    }
    let sum = |of: fn(&c64) -> f64| logs.iter().map(of).sum::<f64>();
    let mut weights = [0.0, 1.0];
    let both = sum(|log| log.re * log.im);
    let matrix = [sum(|log| log.re * log.re), both, both, sum(|log| log.im * log.im)];
    Cholesky::new(2, &matrix).ok()?.solve(&mut weights);
    step.iter_mut().zip(logs).for_each(|(step, log)| *step = weights[0] * log.re + weights[1] * log.im);
    Some(step).filter(|step| step.iter().all(|own| own.is_finite()))
}
