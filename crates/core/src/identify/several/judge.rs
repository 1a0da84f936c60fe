//! Error bars, what is not identifiable, and statuses.

use super::Task;
use super::at_frequency::Solution;
use super::coordinates::Own;
use super::information::Information;
use super::neighbourhoods::Neighbourhoods;
use super::search::{BandSolution, Place, Plane, Reach};
use crate::c64;
use crate::for_each::map;
use crate::frfs::Noise;
use crate::identify::band::{MAX_REDUCTION_ERROR, reduction_error};
use crate::identify::band_value::{BandCoordinate, BandValue, Direction, Number, NumberOf, Profile};
use crate::identify::channel::ChannelNumber;
use crate::identify::goodness_of_fit::{GoodnessOfFit, MAX_ERROR, MAX_RMS_MISFIT, judge};
use crate::identify::identification::{Identifiability, Identification, SearchReport};
use crate::identify::local_fit::of_responses;
use crate::identify::model_errors::{Estimated, Split};
use crate::identify::noise::NoiseLevel;
use crate::identify::outcome::{Line, LineSolution, LineValue, Standing, Status};
use crate::identify::uncertainty::{Contributions, Uncertainty};
use crate::identify::uncertainty::{KNOWN_RELATIVE_STD, MIN_KNOWN_LOSS_FACTOR};
use crate::identify::unknown::{Unknown, Variation};
use crate::laws::LawKind;
use crate::material::{Law, loss_factor};
use crate::median::median;
use crate::response::relative_error_without;
use crate::roots::Bounds;

/// Points of a profile to either side, and how far they reach in standard deviations.
const PROFILE_POINTS: usize = 5;
const PROFILE_REACH_STD: f64 = 3.0;

/// Where more of the lines than this are not explained, what holds for the band is not either.
const MAX_UNEXPLAINED_SHARE: f64 = 0.5;

/// No material gives energy: a loss factor so many standard deviations below zero, as a median over the band, is that of another model.
const MAX_NEGATIVE_STD: f64 = 3.0;

/// An optimum within the bounds is this near to one of them, in standard deviations, in few cases of a hundred.
const BESIDE_BOUND_STD: f64 = 0.05;

/// Farther than this in logarithms a profile does not go, however little the data show.
const MAX_PROFILE_REACH: f64 = 1.0;

/// How well θ and what it hangs on are known, and what they do to a frequency's own coordinates.
struct Known<'k> {
    /// gᵀ C h at σ.
    covariance: &'k (dyn Fn(&[f64], &[f64]) -> f64 + Sync),
    /// What it consists of, where there are errors of the model.
    split: Option<&'k Split>,
    /// Where unknowns are smooth curves: their covariance with the errors, and what it consists of, `[unknown]`.
    curves: Option<(&'k Estimated, &'k [Option<Split>])>,
    /// ∂y/∂θ, then by the errors of the model, `[coordinate][own]`.
    moved: Vec<Vec<f64>>,
}

impl Task<'_, '_> {
    pub(super) fn judge(
        &self,
        reduced: &Neighbourhoods<'_>,
        found: &BandSolution,
        errors: Option<&Estimated>,
    ) -> Identification {
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        let n = found.theta.len();
        let eliminated = self.eliminated(&all, found, &found.theta, None);
        let place = eliminated.map(|eliminated| Place { theta: found.theta.clone(), eliminated });
        let binding = place.as_ref().map_or(Vec::new(), |place| {
            found.coordinates.binding(&place.theta, &place.eliminated.gradient())
        });
        let own: usize = self.problem.unknowns.iter().map(Unknown::per_frequency).sum();
        let answered = all.iter().filter(|&&i| found.at(i).is_some()).count();
        let sensors = self.problem.experiment.sensors.len() - self.left_out.len();
        let is_smooth = |j: &usize| self.problem.unknowns[*j].varies == Variation::Smooth;
        let smooth: Vec<usize> = (0..self.problem.unknowns.len()).filter(is_smooth).collect();
        let curve_numbers = errors.map_or(0, |errors| smooth.iter().map(|&j| errors.range(j).len()).sum());
        let freedom = (answered * 2 * sensors).saturating_sub(answered * own + n + curve_numbers);
        let chi_squared: f64 = all.iter().filter_map(|&i| Some(found.at(i)?.misfit)).sum();
        let of_sensors = (freedom > 0).then(|| (chi_squared / freedom as f64).sqrt());
        let frfs = self.problem.frfs;
        let of_responses = match frfs.noise {
            Noise::Known(_) | Noise::Common(_) => None,
            _ => of_responses((&self.omegas, frfs.receptance), &self.sigma),
        };
        let noise = NoiseLevel::new(frfs.noise, of_sensors, of_responses);
        let level = noise.level;
        let fit = level
            .and_then(|level| judge(chi_squared / (level * level), freedom, &noise, self.problem.frfs.noise))
            .map(|fit| fit.beside(errors.map_or(0.0, |errors| errors.rest)));
        let of_bars = level_of_bars(level, fit);
        // Of θ, and of the errors of the model that it hangs on.
        let coordinates = |errors: &Estimated| -> Vec<usize> {
            let of_band = found.coordinates.each.iter().flat_map(|own| errors.range(own.unknowns));
            of_band.chain(errors.channels().range()).chain(errors.error_range()).collect()
        };
        let joint = errors.map(|errors| errors.covariance_of(&coordinates(errors)));
        let split = errors.and_then(|errors| errors.split_of(&coordinates(errors)));
        let curve_split = |j: usize| -> Option<Split> {
            let errors = errors.filter(|_| smooth.contains(&j))?;
            errors.split_of(&errors.range(j).chain(errors.error_range()).collect::<Vec<_>>())
        };
        let curve_splits: Vec<Option<Split>> = (0..self.problem.unknowns.len()).map(curve_split).collect();
        let information = match &joint {
            Some(joint) => {
                let size = joint.len().isqrt();
                let of_theta: Vec<f64> =
                    joint.chunks_exact(size.max(1)).take(n).flat_map(|c| &c[..n]).copied().collect();
                Information::from_covariance(&of_theta, n, level.unwrap_or(1.0))
            }
            None => place.as_ref().and_then(|p| Information::new(&p.eliminated.jacobian, n)),
        };
        let covariance = |g: &[f64], h: &[f64]| match (&joint, &information) {
            (Some(joint), _) => {
                let size = joint.len().isqrt();
                let rows = joint.chunks_exact(size.max(1)).zip(g);
                let times = rows.map(|(row, g)| g * row.iter().zip(h).map(|(c, h)| c * h).sum::<f64>());
                times.sum::<f64>() / level.unwrap_or(1.0).powi(2)
            }
            (None, Some(information)) => information.covariance(g, h),
            (None, None) => 0.0,
        };
        let mut lines: Vec<Line> = map(self.context.for_each, all.len(), |i| {
            let own = place.as_ref().and_then(|p| p.eliminated.own[i].as_ref());
            let mut moved = own.map(|(_, moved)| moved.clone());
            if let (Some(moved), Some(solution), Some(_)) = (&mut moved, found.at(i), errors) {
                moved.extend(self.moved_by_errors(reduced, i, found, solution).into_iter().flatten());
            }
            let known = information.as_ref().and(moved);
            self.judge_at(
                reduced,
                found,
                i,
                (level, fit),
                known.map(|moved| Known {
                    covariance: &covariance,
                    split: split.as_ref(),
                    curves: errors.map(|errors| (errors, curve_splits.as_slice())),
                    moved,
                }),
            )
        });
        let numbers_of = |one: &Own| {
            let of = NumberOf::Unknown(one.unknowns);
            names(one.kind()).into_iter().map(move |number| BandCoordinate { of, number })
        };
        let coordinates: Vec<BandCoordinate> = found
            .coordinates
            .each
            .iter()
            .flat_map(numbers_of)
            .chain(found.coordinates.channels.numbers().iter().map(of_channel))
            .collect();
        let channels = found.coordinates.channels.found(&found.theta, |c| {
            let mut gradient = vec![0.0; n];
            gradient[c] = 1.0;
            Some(of_bars? * information.as_ref()?.covariance(&gradient, &gradient).sqrt())
        });
        let (directions, correlation) = match &information {
            Some(information) if n > 0 => (directions(information, of_bars), correlation(information, found)),
            _ => (Vec::new(), Vec::new()),
        };
        let informed = place.as_ref().zip(information.as_ref());
        let profile = directions
            .first()
            .filter(|_| n > 1)
            .and_then(|worst| self.profile(reduced, found, informed?, worst, level?));
        let band = found.coordinates.each.iter().map(|one| {
            let (values, slopes) = one.numbers(&found.theta);
            let std = |row: &[f64]| {
                let gradient = one.gradient(row.iter().copied(), n);
                Some(of_bars? * information.as_ref()?.covariance(&gradient, &gradient).sqrt())
            };
            let numbers: Vec<Number> = names(one.kind())
                .into_iter()
                .zip(values.iter().zip(&slopes))
                .map(|(name, (&value, row))| Number { name, value, std: std(row) })
                .collect();
            let law = match one.kind() {
                Some(kind) => kind.law(&values),
                None => Law::Constant(c64::new(values[0], 0.0)),
            };
            let unknowns = &self.problem.unknowns[one.unknowns];
            let middle = self.problem.frfs.frequency_hz[self.omegas.len() / 2];
            // Constants stop at their bounds, and each of their coordinates is a number; of a law the modulus is compared with them. A number that is not identifiable has no
            // value that could break a bound.
            let stops = |(c, number): (usize, &Number)| {
                let is_beside = errors.is_some() && is_beside_bound(number, &unknowns.bounds);
                (binding.contains(&c) || is_beside)
                    && number.is_identifiable()
                    && !number.is_unknown_loss_factor()
            };
            let at_bound = one.range.clone().zip(&numbers).any(stops)
                || law.at(middle).is_ok_and(|value| unknowns.bounds.broken_by(value).is_some());
            let status = Status::of([
                (answered == 0, Status::NoRoot),
                (!numbers.iter().all(Number::is_identifiable), Status::NotIdentifiable),
                (!found.converged, Status::Failed),
                (at_bound, Status::NoRoot),
            ]);
            BandValue { unknowns: one.unknowns, numbers, law, at_bound, status: status.within(fit) }
        });
        let band: Vec<BandValue> = band.collect();
        let is_unknown = |one: &BandValue| one.status == Status::NotIdentifiable;
        // With a value that stops at its bounds no line has what it needs within them. Where all unknowns hold for the band and none is identifiable, no line has one.
        let instead_of_ok = if band.iter().any(|one| one.at_bound) {
            Status::NoRoot
        } else if band.len() == self.problem.unknowns.len() && band.iter().all(is_unknown) {
            Status::NotIdentifiable
        } else {
            Status::Ok
        };
        lines
            .iter_mut()
            .filter(|line| line.status == Status::Ok)
            .for_each(|line| line.status = instead_of_ok);
        let unexplained = lines.iter().filter(|line| line.status == Status::Unexplained).count();
        let is_other_model = unexplained as f64 > MAX_UNEXPLAINED_SHARE * lines.len() as f64
            || (0..self.problem.unknowns.len()).any(|j| gives_energy(&lines, j));
        let search = SearchReport {
            work: reduced.work(),
            reduced_size: Some(reduced.size()),
            starts: found.starts.len(),
            agreeing: found.agreeing,
            converged: found.converged,
            ..SearchReport::default()
        };
        let outcome = Identification {
            constants: band,
            channels,
            fit,
            identifiability: Identifiability { coordinates, correlation, directions, profile },
            search,
            ..Identification::of_lines(lines, noise)
        };
        if is_other_model { outcome.of_other_model() } else { outcome }
    }

    fn judge_at(
        &self,
        reduced: &Neighbourhoods<'_>,
        found: &BandSolution,
        i: usize,
        (level, fit): (Option<f64>, Option<GoodnessOfFit>),
        known: Option<Known<'_>>,
    ) -> Line {
        let nominal = &self.given[i];
        let values = nominal.iter().map(|&nominal| LineValue::unknown(nominal)).collect();
        let mut line = Line::of_values(self.problem.frfs.frequency_hz[i], values);
        line.nominal_response = reduced.respond(i, nominal).map(|(x, _)| x).unwrap_or_default();
        let solutions = &found.solutions[i];
        let chosen = found.at(i);
        // Of solutions none of which is on the path of every unknown, that of least misfit.
        let Some(solution) = chosen.or_else(|| solutions.first()) else { return line };
        let calibrated = |values: &[c64]| {
            found.coordinates.channels.calibrated(&found.theta, self.problem.frfs.frequency_hz[i], values)
        };
        let measured = &calibrated(&self.problem.frfs.receptance[i]);
        let response = calibrated(&solution.response);
        let values = self.with_bars(found, i, solution, level_of_bars(level, fit), known.as_ref());
        let count = 2 * (measured.len() - self.left_out.len());
        let per_freedom = |misfit: f64| level.map(|level| misfit / (level * level * count as f64));
        let chi_squared = per_freedom(solution.misfit);
        let standing = |k: usize| match found.chosen[i].solution {
            Some(best) if k == best => Standing::Chosen,
            None if k == 0 => Standing::Chosen,
            Some(_) if !found.chosen[i].rivals.contains(&k) => Standing::Excluded,
            _ => Standing::Rival,
        };
        let of_solution = |(k, one): (usize, &Solution)| LineSolution {
            values: one.values.clone(),
            chi_squared: per_freedom(one.misfit),
            standing: standing(k),
        };
        line.solutions = solutions.iter().enumerate().map(of_solution).collect();
        let rivals = line.solutions.iter().filter(|one| one.standing == Standing::Rival);
        line.rivals = rivals.map(|one| one.values.clone()).collect();
        let error = relative_error_without(&self.left_out, measured, &response);
        let assessed = reduced.assess(i, &solution.values);
        let reduction_error =
            assessed.map(|assessed| reduction_error(&assessed, solution.values[0], measured).response);
        let own = |(one, value): (&Unknown, &LineValue)| !one.is_curve() || is_known(value);
        let is_within =
            |(one, value): (&Unknown, &c64)| !one.is_curve() || one.bounds.broken_by(*value).is_none();
        let within = self.problem.unknowns.iter().zip(&solution.values).all(is_within);
        let known = self.problem.unknowns.iter().zip(&values).all(own);
        let unexplained = error > MAX_ERROR && chi_squared.is_none_or(|chi| chi.sqrt() > MAX_RMS_MISFIT);
        line.status = Status::of([
            (unexplained, Status::Unexplained),
            (!line.rivals.is_empty(), Status::Ambiguous),
            (chosen.is_none(), Status::Unexplained),
            (!known, Status::NotIdentifiable),
            (!within, Status::NoRoot),
            (
                reduction_error.is_none_or(|reduction_error| reduction_error > MAX_REDUCTION_ERROR),
                Status::Failed,
            ),
        ])
        .within(fit);
        line.values = values;
        line.on_path = chosen.is_some();
        line.error = Some(error).filter(|error| error.is_finite());
        line.chi_squared = chi_squared;
        line.reduction_error = reduction_error;
        line.updated_response = response;
        line
    }

    /// All values at a frequency with their error bars: of its own coordinates (JᵀJ)⁻¹ + (∂y/∂θ) Cov θ (∂y/∂θ)ᵀ.
    fn with_bars(
        &self,
        found: &BandSolution,
        i: usize,
        solution: &Solution,
        level: Option<f64>,
        known: Option<&Known<'_>>,
    ) -> Vec<LineValue> {
        let problem = self.at_frequency(i);
        let own = problem.covariance(solution);
        let n = found.theta.len();
        // Gradient of one of its own coordinates by θ.
        let gradient = |a: usize| -> Vec<f64> {
            known.map_or(vec![0.0; n], |known| known.moved.iter().map(|of_theta| of_theta[a]).collect())
        };
        let of_theta = |g: &[f64], h: &[f64]| known.map_or(0.0, |known| (known.covariance)(g, h));
        // Over σ².
        let contributed = |g: &[f64]| -> [f64; 3] {
            match known.and_then(|known| known.split).zip(level) {
                Some((split, level)) => split.of(g).map(|variance| variance / (level * level)),
                None => [of_theta(g, g), 0.0, 0.0],
            }
        };
        let mut first = 0;
        let mut one = |(j, unknowns): (usize, &Unknown)| {
            let value = solution.values[j];
            let size = problem.size[j];
            // Covariance of real and imaginary part at σ.
            let mut contributions = None;
            let parts: Option<[f64; 3]> = if unknowns.per_frequency() > 0 {
                let a = first;
                let b = first + unknowns.per_frequency() - 1;
                first = b + 1;
                let both =
                    |a: usize, b: usize| size * size * (own[a][b] + of_theta(&gradient(a), &gradient(b)));
                let [of_theta, model, known_factors] = contributed(&gradient(a));
                contributions = Some([own[a][a] + of_theta, model, known_factors]);
                Some([both(a, a), both(a, b), both(b, b)])
            } else if let (true, Some((errors, splits))) = (unknowns.is_curve(), known.and_then(|k| k.curves))
            {
                let frequency_hz = self.problem.frfs.frequency_hz[i];
                level.and_then(|level| {
                    let over_sigma = |variance: f64| variance / (level * level);
                    let slopes = errors.real_slopes(j, i, frequency_hz)?;
                    let own = &slopes[errors.range(j)];
                    contributions = splits[j].as_ref().map(|split| split.of(own).map(over_sigma));
                    let [re, im, both] = errors.covariance_at(j, i, frequency_hz)?;
                    Some([re, both, im].map(over_sigma))
                })
            } else {
                let own = found.coordinates.each.iter().find(|own| own.unknowns == j);
                own.and_then(|own| {
                    let (_, slopes) = own.value(&found.theta, self.omegas[i])?;
                    let part = |of: fn(&c64) -> f64| own.gradient(slopes.iter().map(of), n);
                    let (re, im) = (part(|s| s.re), part(|s| s.im));
                    known?;
                    contributions = Some(contributed(&re));
                    Some([of_theta(&re, &re), of_theta(&re, &im), of_theta(&im, &im)])
                })
            };
            bars(self.given[i][j], value, unknowns.real, parts.zip(level), contributions)
        };
        self.problem.unknowns.iter().enumerate().map(&mut one).collect()
    }

    /// χ² along a direction of θ, with the identifiable directions at right angles to it at their best.
    fn profile(
        &self,
        reduced: &Neighbourhoods<'_>,
        found: &BandSolution,
        (best, information): (&Place, &Information),
        worst: &Direction,
        level: f64,
    ) -> Option<Profile> {
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        let mut along = vec![0.0; found.theta.len()];
        worst.weights.iter().for_each(|&(c, weight)| along[c] = weight);
        // The worst is the first of the eigenvectors; the identifiable ones of the others are at right angles to it.
        let others = information.identifiable_but_the_first();
        let reach = (PROFILE_REACH_STD * worst.std / PROFILE_POINTS as f64)
            .min(MAX_PROFILE_REACH / PROFILE_POINTS as f64);
        let mut points = Vec::new();
        for side in [-1.0, 1.0] {
            let (mut place, mut rest) = (best.clone(), vec![0.0; others.len()]);
            for k in 1..=PROFILE_POINTS {
                let t = side * k as f64 * reach;
                let origin: Vec<f64> =
                    found.theta.iter().zip(&along).map(|(theta, v)| theta + t * v).collect();
                let plane = Plane { origin: &origin, basis: &others };
                // Models about the point before may show where the minimum is, but not its value.
                let near = self.search_in(reduced, &all, (found, &place), &plane, &rest, Reach::Near);
                let next = near.and_then(|near| {
                    let next = self.moved_to(reduced, &all, (found, &place), plane.at(&near.theta))?;
                    Some((next, near.theta))
                });
                let Some((next, end)) = next else { break };
                points.push((t, (next.eliminated.sum() - best.eliminated.sum()) / (level * level)));
                (place, rest) = (next, end);
            }
        }
        points.push((0.0, 0.0));
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(Profile { points })
    }
}

/// Whether a value that a frequency has of its own is known.
fn is_known(value: &LineValue) -> bool {
    let (Some(found), Some(bars)) = (value.value, value.uncertainty) else { return true };
    let eta = loss_factor(found).abs().max(MIN_KNOWN_LOSS_FACTOR);
    bars.storage_std <= KNOWN_RELATIVE_STD * found.norm()
        && bars.loss_factor_std.is_none_or(|std| std <= KNOWN_RELATIVE_STD * eta)
}

/// Noise over σ in error bars: the residual of a band that is nearly explained makes them longer.
fn level_of_bars(level: Option<f64>, fit: Option<GoodnessOfFit>) -> Option<f64> {
    level.map(|level| level * fit.map_or(1.0, |fit| fit.excess()))
}

/// A value with standard deviations from the covariance of its parts at σ and the level of the noise.
fn bars(
    nominal: c64,
    value: c64,
    real: bool,
    covariance: Option<([f64; 3], f64)>,
    contributions: Option<[f64; 3]>,
) -> LineValue {
    let found =
        LineValue { value: Some(value), correction: Some(value - nominal), ..LineValue::unknown(nominal) };
    let Some(([a, b, c], level)) = covariance else { return found };
    let storage = a.max(0.0).sqrt();
    let eta = loss_factor(value);
    // δη = (δE″ − η δE′)/E′
    let of_eta = (c - 2.0 * eta * b + eta * eta * a).max(0.0).sqrt() / value.re.abs();
    let common = (b - eta * a) / value.re;
    let loss_factor_std = Some(level * of_eta).filter(|std| !real && std.is_finite());
    let uncertainty = Uncertainty {
        correction_std: level * (a + if real { 0.0 } else { c }).max(0.0).sqrt(),
        storage_std: level * storage,
        loss_factor_std,
        correlation: loss_factor_std.map(|_| common / (storage * of_eta)).filter(|c| c.is_finite()),
        contributions: match contributions {
            Some(variances) => Contributions::in_ratio(level * storage, variances),
            None => Contributions::of_noise(level * storage),
        },
        // Linear in θ: how far that holds is for the profile to show.
        nonlinearity: 0.0,
    };
    LineValue { uncertainty: Some(uncertainty), ..found }
}

fn of_channel(number: &ChannelNumber) -> BandCoordinate {
    let name = if number.is_delay { "delay_s" } else { "scale" };
    BandCoordinate { of: NumberOf::Channel(number.channel), number: name.to_owned() }
}

fn names(kind: Option<LawKind>) -> Vec<String> {
    match kind {
        Some(kind) => kind.parameters().into_iter().map(|parameter| parameter.name.into_owned()).collect(),
        None => vec!["value".to_owned()],
    }
}

/// Directions of θ, the least identifiable first.
fn directions(information: &Information, level: Option<f64>) -> Vec<Direction> {
    let n = information.values.len();
    let one = |(v, value): (&[f64], &f64)| {
        let mut weights: Vec<(usize, f64)> = v.iter().copied().enumerate().collect();
        weights.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        // The sense in which the largest weight is positive.
        let sign = weights.first().map_or(1.0, |(_, weight)| weight.signum());
        weights.iter_mut().for_each(|(_, weight)| *weight *= sign);
        Direction { weights, std: level.map_or(f64::INFINITY, |level| level / value.sqrt()) } // 1/0: not identifiable
    };
    information.vectors.chunks_exact(n).zip(&information.values).map(one).collect()
}

fn correlation(information: &Information, found: &BandSolution) -> Vec<Vec<f64>> {
    let n = found.theta.len();
    let of_one = |one: &Own| -> Vec<Vec<f64>> {
        let (_, slopes) = one.numbers(&found.theta);
        slopes.into_iter().map(|row| one.gradient(row, n)).collect()
    };
    let mut gradients: Vec<Vec<f64>> = found.coordinates.each.iter().flat_map(of_one).collect();
    // Of channels each number hangs on its own coordinate alone.
    let first = gradients.len();
    gradients.extend((first..n).map(|c| (0..n).map(|k| if k == c { 1.0 } else { 0.0 }).collect()));
    let entry = |a: usize, b: usize| {
        let of = |a: usize, b: usize| information.covariance(&gradients[a], &gradients[b]);
        of(a, b) / (of(a, a) * of(b, b)).sqrt()
    };
    (0..n).map(|a| (0..n).map(|b| entry(a, b)).collect()).collect()
}

/// Whether an unknown has a negative loss factor over the band.
fn gives_energy(lines: &[Line], unknown: usize) -> bool {
    let over_std = |line: &Line| {
        let value = &line.values[unknown];
        // What is as good as none may be negative by roundoff.
        let std = value.uncertainty?.loss_factor_std?.max(MIN_KNOWN_LOSS_FACTOR);
        Some(loss_factor(value.value?) / std).filter(|ratio| ratio.is_finite())
    };
    median(lines.iter().filter_map(over_std).collect()).is_some_and(|ratio| ratio < -MAX_NEGATIVE_STD)
}

/// Whether a constant is nearer to one of its bounds than a small share of its standard deviation. Errors of the model that were found with a value at its bound
/// leave no slope there that would show it. That a loss factor is next to 0 says nothing.
fn is_beside_bound(number: &Number, bounds: &Bounds) -> bool {
    let bound = match number.name.as_str() {
        "storage" | "value" => bounds.storage,
        "loss_factor" => {
            bounds.loss_factor.map(|[low, high]| [if low > 0.0 { low } else { f64::NEG_INFINITY }, high])
        }
        _ => None,
    };
    bound.zip(number.std).is_some_and(|([low, high], std)| {
        (number.value - low).min(high - number.value) <= BESIDE_BOUND_STD * std
    })
}
