//! Moduli and the laws that were fitted to them.

use super::draw;
use crate::output::File;
use crate::units::FactorUnit;
use frfit::laws::LawFit;
use frfit::material::loss_factor;
use frfit_figures::{Axis, Color, Dash, Figure, Marker, Panel, PngError, Series};
use frfit_formats::csv::ModulusData;

/// Laws that are drawn, the best ones: more curves cannot be distinguished.
const DRAWN: usize = 3;

/// Points of a curve.
const POINTS: usize = 400;

/// Decades from which on moduli are drawn over a logarithmic axis.
const WIDE: f64 = 10.0;

/// `figures/laws.*`: the data, the best laws, and two standard deviations about the best.
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
                series.push(line("± 2 standard deviations".into(), curve(2.0), Dash::Dotted));
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

/// E′ or η of a law at a frequency, so many standard deviations off; NaN where it has none.
fn part_of(fit: &LawFit, frequency_hz: f64, part: usize, deviations: f64) -> f64 {
    let Some(estimate) = fit.at(frequency_hz) else { return f64::NAN };
    let (value, std) = match part {
        0 => (estimate.modulus.re, estimate.storage_std),
        _ => (loss_factor(estimate.modulus), estimate.loss_factor_std),
    };
    if deviations == 0.0 { value } else { value + deviations * std.unwrap_or(f64::NAN) }
}
