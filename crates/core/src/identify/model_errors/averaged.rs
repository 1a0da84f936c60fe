//! A right model averaged over errors too small to be seen.

use super::band_search::{NEIGHBOURHOOD_TOL, Search};
use super::curve::Curves;
use super::descent::Minimum;
use super::estimated::{Estimated, covariance};
use super::fit::Explained;
use super::fitting::Fitting;
use super::measured::Measured;
use super::small_errors::About;
use crate::for_each::ForEach;
use crate::subspace::{Modes, Projection};

/// A right model whose covariance holds what errors too small to be seen may do.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct AveragedModel {
    pub(in crate::identify) estimated: Estimated,
    /// What small errors add to the covariance of the unknowns' θ, row after row.
    beside_noise: Vec<f64>,
}

impl AveragedModel {
    fn new(estimated: Estimated, of_noise: &[f64]) -> Self {
        let noise = of_noise.chunks_exact(estimated.theta().len().max(1));
        let rows = estimated.of_theta().into_iter().zip(noise);
        let beside_noise =
            rows.flat_map(|(own, noise)| own.into_iter().zip(noise).map(|(a, b)| a - b)).collect();
        Self { estimated, beside_noise }
    }

    /// What small errors add to the covariance of the unknowns' θ, row after row.
    pub(in crate::identify) fn beside_noise(&self) -> &[f64] {
        &self.beside_noise
    }

    /// What they add to the variances of the real and the imaginary part of an unknown at a line, and to their covariance.
    pub(in crate::identify) fn beside_noise_at(
        &self,
        unknown: usize,
        line: usize,
        frequency_hz: f64,
    ) -> Option<[f64; 3]> {
        let slopes = self.estimated.slopes(unknown, line, frequency_hz)?;
        Some(covariance(&self.beside_noise, &slopes))
    }
}

/// A right model at θ, averaged over errors too small to be seen. `None` where the case says how large errors are, or a coarser mesh does, and where
/// several sensors agree to roundoff.
pub(in crate::identify) fn averaged_over_small_errors(
    model: &Projection,
    data: &Measured<'_, '_>,
    curves: &Curves,
    theta: &[f64],
    for_each: ForEach<'_>,
) -> Option<AveragedModel> {
    let is_known = data.given_sizes.any() || data.coarser.is_some() || !data.may_be_wrong || data.is_exact();
    let search = if is_known { None } else { Search::new(model, data, (curves, theta), theta, for_each) }?;
    if search.factors.iter().any(|factor| factor.is_given) {
        return None;
    }
    let (near, modes) = search.smaller(&search.points(theta), NEIGHBOURHOOD_TOL);
    let none = Modes::none(&near);
    let fitting = Fitting { factors: &[], ..search.fitting(&near, &none, &search.lines) };
    let right = data.settled_near(&fitting, fitting.start(theta))?;
    let whole = search.fitting(&near, &modes, &search.lines);
    let about = About::new(data, &whole, &right, &[])?;
    let (moments, of_noise, place) = (about.second_moments()?, about.of_none()?, about.place);
    let at = Explained { found: Minimum { place, ..right.found }, ..right };
    let estimated = Estimated { modes: search.modes.clone(), ..data.estimated(&whole, at, &moments) };
    Some(AveragedModel::new(estimated, &of_noise))
}
