//! Where the sample files are, and functions of every form to write.

// Every test that includes this module uses a part of it.
#![allow(dead_code)]

use crate::outside;

use std::path::PathBuf;

use frfit_formats::uff::{
    Axis, DataType, Dof, Function, FunctionHeader, FunctionType, Quantity, Spacing, Values,
};
use num_complex::Complex64 as c64;

/// The folder of UFF samples.
pub(crate) fn samples() -> PathBuf {
    outside::shared("uff")
}

/// The eight combinations of data type and spacing.
pub(crate) fn variants() -> Vec<(DataType, Spacing)> {
    let types =
        [DataType::RealSingle, DataType::RealDouble, DataType::ComplexSingle, DataType::ComplexDouble];
    let spacings = [Spacing::Even { minimum: 2.5, increment: 0.125 }, Spacing::Uneven];
    types.into_iter().flat_map(|data_type| spacings.map(|spacing| (data_type, spacing))).collect()
}

/// A function with a header that is full of different fields, and these numbers as ordinates (two of them a
/// point where they are complex) and as stored abscissae.
pub(crate) fn function(data_type: DataType, spacing: Spacing, numbers: &[f64]) -> Function {
    let values = if data_type.is_complex() {
        Values::Complex(numbers.chunks_exact(2).map(|pair| c64::new(pair[0], pair[1])).collect())
    } else {
        Values::Real(numbers.to_vec())
    };
    let abscissa = match spacing {
        Spacing::Even { minimum, increment } => {
            (0..values.len()).map(|k| minimum + k as f64 * increment).collect()
        }
        Spacing::Uneven => numbers.iter().rev().take(values.len()).copied().collect(),
    };
    let axis = |quantity, label: &str, unit: &str| Axis {
        quantity,
        label: label.to_owned(),
        unit: unit.to_owned(),
        ..Axis::default()
    };
    let header = FunctionHeader {
        id: ["tip of the beam", "run 3", "05-MAR-24 10:11:12", "", "x/L = 1"].map(str::to_owned),
        function_type: FunctionType::FrequencyResponse,
        function_id: 17,
        version: 2,
        load_case: 0,
        response: Dof { entity: "beam".to_owned(), node: 34, direction: 3 },
        reference: Dof { entity: String::new(), node: 1_234_567, direction: -5 },
        data_type,
        points: 0,
        spacing,
        z_value: 0.75,
        abscissa: axis(Quantity::Frequency, "frequency", "Hz"),
        ordinate: axis(Quantity::Acceleration, "acceleration", "m/s²"),
        denominator: axis(Quantity::ExcitationForce, "force", "N"),
        z_axis: Axis { length_exponent: -2, force_exponent: 1, temperature_exponent: 3, ..Axis::default() },
    };
    Function::new(header, abscissa, values)
}
