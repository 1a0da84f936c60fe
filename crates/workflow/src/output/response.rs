//! `response.csv`: nominal, measured and updated response, per sensor, in the quantity that was measured.

use crate::load::{Case, IdentifyCase, SensorInfo, SeveralCase};
use crate::run::{IdentifyRun, RespondRun, SeveralRun};
use frfit::c64;
use frfit_formats::csv::{Cell, write};

/// One row a frequency and sensor: nominal, measured, updated; where there is no response, the cells are empty.
pub fn response_csv(case: &Case, identify: &IdentifyCase, run: &IdentifyRun) -> String {
    let rows = run.outcomes.iter().zip(&identify.measured).map(|(outcome, measured)| {
        let measured = run.measured(outcome.frequency_hz, measured);
        (outcome.frequency_hz, [outcome.nominal_response.clone(), measured, outcome.updated_response.clone()])
    });
    responses_csv(case, rows)
}

/// The same of several unknowns.
pub fn several_response_csv(case: &Case, wanted: &SeveralCase, run: &SeveralRun) -> String {
    let rows = run.outcome.at.iter().zip(&wanted.measured).map(|(at, measured)| {
        (at.frequency_hz, [at.nominal_response.clone(), measured.clone(), at.updated_response.clone()])
    });
    responses_csv(case, rows)
}

/// Nominal, measured and updated receptance at the sensors, frequency by frequency.
fn responses_csv(case: &Case, rows: impl Iterator<Item = (f64, [Vec<c64>; 3])>) -> String {
    let columns = [
        "frequency_hz",
        "sensor",
        "quantity",
        "nominal_re",
        "nominal_im",
        "measured_re",
        "measured_im",
        "updated_re",
        "updated_im",
    ];
    let rows = rows.flat_map(|(frequency_hz, responses)| {
        case.sensors.iter().enumerate().map(move |(m, sensor)| {
            let there = |receptance: &[c64]| cells(sensor, frequency_hz, receptance.get(m));
            let [[nominal_re, nominal_im], [measured_re, measured_im], [updated_re, updated_im]] =
                [0, 1, 2].map(|k| there(&responses[k]));
            [
                Cell::Number(frequency_hz),
                Cell::Text(&sensor.label),
                Cell::Text(sensor.quantity.name()),
                nominal_re,
                nominal_im,
                measured_re,
                measured_im,
                updated_re,
                updated_im,
            ]
        })
    });
    write(&columns, rows).expect("every row has the columns, and no label a line break")
}

/// One row a frequency and sensor of a forward response.
pub fn respond_csv(case: &Case, run: &RespondRun) -> String {
    let columns = ["frequency_hz", "sensor", "quantity", "re", "im"];
    let rows = run.frequency_hz.iter().zip(&run.receptance).flat_map(|(&frequency_hz, receptance)| {
        case.sensors.iter().enumerate().map(move |(m, sensor)| {
            let [re, im] = cells(sensor, frequency_hz, receptance.as_ref().ok().and_then(|x| x.get(m)));
            [
                Cell::Number(frequency_hz),
                Cell::Text(&sensor.label),
                Cell::Text(sensor.quantity.name()),
                re,
                im,
            ]
        })
    });
    write(&columns, rows).expect("every row has the columns, and no label a line break")
}

fn cells<'a>(sensor: &SensorInfo, frequency_hz: f64, receptance: Option<&c64>) -> [Cell<'a>; 2] {
    match receptance.map(|&x| sensor.quantity.from_receptance(frequency_hz, x)) {
        Some(value) => [Cell::Number(value.re), Cell::Number(value.im)],
        None => [Cell::Empty; 2],
    }
}
