//! The records of all impacts, one over the other.

use super::measured::thinned;
use crate::records::{Records, Sensor};
use frfit::signal::{Channel, Fault, Impact, Measured};
use frfit_figures::{Axis, Color, Dash, Figure, Panel, Series};

/// Of impacts that are averaged, in turn.
const COLORS: [Color; 6] =
    [Color::Blue, Color::Vermilion, Color::Green, Color::Orange, Color::Purple, Color::SkyBlue];

/// The contacts, from one contact before the trigger to three after it.
pub(super) fn force(records: &Records, measured: &Measured) -> Figure {
    let longest = measured.impacts.iter().map(|impact| impact.contact_s(measured.step_s)).fold(0.0, f64::max);
    // At a coarse sampling a contact has few samples; the lines between them would be all there is.
    let shown_s = longest.max(8.0 * measured.step_s);
    let range_ms = (-1e3 * shown_s, 3e3 * shown_s);
    Figure {
        title: "Force of every impact".into(),
        x: Axis { range: Some(range_ms), ..Axis::linear("Time after the trigger (ms)") },
        panels: vec![panel(records, measured, Channel::Force, &records.force, Some(range_ms))],
        ..Figure::default()
    }
}

/// A response over the whole record.
pub(super) fn response(records: &Records, measured: &Measured, sensor: usize) -> Figure {
    let channel = &records.responses[sensor];
    Figure {
        title: format!("{} of every impact", channel.name),
        x: Axis::linear("Time after the trigger (ms)"),
        panels: vec![panel(records, measured, Channel::Response(sensor), channel, None)],
        ..Figure::default()
    }
}

fn panel(
    records: &Records,
    measured: &Measured,
    channel: Channel,
    sensor: &Sensor,
    range_ms: Option<(f64, f64)>,
) -> Panel {
    let kind = sensor.kind;
    let mut name = kind.name().to_owned();
    name[..1].make_ascii_uppercase();
    let series = (1..)
        .zip(&measured.impacts)
        .map(|(number, impact)| one(records, measured, channel, range_ms, number, impact));
    // A spike is named in the legend and not drawn: on its scale the impacts would not be seen.
    let peaks = measured.impacts.iter().map(|impact| impact.peak_n).fold(0.0, f64::max);
    let range = (channel == Channel::Force && peaks > 0.0).then_some((-0.1 * peaks, 1.2 * peaks));
    Panel {
        y: Axis { range, ..Axis::linear(format!("{name} ({})", kind.unit())) },
        series: series.filter(|series| !series.x.is_empty()).collect(),
        ..Panel::default()
    }
}

fn one(
    records: &Records,
    measured: &Measured,
    channel: Channel,
    range_ms: Option<(f64, f64)>,
    number: usize,
    impact: &Impact,
) -> Series {
    let samples =
        records.recordings.get(impact.recording).map_or(&[][..], |recording| recording.channel(channel));
    let record = samples.get(impact.range.clone()).unwrap_or(&[]);
    let time_ms = |k: usize| 1e3 * ((impact.range.start + k) as f64 - impact.onset as f64) * measured.step_s;
    let points = record.iter().enumerate().map(|(k, &y)| (time_ms(k), y));
    let is_shown = |x: f64| range_ms.is_none_or(|(low, high)| (low..=high).contains(&x));
    let (x, y): (Vec<f64>, Vec<f64>) = points.filter(|(x, _)| is_shown(*x)).unzip();
    let (x, y) = thinned(&x, &y);
    let faults: Vec<String> =
        impact.faults.iter().map(|fault: &Fault| fault.name().replace('_', " ")).collect();
    let label = match faults.is_empty() {
        true => format!("impact {number}"),
        false => format!("impact {number}: {}", faults.join(", ")),
    };
    let (color, line) = match impact.is_kept() {
        true => (COLORS[(number - 1) % COLORS.len()], Dash::Solid),
        false => (Color::Grey, Dash::Dashed),
    };
    Series { label, x, y, color, line: Some(line), ..Series::default() }
}
