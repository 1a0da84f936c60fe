//! Storage modulus and loss factor of an unknown over frequency: Figs 4 and 10.

use super::{status_strip, title};
use crate::load::{Case, IdentifyCase};
use crate::run::IdentifyRun;
use frfit::c64;
use frfit::identify::{Line, Status, Trust, Uncertainty, Variation};
use frfit::laws::best;
use frfit::material::loss_factor;
use frfit_figures::{Axis, Color, Dash, Figure, Marker, Panel, Series};

/// Half-length of an error bar in standard deviations: 95 of 100 truths are within.
const BAND_STDS: f64 = 2.0;

/// The j-th unknown over frequency: points where each frequency has a value of its own, else a curve.
pub(super) fn figure(case: &Case, identify: &IdentifyCase, run: &IdentifyRun, j: usize) -> Figure {
    let one = &identify.unknowns[j];
    let panel = |label: &str, part: Part| match one.varies {
        Variation::PerFrequency => points(identify, run, j, label, part),
        _ => curve_of_band(identify, run, j, label, part),
    };
    let first =
        if one.real { "Real part of the factor".to_owned() } else { identify.units[j].storage_label() };
    let mut panels = vec![Panel { strip: Some(status_strip(run)), ..panel(&first, STORAGE) }];
    if !one.real {
        panels.push(panel("Loss factor η", LOSS_FACTOR));
    }
    let what = match one.varies {
        Variation::PerFrequency => "identified factor",
        Variation::Smooth => "smooth modulus of the factor",
        _ => "law of the factor",
    };
    Figure {
        title: title(case, &format!("{what} of {}", one.name)),
        x: Axis::linear("Frequency (Hz)"),
        panels,
        size: if one.real { (720.0, 460.0) } else { (720.0, 620.0) },
    }
}

/// A part of a factor, and its standard deviation.
#[derive(Clone, Copy)]
struct Part {
    of: fn(c64) -> f64,
    std: fn(Uncertainty) -> Option<f64>,
}

const STORAGE: Part = Part { of: |factor| factor.re, std: |bars| Some(bars.storage_std) };
const LOSS_FACTOR: Part = Part { of: loss_factor, std: |bars| bars.loss_factor_std };

impl Part {
    /// NaN where there is no factor.
    fn each(self, factors: impl Iterator<Item = Option<c64>>) -> Vec<f64> {
        factors.map(|factor| factor.map_or(f64::NAN, self.of)).collect()
    }

    /// Half-lengths of the error bars of the j-th unknown; NaN where it has none.
    fn bars(self, run: &IdentifyRun, j: usize) -> Vec<f64> {
        let of = |line: &Line| line.values[j].uncertainty.and_then(self.std);
        run.found.lines.iter().map(|line| of(line).map_or(f64::NAN, |std| BAND_STDS * std)).collect()
    }
}

/// A law or a smooth curve through the band, two standard deviations about it, and the values of each frequency alone.
fn curve_of_band(identify: &IdentifyCase, run: &IdentifyRun, j: usize, label: &str, part: Part) -> Panel {
    let found = &run.found;
    let x: Vec<f64> = found.lines.iter().map(|line| line.frequency_hz).collect();
    let series = |label, y, color, line, marker| super::curve(label, &x, y, color, line, marker);
    // A law has a value at frequencies that were left out too.
    let law = found.constants.iter().find(|value| value.unknowns == j).map(|value| &value.law);
    let value = |line: &Line| law.and_then(|law| law.at(line.frequency_hz).ok()).or(line.values[j].value);
    let curve = part.each(found.lines.iter().map(value));
    let bars = part.bars(run, j);
    let edge = |by: f64| curve.iter().zip(&bars).map(|(y, bar)| y + by * bar).collect();
    let own = |line: &Line| line.values[j].value.filter(|_| line.status == Status::Ok);
    let nominal = part.each(found.lines.iter().map(|line| Some(line.values[j].nominal)));
    let mut all = vec![series("nominal", nominal, Color::Blue, Some(Dash::Dashed), None)];
    if !found.free.is_empty() {
        let own = part.each(found.free.iter().map(own));
        all.push(series("each frequency alone", own, Color::Grey, None, Some(Marker::Circle)));
    }
    if let Some(reference) = &identify.reference[j] {
        let reference = part.each(x.iter().map(|&f| reference.at(f).ok()));
        all.push(series("true", reference, Color::Black, Some(Dash::Solid), None));
    }
    let name = best(&found.laws).map_or(identify.varies(j).to_owned(), |law| law.kind.to_string());
    all.push(series(&name, curve.clone(), Color::Vermilion, Some(Dash::Solid), None));
    all.push(series("± 2 standard deviations", edge(1.0), Color::Vermilion, Some(Dash::Dotted), None));
    all.push(series("", edge(-1.0), Color::Vermilion, Some(Dash::Dotted), None));
    Panel { y: Axis::linear(label), series: all, ..Panel::default() }
}

/// The value at each frequency with its bar, by what it is good for.
fn points(identify: &IdentifyCase, run: &IdentifyRun, j: usize, label: &str, part: Part) -> Panel {
    let lines = &run.found.lines;
    let x: Vec<f64> = lines.iter().map(|line| line.frequency_hz).collect();
    let with = |trust: Trust| {
        part.each(lines.iter().map(|line| line.values[j].value.filter(|_| line.status.trust() == trust)))
    };
    let mut series = vec![Series {
        label: "nominal".into(),
        y: part.each(lines.iter().map(|line| Some(line.values[j].nominal))),
        color: Color::Blue,
        line: Some(Dash::Dashed),
        ..Series::default()
    }];
    let bars = part.bars(run, j);
    for (label, trust, color, marker) in [
        ("evidence only", Trust::EvidenceOnly, Color::Grey, Marker::Cross),
        ("updated, ambiguous", Trust::Ambiguous, Color::Orange, Marker::Triangle),
        ("updated", Trust::Trusted, Color::Vermilion, Marker::Circle),
    ] {
        let y = with(trust);
        if y.iter().any(|y| y.is_finite()) {
            // The bars of what is not known would hide what is, and stretch the axis with it.
            let y_error = if color == Color::Grey { Vec::new() } else { bars.clone() };
            let (label, marker) = (label.into(), Some(marker));
            series.push(Series { label, y, y_error, color, line: None, marker, ..Series::default() });
        }
    }
    // Above the others: a line shows among many markers, and would not below them.
    if let Some(reference) = &identify.reference[j] {
        series.push(Series {
            label: "true".into(),
            y: part.each(x.iter().map(|&f| reference.at(f).ok())),
            color: Color::Black,
            ..Series::default()
        });
    }
    for one in &mut series {
        one.x = x.clone();
    }
    let shown = lines.iter().any(|line| line.status == Status::Ok && line.values[j].uncertainty.is_some());
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
