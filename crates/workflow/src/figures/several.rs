//! Several unknowns: the responses, each unknown over frequency, and how those that hold for the band hang together.

use super::accelerance::compared;
use super::modulus::DEVIATIONS;
use super::{curve, draw, strip_of, title};
use crate::load::{Case, IdentifyCase};
use crate::output::{File, coordinate, file_name};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::identify::{Status, Uncertainty, Variation};
use frfit::material::loss_factor;
use frfit_figures::{Axis, Color, Dash, Figure, HeatMap, Marker, Panel, PngError, Series};

/// `figures/accelerance-*.*`, `figures/<unknown>.*` of what varies, `figures/correlation.*` and `figures/profile.*` of what holds for the band.
///
/// # Errors
/// [`PngError`] where a figure cannot be rasterised.
pub fn several_figures(case: &Case, wanted: &IdentifyCase, run: &IdentifyRun) -> Result<Vec<File>, PngError> {
    let mut figures = Vec::new();
    for m in 0..case.sensors.len() {
        let name =
            if case.sensors.len() == 1 { "accelerance".into() } else { format!("accelerance-{}", m + 1) };
        figures.push((name, accelerance(case, wanted, run, m)));
    }
    // A constant over frequency is a number, not a curve.
    for j in (0..wanted.unknowns.len()).filter(|&j| wanted.unknowns[j].varies != Variation::Constant) {
        figures.push((file_name(&wanted.unknowns[j].name), over_frequency(case, wanted, run, j)));
    }
    if run.found.identifiability.correlation.len() > 1 {
        figures.push(("correlation".to_owned(), correlation(case, wanted, run)));
    }
    if let Some(profile) = &run.found.identifiability.profile {
        let (x, y): (Vec<f64>, Vec<f64>) = profile.points.iter().copied().unzip();
        // What a straight line of slopes would have it.
        let std = run.found.identifiability.directions.first().map_or(f64::INFINITY, |worst| worst.std);
        let parabola = x.iter().map(|t| (t / std).powi(2)).collect();
        let series = |label, y, color, line, marker| curve(label, &x, y, color, line, marker);
        figures.push((
            "profile".to_owned(),
            Figure {
                title: title(case, "misfit along what is told worst"),
                x: Axis::linear("Distance from the answer (1 is a factor of e)"),
                panels: vec![Panel {
                    y: Axis::linear("Δχ²"),
                    series: vec![
                        series(
                            "all else at its best",
                            y,
                            Color::Vermilion,
                            Some(Dash::Solid),
                            Some(Marker::Circle),
                        ),
                        series("as the error bar has it", parabola, Color::Grey, Some(Dash::Dashed), None),
                    ],
                    ..Panel::default()
                }],
                ..Figure::default()
            },
        ));
    }
    draw(figures)
}

/// Width and height of the correlation beside its cells, and of each cell.
const AROUND: (f64, f64) = (330.0, 130.0);
const CELL: f64 = 56.0;

/// Correlation of the numbers that hold for the band, in the order of the summary's `coordinates`, the first on top.
fn correlation(case: &Case, wanted: &IdentifyCase, run: &IdentifyRun) -> Figure {
    let outcome = &run.found;
    let count = outcome.identifiability.correlation.len();
    let numbers: Vec<f64> = (1..=count).map(|k| k as f64).collect();
    let names = (0..count).rev().map(|c| format!("{} {}", c + 1, coordinate(wanted, outcome, c)));
    Figure {
        title: title(case, "correlation of what holds for the band"),
        x: Axis::whole("Number, as on the left"),
        panels: vec![Panel {
            y: Axis::whole(""),
            heat: Some(HeatMap {
                x: numbers.clone(),
                y: numbers,
                values: outcome.identifiability.correlation.iter().rev().flatten().copied().collect(),
                label: "Correlation".into(),
                range: Some((-1.0, 1.0)),
                names: names.collect(),
            }),
            ..Panel::default()
        }],
        size: (AROUND.0 + CELL * count as f64, AROUND.1 + CELL * count as f64),
    }
}

fn accelerance(case: &Case, wanted: &IdentifyCase, run: &IdentifyRun, sensor: usize) -> Figure {
    let at = &run.found.lines;
    let nominal = at.iter().map(|at| at.nominal_response.get(sensor).copied()).collect();
    let updated = at.iter().map(|at| at.updated_response.get(sensor).copied()).collect();
    let measured = wanted.measured.iter().map(|u| u.get(sensor).copied()).collect();
    let strip = strip_of(at.iter().map(|at| (at.frequency_hz, at.status)));
    compared(case, sensor, &wanted.frequency_hz, [nominal, measured, updated], strip)
}

fn over_frequency(case: &Case, wanted: &IdentifyCase, run: &IdentifyRun, j: usize) -> Figure {
    let one = &wanted.unknowns[j];
    let at = &run.found.lines;
    let panel = |label: &str, part: fn(c64) -> f64, std: fn(Uncertainty) -> Option<f64>| {
        let of = |values: Vec<Option<c64>>| {
            values.into_iter().map(|v| v.map_or(f64::NAN, part)).collect::<Vec<f64>>()
        };
        let with = |ok: bool| {
            at.iter().map(|at| at.values[j].value.filter(|_| (at.status == Status::Ok) == ok)).collect()
        };
        let bars = at
            .iter()
            .map(|at| at.values[j].uncertainty.and_then(std).map_or(f64::NAN, |s| DEVIATIONS * s))
            .collect();
        let drawn =
            |label, y, color, line, marker| curve(label, &wanted.frequency_hz, y, color, line, marker);
        let nominal = of(at.iter().map(|at| Some(at.values[j].nominal)).collect());
        let mut series = vec![
            drawn("nominal", nominal, Color::Blue, Some(Dash::Dashed), None),
            drawn("not trusted", of(with(false)), Color::Grey, None, Some(Marker::Cross)),
            Series {
                y_error: bars,
                ..drawn("updated", of(with(true)), Color::Vermilion, None, Some(Marker::Circle))
            },
        ];
        series.retain(|one| one.y.iter().any(|y| y.is_finite()));
        if let Some(reference) = &wanted.reference[j] {
            let reference = of(wanted.frequency_hz.iter().map(|&f| reference.at(f).ok()).collect());
            series.push(drawn("true", reference, Color::Black, Some(Dash::Solid), None));
        }
        Panel { y: Axis::linear(format!("{label}, ±2 std")), series, ..Panel::default() }
    };
    let strip = Some(strip_of(at.iter().map(|at| (at.frequency_hz, at.status))));
    let first = if one.real { "Value".to_owned() } else { wanted.units[j].storage_label() };
    let mut panels = vec![Panel { strip, ..panel(&first, |v| v.re, |bars| Some(bars.storage_std)) }];
    if !one.real {
        panels.push(panel("Loss factor η", loss_factor, |bars| bars.loss_factor_std));
    }
    Figure {
        title: title(case, &one.name),
        x: Axis::linear("Frequency (Hz)"),
        panels,
        size: if one.real { (720.0, 460.0) } else { (720.0, 620.0) },
    }
}
