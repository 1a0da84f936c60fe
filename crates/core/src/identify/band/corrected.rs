//! A band once more, with the errors of the model taken out and carried into every error bar (B-11).

use super::noise::deviations;
use super::outlier_sensor::without;
use super::reduced_band::ReducedBand;
use super::{Band, BandOutcome, Context, Noise, joint};
use crate::c64;
use crate::for_each::map;
use crate::identify::model_errors::{Deviations, Estimated, Measured, covariance, estimate};
use crate::identify::{ModelErrors, Options, Status};
use crate::model::ModelAt;

/// What is found when the errors of the model are estimated and taken out; the same where a right model explains the band as well.
pub(super) fn correct<'a>(
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    found: BandOutcome,
    space: &mut ReducedBand<'a, '_>,
    options: &Options,
    hooks: Context<'_>,
) -> BandOutcome {
    if options.model_errors == ModelErrors::None {
        return found;
    }
    let sigma = Weights::new(band, &found.left_out());
    let measured = sigma.of(band, at, &found, options);
    let Some(errors) = estimate(space.whole(), &measured, hooks.for_each) else { return found };
    let before = space.work();
    space.correct(&errors.modes, &errors.errors);
    let mut outcome = joint::identify(band, at, Some(space), &found.left_out(), options, hooks);
    outcome.work = found.work;
    outcome.work += space.work().since(before);
    for (sensor, before) in outcome.sensors.iter_mut().zip(&found.sensors) {
        sensor.contradicts |= before.contradicts;
        sensor.left_out |= before.left_out;
    }
    widen(&mut outcome, &errors, at, space, &sigma.sigma, hooks);
    outcome.model_errors = Some(errors);
    outcome
}

/// What the lines of a band are weighed by.
pub(super) struct Weights {
    sigma: Vec<Vec<f64>>,
    size: Vec<Vec<f64>>,
}

impl Weights {
    pub(super) fn new(band: &Band<'_>, left_out: &[usize]) -> Self {
        let of = |noise: Noise<'_>| without(&deviations(band.measured, noise), left_out);
        Self { sigma: of(band.noise), size: of(Noise::Unknown) }
    }

    pub(super) fn of<'t, 'a>(
        &'t self,
        band: &Band<'t>,
        at: &'t [ModelAt<'a>],
        found: &'t BandOutcome,
        options: &Options,
    ) -> Measured<'t, 'a> {
        let known = matches!(band.noise, Noise::Known(_));
        Measured {
            at,
            measured: band.measured,
            sigma: &self.sigma,
            size: &self.size,
            deviations: if known { Deviations::Known } else { Deviations::Relative },
            free: &found.outcomes,
            alone: found.noise.level,
            real: options.real,
        }
    }
}

/// Adds to the error bars what those of the errors of the model make of the factor.
fn widen(
    outcome: &mut BandOutcome,
    errors: &Estimated,
    at: &[ModelAt<'_>],
    space: &ReducedBand<'_, '_>,
    sigma: &[Vec<f64>],
    hooks: Context<'_>,
) {
    let Some((modes, values, model)) = space.errors() else { return };
    let lines = &outcome.outcomes;
    let moved = map(hooks.for_each, lines.len(), |i| -> Option<[f64; 3]> {
        let correction = lines[i].correction()?;
        let slopes = model.respond_with_error_slopes((modes, values), &at[i], correction).ok()?;
        let (n, t) = (modes.omega_rad_s.len(), values.factors.len());
        let first_shape = modes.of_error.len() + t;
        let count = first_shape + sigma[i].len() * n;
        let mut pulls = vec![c64::default(); count];
        let mut weight = 0.0;
        for (m, sigma) in sigma[i].iter().enumerate().filter(|(_, sigma)| sigma.is_finite()) {
            let along = slopes.slope[m].conj() / (sigma * sigma);
            weight += slopes.slope[m].norm_sqr() / (sigma * sigma);
            let own = [
                (0, &slopes.frequency[m]),
                (modes.of_error.len(), &slopes.factors[m]),
                (first_shape + m * n, &slopes.shape[m]),
            ];
            for (first, slopes) in own {
                pulls[first..].iter_mut().zip(slopes).for_each(|(pull, slope)| *pull += along * slope);
            }
        }
        pulls.iter_mut().for_each(|pull| *pull /= weight);
        Some(covariance(&errors.covariance, &pulls))
    });
    for (line, moved) in outcome.outcomes.iter_mut().zip(moved) {
        let (Some(moved), Some(factor)) = (moved, line.factor()) else { continue };
        let Some(bars) = line.values[0].uncertainty.as_mut() else { continue };
        bars.widen(factor, moved);
        if line.status == Status::Ok && !(bars.is_known(factor) && bars.is_linear()) {
            line.status = Status::NotIdentifiable;
        }
    }
}
