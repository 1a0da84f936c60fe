//! ρ(−c A₀⁻¹A₁) over frequency: Figs 9 and 13.

use super::{status_strip, title};
use crate::load::Case;
use crate::run::IdentifyRun;
use frfit::frequency::bands_hz;
use frfit_figures::{Axis, Bands, Color, Figure, Level, Panel, Series};

pub(super) fn figure(case: &Case, run: &IdentifyRun) -> Figure {
    let at = |line: &frfit::identify::Line| line.spectral_radius.unwrap_or(f64::NAN);
    // Beside the nearest pole ρ is in the hundreds: on a linear axis nothing else would be seen.
    let largest = run.found.lines.iter().map(at).fold(0.0, f64::max);
    let axis = if largest > 10.0 { Axis::log } else { Axis::linear };
    let above = bands_hz(run.found.lines.iter().map(|line| (line.frequency_hz, at(line) >= 1.0)));
    Figure {
        title: title(case, "spectral radius at the correction"),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: axis("Spectral radius ρ(−c A₀⁻¹A₁)"),
            series: vec![Series {
                x: run.found.lines.iter().map(|line| line.frequency_hz).collect(),
                y: run.found.lines.iter().map(at).collect(),
                color: Color::Blue,
                ..Series::default()
            }],
            bands: match above[..] {
                [] => Vec::new(),
                _ => vec![Bands {
                    label: "series diverges (ρ ≥ 1)".into(),
                    color: Color::Vermilion,
                    ranges: above.into_iter().map(|[first, last]| (first, last)).collect(),
                }],
            },
            levels: vec![Level { label: String::new(), y: 1.0 }],
            strip: Some(status_strip(run)),
            ..Panel::default()
        }],
        ..Figure::default()
    }
}
