//! Fig. 1 of the paper, with measurements below; and the same over the size of the model.

use crate::measure::{ORDERS, Timing};
use frfit::efficiency::speedup;
use frfit_figures::{Axis, Color, Dash, Figure, Level, Marker, Panel, Series};

/// Colour and marker of each kind of model.
fn look(kind: &str) -> (Color, Marker) {
    match kind {
        "bar" => (Color::Green, Marker::Circle),
        "plate" => (Color::Blue, Marker::Square),
        "sandwich" => (Color::Vermilion, Marker::Triangle),
        _ => (Color::Purple, Marker::Diamond),
    }
}

fn as_fast() -> Level {
    Level { label: "as fast as a direct solve".into(), y: 1.0 }
}

/// Speed-up over the order: formula above, smallest and largest model of each kind below.
pub(crate) fn by_order(timings: &[Timing]) -> Figure {
    let orders: Vec<f64> = (1..=100).map(f64::from).collect();
    let sizes = [
        (1e2, "10²", Color::Black, Dash::Solid),
        (1e3, "10³", Color::Blue, Dash::Dashed),
        (1e4, "10⁴", Color::Vermilion, Dash::DashDot),
        (1e5, "10⁵", Color::Green, Dash::Solid),
        (1e6, "10⁶", Color::Purple, Dash::Dashed),
    ];
    let formula = sizes.map(|(dofs, name, color, line)| Series {
        label: format!("N = {name}"),
        x: orders.clone(),
        y: orders.iter().map(|&order| speedup(dofs, order)).collect(),
        color,
        line: Some(line),
        ..Series::default()
    });
    let curve = |timing: &Timing, line| {
        let (color, marker) = look(timing.kind);
        Series {
            label: format!("{}, N = {}", timing.kind, timing.dofs),
            x: ORDERS.iter().map(|&order| order as f64).collect(),
            y: timing.speedups(),
            color,
            line: Some(line),
            marker: Some(marker),
            ..Series::default()
        }
    };
    let measured = timings.chunk_by(|a, b| a.kind == b.kind).flat_map(|of_kind| match of_kind {
        [smallest, .., largest] => vec![curve(smallest, Dash::Dotted), curve(largest, Dash::Solid)],
        ends => ends.iter().map(|timing| curve(timing, Dash::Dotted)).collect(),
    });
    let panel = |label: &str, series| Panel {
        y: Axis::log(label),
        series,
        levels: vec![as_fast()],
        ..Panel::default()
    };
    Figure {
        title: "Speed-up of the order-n series over a direct solve".into(),
        x: Axis::log("Order of approximation n"),
        panels: vec![
            panel("Speed-up, dense formula", formula.into()),
            panel("Speed-up, sparse, measured", measured.collect()),
        ],
        size: (720.0, 760.0),
    }
}

/// Speed-up over the number of degrees of freedom, at the paper's order.
pub(crate) fn by_size(timings: &[Timing]) -> Figure {
    let (index, order) = (4, ORDERS[4]);
    let dofs: Vec<f64> = (0..=40).map(|k| 10f64.powf(3.0 + 2.0 * f64::from(k) / 40.0)).collect();
    let mut series = vec![Series {
        label: "dense formula".into(),
        y: dofs.iter().map(|&dofs| speedup(dofs, order as f64)).collect(),
        x: dofs,
        line: Some(Dash::Dashed),
        ..Series::default()
    }];
    for of_kind in timings.chunk_by(|a, b| a.kind == b.kind) {
        let (color, marker) = look(of_kind[0].kind);
        series.push(Series {
            label: of_kind[0].kind.into(),
            x: of_kind.iter().map(|timing| timing.dofs as f64).collect(),
            y: of_kind.iter().map(|timing| timing.speedups()[index]).collect(),
            color,
            marker: Some(marker),
            ..Series::default()
        });
    }
    Figure {
        title: format!("Speed-up of the series at n = {order} over the size of the model"),
        x: Axis::log("Degrees of freedom N"),
        panels: vec![Panel { y: Axis::log("Speed-up"), series, levels: vec![as_fast()], ..Panel::default() }],
        ..Figure::default()
    }
}
