//! `sensitivities.csv`.

use super::SensitivityRun;
use crate::load::Case;
use frfit_formats::csv::{Cell, write};

/// One row a frequency, sensor and parameter: real and imaginary part of ∂ln x/∂ln p (the change of the amplitude's logarithm, and that of the phase in rad) and its
/// estimated error; empty where there is no answer.
pub(super) fn csv(case: &Case, run: &SensitivityRun) -> String {
    let columns = ["frequency_hz", "sensor", "parameter", "re", "im", "error"];
    let rows = run.frequency_hz.iter().zip(&run.values).flat_map(|(&frequency_hz, values)| {
        case.sensors.iter().enumerate().flat_map(move |(m, sensor)| {
            run.variables.iter().zip(values).map(move |(variable, values)| {
                let [re, im, error] = match values[m] {
                    Some((value, error)) => [value.re, value.im, error].map(Cell::Number),
                    None => [Cell::Empty; 3],
                };
                [
                    Cell::Number(frequency_hz),
                    Cell::Text(&sensor.label),
                    Cell::Text(&variable.name),
                    re,
                    im,
                    error,
                ]
            })
        })
    });
    write(&columns, rows).expect("every row has the columns, and no label a line break")
}
