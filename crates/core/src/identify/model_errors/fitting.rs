//! The least squares of a curve with the errors of the model: min over θ, δ, ν, a of χ² + their priors.

use super::curve::Curves;
use super::factor_prior::FactorPrior;
use super::found::{Assumption, ContradictedAssumption};
use super::kinds::{Damping, Kinds};
use super::measured::PointAt;
use super::mesh::BetweenMeshes;
use super::sizes::{CALIBRATION_PRIOR_STD, KnownSizes, Sizes, UNDAMPED_SHARE_RATIO};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::identify::options::ErrorSizes;
use crate::subspace::{ErrorSlopes, FactorError, ModalErrors, Modes, Projection, UnknownLoss};
use frfit_linalg::column_block::times_transpose;
use frfit_linalg::dense::Cholesky;
use std::f64::consts::TAU;
use std::sync::Arc;

/// What is to be explained, and with what.
#[derive(Clone, Copy)]
pub(super) struct Fitting<'t, 'a> {
    /// The reduced model without errors.
    pub(super) model: &'t Projection,
    pub(super) modes: &'t Modes,
    pub(super) point: PointAt<'t, 'a>,
    pub(super) omegas: &'t [f64],
    pub(super) measured: &'t [Vec<c64>],
    /// Lines that are used.
    pub(super) lines: &'t [usize],
    pub(super) curves: &'t Curves,
    /// About where θ is before the data.
    pub(super) centre: &'t [f64],
    /// The highest frequency of the band.
    pub(super) highest_rad_s: f64,
    /// Known factors that may be in error.
    pub(super) factors: &'t [FactorPrior],
    /// Unknown stiffnesses with damping, whose loss factors may have an error in common, and the terms of each.
    pub(super) damped: &'t [(usize, Vec<usize>)],
    /// Errors that are searched beside those of stiffness, shapes and factors.
    pub(super) kinds: Kinds,
    /// What lies between the meshes, where there are two; none without modes.
    pub(super) mesh: Option<&'t BetweenMeshes>,
    /// What is known of the sizes of errors.
    pub(super) known: KnownSizes,
    /// Whether shapes near nodes may have any value: far from the answer that only lets a mode vanish that is at another frequency.
    pub(super) free_nodes: bool,
    /// Whether the unknowns stay where they are.
    pub(super) held: bool,
    pub(super) for_each: ForEach<'t>,
}

/// The standard deviation of an error that is not searched: practically zero.
pub(super) const NEGLIGIBLE_STD: f64 = 1e-7;

/// Parts that the δ_i have in common: of the first group a scale of all stiffness; of each group what grows with ω_i and with its square, as the errors of meshes do, in
/// proportion to the strain energy there; of the first group what falls with 1/ω_i², as the errors of supports do. Then four of the ε_i of each group: the same for all modes, with 1/ω_i², and with
/// ω_i and its square, since what a mesh has too much of stiffness has another damping than the mode.
const COMMON_PARTS: usize = 8;
const COMMON_FREQUENCY_PARTS: usize = 4;
const OF_MESH: usize = 1;
const OF_SUPPORT: usize = 3;
const LOSS_OF_MESH: usize = 6;

/// Whether a common part is one of the δ_i, and not of the ε_i.
fn is_frequency_part(part: usize) -> bool {
    part % COMMON_PARTS < COMMON_FREQUENCY_PARTS
}

/// Standard deviation of δ of a rigid body: a usual suspension has natural frequencies below a third of the first other one.
const RIGID_BODY_STD: f64 = 0.05;

/// Where a search is: θ, the common parts of δ and ε, the amplitude of the mesh's error where there are two meshes, own parts of δ and ε, ν and Δη, κ, g of the
/// force and of each sensor, then a of the load and of each sensor.
pub(super) type Place = Vec<f64>;

/// The normal equations at a place: χ², ½ ∂χ²/∂p, JᵀJ (n × n).
pub(super) struct Normal {
    pub(super) chi_squared: f64,
    pub(super) gradient: Vec<f64>,
    pub(super) information: Vec<f64>,
}

impl Normal {
    /// JᵀJ and the prior's precision together, n × n.
    pub(super) fn with_prior(&self, precision: &[f64]) -> Vec<f64> {
        self.information.iter().zip(precision).map(|(data, prior)| data + prior).collect()
    }
}

/// The responses near a place, before they are weighed: what noise and priors are assumed does not change them.
pub(super) struct Linearised {
    pub(super) place: Place,
    /// Coordinates in all, and those on which the response at each sensor depends.
    count: usize,
    coordinates: Vec<Vec<usize>>,
    /// Of each line and sensor: slopes along these, then what is left of the measurement.
    rows: Vec<Vec<Vec<c64>>>,
}

impl Linearised {
    /// |u_m − x_m|² at each of the lines.
    pub(super) fn squares(&self) -> Vec<Vec<f64>> {
        let square = |row: &Vec<c64>| row.last().map_or(0.0, |rest| rest.norm_sqr());
        self.rows.iter().map(|of_line| of_line.iter().map(square).collect()).collect()
    }

    /// The normal equations; `None` where the response is not finite. σ is that of real and imaginary part each, for each of the lines.
    pub(super) fn normal(&self, sigma: &[Vec<f64>], for_each: ForEach<'_>) -> Option<Normal> {
        let n = self.count;
        let sensors = self.coordinates.len();
        let chunks = self.rows.len().min(LINE_CHUNKS);
        // Of each sensor all products of the columns of [J r].
        let part = |c: usize| -> Vec<Vec<f64>> {
            let of_sensor = |m: usize| {
                let mut stacked = Vec::new();
                for (row, sigma) in
                    (c..self.rows.len()).step_by(chunks).map(|k| (&self.rows[k][m], sigma[k][m]))
                {
                    if sigma.is_finite() {
                        stacked.extend(row.iter().map(|x| x.re / sigma));
                        stacked.extend(row.iter().map(|x| x.im / sigma));
                    }
                }
                times_transpose(&stacked, self.coordinates[m].len() + 1)
            };
            (0..sensors).map(of_sensor).collect()
        };
        let mut sum = Normal { chi_squared: 0.0, gradient: vec![0.0; n], information: vec![0.0; n * n] };
        for products in map(for_each, chunks, part) {
            for (of_sensor, coordinates) in products.iter().zip(&self.coordinates) {
                let mut columns = of_sensor.chunks_exact(coordinates.len() + 1);
                for (&a, column) in coordinates.iter().zip(&mut columns) {
                    let information = &mut sum.information[a * n..][..n];
                    coordinates.iter().zip(column).for_each(|(&b, product)| information[b] += product);
                }
                let rest = columns.next().unwrap_or_default();
                coordinates.iter().zip(rest).for_each(|(&a, product)| sum.gradient[a] += product);
                sum.chi_squared += rest.last().unwrap_or(&0.0);
            }
        }
        Some(sum).filter(|sum| sum.chi_squared.is_finite())
    }
}

/// Slopes of the unknowns at a line, with the number of the unknown.
struct Slopes {
    /// ∂p/∂θ.
    of_theta: Vec<(usize, c64)>,
    /// ∂p/∂ε of the error that all loss factors have in common.
    of_loss: Vec<(usize, c64)>,
}

/// A minimum.
pub(super) struct Minimum {
    pub(super) place: Place,
    pub(super) normal: Normal,
    pub(super) prior: f64,
}

/// Steps that are refused before a search ends.
const MAX_REFUSED_STEPS: usize = 6;

/// The largest step of a coordinate of θ.
const MAX_THETA_STEP: f64 = 0.5;

/// Errors larger than these, root mean squares over the modes of the band, are no small errors of this model: it is another one.
const MAX_FREQUENCY_ERROR: f64 = 0.04;
const MAX_SHAPE_ERROR: f64 = 0.3;

/// What of those of frequencies another size of the unknown stiffness may take, which is in its error bar: a fifth of that stiffness.
const MAX_COMMON_ERROR: f64 = 0.1;

/// The same over the sizes that were given.
const MAX_ERROR_OVER_GIVEN_SIZE: f64 = 3.0;

/// What is known of factors and calibrations is contradicted beyond so many of its standard deviations, of all of them together: 6 of 100 000 normal ones. Each beyond
/// so many is named.
const MAX_DEVIATIONS: f64 = 4.0;
const LARGE_DEVIATIONS: f64 = 2.0;

/// A descent ends where a step lowers the cost, −2 ln of a probability, by less than this part of it or by less than this.
const COST_RTOL: f64 = 1e-5;
const COST_ATOL: f64 = 0.01;

impl Fitting<'_, '_> {
    pub(super) fn sensors(&self) -> usize {
        self.measured[0].len()
    }

    pub(super) fn modes(&self) -> usize {
        self.modes.omega_rad_s.len()
    }

    fn stiffness_errors(&self) -> usize {
        self.modes.of_error.len()
    }

    /// θ, common and own δ, ε, ν, a of the load: what every sensor hangs on.
    fn shared(&self) -> usize {
        self.first_load() + self.modes()
    }

    pub(super) fn count(&self) -> usize {
        self.shared() + self.sensors() * self.modes()
    }

    /// The place of δ_1, and of ν_1.
    pub(super) fn first_own(&self) -> usize {
        self.curves.count() + self.common_errors()
    }

    /// Coordinates of what the δ_i have in common.
    fn common_errors(&self) -> usize {
        self.common_parts() + usize::from(self.mesh.is_some())
    }

    /// Those of all groups.
    fn common_parts(&self) -> usize {
        COMMON_PARTS * self.modes.groups()
    }

    /// The place of the amplitude of the mesh's error.
    pub(super) fn of_mesh(&self) -> Option<(usize, &BetweenMeshes)> {
        Some((self.curves.count() + self.common_parts(), self.mesh?))
    }

    /// Before the data.
    pub(super) fn expected(&self, coordinate: usize) -> f64 {
        match self.of_mesh().filter(|(place, _)| *place == coordinate) {
            Some((_, mesh)) => mesh.remainder,
            None => self.centre.get(coordinate).copied().unwrap_or(0.0),
        }
    }

    /// The place of the scale of all stiffness.
    pub(super) fn of_scale(&self) -> Option<usize> {
        (self.modes() > 0).then(|| self.curves.count())
    }

    /// What δ_i or ε_i has of each common part; nothing of the scale of all stiffness, which is no error of single modes.
    pub(super) fn common(&self, i: usize) -> Vec<f64> {
        let own = self.modes.omega_rad_s[self.modes.of_error[i]];
        let mut parts = vec![0.0; self.common_errors()];
        if let Some(lowest) = self.modes.lowest_rad_s().filter(|_| own > 0.0) {
            let (omega, support) = (own / self.highest_rad_s, (lowest / own).powi(2));
            let (first, share) = (COMMON_PARTS * self.modes.group[i], self.modes.share_of(i));
            match self.modes.is_of_frequency(i) {
                true => {
                    let of_mesh = [share * omega, share * omega * omega];
                    parts[first + OF_MESH..][..of_mesh.len()].copy_from_slice(&of_mesh);
                    // A support is no part of either stiffness.
                    parts[OF_SUPPORT] = share * support;
                }
                false => {
                    let of_loss = [1.0, support, omega, omega * omega];
                    parts[first + COMMON_FREQUENCY_PARTS..][..of_loss.len()].copy_from_slice(&of_loss);
                }
            }
        }
        if let Some(place) = self.of_unknown_loss() {
            parts[place - self.curves.count()] = 0.0;
        }
        if let (Some(mesh), Some(last)) = (self.mesh, parts.last_mut()) {
            *last = mesh.stiffness[i];
        }
        parts
    }

    /// The place of the error that all loss factors of unknown stiffness have in common, where there is one: it is one of the unknowns, p → Re p + i(1 + ε) Im p, and not of the modes that are
    /// there. Beyond these a coarse mesh is wrong, and what it lacks would be taken for a difference between the loss factor of the material and that of the modes.
    pub(super) fn of_unknown_loss(&self) -> Option<usize> {
        let group = self.modes.groups().checked_sub(1).filter(|_| !self.damped.is_empty())?;
        Some(self.curves.count() + COMMON_PARTS * group + COMMON_FREQUENCY_PARTS)
    }

    /// Unknowns whose loss factors are in error, with those at a place.
    pub(super) fn unknown_losses(&self, place: &[f64]) -> Arc<[UnknownLoss]> {
        if self.of_unknown_loss().is_none() {
            return Arc::new([]);
        }
        let values = |line: usize| self.curves.values(place, line, self.omegas[line]);
        let all: Vec<(f64, Vec<c64>)> =
            (0..self.omegas.len()).filter_map(|i| Some((self.omegas[i] / TAU, values(i)?.0))).collect();
        let of_unknown = |(j, terms): &(usize, Vec<usize>)| UnknownLoss {
            terms: terms.clone(),
            loss_factors: all.iter().map(|(hz, values)| (*hz, values[*j].im / values[*j].re)).collect(),
        };
        self.damped.iter().map(of_unknown).collect()
    }

    /// The unknowns at a line with their errors, and their slopes.
    fn unknowns_at(&self, place: &[f64], line: usize) -> Option<(Vec<c64>, Slopes)> {
        let (mut values, mut of_theta) = self.curves.values(place, line, self.omegas[line])?;
        let mut of_loss = Vec::new();
        if let Some(error) = self.of_unknown_loss().map(|i| place[i]) {
            let with_error = |value: c64| c64::new(value.re, (1.0 + error) * value.im);
            let is_damped = |j: usize| self.damped.iter().any(|(own, _)| *own == j);
            let slopes = of_theta.iter_mut().filter(|(j, _)| is_damped(*j));
            slopes.for_each(|(_, slope)| *slope = with_error(*slope));
            for &(j, _) in self.damped {
                of_loss.push((j, c64::new(0.0, values[j].im)));
                values[j] = with_error(values[j]);
            }
        }
        Some((values, Slopes { of_theta, of_loss }))
    }

    /// The common parts of δ, or of ε.
    pub(super) fn in_common(&self, of_frequency: bool) -> impl Iterator<Item = usize> {
        let first = self.curves.count();
        let is_wanted = move |&part: &usize| is_frequency_part(part) == of_frequency;
        (0..self.common_parts()).filter(is_wanted).map(move |part| first + part)
    }

    /// The common parts that together are an error of all natural frequencies in proportion to ω², one at the highest of the band.
    pub(super) fn square_trend(&self) -> impl Iterator<Item = usize> {
        let first = self.curves.count() + OF_MESH + 1;
        (0..self.modes.groups()).map(move |group| first + group * COMMON_PARTS)
    }

    /// What each δ_i has of it.
    pub(super) fn of_square_trend(&self) -> Vec<f64> {
        let first = self.curves.count();
        let of = |i: usize| self.square_trend().map(|part| self.common(i)[part - first]).sum();
        (0..self.stiffness_errors()).map(of).collect()
    }

    /// Whether it is a common part, of the δ_i or of the ε_i, that grows with frequency.
    fn is_of_mesh(&self, coordinate: usize) -> bool {
        let part = (coordinate - self.curves.count()) % COMMON_PARTS;
        (OF_MESH..OF_SUPPORT).contains(&part) || part >= LOSS_OF_MESH
    }

    pub(super) fn first_factor(&self) -> usize {
        self.first_own() + self.stiffness_errors()
    }

    pub(super) fn first_load(&self) -> usize {
        self.first_gain() + if self.modes() > 0 { 1 + self.sensors() } else { 0 }
    }

    fn first_gain(&self) -> usize {
        self.first_mass() + if self.modes() > 0 { self.sensors() } else { 0 }
    }

    /// g of the force and of the sensors; none without modes.
    pub(super) fn gains(&self) -> std::ops::Range<usize> {
        self.first_gain()..self.first_load()
    }

    fn first_mass(&self) -> usize {
        self.first_factor() + self.factors.len()
    }

    pub(super) fn masses(&self) -> std::ops::Range<usize> {
        self.first_mass()..self.first_gain()
    }

    pub(super) fn first_shape(&self, sensor: usize) -> usize {
        self.shared() + sensor * self.modes()
    }

    /// a of the load and of the sensors.
    pub(super) fn shapes(&self) -> std::ops::Range<usize> {
        self.first_load()..self.count()
    }

    /// How much larger the error of a mode is than usual, of the coordinate of an own δ or of an a; 1 of what modes have in common. Above the band errors of
    /// meshes grow with the square of the frequency. Near a node of its shape the error of that is a part of what modes usually have there.
    pub(super) fn growth(&self, coordinate: usize) -> f64 {
        if coordinate < self.first_own() {
            return 1.0;
        }
        let of_shape =
            coordinate.checked_sub(self.first_load()).filter(|_| self.shapes().contains(&coordinate));
        // Factors, masses and calibrations belong to no mode.
        if of_shape.is_none() && !self.own().contains(&coordinate) {
            return 1.0;
        }
        let mode = self.mode_of(coordinate);
        let above_band = self.over_highest_squared(mode).max(1.0);
        let at_node = |k: usize| self.modes.usual_over_own(k / self.modes(), mode);
        above_band * of_shape.filter(|_| self.free_nodes).map_or(1.0, at_node)
    }

    /// The mode of the coordinate of an own δ or ε, or of an a.
    pub(super) fn mode_of(&self, coordinate: usize) -> usize {
        match self.own().contains(&coordinate) {
            true => self.modes.of_error[coordinate - self.first_own()],
            false => (coordinate - self.first_load()) % self.modes(),
        }
    }

    /// The square of a natural frequency over the highest frequency of the band.
    pub(super) fn over_highest_squared(&self, mode: usize) -> f64 {
        (self.modes.omega_rad_s[mode] / self.highest_rad_s).powi(2)
    }

    /// All coordinates but the curves and the δ_i, own and common.
    pub(super) fn beside_frequencies(&self) -> impl Iterator<Item = usize> {
        let own = self.own().filter(|&i| self.is_frequency(i));
        let of_frequency: Vec<usize> = self.in_common(true).chain(own).collect();
        (self.curves.count()..self.count()).filter(move |i| !of_frequency.contains(i))
    }

    /// Own parts of δ and ε.
    pub(super) fn own(&self) -> std::ops::Range<usize> {
        self.first_own()..self.first_factor()
    }

    /// Own parts of δ, or of ε, of modes that have a stiffness.
    pub(super) fn elastic(&self, is_frequency: bool) -> impl Iterator<Item = usize> {
        self.own().filter(move |&i| !self.is_rigid(i) && self.is_frequency(i) == is_frequency)
    }

    /// Whether it is a δ.
    fn is_frequency(&self, coordinate: usize) -> bool {
        self.modes.is_of_frequency(coordinate - self.first_own())
    }

    /// Whether it is of a rigid body.
    fn is_rigid(&self, coordinate: usize) -> bool {
        self.modes.omega_rad_s[self.modes.of_error[coordinate - self.first_own()]] == 0.0
    }

    /// No errors but those that the mesh is expected to have.
    pub(super) fn start(&self, theta: &[f64]) -> Place {
        let mut place = theta.to_vec();
        place.resize(self.count(), 0.0);
        if let Some((of_mesh, mesh)) = self.of_mesh() {
            place[of_mesh] = mesh.remainder;
        }
        place
    }

    /// The coordinates of the curves and of some of the factors: those of a fitting without modes.
    pub(super) fn coordinates_of(&self, some: &[FactorPrior]) -> Vec<usize> {
        let same = |wanted: &FactorPrior| self.factors.iter().position(|own| own == wanted);
        let factors = some.iter().filter_map(same).map(|t| self.first_factor() + t);
        (0..self.curves.count()).chain(factors).collect()
    }

    pub(super) fn errors(&self, place: &[f64]) -> ModalErrors {
        let (own, n) = (self.first_own(), self.modes());
        let first = self.curves.count();
        let common = |i: usize| self.common(i).iter().zip(&place[first..]).map(|(w, e)| w * e).sum::<f64>();
        let by_mesh = self.of_mesh().map_or(0.0, |(of_mesh, _)| place[of_mesh]);
        let with_mesh = |range: std::ops::Range<usize>| -> Vec<f64> {
            range.map(|i| place[i] + by_mesh * self.between_shapes(i)).collect()
        };
        let shape = |m: usize| with_mesh(self.first_shape(m)..self.first_shape(m) + n);
        let factor =
            |(prior, &error): (&FactorPrior, &f64)| FactorError { term: prior.term, part: prior.part, error };
        ModalErrors {
            scale: self.of_scale().map_or(0.0, |scale| place[scale]),
            // Of the unknowns here, not of the model.
            loss: 0.0,
            of_loss: Arc::new([]),
            stiffness: (0..self.stiffness_errors()).map(|i| common(i) + place[own + i]).collect(),
            masses: place[self.masses()].to_vec(),
            gains: place[self.gains()].to_vec(),
            load: with_mesh(self.first_load()..self.shared()),
            shape: (0..self.sensors()).map(shape).collect(),
            factors: self.factors.iter().zip(&place[self.first_factor()..]).map(factor).collect(),
        }
    }

    /// The lines below the gap over the first mode, or over some modes more, up to all.
    pub(super) fn stages(&self, most: usize) -> impl Iterator<Item = &[usize]> {
        let modes: Vec<f64> =
            self.modes.omega_rad_s.iter().copied().filter(|&omega| omega <= self.highest_rad_s).collect();
        let count = modes.len().clamp(1, most);
        (1..=count).map(move |stage| {
            let last = stage * modes.len() / count;
            let end = match (last.checked_sub(1).and_then(|k| modes.get(k)), modes.get(last)) {
                (Some(below), Some(above)) => (below * above).sqrt(),
                _ => f64::INFINITY,
            };
            let below = self.lines.partition_point(|&i| self.omegas[i] <= end);
            &self.lines[..below]
        })
    }

    /// Whether the errors in the band are small ones of this model, or not much larger than was given, and it is no other. What another size of all unknown
    /// stiffness would do is no error of modes.
    pub(super) fn are_small(&self, place: &[f64], given: ErrorSizes) -> bool {
        let errors = self.errors(place);
        let is_in_band = |&i: &usize| {
            let omega = self.modes.omega_rad_s[i];
            omega > 0.0 && omega <= self.highest_rad_s
        };
        let in_band: Vec<usize> = (0..self.modes()).filter(is_in_band).collect();
        let square = |of: &dyn Fn(usize) -> f64| {
            in_band.iter().map(|&i| of(i).powi(2)).sum::<f64>() / in_band.len().max(1) as f64
        };
        let frequency = |i: usize| -> f64 {
            errors.scale + self.modes.frequency_errors(i).map(|error| errors.stiffness[error]).sum::<f64>()
        };
        let share = |i: usize| self.modes.share_of_unknown(i);
        let sum = |of: &dyn Fn(usize) -> f64| in_band.iter().map(|&i| of(i)).sum::<f64>();
        let squares = sum(&|i| share(i) * share(i));
        let size = if squares > 0.0 { sum(&|i| share(i) * frequency(i)) / squares } else { 0.0 };
        let size = size.clamp(-MAX_COMMON_ERROR, MAX_COMMON_ERROR);
        let of_mode = |i: usize| frequency(i) - size * share(i);
        let largest = |usual: f64, given: Option<f64>| {
            usual.max(MAX_ERROR_OVER_GIVEN_SIZE * given.unwrap_or(0.0)).powi(2)
        };
        let of_shapes = |(place, shape): (usize, &Vec<f64>)| {
            let error = |i: usize| shape[i] / self.modes.usual_over_own(place, i);
            square(&error) <= largest(MAX_SHAPE_ERROR, given.shape)
        };
        square(&of_mode) <= largest(MAX_FREQUENCY_ERROR, given.frequency)
            && std::iter::once(&errors.load).chain(&errors.shape).enumerate().all(of_shapes)
    }

    /// What is known of calibrations and factors, and what the data say against it; nothing where the two agree.
    ///
    /// What all sensors show too much or too little of is one number, however it is shared between them and the force.
    pub(super) fn contradicted_assumptions(
        &self,
        place: &[f64],
        given: ErrorSizes,
    ) -> Vec<ContradictedAssumption> {
        let gains = &place[self.gains()];
        let of_all = gains.split_first().map(|(of_force, of_sensors)| {
            let count = of_sensors.len() as f64;
            let std = given.calibration.unwrap_or(CALIBRATION_PRIOR_STD) * (1.0 + 1.0 / count).sqrt();
            ContradictedAssumption {
                what: Assumption::Calibration,
                error: of_force + of_sensors.iter().sum::<f64>() / count,
                std,
            }
        });
        let of_factors = self.factors.iter().zip(&place[self.first_factor()..]);
        let of_factors = of_factors.filter(|(prior, _)| prior.is_known).map(|(prior, &error)| {
            let what = Assumption::Factor { term: prior.term, part: prior.part };
            ContradictedAssumption { what, error, std: prior.std }
        });
        let mut all: Vec<ContradictedAssumption> = of_all.into_iter().chain(of_factors).collect();
        all.sort_by(|a, b| b.deviations().total_cmp(&a.deviations()));
        let square: f64 = all.iter().map(|one| one.deviations().powi(2)).sum();
        if square <= MAX_DEVIATIONS.powi(2) {
            return Vec::new();
        }
        let is_large =
            |(k, one): &(usize, ContradictedAssumption)| *k == 0 || one.deviations() >= LARGE_DEVIATIONS;
        all.into_iter().enumerate().filter(is_large).map(|(_, one)| one).collect()
    }

    /// Coordinates that the search moves.
    fn moves(&self, coordinate: usize) -> bool {
        let is_mass = self.masses().contains(&coordinate);
        let is_own_damping = self.own().contains(&coordinate) && !self.is_frequency(coordinate);
        let shared = coordinate.checked_sub(self.curves.count()).filter(|_| coordinate < self.first_own());
        let is_common_damping =
            shared.is_some_and(|part| !is_frequency_part(part)) && self.of_unknown_loss() != Some(coordinate);
        let is_left_out = (self.held && coordinate < self.curves.count())
            || (is_mass && !self.kinds.masses)
            || (is_common_damping && self.kinds.damping == Damping::None)
            || (is_own_damping && self.kinds.damping != Damping::Own);
        !is_left_out
    }

    /// Slopes of x_m by the shared coordinates, then by the shapes at the sensor. `common` is [`Self::common`] of each error.
    fn row(
        &self,
        slopes: &ErrorSlopes,
        (Slopes { of_theta, of_loss }, omega_rad_s): (&Slopes, f64),
        common: &[Vec<f64>],
        m: usize,
    ) -> Vec<c64> {
        let along = |(j, slope): &(usize, c64)| slopes.slopes[*j][m] * slope;
        let mut row: Vec<c64> = of_theta.iter().map(along).collect();
        row.extend(self.curves.channels().slopes(slopes.response[m], m, omega_rad_s));
        if self.modes() > 0 {
            let mut of_common = vec![c64::default(); self.common_errors()];
            for (parts, slope) in common.iter().zip(&slopes.stiffness[m]) {
                of_common.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part * slope);
            }
            of_common[0] = slopes.scale[m];
            if let Some(place) = self.of_unknown_loss() {
                of_common[place - self.curves.count()] = of_loss.iter().map(along).sum();
            }
            if let (Some(mesh), Some(last)) = (self.mesh, of_common.last_mut()) {
                let at = |by: &[f64], slopes: &[c64]| -> c64 {
                    by.iter().zip(slopes).map(|(by, slope)| *by * slope).sum()
                };
                *last += at(&mesh.load, &slopes.load[m]) + at(&mesh.shape[m], &slopes.shape[m]);
            }
            row.extend(of_common);
            row.extend(&slopes.stiffness[m]);
        }
        row.extend(&slopes.factors[m]);
        // Without modes masses and calibrations are no coordinates.
        if self.modes() > 0 {
            row.extend(&slopes.masses[m]);
            row.extend(&slopes.gains[m]);
        }
        row.extend(&slopes.load[m]);
        row.extend(&slopes.shape[m]);
        row
    }

    /// The responses near a place; `None` where they are not finite.
    pub(super) fn linearised(&self, place: Place) -> Option<Linearised> {
        let errors = self.errors(&place);
        let model = self.model.with_errors(self.modes, &errors);
        let common: Vec<Vec<f64>> = (0..self.stiffness_errors()).map(|i| self.common(i)).collect();
        let moving: Vec<usize> = (0..self.shared()).filter(|&i| self.moves(i)).collect();
        let coordinates = |m: usize| -> Vec<usize> {
            let shapes = self.first_shape(m)..self.first_shape(m) + self.modes();
            moving.iter().copied().chain(shapes).collect()
        };
        let coordinates = (0..self.sensors()).map(coordinates).collect();
        // In a row shapes at a sensor follow what is shared.
        let places: Vec<usize> =
            moving.iter().copied().chain(self.shared()..self.shared() + self.modes()).collect();
        let rows = |k: usize| -> Option<Vec<Vec<c64>>> {
            let i = self.lines[k];
            let (slopes, of_unknowns) = self.shown(&model, &errors, &place, i)?;
            let at_sensor = |m: usize| {
                let row = self.row(&slopes, (&of_unknowns, self.omegas[i]), &common, m);
                let rest = self.measured[i][m] - slopes.response[m];
                places.iter().map(|&place| row[place]).chain([rest]).collect()
            };
            Some((0..self.sensors()).map(at_sensor).collect())
        };
        let rows = map(self.for_each, self.lines.len(), rows).into_iter().collect::<Option<_>>()?;
        Some(Linearised { place, count: self.count(), coordinates, rows })
    }

    /// What the sensors show at a line, with its slopes, and those of the unknowns.
    fn shown(
        &self,
        model: &Projection,
        errors: &ModalErrors,
        place: &[f64],
        line: usize,
    ) -> Option<(ErrorSlopes, Slopes)> {
        let (values, of_unknowns) = self.unknowns_at(place, line)?;
        let point = (self.point)(line, &values)?;
        let slopes =
            model.respond_with_error_slopes((self.modes, errors), &point.at, point.correction).ok()?;
        Some((slopes.shown(&self.curves.shares(place, self.omegas[line])), of_unknowns))
    }

    /// The prior's precision, n × n: curve and errors.
    pub(super) fn precision(&self, sizes: &Sizes) -> Vec<f64> {
        let (n, own) = (self.count(), self.curves.count());
        let mut all = vec![0.0; n * n];
        let curve = self.curves.precision(self.centre, sizes.bend);
        for i in 0..own {
            all[i * n..i * n + own].copy_from_slice(&curve[i * own..(i + 1) * own]);
        }
        let mut set = |i: usize, std: f64| all[i * n + i] = std.powi(-2);
        let least = |i: usize| if self.is_of_mesh(i) { self.known.least_of_mesh } else { 0.0 };
        self.in_common(true).for_each(|i| set(i, sizes.common.max(least(i))));
        let only_if = |is_looked_for: bool, std: f64| if is_looked_for { std } else { NEGLIGIBLE_STD };
        let damping = |std: f64| only_if(self.kinds.damping == Damping::Own, std);
        let common_loss = |i: usize| {
            let std = sizes.common_loss.max(UNDAMPED_SHARE_RATIO * least(i));
            only_if(self.kinds.damping != Damping::None, std)
        };
        let mass = only_if(self.kinds.masses, sizes.mass);
        self.in_common(false).for_each(|i| set(i, common_loss(i)));
        // No response shows the error of the unknown's loss factor, however little there is of errors of damping.
        let of_unknown = sizes.common_loss.max(self.known.least_of_unknown_loss);
        self.of_unknown_loss().into_iter().for_each(|i| set(i, of_unknown));
        if let Some((place, mesh)) = self.of_mesh() {
            set(place, mesh.remainder);
        }
        let own = |i: usize| match (self.is_frequency(i), self.is_rigid(i)) {
            (true, false) => (sizes.frequency * self.growth(i)).hypot(self.scatter_of_mesh(i)),
            (false, false) => damping(sizes.loss_factor * self.growth(i)),
            (true, true) => RIGID_BODY_STD,
            // Of a support without damping ε is −2δ.
            (false, true) => damping(2.0 * RIGID_BODY_STD),
        };
        self.own().for_each(|i| set(i, own(i)));
        (self.first_factor()..).zip(self.factors).for_each(|(i, prior)| set(i, prior.std));
        self.masses().for_each(|i| set(i, mass));
        self.gains().for_each(|i| set(i, sizes.calibration));
        self.shapes().for_each(|i| set(i, (sizes.shape * self.growth(i)).hypot(self.scatter_of_mesh(i))));
        all
    }

    /// The step to where a quadratic form is least within the bounds: coordinates that would leave them stop there. Both are used up.
    fn step(&self, place: &[f64], matrix: &mut [f64], slope: &mut [f64]) -> Option<Vec<f64>> {
        let n = slope.len();
        loop {
            let mut step = slope.to_vec();
            Cholesky::new(n, matrix).ok()?.solve(&mut step);
            // Bounds are those of a few coordinates, and each stops once.
            let stopped = self.curves.stopped(place, &step);
            if stopped.is_empty() {
                return Some(step);
            }
            for (i, by) in stopped {
                for j in (0..n).filter(|&j| j != i) {
                    slope[j] -= matrix[i * n + j] * by;
                    (matrix[i * n + j], matrix[j * n + i]) = (0.0, 0.0);
                }
                (matrix[i * n + i], slope[i]) = (1.0, by);
            }
        }
    }

    /// From a minimum to where a smooth unknown as a whole is exp(by) times as large, and all else where it fits best beside that with errors of usual sizes: of
    /// the mean s = cᵀp of its logarithms at the knots, Δp = C c Δs/(cᵀCc). What all modes have in common stays: together with the other unknowns it
    /// can stand in for any scale.
    pub(super) fn with_scale(&self, from: &Minimum, (unknown, by): (usize, f64)) -> Option<Place> {
        let n = self.count();
        let usual = Sizes::prior(self.known).of_kinds(self.kinds, self.known);
        let mut whole = from.normal.with_prior(&self.precision(&usual));
        self.in_common(true).for_each(|i| whole[i * n + i] = NEGLIGIBLE_STD.powi(-2));
        let mut mean = vec![0.0; n];
        self.curves.scale(&mut mean, unknown, 1.0);
        let knots: f64 = mean.iter().sum();
        mean.iter_mut().for_each(|share| *share /= knots);
        let mut along = mean.clone();
        Cholesky::new(n, &whole).ok()?.solve(&mut along);
        let variance: f64 = mean.iter().zip(&along).map(|(a, b)| a * b).sum();
        let mut place: Place =
            from.place.iter().zip(&along).map(|(place, along)| place + by / variance * along).collect();
        self.curves.keep_within_bounds(&mut place);
        Some(place)
    }

    /// Levenberg and Marquardt's method from a place: where it ends, and the responses near there.
    pub(super) fn descend(
        &self,
        mut at: Linearised,
        sigma: &[Vec<f64>],
        precision: &[f64],
        steps: usize,
    ) -> Option<(Minimum, Linearised)> {
        let n = self.count();
        let prior = |place: &[f64]| -> (f64, Vec<f64>) {
            let off: Vec<f64> = (0..n).map(|i| place[i] - self.expected(i)).collect();
            let times: Vec<f64> =
                precision.chunks_exact(n).map(|row| row.iter().zip(&off).map(|(p, o)| p * o).sum()).collect();
            (times.iter().zip(&off).map(|(p, o)| p * o).sum(), times)
        };
        let mut normal = at.normal(sigma, self.for_each)?;
        let (mut of_prior, mut pull) = prior(&at.place);
        let (mut damping, mut refused) = (1e-4, 0);
        for _ in 0..steps {
            let mut matrix = normal.with_prior(precision);
            (0..n).for_each(|i| matrix[i * n + i] *= 1.0 + damping);
            let mut slope: Vec<f64> = normal.gradient.iter().zip(&pull).map(|(g, p)| g - p).collect();
            let Some(step) = self.step(&at.place, &mut matrix, &mut slope) else {
                damping *= 10.0;
                continue;
            };
            let longest = step[..self.curves.count()].iter().fold(0.0f64, |most, s| most.max(s.abs()));
            let part = (MAX_THETA_STEP / longest).min(1.0);
            let mut there: Place = at.place.iter().zip(&step).map(|(p, s)| p + part * s).collect();
            // Roundoff.
            self.curves.keep_within_bounds(&mut there);
            let (other_prior, other_pull) = prior(&there);
            let cost = normal.chi_squared + of_prior;
            let other = self.linearised(there).and_then(|there| {
                let normal = there.normal(sigma, self.for_each)?;
                (normal.chi_squared + other_prior <= cost).then_some((there, normal))
            });
            match other {
                Some((there, other)) => {
                    let gain = cost - other.chi_squared - other_prior;
                    (at, normal, of_prior, pull) = (there, other, other_prior, other_pull);
                    damping = (damping * 0.1).max(1e-9);
                    refused = 0;
                    if gain <= (COST_RTOL * cost).max(COST_ATOL) && part == 1.0 {
                        break;
                    }
                }
                None => {
                    damping = (damping * 10.0).max(1e-6);
                    refused += 1;
                    if refused == MAX_REFUSED_STEPS {
                        break;
                    }
                }
            }
        }
        Some((Minimum { place: at.place.clone(), normal, prior: of_prior }, at))
    }
}

/// The line at whose modulus the modes are those of the model.
pub(super) fn middle(lines: &[usize]) -> usize {
    lines[lines.len() / 2]
}

/// Parts in which the lines are summed.
const LINE_CHUNKS: usize = 4;
