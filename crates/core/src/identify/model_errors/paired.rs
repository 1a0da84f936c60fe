//! A start from the modes of the measurement: paired with those of the model they say where each natural frequency is.
//!
//! A mode that is off by many half-widths has no slope towards its place. A rational fit of the responses shows that place whatever the model is.

use super::band_search::Search;
use super::fitting::{Fitting, Place};
use super::tuned::MAX_SHARE;
use crate::identify::shown_modes::ShownModes;
use crate::median::median;
use crate::modal::{MeasuredMode, Pair, PairedShape, paired};
use std::f64::consts::TAU;

/// Fewer pairs say nothing of a common factor beside the errors of the modes.
const MIN_PAIRS: usize = 3;

/// The damping of a mode is that of the unknowns where they have so much of its strain energy.
const MIN_ENERGY_SHARE: f64 = 0.3;

impl Search<'_, '_> {
    /// From a start to where each mode that has a partner in the measurement has its natural frequency and its residues, and the unknowns the damping.
    /// Natural frequencies without a partner are tried all over their range. `None` where there are too few pairs, or no unknown is smooth.
    pub(super) fn paired(
        &self,
        fitting: &Fitting<'_, '_>,
        start: &[f64],
        used: &dyn Fn(usize, usize) -> bool,
    ) -> Option<Place> {
        let ShownModes { sensors, modes: measured } = self.shown_modes()?;
        let residues = |mode: &MeasuredMode| PairedShape {
            frequency_hz: mode.frequency_hz(),
            residues: mode.residues.clone(),
            energy_share: 1.0,
        };
        let of_measured: Vec<PairedShape> = measured.iter().map(residues).collect();
        let elastic: Vec<usize> = (0..fitting.modes()).filter(|&i| self.modes.omega_rad_s[i] > 0.0).collect();
        let of_model = |theta: &[f64]| -> Option<Vec<PairedShape>> {
            elastic.iter().map(|&mode| self.mode(mode, theta, &sensors)).collect()
        };
        let there = of_model(start)?;
        let pairing = paired(&there, &of_measured);
        if pairing.pairs.len() < MIN_PAIRS {
            return None;
        }
        let mut theta = start.to_vec();
        let loss_factor = |pair: &Pair| {
            let share = there[pair.model].energy_share;
            (share > MIN_ENERGY_SHARE).then(|| 2.0 * measured[pair.measured].damping_ratio() / share)
        };
        let loss_factor = median(pairing.pairs.iter().filter_map(loss_factor).collect());
        for unknown in self.curves.smooth() {
            self.curves.scale(&mut theta, unknown, pairing.stiffness_factor.ln());
            if let Some(loss_factor) = loss_factor {
                self.curves.set_phase(&mut theta, unknown, loss_factor.atan());
            }
        }
        let scaled = of_model(&theta)?;
        let mut place = fitting.start(&theta);
        for pair in &pairing.pairs {
            let pair_of_modes = (&scaled[pair.model], &of_measured[pair.measured]);
            self.set_to_partner(&mut place, fitting, (elastic[pair.model], &sensors), pair_of_modes);
        }
        let is_alone = |mode: &usize| {
            self.modes.omega_rad_s[*mode] <= fitting.highest_rad_s
                && pairing.pairs.iter().all(|pair| elastic[pair.model] != *mode)
        };
        let alone: Vec<usize> = elastic.iter().copied().filter(is_alone).collect();
        fitting.with_best_frequencies_of(place, &alone, used)
    }

    /// A mode of the model with these values of the unknowns, by Rayleigh's quotient from those at which the modes were computed.
    fn mode(&self, mode: usize, theta: &[f64], sensors: &[usize]) -> Option<PairedShape> {
        let modes = &self.modes;
        let energy_share = *modes.energy_shares[mode].last()?;
        let omega = modes.omega_rad_s[mode];
        let apart = |line: &usize| (self.data.omegas[*line] / omega).ln().abs();
        let line = self.lines.iter().copied().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let (values, _) = self.curves.values(theta, line, self.data.omegas[line])?;
        let smooth = self.curves.smooth();
        let ln_ratio = |&j: &usize| (values[j].re / self.values_of_modes[j].re).ln();
        let mean = smooth.iter().map(ln_ratio).sum::<f64>() / smooth.len() as f64;
        let omega = omega * (0.5 * energy_share * mean).exp();
        let residues = modes.residues(mode, omega, sensors);
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
