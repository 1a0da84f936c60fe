//! A start from the modes of the measurement: paired with those of the model they say where each natural frequency is.
//!
//! A mode that is off by many half-widths has no slope towards its place. A rational fit of the responses shows that place whatever the model is.

use super::band_search::Search;
use super::fitting::{Fitting, Place, middle};
use super::tuned::MAX_SHARE;
use crate::identify::shown_modes::ShownModes;
use crate::median::median;
use crate::modal::{LOG_FACTOR_STD, MeasuredMode, Pair, PairedShape, by_shares, paired, stiffness_factors};
use std::f64::consts::TAU;

/// Fewer pairs say nothing of a common factor beside the errors of the modes.
const MIN_PAIRS: usize = 3;

/// The damping of a mode is that of the unknowns where they have so much of its strain energy.
const MIN_ENERGY_SHARE: f64 = 0.3;

/// How often pairs are made with unknowns that earlier pairs moved.
const PAIRING_ROUNDS: usize = 3;

/// By how much the loss factors of partners differ, over the usual one.
const LOSS_FACTOR_STD: f64 = 0.2;

/// No loss factor is a smaller part of the usual one.
const MIN_LOSS_FACTOR_RATIO: f64 = 0.1;

/// Natural frequencies say where an unknown is if its standard deviation by them is less than this, in its logarithm: half of what was assumed.
const KNOWN_LOG_STD: f64 = 0.5 * LOG_FACTOR_STD;

/// A mode of the model and its partner.
struct PairOfModes {
    /// What of its strain energy is in each unknown.
    shares: Vec<f64>,
    /// ln of the measured natural frequency over that of the model.
    log_ratio: f64,
    /// Of the measured mode.
    loss_factor: f64,
}

impl PairOfModes {
    /// What of its strain energy is in all unknowns.
    fn share(&self) -> f64 {
        self.shares.iter().sum()
    }
}

/// Unknown stiffnesses by the natural frequencies of the measurement, and its modes with their partners.
pub(super) struct ByModes {
    /// θ there.
    theta: Vec<f64>,
    /// Of constant stiffnesses that the pairs determine: which, p, and the standard deviation of ln p. Wide modes, and an unknown that varies over the band, say too little.
    pub(super) constants: Vec<(usize, f64, f64)>,
    pairs: Vec<Pair>,
    sensors: Vec<usize>,
    measured: Vec<PairedShape>,
}

impl Search<'_, '_> {
    /// The unknowns by the modes of the measurement. `None` where too few of them have a partner.
    pub(super) fn by_modes(&self, start: &[f64]) -> Option<ByModes> {
        let ShownModes { sensors, modes: measured } = self.shown_modes()?;
        let residues = |mode: &MeasuredMode| PairedShape {
            frequency_hz: mode.frequency_hz(),
            residues: mode.residues.clone(),
            energy_share: 1.0,
        };
        let of_measured: Vec<PairedShape> = measured.iter().map(residues).collect();
        let elastic = self.elastic();
        let mut theta = start.to_vec();
        let mut log_stds = Vec::new();
        let mut pairing = paired(&self.shapes(&theta, &sensors)?, &of_measured);
        // A single unknown is where the common factor says.
        for _ in 0..if self.stiffnesses.len() > 1 { PAIRING_ROUNDS } else { 1 } {
            if pairing.pairs.len() < MIN_PAIRS {
                return None;
            }
            let of_pair = |pair: &Pair| PairOfModes {
                shares: self.shares(elastic[pair.model]).collect(),
                log_ratio: -pair.frequency_difference.ln_1p(),
                loss_factor: 2.0 * measured[pair.measured].damping_ratio(),
            };
            let pairs: Vec<PairOfModes> = pairing.pairs.iter().map(of_pair).collect();
            log_stds = self.move_to(&mut theta, &pairs, pairing.stiffness_factor.ln())?;
            pairing = paired(&self.shapes(&theta, &sensors)?, &of_measured);
        }
        self.curves.keep_within_bounds(&mut theta);
        let line = middle(&self.lines);
        let (values, _) = self.curves.values(&theta, line, self.data.omegas[line])?;
        let each = self.stiffnesses.iter().zip(log_stds);
        let known = each.filter(|(unknown, std)| self.curves.is_constant(**unknown) && *std < KNOWN_LOG_STD);
        let constants = known.map(|(&unknown, std)| (unknown, values[unknown].re, std)).collect();
        Some(ByModes { theta, constants, pairs: pairing.pairs, sensors, measured: of_measured })
    }

    /// Where each mode that has a partner in the measurement has its natural frequency and its residues, and the unknowns the damping.
    /// Natural frequencies without a partner are tried all over their range.
    pub(super) fn at_partners(
        &self,
        ByModes { theta, pairs, sensors, measured, .. }: &ByModes,
        fitting: &Fitting<'_, '_>,
        used: &dyn Fn(usize, usize) -> bool,
    ) -> Option<Place> {
        let (elastic, scaled) = (self.elastic(), self.shapes(theta, sensors)?);
        let mut place = fitting.start(theta);
        for pair in pairs {
            let pair_of_modes = (&scaled[pair.model], &measured[pair.measured]);
            self.set_to_partner(&mut place, fitting, (elastic[pair.model], sensors), pair_of_modes);
        }
        let is_alone = |mode: &usize| pairs.iter().all(|pair| elastic[pair.model] != *mode);
        let alone: Vec<usize> = fitting.modes_up_to_band().into_iter().filter(is_alone).collect();
        fitting.with_best_frequencies_of(place, &alone, used)
    }

    /// Moves unknown stiffnesses to where natural frequencies and loss factors of pairs differ least. By Rayleigh's quotient an unknown with the share w of the strain energy of
    /// a mode changes ln ω by w/2 of the change of ln p, and the loss factor of the mode is Σ w η. `common` is ln of the factor on all of them with which the pairs fit best.
    /// Returns the standard deviations of ln p.
    fn move_to(&self, theta: &mut [f64], pairs: &[PairOfModes], common: f64) -> Option<Vec<f64>> {
        let is_single = self.stiffnesses.len() == 1;
        let own = |found: Vec<f64>| if is_single { vec![0.0] } else { found };
        let shares = pairs.iter().map(|pair| &*pair.shares);
        let log_ratios = pairs.iter().map(|pair| pair.log_ratio);
        let (factors, log_stds) = stiffness_factors(shares.clone().zip(log_ratios), common)?;
        for (&unknown, factor) in self.stiffnesses.iter().zip(own(factors)) {
            self.curves.scale(theta, unknown, common + factor);
        }
        let of_unknowns = pairs.iter().filter(|pair| pair.share() > MIN_ENERGY_SHARE);
        let usual = median(of_unknowns.map(|pair| pair.loss_factor / pair.share()).collect());
        let Some(usual) = usual else { return Some(log_stds) };
        let apart = [LOSS_FACTOR_STD * usual, usual];
        let rests: Vec<f64> = pairs.iter().map(|pair| pair.loss_factor - pair.share() * usual).collect();
        let (loss_factors, _) = by_shares(shares, &rests, apart)?;
        for (&unknown, loss_factor) in self.stiffnesses.iter().zip(own(loss_factors)) {
            let loss_factor = (usual + loss_factor).max(MIN_LOSS_FACTOR_RATIO * usual);
            self.curves.set_loss_factor(theta, unknown, loss_factor);
        }
        Some(log_stds)
    }

    /// Modes with stiffness.
    fn elastic(&self) -> Vec<usize> {
        (0..self.modes.omega_rad_s.len()).filter(|&i| self.modes.omega_rad_s[i] > 0.0).collect()
    }

    /// These modes with other values of the unknowns.
    fn shapes(&self, theta: &[f64], sensors: &[usize]) -> Option<Vec<PairedShape>> {
        self.elastic().into_iter().map(|mode| self.mode(mode, theta, sensors)).collect()
    }

    /// What of the strain energy of a mode is in each unknown stiffness.
    fn shares(&self, mode: usize) -> impl Iterator<Item = f64> {
        self.stiffnesses.iter().map(move |&j| self.modes.unknown_shares[mode][j])
    }

    /// A mode of the model with these values of the unknowns, by Rayleigh's quotient from those at which the modes were computed.
    fn mode(&self, mode: usize, theta: &[f64], sensors: &[usize]) -> Option<PairedShape> {
        let omega = self.modes.omega_rad_s[mode];
        let apart = |line: &usize| (self.data.omegas[*line] / omega).ln().abs();
        let line = self.lines.iter().copied().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let (values, _) = self.curves.values(theta, line, self.data.omegas[line])?;
        let log_ratio = |&j: &usize| (values[j].re / self.values_of_modes[j].re).ln();
        let log_factor: f64 =
            self.shares(mode).zip(&self.stiffnesses).map(|(share, j)| share * log_ratio(j)).sum();
        let omega = omega * (0.5 * log_factor).exp();
        let residues = self.modes.residues(mode, omega, sensors);
        let energy_share = self.shares(mode).sum();
        omega.is_finite().then_some(PairedShape { frequency_hz: omega / TAU, residues, energy_share })
    }

    /// Gives a mode the natural frequency and the residues of its partner.
    fn set_to_partner(
        &self,
        place: &mut Place,
        fitting: &Fitting<'_, '_>,
        (mode, sensors): (usize, &[usize]),
        (own, partner): (&PairedShape, &PairedShape),
    ) {
        let share_of = |error: &usize| self.modes.share_of(*error);
        let errors = self.modes.frequency_errors(mode);
        let Some(error) = errors.max_by(|a, b| share_of(a).total_cmp(&share_of(b))) else { return };
        place[fitting.first_own() + error] = (partner.frequency_hz / own.frequency_hz).ln();
        let residues = partner.residues.iter().zip(&own.residues);
        let ratios = residues.map(|(partner, own)| (partner / own).re);
        let ratios: Vec<(usize, f64)> = sensors
            .iter()
            .zip(ratios)
            .filter(|(_, ratio)| ratio.is_finite())
            .map(|(&m, ratio)| (fitting.first_shape(m) + mode, ratio.clamp(-MAX_SHARE, MAX_SHARE)))
            .collect();
        // The force has the part of the ratios that leaves the least unusual errors to the force and the sensors.
        let of_force = fitting.first_load() + mode;
        let unusual = |coordinate: usize, error: f64| (error / fitting.growth(coordinate)).powi(2);
        let cost = |force: f64| {
            let own = ratios.iter().map(|&(place, ratio)| unusual(place, ratio / force - 1.0));
            unusual(of_force, force - 1.0) + own.sum::<f64>()
        };
        let tried = std::iter::once(1.0).chain(ratios.iter().map(|(_, ratio)| *ratio));
        let force = tried.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap_or(1.0);
        place[of_force] = force - 1.0;
        ratios.iter().for_each(|&(coordinate, ratio)| place[coordinate] = ratio / force - 1.0);
    }

    fn shown_modes(&self) -> Option<ShownModes> {
        let data = self.data;
        let decay_per_s = data.on(self.curves, self.centre, self.lines[0])?.at.model.decay_per_s();
        ShownModes::new(data.omegas, (data.measured, data.sigma), decay_per_s, self.for_each)
    }
}
