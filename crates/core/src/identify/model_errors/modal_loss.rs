//! What a smooth loss factor may owe to the damping of single modes.
//!
//! A support that gives and the air damp each mode in their own way. A curve through the loss factors of few modes takes that for the material. Of errors δ of natural
//! frequencies a stiffness that is not in the model has 2δ of the strain energy, and with its own loss factor η_s adds 2δ η_s. So what the curve is off its level,
//! up to that, may be of the modes: the covariance has the step to the level, in which the response stays the same,
//! $\varphi(\omega) \\to \bar\varphi$ and $\eta_i \\to \eta_i \\, (1 + (\varphi(\omega_i) - \bar\varphi)/\varphi(\omega_i))$.
//!
//! # Limits
//! What all modes have in common is no part of it (`common_loss`). A right model has no such errors: a support that damps and does not give is not seen.

use super::fitting::Fitting;
use super::sizes::{Sizes, UNDAMPED_SHARE_RATIO};

/// η_s: rubber has more, a clamp of steel less.
const LOSS_FACTOR_OF_MISSING_STIFFNESS: f64 = 0.3;

/// Standard deviations that a curve is off its level by chance.
const SIGNIFICANT_STD: f64 = 2.0;

/// Adds that step to the covariance of θ and the errors, n × n, where the only unknown is a smooth stiffness with damping. Errors of stiffness begin at `first_error`.
pub(super) fn add_modal_loss(
    covariance: &mut [f64],
    (n, first_error): (usize, usize),
    fitting: &Fitting<'_, '_>,
    theta: &[f64],
    sizes: Sizes,
) {
    let [(unknown, _)] = fitting.damped else { return };
    let is_alone = !fitting.curves.is_beside_others();
    let Some(knots) = fitting.curves.phases(*unknown).filter(|_| is_alone) else { return };
    let share = UNDAMPED_SHARE_RATIO * sizes.frequency.hypot(sizes.usual_trend());
    let most = LOSS_FACTOR_OF_MISSING_STIFFNESS * share;
    // The level is that of the knots that are known best, and as uncertain as the mean of numbers that scatter as they do. What the data leave open is no distance from it.
    let variances: Vec<f64> = knots.clone().map(|k| covariance[k * n + k]).collect();
    let phases = &theta[knots.clone()];
    let weights = || variances.iter().map(|variance| 1.0 / variance);
    let total: f64 = weights().sum();
    let level = weights().zip(phases).map(|(w, phase)| w * phase).sum::<f64>() / total;
    let beyond = |(phase, variance): (&f64, &f64)| {
        let square = (level - phase).powi(2) - SIGNIFICANT_STD.powi(2) * variance;
        square.max(0.0).sqrt().min(most).copysign(level - phase)
    };
    let to_level: Vec<f64> = phases.iter().zip(&variances).map(beyond).collect();
    let squares = weights().zip(&to_level).map(|(w, step)| w * step * step).sum::<f64>();
    let of_level = (squares / total / phases.len() as f64).sqrt();
    for of_knots in [to_level, vec![of_level; knots.len()]] {
        let mut step = vec![0.0; n];
        step[knots.clone()].copy_from_slice(&of_knots);
        in_modes(&mut step, first_error, fitting, (*unknown, theta));
        for a in (0..n).filter(|&a| step[a] != 0.0) {
            let row = covariance[a * n..][..n].iter_mut().zip(&step);
            row.for_each(|(covariance, other)| *covariance += step[a] * other);
        }
    }
}

/// The errors of loss factors that leave the response as it is where a curve makes a step.
fn in_modes(
    step: &mut [f64],
    first_error: usize,
    fitting: &Fitting<'_, '_>,
    (unknown, theta): (usize, &[f64]),
) {
    let modes = fitting.modes;
    for (error, &mode) in modes.of_error.iter().enumerate() {
        let line = fitting.omegas.partition_point(|omega| *omega < modes.omega_rad_s[mode]);
        let is_in_band = line > 0 && line < fitting.omegas.len();
        let is_of_unknown = modes.group[error] + 1 == modes.groups();
        if modes.is_of_frequency(error) || !is_in_band || !is_of_unknown {
            continue;
        }
        let [phase, change] = [theta, &*step].map(|of| fitting.curves.phase_at(unknown, of, line));
        if phase > 0.0 {
            step[first_error + error] = -change / phase;
        }
    }
}
