//! Storage modulus and loss factor over frequency: Figs 4 and 10.

use super::{status_strip, title};
use crate::load::{Case, IdentifyCase};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::identify::{Status, Uncertainty};
use frfit::material::loss_factor;
use frfit_figures::{Axis, Color, Dash, Figure, Marker, Panel, Series};

/// Half-length of an error bar in standard deviations: 95 of 100 truths are within.
pub(super) const DEVIATIONS: f64 = 2.0;

pub(super) fn figure(case: &Case, identify: &IdentifyCase, run: &IdentifyRun) -> Figure {
    let names = identify.unknowns[0].name.clone();
    let real = identify.unknowns[0].real;
    let mut panels = vec![Panel {
        strip: Some(status_strip(run)),
        ..panel(identify, run, "Real part of the factor", |e| e.re, |bars| Some(bars.storage_std))
    }];
    if !real {
        panels[0].y.label =
            panels[0].y.label.replace("Real part of the factor", &identify.units[0].storage_label());
        panels.push(panel(identify, run, "Loss factor η", loss_factor, |bars| bars.loss_factor_std));
    }
    Figure {
        title: title(case, &format!("identified factor of {names}")),
        x: Axis::linear("Frequency (Hz)"),
        panels,
        size: if real { (720.0, 460.0) } else { (720.0, 620.0) },
    }
}

fn panel(
    identify: &IdentifyCase,
    run: &IdentifyRun,
    label: &str,
    part: fn(c64) -> f64,
    std: fn(Uncertainty) -> Option<f64>,
) -> Panel {
    let x: Vec<f64> = run.found.lines.iter().map(|outcome| outcome.frequency_hz).collect();
    let of = |values: Vec<Option<c64>>| values.into_iter().map(|e| e.map_or(f64::NAN, part)).collect();
    let with = |status: &[Status]| {
        of(run.found.lines.iter().map(|o| status.contains(&o.status).then(|| o.factor()).flatten()).collect())
    };
    let mut series = vec![Series {
        label: "nominal".into(),
        y: of(run.found.lines.iter().map(|outcome| Some(outcome.nominal())).collect()),
        color: Color::Blue,
        line: Some(Dash::Dashed),
        ..Series::default()
    }];
    let bars: Vec<f64> = run
        .found
        .lines
        .iter()
        .map(|o| o.uncertainty().and_then(std).map_or(f64::NAN, |s| DEVIATIONS * s))
        .collect();
    // A diverged frequency has no answer: what its series ended on belongs into the table, not into a curve.
    let evidence = [Status::NotIdentifiable, Status::Unexplained, Status::Failed];
    for (label, statuses, color, marker) in [
        ("evidence only", &evidence[..], Color::Grey, Marker::Cross),
        ("updated, ambiguous", &[Status::Ambiguous], Color::Orange, Marker::Triangle),
        ("updated", &[Status::Ok], Color::Vermilion, Marker::Circle),
    ] {
        let y: Vec<f64> = with(statuses);
        if y.iter().any(|y| y.is_finite()) {
            // The bars of what is not known would hide what is, and stretch the axis with it.
            let y_error = if color == Color::Grey { Vec::new() } else { bars.clone() };
            let (label, marker) = (label.into(), Some(marker));
            series.push(Series { label, y, y_error, color, line: None, marker, ..Series::default() });
        }
    }
    // Above the others: a line shows among many markers, and would not below them.
    if let Some(reference) = &identify.reference[0] {
        series.push(Series {
            label: "true".into(),
            y: of(x.iter().map(|&f| reference.at(f).ok()).collect()),
            color: Color::Black,
            ..Series::default()
        });
    }
    for one in &mut series {
        one.x = x.clone();
    }
    let shown = run.found.lines.iter().any(|o| o.status == Status::Ok && o.uncertainty().is_some());
    let label = if shown { format!("{label}, ±2 std") } else { label.to_owned() };
    Panel { y: Axis { range: range_of_answers(&series), ..Axis::linear(label) }, series, ..Panel::default() }
}

/// Least and greatest of what is drawn, error bars included, if some of it is evidence only, which may be anywhere; `None`, for all of it, where there is no
/// such evidence, or nothing else.
fn range_of_answers(series: &[Series]) -> Option<(f64, f64)> {
    let is_evidence = |one: &Series| one.color == Color::Grey;
    if !series.iter().any(is_evidence) {
        return None;
    }
    let ends = series.iter().filter(|one| !is_evidence(one)).flat_map(|one| {
        one.y.iter().enumerate().flat_map(|(i, y)| {
            let bar = one.y_error.get(i).copied().filter(|bar| bar.is_finite()).unwrap_or(0.0);
            [y - bar, y + bar]
        })
    });
    let (low, high) = ends
        .filter(|y| y.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    let margin = 0.05 * (high - low);
    (low < high).then_some((low - margin, high + margin))
}
