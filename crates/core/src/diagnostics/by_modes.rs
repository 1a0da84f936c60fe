//! Values of several unknowns by the natural frequencies of the measurement.
//!
//! Whatever sign, unit or place is wrong, resonances are where they are. A grid over several unknowns has few points near the right one; the modes of the model,
//! paired with those of the measurement, lead there in a few steps of Rayleigh's quotient.

use super::few::Measured;
use super::moduli::{Moduli, Parametrization};
use crate::c64;
use crate::for_each::ForEach;
use crate::frequency::omega_rad_s;
use crate::frfs::{Noise, standard_deviations};
use crate::identify::{Problem, ShownModes};
use crate::median::median;
use crate::modal::{
    LOG_FACTOR_STD, LOG_FREQUENCY_STD, Pair, PairedShape, Pairing, paired, stiffness_factors,
};
use crate::model::ModelAt;
use crate::subspace::Projection;
use frfit_linalg::vector::norm;
use std::f64::consts::TAU;

/// Steps of Rayleigh's quotient.
const ROUNDS: usize = 4;

/// Modes up to this many times the highest frequency, and so many at most.
const MODES_ABOVE_BAND: f64 = 1.5;
const MAX_MODES: usize = 60;

/// Fewer pairs say nothing, nor do those of less than this part of the measured modes.
const MIN_PAIRS: usize = 3;
const MIN_PAIRED: f64 = 0.5;

/// No loss factor is smaller: noise may make it zero.
const MIN_LOSS_FACTOR: f64 = 1e-5;

/// The modes of the measurement.
///
/// Shapes are not compared: a sensor may be at fault. What is left of the residues is their size.
struct Partners {
    shapes: Vec<PairedShape>,
    loss_factors: Vec<f64>,
    /// Where the model has the sensors of the shapes.
    sensors: Vec<usize>,
    highest_rad_s: f64,
}

/// Values of the unknowns with which the modes of the model are those of the measurement; `None` where too few of these have a partner. `sensors` says which of the model's
/// sensors the measured ones are.
pub(super) fn moduli_by_modes(
    problem: &Problem<'_>,
    (model, sensors): (&Projection, &[usize]),
    measured: Measured<'_>,
    (parametrization, frequency_hz): (&Parametrization, &[f64]),
    for_each: ForEach<'_>,
) -> Option<Moduli> {
    let partners = Partners::new(problem, sensors, measured, for_each)?;
    let (mut moduli, mut loss_factor) = (parametrization.nominal(), 0.0);
    let middle = frequency_hz.len() / 2;
    for _ in 0..ROUNDS {
        let at = problem.at(*frequency_hz.get(middle)?, &parametrization.values(&moduli, middle)).ok()?;
        loss_factor = partners.lead(&mut moduli, parametrization, (model, &at))?;
    }
    if parametrization.has_loss()[0] {
        moduli.ln_loss = parametrization.ln_loss(loss_factor.max(MIN_LOSS_FACTOR).atan());
    }
    Some(moduli)
}

impl Partners {
    fn new(
        problem: &Problem<'_>,
        sensors: &[usize],
        measured: Measured<'_>,
        for_each: ForEach<'_>,
    ) -> Option<Self> {
        let omegas: Vec<f64> = problem.frfs().frequency_hz.iter().map(|&f| omega_rad_s(f)).collect();
        let noise = measured.std.map_or(Noise::Unknown, Noise::Known);
        let std = standard_deviations(measured.receptance, noise);
        let decay_per_s = problem.model().decay_per_s();
        let shown = ShownModes::new(&omegas, (measured.receptance, &std), decay_per_s, for_each)?;
        Some(Self {
            shapes: shown
                .modes
                .iter()
                .map(|mode| of_size(mode.frequency_hz(), &mode.residues, 1.0))
                .collect(),
            loss_factors: shown.modes.iter().map(|mode| 2.0 * mode.damping_ratio()).collect(),
            sensors: shown.sensors.iter().map(|&m| sensors.get(m).copied()).collect::<Option<_>>()?,
            highest_rad_s: MODES_ABOVE_BAND * omegas.last()?,
        })
    }

    /// Moves unknown stiffnesses by Rayleigh's quotient from where the model is, and returns the usual loss factor of the modes that have a partner.
    fn lead(
        &self,
        moduli: &mut Moduli,
        parametrization: &Parametrization,
        (model, at): (&Projection, &ModelAt<'_>),
    ) -> Option<f64> {
        let free: Vec<(usize, [f64; 2])> =
            parametrization.free().filter(|(j, _)| at.is_stiffness(*j)).collect();
        let modes = model.modes(at, c64::default(), self.highest_rad_s, MAX_MODES).ok()?;
        let elastic = (0..modes.omega_rad_s.len()).filter(|&i| modes.omega_rad_s[i] > 0.0);
        let of_mode = |i: usize| -> (PairedShape, Vec<f64>) {
            let omega = modes.omega_rad_s[i];
            let shares: Vec<f64> = free.iter().map(|(j, _)| modes.unknown_shares[i][*j]).collect();
            let residues = modes.residues(i, omega, &self.sensors);
            (of_size(omega / TAU, &residues, shares.iter().sum()), shares)
        };
        let (own, shares): (Vec<PairedShape>, Vec<Vec<f64>>) = elastic.map(of_mode).unzip();
        let Pairing { pairs, stiffness_factor } = paired(&own, &self.shapes);
        if pairs.len() < MIN_PAIRS || (pairs.len() as f64) < MIN_PAIRED * self.shapes.len() as f64 {
            return None;
        }
        let common = stiffness_factor.ln();
        let rest =
            |pair: &Pair| -2.0 * pair.frequency_difference.ln_1p() - common * own[pair.model].energy_share;
        let rests: Vec<f64> = pairs.iter().map(rest).collect();
        let of_pairs = pairs.iter().map(|pair| &*shares[pair.model]);
        let (factors, _) = stiffness_factors(of_pairs, &rests, [2.0 * LOG_FREQUENCY_STD, LOG_FACTOR_STD])?;
        for ((j, [low, high]), factor) in free.into_iter().zip(factors) {
            moduli.ln_sizes[j] = (moduli.ln_sizes[j] + common + factor).clamp(low, high);
        }
        median(pairs.iter().map(|pair| self.loss_factors[pair.measured]).collect())
    }
}

fn of_size(frequency_hz: f64, residues: &[c64], energy_share: f64) -> PairedShape {
    PairedShape { frequency_hz, residues: vec![c64::from(norm(residues))], energy_share }
}
