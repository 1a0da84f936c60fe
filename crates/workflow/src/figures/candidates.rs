//! Every solution over frequency, and the path that was chosen through them.

use super::{status_strip, title};
use crate::load::{Case, IdentifyCase};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::identify::Line;
use frfit::material::loss_factor;
use frfit::roots::Candidate;
use frfit_figures::{Axis, Color, Figure, Marker, Panel, Series};

pub(super) fn figure(case: &Case, identify: &IdentifyCase, run: &IdentifyRun) -> Figure {
    let panel = |y: Axis, part: fn(c64) -> f64| Panel {
        y,
        series: vec![
            scatter("other solutions", run, Color::Grey, part, |outcome, root| {
                outcome.correction() != Some(root.correction) && !outcome.is_rival(root)
            }),
            scatter("alternatives", run, Color::Orange, part, |outcome, root| outcome.is_rival(root)),
            Series {
                label: "chosen".into(),
                x: run.found.lines.iter().map(|outcome| outcome.frequency_hz).collect(),
                y: run.found.lines.iter().map(|outcome| outcome.factor().map_or(f64::NAN, part)).collect(),
                color: Color::Blue,
                ..Series::default()
            },
        ]
        .into_iter()
        .filter(|series| !series.x.is_empty())
        .collect(),
        ..Panel::default()
    };
    Figure {
        title: title(case, "all solutions, and the one that was chosen"),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![
            Panel {
                strip: Some(status_strip(run)),
                ..panel(Axis::log(identify.units[0].storage_label()), |factor| factor.re)
            },
            panel(Axis::linear("Loss factor η"), loss_factor),
        ],
        size: (720.0, 620.0),
    }
}

/// The admissible candidates of a kind.
fn scatter(
    label: &str,
    run: &IdentifyRun,
    color: Color,
    part: fn(c64) -> f64,
    kind: impl Fn(&Line, &Candidate) -> bool,
) -> Series {
    let points = run.found.lines.iter().flat_map(|outcome| {
        let admitted = outcome.roots.iter().filter(|root| root.refusal.is_none());
        let wanted = admitted.filter(|root| kind(outcome, root));
        wanted
            .map(|root| (outcome.frequency_hz, part(outcome.nominal() + root.correction)))
            .collect::<Vec<_>>()
    });
    let (x, y) = points.unzip();
    Series { label: label.into(), x, y, color, line: None, marker: Some(Marker::Circle), ..Series::default() }
}
