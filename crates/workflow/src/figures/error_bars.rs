//! What the error bars consist of: noise, errors of the model, known factors.

use super::{curve, title};
use crate::load::{Case, IdentifyCase};
use crate::run::IdentifyRun;
use frfit::identify::{Contributions, Line};
use frfit_figures::{Axis, Color, Dash, Figure, Panel};

/// Of one of the unknowns, relative to its storage modulus or value.
pub(super) fn figure(case: &Case, identify: &IdentifyCase, run: &IdentifyRun, j: usize) -> Figure {
    let lines = &run.found.lines;
    let x: Vec<f64> = lines.iter().map(|line| line.frequency_hz).collect();
    let over_value = |of: &dyn Fn(&Contributions) -> f64| -> Vec<f64> {
        let at = |line: &Line| {
            let std = of(&line.values[j].uncertainty?.contributions) / line.values[j].storage()?.abs();
            // A logarithmic axis has no zero.
            Some(std).filter(|std| *std > 0.0)
        };
        lines.iter().map(|line| at(line).unwrap_or(f64::NAN)).collect()
    };
    let part = |name: &str, of: fn(&Contributions) -> f64, color: Color, dash: Dash| {
        curve(name, &x, over_value(&of), color, Some(dash), None)
    };
    let series = vec![
        part("whole", Contributions::whole, Color::Black, Dash::Dotted),
        part("noise", |of| of.noise, Color::Blue, Dash::Solid),
        part("errors of the model", |of| of.model, Color::Vermilion, Dash::Solid),
        part("known factors", |of| of.known_factors, Color::Green, Dash::Dashed),
    ];
    let name = match identify.unknowns.len() {
        1 => "what the error bars consist of".to_owned(),
        _ => format!("what the error bars of {} consist of", identify.unknowns[j].name),
    };
    Figure {
        title: title(case, &name),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel { y: Axis::log("Standard deviation, relative"), series, ..Panel::default() }],
        ..Figure::default()
    }
}
