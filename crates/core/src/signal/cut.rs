//! Impacts found, and a record of equal length cut for each.

use super::pulse::{Contact, Pulse};
use super::{Impact, Options, Recording};

/// Time in s within which a second contact is a rebound: no hand impacts twice on purpose in less.
const MAX_REBOUND_S: f64 = 0.25;

/// Force over its noise from which on a contact is one: of 10⁵ samples of normal noise the largest is at 4.4.
const MIN_CONTACT_OVER_NOISE: f64 = 10.0;

/// Share of a recording's largest force that is the trigger by default.
const TRIGGER_SHARE: f64 = 0.1;

/// Share of the time between impacts that comes before the trigger by default.
const PRE_TRIGGER_SHARE: f64 = 0.01;

/// Impacts, not yet judged, and how many samples a record has.
pub(super) struct Cut {
    pub(super) impacts: Vec<Impact>,
    pub(super) samples: usize,
}

pub(super) fn impacts(recordings: &[Recording], options: &Options) -> Cut {
    let mut impacts = Vec::new();
    for (k, recording) in recordings.iter().enumerate() {
        let contact = Contact::new(&recording.force);
        let is_capture = recordings.len() > 1;
        let pulses = own(&contact, recording, options, is_capture);
        match pulses[..] {
            [] => impacts.push(Impact::none(k, recording.len(), &recording.force)),
            [pulse] => impacts.push(capture(k, recording, pulse, options)),
            _ => impacts.extend(several(k, recording, &pulses, options)),
        }
    }
    let step_s = recordings.first().map_or(1.0, |recording| recording.step_s);
    let asked = options.length_s.map(|length_s| count(length_s, step_s).max(2));
    let samples = asked.unwrap_or_else(|| usual(&impacts));
    for impact in &mut impacts {
        impact.range.end = impact.range.end.min(impact.range.start + samples);
    }
    Cut { impacts, samples }
}

/// How many samples last so long.
fn count(seconds: f64, step_s: f64) -> usize {
    (seconds / step_s).round() as usize
}

/// Share of the usual room for a record that an impact needs to have its say in the length of all.
const MIN_ROOM_SHARE: f64 = 0.8;

/// The longest length for which no impact has to be left out that has nearly as much room as at least half of them.
fn usual(impacts: &[Impact]) -> usize {
    let mut room: Vec<usize> = impacts.iter().map(|impact| impact.range.len()).collect();
    room.sort_unstable_by(|a, b| b.cmp(a));
    let of_half = room.get(room.len().saturating_sub(1) / 2).copied().unwrap_or(0);
    room.into_iter().filter(|&room| room as f64 >= MIN_ROOM_SHARE * of_half as f64).min().unwrap_or(0)
}

/// The first contact of each impact: what follows too soon is a rebound, in a triggered capture all that follows.
fn own(contact: &Contact, recording: &Recording, options: &Options, is_capture: bool) -> Vec<Pulse> {
    let level = options.trigger_n.unwrap_or(TRIGGER_SHARE * contact.largest());
    if level <= 0.0 || contact.largest() < MIN_CONTACT_OVER_NOISE * contact.noise {
        return Vec::new();
    }
    let apart = count(options.length_s.unwrap_or(MAX_REBOUND_S), recording.step_s);
    let mut own: Vec<Pulse> = Vec::new();
    for pulse in contact.pulses(0..contact.force.len().min(recording.len()), level) {
        if own.last().is_none_or(|last| !is_capture && pulse.first - last.first >= apart) {
            own.push(pulse);
        }
    }
    own
}

/// One impact in a recording: all of it, unless the options say where a record begins.
fn capture(k: usize, recording: &Recording, pulse: Pulse, options: &Options) -> Impact {
    let before = options.pre_trigger_s.map(|seconds| count(seconds, recording.step_s));
    let start = before.map_or(0, |before| pulse.first.saturating_sub(before));
    // A record that would begin before its recording lacks that much at its end, so that it is seen to be incomplete.
    let lacking = before.map_or(0, |before| before.saturating_sub(pulse.first));
    let end = recording.len().saturating_sub(lacking).max(start);
    Impact::at(k, pulse.first, pulse.last, pulse.peak, start..end)
}

/// Several impacts in a recording: each up to where the record of the next begins.
fn several(k: usize, recording: &Recording, pulses: &[Pulse], options: &Options) -> Vec<Impact> {
    let mut gaps: Vec<usize> = pulses.windows(2).map(|pair| pair[1].first - pair[0].first).collect();
    gaps.sort_unstable();
    let usual = gaps[gaps.len() / 2];
    let default = (usual as f64 * PRE_TRIGGER_SHARE) as usize;
    let before = options.pre_trigger_s.map_or(default, |seconds| count(seconds, recording.step_s));
    let starts = pulses.iter().map(|pulse| pulse.first.saturating_sub(before));
    let ends = starts.clone().skip(1).chain([recording.len()]);
    let impact = |((pulse, start), end): ((&Pulse, usize), usize)| {
        let lacking = before.saturating_sub(pulse.first);
        Impact::at(k, pulse.first, pulse.last, pulse.peak, start..end.saturating_sub(lacking).max(start))
    };
    pulses.iter().zip(starts).zip(ends).map(impact).collect()
}
