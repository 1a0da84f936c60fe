//! Faults of data, drawn.

use super::{Data, Which};
use crate::wrong_models::Failure;
use crate::wrong_models::case::{Case, solve};
use crate::wrong_models::dice::Dice;
use frfit::c64;
use frfit::diagnostics::{Fault as Found, KnownFactor};
use frfit::frequency::omega_rad_s;
use frfit::model::Experiment;
use frfit::quantity::Quantity;
use std::f64::consts::{PI, TAU};
use std::fmt;

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// The complex conjugate.
    Conjugated,
    /// The opposite sign.
    Sign,
    /// Another quantity.
    Quantity(Quantity),
    /// A number that has a name.
    Unit(KnownFactor),
    /// A delay in s.
    Delay(f64),
    /// A sensor that is on this row.
    ResponseDof(usize),
    /// The load is on this row.
    LoadDof(usize),
    /// rad/s in place of Hz.
    Axis,
    /// A channel that shows nothing.
    NoSignal,
}

/// A fault, and of which sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct Planted {
    /// What.
    pub fault: Fault,
    /// Whose.
    pub sensors: Vec<usize>,
    /// Of a row, all that answer alike: none of them can be known from it.
    pub alike: Vec<usize>,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Conjugated => f.write_str("conjugated"),
            Self::Sign => f.write_str("sign"),
            Self::Quantity(_) => f.write_str("quantity"),
            Self::Unit(_) => f.write_str("unit"),
            Self::Delay(_) => f.write_str("delay"),
            Self::ResponseDof(_) => f.write_str("response dof"),
            Self::LoadDof(_) => f.write_str("load dof"),
            Self::Axis => f.write_str("axis"),
            Self::NoSignal => f.write_str("no signal"),
        }
    }
}

/// Kinds of faults.
const KINDS: usize = 9;

/// Those of them that are rows.
const ROWS: [usize; 2] = [5, 6];

/// Root mean square of ln(faulty/right) at least: what changes data less than that no one can see beside a wrong model.
const VISIBLE: f64 = 0.3;

/// Rows whose responses differ by less than this, as [`VISIBLE`], are alike.
const ALIKE: f64 = 0.1;

/// What a delay turns the phase by at the top of the band, rad.
const DELAY_PHASE: [f64; 2] = [0.6, 6.0];

/// Draws a fault and puts it into the data; `None` where the one that was drawn is there already, or would not be seen.
pub(super) fn planted(
    case: &Case,
    data: &mut Data,
    (before, which): (&[Planted], Which),
    dice: &mut Dice,
) -> Result<Option<Planted>, Failure> {
    let count = data.quantities.len();
    let all: Vec<usize> = (0..count).collect();
    let is_of_all = dice.coin();
    let sensors = if is_of_all { all.clone() } else { vec![dice.below(count)] };
    let top = omega_rad_s(case.frequency_hz.last().copied().unwrap_or(1.0));
    let taken_for = data.quantities[sensors[0]];
    let others: Vec<Quantity> = Quantity::ALL.into_iter().filter(|q| *q != taken_for).collect();
    let rows = case.model.dim();
    let kind = match which {
        Which::All => dice.below(KINDS),
        Which::Rows => dice.pick(&ROWS),
    };
    let (fault, sensors) = match kind {
        0 => (Fault::Conjugated, sensors),
        1 => (Fault::Sign, sensors),
        2 => (Fault::Quantity(dice.pick(&others)), sensors),
        3 => (Fault::Unit(dice.pick(&KnownFactor::ALL)), sensors),
        4 => (Fault::Delay(dice.between(DELAY_PHASE[0], DELAY_PHASE[1]) / top), sensors),
        5 => (Fault::ResponseDof(dice.below(rows)), vec![dice.below(count)]),
        6 => (Fault::LoadDof(dice.below(rows)), all),
        7 => (Fault::Axis, all),
        _ if count > 1 => (Fault::NoSignal, vec![dice.below(count)]),
        _ => return Ok(None),
    };
    // The conjugate of a mobility that is then written as a receptance has the opposite sign too: a third fault.
    let is_conjugated = before.iter().any(|one| one.fault == Fault::Conjugated);
    let is_third = is_conjugated && matches!(fault, Fault::Quantity(_));
    if is_third || before.iter().any(|one| one.fault.is_same_kind(&fault)) {
        return Ok(None);
    }
    let mut changed = data.clone();
    let is_row = matches!(fault, Fault::ResponseDof(_) | Fault::LoadDof(_));
    if is_row {
        // The structure is measured elsewhere than the case says: the case names another row.
        let Some(elsewhere) = elsewhere(case, data, &fault, &sensors)? else { return Ok(None) };
        changed.experiment = elsewhere;
    }
    // What happened to values did so at the true frequencies.
    for ((given, f), values) in
        changed.frequency_hz.iter_mut().zip(&case.frequency_hz).zip(&mut changed.written)
    {
        for &m in &sensors {
            values[m] = fault.applied(*f, taken_for, values[m]);
        }
        if fault == Fault::Axis {
            *given *= TAU;
        }
    }
    let differs = |before: &[Vec<c64>]| difference(before, &changed.written, &sensors) > VISIBLE;
    let is_visible = match fault {
        Fault::Axis | Fault::NoSignal => true,
        // The conjugate of a lightly damped mobility is its opposite, within the noise.
        Fault::Conjugated => differs(&data.written) && differs(&opposite(&data.written)),
        _ => is_row || differs(&data.written),
    };
    if !is_visible {
        return Ok(None);
    }
    // What is to be found is where it was measured in truth.
    let fault = match fault {
        Fault::ResponseDof(_) => Fault::ResponseDof(data.experiment.sensors[sensors[0]].row),
        Fault::LoadDof(_) => Fault::LoadDof(driven(&data.experiment)),
        other => other,
    };
    let alike = alike(case, &data.experiment, &fault, &sensors)?;
    *data = changed;
    Ok(Some(Planted { fault, sensors, alike }))
}

/// The rows that answer as the true one does, for a sensor or for the load.
fn alike(
    case: &Case,
    experiment: &Experiment,
    fault: &Fault,
    sensors: &[usize],
) -> Result<Vec<usize>, Failure> {
    let (own, drives): (usize, Vec<Vec<c64>>) = match *fault {
        Fault::ResponseDof(row) => (row, vec![experiment.load.clone()]),
        // By reciprocity a load at any row answers at a sensor as that row does where the sensor is driven.
        Fault::LoadDof(row) => (row, sensors.iter().map(|&m| experiment.unit_force(m)).collect()),
        _ => return Ok(Vec::new()),
    };
    let mut squares = vec![0.0; case.model.dim()];
    let few: Vec<f64> = case.frequency_hz.iter().step_by(10).copied().collect();
    for &f in &few {
        let factor = case.model.analysis().factor(&case.model.at(f, &[])?.assemble(&[]))?;
        for drive in &drives {
            let mut x = drive.clone();
            factor.solve(&mut x)?;
            for (sum, value) in squares.iter_mut().zip(&x) {
                *sum += square(value / x[own]);
            }
        }
    }
    let count = (few.len() * drives.len()) as f64;
    Ok((0..squares.len()).filter(|&row| (squares[row] / count).sqrt() < ALIKE).collect())
}

/// |ln|² of a ratio.
fn square(ratio: c64) -> f64 {
    let square = ratio.norm().ln().powi(2) + ratio.arg().powi(2);
    if square.is_finite() { square.min(PI * PI) } else { 0.0 }
}

fn driven(experiment: &Experiment) -> usize {
    experiment.load.iter().position(|force| *force != c64::default()).unwrap_or(0)
}

/// The experiment with another row, where the model answers otherwise there.
fn elsewhere(
    case: &Case,
    data: &Data,
    fault: &Fault,
    sensors: &[usize],
) -> Result<Option<Experiment>, Failure> {
    let mut other = data.experiment.clone();
    match *fault {
        Fault::ResponseDof(row) => other.sensors[sensors[0]].row = row,
        Fault::LoadDof(row) => other.load.swap(driven(&data.experiment), row),
        _ => return Ok(None),
    }
    // At some lines, with the model at its nominal value: which rows answer alike does not depend on it.
    let few: Vec<f64> = case.frequency_hz.iter().step_by(10).copied().collect();
    let here = solve(&case.model, &data.experiment, &few)?;
    let there = solve(&case.model, &other, &few)?;
    Ok((difference(&here, &there, sensors) > VISIBLE).then_some(other))
}

fn opposite(values: &[Vec<c64>]) -> Vec<Vec<c64>> {
    values.iter().map(|at| at.iter().map(|value| -value).collect()).collect()
}

/// Root mean square of ln(b/a) of some sensors.
fn difference(a: &[Vec<c64>], b: &[Vec<c64>], sensors: &[usize]) -> f64 {
    let squares = a.iter().zip(b).flat_map(|(a, b)| sensors.iter().map(move |&m| square(b[m] / a[m])));
    let (sum, count) = squares.fold((0.0, 0), |(sum, count), square| (sum + square, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

impl Fault {
    pub(super) fn is_same_kind(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// A value with it.
    fn applied(&self, frequency_hz: f64, taken_for: Quantity, value: c64) -> c64 {
        match *self {
            Self::Conjugated => value.conj(),
            Self::Sign => -value,
            Self::Quantity(is) => {
                is.from_receptance(frequency_hz, taken_for.to_receptance(frequency_hz, value))
            }
            Self::Unit(factor) => factor.value() * value,
            Self::Delay(seconds) => value * c64::from_polar(1.0, -omega_rad_s(frequency_hz) * seconds),
            Self::NoSignal => c64::default(),
            Self::ResponseDof(_) | Self::LoadDof(_) | Self::Axis => value,
        }
    }
}

impl Planted {
    /// Whether a finding names it.
    pub fn is(&self, found: &Found, sensors: &[usize]) -> bool {
        let is_fault = match (self.fault, found) {
            (Fault::Conjugated, Found::Conjugated)
            | (Fault::Sign, Found::Sign)
            | (Fault::NoSignal, Found::NoSignal) => true,
            (Fault::Quantity(quantity), Found::Quantity { is, .. }) => quantity == *is,
            (Fault::Unit(unit), Found::Factor { known, .. }) => *known == Some(unit),
            (Fault::Delay(planted), Found::Delay { seconds, .. }) => (seconds / planted - 1.0).abs() < 0.2,
            (Fault::ResponseDof(row), Found::ResponseDof { rows })
            | (Fault::LoadDof(row), Found::LoadDof { rows }) => {
                rows.iter().any(|other| other.row == row || self.alike.contains(&other.row))
            }
            (Fault::Axis, Found::Axis { factor }) => *factor > 1.0,
            _ => false,
        };
        is_fault && sensors == self.sensors
    }
}
