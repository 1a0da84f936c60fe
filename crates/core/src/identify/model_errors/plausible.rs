//! Whether errors are plausible: small ones of this model, which agree with what is taken for known.

use super::fitting::Fitting;
use super::found::{Assumption, ContradictedAssumption};
use super::sizes::CALIBRATION_PRIOR_STD;

/// Errors larger than these, root mean squares over the modes of the band, are no small errors of this model: it is another one.
const MAX_FREQUENCY_ERROR: f64 = 0.05;
const MAX_SHAPE_ERROR: f64 = 0.3;

/// What of those of frequencies another size of the unknown stiffness may take, which is in its error bar: a fifth of that stiffness.
const MAX_COMMON_ERROR: f64 = 0.1;

/// The same over the sizes that were given.
const MAX_ERROR_OVER_GIVEN_SIZE: f64 = 3.0;

/// What is known of factors and calibrations is contradicted beyond so many of its standard deviations, of all of them together: 6 of 100 000 normal ones. Each beyond
/// so many is named.
const MAX_DEVIATIONS: f64 = 4.0;
const LARGE_DEVIATIONS: f64 = 2.0;

impl Fitting<'_, '_> {
    /// Whether the errors in the band are small ones of this model, or not much larger than was given, and it is no other. What another size of all unknown
    /// stiffness would do is no error of modes.
    pub(super) fn are_small(&self, place: &[f64]) -> bool {
        let given = self.known.given;
        let errors = self.errors(place);
        let modes = self.modes_up_to_band();
        let square = |of: &dyn Fn(usize) -> f64| {
            modes.iter().map(|&i| of(i).powi(2)).sum::<f64>() / modes.len().max(1) as f64
        };
        let frequency = |i: usize| -> f64 {
            errors.scale + self.modes.frequency_errors(i).map(|error| errors.stiffness[error]).sum::<f64>()
        };
        let share = |i: usize| self.modes.share_of_unknown(i);
        let sum = |of: &dyn Fn(usize) -> f64| modes.iter().map(|&i| of(i)).sum::<f64>();
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
    pub(super) fn contradicted_assumptions(&self, place: &[f64]) -> Vec<ContradictedAssumption> {
        let gains = &place[self.gains()];
        let of_all = gains.split_first().map(|(of_force, of_sensors)| {
            let count = of_sensors.len() as f64;
            let std =
                self.known.given.calibration.unwrap_or(CALIBRATION_PRIOR_STD) * (1.0 + 1.0 / count).sqrt();
            ContradictedAssumption {
                what: Assumption::Calibration,
                error: of_force + of_sensors.iter().sum::<f64>() / count,
                std,
            }
        });
        let errors = self.errors(place);
        let of_factors = self.factors.iter().zip(&errors.factors);
        let of_factors = of_factors.filter(|(prior, _)| prior.is_known).map(|(prior, one)| {
            let what = Assumption::Factor { term: one.term, part: one.part };
            ContradictedAssumption { what, error: one.relative()[0], std: prior.std }
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
}
