//! Poles over frequency, and pairs of model and measurement.

use super::{curve, draw, title};
use crate::load::Case;
use crate::modes::ModesRun;
use crate::output::File;
use frfit::c64;
use frfit::modal::{PoleAtOrder, assurance};
use frfit_figures::{Axis, Color, Dash, Figure, HeatMap, Level, Marker, Panel, PngError, Series};

/// Figures of the modal view; none without a measurement.
///
/// # Errors
/// [`PngError`] where a figure cannot be rasterised.
pub fn modes_figures(case: &Case, run: &ModesRun) -> Result<Vec<File>, PngError> {
    let mut figures = Vec::new();
    if run.measured.is_some() {
        figures.push(("stabilisation".to_owned(), stabilisation(case, run)));
        figures.push(("frf-correlation".to_owned(), correlation(case, run)));
    }
    if run.measured.as_ref().is_some_and(|measured| !measured.pairing.pairs.is_empty()) {
        figures.push(("pairs".to_owned(), pairs(case, run)));
        if case.sensors.len() > 1 {
            figures.push(("mac".to_owned(), mac(case, run)));
        }
    }
    draw(figures)
}

/// √Σ|H_m|² of the sensors.
fn size(responses: &[c64]) -> f64 {
    responses.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt()
}

/// The measured responses with the fit and the model, above the poles of each order.
fn stabilisation(case: &Case, run: &ModesRun) -> Figure {
    let Some(measured) = &run.measured else { return Figure::default() };
    let x = &measured.band.frequency_hz;
    let rows = |rows: &[Vec<c64>]| rows.iter().map(|row| size(row)).collect::<Vec<_>>();
    let fitted = &measured.modes.fitted;
    let at_line = |k: usize| size(&fitted.iter().map(|own| own[k]).collect::<Vec<_>>());
    let of_fit = (0..measured.modes.frequency_hz.len()).map(at_line).collect();
    let mut series = vec![
        curve("measured", x, rows(&measured.band.receptance), Color::Black, Some(Dash::Solid), None),
        curve(
            "fit of the poles",
            &measured.modes.frequency_hz,
            of_fit,
            Color::Vermilion,
            Some(Dash::Dashed),
            None,
        ),
    ];
    if !measured.response.is_empty() {
        series.push(curve("model", x, rows(&measured.response), Color::Blue, Some(Dash::Dotted), None));
    }
    series.retain(|one| one.y.iter().any(|y| y.is_finite()));
    let poles = |label: &str, color, marker, wanted: &dyn Fn(&PoleAtOrder) -> bool| {
        let (x, y) = measured
            .modes
            .diagram
            .iter()
            .filter(|pole| wanted(pole))
            .map(|pole| (pole.frequency_hz(), pole.order as f64))
            .unzip::<f64, f64, Vec<f64>, Vec<f64>>();
        curve(label, &x, y, color, None, Some(marker))
    };
    let chosen: Vec<f64> = measured.modes.modes.iter().map(|mode| mode.frequency_hz()).collect();
    let top = measured.modes.diagram.iter().map(|pole| pole.order).max().unwrap_or(2) as f64 + 3.0;
    let mut orders = vec![
        poles("other", Color::Grey, Marker::Cross, &|pole| !pole.is_stable),
        poles("stable", Color::Blue, Marker::Circle, &|pole| pole.is_stable),
        curve("modes", &chosen, vec![top; chosen.len()], Color::Vermilion, None, Some(Marker::Triangle)),
    ];
    orders.retain(|one: &Series| !one.x.is_empty());
    Figure {
        title: title(case, "poles of the measurement"),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![
            Panel { y: Axis::log("Receptance of all sensors (m/N)"), series, ..Panel::default() },
            Panel { y: Axis::whole("Order"), series: orders, ..Panel::default() },
        ],
        size: (720.0, 620.0),
    }
}

/// CSAC and CSF over frequency.
fn correlation(case: &Case, run: &ModesRun) -> Figure {
    let Some(measured) = &run.measured else { return Figure::default() };
    let x = &measured.band.frequency_hz;
    let each = |label: &str, values: &[Option<f64>], color, dash| {
        curve(
            label,
            x,
            values.iter().map(|value| value.unwrap_or(f64::NAN)).collect(),
            color,
            Some(dash),
            None,
        )
    };
    let mut series = vec![
        each("CSAC, shape", &measured.csac, Color::Blue, Dash::Solid),
        each("CSF, shape and size", &measured.csf, Color::Vermilion, Dash::Dashed),
    ];
    series.retain(|one| one.y.iter().any(|y| y.is_finite()));
    Figure {
        title: title(case, "model and measurement, all sensors together"),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis { range: Some((0.0, 1.02)), ..Axis::linear("Correlation") },
            series,
            ..Panel::default()
        }],
        ..Figure::default()
    }
}

const NATURAL_FREQUENCY: &str = "Measured natural frequency (Hz)";

/// Differences of frequency, and damping of both, over frequency.
fn pairs(case: &Case, run: &ModesRun) -> Figure {
    let Some(measured) = &run.measured else { return Figure::default() };
    let pairs = &measured.pairing.pairs;
    let of_measured = || pairs.iter().map(|pair| &measured.modes.modes[pair.measured]);
    let of_model = || pairs.iter().map(|pair| &run.model.modes[pair.model]);
    let x: Vec<f64> = of_measured().map(|mode| mode.frequency_hz()).collect();
    let difference = pairs.iter().map(|pair| 100.0 * pair.frequency_difference).collect();
    let bars = |std: &dyn Fn(&frfit::modal::MeasuredMode) -> Option<f64>| -> Vec<f64> {
        of_measured().map(|mode| std(mode).map_or(f64::NAN, |std| 2.0 * 100.0 * std)).collect()
    };
    let frequency = Series {
        y_error: bars(&|mode| Some(mode.frequency_std_hz? / mode.frequency_hz())),
        ..curve("model over measurement, ±2 std", &x, difference, Color::Vermilion, None, Some(Marker::Disc))
    };
    let percent = |ratio: f64| if ratio > 0.0 { 100.0 * ratio } else { f64::NAN };
    let damping = Series {
        y_error: bars(&|mode| mode.damping_ratio_std),
        ..curve(
            "measured, ±2 std",
            &x,
            of_measured().map(|mode| percent(mode.damping_ratio())).collect(),
            Color::Black,
            None,
            Some(Marker::Disc),
        )
    };
    let own = curve(
        "model",
        &x,
        of_model().map(|mode| percent(mode.damping_ratio())).collect(),
        Color::Blue,
        None,
        Some(Marker::Square),
    );
    Figure {
        title: title(case, "pairs of modes"),
        x: Axis { range: Some((run.band_hz[0], run.band_hz[1])), ..Axis::linear(NATURAL_FREQUENCY) },
        panels: vec![
            Panel {
                y: Axis::linear("Frequency difference (%)"),
                series: vec![frequency],
                levels: vec![Level { label: String::new(), y: 0.0 }],
                ..Panel::default()
            },
            Panel { y: Axis::log("Damping ratio (%)"), series: vec![damping, own], ..Panel::default() },
        ],
        size: (720.0, 560.0),
    }
}

/// MAC of each mode of the model with each of the measurement.
fn mac(case: &Case, run: &ModesRun) -> Figure {
    let Some(measured) = &run.measured else { return Figure::default() };
    let shown: Vec<usize> = run.shown().filter(|&i| !run.model.modes[i].is_rigid_body()).collect();
    let residues: Vec<Vec<c64>> = shown.iter().map(|&i| run.model.modes[i].residues()).collect();
    let values = residues.iter().flat_map(|own| {
        measured.modes.modes.iter().map(move |mode| assurance(own, &mode.residues).unwrap_or(f64::NAN))
    });
    let name = |&i: &usize| format!("{} · {:.1} Hz", i + 1, run.model.modes[i].frequency_hz());
    Figure {
        title: title(case, "MAC of model (rows) and measurement"),
        x: Axis::whole("Mode of the measurement"),
        panels: vec![Panel {
            y: Axis::whole(""),
            heat: Some(HeatMap {
                x: (1..=measured.modes.modes.len()).map(|j| j as f64).collect(),
                y: (1..=shown.len()).map(|i| i as f64).collect(),
                values: values.collect(),
                label: "MAC".into(),
                range: Some((0.0, 1.0)),
                names: shown.iter().map(name).collect(),
            }),
            ..Panel::default()
        }],
        size: (720.0, 160.0 + 26.0 * shown.len() as f64),
    }
}
