//! Modes of a model beside those of a measurement: which is which.

use super::correlation::assurance;
use crate::c64;
use crate::median::median;
use std::cmp::Ordering;

/// What of a mode is compared.
#[derive(Debug, Clone, PartialEq)]
pub struct PairedShape {
    /// Natural frequency; above zero.
    pub frequency_hz: f64,
    /// Residues at the sensors, in the same order in both sets.
    pub residues: Vec<c64>,
    /// What of its strain energy is in stiffness that may be off by a common factor.
    pub energy_share: f64,
}

/// A mode of the model and one of the measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Which of the model.
    pub model: usize,
    /// Which of the measurement.
    pub measured: usize,
    /// The natural frequency of the model over that of the measurement, less one.
    pub frequency_difference: f64,
    /// The same with the common factor [`Pairing::stiffness_factor`] on the stiffness that may be off.
    pub difference_at_factor: f64,
    /// MAC of their residues; `None` for a single sensor, of which all shapes are proportional.
    pub assurance: Option<f64>,
    /// Whether another pair has the other order: two modes changed places.
    pub is_crossing: bool,
}

/// All pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct Pairing {
    /// In the order of the measurement.
    pub pairs: Vec<Pair>,
    /// The factor on the stiffness that may be off with which the pairs fit best: by Rayleigh's quotient a mode with the share w of its energy
    /// there changes its frequency by the factor to the power of w/2.
    pub stiffness_factor: f64,
}

/// Standard deviations by which modes of one structure differ: the logarithm of the frequency beside a common factor, the logarithm of
/// the size of its residues, and the part of the shape that is another, √(1 − MAC).
pub(crate) const LOG_FREQUENCY_STD: f64 = 0.02;
const LOG_SIZE_STD: f64 = 0.8;
const SHAPE_STD: f64 = 0.25;

/// Modes that differ by more than so many of them are two.
const MAX_DIFFERENCE: f64 = 3.0;

/// Logarithm of what the stiffness may be off by, a factor of four, and the steps in which it is tried.
const MAX_LOG_FACTOR: f64 = 1.4;
const LOG_FACTOR_STEP: f64 = 0.01;

/// Of each pair which of the model and which of the measurement.
type Partners = Vec<(usize, usize)>;

/// Pairs at the factor with which they fit best.
#[derive(Debug, Default)]
pub(crate) struct Best {
    /// By how much they fit better than none.
    pub(crate) gain: f64,
    pub(crate) log_factor: f64,
    pub(crate) pairs: Partners,
}

/// The pairs that together differ least, by frequency, size and shape; a common factor on the stiffness that may be off does not count, nor does
/// the scale of the measurement.
///
/// # Limits
/// Of modes so close that they exchange their shapes with a small change of the structure, either may be the other's partner.
pub fn paired(model: &[PairedShape], measured: &[PairedShape]) -> Pairing {
    let Best { log_factor, mut pairs, .. } = best(model, measured, MAX_LOG_FACTOR);
    pairs.sort_by_key(|&(_, measured)| measured);
    let is_crossing = |&(i, j): &(usize, usize)| {
        let order = |a: f64, b: f64| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
        pairs.iter().any(|&(a, b)| {
            let of_model = order(model[i].frequency_hz, model[a].frequency_hz);
            let of_measured = order(measured[j].frequency_hz, measured[b].frequency_hz);
            of_model == of_measured.reverse() && of_model != Ordering::Equal
        })
    };
    let pair = |own: &(usize, usize)| {
        let (mode, other) = (&model[own.0], &measured[own.1]);
        let ratio = mode.frequency_hz / other.frequency_hz;
        Pair {
            model: own.0,
            measured: own.1,
            frequency_difference: ratio - 1.0,
            difference_at_factor: ratio * (0.5 * mode.energy_share * log_factor).exp() - 1.0,
            assurance: shape_assurance(mode, other),
            is_crossing: is_crossing(own),
        }
    };
    Pairing { pairs: pairs.iter().map(pair).collect(), stiffness_factor: log_factor.exp() }
}

/// The factor with which modes pair best, in a range to either side of one.
pub(crate) fn best(model: &[PairedShape], measured: &[PairedShape], max_log_factor: f64) -> Best {
    let steps = (max_log_factor / LOG_FACTOR_STEP).round() as i32;
    // From none at all outwards: of two that pair as well the smaller change.
    let mut factors: Vec<f64> = (-steps..=steps).map(|k| f64::from(k) * LOG_FACTOR_STEP).collect();
    factors.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let mut best = Best::default();
    for log_factor in factors {
        let (gain, pairs) = with_factor(model, measured, log_factor);
        if gain > best.gain {
            best = Best { gain, log_factor, pairs };
        }
    }
    best
}

/// MAC of several sensors.
fn shape_assurance(a: &PairedShape, b: &PairedShape) -> Option<f64> {
    if a.residues.len() > 1 { assurance(&a.residues, &b.residues) } else { None }
}

/// The pairs with one factor on the stiffness, and what they gain over none.
fn with_factor(model: &[PairedShape], measured: &[PairedShape], log_factor: f64) -> (f64, Partners) {
    let apart = |i: usize, j: usize, log_ratio: Option<f64>| {
        let frequency = (model[i].frequency_hz / measured[j].frequency_hz).ln()
            + 0.5 * model[i].energy_share * log_factor;
        let shape = shape_assurance(&model[i], &measured[j]).map_or(0.0, |mac| (1.0 - mac).max(0.0).sqrt());
        let size = log_ratio.map_or(0.0, |common| log_size(&model[i], &measured[j]) - common);
        (frequency / LOG_FREQUENCY_STD).hypot(shape / SHAPE_STD).hypot(size / LOG_SIZE_STD)
    };
    let count = (model.len(), measured.len());
    // The scale of the residues is that of the pairs that frequencies and shapes make.
    let first = nearest_pairs(count, MAX_DIFFERENCE, |i, j| apart(i, j, None));
    let log_ratio = median(first.iter().map(|&(i, j)| log_size(&model[i], &measured[j])).collect());
    let pairs = nearest_pairs(count, MAX_DIFFERENCE, |i, j| apart(i, j, log_ratio));
    let gain = pairs.iter().map(|&(i, j)| MAX_DIFFERENCE.powi(2) - apart(i, j, log_ratio).powi(2)).sum();
    (gain, pairs)
}

/// ln of the size of the residues of one mode over that of another's.
fn log_size(a: &PairedShape, b: &PairedShape) -> f64 {
    let size = |shape: &PairedShape| shape.residues.iter().map(|r| r.norm_sqr()).sum::<f64>();
    let ratio = 0.5 * (size(a) / size(b)).ln();
    if ratio.is_finite() { ratio } else { 0.0 }
}

/// Of all pairs those that differ least, one after the other, each of either side once, up to the largest difference.
pub(crate) fn nearest_pairs(
    (first, second): (usize, usize),
    most: f64,
    difference: impl Fn(usize, usize) -> f64,
) -> Vec<(usize, usize)> {
    let all = (0..first).flat_map(|i| (0..second).map(move |j| (i, j)));
    let mut near: Vec<(f64, usize, usize)> = all.map(|(i, j)| (difference(i, j), i, j)).collect();
    near.retain(|pair| pair.0 <= most);
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for (_, i, j) in near {
        if pairs.iter().all(|&(a, b)| a != i && b != j) {
            pairs.push((i, j));
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(frequency_hz: f64, residues: [f64; 2]) -> PairedShape {
        PairedShape { frequency_hz, residues: residues.map(|r| c64::new(0.0, r)).to_vec(), energy_share: 1.0 }
    }

    #[test]
    fn a_common_scale_and_a_crossing_are_seen() {
        let model = [shape(100.0, [1.0, 1.0]), shape(200.0, [1.0, -1.0]), shape(204.0, [0.3, 1.0])];
        // A modulus a fifth too soft, another calibration, and the last two in the other order.
        let measured = [shape(110.0, [-2.0, -2.0]), shape(219.0, [-0.6, -2.0]), shape(222.0, [-2.0, 2.0])];
        let found = paired(&model, &measured);
        let which: Vec<_> =
            found.pairs.iter().map(|pair| (pair.model, pair.measured, pair.is_crossing)).collect();
        assert_eq!(which, [(0, 0, false), (2, 1, true), (1, 2, true)]);
        assert!((found.stiffness_factor - 1.21).abs() < 0.05, "{}", found.stiffness_factor);
    }

    #[test]
    fn a_mode_without_a_partner_has_none() {
        let model = [shape(100.0, [1.0, 1.0]), shape(150.0, [1.0, -1.0])];
        let measured = [shape(101.0, [1.0, 1.0]), shape(300.0, [1.0, 0.5])];
        let found = paired(&model, &measured);
        assert_eq!(found.pairs.len(), 1);
        assert_eq!((found.pairs[0].model, found.pairs[0].measured), (0, 0));
    }
}
