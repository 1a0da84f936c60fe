//! Where to begin: everything constant over the band, and the logarithms of the responses compared.
//!
//! Near resonances a response is a steep function of what is unknown, and the misfit of responses has a valley for each coincidence of a measured with a computed
//! resonance. Logarithms see how far two curves are apart, not only that they are: valleys are wide.

use super::Task;
use super::coordinates::Coordinates;
use super::neighbourhoods::{Neighbourhoods, in_box};
use super::search::{Begin, Guess};
use crate::c64;
use crate::for_each::map;
use crate::identify::band::by_shape;
use crate::identify::channel::{Channel, ChannelUnknowns};
use crate::identify::unknown::Variation;
use crate::least_squares::{Search, minimise};
use crate::thinned::thinned;

/// Frequencies that say which points of the box are compared where logarithms are.
const RANKING_FREQUENCIES: usize = 40;

/// Error of the responses whose logarithms are compared: valleys are far wider.
const LOG_RESPONSE_TOL: f64 = 1e-2;

/// Points of the box for each number, how many of the best are compared at all frequencies, and how many of the best of these are followed.
const POINTS_PER_NUMBER: usize = 24;
const COMPARED_POINTS: usize = 24;
const FOLLOWED_POINTS: usize = 8;

/// Evaluations for each start and number.
const EVALUATIONS_PER_START_AND_NUMBER: usize = 12;

/// Weight of a coordinate's way from the nominal one, beside logarithms of responses: a millionth of what an identifiable coordinate moves.
const NOMINAL_WEIGHT: f64 = 1e-3;

/// Ends that are kept: later steps show which is right.
const MAX_KEPT_ENDS: usize = 4;

impl Task<'_, '_> {
    /// Values of all unknowns, constant over the band, the likeliest first, by so many frequencies at most.
    pub(super) fn starts(&self, reduced: &Neighbourhoods<'_>, most: usize) -> Vec<Vec<c64>> {
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        let which: Vec<usize> = thinned(&all, most).copied().collect();
        let rough = map(self.context.for_each, which.len(), |k| reduced.rough(which[k], LOG_RESPONSE_TOL));
        let middle = &self.nominal[all.len() / 2];
        let constants = Coordinates::new(self.problem.unknowns, |_| Variation::Constant, middle, self.seen());
        let of = |values: &[c64]| constants.of(values, |_, _| Vec::new());
        let points =
            (1..=POINTS_PER_NUMBER * constants.count).map(|k| of(&in_box(&reduced.composite, middle, k)));
        let begin: Vec<Vec<f64>> = std::iter::once(of(middle)).chain(points).collect();
        let evaluate = |theta: &[f64], lines: &[usize]| {
            let one = |k: usize| {
                let (k, i) = (lines[k], which[lines[k]]);
                let own = constants.each.iter().map(|own| own.value(theta, self.omegas[i]));
                let (values, slopes): (Vec<c64>, Vec<Vec<c64>>) =
                    own.collect::<Option<Vec<_>>>()?.into_iter().unzip();
                let (x, of_values) = reduced.respond_on(&rough[k], i, &values)?;
                let u = &self.problem.frfs.receptance[i];
                // A zero has no logarithm, and a sensor that is left out no say.
                let kept: Vec<usize> =
                    (0..u.len()).filter(|&m| self.sigma[i][m].is_finite() && u[m].norm() > 0.0).collect();
                let rest: Vec<c64> = kept.iter().map(|&m| self.ln_ratio(m, x[m] / u[m])).collect();
                let column = |(j, slope): (usize, c64)| -> Vec<c64> {
                    kept.iter().map(|&m| self.of_known_phase(m, of_values[j][m] * slope / x[m])).collect()
                };
                let all =
                    slopes.iter().enumerate().flat_map(|(j, own)| own.iter().map(move |&slope| (j, slope)));
                Some(Row { columns: std::iter::once(rest).chain(all.map(column)).collect(), kept })
            };
            let rows =
                map(self.context.for_each, lines.len(), one).into_iter().collect::<Option<Vec<_>>>()?;
            let rows = self.without_scales(rows);
            let parts = |values: &[c64]| values.iter().flat_map(|v| [v.re, v.im]).collect::<Vec<f64>>();
            let count = constants.count;
            // A direction that is not identifiable stays where it was.
            let stay = theta.iter().zip(&begin[0]).map(|(t, t0)| NOMINAL_WEIGHT * (t - t0));
            let residuals: Vec<f64> =
                rows.iter().flat_map(|row| parts(&row.columns[0])).chain(stay).collect();
            let jacobian: Vec<f64> = (0..count)
                .flat_map(|c| {
                    let measured = rows.iter().flat_map(move |row| parts(&row.columns[1 + c]));
                    measured.chain((0..count).map(move |other| if other == c { NOMINAL_WEIGHT } else { 0.0 }))
                })
                .collect();
            let finite = residuals.iter().chain(&jacobian).all(|value| value.is_finite());
            finite.then_some((residuals, jacobian))
        };
        let search =
            Search { starts: FOLLOWED_POINTS, patience: EVALUATIONS_PER_START_AND_NUMBER, same: 0.0 };
        let lines: Vec<usize> = (0..which.len()).collect();
        let few: Vec<usize> = thinned(&lines, RANKING_FREQUENCIES).copied().collect();
        let sum = |theta: &Vec<f64>| Some(evaluate(theta, &few)?.0.iter().map(|r| r * r).sum::<f64>());
        let mut ranked: Vec<(f64, Vec<f64>)> =
            begin.iter().filter_map(|theta| Some((sum(theta)?, theta.clone()))).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let compared: Vec<Vec<f64>> =
            ranked.into_iter().take(COMPARED_POINTS).map(|(_, theta)| theta).collect();
        let Some(minima) = minimise(&compared, &|theta| evaluate(theta, &lines), &search) else {
            return vec![middle.clone()];
        };
        let ends = std::iter::once(&minima.best).chain(&minima.others).take(MAX_KEPT_ENDS);
        let values = |theta: &[f64]| {
            let own = constants.each.iter().map(|own| Some(own.value(theta, self.omegas[all.len() / 2])?.0));
            own.collect::<Option<Vec<c64>>>()
        };
        ends.filter_map(|end| values(&end.theta)).collect()
    }

    /// θ that begins with these constants, and channels that begin where most ratios of the responses to what was measured agree: the responses of these constants, or of what the
    /// calibrated channels alone give where they are enough for it.
    pub(super) fn begin(&self, reduced: &Neighbourhoods<'_>, which: &[usize], values: &[c64]) -> Begin {
        let coordinates = self.coordinates();
        let theta = self.theta(&coordinates, values);
        let mut begin = Begin { coordinates, theta };
        if begin.coordinates.channels.count() == 0 {
            return begin;
        }
        let responses: Vec<Option<Vec<c64>>> = match self.of_calibrated_channels() {
            Some(task) => {
                let found = task.follow(reduced, which, begin.clone(), &Guess::Everywhere(values));
                begin.theta.clone_from(&found.theta);
                (0..which.len())
                    .map(|k| Some(found.at(k).or(found.solutions[k].first())?.response.clone()))
                    .collect()
            }
            None => {
                let respond = |&i: &usize| {
                    let (values, _) = self.given(&begin.coordinates, &begin.theta, i, values)?;
                    Some(reduced.respond(i, &values)?.0)
                };
                which.iter().map(respond).collect()
            }
        };
        let channels = self.matching(which, &responses, begin.coordinates.channels.top_rad_s());
        begin.coordinates.channels.begin_at(&channels, &mut begin.theta);
        begin
    }

    /// The calibration of each channel with which these responses are what was measured.
    fn matching(&self, which: &[usize], responses: &[Option<Vec<c64>>], top_rad_s: f64) -> Vec<Channel> {
        let one = |(m, &unknown)| {
            let ratio = |(&i, x): (&usize, &Option<Vec<c64>>)| {
                Some((self.omegas[i], x.as_ref()?[m] / self.problem.frfs.receptance[i][m]))
            };
            let ratios: Vec<(f64, c64)> = which.iter().zip(responses).filter_map(ratio).collect();
            by_shape(&ratios, unknown, top_rad_s).unwrap_or(Channel::CALIBRATED)
        };
        self.problem.channels.iter().enumerate().map(one).collect()
    }

    /// The same task of the calibrated channels alone; `None` where they measure fewer numbers at a frequency than it has of its own.
    fn of_calibrated_channels(&self) -> Option<Self> {
        let is_free = |m: &usize| self.problem.channels.get(*m).is_some_and(|channel| channel.any());
        let sensors = self.problem.experiment.sensors.len();
        let out: Vec<usize> = (0..sensors).filter(|m| self.left_out.contains(m) || is_free(m)).collect();
        let left = sensors - out.len();
        (left > 0 && 2 * left >= self.own()).then(|| self.leaving_out(&out))
    }

    /// ln(x/u) as far as the channel lets it be known: where its scale is unknown the sense is too, and where its delay is unknown the phase.
    fn ln_ratio(&self, m: usize, ratio: c64) -> c64 {
        let unknown = self.channel(m);
        self.of_known_phase(m, if unknown.scale { 0.5 * (ratio * ratio).ln() } else { ratio.ln() })
    }

    /// Without the imaginary part where the delay is unknown.
    fn of_known_phase(&self, m: usize, ln: c64) -> c64 {
        if self.channel(m).delay { c64::new(ln.re, 0.0) } else { ln }
    }

    /// Logarithms without what unknown scales add to them: their mean over the band.
    fn without_scales(&self, mut rows: Vec<Row>) -> Vec<Row> {
        let columns = rows.first().map_or(0, |row| row.columns.len());
        for (m, _) in self.problem.channels.iter().enumerate().filter(|(_, channel)| channel.scale) {
            for c in 0..columns {
                let mut logs: Vec<&mut c64> = rows.iter_mut().filter_map(|row| row.at(m, c)).collect();
                let mean = logs.iter().map(|ln| ln.re).sum::<f64>() / logs.len().max(1) as f64;
                logs.iter_mut().for_each(|ln| ln.re -= mean);
            }
        }
        rows
    }

    fn channel(&self, m: usize) -> ChannelUnknowns {
        self.problem.channels.get(m).copied().unwrap_or_default()
    }
}

/// The logarithms of one frequency.
struct Row {
    /// Residuals, then their slopes by each coordinate, of the sensors that are kept.
    columns: Vec<Vec<c64>>,
    kept: Vec<usize>,
}

impl Row {
    fn at(&mut self, sensor: usize, column: usize) -> Option<&mut c64> {
        let k = self.kept.iter().position(|&m| m == sensor)?;
        Some(&mut self.columns[column][k])
    }
}
