//! Spectra and FRFs of a hammer test.

use crate::records::Records;
use frfit::signal::Measured;
use frfit_figures::{Axis, Color, Dash, Figure, Panel, Series};

/// Bins of a curve of many points: twice as many as a figure has pixels across, so that nothing is seen to be missing.
const BINS: usize = 1500;

/// The smallest and the largest value of each of many bins, where they stand; all points where there are few.
pub(super) fn thinned(x: &[f64], y: &[f64]) -> (Vec<f64>, Vec<f64>) {
    if x.len() <= 2 * BINS {
        return (x.to_vec(), y.to_vec());
    }
    let mut kept: Vec<usize> = Vec::with_capacity(2 * BINS);
    for bin in 0..BINS {
        let range = bin * y.len() / BINS..(bin + 1) * y.len() / BINS;
        let by_value = |a: &usize, b: &usize| y[*a].total_cmp(&y[*b]);
        let (low, high) = (range.clone().min_by(by_value), range.max_by(by_value));
        let mut ends: Vec<usize> = low.into_iter().chain(high).collect();
        ends.sort_unstable();
        ends.dedup();
        kept.extend(ends);
    }
    let of = |values: &[f64]| kept.iter().map(|&k| values[k]).collect();
    (of(x), of(y))
}

fn curve(label: &str, measured: &Measured, y: Vec<f64>, color: Color) -> Series {
    let (x, y) = thinned(&measured.frequency_hz, &y);
    Series { label: label.into(), x, y, color, ..Series::default() }
}

/// Root mean squares over the impacts of the transforms of force and responses.
pub(super) fn spectra(records: &Records, measured: &Measured) -> Figure {
    let force = curve("", measured, measured.force.clone(), Color::Black);
    let mut panels = vec![Panel { y: Axis::log("Force (N·s)"), series: vec![force], ..Panel::default() }];
    for (sensor, frf) in records.responses.iter().zip(&measured.frfs) {
        let values = frf.gain.iter().zip(&measured.force).map(|(gain, force)| gain * force).collect();
        panels.push(Panel {
            y: Axis::log(format!("{} ({}·s)", sensor.name, sensor.kind.unit())),
            series: vec![curve("", measured, values, Color::Blue)],
            ..Panel::default()
        });
    }
    Figure {
        title: format!("Spectra, root mean square of {}", measured.averages()),
        x: Axis::linear("Frequency (Hz)"),
        size: (720.0, 140.0 + 220.0 * panels.len() as f64),
        panels,
    }
}

/// Modulus with its standard deviation, phase, coherence.
pub(super) fn frf(records: &Records, measured: &Measured, sensor: usize) -> Figure {
    let (channel, frf) = (&records.responses[sensor], &measured.frfs[sensor]);
    let quantity = channel.quantity();
    let modulus = frf.response.iter().map(|h| h.norm()).collect();
    let phase = frf.response.iter().map(|h| h.arg().to_degrees()).collect();
    let mut name = quantity.name().to_owned();
    name[..1].make_ascii_uppercase();
    let mut modulus_series = vec![curve("FRF", measured, modulus, Color::Blue)];
    if let Some(variance) = &frf.variance {
        let std = variance.iter().map(|variance| variance.sqrt()).collect();
        let std = curve("standard deviation of either part", measured, std, Color::Orange);
        modulus_series.push(Series { line: Some(Dash::Dotted), ..std });
    }
    let mut phase = curve("", measured, phase, Color::Blue);
    for k in (1..phase.y.len()).rev() {
        // Once around: a gap in place of a line across the panel.
        if (phase.y[k] - phase.y[k - 1]).abs() > 180.0 {
            phase.x.insert(k, phase.x[k]);
            phase.y.insert(k, f64::NAN);
        }
    }
    let mut panels = vec![
        Panel {
            y: Axis::log(format!("|{name}| ({})", quantity.unit())),
            series: modulus_series,
            height: 2.0,
            ..Panel::default()
        },
        Panel {
            y: Axis { range: Some((-180.0, 180.0)), ..Axis::linear("Phase (°)") },
            series: vec![phase],
            ..Panel::default()
        },
    ];
    if let Some(coherence) = &frf.coherence {
        panels.push(Panel {
            y: Axis { range: Some((0.0, 1.02)), ..Axis::linear("Coherence γ²") },
            series: vec![curve("", measured, coherence.clone(), Color::Green)],
            ..Panel::default()
        });
    }
    Figure {
        title: format!("{} over {}, average of {}", channel.name, records.force.name, measured.averages()),
        x: Axis::linear("Frequency (Hz)"),
        size: (720.0, 140.0 + 170.0 * panels.len() as f64),
        panels,
    }
}
