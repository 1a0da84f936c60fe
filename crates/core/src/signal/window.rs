//! Windows of force and response, and the damping that one of them adds.

use super::baseline::offset;
use super::{Impact, Recording};
use crate::with_fields::with_fields;
use std::f64::consts::PI;

/// Windows over the record of an impact; by default none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Windows {
    /// Time in s after the trigger from which on the force is taken for zero, after a cosine of a tenth of that: silences the hammer's cable
    /// after the contact.
    pub force_s: Option<f64>,
    /// Time constant τ in s of the factor e^{−t/τ} on force and response: forces a response to decay within the record.
    /// It adds damping, which the model has to have too ([`added_decay`]).
    pub exponential_s: Option<f64>,
}

with_fields!(Windows {
    with_force_s: force_s as Option<f64>,
    with_exponential_s: exponential_s as Option<f64>,
});

/// β = 1/τ in 1/s, what the exponential window e^{−t/τ} adds to the decay rate of every mode.
///
/// With the same window on both channels the quotient is exactly the FRF on a parallel to the imaginary axis,
/// $$ H_w(\omega) = H(s)\big|_{s = i\omega + \beta}, $$
/// since e^{−βt} shifts a Laplace transform. It cannot be taken back from one frequency to the next without a model of
/// the structure; a model has it exactly ([`crate::model::DynamicStiffness::with_decay_per_s`]).
pub fn added_decay(exponential_s: f64) -> f64 {
    1.0 / exponential_s
}

/// What an exponential window leaves of a response at the end of a record whose response has not decayed.
const LEFT_BY_WINDOW: f64 = 1e-3;

/// The time constant τ in s of an exponential window that leaves a thousandth at the end of a record of `length_s` after the impact, whatever the structure does.
pub fn decaying_within(length_s: f64) -> f64 {
    length_s / (1.0 / LEFT_BY_WINDOW).ln()
}

/// 2β/ω to first order: the loss factor that a decay rate β (1/s) stands for at a frequency; twice the damping ratio β/ω.
pub fn added_loss_factor(decay_per_s: f64, frequency_hz: f64) -> f64 {
    decay_per_s / (PI * frequency_hz)
}

/// The record of an impact without its offsets, windowed: the force, then every response.
pub(super) fn records(recording: &Recording, impact: &Impact, windows: &Windows) -> Vec<Vec<f64>> {
    let before = impact.before();
    let onset = impact.pulse_in_record().start;
    let record = |samples: &[f64]| -> Vec<f64> {
        let record = &samples[impact.range.clone()];
        let offset = offset(record, before);
        record.iter().map(|x| x - offset).collect()
    };
    let mut records: Vec<Vec<f64>> = std::iter::once(&recording.force)
        .chain(&recording.responses)
        .map(|samples| record(samples))
        .collect();
    let seconds = |k: usize| (k as f64 - onset as f64) * recording.step_s;
    if let Some(length_s) = windows.force_s {
        for (k, x) in records[0].iter_mut().enumerate() {
            *x *= pulse_window(seconds(k), length_s);
        }
    }
    if let Some(exponential_s) = windows.exponential_s {
        for record in &mut records {
            for (k, x) in record.iter_mut().enumerate() {
                *x *= (-seconds(k) / exponential_s).exp();
            }
        }
    }
    records
}

/// 1 up to a time, then a half cosine of a tenth of it, then 0.
fn pulse_window(time_s: f64, length_s: f64) -> f64 {
    let past = (time_s - length_s) / (0.1 * length_s);
    match past {
        ..=0.0 => 1.0,
        1.0.. => 0.0,
        _ => 0.5 * (1.0 + (PI * past).cos()),
    }
}
