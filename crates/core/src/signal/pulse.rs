//! Contacts of the hammer, and what only looks like one.

use super::baseline::{peak, quiet};
use std::ops::Range;

/// A contact: the samples from the first at or above a level to the last, before the force falls below half the level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pulse {
    pub(super) first: usize,
    pub(super) last: usize,
    /// Where the force is largest.
    pub(super) at: usize,
    /// The largest force above its offset, positive whatever the sensor's polarity.
    pub(super) peak: f64,
}

/// A force channel with its offset removed, its impacts positive, and its spikes bridged.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contact {
    pub(super) force: Vec<f64>,
    /// Standard deviation where nothing happens.
    pub(super) noise: f64,
    /// Where spikes were, and how high.
    pub(super) spikes: Vec<(Range<usize>, f64)>,
}

/// Longest spike in samples: a glitch of a converter or a plug; a contact of that length cannot be sampled anyway.
const MAX_SPIKE_SAMPLES: usize = 5;

/// Most spikes that are bridged in one recording; one with more is beyond help.
const MAX_SPIKES: usize = 8;

/// A spike is higher than the pulse it sits on by this factor at least: pulses, even of few samples, lose less than that without
/// their upper half.
const MIN_SPIKE_RATIO: f64 = 3.0;

/// Higher by this factor, whatever it sits on: the samples beside a contact of a single sample have a fifth of it behind a filter.
const CERTAIN_SPIKE_RATIO: f64 = 10.0;

impl Contact {
    pub(super) fn new(samples: &[f64]) -> Self {
        let (offset, noise) = quiet(samples);
        let mut force: Vec<f64> = samples.iter().map(|x| x - offset).collect();
        let mut spikes = Vec::new();
        while let Some((range, height)) = spike(&force).filter(|_| spikes.len() < MAX_SPIKES) {
            bridge(&mut force, range.clone());
            spikes.push((range, height));
        }
        let largest = force.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
        if largest < 0.0 {
            force.iter_mut().for_each(|x| *x = -*x);
        }
        Self { force, noise, spikes }
    }

    /// The contacts in a range of samples, at or above a level.
    pub(super) fn pulses(&self, range: Range<usize>, level: f64) -> Vec<Pulse> {
        let mut pulses: Vec<Pulse> = Vec::new();
        let mut open = false;
        for k in range {
            let x = self.force[k];
            match pulses.last_mut().filter(|_| open) {
                Some(pulse) if x >= level => {
                    pulse.last = k;
                    if x > pulse.peak {
                        (pulse.at, pulse.peak) = (k, x);
                    }
                }
                Some(_) => open = x >= level / 2.0,
                None if x >= level => {
                    pulses.push(Pulse { first: k, last: k, at: k, peak: x });
                    open = true;
                }
                None => {}
            }
        }
        pulses
    }

    /// Samples around the peak that reach half of it.
    pub(super) fn width(&self, pulse: &Pulse) -> usize {
        above(&self.force, pulse.at, pulse.peak / 2.0).len()
    }

    pub(super) fn largest(&self) -> f64 {
        peak(&self.force, 0.0)
    }
}

/// The samples around one that reach a level in the direction of that one.
fn above(force: &[f64], at: usize, level: f64) -> Range<usize> {
    let sign = force[at].signum();
    let reaches = |x: &&f64| sign * **x >= level;
    let before = force[..at].iter().rev().take_while(reaches).count();
    let after = force[at..].iter().take_while(reaches).count();
    at - before..at + after
}

/// The largest deflection, where it is a spike: a few samples far above a pulse that goes on below them, or far narrower than a
/// pulse elsewhere.
fn spike(force: &[f64]) -> Option<(Range<usize>, f64)> {
    let at = (0..force.len()).max_by(|&a, &b| force[a].abs().total_cmp(&force[b].abs()))?;
    let height = force[at].abs();
    let run = above(force, at, height / 2.0);
    if height == 0.0 || run.len() > MAX_SPIKE_SAMPLES {
        return None;
    }
    let margin = 3 * MAX_SPIKE_SAMPLES;
    let left = &force[run.start.saturating_sub(margin)..run.start];
    let right = &force[run.end..force.len().min(run.end + margin)];
    let below = left.iter().chain(right).map(|x| x.abs()).fold(0.0, f64::max);
    let shoulder = |x: &&f64| x.abs() >= below / 2.0;
    let shoulders =
        [left.iter().rev().take_while(shoulder).count(), right.iter().take_while(shoulder).count()];
    // A short pulse has one sample on either shoulder, and they are not that low; what a spike sits on has more, or is far lower.
    let [left, right] = shoulders;
    let on_a_pulse = height >= MIN_SPIKE_RATIO * below && left + right >= 3 && left.max(right) >= 2
        || height >= CERTAIN_SPIKE_RATIO * below && left.min(right) >= 1;
    let on_a_pulse = on_a_pulse && below > 0.0;
    let largest_in = |range: Range<usize>| range.max_by(|&a, &b| force[a].abs().total_cmp(&force[b].abs()));
    let others = [
        largest_in(0..run.start.saturating_sub(margin)),
        largest_in((run.end + margin).min(force.len())..force.len()),
    ];
    let narrower = others.into_iter().flatten().any(|other| {
        let size = force[other].abs();
        size >= height / 100.0 && above(force, other, size / 2.0).len() > 2 * run.len() + 1
    });
    let stands_out = height >= MIN_SPIKE_RATIO * below;
    (on_a_pulse || stands_out && narrower).then_some((run, height))
}

/// A straight line over the samples of a range.
fn bridge(force: &mut [f64], range: Range<usize>) {
    let from = range.start.checked_sub(1).map_or(0.0, |k| force[k]);
    let to = force.get(range.end).copied().unwrap_or(0.0);
    let steps = (range.len() + 1) as f64;
    for (i, k) in (1..).zip(range) {
        force[k] = from + (to - from) * f64::from(i) / steps;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A half-sine of `n` samples from sample `at` on, in silence.
    fn half_sine(len: usize, at: usize, n: usize, peak: f64) -> Vec<f64> {
        let phase = |k: usize| std::f64::consts::PI * (k as f64 - at as f64 + 0.5) / n as f64;
        (0..len).map(|k| if (at..at + n).contains(&k) { peak * phase(k).sin() } else { 0.0 }).collect()
    }

    #[test]
    fn pulses_of_any_length_are_no_spikes() {
        for n in 1..200 {
            for peak in [1.0, -250.0] {
                let contact = Contact::new(&half_sine(1000, 100, n, peak));
                assert!(contact.spikes.is_empty(), "{n} samples: {:?}", contact.spikes);
                let [pulse] = contact.pulses(0..1000, peak.abs() / 10.0)[..] else { panic!("{n} samples") };
                assert!((100..100 + n).contains(&pulse.at) && pulse.peak > 0.0);
            }
        }
    }

    #[test]
    fn a_spike_on_a_pulse_and_one_in_silence_are_bridged() {
        for (at, samples) in [(104..105, 1), (103..106, 3), (400..401, 1), (600..603, 3)] {
            let mut force = half_sine(1000, 100, 15, 150.0);
            force[at.clone()].fill(2000.0);
            let contact = Contact::new(&force);
            assert_eq!(contact.spikes, [(at.clone(), 2000.0)], "{samples} samples");
            assert!((contact.largest() - 150.0).abs() < 30.0);
        }
    }

    #[test]
    fn a_contact_ends_where_the_force_falls_below_half_the_level() {
        let force = [0.0, 0.0, 0.0, 2.0, 9.0, 0.8, 3.0, 0.2, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 0.0];
        let contact = Contact { force: force.to_vec(), noise: 0.0, spikes: Vec::new() };
        let pulses: Vec<_> = contact.pulses(0..16, 1.0).iter().map(|p| (p.first, p.last, p.at)).collect();
        assert_eq!(pulses, [(3, 6, 4), (11, 11, 11)]);
        assert_eq!(contact.width(&contact.pulses(0..16, 1.0)[0]), 1);
    }
}
