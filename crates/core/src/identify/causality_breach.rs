//! Where identified moduli are those of no causal material (B-12).

use super::outcome::{Line, Status};
use super::unknown::Unknown;
use crate::c64;
use crate::frequency::omega_rad_s;
use crate::median::median;
use crate::model::{DynamicStiffness, Role};
use crate::select::{SLOPE_TOLERANCE, slope_of_material};
use std::f64::consts::LN_2;

/// A stretch of the band in which an unknown is the modulus of no causal material: over an octave its storage part falls, or it or its loss part rises faster than
/// the loss allows, by more than the error bars.
///
/// With several sensors that agree, the values stand all the same: what was identified is then no material alone, as a joint whose contact
/// opens or a modulus that stands for a missing part of the model.
///
/// # Limits
/// The local relation 0 ≤ d ln|E|/d ln ω ≤ (2/π) arg E, with a tolerance of 0.1 + 0.4 arg E: it is no proof that a modulus is causal.
/// Bands of less than an octave are not looked at.
///
/// # Source
/// H. C. Booij, G. P. J. M. Thoone, Rheologica Acta 21 (1982) 15–24.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CausalityBreach {
    /// Which of the unknowns.
    pub unknown: usize,
    /// From the first to the last octave's middle, in Hz.
    pub range_hz: [f64; 2],
}

/// Middles of octaves that are looked at, per octave, and the values that one has to have.
const PER_OCTAVE: f64 = 8.0;
const MIN_VALUES: usize = 6;

/// Standard deviations that a slope has to be beyond what is allowed.
const BARS: f64 = 3.0;

/// The local relation misses by this part of the loss in a steep transition.
const TRANSITION_TOLERANCE: f64 = 0.4;

/// One modulus with its place.
struct Value {
    log_omega: f64,
    log: c64,
    std: f64,
}

/// All breaches of all moduli that have a value at each frequency.
pub(super) fn causality_breaches(
    model: &DynamicStiffness,
    unknowns: &[Unknown],
    lines: &[Line],
) -> Vec<CausalityBreach> {
    let is_stiffness = |term: usize| model.terms()[term].role == Role::Stiffness;
    let is_material = |one: &Unknown| one.is_curve() && !one.real && one.dependence.terms().any(is_stiffness);
    let of = |unknown: usize| {
        let values: Vec<Value> = lines.iter().filter_map(|line| value(line, unknown)).collect();
        ranges(&values).into_iter().map(move |range_hz| CausalityBreach { unknown, range_hz })
    };
    (0..unknowns.len()).filter(|&j| is_material(&unknowns[j])).flat_map(of).collect()
}

/// What a line that is trusted has of an unknown.
fn value(line: &Line, unknown: usize) -> Option<Value> {
    let one = line.values.get(unknown).filter(|_| line.status == Status::Ok && line.frequency_hz > 0.0)?;
    let value = one.value.filter(|value| value.re > 0.0)?;
    let std = one.uncertainty.map_or(0.0, |bars| bars.storage_std / value.norm());
    Some(Value { log_omega: omega_rad_s(line.frequency_hz).ln(), log: value.ln(), std })
}

/// Ranges of octaves, by their middles in Hz, in which the slope is no material's.
fn ranges(values: &[Value]) -> Vec<[f64; 2]> {
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    let [Some(first), Some(last)] = [values.first(), values.last()] else { return ranges };
    let (step, half) = (LN_2 / PER_OCTAVE, 0.5 * LN_2);
    let middles = (0u32..).map(|k| first.log_omega + half + f64::from(k) * step);
    let mut goes_on = false;
    for middle in middles.take_while(|middle| middle + half <= last.log_omega) {
        let place = |log_omega: f64| values.partition_point(|one| one.log_omega < log_omega);
        let is_breach = is_breach(&values[place(middle - half)..place(middle + half)]);
        let hz = middle.exp() / omega_rad_s(1.0);
        match ranges.last_mut().filter(|_| goes_on && is_breach) {
            Some(range) => range[1] = hz,
            None if is_breach => ranges.push([hz, hz]),
            None => {}
        }
        goes_on = is_breach;
    }
    ranges
}

/// Whether the straight line through the values of an octave is no material's.
fn is_breach(values: &[Value]) -> bool {
    let n = values.len() as f64;
    let span = values.last().map_or(0.0, |last| last.log_omega - values[0].log_omega);
    if values.len() < MIN_VALUES || span < 0.6 * LN_2 {
        return false;
    }
    let mean_x = values.iter().map(|one| one.log_omega).sum::<f64>() / n;
    let mean = values.iter().map(|one| one.log).sum::<c64>() / n;
    let squares: f64 = values.iter().map(|one| (one.log_omega - mean_x).powi(2)).sum();
    let slope = values.iter().map(|one| (one.log - mean) * (one.log_omega - mean_x)).sum::<c64>() / squares;
    let off = (slope_of_material(mean, slope) - slope).norm();
    // Bars of errors of the model hang together: those of one end may all be up, and those of the other down.
    let usual = median(values.iter().map(|one| one.std).collect()).unwrap_or(0.0);
    let tolerance = SLOPE_TOLERANCE + TRANSITION_TOLERANCE * mean.im.abs();
    off > tolerance + BARS * 2.0 * usual / span
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(modulus: impl Fn(f64) -> c64, std: f64) -> Vec<[f64; 2]> {
        let values: Vec<Value> = (1..=200)
            .map(|k| 10.0 * 200f64.powf(f64::from(k) / 200.0))
            .map(|hz| Value { log_omega: omega_rad_s(hz).ln(), log: modulus(hz).ln(), std })
            .collect();
        ranges(&values)
    }

    #[test]
    fn materials_are_no_breach() {
        for loss_factor in [0.0, 1e-3, 0.1, 1.5] {
            assert!(of(|_| c64::new(2e9, 2e9 * loss_factor), 1e-6).is_empty(), "{loss_factor}");
        }
        for alpha in [0.3, 0.6, 0.95] {
            for peak_hz in [1.0, 300.0, 1e5] {
                let zener = |hz: f64| {
                    let z = c64::new(0.0, hz / peak_hz).powf(alpha);
                    (1.0 + 8.0 * z) / (1.0 + z)
                };
                assert!(of(zener, 1e-6).is_empty(), "{alpha} {peak_hz}");
            }
        }
    }

    #[test]
    fn what_falls_or_jumps_is_a_breach_where_it_does() {
        let falls = |hz: f64| c64::new(1.0, 0.05) * (hz / 100.0).powf(-0.5);
        let [[from, to]] = of(falls, 1e-3)[..] else { panic!("{:?}", of(falls, 1e-3)) };
        assert!(from < 20.0 && to > 1300.0, "{from} {to}");
        let jumps = |hz: f64| c64::new(1.0, if hz < 400.0 { 0.02 } else { 0.2 });
        let [[from, to]] = of(jumps, 1e-3)[..] else { panic!("{:?}", of(jumps, 1e-3)) };
        assert!(from > 200.0 && from < 400.0 && to > 400.0 && to < 800.0, "{from} {to}");
        // Bars that would allow it.
        assert!(of(falls, 0.1).is_empty());
    }

    #[test]
    fn a_band_of_less_than_an_octave_is_not_looked_at() {
        let value = |k: u32| {
            let hz = 100.0 + f64::from(k);
            Value { log_omega: omega_rad_s(hz).ln(), log: c64::new(hz.powf(-2.0), 0.0).ln(), std: 0.0 }
        };
        assert!(ranges(&(0..60).map(value).collect::<Vec<_>>()).is_empty());
        assert!(ranges(&[]).is_empty());
    }
}
