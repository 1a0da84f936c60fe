//! How impacts are found, judged and averaged.

use super::{Estimator, Windows};
use crate::with_fields::with_fields;
use std::fmt;

/// How impacts are found, judged and averaged.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Which estimator of the FRF.
    pub estimator: Estimator,
    /// Force in N from which on there is an impact; `None`: a tenth of each recording's largest, spikes aside.
    pub trigger_n: Option<f64>,
    /// Time before the trigger that belongs to a record; `None`: all of a triggered capture, a hundredth of the
    /// time between impacts in a recording of several.
    pub pre_trigger_s: Option<f64>,
    /// Length of a record; `None`: that of a triggered capture, up to the next impact in a recording of several.
    pub length_s: Option<f64>,
    /// Share of an impact's largest force that a second contact has to reach to be called a double impact.
    ///
    /// A second contact of a share q ripples the force's spectrum by ±q; below a tenth it hardly differs from the ringing of filters.
    pub double_impact: f64,
    /// Share of a channel's largest value by which its mean may move within a record.
    pub drift: f64,
    /// Windows.
    pub windows: Windows,
    /// Impacts, by their number from 1, that are averaged whatever is wrong with them, as long as their record is complete
    /// and no channel is missing.
    pub keep: Vec<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            estimator: Estimator::H1,
            trigger_n: None,
            pre_trigger_s: None,
            length_s: None,
            double_impact: 0.1,
            drift: 0.05,
            windows: Windows::default(),
            keep: Vec::new(),
        }
    }
}

with_fields!(Options {
    with_estimator: estimator as Estimator,
    with_trigger_n: trigger_n as Option<f64>,
    with_pre_trigger_s: pre_trigger_s as Option<f64>,
    with_length_s: length_s as Option<f64>,
    with_double_impact: double_impact as f64,
    with_drift: drift as f64,
    with_windows: windows as Windows,
    with_keep: keep as Vec<usize>,
});

/// An option that is not as it can be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OptionsError {
    /// The field's name.
    pub name: &'static str,
    /// What it has to be.
    pub expected: &'static str,
    /// What it is.
    pub found: f64,
}

impl fmt::Display for OptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: expected {}, found {}", self.name, self.expected, self.found)
    }
}

impl std::error::Error for OptionsError {}

impl Options {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OptionsError`], the first of them.
    pub fn validate(&self) -> Result<(), OptionsError> {
        let positive =
            |name, value: Option<f64>| (name, "a positive number", value, f64::MIN_POSITIVE, f64::MAX);
        let share = |name, value| (name, "a number from 0 to 1", Some(value), 0.0, 1.0);
        let all = [
            positive("trigger", self.trigger_n),
            ("pre_trigger", "a number from 0 on", self.pre_trigger_s, 0.0, f64::MAX),
            positive("length", self.length_s),
            share("double_impact", self.double_impact),
            share("drift", self.drift),
            positive("force_window", self.windows.force_s),
            positive("exponential_window", self.windows.exponential_s),
        ];
        for (name, expected, value, least, most) in all {
            if let Some(found) = value.filter(|value| !(least..=most).contains(value)) {
                return Err(OptionsError { name, expected, found });
            }
        }
        Ok(())
    }
}
