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
use crate::modal::{Pair, PairedShape, Pairing, paired, stiffness_factors};
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
        let std = standard_deviations(problem.frfs().frequency_hz, measured.receptance, noise);
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
        if free.is_empty() {
            return None;
        }
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
        let of_pair = |pair: &Pair| (&*shares[pair.model], -pair.frequency_difference.ln_1p());
        let (factors, _) = stiffness_factors(pairs.iter().map(of_pair), common)?;
        for ((j, [low, high]), factor) in free.into_iter().zip(factors) {
            moduli.ln_sizes[j] = (moduli.ln_sizes[j] + common + factor).clamp(low, high);
        }
        median(pairs.iter().map(|pair| self.loss_factors[pair.measured]).collect())
    }
}

fn of_size(frequency_hz: f64, residues: &[c64], energy_share: f64) -> PairedShape {
    PairedShape { frequency_hz, residues: vec![c64::from(norm(residues))], energy_share }
}

#[cfg(test)]
mod tests {
    use super::super::responses::{over_the_box, trained};
    use super::*;
    use crate::for_each::sequential;
    use crate::frequency::linear_hz;
    use crate::frfs::Frfs;
    use crate::identify::{Options, Unknown, Variation};
    use crate::material::Law;
    use crate::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
    use crate::quantity::Quantity;
    use crate::roots::Bounds;
    use frfit_linalg::sparse::Triplets;

    const PARTS: usize = 4;
    const MASSES_OF_PART: usize = 6;

    /// A chain of four parts on a spring that each have a stiffness of their own.
    fn chain(stiffness: [f64; PARTS]) -> DynamicStiffness {
        let n = PARTS * MASSES_OF_PART;
        let term = |name: String, role, matrix: Triplets, factor| Term {
            name,
            role,
            matrix: matrix.assemble(),
            factor: Law::Constant(factor),
        };
        let part = |(p, k): (usize, f64)| {
            let mut springs = Triplets::new(n);
            for i in p * MASSES_OF_PART..(p + 1) * MASSES_OF_PART {
                springs.add_element(&[i.checked_sub(1), Some(i)], &[1.0, -1.0, -1.0, 1.0]);
            }
            term(format!("part {p}"), Role::Stiffness, springs, c64::new(k, 0.01 * k))
        };
        let mut mass = Triplets::new(n);
        (0..n).for_each(|i| mass.add(i, i, 1.0));
        let mass = term("mass".to_owned(), Role::Mass, mass, c64::new(1.0, 0.0));
        let parts = stiffness.into_iter().enumerate().map(part);
        DynamicStiffness::new(parts.chain([mass]).collect()).unwrap()
    }

    /// Four stiffnesses are 23 to 40 % off, and the response is of the opposite sense and in another unit.
    #[test]
    fn resonances_lead_to_four_stiffnesses() {
        let (truth, nominal) = ([1.0, 1.3, 0.8, 1.1], [1.4, 1.0, 1.1, 0.8]);
        let (true_model, model) = (chain(truth), chain(nominal));
        let n = PARTS * MASSES_OF_PART;
        let sensor = |row| Sensor { row, sign: 1.0 };
        let experiment = Experiment::driven_at(n, sensor(n - 1), vec![sensor(n - 1)]);
        let frequency_hz = linear_hz(0.003, 0.2, 400);
        let measured = |&f: &f64| {
            let at = true_model.at(f, &[]).unwrap();
            let mut x = experiment.load.clone();
            true_model.analysis().factor(&at.assemble(&[])).unwrap().solve(&mut x).unwrap();
            experiment.observe(&x).into_iter().map(|x| x / -9.80665).collect()
        };
        let receptance: Vec<Vec<c64>> = frequency_hz.iter().map(measured).collect();
        let unknowns: [Unknown; PARTS] = std::array::from_fn(|p| Unknown {
            varies: Variation::Constant,
            bounds: Bounds { storage: Some([0.2, 5.0]), loss_factor: Some([0.0, 0.1]) },
            ..Unknown::factor_of(&model, &[&format!("part {p}")]).unwrap()
        });
        let noise = Noise::Unknown;
        let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &receptance, noise };
        let problem = Problem::new(&model, &experiment, &unknowns, &[], frfs).unwrap();
        let picked: Vec<f64> = frequency_hz.iter().copied().step_by(10).collect();
        let parametrization = Parametrization::new(&problem, &picked, &Options::default()).unwrap().unwrap();
        let moduli = over_the_box(&parametrization);
        let subspace = trained(&problem, &experiment, &picked, &parametrization, &moduli, &sequential);
        let subspace = subspace.unwrap().unwrap();
        let quantities = [Quantity::Receptance];
        let measured =
            Measured { experiment: &experiment, receptance: &receptance, quantities: &quantities, std: None };
        let found = moduli_by_modes(
            &problem,
            (subspace.projection(), &[0]),
            measured,
            (&parametrization, &picked),
            &sequential,
        )
        .unwrap();
        for (p, ln_size) in found.ln_sizes.iter().enumerate() {
            // Frequencies of partners may differ by 2 %, so that what differs little from part to part is believed only partly.
            let value = nominal[p] * ln_size.exp();
            assert!((value / truth[p] - 1.0).abs() < 0.1, "part {p}: {value} {found:?}");
        }
    }
}
