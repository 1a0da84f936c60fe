//! |∂ln x/∂ln p| over frequency, a row for each parameter.

use super::{draw, title};
use crate::load::Case;
use crate::output::File;
use crate::sensitivities::SensitivityRun;
use frfit_figures::{Axis, Figure, HeatMap, Panel, PngError};

/// Below this nothing is seen of a parameter at any noise: the colours are spent on what is.
const FLOOR: f64 = 1e-4;

/// Height of the figure beside its rows, and of each.
const HEIGHT: (f64, f64) = (140.0, 28.0);

/// The heat map of sensitivities, as SVG and PNG.
///
/// # Errors
/// [`PngError`] where it cannot be rasterised.
pub fn sensitivity_figure(case: &Case, run: &SensitivityRun) -> Result<Vec<File>, PngError> {
    // The largest on top.
    let rows: Vec<usize> = run.ranking.iter().rev().map(|ranking| ranking.variable).collect();
    let rms = |i: usize, p: usize| {
        let values: Vec<f64> = run.values[i][p].iter().flatten().map(|(value, _)| value.norm_sqr()).collect();
        (values.iter().sum::<f64>() / values.len() as f64).sqrt()
    };
    // NaN, where there is no answer, stays one: a grey cell.
    let log = |value: f64| if value < FLOOR { FLOOR.log10() } else { value.log10() };
    let values = rows.iter().flat_map(|&p| (0..run.frequency_hz.len()).map(move |i| log(rms(i, p))));
    let figure = Figure {
        title: title(case, "sensitivities, rms over the sensors"),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::whole(""),
            heat: Some(HeatMap {
                x: run.frequency_hz.clone(),
                y: (1..=rows.len()).map(|k| k as f64).collect(),
                values: values.collect(),
                label: "log₁₀ |∂ln x/∂ln p|".into(),
                range: None,
                names: rows.iter().map(|&p| run.variables[p].name.clone()).collect(),
            }),
            ..Panel::default()
        }],
        size: (720.0, HEIGHT.0 + HEIGHT.1 * rows.len() as f64),
    };
    draw(vec![("sensitivities".to_owned(), figure)])
}
