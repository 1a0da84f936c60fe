//! `response.csv`: nominal, measured and updated response, per sensor, in the quantity that was measured, and how well it was measured.

use crate::load::{Case, IdentifyCase, MeasuredNoise};
use crate::run::{IdentifyRun, RespondRun};
use frfit::c64;
use frfit_formats::csv::{Cell, write};

/// One row a frequency and sensor: nominal, measured, updated; where there is no response, the cells are empty. `measured_std` is the
/// standard deviation √E|δH|² of the measured value, where files and case give it.
pub fn response_csv(case: &Case, identify: &IdentifyCase, run: &IdentifyRun) -> String {
    let rows = run.found.lines.iter().zip(&identify.measured).enumerate().map(|(i, (outcome, measured))| {
        let frequency_hz = outcome.frequency_hz;
        // A scale that was found is one of the values and of their standard deviations.
        let std = run.measured(frequency_hz, &known_std(&identify.noise, i, measured.len()));
        let measured = run.measured(frequency_hz, measured);
        (frequency_hz, [outcome.nominal_response.clone(), measured, outcome.updated_response.clone()], std)
    });
    responses_csv(case, rows)
}

/// Standard deviations of the sensors at the i-th frequency; NaN where they are not known.
fn known_std(noise: &MeasuredNoise, i: usize, sensors: usize) -> Vec<c64> {
    let of_one = |m: usize| match noise {
        MeasuredNoise::Known(std) => std[i][m],
        MeasuredNoise::Relative(_) | MeasuredNoise::Unknown => f64::NAN,
    };
    (0..sensors).map(|m| c64::from(of_one(m))).collect()
}

/// Nominal, measured and updated receptance at the sensors and the measured one's standard deviation, frequency by frequency.
fn responses_csv(case: &Case, rows: impl Iterator<Item = (f64, [Vec<c64>; 3], Vec<c64>)>) -> String {
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
        "measured_std",
    ];
    let rows = rows.flat_map(|(frequency_hz, responses, std)| {
        case.sensors.iter().enumerate().map(move |(m, sensor)| {
            let over_receptance = case.over_receptance(sensor, frequency_hz);
            let there = |receptance: &[c64]| cells(over_receptance, receptance.get(m));
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
                std.get(m).map(|std| (over_receptance * std).norm()).into(),
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
            let over_receptance = case.over_receptance(sensor, frequency_hz);
            let [re, im] = cells(over_receptance, receptance.as_ref().ok().and_then(|x| x.get(m)));
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

fn cells<'a>(over_receptance: c64, receptance: Option<&c64>) -> [Cell<'a>; 2] {
    match receptance.map(|&x| over_receptance * x) {
        Some(value) => [Cell::Number(value.re), Cell::Number(value.im)],
        None => [Cell::Empty; 2],
    }
}
