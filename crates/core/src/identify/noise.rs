//! How large the noise is: as given, or as the band shows it.

use crate::c64;
use crate::frequency::omega_rad_s;
use crate::frfs::{Noise, NoiseFloor};
use crate::median::median;
use crate::select::{Choice, Node};
use crate::thinned::thinned;

/// The least level that is believed of one that is not given: a millionth of the response is roundoff near a resonance.
pub(super) const MIN_NOISE_LEVEL: f64 = 1e-6;

/// Of independent noise the scatter of n answers is the misfit of the sensors, with a relative standard deviation of 1/√n at most. They have noise in common from so many of
/// these on.
const SCATTER_DEVIATIONS: f64 = 3.0;

/// Answers with two neighbours on either side that a scatter is estimated from: with fewer, a median is an accident.
const MIN_SCATTER_ANSWERS: usize = 12;

/// Where the level of the noise is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoiseSource {
    /// Standard deviations that were given.
    Given,
    /// How well one factor explains several sensors.
    Sensors,
    /// How far the answers, or of several unknowns the responses themselves, lie off a smooth curve over frequency.
    Scatter,
    /// What a smooth curve leaves, of the sensors and over frequency.
    Curve,
    /// Nothing: too few sensors, and too few answers side by side.
    Nothing,
}

impl NoiseSource {
    /// The word that summaries use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Sensors => "sensors",
            Self::Scatter => "scatter",
            Self::Curve => "curve",
            Self::Nothing => "unknown",
        }
    }
}

/// The noise over the assumed standard deviations: those that were given, or where none were, the responses themselves (a tenth of their median at
/// least, or with the floor that they show), for real and imaginary part each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseLevel {
    /// What the error bars are made with; `None` where it is not known.
    pub level: Option<f64>,
    /// Where it is known from.
    pub source: NoiseSource,
    /// What the misfit of several sensors says; `None` for one, which everything explains.
    pub of_sensors: Option<f64>,
    /// What the scatter of the answers over frequency says, or of several unknowns that of the responses about local rational functions.
    pub of_scatter: Option<f64>,
    /// The floor that the assumed standard deviations have, where the responses show one.
    pub floor: Option<NoiseFloor>,
    /// The correlation of two sensors' noise over their responses, where the responses show one: it is in the assumed standard deviations.
    pub correlation: Option<f64>,
    /// The scatter of the answers where the sensors have noise in common, which they do not show.
    pub common: Option<f64>,
}

impl NoiseLevel {
    pub(super) fn new(noise: Noise<'_>, of_sensors: Option<f64>, of_scatter: Option<f64>) -> Self {
        let (level, source) = match (noise, of_sensors, of_scatter) {
            (Noise::Known(_) | Noise::Common(_), ..) => (Some(1.0), NoiseSource::Given),
            (_, Some(level), _) => (Some(level.max(MIN_NOISE_LEVEL)), NoiseSource::Sensors),
            (_, None, Some(level)) => (Some(level.max(MIN_NOISE_LEVEL)), NoiseSource::Scatter),
            (_, None, None) => (None, NoiseSource::Nothing),
        };
        let floor = match noise {
            Noise::Floor(floor) => Some(floor),
            _ => None,
        };
        let correlation = match noise {
            Noise::Common(common) => Some(common.correlation),
            _ => None,
        };
        Self { level, source, of_sensors, of_scatter, floor, correlation, common: None }
    }

    /// With the scatter of so many answers where it is more than sensors say that are independent: noise of the force, and leakage, change all of them by the same factor,
    /// and a factor explains that.
    pub(super) fn with_common(self, answers: usize) -> Self {
        let least = 1.0 + SCATTER_DEVIATIONS / (answers.max(1) as f64).sqrt();
        match (self.of_sensors, self.of_scatter) {
            (Some(sensors), Some(scatter))
                if self.source != NoiseSource::Given && scatter > (least * sensors).max(MIN_NOISE_LEVEL) =>
            {
                Self { level: Some(scatter), source: NoiseSource::Scatter, common: Some(scatter), ..self }
            }
            _ => self,
        }
    }

    /// Nothing known, as where each frequency is answered alone.
    pub(super) const UNKNOWN: Self = Self {
        level: None,
        source: NoiseSource::Nothing,
        of_sensors: None,
        of_scatter: None,
        floor: None,
        correlation: None,
        common: None,
    };
}

/// Half the width of the neighbourhood that has the level of a response, in ln ω: a third of an octave in all.
const LEVEL_HALF_WIDTH: f64 = std::f64::consts::LN_2 / 6.0;

/// Lines of a neighbourhood that are looked at, at most.
const MAX_LEVEL_LINES: usize = 41;

/// The level of each response, `[frequency][sensor]`: itself, or the median of its neighbourhood where that is larger. Near an antiresonance what modes add up to is small, and what
/// is wrong with each is not.
pub(super) fn levels(measured: &[Vec<c64>], frequency_hz: &[f64]) -> Vec<Vec<f64>> {
    let of = |i: usize| {
        let from = frequency_hz.partition_point(|&f| f < frequency_hz[i] * (-LEVEL_HALF_WIDTH).exp());
        let to = frequency_hz.partition_point(|&f| f <= frequency_hz[i] * LEVEL_HALF_WIDTH.exp());
        let near: Vec<usize> = (from..to).collect();
        let level = |m: usize| {
            let near = thinned(&near, MAX_LEVEL_LINES).map(|&k| measured[k][m].norm());
            median(near.collect()).unwrap_or(0.0).max(measured[i][m].norm())
        };
        (0..measured[i].len()).map(level).collect()
    };
    (0..measured.len()).map(of).collect()
}

/// The standard deviations with what the response has beside the noise: this part of its level, for real and imaginary part each.
pub(super) fn beside(sigma: &[Vec<f64>], rest: f64, levels: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let wider = |(row, levels): (&Vec<f64>, &Vec<f64>)| {
        row.iter().zip(levels).map(|(sigma, level)| sigma.hypot(rest * level)).collect()
    };
    sigma.iter().zip(levels).map(wider).collect()
}

/// The standard deviations with those of some sensors infinite: nothing is asked of them.
pub(super) fn without(sigma: &[Vec<f64>], out: &[usize]) -> Vec<Vec<f64>> {
    let mut sigma = sigma.to_vec();
    sigma.iter_mut().for_each(|row| out.iter().for_each(|&m| row[m] = f64::INFINITY));
    sigma
}

/// Degrees of freedom that χ² of so many sensors has once the factor is fitted to them.
pub(super) fn freedom(sensors: usize, real: bool) -> usize {
    (2 * sensors).saturating_sub(if real { 1 } else { 2 })
}

/// Noise over σ by the median of the χ² that some frequencies have; `None` without a degree of freedom, or a frequency.
pub(super) fn level_of(misfits: Vec<f64>, freedom: usize) -> Option<f64> {
    let median = median(misfits).filter(|_| freedom > 0)?;
    Some((median / median_chi_squared(freedom)).sqrt())
}

/// Noise over σ from how well the chosen solutions explain the sensors, and where none is chosen the best ones.
pub(super) fn of_sensors(nodes: &[Vec<Node>], choices: &[Choice], freedom: usize) -> Option<f64> {
    let misfit = |(nodes, choice): (&Vec<Node>, &Choice)| match choice.chosen {
        Some(k) => Some(nodes[k].misfit),
        None => nodes.iter().map(|node| node.misfit).min_by(f64::total_cmp),
    };
    level_of(nodes.iter().zip(choices).filter_map(misfit).collect(), freedom)
}

/// Noise over σ from how far each answer lies off the cubic through its four neighbours in ln E over ln ω; `std` is that of real and
/// imaginary part each under σ. A law of materials is smooth on the scale of neighbouring frequencies; where it is not, this is too large.
pub(super) fn of_scatter(frequency_hz: &[f64], answers: &[Option<Node>], real: bool) -> Option<f64> {
    let square = |k: usize| {
        let mut nodes = [None; 5];
        for (node, estimate) in nodes.iter_mut().zip(&answers[k - 2..=k + 2]) {
            *node = Some((*estimate)?);
        }
        let x: Vec<f64> = frequency_hz[k - 2..=k + 2].iter().map(|&f| omega_rad_s(f).ln()).collect();
        let (mut off, mut variance) = (c64::default(), 0.0);
        for (j, Node { factor, std, .. }) in nodes.into_iter().flatten().enumerate() {
            let others = (0..5).filter(|&i| i != 2 && i != j);
            let weight =
                if j == 2 { 1.0 } else { -others.map(|i| (x[2] - x[i]) / (x[j] - x[i])).product::<f64>() };
            off += weight * factor.ln();
            variance += (weight * std / factor.norm()).powi(2);
        }
        let off = if real { c64::new(off.re, 0.0) } else { off };
        Some(off.norm_sqr() / variance).filter(|square| square.is_finite())
    };
    let squares: Vec<f64> = (2..answers.len().saturating_sub(2)).filter_map(square).collect();
    if squares.len() < MIN_SCATTER_ANSWERS {
        return None;
    }
    level_of(squares, if real { 1 } else { 2 })
}

/// Median of χ².
///
/// # Source
/// E. B. Wilson, M. M. Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684–688.
fn median_chi_squared(freedom: usize) -> f64 {
    let freedom = freedom as f64;
    freedom * (1.0 - 2.0 / (9.0 * freedom)).powi(3)
}
