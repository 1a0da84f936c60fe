//! How measured values are read: as the case says, or otherwise.

use super::misfit::HALF_TURN;
use crate::c64;
use crate::frequency::omega_rad_s;
use crate::quantity::Quantity;

/// One way in which values may be meant otherwise.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Change {
    Conjugated,
    Reversed,
    /// Of what the case says, another quantity.
    Quantity {
        was: Quantity,
        is: Quantity,
    },
    /// By an unknown factor.
    Factor,
    /// By an unknown time.
    Delay,
    /// Compared with another column of the responses: another sensor's row, or another load.
    Column(Vec<usize>),
}

/// What is on another row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DofMismatch {
    /// The sensor, on this row.
    Response(usize),
    /// The load, on this row.
    Load(usize),
}

/// A change, and of which sensors.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Edit {
    pub(super) change: Change,
    pub(super) sensors: Vec<usize>,
}

/// How every sensor's values are read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DataHypothesis {
    pub(super) quantity: Vec<Quantity>,
    conjugated: Vec<bool>,
    reversed: Vec<bool>,
    factor: Vec<bool>,
    delay: Vec<bool>,
    /// Which column of the responses each is compared with.
    pub(super) column: Vec<usize>,
    /// α of a window on force and response, 1/s.
    decay_per_s: f64,
}

impl DataHypothesis {
    /// As the case says.
    pub(super) fn as_given(quantities: &[Quantity], decay_per_s: f64) -> Self {
        let no = vec![false; quantities.len()];
        Self {
            quantity: quantities.to_vec(),
            conjugated: no.clone(),
            reversed: no.clone(),
            factor: no.clone(),
            delay: no,
            column: (0..quantities.len()).collect(),
            decay_per_s,
        }
    }

    pub(super) fn sensors(&self) -> usize {
        self.quantity.len()
    }

    /// Whether a factor is unknown, and whether a delay is.
    pub(super) fn free(&self) -> [bool; 2] {
        [&self.factor, &self.delay].map(|which| which.contains(&true))
    }

    /// With one more change.
    pub(super) fn with(&self, edit: &Edit) -> Self {
        let mut other = self.clone();
        for (k, &m) in edit.sensors.iter().enumerate() {
            match &edit.change {
                Change::Conjugated => other.conjugated[m] = true,
                Change::Reversed => other.reversed[m] = true,
                Change::Quantity { is, .. } => other.quantity[m] = *is,
                Change::Factor => other.factor[m] = true,
                Change::Delay => other.delay[m] = true,
                Change::Column(columns) => other.column[m] = columns[k],
            }
        }
        other
    }

    /// The changes of values that are still to be tried: of all sensors, and of each.
    pub(super) fn edits(&self) -> Vec<Edit> {
        let all: Vec<usize> = (0..self.sensors()).collect();
        let single = all.iter().map(|&m| vec![m]).filter(|single| *single != all);
        let mut edits = Vec::new();
        for sensors in std::iter::once(all.clone()).chain(single) {
            let none = |which: &[bool]| sensors.iter().all(|&m| !which[m]);
            let mut push = |change| edits.push(Edit { change, sensors: sensors.clone() });
            if none(&self.conjugated) {
                push(Change::Conjugated);
            }
            if none(&self.reversed) {
                push(Change::Reversed);
            }
            let taken_for = self.quantity[sensors[0]];
            if sensors.iter().all(|&m| self.quantity[m] == taken_for) {
                let others = Quantity::ALL.into_iter().filter(|&q| q != taken_for);
                others.for_each(|is| push(Change::Quantity { was: taken_for, is }));
            }
            let [factor, delay] = self.free();
            if !factor {
                push(Change::Factor);
            }
            if !delay {
                push(Change::Delay);
            }
        }
        edits
    }

    /// How a value of a sensor is read, from the logarithm of the value as it was written.
    pub(super) fn reading(&self, m: usize, frequency_hz: f64, written: c64) -> Reading {
        let mut value = written;
        if self.conjugated[m] {
            value.im = -value.im;
        }
        if self.reversed[m] {
            value.im += HALF_TURN;
        }
        Reading {
            ln: value - ln_over_receptance(self.quantity[m], frequency_hz, self.decay_per_s),
            factor: f64::from(u8::from(self.factor[m])),
            turn: if self.delay[m] { omega_rad_s(frequency_hz) } else { 0.0 },
        }
    }
}

/// A value as it is read, whatever the unknown factor and delay are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading {
    /// ln of the receptance without both.
    ln: c64,
    /// 1 where the factor is of this sensor, otherwise 0.
    pub(super) factor: f64,
    /// ω where the delay is of this sensor, otherwise 0.
    pub(super) turn: f64,
}

impl Reading {
    /// ln of the receptance, with the factor's logarithm and the delay.
    pub(super) fn receptance(&self, ln_factor: f64, delay_s: f64) -> c64 {
        self.ln + c64::new(-self.factor * ln_factor, self.turn * delay_s)
    }
}

/// ln of 1, s or s² with s = iω + α: of 1, iω or −ω² without a window.
pub(super) fn ln_over_receptance(quantity: Quantity, frequency_hz: f64, decay_per_s: f64) -> c64 {
    let omega = omega_rad_s(frequency_hz);
    let ln_s = c64::new(omega.hypot(decay_per_s).ln(), 0.5 * HALF_TURN - decay_per_s.atan2(omega));
    match quantity {
        Quantity::Receptance => c64::default(),
        Quantity::Mobility => ln_s,
        Quantity::Accelerance => 2.0 * ln_s,
    }
}
