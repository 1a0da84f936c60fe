//! Moduli and the laws that were fitted to them.

use super::{draw, status_strip, title};
use crate::load::{Case, IdentifyCase};
use crate::output::File;
use crate::run::IdentifyRun;
use crate::units::FactorUnit;
use frfit::c64;
use frfit::identify::{Line, Status};
use frfit::laws::LawFit;
use frfit::material::loss_factor;
use frfit_figures::{Axis, Color, Dash, Figure, Marker, Panel, PngError, Series};
use frfit_formats::csv::ModulusData;

/// Laws that are drawn, the best ones: more cannot be told apart.
const DRAWN: usize = 3;

/// Points of a curve.
const POINTS: usize = 400;

/// Decades from which on moduli are drawn over a logarithmic axis.
const WIDE: f64 = 10.0;

/// `figures/laws.*`: the data, the best laws, and two deviations about the best.
///
/// # Errors
/// [`PngError`] where a figure cannot be rasterised.
pub fn law_figures(
    title: &str,
    data: &ModulusData,
    fits: &[LawFit],
    of: FactorUnit,
) -> Result<Vec<File>, PngError> {
    let (first, last) = (data.frequency_hz[0], data.frequency_hz[data.frequency_hz.len() - 1]);
    let at = |k: usize| first * (last / first).powf(k as f64 / (POINTS - 1) as f64);
    let x: Vec<f64> = (0..POINTS).map(at).collect();
    let std = |part: usize| {
        let of = |std: &Vec<[f64; 2]>| std.iter().map(|std| std[part]).collect();
        data.std.as_ref().map_or(Vec::new(), of)
    };
    let mut best: Vec<&LawFit> = fits.iter().collect();
    best.sort_by(|a, b| a.bic().total_cmp(&b.bic()));
    best.truncate(DRAWN);
    let panel = |y: Axis, values: &[f64], part: usize| {
        let mut series = vec![Series {
            label: "data".into(),
            x: data.frequency_hz.clone(),
            y: values.to_vec(),
            y_error: std(part),
            color: Color::Blue,
            line: None,
            marker: Some(Marker::Circle),
            ..Series::default()
        }];
        let styles =
            [(Color::Vermilion, Dash::Solid), (Color::Green, Dash::Dashed), (Color::Purple, Dash::DashDot)];
        for (k, (fit, (color, dash))) in best.iter().zip(styles).enumerate().rev() {
            let curve = |by: f64| x.iter().map(|&f| part_of(fit, f, part, by)).collect();
            let line = |label: String, y, dash| Series {
                label,
                x: x.clone(),
                y,
                color,
                line: Some(dash),
                ..Series::default()
            };
            series.push(line(fit.kind.to_string(), curve(0.0), dash));
            if k == 0 {
                series.push(line("± 2 deviations".into(), curve(2.0), Dash::Dotted));
                series.push(line(String::new(), curve(-2.0), Dash::Dotted));
            }
        }
        Panel { y, series, ..Panel::default() }
    };
    let extent = |f: fn(f64, f64) -> f64| data.storage.iter().copied().reduce(f).unwrap_or(1.0);
    let wide = extent(f64::max) > WIDE * extent(f64::min);
    let storage = of.storage_label();
    let figure = Figure {
        title: title.to_owned(),
        x: if last > WIDE * first { Axis::log("Frequency (Hz)") } else { Axis::linear("Frequency (Hz)") },
        panels: vec![
            panel(if wide { Axis::log(storage) } else { Axis::linear(storage) }, &data.storage, 0),
            panel(Axis::linear("Loss factor η"), &data.loss_factor, 1),
        ],
        size: (720.0, 620.0),
    };
    draw(vec![("laws".to_owned(), figure)])
}

/// The best law of a band, two deviations about it, and what each frequency says by itself.
pub(super) fn of_band(
    case: &Case,
    identify: &IdentifyCase,
    run: &IdentifyRun,
    free: &[Line],
    law: &LawFit,
) -> Figure {
    let curve = Drawn {
        what: "law",
        label: law.kind.to_string(),
        at: &|i, part, by| part_of(law, run.found.lines[i].frequency_hz, part, by),
    };
    curve_of_band(case, identify, run, free, &curve)
}

/// The smooth modulus of a band in the same way.
pub(super) fn smooth_of_band(
    case: &Case,
    identify: &IdentifyCase,
    run: &IdentifyRun,
    free: &[Line],
) -> Figure {
    let at = |i: usize, part: usize, by: f64| {
        let outcome = &run.found.lines[i];
        let Some((factor, bars)) = outcome.factor().zip(outcome.uncertainty()) else { return f64::NAN };
        match part {
            0 => factor.re + by * bars.storage_std,
            _ => loss_factor(factor) + by * bars.loss_factor_std.unwrap_or(f64::NAN),
        }
    };
    let curve = Drawn { what: "smooth modulus", label: "smooth".into(), at: &at };
    curve_of_band(case, identify, run, free, &curve)
}

/// A curve through a band.
struct Drawn<'d> {
    /// What the figure shows of the factor.
    what: &'d str,
    label: String,
    /// E′ (0) or η (1) at a frequency, so many deviations off; NaN where there is none.
    at: &'d dyn Fn(usize, usize, f64) -> f64,
}

fn curve_of_band(
    case: &Case,
    identify: &IdentifyCase,
    run: &IdentifyRun,
    free: &[Line],
    drawn: &Drawn<'_>,
) -> Figure {
    let x: Vec<f64> = run.found.lines.iter().map(|outcome| outcome.frequency_hz).collect();
    let parts: [fn(c64) -> f64; 2] = [|e| e.re, loss_factor];
    let panel = |label: &str, part: usize| {
        let of = |factor: Option<c64>| factor.map_or(f64::NAN, parts[part]);
        let series = |label, y, color, line, marker| super::curve(label, &x, y, color, line, marker);
        let own = |outcome: &Line| outcome.factor().filter(|_| outcome.status == Status::Ok);
        let own = free.iter().map(|outcome| of(own(outcome))).collect();
        let nominal = run.found.lines.iter().map(|outcome| of(Some(outcome.nominal()))).collect();
        let curve = |by: f64| (0..x.len()).map(|i| (drawn.at)(i, part, by)).collect();
        let mut all = vec![
            series("nominal", nominal, Color::Blue, Some(Dash::Dashed), None),
            series("each frequency by itself", own, Color::Grey, None, Some(Marker::Circle)),
        ];
        if let Some(reference) = &identify.reference[0] {
            let reference = x.iter().map(|&f| of(reference.at(f).ok())).collect();
            all.push(series("true", reference, Color::Black, Some(Dash::Solid), None));
        }
        all.push(series(&drawn.label, curve(0.0), Color::Vermilion, Some(Dash::Solid), None));
        all.push(series("± 2 deviations", curve(2.0), Color::Vermilion, Some(Dash::Dotted), None));
        all.push(series("", curve(-2.0), Color::Vermilion, Some(Dash::Dotted), None));
        Panel { y: Axis::linear(label), series: all, ..Panel::default() }
    };
    let real = identify.unknowns[0].real;
    let first = if real { "Real part of the factor".to_owned() } else { identify.units[0].storage_label() };
    let mut panels = vec![Panel { strip: Some(status_strip(run)), ..panel(&first, 0) }];
    if !real {
        panels.push(panel("Loss factor η", 1));
    }
    Figure {
        title: title(case, &format!("{} of the factor of {}", drawn.what, identify.unknowns[0].name)),
        x: Axis::linear("Frequency (Hz)"),
        panels,
        size: if real { (720.0, 460.0) } else { (720.0, 620.0) },
    }
}

/// E′ or η of a law at a frequency, so many deviations off; NaN where it has none.
fn part_of(fit: &LawFit, frequency_hz: f64, part: usize, deviations: f64) -> f64 {
    let Some(estimate) = fit.at(frequency_hz) else { return f64::NAN };
    let (value, std) = match part {
        0 => (estimate.modulus.re, estimate.storage_std),
        _ => (loss_factor(estimate.modulus), estimate.loss_factor_std),
    };
    if deviations == 0.0 { value } else { value + deviations * std.unwrap_or(f64::NAN) }
}
