//! |a| over frequency for the nominal, measured and updated response: Figs 2, 7 and 11.

use super::{curve, status_strip, title};
use crate::load::{Case, IdentifyCase};
use crate::run::{IdentifyRun, RespondRun};
use frfit::c64;
use frfit::quantity::Quantity;
use frfit_figures::{Axis, Color, Dash, Figure, Marker, Panel, Series};

pub(super) fn identified(case: &Case, identify: &IdentifyCase, run: &IdentifyRun, sensor: usize) -> Figure {
    let frequency_hz = &identify.frequency_hz;
    let nominal = run.found.lines.iter().map(|o| o.nominal_response.get(sensor).copied()).collect();
    let updated = run.found.lines.iter().map(|o| o.updated_response.get(sensor).copied()).collect();
    let measured = frequency_hz.iter().zip(&identify.measured);
    let measured = measured.map(|(&f, u)| Some(run.measured_by(sensor, f, *u.get(sensor)?))).collect();
    let series = |label, responses, color, line, marker| {
        curve(label, frequency_hz, modulus(case, frequency_hz, responses), color, line, marker)
    };
    Figure {
        title: title(case, &format!("accelerance at {}", case.sensors[sensor].label)),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::log("|Accelerance| (m/(s²·N))"),
            series: vec![
                series("nominal", nominal, Color::Blue, Some(Dash::Dashed), None),
                series("measured", measured, Color::Black, None, Some(Marker::Circle)),
                series("updated", updated, Color::Vermilion, Some(Dash::Solid), None),
            ],
            strip: Some(status_strip(run)),
            ..Panel::default()
        }],
        ..Figure::default()
    }
}

pub(super) fn forward(case: &Case, run: &RespondRun) -> Figure {
    let colors = [Color::Blue, Color::Vermilion, Color::Green, Color::Orange, Color::Purple, Color::SkyBlue];
    let dashes = [Dash::Solid, Dash::Dashed, Dash::DashDot, Dash::Dotted];
    let series = case.sensors.iter().enumerate().map(|(m, sensor)| Series {
        label: sensor.label.clone(),
        x: run.frequency_hz.clone(),
        y: modulus(
            case,
            &run.frequency_hz,
            run.receptance.iter().map(|x| x.as_ref().ok()?.get(m).copied()).collect(),
        ),
        color: colors[m % colors.len()],
        line: Some(dashes[m / colors.len() % dashes.len()]),
        ..Series::default()
    });
    Figure {
        title: title(case, "accelerance"),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::log("|Accelerance| (m/(s²·N))"),
            series: series.collect(),
            ..Panel::default()
        }],
        ..Figure::default()
    }
}

/// |−ω² x|, P-39, |s² x| under a window of the measurements; a gap where there is no response.
fn modulus(case: &Case, frequency_hz: &[f64], receptance: Vec<Option<c64>>) -> Vec<f64> {
    let over = |f: f64| Quantity::Accelerance.over_receptance_windowed(f, case.model.decay_per_s());
    let of = |(&f, x): (&f64, Option<c64>)| x.map_or(f64::NAN, |x| (over(f) * x).norm());
    frequency_hz.iter().zip(receptance).map(of).collect()
}
