//! Storage modulus and loss factor over frequency: Figs 4 and 10.

use super::{status_strip, title};
use crate::load::{Case, IdentifyCase};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::identify::Status;
use frfit::material::loss_factor;
use frfit_figures::{Axis, Color, Dash, Figure, Marker, Panel, Series};

pub(super) fn figure(case: &Case, identify: &IdentifyCase, run: &IdentifyRun) -> Figure {
    let names = identify.names.join(", ");
    let real = identify.options.real;
    let mut panels = vec![Panel {
        strip: Some(status_strip(run)),
        ..panel(identify, run, "Real part of the factor", |e| e.re)
    }];
    if !real {
        panels[0].y.label = "Storage modulus E′ (Pa)".into();
        panels.push(panel(identify, run, "Loss factor η", loss_factor));
    }
    Figure {
        title: title(case, &format!("identified factor of {names}")),
        x: Axis::linear("Frequency (Hz)"),
        panels,
        size: if real { (720.0, 460.0) } else { (720.0, 620.0) },
    }
}

fn panel(identify: &IdentifyCase, run: &IdentifyRun, label: &str, part: fn(c64) -> f64) -> Panel {
    let x: Vec<f64> = run.outcomes.iter().map(|outcome| outcome.frequency_hz).collect();
    let of = |values: Vec<Option<c64>>| values.into_iter().map(|e| e.map_or(f64::NAN, part)).collect();
    let with = |status: &[Status]| {
        of(run.outcomes.iter().map(|o| status.contains(&o.status).then(|| o.factor()).flatten()).collect())
    };
    let mut series = vec![Series {
        label: "nominal".into(),
        y: of(run.outcomes.iter().map(|outcome| Some(outcome.nominal)).collect()),
        color: Color::Blue,
        line: Some(Dash::Dashed),
        ..Series::default()
    }];
    if let Some(truth) = &identify.truth {
        series.push(Series {
            label: "true".into(),
            y: of(x.iter().map(|&f| truth.at(f).ok()).collect()),
            color: Color::Black,
            ..Series::default()
        });
    }
    // A diverged frequency has no answer: what its series ended on belongs into the table, not into a curve.
    for (label, status, color, marker) in [
        ("updated, ambiguous", Status::Ambiguous, Color::Orange, Marker::Triangle),
        ("updated", Status::Ok, Color::Vermilion, Marker::Circle),
    ] {
        let y: Vec<f64> = with(&[status]);
        if y.iter().any(|y| y.is_finite()) {
            let (label, marker) = (label.into(), Some(marker));
            series.push(Series { label, y, color, line: None, marker, ..Series::default() });
        }
    }
    for one in &mut series {
        one.x = x.clone();
    }
    Panel { y: Axis::linear(label), series, ..Panel::default() }
}
