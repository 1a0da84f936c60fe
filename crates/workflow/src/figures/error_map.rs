//! log₁₀ ε over frequency and order: Figs 3, 8 and 12.

use super::title;
use crate::load::Case;
use crate::run::ErrorMap;
use frfit_figures::{Axis, Figure, HeatMap, Panel};

/// Errors below this are roundoff: the colours are spent on errors that differ.
const FLOOR: f64 = 1e-16;

pub(super) fn figure(case: &Case, map: &ErrorMap) -> Figure {
    let orders = map.error.iter().map(Vec::len).max().unwrap_or(0);
    let log = |error: Option<f64>| error.map_or(f64::NAN, |e| e.max(FLOOR).log10());
    let values =
        (0..orders).flat_map(|k| map.error.iter().map(move |column| log(column.get(k).copied().flatten())));
    Figure {
        title: title(case, "error of the updated response"),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::whole("Order n of the series"),
            heat: Some(HeatMap {
                x: map.frequency_hz.clone(),
                y: (1..=orders).map(|k| k as f64).collect(),
                values: values.collect(),
                label: "log₁₀ ε".into(),
                range: None,
                names: Vec::new(),
            }),
            ..Panel::default()
        }],
        ..Figure::default()
    }
}
