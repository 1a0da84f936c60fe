//! A LabVIEW measurement file, and what its channels hold.

use super::text::aligned;
use crate::terminal::short;
use frfit_formats::FormatError;
use frfit_formats::lvm::{Abscissa, Channel, Lvm, read};
use serde_json::{Value, json};

/// A LabVIEW measurement file in a few words.
#[derive(Debug, Clone, PartialEq)]
pub struct LvmFacts {
    /// Segments.
    pub segments: usize,
    /// The channels of all segments, once each name and unit.
    pub channels: Vec<LvmChannel>,
}

/// A channel in a few words.
#[derive(Debug, Clone, PartialEq)]
pub struct LvmChannel {
    /// Its name.
    pub name: String,
    /// Its unit as the file has it.
    pub unit: String,
    /// Distance of its samples, where they are equally spaced.
    pub step: Option<f64>,
    /// Samples in each segment that has it.
    pub samples: Vec<usize>,
    /// Smallest and largest of all samples.
    pub range: [f64; 2],
}

impl LvmFacts {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        let Lvm { segments, .. } = read(bytes)?;
        let mut facts = Self { segments: segments.len(), channels: Vec::new() };
        for channel in segments.iter().flat_map(|segment| &segment.channels) {
            let is_it =
                |known: &&mut LvmChannel| (&known.name, &known.unit) == (&channel.name, &channel.unit);
            match facts.channels.iter_mut().find(is_it) {
                Some(known) => known.add(channel),
                None => {
                    let mut known = LvmChannel::new(channel);
                    known.add(channel);
                    facts.channels.push(known);
                }
            }
        }
        Ok(facts)
    }

    pub(super) fn json(&self) -> Value {
        let channel = |channel: &LvmChannel| {
            json!({
                "name": channel.name,
                "unit": channel.unit,
                "step": channel.step,
                "samples": channel.samples,
                "range": channel.shown_range(),
            })
        };
        json!({
            "segments": self.segments,
            "channels": self.channels.iter().map(channel).collect::<Vec<_>>(),
            "serves_as": ["records"],
        })
    }

    pub(super) fn lines(&self) -> String {
        let mut lines = vec![("segments", self.segments.to_string())];
        lines.extend(self.channels.iter().map(|channel| ("channel", channel.line())));
        lines.push(("use", "time records (frfit frf)".to_owned()));
        aligned(&lines)
    }
}

impl LvmChannel {
    fn new(channel: &Channel) -> Self {
        let step = match channel.abscissa {
            Abscissa::Even { step, .. } => Some(step),
            Abscissa::Listed(_) => None,
        };
        Self {
            name: channel.name.clone(),
            unit: channel.unit.clone(),
            step,
            samples: Vec::new(),
            range: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    fn add(&mut self, channel: &Channel) {
        self.samples.push(channel.values.len());
        for &x in &channel.values {
            self.range = [self.range[0].min(x), self.range[1].max(x)];
        }
    }

    /// None of a channel without samples.
    fn shown_range(&self) -> Option<[f64; 2]> {
        (self.range[0] <= self.range[1]).then_some(self.range)
    }

    fn line(&self) -> String {
        let mut samples = self.samples.clone();
        samples.dedup();
        let samples: Vec<String> = samples.iter().map(usize::to_string).collect();
        let unit = if self.unit.is_empty() { "no unit" } else { &self.unit };
        let step = self.step.map_or(String::new(), |step| format!(", every {} s", short(step)));
        let range = self
            .shown_range()
            .map_or(String::new(), |[low, high]| format!(", {} to {}", short(low), short(high)));
        format!("{:?} in {unit}, {} samples{step}{range}", self.name, samples.join(" or "))
    }
}
