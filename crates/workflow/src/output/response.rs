//! `response.csv`: nominal, measured and updated response, per sensor, in the quantity that was measured, and how well it was measured.

use crate::load::{Case, IdentifyCase, MeasuredNoise, SensorInfo};
use crate::run::{IdentifyRun, RespondRun};
use frfit::c64;
use frfit_formats::csv::{Cell, write};

/// One row a frequency and sensor: nominal, measured, updated; where there is no response, the cells are empty. `measured_std` is the
/// standard deviation √E|δH|² of the measured value, where files and case tell it.
pub fn response_csv(case: &Case, identify: &IdentifyCase, run: &IdentifyRun) -> String {
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
    let all_std = match &identify.noise {
        MeasuredNoise::Known(std) => std.as_slice(),
        MeasuredNoise::Relative(_) | MeasuredNoise::Unknown => &[],
    };
    let rows =
        run.outcomes.iter().zip(&identify.measured).enumerate().flat_map(|(i, (outcome, measured))| {
            let of_one =
                |m: usize| c64::from(all_std.get(i).and_then(|std| std.get(m)).copied().unwrap_or(f64::NAN));
            let std: Vec<c64> = (0..measured.len()).map(of_one).collect();
            // A scale that was found is one of the values and of their deviations.
            let std = run.measured(outcome.frequency_hz, &std);
            let measured = run.measured(outcome.frequency_hz, measured);
            case.sensors.iter().enumerate().map(move |(m, sensor)| {
                let there = |receptance: Option<&c64>| cells(sensor, outcome.frequency_hz, receptance);
                let [nominal_re, nominal_im] = there(outcome.nominal_response.get(m));
                let [measured_re, measured_im] = there(measured.get(m));
                let [updated_re, updated_im] = there(outcome.updated_response.get(m));
                [
                    Cell::Number(outcome.frequency_hz),
                    Cell::Text(&sensor.label),
                    Cell::Text(sensor.quantity.name()),
                    nominal_re,
                    nominal_im,
                    measured_re,
                    measured_im,
                    updated_re,
                    updated_im,
                    std.get(m)
                        .map(|std| sensor.quantity.from_receptance(outcome.frequency_hz, *std).norm())
                        .into(),
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
