//! Natural frequencies and mode shapes of a reduced model, and the same model with errors in them (B-11).
//!
//! With the real pencil (K, M) of the reduced model at some values and its modes y_i (yᵀMy = 1),
//! $$ S_g \leftarrow S_g + \sum_i (e^{2 \delta_i} - 1) \\, (y_i^T S_g y_i) \\, (M y_i)(M y_i)^T $$
//! for the known or the unknown stiffnesses S_g multiplies the natural frequency of mode i by exp(δ_i) with their damping kept (where a part e of the mode's strain energy is in them,
//! e (exp(2δ_i/e) − 1)),
//! $$ S_g \leftarrow S_g + \sum_i \frac{i \eta_i}{1 + i \eta_i} \epsilon_i \\, (y_i^T S_g y_i) \\, (M y_i)(M y_i)^T $$
//! its loss factor η_i by the relative ε_i with its frequency kept; $S_g \leftarrow e^{2e} S_g$ multiplies all natural frequencies by exp(e); a rigid body has no stiffness that could be in error,
//! and $2 \delta_i \omega_1^2$ with the lowest other natural frequency ω_1 is that of a support or a suspension that the model does not have;
//! $$ \ell_m \leftarrow \ell_m + \sum_i a_{mi} \\, (\ell_m^T y_i) \\, M y_i $$
//! changes mode i at sensor m by the relative a_mi, the same with F where the force acts; (1 + g_m) and (1 + g_0) multiply all of ℓ_m and of F where a calibration is off;
//! $$ M \leftarrow M + \sum_m \kappa_m M_m \\, \ell_m \ell_m^T, \qquad M_m^{-1} = \overline{(\ell_m^T y_i)^2} $$
//! is a mass at sensor m that the model does not have, as that of an accelerometer, over the apparent mass M_m of the modes there;
//! $$ f_t \leftarrow e^{\nu_t} (f_t + i \\, \Delta\eta_t \operatorname{Re} f_t) $$
//! changes a known factor;
//! $$ p_j \leftarrow \operatorname{Re} p_j + i(1 + \epsilon) \operatorname{Im} p_j $$
//! the loss factor of every unknown stiffness. What comes out is a reduced model like any other.

use super::assess::{Solutions, weights};
use super::{FactorError, Point, Projection, UnknownLoss};
use crate::c64;
use crate::model::{ModelAt, ParameterAt, Role};
use frfit_linalg::dense::NoConvergence;
use frfit_linalg::solve::Breakdown;
use frfit_linalg::vector::transpose_dot;
use std::sync::Arc;

/// Modes of a reduced model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Modes {
    /// Natural frequencies ω_i, rad/s, ascending; zero of rigid bodies.
    pub(crate) omega_rad_s: Vec<f64>,
    /// y_i, one after the other.
    shapes: Vec<Vec<f64>>,
    /// My_i, one after the other.
    momenta: Vec<Vec<f64>>,
    /// M = Σ factor S_g.
    mass: Vec<(usize, f64)>,
    /// The mode of each error of a stiffness: a mode has one of its natural frequency, and one of its loss factor where it has damping, in the known stiffness, and as many
    /// in that of all unknowns.
    pub(crate) of_error: Vec<usize>,
    /// The same mode, or of a rigid body another one: which of their combinations are modes is not determined, and a support couples them.
    partner: Vec<usize>,
    /// Where it is: 0 and 1 where there is known and unknown stiffness, 0 where there is one of them.
    pub(crate) group: Vec<usize>,
    /// What of the strain energy of each mode is in each group.
    pub(crate) energy_shares: Vec<Vec<f64>>,
    /// What of it is in the terms of each unknown, `[mode][unknown]`.
    pub(crate) unknown_shares: Vec<Vec<f64>>,
    /// What of the stiffness a small error is: 2 of δ_i, iη/(1 + iη) of ε_i.
    share: Vec<c64>,
    /// The part of S_g that belongs to each error, `[g][error]`; empty for parts that are no stiffness.
    stiffness: Vec<Vec<f64>>,
    /// ℓ_m, what of which S_g a mass there is, and the apparent mass M_m.
    directions: Vec<Vec<f64>>,
    mass_part: Option<(usize, f64)>,
    pub(crate) apparent_mass: Vec<f64>,
    /// FᵀVy_i.
    pub(crate) load: Vec<c64>,
    /// ℓ_mᵀVy_i, `[m][i]`.
    pub(crate) sensors: Vec<Vec<f64>>,
}

/// Relative errors of modes and terms.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ModalErrors {
    /// e of all natural frequencies: every stiffness is multiplied by exp(2e).
    pub scale: f64,
    /// ε of the loss factors of unknowns, and of which.
    pub loss: f64,
    pub of_loss: Arc<[UnknownLoss]>,
    /// δ of natural frequencies and ε of loss factors, by [`Modes::of_error`]: the model with them has ω_i exp(δ) and η_i(1 + ε); a rigid body about ω_1 √(2δ).
    pub stiffness: Vec<f64>,
    /// κ_m of the mass at sensor m.
    pub masses: Vec<f64>,
    /// g of the calibrations, of the force and then of each sensor: what it shows is 1 + g times the response. Empty without modes.
    pub gains: Vec<f64>,
    /// a_0i of mode i where the force acts.
    pub load: Vec<f64>,
    /// a_mi of mode i at sensor m.
    pub shape: Vec<Vec<f64>>,
    /// Of known factors.
    pub factors: Vec<FactorError>,
}

impl ModalErrors {
    /// What a right calibration of the force has to be multiplied by.
    fn gain_of_force(&self) -> f64 {
        1.0 + self.gains.first().unwrap_or(&0.0)
    }

    /// The same of sensor m.
    fn gain_of(&self, m: usize) -> f64 {
        1.0 + self.gains.get(m + 1).unwrap_or(&0.0)
    }
}

/// Response and slopes of a model with errors at one frequency.
pub(crate) struct ErrorSlopes {
    /// x_m.
    pub(crate) response: Vec<c64>,
    /// ∂x_m/∂c_j, `[parameter][m]`.
    pub(crate) slopes: Vec<Vec<c64>>,
    /// ∂x_m/∂e.
    pub(crate) scale: Vec<c64>,
    /// ∂x_m/∂ε of the loss factors of unknowns; empty where none is in error.
    pub(crate) loss: Vec<c64>,
    /// ∂x_m/∂δ_i and ∂x_m/∂ε_i, `[m][error]`.
    pub(crate) stiffness: Vec<Vec<c64>>,
    /// ∂x_m/∂κ_n, `[m][n]`.
    pub(crate) masses: Vec<Vec<c64>>,
    /// ∂x_m/∂g_n, `[m][n]`.
    pub(crate) gains: Vec<Vec<c64>>,
    /// ∂x_m/∂a_0i, `[m][i]`.
    pub(crate) load: Vec<Vec<c64>>,
    /// ∂x_m/∂a_mi, `[m][i]`.
    pub(crate) shape: Vec<Vec<c64>>,
    /// ∂x_m/∂ν_t, `[m][t]`.
    pub(crate) factors: Vec<Vec<c64>>,
}

impl ErrorSlopes {
    /// Those of what sensors show that have a share of the response each; all of it without shares.
    pub(crate) fn shown(mut self, shares: &[c64]) -> Self {
        for (m, &share) in shares.iter().enumerate() {
            self.response[m] *= share;
            self.scale[m] *= share;
            self.loss.get_mut(m).into_iter().for_each(|slope| *slope *= share);
            self.slopes.iter_mut().for_each(|of_parameter| of_parameter[m] *= share);
            for of_sensors in [
                &mut self.stiffness,
                &mut self.masses,
                &mut self.gains,
                &mut self.load,
                &mut self.shape,
                &mut self.factors,
            ] {
                of_sensors[m].iter_mut().for_each(|slope| *slope *= share);
            }
        }
        self
    }

    /// By what all modes have in common, of each sensor: e, and ε where it is an error; nothing without modes.
    pub(crate) fn in_common(&self, modes: &Modes) -> impl Iterator<Item = &[c64]> {
        let each = [&self.scale[..], &self.loss].into_iter().filter(|of_sensors| !of_sensors.is_empty());
        each.take(if modes.omega_rad_s.is_empty() { 0 } else { usize::MAX })
    }
}

/// A shift of the pencil that makes rigid bodies definite: this part of the square of the highest frequency.
pub(super) const PENCIL_SHIFT_RATIO: f64 = 1e-4;

/// Squares of natural frequencies below this part of that shift are those of rigid bodies.
const RIGID_BODY_RATIO: f64 = 1e-4;

/// Whether the square of a natural frequency is that of a rigid body.
pub(super) fn is_rigid(square: f64, highest_rad_s: f64) -> bool {
    square <= RIGID_BODY_RATIO * PENCIL_SHIFT_RATIO * highest_rad_s * highest_rad_s
}

/// Below this share of a mode's strain energy an error there does not count as an error of the mode.
const MIN_ENERGY_SHARE: f64 = 0.02;

/// What a mode has at a place counts as at least this part of what modes usually have there: beneath it is a node.
const MAX_USUAL_OVER_OWN: f64 = 30.0;

/// A stiffness is stretched exponentially up to this exponent, and in proportion beyond.
const MAX_EXPONENT: f64 = 1.0;

/// μ = 1/(λ + σ) below this part of the largest is a direction without mass.
const MASSLESS_RATIO: f64 = 1e-12;

impl Projection {
    /// The modes up to some frequency at the correction c of the first parameter.
    ///
    /// # Errors
    /// [`NoConvergence`] where the real stiffness is indefinite, or a number is not finite.
    pub(crate) fn modes(
        &self,
        at: &ModelAt<'_>,
        correction: c64,
        highest_rad_s: f64,
        most: usize,
    ) -> Result<Modes, NoConvergence> {
        let r = self.size;
        let (theta, _) = weights(self, at, correction);
        let role = |g: usize| at.model.terms()[self.parts.term(g)].role;
        let factor = |g: usize| theta[g] / at.model.weight(role(g), at.frequency_hz);
        let factors = |wanted: Role| -> Vec<(usize, f64)> {
            (0..theta.len()).filter(|&g| role(g) == wanted).map(|g| (g, factor(g).re)).collect()
        };
        let of_mass = factors(Role::Mass);
        let mass = self.real_sum(&of_mass);
        let shift = PENCIL_SHIFT_RATIO * highest_rad_s * highest_rad_s;
        let of_stiffness = factors(Role::Stiffness);
        let stiffness = self.real_sum(&of_stiffness);
        let is_unknown = |g: usize| at.is_unknown(self.parts.term(g));
        let is_there = |wanted: &bool| of_stiffness.iter().any(|(g, _)| is_unknown(*g) == *wanted);
        let groups: Vec<bool> = [false, true].into_iter().filter(is_there).collect();
        let shifted: Vec<f64> = stiffness.iter().zip(&mass).map(|(k, m)| k + shift * m).collect();
        // μ = 1/(λ + σ).
        let (mu, simultaneous) = self.simultaneous(&shifted, &mass)?;
        let greatest = mu.last().copied().unwrap_or(0.0);
        let square = |k: usize| 1.0 / mu[k] - shift;
        let is_rigid = |square: f64| is_rigid(square, highest_rad_s);
        // What a rigid body would have of a stiffness that holds it, as if it were a part of the first one.
        let lowest = (0..r).rev().map(square).find(|square| !is_rigid(*square));
        let lowest = lowest.unwrap_or(highest_rad_s * highest_rad_s);
        let first = of_stiffness.iter().position(|(_, factor)| *factor != 0.0);
        let ground = |(own, (_, factor)): (usize, &(usize, f64))| {
            if Some(own) == first { lowest / factor } else { 0.0 }
        };
        let of_ground: Vec<f64> = of_stiffness.iter().enumerate().map(ground).collect();
        let mass_part = of_mass.iter().copied().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let directions = self.sensors.clone();
        let mut modes = Modes { mass: of_mass, directions, mass_part, ..Modes::none(self) };
        for k in (0..r).rev().take(most) {
            if mu[k] <= MASSLESS_RATIO * greatest {
                break;
            }
            let omega = if is_rigid(square(k)) { 0.0 } else { square(k).sqrt() };
            if omega > highest_rad_s {
                break;
            }
            let y: Vec<f64> = simultaneous[k * r..(k + 1) * r].iter().map(|y| y / mu[k].sqrt()).collect();
            let times = |matrix: &[f64]| -> Vec<f64> {
                matrix.chunks_exact(r).map(|column| transpose_dot(column, &y)).collect()
            };
            modes.omega_rad_s.push(omega);
            modes.momenta.push(times(&mass));
            let energies: Vec<f64> = match omega > 0.0 {
                true => {
                    of_stiffness.iter().map(|&(g, _)| transpose_dot(&y, &times(&self.matrices[g]))).collect()
                }
                false => of_ground.clone(),
            };
            let each = || of_stiffness.iter().zip(&energies);
            let whole: f64 = each().map(|((_, factor), energy)| factor * energy).sum();
            let share_of = |unknown: &ParameterAt| -> f64 {
                let own = each().filter(|((g, _), _)| unknown.enters(self.parts.term(*g)));
                own.map(|((_, factor), energy)| factor * energy).sum::<f64>() / whole
            };
            modes.unknown_shares.push(at.parameters.iter().map(share_of).collect());
            modes.energy_shares.push(vec![0.0; groups.len()]);
            for (place, &wanted) in groups.iter().enumerate() {
                let of_group = each().filter(|((g, _), _)| is_unknown(*g) == wanted);
                let own: c64 = of_group.map(|((g, _), energy)| factor(*g) * energy).sum();
                if own.re <= MIN_ENERGY_SHARE * whole {
                    continue;
                }
                let loss_factor = own.im / own.re;
                let of_loss = c64::new(0.0, loss_factor) / c64::new(1.0, loss_factor);
                let of_loss = Some(of_loss).filter(|_| loss_factor > 0.0);
                let last = modes.omega_rad_s.len() - 1;
                modes.energy_shares[last][place] = own.re / whole;
                let first = if omega > 0.0 { last } else { 0 };
                let shares = || std::iter::once(c64::new(2.0, 0.0)).chain(of_loss);
                for (partner, share) in (first..=last).flat_map(|j| shares().map(move |share| (j, share))) {
                    modes.of_error.push(last);
                    modes.partner.push(partner);
                    modes.group.push(place);
                    modes.share.push(share);
                    for ((g, _), energy) in each() {
                        let has_it = is_unknown(*g) == wanted && (share.im == 0.0 || self.parts.is_real(*g));
                        modes.stiffness[*g].push(if has_it { energy * whole / own.re } else { 0.0 });
                    }
                }
            }
            modes.load.push(self.load.iter().zip(&y).map(|(force, y)| force * y).sum());
            for (own, sensor) in modes.sensors.iter_mut().zip(&self.sensors) {
                own.push(transpose_dot(sensor, &y));
            }
            modes.shapes.push(y);
        }
        modes.apparent_mass = modes.sensors.iter().map(|own| modes.apparent(own)).collect();
        Ok(modes)
    }

    /// A smaller model of the modes and of what is near some points, with its modes; `None` where it would be no smaller.
    pub(crate) fn about_modes(
        &self,
        modes: &Modes,
        points: &[Point<'_>],
        tolerance: f64,
    ) -> Option<(Self, Modes)> {
        let (local, basis) = self
            .localised_with(points, tolerance, &modes.shapes)
            .or_else(|| self.localised_by_principal_directions(points, tolerance, &modes.shapes))?;
        let along =
            |x: &Vec<f64>| basis.chunks_exact(self.size.max(1)).map(|w| transpose_dot(w, x)).collect();
        let mut of_local = modes.clone();
        of_local.shapes = modes.shapes.iter().map(along).collect();
        of_local.momenta = modes.momenta.iter().map(along).collect();
        of_local.directions.clone_from(&local.sensors);
        Some((local, of_local))
    }

    /// Σ factor S_g.
    pub(super) fn real_sum(&self, factors: &[(usize, f64)]) -> Vec<f64> {
        let mut sum = vec![0.0; self.size * self.size];
        for &(g, factor) in factors {
            sum.iter_mut().zip(&self.matrices[g]).for_each(|(sum, s)| *sum += factor * s);
        }
        sum
    }

    /// This model with errors. Its residuals say how far a smaller model is from it, not how far it is from the full one.
    pub(crate) fn with_errors(&self, modes: &Modes, errors: &ModalErrors) -> Self {
        let r = self.size;
        let mut corrected = Self { parts: self.parts.with_errors(errors), ..self.clone() };
        let is_damped = |&g: &usize| modes.has_damping(g, &errors.stiffness);
        let damped: Vec<usize> = (0..self.matrices.len()).filter(is_damped).collect();
        for &g in &damped {
            corrected.parts.add_imaginary(g);
            corrected.matrices.push(vec![0.0; r * r]);
        }
        for (place, matrix) in corrected.matrices.iter_mut().enumerate() {
            let imaginary = place.checked_sub(self.matrices.len()).map(|k| damped[k]);
            let g = imaginary.unwrap_or(place);
            for (error, by) in modes.stiffness[g].iter().enumerate().filter(|(_, by)| **by != 0.0) {
                let [change, _] = modes.change(error, errors.stiffness[error]);
                let change = if imaginary.is_some() { change.im } else { change.re };
                let pair = [modes.of_error[error], modes.partner[error]].map(|i| &modes.momenta[i][..]);
                add_product(matrix, change * by, pair);
            }
            if modes.is_stiffness(g) {
                let scale = (2.0 * errors.scale).exp();
                matrix.iter_mut().for_each(|entry| *entry *= scale);
            }
        }
        if let Some((g, factor)) = modes.mass_part {
            for ((direction, mass), error) in
                modes.directions.iter().zip(&modes.apparent_mass).zip(&errors.masses)
            {
                add_product(&mut corrected.matrices[g], error * mass / factor, [direction; 2]);
            }
        }
        for (i, momentum) in modes.momenta.iter().enumerate() {
            let by = errors.load[i] * modes.load[i];
            corrected.load.iter_mut().zip(momentum).for_each(|(entry, momentum)| *entry += by * momentum);
        }
        for (m, sensor) in corrected.sensors.iter_mut().enumerate() {
            for (i, momentum) in modes.momenta.iter().enumerate() {
                let by = errors.shape[m][i] * modes.sensors[m][i];
                sensor.iter_mut().zip(momentum).for_each(|(entry, momentum)| *entry += by * momentum);
            }
        }
        corrected.load.iter_mut().for_each(|entry| *entry *= errors.gain_of_force());
        for (m, sensor) in corrected.sensors.iter_mut().enumerate() {
            sensor.iter_mut().for_each(|entry| *entry *= errors.gain_of(m));
        }
        corrected.images = corrected.matrices.clone();
        let real = |l: &Vec<f64>| l.iter().map(|&l| c64::new(l, 0.0)).collect();
        corrected.sketched =
            std::iter::once(corrected.load.clone()).chain(corrected.sensors.iter().map(real)).collect();
        corrected
    }

    /// Response and slopes of a model that [`Self::with_errors`] gave.
    ///
    /// # Errors
    /// [`Breakdown`] where the system is singular.
    pub(crate) fn respond_with_error_slopes(
        &self,
        (modes, errors): (&Modes, &ModalErrors),
        at: &ModelAt<'_>,
        correction: c64,
    ) -> Result<ErrorSlopes, Breakdown> {
        let solutions = Solutions::new(self, at, correction)?;
        let (y, duals) = (&solutions.all[0], &solutions.all[1..]);
        let along = |x: &[c64]| -> Vec<c64> {
            let one = |momentum: &Vec<f64>| momentum.iter().zip(x).map(|(m, x)| *m * x).sum();
            modes.momenta.iter().map(one).collect()
        };
        let of_load = along(y);
        let by_sensor: Vec<Vec<c64>> = duals.iter().map(|z| along(z)).collect();
        // The complex stiffness that belongs to each error.
        let scale = (2.0 * errors.scale).exp();
        let stiffness = |error: usize| -> c64 {
            let parts = modes.stiffness.iter().enumerate().filter(|(_, own)| !own.is_empty());
            let own: c64 = parts.map(|(g, own)| solutions.theta[g] * own[error]).sum();
            scale * modes.change(error, errors.stiffness[error])[1] * own
        };
        let stiffness: Vec<c64> = (0..modes.of_error.len()).map(stiffness).collect();
        let mut of_changes = self.first_weights(at);
        of_changes[0].clone_from(&solutions.slope_theta);
        let of_stiffness = |z: &Vec<c64>| {
            let each = modes.of_error.iter().zip(&modes.partner).zip(&stiffness);
            each.map(|((&i, &j), k)| -0.5 * k * (z[i] * of_load[j] + z[j] * of_load[i])).collect()
        };
        // −ω² M_n ℓ_nᵀy of each mass.
        let at_sensor = |x: &[c64]| -> Vec<c64> {
            modes.directions.iter().map(|l| l.iter().zip(x).map(|(l, x)| *l * x).sum()).collect()
        };
        let inertia = |(own, mass): (c64, &f64)| -> c64 {
            modes.mass_part.map_or(c64::default(), |(g, factor)| solutions.theta[g] * own * (mass / factor))
        };
        let inertias: Vec<c64> = at_sensor(y).into_iter().zip(&modes.apparent_mass).map(inertia).collect();
        let masses = |z: &Vec<c64>| at_sensor(z).iter().zip(&inertias).map(|(z, force)| -z * force).collect();
        let shape = |(m, own): (usize, &Vec<f64>)| {
            own.iter().zip(&of_load).map(|(l, y)| errors.gain_of(m) * l * y).collect()
        };
        let response = solutions.response(self);
        let gains = |m: usize| -> Vec<c64> {
            let of_each = |(n, gain): (usize, &f64)| {
                if n == 0 || n == m + 1 { response[m] / (1.0 + gain) } else { c64::default() }
            };
            errors.gains.iter().enumerate().map(of_each).collect()
        };
        let of_force = errors.gain_of_force();
        let theta = |by: &FactorError| -> Vec<c64> {
            solutions.theta.iter().enumerate().map(|(g, &theta)| self.parts.slope(g, theta, by)).collect()
        };
        let is_stiffness = |g: usize| g >= modes.stiffness.len() || modes.is_stiffness(g);
        let of_scale = |(g, theta): (usize, &c64)| if is_stiffness(g) { 2.0 * theta } else { c64::default() };
        of_changes.push(solutions.theta.iter().enumerate().map(of_scale).collect());
        let of_loss = |(g, theta): (usize, &c64)| self.parts.slope_by_loss(g, *theta, at.frequency_hz);
        if !errors.of_loss.is_empty() {
            of_changes.push(solutions.theta.iter().enumerate().map(of_loss).collect());
        }
        of_changes.extend(errors.factors.iter().map(theta));
        // Parameters, the scale, the loss factors, known factors: every matrix is met once for all of them.
        let mut slopes = solutions.slopes(self, &of_changes);
        let of_factors = slopes.split_off(of_changes.len() - errors.factors.len());
        let loss = if errors.of_loss.is_empty() { Vec::new() } else { slopes.pop().unwrap_or_default() };
        let scale = slopes.pop().unwrap_or_default();
        let factors = |m: usize| of_factors.iter().map(|of_factor| of_factor[m]).collect();
        Ok(ErrorSlopes {
            scale,
            loss,
            slopes,
            stiffness: by_sensor.iter().map(of_stiffness).collect(),
            masses: duals.iter().map(masses).collect(),
            gains: (0..duals.len()).map(gains).collect(),
            load: by_sensor
                .iter()
                .map(|z| z.iter().zip(&modes.load).map(|(z, f)| of_force * z * f).collect())
                .collect(),
            shape: modes.sensors.iter().enumerate().map(shape).collect(),
            response,
            factors: (0..duals.len()).map(factors).collect(),
        })
    }
}

/// The response of a model at one frequency over the natural frequency of one mode and its shapes, everything else as it is.
///
/// With w = D⁻¹My_i and κ = k (t − t₀), where t is what [`Modes::change`] makes of δ_i and k the complex stiffness that belongs to it,
/// $$ x_m = \ell_m^T y - \frac{\kappa}{1 + \kappa s} p \\, \ell_m^T w, \qquad s = (M y_i)^T w, \quad p = (M y_i)^T y. $$
pub(crate) struct AlongMode {
    /// ℓ_mᵀy and ℓ_mᵀw without the mode's share of ℓ_m.
    without: Vec<[c64; 2]>,
    /// (ℓ_mᵀy_i) of a right model.
    own: Vec<f64>,
    p: c64,
    s: c64,
    k: c64,
    /// t₀.
    change: f64,
}

impl AlongMode {
    /// x_m without what sensor m shows of the mode, and what it shows of it where its shape is right there.
    pub(crate) fn at(&self, change: f64) -> impl Iterator<Item = [c64; 2]> {
        let kappa = self.k * (change - self.change);
        let rest = (1.0 + kappa * self.s).inv();
        let without = self.without.iter().map(move |[y, w]| y - kappa * rest * self.p * w);
        without.zip(&self.own).map(move |(without, own)| [without, rest * self.p * own])
    }
}

impl Projection {
    /// Of a model that [`Self::with_errors`] gave, over an error of a natural frequency.
    ///
    /// # Errors
    /// [`Breakdown`] where the system is singular.
    pub(crate) fn along_mode(
        &self,
        (modes, errors): (&Modes, &ModalErrors),
        error: usize,
        at: &ModelAt<'_>,
        correction: c64,
    ) -> Result<AlongMode, Breakdown> {
        let mode = modes.of_error[error];
        let momentum: Vec<c64> = modes.momenta[mode].iter().map(|&m| m.into()).collect();
        let theta = weights(self, at, correction).0;
        let mut block = [self.load.as_slice(), &momentum].concat();
        self.solve(&theta, &mut block)?;
        let (y, w) = block.split_at(self.size);
        let [p, s] = [y, w].map(|x| transpose_dot(&momentum, x));
        let of_sensors = modes.sensors.iter().enumerate();
        let own: Vec<f64> = of_sensors.map(|(m, sensor)| errors.gain_of(m) * sensor[mode]).collect();
        let shown = self.observe(y).into_iter().zip(self.observe(w));
        // The errors' ℓ_m has (1 + a) of the mode.
        let share = |m: usize| (1.0 + errors.shape[m][mode]) * own[m];
        let without = shown.enumerate().map(|(m, (y, w))| [y - share(m) * p, w - share(m) * s]).collect();
        let parts = modes.stiffness.iter().enumerate().filter(|(_, of_error)| !of_error.is_empty());
        let k: c64 = parts.map(|(g, of_error)| theta[g] * of_error[error]).sum();
        let change = modes.change(error, errors.stiffness[error])[0].re;
        Ok(AlongMode { without, own, p, s, k: (2.0 * errors.scale).exp() * k, change })
    }
}

/// A += by (u vᵀ + v uᵀ)/2 for an r × r matrix.
fn add_product(matrix: &mut [f64], by: f64, [u, v]: [&[f64]; 2]) {
    for (column, (u_column, v_column)) in matrix.chunks_exact_mut(u.len().max(1)).zip(u.iter().zip(v)) {
        let each = column.iter_mut().zip(u.iter().zip(v));
        each.for_each(|(entry, (u, v))| *entry += 0.5 * by * (u * v_column + v * u_column));
    }
}

/// WᵀAW for a symmetric A and columns W, both r × r.
pub(super) fn congruent(a: &[f64], w: &[f64], r: usize) -> Vec<f64> {
    use frfit_linalg::column_block::{product, transpose_product};
    transpose_product(w, r, &product(a, r, w))
}

impl Modes {
    /// y_i.
    pub(super) fn shape(&self, i: usize) -> &[f64] {
        &self.shapes[i]
    }

    /// R_m = Fᵀy ℓ_mᵀy/2iω of mode i at some sensors, where its natural frequency is ω.
    pub(crate) fn residues(&self, i: usize, omega_rad_s: f64, sensors: &[usize]) -> Vec<c64> {
        let over = c64::new(0.0, 2.0 * omega_rad_s);
        sensors.iter().map(|&m| self.sensors[m][i] * self.load[i] / over).collect()
    }

    /// None of them: a model without errors.
    pub(crate) fn none(model: &Projection) -> Self {
        Self {
            omega_rad_s: Vec::new(),
            shapes: Vec::new(),
            momenta: Vec::new(),
            mass: Vec::new(),
            of_error: Vec::new(),
            partner: Vec::new(),
            group: Vec::new(),
            energy_shares: Vec::new(),
            unknown_shares: Vec::new(),
            share: Vec::new(),
            stiffness: vec![Vec::new(); model.matrices.len()],
            directions: Vec::new(),
            mass_part: None,
            apparent_mass: Vec::new(),
            load: Vec::new(),
            sensors: vec![Vec::new(); model.sensors.len()],
        }
    }

    /// What of the stiffness of a mode an error changes, and the slope of that. Of a natural frequency it is e (exp(2δ/e) − 1) with the strain energy's share e: a factor exp(t)
    /// of a stiffness and δ = −et/2 of all modes cancel on a straight line, along which a search makes long steps.
    pub(crate) fn change(&self, error: usize, by: f64) -> [c64; 2] {
        let share = self.share[error];
        if share.im != 0.0 || self.omega_rad_s[self.of_error[error]] == 0.0 {
            return [share * by, share];
        }
        let own = self.share_of(error);
        let exponent = share.re * by / own;
        let within = exponent.min(MAX_EXPONENT);
        let slope = within.exp();
        let value = within.exp_m1() + slope * (exponent - within);
        [c64::new(own * value, 0.0), c64::new(share.re * slope, 0.0)]
    }

    /// What of the strain energy of its mode is in the group of an error.
    pub(crate) fn share_of(&self, error: usize) -> f64 {
        self.energy_shares[self.of_error[error]][self.group[error]]
    }

    /// What of the strain energy of a mode is in the stiffness of unknowns; 1 where no other stiffness is known.
    pub(crate) fn share_of_unknown(&self, mode: usize) -> f64 {
        self.energy_shares[mode].get(1).copied().unwrap_or(1.0)
    }

    /// The same as a root mean square over the elastic modes up to some frequency.
    pub(crate) fn share_of_unknowns(&self, highest_rad_s: f64) -> f64 {
        let is_in_band = |&i: &usize| self.omega_rad_s[i] > 0.0 && self.omega_rad_s[i] <= highest_rad_s;
        let in_band = (0..self.omega_rad_s.len()).filter(is_in_band);
        let squares: Vec<f64> = in_band.map(|i| self.share_of_unknown(i).powi(2)).collect();
        if squares.is_empty() { 1.0 } else { (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() }
    }

    /// What modes usually have at the load (0) or at a sensor (m + 1), a root mean square, over what one has, and 1 at least.
    pub(crate) fn usual_over_own(&self, place: usize, mode: usize) -> f64 {
        let at: Vec<f64> = match place.checked_sub(1) {
            None => self.load.iter().map(|own| own.norm()).collect(),
            Some(m) => self.sensors[m].iter().map(|own| own.abs()).collect(),
        };
        let usual = (at.iter().map(|own| own * own).sum::<f64>() / at.len() as f64).sqrt();
        let ratio = usual / at[mode];
        if ratio > 1.0 { ratio.min(MAX_USUAL_OVER_OWN) } else { 1.0 }
    }

    /// The errors of a mode's natural frequency.
    pub(crate) fn frequency_errors(&self, mode: usize) -> impl Iterator<Item = usize> {
        (0..self.of_error.len())
            .filter(move |&error| self.of_error[error] == mode && self.is_of_frequency(error))
    }

    /// Whether an error of a stiffness is one of a natural frequency, and not of a loss factor.
    pub(crate) fn is_of_frequency(&self, error: usize) -> bool {
        self.share[error].im == 0.0
    }

    /// The mean mass that modes with a stiffness have at a sensor; none where none of them moves it.
    fn apparent(&self, own: &[f64]) -> f64 {
        let elastic = own.iter().zip(&self.omega_rad_s).filter(|(_, omega)| **omega > 0.0);
        let squares: Vec<f64> = elastic.map(|(shape, _)| shape * shape).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        if mean > 0.0 { 1.0 / mean } else { 0.0 }
    }

    /// How many groups of stiffness have errors.
    pub(crate) fn groups(&self) -> usize {
        self.energy_shares.first().map_or(0, Vec::len)
    }

    /// Whether S_g is a stiffness.
    fn is_stiffness(&self, g: usize) -> bool {
        !self.stiffness[g].is_empty()
    }

    /// Whether loss factors of S_g are in error.
    fn has_damping(&self, g: usize, errors: &[f64]) -> bool {
        let each = self.stiffness[g].iter().zip(&self.share).zip(errors);
        each.into_iter().any(|((by, share), error)| by * share.im * error != 0.0)
    }

    /// The lowest natural frequency that is not zero.
    pub(crate) fn lowest_rad_s(&self) -> Option<f64> {
        self.omega_rad_s.iter().copied().find(|omega| *omega > 0.0)
    }

    /// The same modes in a basis to which vectors were added.
    pub(crate) fn in_larger(&self, model: &Projection) -> Self {
        let r = model.size;
        let mass = model.real_sum(&self.mass);
        let mut larger = self.clone();
        larger.directions.clone_from(&model.sensors);
        for (shape, momentum) in larger.shapes.iter_mut().zip(&mut larger.momenta) {
            shape.resize(r, 0.0);
            *momentum = mass.chunks_exact(r.max(1)).map(|column| transpose_dot(column, shape)).collect();
        }
        larger
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::for_each::sequential;
    use crate::frequency::omega_rad_s;
    use crate::material::Law;
    use crate::model::{DynamicStiffness, Experiment, FactorPart, Parameter, Sensor, Term};
    use crate::response::{FullModel, Response};
    use crate::subspace::Subspace;
    use crate::subspace::TrainOptions;
    use frfit_linalg::sparse::Triplets;

    /// A chain of twelve masses: the springs of its first half are known, those of the other are not. Its end is held, or it is free.
    fn chain(is_held: bool) -> DynamicStiffness {
        let n = 12;
        let spring = |from: usize, to: usize| {
            let mut k = Triplets::new(n);
            (from..to).for_each(|i| match i {
                0 if is_held => k.add(0, 0, 1.0),
                0 => {}
                _ => k.add_element(&[Some(i - 1), Some(i)], &[1.0, -1.0, -1.0, 1.0]),
            });
            k.assemble()
        };
        let mut mass = Triplets::new(n);
        (0..n).for_each(|i| mass.add(i, i, 1.0));
        let term = |name: &str, role, matrix, factor| Term {
            name: name.into(),
            role,
            matrix,
            factor: Law::Constant(factor),
        };
        DynamicStiffness::new(vec![
            term("known", Role::Stiffness, spring(0, 6), c64::new(1e4, 1e2)),
            term("unknown", Role::Stiffness, spring(6, n), c64::new(2e4, 4e3)),
            term("mass", Role::Mass, mass.assemble(), c64::new(1.0, 0.0)),
        ])
        .unwrap()
    }

    /// Errors move natural frequencies by what they say, and slopes are those of finite differences.
    #[test]
    fn errors_move_natural_frequencies_and_slopes_are_right() {
        [true, false].into_iter().for_each(errors_move_natural_frequencies);
    }

    /// A mass at a sensor is that mass in the mass matrix.
    #[test]
    fn a_mass_at_a_sensor_is_in_the_mass_matrix() {
        let (kilograms, row) = (0.07, 4);
        let model = chain(true);
        let mut at_sensor = Triplets::new(12);
        at_sensor.add(row, row, kilograms);
        let mut terms = model.terms().to_vec();
        let factor = Law::Constant(c64::new(1.0, 0.0));
        terms.push(Term { name: "sensor".into(), role: Role::Mass, matrix: at_sensor.assemble(), factor });
        let truth = DynamicStiffness::new(terms).unwrap();
        let sensor = |row| Sensor { row, sign: 1.0 };
        let experiment = Experiment::driven_at(12, sensor(11), vec![sensor(row), sensor(9)]);
        let parameter = Parameter::factor_of(&model, &["unknown"]).unwrap();
        let at = model.at(9.0, std::slice::from_ref(&parameter)).unwrap();
        let mut subspace = Subspace::new(&experiment, &at).unwrap();
        let point = Point { at: at.clone(), correction: c64::default() };
        subspace.train(&[point], &TrainOptions::default(), &sequential).unwrap();
        let whole = subspace.projection();
        let modes = whole.modes(&at, c64::default(), omega_rad_s(100.0), 6).unwrap();
        let errors = ModalErrors {
            scale: 0.0,
            loss: 0.0,
            of_loss: Arc::new([]),
            stiffness: vec![0.0; modes.of_error.len()],
            masses: vec![kilograms / modes.apparent_mass[0], 0.0],
            gains: vec![0.0; 3],
            load: vec![0.0; 6],
            shape: vec![vec![0.0; 6]; 2],
            factors: Vec::new(),
        };
        let found = whole
            .with_errors(&modes, &errors)
            .respond_with_error_slopes((&modes, &errors), &at, c64::default())
            .unwrap();
        let at = truth.at(9.0, std::slice::from_ref(&parameter)).unwrap();
        let exact = FullModel::new(at, &experiment).unwrap().solve_at(&[c64::default()]).unwrap();
        for (x, exact) in found.response.iter().zip(&exact) {
            assert!((x - exact).norm() < 1e-6 * exact.norm(), "{x} {exact}");
        }
    }

    fn errors_move_natural_frequencies(is_held: bool) {
        let model = chain(is_held);
        let parameter = Parameter::factor_of(&model, &["unknown"]).unwrap();
        let sensor = |row| Sensor { row, sign: 1.0 };
        let experiment = Experiment::driven_at(12, sensor(11), vec![sensor(4), sensor(9)]);
        let at = model.at(9.0, std::slice::from_ref(&parameter)).unwrap();
        let points: Vec<Point<'_>> = [1.0, 4.0, 9.0, 15.0, 25.0]
            .iter()
            .map(|&f| {
                let at = model.at(f, std::slice::from_ref(&parameter)).unwrap();
                Point { at, correction: c64::default() }
            })
            .collect();
        let mut subspace = Subspace::new(&experiment, &at).unwrap();
        subspace.train(&points, &TrainOptions::default(), &sequential).unwrap();
        let whole = subspace.projection();
        let highest = omega_rad_s(100.0);
        let modes = whole.modes(&at, c64::default(), highest, 6).unwrap();
        assert_eq!(modes.omega_rad_s.len(), 6);
        assert_eq!(modes.omega_rad_s[0] > 0.0, is_held, "{:?}", modes.omega_rad_s);
        let lowest = modes.lowest_rad_s().unwrap();
        let of = |term, part| FactorError { term, part, error: 0.0 };
        let mut errors = ModalErrors {
            scale: 0.0,
            loss: 0.0,
            of_loss: Arc::new([]),
            stiffness: vec![0.0; modes.of_error.len()],
            masses: vec![0.0; 2],
            gains: vec![0.0; 3],
            load: vec![0.0; 6],
            shape: vec![vec![0.0; 6]; 2],
            factors: vec![
                of(0, FactorPart::Storage),
                of(0, FactorPart::LossFactor),
                of(2, FactorPart::Storage),
            ],
        };
        for k in 0..modes.of_error.len() {
            errors.stiffness[k] = 1e-4;
            let moved = whole.with_errors(&modes, &errors).modes(&at, c64::default(), highest, 6).unwrap();
            for i in 0..6 {
                let before = modes.omega_rad_s[i];
                // A rigid body gets a support.
                let expected = match modes.of_error[k] == i && modes.is_of_frequency(k) {
                    true if before > 0.0 => {
                        // Of a part of the strain energy.
                        let share = modes.energy_shares[i][modes.group[k]];
                        before * (1.0 + share * (2e-4 / share).exp_m1()).sqrt()
                    }
                    true => before.hypot(lowest * 2e-4_f64.sqrt()),
                    false => before,
                };
                let found = moved.omega_rad_s[i];
                assert!((found - expected).abs() < 1e-8 * lowest, "{k} {i}: {found:e} {expected:e}");
            }
            errors.stiffness[k] = 0.0;
        }
        // Somewhere with errors of every kind.
        errors.stiffness.iter_mut().enumerate().for_each(|(k, error)| *error = 0.01 / (1.0 + k as f64));
        errors.scale = 0.03;
        errors.loss = 0.1;
        errors.of_loss = Arc::new([UnknownLoss { terms: vec![1], loss_factors: vec![(9.0, 0.2)] }]);
        errors.shape[1][2] = 0.05;
        errors.masses[0] = 0.01;
        errors.load[3] = -0.04;
        errors.gains.copy_from_slice(&[0.02, -0.03, 0.05]);
        errors.factors[1].error = 0.03;
        errors.factors[2].error = -0.02;
        let correction = c64::new(1e3, -2e2);
        let slopes = |errors: &ModalErrors| {
            whole
                .with_errors(&modes, errors)
                .respond_with_error_slopes((&modes, errors), &at, correction)
                .unwrap()
        };
        let here = slopes(&errors);
        let step = 1e-6;
        let check = |moved: &ModalErrors, of: &dyn Fn(&ErrorSlopes, usize) -> c64| {
            let there = slopes(moved);
            for m in 0..2 {
                let difference = (there.response[m] - here.response[m]) / step;
                let middle = 0.5 * (of(&there, m) + of(&here, m));
                assert!(
                    (difference - middle).norm() < 1e-5 * here.response[m].norm(),
                    "{difference} {middle}"
                );
            }
        };
        for k in 0..modes.of_error.len() {
            let mut moved = errors.clone();
            moved.stiffness[k] += step;
            check(&moved, &|slopes, m| slopes.stiffness[m][k]);
        }
        let mut moved = errors.clone();
        moved.scale += step;
        check(&moved, &|slopes, m| slopes.scale[m]);
        let mut moved = errors.clone();
        moved.loss += step;
        check(&moved, &|slopes, m| slopes.loss[m]);
        for t in 0..3 {
            let mut moved = errors.clone();
            moved.factors[t].error += step;
            check(&moved, &|slopes, m| slopes.factors[m][t]);
        }
        for n in 0..2 {
            let mut moved = errors.clone();
            moved.masses[n] += step;
            check(&moved, &|slopes, m| slopes.masses[m][n]);
        }
        for n in 0..3 {
            let mut moved = errors.clone();
            moved.gains[n] += step;
            check(&moved, &|slopes, m| slopes.gains[m][n]);
        }
        for i in 0..6 {
            let mut moved = errors.clone();
            moved.load[i] += step;
            check(&moved, &|slopes, m| slopes.load[m][i]);
        }
        for (sensor, i) in [(0, 0), (1, 2)] {
            let mut moved = errors.clone();
            moved.shape[sensor][i] += step;
            check(&moved, &|slopes, m| if m == sensor { slopes.shape[m][i] } else { c64::default() });
        }
        // Far along one mode, with another share of it at the sensors.
        let (far, share) = (0.02, 0.7);
        for error in (0..modes.of_error.len()).filter(|&error| modes.is_of_frequency(error)) {
            let along =
                whole.with_errors(&modes, &errors).along_mode((&modes, &errors), error, &at, correction);
            let change = modes.change(error, errors.stiffness[error] + far)[0].re;
            let mut moved = errors.clone();
            moved.stiffness[error] += far;
            moved.shape.iter_mut().for_each(|shape| shape[modes.of_error[error]] = share - 1.0);
            let expected = slopes(&moved).response;
            for ([without, own], expected) in along.unwrap().at(change).zip(expected) {
                let found = without + share * own;
                assert!((found - expected).norm() < 1e-9 * expected.norm(), "{error}: {found} {expected}");
            }
        }
    }
}
