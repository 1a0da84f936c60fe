//! How an impact is judged: what is wrong with it, and how far the responses have decayed.

use super::baseline::{last_tenth, mean, offset, peak, rms};
use super::impact::FOOT_SAMPLES;
use super::pulse::{Contact, Pulse};
use super::{Channel, Fault, Impact, Options, Recording};
use std::ops::Range;

/// Judges an impact: its faults, and how far the responses have decayed.
pub(super) fn examine(impact: &mut Impact, recording: &Recording, samples: usize, options: &Options) {
    if impact.faults.is_empty() {
        impact.faults = faults(impact, recording, samples, &Contact::new(&recording.force), options);
    }
    let before = impact.before();
    let records =
        recording.responses.iter().map(|response| response.get(impact.range.clone()).unwrap_or(&[]));
    let share = |part: &[f64], record: &[f64]| {
        let largest = peak(record, offset(record, before));
        if largest > 0.0 { rms(part) / largest } else { 0.0 }
    };
    impact.residual =
        records.clone().map(|r| if r.is_empty() { 0.0 } else { share(last_tenth(r), r) }).collect();
    // Fewer samples are no noise level.
    let has_baseline = before >= 2 * FOOT_SAMPLES && records.clone().all(|record| record.len() > before);
    impact.noise = has_baseline.then(|| records.map(|r| share(&r[..before], r)).collect());
}

/// Everything that is wrong with the record of an impact, the contacts of its recording given.
fn faults(
    impact: &Impact,
    recording: &Recording,
    samples: usize,
    contact: &Contact,
    options: &Options,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    if impact.range.len() < samples {
        faults.push(Fault::Incomplete { samples: impact.range.len(), of: samples });
    }
    for (range, height) in contact.spikes.iter().filter(|(range, _)| overlap(range, &impact.range)) {
        faults.push(Fault::Spike { channel: Channel::Force, samples: range.len(), height: *height });
    }
    faults.extend(second_contacts(impact, recording, contact, options));
    for channel in recording.channels() {
        let Some(record) =
            recording.channel(channel).get(impact.range.clone()).filter(|record| is_moving(record))
        else {
            faults.push(Fault::Missing { channel });
            continue;
        };
        if channel != Channel::Force
            && let Some((samples, height)) = spike(record, impact)
        {
            faults.push(Fault::Spike { channel, samples, height });
        }
        if let Some((samples, level)) = clipped(record, offset(record, impact.before())) {
            faults.push(Fault::Clipped { channel, samples, level });
        }
        let share = drift(record, impact.before());
        if share > options.drift {
            faults.push(Fault::Drift { channel, share });
        }
    }
    faults
}

fn is_moving(record: &[f64]) -> bool {
    record.iter().any(|x| *x != record[0])
}

fn overlap(a: &Range<usize>, b: &Range<usize>) -> bool {
    a.start < b.end && b.start < a.end
}

/// Samples after a contact in which the ringing of an anti-aliasing filter may look like another.
const RINGING_SAMPLES: usize = 4;

/// Contacts other than the impact's own.
fn second_contacts(
    impact: &Impact,
    recording: &Recording,
    contact: &Contact,
    options: &Options,
) -> Vec<Fault> {
    let in_record = |pulse: &Pulse| impact.range.contains(&pulse.at);
    let level = (options.double_impact * impact.peak_n).max(6.0 * contact.noise);
    let pulses: Vec<Pulse> =
        contact.pulses(0..contact.force.len(), level).into_iter().filter(in_record).collect();
    let Some(own) = pulses.iter().find(|pulse| pulse.last >= impact.onset) else { return Vec::new() };
    let width = contact.width(own);
    let others =
        pulses.iter().filter(|other| other.first > own.last + RINGING_SAMPLES || other.last < own.first);
    others
        .map(|other| {
            let samples = contact.width(other);
            // As with the largest spike: far narrower than a contact of this hammer.
            if width > 2 * samples + 1 && samples <= 2 {
                return Fault::Spike { channel: Channel::Force, samples, height: other.peak };
            }
            let share = (other.peak / own.peak).min(own.peak / other.peak);
            Fault::DoubleImpact { after_s: own.at.abs_diff(other.at) as f64 * recording.step_s, share }
        })
        .collect()
}

/// A jump there and back within so many samples is a spike...
const MAX_JUMP_SAMPLES: usize = 3;

/// ... where it is higher than any other by this factor. Signals behind an anti-aliasing filter do not jump like that.
const MIN_JUMP_RATIO: f64 = 10.0;

/// A spike of a response away from the contact, where jumps are its own: how many samples, and how far it jumps.
fn spike(record: &[f64], impact: &Impact) -> Option<(usize, f64)> {
    let jumps: Vec<f64> = record.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let there = (0..jumps.len()).max_by(|&a, &b| jumps[a].abs().total_cmp(&jumps[b].abs()))?;
    let near = there.saturating_sub(MAX_JUMP_SAMPLES)..jumps.len().min(there + MAX_JUMP_SAMPLES + 1);
    let is_back = |&k: &usize| jumps[k] * jumps[there] < 0.0 && 2.0 * jumps[k].abs() >= jumps[there].abs();
    let back = near.filter(is_back).max_by(|&a, &b| jumps[a].abs().total_cmp(&jumps[b].abs()))?;
    let run = there.min(back)..=there.max(back);
    let outside = |k: &usize| *k + 1 < *run.start() || *k > run.end() + 1;
    let others = (0..jumps.len()).filter(outside).map(|k| jumps[k].abs()).fold(0.0, f64::max);
    let pulse = impact.pulse_in_record();
    let in_contact = *run.end() + 2 >= pulse.start && *run.start() <= pulse.end + pulse.len();
    (jumps[there].abs() >= MIN_JUMP_RATIO * others && !in_contact)
        .then(|| (run.count() - 1, jumps[there].abs()))
}

/// Fewest equal samples of a flat top.
const MIN_FLAT_SAMPLES: usize = 3;

/// Share of a channel's span that has to be cut off: a smooth top that a converter of 12 bits makes flat lacks a tenth of that.
const MIN_CUT_OFF_SHARE: f64 = 0.005;

/// Samples that stand at the record's largest or smallest value between flanks so steep that a top is missing, and that value.
///
/// A parabola through a flat top of w samples with slope s at its ends is s·w/4 higher. What is flat near the offset is silence.
fn clipped(record: &[f64], offset: f64) -> Option<(usize, f64)> {
    let [low, high] = [f64::min, f64::max].map(|pick| record.iter().copied().reduce(pick).unwrap_or(0.0));
    let far = 0.5 * peak(record, offset);
    let at = |limit: f64| {
        if (limit - offset).abs() < far {
            return (0, limit);
        }
        let mut samples = 0;
        let mut start = 0;
        for run in record.chunk_by(|a, b| a == b) {
            let end = start + run.len();
            if run[0] == limit && run.len() >= MIN_FLAT_SAMPLES && start >= 2 && end + 1 < record.len() {
                let rise = (record[start - 1] - record[start - 2]).abs();
                let fall = (record[end] - record[end + 1]).abs();
                if rise.min(fall) * run.len() as f64 / 4.0 > MIN_CUT_OFF_SHARE * (high - low) {
                    samples += run.len();
                }
            }
            start = end;
        }
        (samples, limit)
    };
    [at(low), at(high)].into_iter().max_by_key(|(samples, _)| *samples).filter(|(samples, _)| *samples > 0)
}

/// How far the mean moves from before the impact, or from the middle of the record, to its last tenth, over the largest value, beyond what noise or
/// a response that has not decayed may move it.
fn drift(record: &[f64], before: usize) -> f64 {
    let end = last_tenth(record);
    let middle =
        &record[record.len() / 2..record.len() / 2 + record.len().div_ceil(10).min(record.len() / 2)];
    let moved = |from: &[f64]| (mean(end) - mean(from)).abs() - rms(end) - rms(from);
    // As many samples before as a mean needs that is not noise.
    let far = if before >= 8 { moved(&record[..before]) } else { 0.0 };
    far.max(moved(middle)).max(0.0) / peak(record, mean(end)).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ringing(k: usize) -> f64 {
        let t = k as f64;
        (-t / 200.0).exp() * (t / 3.0).sin()
    }

    #[test]
    fn a_flat_top_is_clipped_only_between_steep_flanks() {
        let clean: Vec<f64> = (0..1000).map(ringing).collect();
        assert_eq!(clipped(&clean, 0.0), None);
        let limited: Vec<f64> = clean.iter().map(|x| x.clamp(-0.7, 0.7)).collect();
        let (samples, level) = clipped(&limited, 0.0).unwrap();
        assert!(samples >= 3 && level.abs() == 0.7);
        // Slow tops that a converter makes flat.
        let coarse: Vec<f64> = (0..4000).map(|k| (2048.0 * (f64::from(k) / 300.0).sin()).round()).collect();
        assert_eq!(clipped(&coarse, 0.0), None);
        assert_eq!(clipped(&[1.0, 1.0, 1.0, 1.0], 0.0), None);
    }

    #[test]
    fn means_that_move_are_drift() {
        let around = |drift: f64| -> f64 {
            let record: Vec<f64> = (0..1000)
                .map(|k| if k < 50 { 0.0 } else { ringing(k - 50) } + drift * k as f64 / 1000.0)
                .collect();
            super::drift(&record, 50)
        };
        assert!(around(0.0) < 0.005);
        assert!((around(0.2) - 0.18).abs() < 0.04, "{}", around(0.2));
    }
}
