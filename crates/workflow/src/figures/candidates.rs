//! Every solution over frequency, and the path that was chosen through them.

use super::{curve, status_strip, title};
use crate::load::{Case, IdentifyCase};
use crate::output::{Solution, solutions};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::material::loss_factor;
use frfit_figures::{Axis, Color, Dash, Figure, Marker, Panel, Series};

/// Solutions of the j-th unknown.
pub(super) fn figure(case: &Case, identify: &IdentifyCase, run: &IdentifyRun, j: usize) -> Figure {
    let lines = &run.found.lines;
    let x: Vec<f64> = lines.iter().map(|line| line.frequency_hz).collect();
    let panel = |y: Axis, part: fn(c64) -> f64| {
        let chosen = lines.iter().map(|line| line.values[j].value.map_or(f64::NAN, part)).collect();
        let series = [
            scatter("other solutions", run, Color::Grey, j, part, |of| of.verdict == "admissible"),
            scatter("alternatives", run, Color::Orange, j, part, |of| of.verdict == "alternative"),
            curve("chosen", &x, chosen, Color::Blue, Some(Dash::Solid), None),
        ];
        Panel { y, series: series.into_iter().filter(|one| !one.x.is_empty()).collect(), ..Panel::default() }
    };
    let of = if identify.unknowns.len() == 1 {
        String::new()
    } else {
        format!(" of {}", identify.unknowns[j].name)
    };
    Figure {
        title: title(case, &format!("all solutions{of}, and the one that was chosen")),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![
            Panel {
                strip: Some(status_strip(run)),
                ..panel(Axis::log(identify.units[j].storage_label()), |factor| factor.re)
            },
            panel(Axis::linear("Loss factor η"), loss_factor),
        ],
        size: (720.0, 620.0),
    }
}

/// The solutions of a kind.
fn scatter(
    label: &str,
    run: &IdentifyRun,
    color: Color,
    j: usize,
    part: fn(c64) -> f64,
    kind: impl Fn(&Solution) -> bool,
) -> Series {
    let points = run.found.lines.iter().flat_map(|line| {
        let wanted = solutions(line).into_iter().filter(|solution| kind(solution));
        wanted.map(|solution| (line.frequency_hz, part(solution.value(line, j)))).collect::<Vec<_>>()
    });
    let (x, y) = points.unzip::<f64, f64, Vec<f64>, Vec<f64>>();
    curve(label, &x, y, color, None, Some(Marker::Circle))
}
