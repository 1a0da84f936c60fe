//! A band once more, with the errors of the model taken out and carried into every error bar (B-11).

use super::joint;
use super::outcome::BandOutcome;
use super::reduced_band::ReducedBand;
use crate::c64;
use crate::for_each::map;
use crate::frequency::omega_rad_s;
use crate::identify::context::Context;
use crate::identify::measured::Band;
use crate::identify::model_errors::{
    Coarser, Curve, Curves, Estimated, Measured, NoiseScale, PointAt, Spline,
};
use crate::identify::model_errors::{Explanation, covariance, estimate};
use crate::identify::noise::{Noise, standard_deviations, without};
use crate::identify::options::{ModelErrors, Options};
use crate::identify::outcome::Status;
use crate::median::median;
use crate::model::ModelAt;
use crate::subspace::{Corrected, Point};

/// What is found when the errors of the model are estimated and taken out; the same where a right model explains the band as well.
pub(super) fn correct<'a>(
    band: &Band<'a>,
    at: &[ModelAt<'a>],
    found: BandOutcome,
    reduced: &mut ReducedBand<'a, '_>,
    options: &Options,
    context: Context<'_>,
) -> BandOutcome {
    if options.model_errors == ModelErrors::None {
        return found;
    }
    let weights = Weights::new(band, at, &found.left_out());
    let curves = Curves::new(vec![Curve::Spline(Spline::new(&weights.omegas, band.unknown.real))]);
    let point = point(at);
    let measured = weights.of(band, options, &point, &found);
    let (explanation, leverage) = estimate(reduced.whole(), &measured, &curves, context.for_each);
    let found = BandOutcome { leverage, ..found };
    let mut errors = match explanation {
        Explanation::RightModel => return found,
        Explanation::OtherModel => return BandOutcome { other_model: true, ..found },
        Explanation::Errors(errors) => *errors,
    };
    let before = reduced.work();
    reduced.correct(&errors.modes, &errors.errors);
    let mut outcome = joint::identify(band, at, Some(reduced), &found.left_out(), options, context);
    outcome.leverage.clone_from(&found.leverage);
    outcome.work = found.work;
    outcome.work += reduced.work().since(before);
    for (sensor, before) in outcome.sensors.iter_mut().zip(&found.sensors) {
        sensor.contradicts |= before.contradicts;
        sensor.left_out |= before.left_out;
    }
    errors.bars_over_noise = widen(&mut outcome, &errors, at, reduced, &weights.sigma, context);
    outcome.model_errors = Some(errors);
    outcome
}

/// The model of a band with a value of its unknown.
pub(super) fn point<'t, 'a>(
    at: &'t [ModelAt<'a>],
) -> impl Fn(usize, &[c64]) -> Option<Point<'a>> + Sync + 't {
    |i, values| {
        let at = at[i].clone();
        Some(Point { correction: values[0] - at.parameters[0].nominal, at })
    }
}

/// What the lines of a band are weighed by, and their nominal values.
pub(super) struct Weights {
    sigma: Vec<Vec<f64>>,
    size: Vec<Vec<f64>>,
    omegas: Vec<f64>,
    nominal: Vec<Vec<c64>>,
}

impl Weights {
    pub(super) fn new(band: &Band<'_>, at: &[ModelAt<'_>], left_out: &[usize]) -> Self {
        let of = |noise: Noise<'_>| without(&standard_deviations(band.measured, noise), left_out);
        Self {
            sigma: of(band.noise),
            size: of(Noise::Unknown),
            omegas: at.iter().map(|at| omega_rad_s(at.frequency_hz)).collect(),
            nominal: at.iter().map(|at| vec![at.parameters[0].nominal]).collect(),
        }
    }

    pub(super) fn of<'t, 'a>(
        &'t self,
        band: &Band<'t>,
        options: &Options,
        point: PointAt<'t, 'a>,
        found: &'t BandOutcome,
    ) -> Measured<'t, 'a> {
        Measured {
            point,
            omegas: &self.omegas,
            nominal: &self.nominal,
            given: &[],
            given_sizes: options.model_errors.sizes(),
            coarser: band.coarser.map(|mesh| Coarser { mesh, unknowns: std::slice::from_ref(band.unknown) }),
            measured: band.measured,
            sigma: &self.sigma,
            size: &self.size,
            noise_scale: NoiseScale::of(band.noise),
            free: &found.outcomes,
            own: &[0],
            level_per_frequency: found.noise.level,
            fit: found.fit,
        }
    }
}

/// Adds to the error bars what the errors of the model make of the factor. Returns how much longer the bars become: the median of the lines that are `ok`.
fn widen(
    outcome: &mut BandOutcome,
    errors: &Estimated,
    at: &[ModelAt<'_>],
    reduced: &ReducedBand<'_, '_>,
    sigma: &[Vec<f64>],
    context: Context<'_>,
) -> Option<f64> {
    let Corrected { modes, errors: values, model } = reduced.corrected()?;
    let of_errors = errors.of_errors();
    let lines = &outcome.outcomes;
    let moved = map(context.for_each, lines.len(), |i| -> Option<[f64; 3]> {
        let correction = lines[i].correction()?;
        let slopes = model.respond_with_error_slopes((modes, values), &at[i], correction).ok()?;
        let n = modes.omega_rad_s.len();
        let first_mass = modes.of_error.len() + values.factors.len();
        let first_load = first_mass + values.masses.len();
        let first_shape = first_load + n;
        let count = first_shape + sigma[i].len() * n;
        let mut pulls = vec![c64::default(); count];
        let mut weight = 0.0;
        for (m, sigma) in sigma[i].iter().enumerate().filter(|(_, sigma)| sigma.is_finite()) {
            let along = slopes.slopes[0][m].conj() / (sigma * sigma);
            weight += slopes.slopes[0][m].norm_sqr() / (sigma * sigma);
            let own = [
                (0, &slopes.stiffness[m]),
                (modes.of_error.len(), &slopes.factors[m]),
                (first_mass, &slopes.masses[m]),
                (first_load, &slopes.load[m]),
                (first_shape + m * n, &slopes.shape[m]),
            ];
            for (first, slopes) in own {
                pulls[first..].iter_mut().zip(slopes).for_each(|(pull, slope)| *pull += along * slope);
            }
        }
        pulls.iter_mut().for_each(|pull| *pull /= weight);
        Some(covariance(&of_errors, &pulls))
    });
    let mut longer = Vec::new();
    for (line, moved) in outcome.outcomes.iter_mut().zip(moved) {
        let (Some(moved), Some(factor)) = (moved, line.factor()) else { continue };
        let Some(bars) = line.values[0].uncertainty.as_mut() else { continue };
        let of_noise = bars.storage_std;
        bars.widen(factor, moved);
        if line.status == Status::Ok {
            longer.push(bars.storage_std / of_noise);
            if !(bars.is_known(factor) && bars.is_linear()) {
                line.status = Status::NotIdentifiable;
            }
        }
    }
    median(longer)
}
