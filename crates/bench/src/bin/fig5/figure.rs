//! Error against CPU time.

use crate::contest::{Contest, Run};
use frfit_figures::{Axis, Color, Figure, Marker, Panel, Series};

/// The paper's Fig. 5.
pub(crate) fn error_against_time(title: &str, contest: &Contest) -> Figure {
    let series = |label: String, runs: &[Run], color, marker| Series {
        label,
        x: runs.iter().map(|run| run.seconds).collect(),
        x_error: runs.iter().map(|run| run.deviation).collect(),
        y: runs.iter().map(|run| run.error).collect(),
        color,
        marker: Some(marker),
        ..Series::default()
    };
    let (orders, iterations) = (contest.series.len(), contest.nelder_mead.len());
    Figure {
        title: format!("{title}: mean and standard deviation"),
        x: Axis::log("CPU time (s)"),
        panels: vec![Panel {
            y: Axis::log("Error ε of the updated response"),
            series: vec![
                series(format!("series, orders 1–{orders}"), &contest.series, Color::Vermilion, Marker::Disc),
                series(
                    format!("Nelder–Mead, 1–{iterations} iterations"),
                    &contest.nelder_mead,
                    Color::Blue,
                    Marker::Square,
                ),
            ],
            ..Panel::default()
        }],
        ..Figure::default()
    }
}
