//! What a mesh does to the modes of a model, by those of a coarser one (B-11).
//!
//! Modes of both meshes are paired by their frequencies, their residues between load and sensors, and where their strain energy is. With the strain energies
//! $e_g = y^T K_g y$ of the known stiffness and of that of the unknowns,
//! $$ \Delta_{g,i} = \frac{e_{g,i} - e^c_{g,i}}{2 \lambda_i}, \qquad \Delta_{mi} = \frac{\ell_m^T y_i - \ell_m^T y^c_i}{\ell_m^T y_i} $$
//! lie between the meshes. They are in the frequency and in the shape, and by Hellmann and Feynman in the slopes of the frequency by the unknowns too.

use crate::c64;
use crate::for_each::ForEach;
use crate::identify::coarser_mesh::CoarserMesh;
use crate::identify::unknown::{Composite, Unknown};
use crate::median::median;
use crate::modal::nearest_pairs;
use crate::subspace::{Modes, Point, Subspace, TrainOptions};

/// A coarser mesh with its unknowns.
#[derive(Clone, Copy)]
pub(in crate::identify) struct Coarser<'t> {
    pub(in crate::identify) mesh: &'t CoarserMesh,
    pub(in crate::identify) unknowns: &'t [Unknown],
}

impl<'t> Coarser<'t> {
    /// At these values of its unknowns.
    pub(super) fn point(&self, frequency_hz: f64, values: &[c64]) -> Option<Point<'t>> {
        let composite = Composite { model: &self.mesh.model, unknowns: self.unknowns };
        Some(Point { at: composite.at(frequency_hz, values).ok()?, correction: c64::default() })
    }
}

/// The differences Δ between two meshes, mode by mode of the finer one; zero for modes that have no partner.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct BetweenMeshes {
    /// δ over Δ: the part of it that the finer mesh still has.
    pub(super) remainder: f64,
    /// Δ_g,i of each error of a stiffness; zero of loss factors.
    pub(super) stiffness: Vec<f64>,
    /// Where the force acts.
    pub(super) load: Vec<f64>,
    /// Δ_mi, `[sensor][mode]`.
    pub(super) shape: Vec<Vec<f64>>,
    /// The natural frequency of the partner on the coarser mesh, rad/s.
    pub(super) partner_rad_s: Vec<Option<f64>>,
    /// Size of Δ, the largest of a mode and of those below it: where that of a mode alone is small, its mesh is too coarse for the power law.
    pub(super) largest_below: Vec<f64>,
    /// The usual size of Δ in the band.
    pub(super) usual: f64,
}

/// Error of the coarser mesh's reduced model: its modes are of second order in it.
const COARSER_MODEL_TOL: f64 = 1e-5;

/// The error of a mesh by a coarser one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshError {
    /// Modes of the band that are paired.
    pub paired: usize,
    /// The part of what lies between the meshes that the finer one still has, as expected of ratio and order of the elements: 1/(r^p − 1).
    pub expected: f64,
    /// The same as found.
    pub remainder: f64,
    /// The standard deviation of that.
    pub std: f64,
}

/// Standard deviations by which modes of one structure on two meshes differ: the logarithm of their frequencies, their residues over their size, and their shares
/// of strain energy.
const LOG_FREQUENCY_STD: f64 = 0.02;
const RESIDUE_STD: f64 = 0.3;
const ENERGY_SHARE_STD: f64 = 0.1;

/// Modes that differ by more than so many of them are two.
const MAX_DIFFERENCE: f64 = 3.0;

/// Above this part of the highest frequency of the band modes of a reduced model need not be those of the structure.
const PAIRED_UP_TO: f64 = 1.05;

/// Part of the modes of a band that are paired at least, or it is not the same structure, or is driven and measured elsewhere.
const MIN_PAIRED: f64 = 0.5;

/// An error of a shape beyond this belongs to a node, where it says nothing.
const MAX_SHAPE_DIFFERENCE: f64 = 0.5;

impl BetweenMeshes {
    /// At some points of the coarser mesh, of which one is where the finer one's modes are; `None` where too few modes are paired.
    pub(super) fn new(
        mesh: &CoarserMesh,
        points: &[Point<'_>],
        at: &Point<'_>,
        (modes, highest_rad_s): (&Modes, f64),
        for_each: ForEach<'_>,
    ) -> Option<Self> {
        let mut subspace = Subspace::new(&mesh.experiment, &points.last()?.at).ok()?;
        let options = TrainOptions::default().with_tolerance(COARSER_MODEL_TOL);
        subspace.train(points, &options, for_each).ok()?;
        let limit = PAIRED_UP_TO * (1.0 + LOG_FREQUENCY_STD * MAX_DIFFERENCE) * highest_rad_s;
        let most = 2 * modes.omega_rad_s.len();
        let coarser = subspace.projection().modes(&at.at, at.correction, limit, most).ok()?;
        Self::of(modes, &coarser, mesh.remainder(), highest_rad_s)
    }

    /// Of two sets of modes.
    fn of(modes: &Modes, coarser: &Modes, remainder: f64, highest_rad_s: f64) -> Option<Self> {
        let partners = paired(modes, coarser, PAIRED_UP_TO * highest_rad_s);
        let is_in_band = |omega: &f64| *omega > 0.0 && *omega <= highest_rad_s;
        let in_band = modes.omega_rad_s.iter().zip(&partners).filter(|(omega, _)| is_in_band(omega));
        let [all, known] = [in_band.clone().count(), in_band.filter(|(_, j)| j.is_some()).count()];
        if (known as f64) < MIN_PAIRED * all as f64 {
            return None;
        }
        let n = modes.omega_rad_s.len();
        let mut stiffness = vec![0.0; modes.of_error.len()];
        let mut load = vec![0.0; n];
        let mut shape = vec![vec![0.0; n]; modes.sensors.len()];
        let mut sizes = vec![None; n];
        for (i, j) in partners.iter().enumerate().filter_map(|(i, j)| Some((i, (*j)?))) {
            let square = (coarser.omega_rad_s[j] / modes.omega_rad_s[i]).powi(2);
            let [own, other] = [&modes.energy_shares[i], &coarser.energy_shares[j]];
            for error in modes.frequency_errors(i) {
                let group = modes.group[error];
                stiffness[error] = 0.5 * (own[group] - square * other.get(group).unwrap_or(&0.0));
            }
            sizes[i] = Some(modes.frequency_errors(i).map(|error| stiffness[error]).sum::<f64>().abs());
            // The sign of a mode is arbitrary.
            let products = modes.sensors.iter().zip(&coarser.sensors).map(|(own, other)| own[i] * other[j]);
            let sum = products.sum::<f64>() + (modes.load[i].conj() * coarser.load[j]).re;
            let sign = if sum < 0.0 { -1.0 } else { 1.0 };
            let relative = |own: f64, other: f64| {
                let difference = (own - sign * other) / own;
                if difference.abs() <= MAX_SHAPE_DIFFERENCE { difference } else { 0.0 }
            };
            load[i] = relative(modes.load[i].re, coarser.load[j].re);
            for (own, (fine, coarse)) in shape.iter_mut().zip(modes.sensors.iter().zip(&coarser.sensors)) {
                own[i] = relative(fine[i], coarse[j]);
            }
        }
        let partner_rad_s = partners.iter().map(|j| j.map(|j| coarser.omega_rad_s[j])).collect();
        let largest = |i: usize| sizes[..=i].iter().flatten().copied().fold(0.0, f64::max);
        let largest_below = (0..n).map(largest).collect();
        let usual = median(sizes.iter().flatten().copied().collect())?;
        Some(Self { remainder, stiffness, load, shape, partner_rad_s, largest_below, usual })
    }

    /// Whether a mode has a partner.
    pub(super) fn is_paired(&self, mode: usize) -> bool {
        self.partner_rad_s[mode].is_some()
    }
}

/// The partner of each mode up to some frequency: of all pairs those that differ least, one after the other.
fn paired(modes: &Modes, coarser: &Modes, highest_rad_s: f64) -> Vec<Option<usize>> {
    let own = residues(modes);
    let other = residues(coarser);
    let difference = |i: usize, j: usize| -> f64 {
        let frequency = (modes.omega_rad_s[i] / coarser.omega_rad_s[j]).ln() / LOG_FREQUENCY_STD;
        let [mut apart, mut size] = [0.0; 2];
        for (a, b) in own[i].iter().zip(&other[j]) {
            apart += (a - b).norm_sqr();
            size += 0.5 * (a.norm_sqr() + b.norm_sqr());
        }
        let residue = if size > 0.0 { (apart / size).sqrt() / RESIDUE_STD } else { 0.0 };
        let shares = modes.energy_shares[i].iter().zip(&coarser.energy_shares[j]);
        let energy = shares.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt() / ENERGY_SHARE_STD;
        frequency.hypot(residue).hypot(energy)
    };
    let is_elastic = |omega: f64| omega > 0.0;
    let count = (modes.omega_rad_s.len(), coarser.omega_rad_s.len());
    let pairs = nearest_pairs(count, MAX_DIFFERENCE, |i, j| {
        let [own, other] = [modes.omega_rad_s[i], coarser.omega_rad_s[j]];
        let counts = is_elastic(own) && own <= highest_rad_s && is_elastic(other);
        if counts { difference(i, j) } else { f64::INFINITY }
    });
    let mut partners = vec![None; count.0];
    pairs.into_iter().for_each(|(i, j)| partners[i] = Some(j));
    partners
}

/// Residues Fᵀy_i · ℓ_mᵀy_i of each mode: they have no sign of their own.
fn residues(modes: &Modes) -> Vec<Vec<c64>> {
    let of = |i: usize| modes.sensors.iter().map(|own| modes.load[i] * own[i]).collect();
    (0..modes.omega_rad_s.len()).map(of).collect()
}
