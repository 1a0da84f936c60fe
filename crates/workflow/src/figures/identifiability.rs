//! How well the numbers that hold for the band are identifiable: their correlation, and χ² along the least identifiable direction.

use super::{curve, title};
use crate::load::{Case, IdentifyCase};
use crate::output::coordinate;
use crate::run::IdentifyRun;
use frfit::identify::Profile;
use frfit_figures::{Axis, Color, Dash, Figure, HeatMap, Marker, Panel};

/// Width and height of the correlation beside its cells, and of each cell.
const AROUND: (f64, f64) = (330.0, 130.0);
const CELL: f64 = 56.0;

/// Correlation of the numbers that hold for the band, in the order of the summary's `coordinates`, the first on top.
pub(super) fn correlation(case: &Case, identify: &IdentifyCase, run: &IdentifyRun) -> Figure {
    let found = &run.found;
    let count = found.identifiability.correlation.len();
    let numbers: Vec<f64> = (1..=count).map(|k| k as f64).collect();
    let names = (0..count).rev().map(|c| format!("{} {}", c + 1, coordinate(identify, found, c)));
    Figure {
        title: title(case, "correlation of the values for the band"),
        x: Axis::whole("Number, as on the left"),
        panels: vec![Panel {
            y: Axis::whole(""),
            heat: Some(HeatMap {
                x: numbers.clone(),
                y: numbers,
                values: found.identifiability.correlation.iter().rev().flatten().copied().collect(),
                label: "Correlation".into(),
                range: Some((-1.0, 1.0)),
                names: names.collect(),
            }),
            ..Panel::default()
        }],
        size: (AROUND.0 + CELL * count as f64, AROUND.1 + CELL * count as f64),
    }
}

/// χ² along the least identifiable direction, beside the parabola of its error bar.
pub(super) fn profile(case: &Case, run: &IdentifyRun, profile: &Profile) -> Figure {
    let (x, y): (Vec<f64>, Vec<f64>) = profile.points.iter().copied().unzip();
    let std = run.found.identifiability.directions.first().map_or(f64::INFINITY, |least| least.std);
    let parabola = x.iter().map(|t| (t / std).powi(2)).collect();
    let series = |label, y, color, line, marker| curve(label, &x, y, color, line, marker);
    Figure {
        title: title(case, "misfit along the least identifiable direction"),
        x: Axis::linear("Distance from the answer (1 is a factor of e)"),
        panels: vec![Panel {
            y: Axis::linear("Δχ²"),
            series: vec![
                series("all else at its best", y, Color::Vermilion, Some(Dash::Solid), Some(Marker::Circle)),
                series("as the error bar has it", parabola, Color::Grey, Some(Dash::Dashed), None),
            ],
            ..Panel::default()
        }],
        ..Figure::default()
    }
}
