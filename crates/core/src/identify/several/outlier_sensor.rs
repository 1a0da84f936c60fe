//! A sensor that contradicts the others: all unknowns are found without each in turn.

use super::Task;
use super::neighbourhoods::Neighbourhoods;
use super::search::BandSolution;
use crate::frfs::Noise;
use crate::identify::band::{OUTLIER_FREQUENCIES, OUTLIER_RATIO};
use crate::identify::dead_channel::dead_channels;
use crate::identify::goodness_of_fit::SensorFit;
use crate::identify::identification::Identification;
use crate::identify::noise::{level_of, without};
use crate::identify::outcome::Line;
use crate::identify::unknown::Unknown;
use crate::thinned::thinned;

/// Where no standard deviation is given: one per cent of the response is usual noise, and no reason to doubt a sensor.
const USUAL_NOISE_OVER_RESPONSE: f64 = 1e-2;

/// Frequencies at most by which a trial finds its starts.
const START_FREQUENCIES: usize = 2 * OUTLIER_FREQUENCIES;

/// Sensors that are left out by way of trial, the worst first, before any other is.
const FIRST_TRIALS: usize = 2;

impl Task<'_, '_> {
    /// The sensors that contradict the others, worst first. Of two sensors nothing shows which one is wrong.
    ///
    /// Each trial leaves out one sensor and searches again on a few frequencies. No sensor is tried where the result explains the sensors. The sensors that fit worst are left out
    /// first, and the others only if that makes χ² far smaller.
    pub(super) fn contradicting(&self, reduced: &mut Neighbourhoods<'_>, found: &BandSolution) -> Vec<usize> {
        let sensors = self.problem.experiment.sensors.len();
        let floor = self.usual_chi_squared();
        let mut with_all = self.chi_squared_of(found);
        let mut out: Vec<usize> = self.left_out.clone();
        let for_each = self.context.for_each;
        while with_all > OUTLIER_RATIO * floor && self.is_determined(sensors - out.len()) {
            reduced.widen(for_each);
            let tried = |m: usize| (self.chi_squared_without(&*reduced, &[&out[..], &[m]].concat()), m);
            let mut left = self.worst_first(found);
            left.retain(|m| !out.contains(m) && self.is_calibrated_without(&[&out[..], &[*m]].concat()));
            let others = left.split_off(left.len().min(FIRST_TRIALS));
            let mut trials: Vec<(f64, usize)> = left.into_iter().map(tried).collect();
            if trials.iter().all(|(without, _)| OUTLIER_RATIO * without.max(floor) >= with_all) {
                break;
            }
            trials.extend(others.into_iter().map(tried));
            trials.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (Some(&(least, worst)), second) = (trials.first(), trials.get(1)) else { break };
            if OUTLIER_RATIO * least.max(floor) >= second.map_or(with_all, |second| with_all.min(second.0)) {
                break;
            }
            out.push(worst);
            with_all = least;
        }
        reduced.narrow(found.answers(), for_each);
        out.split_off(self.left_out.len())
    }

    /// The sensors, the one that fits worst first.
    fn worst_first(&self, found: &BandSolution) -> Vec<usize> {
        let misfit = |m: usize| {
            let of_line =
                |k: usize| Some(found.at(k)?.residuals[2 * m..2 * m + 2].iter().map(|r| r * r).sum::<f64>());
            (0..self.omegas.len()).filter_map(of_line).sum::<f64>()
        };
        let mut all: Vec<(f64, usize)> =
            (0..self.problem.experiment.sensors.len()).map(|m| (misfit(m), m)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.into_iter().map(|(_, m)| m).collect()
    }

    /// Whether more is left than noise.
    pub(super) fn is_unexplained(&self, found: &BandSolution) -> bool {
        self.chi_squared_of(found) > OUTLIER_RATIO * self.usual_chi_squared()
    }

    /// χ² of usual noise.
    fn usual_chi_squared(&self) -> f64 {
        match self.problem.frfs.noise {
            Noise::Known(_) | Noise::Common(_) => 1.0,
            Noise::Unknown | Noise::Floor(_) | Noise::Relative(_) => {
                USUAL_NOISE_OVER_RESPONSE * USUAL_NOISE_OVER_RESPONSE
            }
        }
    }

    /// χ² over its usual size at all frequencies that were looked at.
    fn chi_squared_of(&self, found: &BandSolution) -> f64 {
        let misfit = |k: usize| found.at(k).map_or(f64::INFINITY, |solution| solution.misfit);
        let all = (0..found.solutions.len()).map(misfit).collect();
        self.chi_squared(all, self.problem.experiment.sensors.len())
    }

    /// Whether two sensors and more are left without one of so many, with more numbers at a frequency than it has of its own.
    fn is_determined(&self, sensors: usize) -> bool {
        sensors > 2 && 2 * (sensors - 1) > self.own()
    }

    /// Whether a calibrated channel is left without some, if there is any: the reference of sizes is never left out.
    fn is_calibrated_without(&self, out: &[usize]) -> bool {
        let is_calibrated = |m: &usize| self.problem.channels.get(*m).is_none_or(|channel| !channel.any());
        let mut calibrated = (0..self.problem.experiment.sensors.len()).filter(is_calibrated).peekable();
        calibrated.peek().is_none() || calibrated.any(|m| !out.contains(&m))
    }

    /// Real numbers that a frequency has of its own.
    pub(super) fn own(&self) -> usize {
        self.problem.unknowns.iter().map(Unknown::per_frequency).sum()
    }

    /// χ² over its usual size at some frequencies, of so many sensors.
    fn chi_squared(&self, misfits: Vec<f64>, sensors: usize) -> f64 {
        level_of(misfits, (2 * sensors).saturating_sub(self.own())).map_or(0.0, |level| level * level)
    }

    fn chi_squared_without(&self, reduced: &Neighbourhoods<'_>, out: &[usize]) -> f64 {
        let task = self.leaving_out(out);
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        let which: Vec<usize> = thinned(&all, OUTLIER_FREQUENCIES).copied().collect();
        let tried = task.tried(reduced, &which, START_FREQUENCIES);
        let best = &tried[0].1;
        let misfit = |k: usize| best.at(k).or(best.solutions[k].first()).map_or(f64::INFINITY, |s| s.misfit);
        let sensors = self.problem.experiment.sensors.len() - out.len();
        self.chi_squared((0..which.len()).map(misfit).collect(), sensors)
    }

    /// The same task, in which some more sensors count for nothing.
    pub(super) fn leaving_out(&self, out: &[usize]) -> Self {
        Self {
            omegas: self.omegas.clone(),
            sigma: without(&self.sigma, out),
            left_out: out.to_vec(),
            ..*self
        }
    }

    /// How each sensor fits: root mean square of its misfit over its assumed standard deviation and the level of the noise.
    pub(super) fn sensor_fits(
        &self,
        assumed: &[Vec<f64>],
        contradicting: &[usize],
        outcome: &Identification,
    ) -> Vec<SensorFit> {
        let level = outcome.noise.level;
        let dead = dead_channels(self.problem.frfs.receptance);
        let one = |m: usize| {
            let channel = outcome.channels.get(m).copied().unwrap_or_default();
            let square = |(i, line): (usize, &Line)| {
                let shown = line.updated_response.get(m)? / channel.factor(line.frequency_hz);
                let off = (self.problem.frfs.receptance[i][m] - shown).norm_sqr();
                Some(off / (2.0 * (level? * assumed[i][m]).powi(2))).filter(|square| square.is_finite())
            };
            let squares: Vec<f64> = outcome.lines.iter().enumerate().filter_map(square).collect();
            let misfit = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            SensorFit {
                misfit: Some(misfit).filter(|misfit| misfit.is_finite()),
                contradicts: contradicting.contains(&m),
                dead: dead.contains(&m),
                left_out: self.left_out.contains(&m),
            }
        };
        (0..self.problem.experiment.sensors.len()).map(one).collect()
    }
}
