//! What is fitted: curves with the errors of the model, min over θ, δ, ν, a of χ² + their priors; and which coordinate is what.

use super::curve::Curves;
use super::factor_prior::FactorPrior;
use super::kinds::Kinds;
use super::measured::PointAt;
use super::mesh::BetweenMeshes;
use super::sizes::KnownSizes;
use super::sizes::MAX_COMMON_STD;
use crate::c64;
use crate::for_each::ForEach;
use crate::subspace::{FactorError, ModalErrors, Modes, Projection, UnknownLoss};
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
    pub(super) for_each: ForEach<'t>,
}

/// Parts that errors have in common, of each group: four of the δ_i, then four of the ε_i.
///
/// Of the δ_i: a scale of all stiffness; what grows with ω_i and with its square, as the errors of meshes do, in proportion to the strain energy there; what falls
/// with 1/ω_i², as the errors of supports do. The first and the last are of the first group alone. Of the ε_i: the same for all modes, with 1/ω_i², and with
/// ω_i and its square, since what a mesh has too much of stiffness has another damping than the mode.
const COMMON_PARTS: usize = 8;
const COMMON_FREQUENCY_PARTS: usize = 4;
const OF_MESH: usize = 1;
const OF_SUPPORT: usize = 3;
const LOSS_OF_MESH: usize = 6;

/// Whether a common part is one of the δ_i, and not of the ε_i.
pub(super) fn is_frequency_part(part: usize) -> bool {
    part % COMMON_PARTS < COMMON_FREQUENCY_PARTS
}

/// What modes have in common is improbable beyond so many standard deviations.
const IMPROBABLE: f64 = 2.0;

/// Where a search is: θ, the common parts of δ and ε, the amplitude of the mesh's error where there are two meshes, own parts of δ and ε, ν and Δη, κ. Then g of
/// the force and of each sensor, and a of the load and of each sensor.
pub(super) type Place = Vec<f64>;

impl Fitting<'_, '_> {
    pub(super) fn sensors(&self) -> usize {
        self.measured[0].len()
    }

    pub(super) fn modes(&self) -> usize {
        self.modes.omega_rad_s.len()
    }

    pub(super) fn stiffness_errors(&self) -> usize {
        self.modes.of_error.len()
    }

    /// θ, common and own δ, ε, ν, a of the load: what every sensor hangs on.
    pub(super) fn shared(&self) -> usize {
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
    pub(super) fn common_errors(&self) -> usize {
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

    /// The common parts of δ, or of ε.
    pub(super) fn in_common(&self, of_frequency: bool) -> impl Iterator<Item = usize> {
        let first = self.curves.count();
        let is_wanted = move |&part: &usize| is_frequency_part(part) == of_frequency;
        (0..self.common_parts()).filter(is_wanted).map(move |part| first + part)
    }

    /// The common parts of δ that are trends of one kind, in the order of their sizes: what grows with ω_i, with its square, or falls with 1/ω_i².
    pub(super) fn trend(&self, kind: usize) -> impl Iterator<Item = usize> + use<> {
        let first = self.curves.count() + OF_MESH + kind;
        (0..self.modes.groups()).map(move |group| first + group * COMMON_PARTS)
    }

    /// The common parts that together are an error of all natural frequencies in proportion to ω², one at the highest of the band.
    pub(super) fn square_trend(&self) -> impl Iterator<Item = usize> + use<> {
        self.trend(1)
    }

    /// What each δ_i has of it.
    pub(super) fn of_square_trend(&self) -> Vec<f64> {
        let first = self.curves.count();
        let of = |i: usize| self.square_trend().map(|part| self.common(i)[part - first]).sum();
        (0..self.stiffness_errors()).map(of).collect()
    }

    /// Whether it is a common part, of the δ_i or of the ε_i, that grows with frequency.
    pub(super) fn is_of_mesh(&self, coordinate: usize) -> bool {
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
    pub(super) fn is_frequency(&self, coordinate: usize) -> bool {
        self.modes.is_of_frequency(coordinate - self.first_own())
    }

    /// Whether it is of a rigid body.
    pub(super) fn is_rigid(&self, coordinate: usize) -> bool {
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

    /// Where smooth unknowns have what is the scale of all stiffness at a place, if that is an improbable one.
    pub(super) fn without_common_error(&self, place: &[f64]) -> Option<Place> {
        let scale = self.of_scale()?;
        let error = place[scale];
        if error.abs() <= IMPROBABLE * MAX_COMMON_STD {
            return None;
        }
        let mut there = place.to_vec();
        let unknowns = self.curves.smooth();
        for &unknown in &unknowns {
            // Natural frequencies go with the root of the stiffness.
            self.curves.scale(&mut there, unknown, 2.0 * error.ln_1p());
        }
        there[scale] = 0.0;
        (!unknowns.is_empty()).then_some(there)
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

    /// Δ_mi of the coordinate of an a, zero of any other: what of the amplitude of the mesh's error it has.
    pub(super) fn between_shapes(&self, coordinate: usize) -> f64 {
        let Some(mesh) = self.mesh else { return 0.0 };
        match coordinate.checked_sub(self.shapes().start) {
            Some(place) => {
                let (at, mode) = (place / self.modes(), place % self.modes());
                at.checked_sub(1).map_or(mesh.load[mode], |sensor| mesh.shape[sensor][mode])
            }
            None => 0.0,
        }
    }

    /// Elastic modes up to the end of the band: the responses show those below it too.
    pub(super) fn modes_up_to_band(&self) -> Vec<usize> {
        let is_elastic = |&mode: &usize| self.modes.omega_rad_s[mode] > 0.0;
        let is_up_to_band = |&mode: &usize| self.modes.omega_rad_s[mode] <= self.highest_rad_s;
        (0..self.modes()).filter(is_elastic).filter(is_up_to_band).collect()
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
}

/// The line at whose modulus the modes are those of the model.
pub(super) fn middle(lines: &[usize]) -> usize {
    lines[lines.len() / 2]
}
