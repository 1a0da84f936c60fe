//! Measured frequency response functions as UFF 58 or CSV.

use crate::Error;
use frfit::c64;
use frfit::dof::DofName;
use frfit::quantity::Quantity;
use frfit_formats::csv::{self, Cell};
use frfit_formats::uff::{self, Axis, Dof, Form, Function, FunctionHeader, Spacing, Units, Values, write};

/// One sensor's response over evenly spaced frequencies.
pub(crate) struct Frf<'a> {
    /// What was measured, in a line.
    pub(crate) title: &'a str,
    /// Which quantity the values are.
    pub(crate) quantity: Quantity,
    /// Where it was measured.
    pub(crate) response: DofName,
    /// Where the unit force was; `None` where more than one row is loaded.
    pub(crate) reference: Option<DofName>,
    /// First + k · step.
    pub(crate) frequency_hz: &'a [f64],
    /// The complex values.
    pub(crate) values: Vec<c64>,
}

/// Columns frequency_hz, re, im, and std where it is known.
pub(crate) fn csv_frf(frf: &Frf<'_>, std: Option<&[f64]>) -> Result<String, Error> {
    let columns = ["frequency_hz", "re", "im", "std"];
    let row = |(k, (f, value)): (usize, (&f64, &c64))| {
        let std = std.map(|std| std[k]);
        [*f, value.re, value.im].into_iter().chain(std).map(Cell::from).collect::<Vec<_>>()
    };
    let rows = frf.frequency_hz.iter().zip(&frf.values).enumerate().map(row);
    Ok(csv::write(&columns[..if std.is_some() { 4 } else { 3 }], rows)?)
}

/// The units of the file, then one function a sensor.
pub(crate) fn uff_frfs(frfs: &[Frf<'_>]) -> Result<Vec<u8>, Error> {
    let mut bytes = write::units(&Units::default())?;
    for (number, frf) in (1..).zip(frfs) {
        bytes.extend(write::function(&function(number, frf), Form::Ascii)?);
    }
    Ok(bytes)
}

fn function(number: i64, frf: &Frf<'_>) -> Function {
    let (numerator, label, unit) = match frf.quantity {
        Quantity::Receptance => (uff::Quantity::Displacement, "Displacement", "m"),
        Quantity::Mobility => (uff::Quantity::Velocity, "Velocity", "m/s"),
        Quantity::Accelerance => (uff::Quantity::Acceleration, "Acceleration", "m/s^2"),
    };
    let origin = "Direct solution of the finite element model with the true parameter, no noise";
    let header = FunctionHeader {
        id: [frf.title, origin, "", "", ""].map(str::to_owned),
        function_id: number,
        // 0: excitation at a single point.
        load_case: i64::from(frf.reference.is_none()),
        response: dof(frf.response),
        reference: frf.reference.map(dof).unwrap_or_default(),
        spacing: spacing(frf.frequency_hz),
        abscissa: axis(uff::Quantity::Frequency, "Frequency", "Hz"),
        ordinate: axis(numerator, label, unit),
        denominator: axis(uff::Quantity::ExcitationForce, "Force", "N"),
        ..FunctionHeader::default()
    };
    Function::new(header, frf.frequency_hz.to_vec(), Values::Complex(frf.values.clone()))
}

fn spacing(frequency_hz: &[f64]) -> Spacing {
    match frequency_hz {
        [first, second, ..] => Spacing::Even { minimum: *first, increment: second - first },
        _ => Spacing::Uneven,
    }
}

fn dof(name: DofName) -> Dof {
    // Labels are row or node numbers of a mesh in memory: far below 2⁶³.
    Dof { entity: String::new(), node: name.node as i64, direction: name.uff_direction() }
}

fn axis(quantity: uff::Quantity, label: &str, unit: &str) -> Axis {
    Axis { quantity, label: label.to_owned(), unit: unit.to_owned(), ..Axis::default() }
}
