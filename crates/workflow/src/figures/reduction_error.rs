//! How good the subspace is at the answers.

use super::{status_strip, title};
use crate::load::Case;
use crate::run::IdentifyRun;
use frfit_figures::{Axis, Color, Figure, Panel, Series};

pub(super) fn figure(case: &Case, run: &IdentifyRun) -> Figure {
    Figure {
        title: title(case, "estimated error of the reduced model at the answers"),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::log("Error of the response at the sensors, relative"),
            series: vec![Series {
                x: run.found.lines.iter().map(|line| line.frequency_hz).collect(),
                y: run.found.lines.iter().map(|line| line.reduction_error.unwrap_or(f64::NAN)).collect(),
                color: Color::Blue,
                ..Series::default()
            }],
            strip: Some(status_strip(run)),
            ..Panel::default()
        }],
        ..Figure::default()
    }
}
