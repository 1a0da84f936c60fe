//! A band once more, corrected for the errors of the model, which are carried into every error bar (B-11).

use super::joint;
use super::neighbourhoods::Neighbourhoods;
use super::outcome::BandOutcome;
use super::scaled::Scaled;
use crate::c64;
use crate::for_each::map;
use crate::frequency::omega_rad_s;
use crate::frfs::{Noise, standard_deviations};
use crate::identify::channel::ChannelUnknowns;
use crate::identify::channel_coordinates::ChannelCoordinates;
use crate::identify::context::Context;
use crate::identify::measured::Band;
use crate::identify::model_errors::{
    AveragedModel, Coarser, Curve, Curves, Estimated, Explanation, Measured, NoiseScale, PointAt, Spline,
    averaged_over_small_errors, covariance, estimate,
};
use crate::identify::noise::{levels, without};
use crate::identify::options::{ModelErrors, Options};
use crate::identify::outcome::{Line, Status};
use crate::median::median;
use crate::model::ModelAt;
use crate::subspace::{Corrected, ModalErrors, Modes, Point, Projection};
use crate::thinned::thinned;

/// What is found when the errors of the model are estimated and corrected for; the same where a right model explains the band as well. Scales and delays of
/// channels that are unknown are estimated with them, as corrections of those that the band has.
pub(super) fn correct<'a>(
    (band, unknown): (&Band<'_>, &[ChannelUnknowns]),
    at: &[ModelAt<'a>],
    found: BandOutcome,
    reduced: &mut Neighbourhoods<'a, '_>,
    options: &Options,
    context: Context<'_>,
) -> BandOutcome {
    if options.model_errors.is_exact(band.model) {
        return found;
    }
    let weights = Weights::new((band, unknown), at, &found.left_out());
    let curves = weights.smooth(band, unknown);
    let point = point(at);
    let measured = weights.of(band, options, &point, &found);
    let (explanation, leverage) = estimate(reduced.whole(), &measured, &curves, context.for_each);
    let small = match &explanation {
        Explanation::RightModel => small_errors(reduced.whole(), &measured, &curves, context),
        _ => None,
    };
    let found = BandOutcome { leverage, ..found };
    let errors = match explanation {
        Explanation::RightModel => {
            let Some(small) = small else { return found };
            return with_small_errors(found, small, at, reduced.whole(), &weights.sigma, context);
        }
        Explanation::OtherModel => return BandOutcome { other_model: true, ..found },
        Explanation::Errors(errors) => *errors,
    };
    let before = reduced.work();
    reduced.correct(&errors.modes, &errors.errors);
    let scaled =
        Scaled::new(band, &errors.channels().at(errors.theta())).with_rest(errors.rest, band.frequency_hz);
    let outcome = on_corrected(&scaled.band(band), at, reduced, (errors, &found), options, context);
    let mut work = found.work;
    work += reduced.work().since(before);
    BandOutcome { work, ..outcome }
}

/// Errors of a right model that are too small to be seen. Where channels have an unknown scale or delay, its bars are those of the noise.
fn small_errors(
    whole: &Projection,
    measured: &Measured<'_, '_>,
    curves: &Curves,
    context: Context<'_>,
) -> Option<AveragedModel> {
    let start = measured.starts(curves).into_iter().next().filter(|_| curves.channels().count() == 0)?;
    averaged_over_small_errors(whole, measured, curves, &start, context.for_each)
}

/// The answers of a right model, with such errors in their bars. What noise leaves identifiable stays so.
fn with_small_errors(
    mut found: BandOutcome,
    small: AveragedModel,
    at: &[ModelAt<'_>],
    whole: &Projection,
    sigma: &[Vec<f64>],
    context: Context<'_>,
) -> BandOutcome {
    let corrected = Corrected::new(whole, &small.estimated.modes, &small.estimated.errors);
    widen(&mut found, &small.estimated, at, (whole, &corrected), sigma, context);
    BandOutcome { small_errors: Some(small), ..found }
}

/// The band on a model that is corrected for its errors, with their effect on its bars; what was found before says of which sensors nothing is asked.
pub(super) fn on_corrected<'a>(
    band: &Band<'_>,
    at: &[ModelAt<'a>],
    reduced: &mut Neighbourhoods<'a, '_>,
    (mut errors, found): (Estimated, &BandOutcome),
    options: &Options,
    context: Context<'_>,
) -> BandOutcome {
    let left_out = found.left_out();
    let mut outcome = joint::identify(band, at, Some(&mut *reduced), &left_out, options, context);
    outcome.leverage.clone_from(&found.leverage);
    for (sensor, before) in outcome.sensors.iter_mut().zip(&found.sensors) {
        sensor.contradicts |= before.contradicts;
        sensor.left_out |= before.left_out;
    }
    let fitted = errors.channels().count();
    if fitted > 0 {
        outcome = outcome.with_fitted(fitted, band);
    }
    let sigma = without(&standard_deviations(band.frequency_hz, band.measured, band.noise), &left_out);
    let corrected = reduced.corrected().map(|corrected| (reduced.whole(), corrected));
    errors.bars_over_noise =
        corrected.and_then(|corrected| widen(&mut outcome, &errors, at, corrected, &sigma, context));
    // What noise leaves of the loss factor is decided already. Errors of the model make its bar longer, and the modulus may be known all the same.
    for line in outcome.lines.iter_mut().filter(|line| line.status == Status::Ok) {
        let is_known = line
            .factor()
            .zip(line.uncertainty())
            .is_none_or(|(f, bars)| bars.is_modulus_known(f) && bars.is_linear());
        if !is_known {
            line.status = Status::NotIdentifiable;
        }
    }
    outcome.other_model = !errors.contradicted_assumptions.is_empty();
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
    levels: Vec<Vec<f64>>,
    omegas: Vec<f64>,
    nominal: Vec<Vec<c64>>,
    /// θ of the channels: as they are.
    given: [Vec<f64>; 1],
}

impl Weights {
    pub(super) fn new(
        (band, unknown): (&Band<'_>, &[ChannelUnknowns]),
        at: &[ModelAt<'_>],
        left_out: &[usize],
    ) -> Self {
        let of = |noise: Noise<'_>| {
            without(&standard_deviations(band.frequency_hz, band.measured, noise), left_out)
        };
        Self {
            sigma: of(band.noise),
            size: of(Noise::Unknown),
            levels: levels(band.measured, band.frequency_hz),
            omegas: at.iter().map(|at| omega_rad_s(at.frequency_hz)).collect(),
            nominal: at.iter().map(|at| vec![at.parameters[0].nominal]).collect(),
            given: [vec![0.0; unknown.iter().map(|one| one.count()).sum()]],
        }
    }

    pub(super) fn omegas(&self) -> &[f64] {
        &self.omegas
    }

    /// A smooth modulus, and the channels of unknown scale or delay.
    pub(super) fn smooth(&self, band: &Band<'_>, unknown: &[ChannelUnknowns]) -> Curves {
        let curves = Curves::new(vec![Curve::Spline(Spline::new(&self.omegas, band.unknown.real))]);
        curves.with_channels(ChannelCoordinates::new(unknown, 0, &self.omegas))
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
            given: &self.given,
            given_sizes: options.model_errors.sizes(),
            coarser: band.coarser.map(|mesh| Coarser { mesh, unknowns: std::slice::from_ref(band.unknown) }),
            measured: band.measured,
            sigma: &self.sigma,
            size: &self.size,
            levels: &self.levels,
            noise_scale: NoiseScale::of(band.noise),
            free: &found.lines,
            own: &[0],
            level_per_frequency: found.noise.level,
            fit: found.fit,
            may_be_wrong: options.model_errors != ModelErrors::None,
            wants_curves: false,
        }
    }
}

/// Answers along the path about which a smaller model is made, and to which error: of error bars three digits are more than enough.
const PATH_POINTS: usize = 24;
const PATH_TOL: f64 = 1e-6;

/// A smaller model with the errors, good near the answers on the path, with its modes; `None` where it would be no smaller.
fn near_path(
    (whole, modes, errors): (&Projection, &Modes, &ModalErrors),
    at: &[ModelAt<'_>],
    lines: &[Line],
) -> Option<(Modes, Projection)> {
    let on_path: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].on_path).collect();
    let point = |&i: &usize| Some(Point { at: at[i].clone(), correction: lines[i].correction()? });
    let points: Vec<Point<'_>> = thinned(&on_path, PATH_POINTS).filter_map(point).collect();
    let (small, modes) = whole.about_modes(modes, &points, PATH_TOL)?;
    let small = small.with_errors(&modes, errors);
    Some((modes, small))
}

/// Adds to the error bars what the errors of the model make of the factor. Returns how much longer the bars become: the median of the lines that are `ok`.
fn widen(
    outcome: &mut BandOutcome,
    errors: &Estimated,
    at: &[ModelAt<'_>],
    (whole, Corrected { modes, errors: values, model }): (&Projection, &Corrected),
    sigma: &[Vec<f64>],
    context: Context<'_>,
) -> Option<f64> {
    let near_path = near_path((whole, modes, values), at, &outcome.lines);
    let covariances = errors.of_channels_and_errors();
    let channels = errors.channels();
    let lines = &outcome.lines;
    let split = errors.split();
    let moved = map(context.for_each, lines.len(), |i| -> Option<([f64; 3], Option<[f64; 3]>)> {
        let correction = lines[i].correction()?;
        let (modes, model) = match &near_path {
            Some((modes, model)) if lines[i].on_path => (modes, model),
            _ => (modes, model),
        };
        let slopes = model.respond_with_error_slopes((modes, values), &at[i], correction).ok()?;
        let n = modes.omega_rad_s.len();
        let first_error = channels.count() + errors.in_common();
        let first_factor = first_error + modes.of_error.len();
        let first_mass = first_factor + values.factors.len();
        let first_gain = first_mass + values.masses.len();
        let first_load = first_gain + values.gains.len();
        let first_shape = first_load + n;
        let count = first_shape + sigma[i].len() * n;
        let mut pulls = vec![c64::default(); count];
        let mut weight = 0.0;
        for (m, sigma) in sigma[i].iter().enumerate().filter(|(_, sigma)| sigma.is_finite()) {
            let along = slopes.slopes[0][m].conj() / (sigma * sigma);
            weight += slopes.slopes[0][m].norm_sqr() / (sigma * sigma);
            let of_channels = channels.slopes(slopes.response[m], m, omega_rad_s(at[i].frequency_hz));
            let in_common = slopes.in_common(modes).map(|of_sensors| of_sensors[m]);
            let before_errors: Vec<c64> = of_channels.chain(in_common).collect();
            let own = [
                (0, &before_errors),
                (first_error, &slopes.stiffness[m]),
                (first_factor, &slopes.factors[m]),
                (first_mass, &slopes.masses[m]),
                (first_gain, &slopes.gains[m]),
                (first_load, &slopes.load[m]),
                (first_shape + m * n, &slopes.shape[m]),
            ];
            for (first, slopes) in own {
                pulls[first..].iter_mut().zip(slopes).for_each(|(pull, slope)| *pull += along * slope);
            }
        }
        pulls.iter_mut().for_each(|pull| *pull /= weight);
        // No curve is pulled: a frequency has a value of its own.
        let of_curves = std::iter::repeat_n(0.0, errors.count() - count);
        let gradient: Vec<f64> = of_curves.chain(pulls.iter().map(|pull| pull.re)).collect();
        Some((covariance(&covariances, &pulls), split.as_ref().map(|split| split.of(&gradient))))
    });
    let mut longer = Vec::new();
    for (line, moved) in outcome.lines.iter_mut().zip(moved) {
        let (Some((moved, parts)), Some(factor)) = (moved, line.factor()) else { continue };
        let Some(bars) = line.values[0].uncertainty.as_mut() else { continue };
        let of_noise = bars.storage_std;
        bars.widen(factor, moved);
        if let Some([of_channels, model, known_factors]) = parts {
            bars.divide([of_noise * of_noise + of_channels, model, known_factors]);
        }
        if line.status == Status::Ok {
            longer.push(bars.storage_std / of_noise);
        }
    }
    median(longer)
}
