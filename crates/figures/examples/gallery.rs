//! Draws one figure of each kind, from invented data, into the folder given as argument.

use std::io::{Error, ErrorKind};
use std::path::Path;

use frfit_figures::{Axis, Bands, Class, Color, Dash, Figure, HeatMap, Level, Marker, Panel, Series, Strip};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os().nth(1).ok_or_else(|| {
        Error::new(ErrorKind::InvalidInput, "the gallery needs the folder to draw into: gallery FOLDER")
    })?;
    std::fs::create_dir_all(&folder)?;
    let gallery = [
        ("accelerance", accelerance()),
        ("modulus", modulus()),
        ("error_map", error_map()),
        ("spectral_radius", spectral_radius()),
        ("speedup", speedup()),
        ("error_cpu", error_cpu()),
        ("status", status()),
        ("no_data", no_data()),
    ];
    for (name, figure) in gallery {
        let path = Path::new(&folder).join(name);
        std::fs::write(path.with_extension("svg"), figure.svg())?;
        std::fs::write(path.with_extension("png"), figure.png(1.25)?)?;
    }
    Ok(())
}

fn frequencies_hz(count: u32) -> Vec<f64> {
    (0..count).map(|k| 200.0 + 2800.0 * f64::from(k) / f64::from(count - 1)).collect()
}

/// A few damped modes, stretched in frequency and damping.
fn modes(f: f64, stretch: f64, damping: f64) -> f64 {
    let mode = |k: u32| {
        let fk = 480.0 * f64::from(k) * stretch;
        let sign = if k.is_multiple_of(2) { -1.0 } else { 1.0 };
        let (a, b) = (1.0 - (f / fk).powi(2), damping * (1.0 + f / 3e3));
        let n = f * f / (fk * fk) / (a * a + b * b);
        (sign * n * a, sign * n * b)
    };
    let (re, im) = (1..=9).map(mode).fold((0.02, 0.0), |s, m| (s.0 + m.0, s.1 + m.1));
    re.hypot(im)
}

/// A repeatable wobble in −1..1.
fn wobble(k: usize) -> f64 {
    (k as f64 * 12.9898).sin() * 0.6 + (k as f64 * 4.1414).sin() * 0.4
}

fn accelerance() -> Figure {
    let f = frequencies_hz(301);
    let measured =
        f.iter().enumerate().map(|(k, &f)| modes(f, 1.0, 0.11) * (1.0 + 0.04 * wobble(k))).collect();
    let nominal = f.iter().map(|&f| modes(f, 1.12, 0.06)).collect();
    let updated = f.iter().map(|&f| modes(f, 1.0, 0.11)).collect();
    let every_third = |v: &[f64]| v.iter().step_by(3).copied().collect::<Vec<f64>>();
    let measured: Vec<f64> = measured;
    Figure {
        title: "Accelerance of the rubber bar at its free end".into(),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::log("Accelerance |a| (m s⁻² N⁻¹)"),
            series: vec![
                Series {
                    label: "measured".into(),
                    x: every_third(&f),
                    y: every_third(&measured),
                    line: None,
                    marker: Some(Marker::Circle),
                    ..Series::default()
                },
                Series {
                    label: "nominal".into(),
                    x: f.clone(),
                    y: nominal,
                    color: Color::Blue,
                    line: Some(Dash::Dashed),
                    ..Series::default()
                },
                Series {
                    label: "updated, order 30".into(),
                    x: f,
                    y: updated,
                    color: Color::Vermilion,
                    ..Series::default()
                },
            ],
            ..Panel::default()
        }],
        ..Figure::default()
    }
}

fn modulus() -> Figure {
    let f = frequencies_hz(71);
    let storage = |f: f64| 0.9e6 + 1.1e5 * (f / 200.0).powf(0.53);
    let loss = |f: f64| 0.08 + 0.05 * (f / 200.0).powf(0.4);
    let gap = |k: usize, v: f64| if (30..34).contains(&k) || k == 45 || k == 47 { f64::NAN } else { v };
    let series = |label: &str, y: Vec<f64>, color, line, marker| Series {
        label: label.into(),
        x: f.clone(),
        y,
        color,
        line,
        marker,
        ..Series::default()
    };
    let three = |value: &dyn Fn(f64) -> f64, nominal: f64, noise: f64| {
        let updated =
            f.iter().enumerate().map(|(k, &f)| gap(k, value(f) * (1.0 + noise * wobble(k)))).collect();
        vec![
            series("true", f.iter().map(|&f| value(f)).collect(), Color::Black, Some(Dash::Solid), None),
            series("nominal", vec![nominal; f.len()], Color::Blue, Some(Dash::Dashed), None),
            series("updated", updated, Color::Vermilion, Some(Dash::Solid), Some(Marker::Disc)),
        ]
    };
    Figure {
        title: "Complex modulus of the rubber bar".into(),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![
            Panel {
                y: Axis::linear("Storage modulus E′ (Pa)"),
                series: three(&storage, 1.0e6, 0.02),
                ..Panel::default()
            },
            Panel { y: Axis::linear("Loss factor η"), series: three(&loss, 0.1, 0.05), ..Panel::default() },
        ],
        size: (720.0, 560.0),
    }
}

/// Spectral radius of an imagined lightly damped plate.
fn radius(f: f64) -> f64 {
    let near = |r: f64| 0.02 / ((f - r).hypot(9.0) / r);
    0.22 + near(858.0) + near(1748.5) + near(2566.2)
}

fn error_map() -> Figure {
    // denser around the resonances, with a hole
    let mut f = frequencies_hz(90);
    f.extend((0..60).map(|k| 780.0 + 2.5 * f64::from(k)));
    f.sort_by(f64::total_cmp);
    let orders: Vec<f64> = (1..=30).map(f64::from).collect();
    let error = |n: f64, f: f64| {
        let hole = (1300.0..1340.0).contains(&f) || f > 2600.0 && n > 24.0;
        if hole { f64::NAN } else { ((n + 1.0) * radius(f).log10()).clamp(-13.0, 1.5) }
    };
    let values = orders.iter().flat_map(|&n| f.iter().map(move |&f| error(n, f))).collect();
    Figure {
        title: "Error of the updated response".into(),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::whole("Order of approximation n"),
            heat: Some(HeatMap {
                x: f,
                y: orders,
                values,
                label: "log₁₀ ε".into(),
                range: None,
                names: Vec::new(),
            }),
            ..Panel::default()
        }],
        ..Figure::default()
    }
}

fn spectral_radius() -> Figure {
    let f = frequencies_hz(561);
    let rho: Vec<f64> = f.iter().map(|&f| radius(f)).collect();
    let mut ranges: Vec<(f64, f64)> = Vec::new();
    for (&f, _) in f.iter().zip(&rho).filter(|(_, r)| **r > 1.0) {
        match ranges.last_mut() {
            Some(last) if f - last.1 < 8.0 => last.1 = f,
            _ => ranges.push((f, f)),
        }
    }
    Figure {
        title: "Convergence of the series on the clamped plate".into(),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::linear("Spectral radius ρ(c A₀⁻¹A₁)"),
            series: vec![Series {
                label: "ρ".into(), x: f, y: rho, color: Color::Blue, ..Series::default()
            }],
            bands: vec![Bands { label: "series diverges".into(), color: Color::Vermilion, ranges }],
            levels: vec![Level { label: "ρ = 1".into(), y: 1.0 }],
            ..Panel::default()
        }],
        ..Figure::default()
    }
}

fn speedup() -> Figure {
    let orders: Vec<f64> = (1..=100).map(f64::from).collect();
    let formula = |size: f64, n: f64| {
        (16.0 / 3.0 * size.powi(3) + 16.0 * size.powi(2)) / (n * (16.0 * size.powi(2) + 6.0 * size))
    };
    let sizes = [
        (1e3, "10³", Color::Blue, Dash::Solid, Marker::Circle),
        (1e4, "10⁴", Color::Vermilion, Dash::Dashed, Marker::Square),
        (1e5, "10⁵", Color::Green, Dash::DashDot, Marker::Triangle),
        (1e6, "10⁶", Color::Purple, Dash::Dotted, Marker::Diamond),
    ];
    let mut series = Vec::new();
    for (size, name, color, dash, marker) in sizes {
        let label = format!("N = {name}");
        series.push(Series {
            label: label.clone(),
            x: orders.clone(),
            y: orders.iter().map(|&n| formula(size, n)).collect(),
            color,
            line: Some(dash),
            ..Series::default()
        });
        let x: Vec<f64> = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0].into();
        series.push(Series {
            label,
            y: x.iter().enumerate().map(|(k, &n)| formula(size, n) * (0.6 + 0.2 * wobble(k))).collect(),
            x,
            color,
            line: None,
            marker: Some(marker),
            ..Series::default()
        });
    }
    Figure {
        title: "Speedup of an order-n series (lines: formula, points: measured)".into(),
        x: Axis::log("Order of approximation n"),
        panels: vec![Panel { y: Axis::log("Speedup"), series, ..Panel::default() }],
        ..Figure::default()
    }
}

fn error_cpu() -> Figure {
    let run = |label: &str, start: f64, step: f64, rate: f64, color, marker| {
        let orders = || (1..=30).map(f64::from);
        let y: Vec<f64> = orders().map(|n| 0.5 * 10f64.powf(-rate * n)).collect();
        Series {
            label: label.into(),
            x: orders().map(|n| start + step * n).collect(),
            x_error: orders().map(|n| 0.06 * (start + step * n)).collect(),
            y_error: y.iter().enumerate().map(|(k, e)| e * (0.5 + 0.5 * wobble(k))).collect(),
            y,
            color,
            line: Some(Dash::Solid),
            marker: Some(marker),
        }
    };
    Figure {
        title: "Error against CPU time at 1500 Hz".into(),
        x: Axis::log("CPU time (s)"),
        panels: vec![Panel {
            y: Axis::log("Normalised error ε"),
            series: vec![
                run(
                    "series, orders 1–30 (mean ± deviation)",
                    3e-3,
                    1e-4,
                    0.3,
                    Color::Vermilion,
                    Marker::Disc,
                ),
                run("Nelder–Mead, 1–30 iterations", 2e-3, 6e-3, 0.11, Color::Blue, Marker::Square),
            ],
            ..Panel::default()
        }],
        ..Figure::default()
    }
}

fn status() -> Figure {
    let f = frequencies_hz(160);
    let class = |k: usize| match (k, radius(f[k])) {
        (60..64, _) => 9,
        (_, r) if r > 1.0 => 2,
        (_, r) if r > 0.6 => 1,
        _ => 0,
    };
    let of =
        |wanted: usize| -> Vec<f64> { (0..f.len()).filter(|&k| class(k) == wanted).map(|k| f[k]).collect() };
    let kinds = [
        ("ok", Color::Green, Marker::Disc),
        ("ambiguous", Color::Orange, Marker::Triangle),
        ("diverged", Color::Vermilion, Marker::Cross),
    ];
    let points = |(i, (label, color, marker)): (usize, &(&str, Color, Marker))| Series {
        label: (*label).into(),
        x: of(i),
        y: of(i).iter().enumerate().map(|(k, &f)| 1e-3 * radius(f).powi(8) * (1.5 + wobble(k))).collect(),
        color: *color,
        line: None,
        marker: Some(*marker),
        ..Series::default()
    };
    let classes =
        kinds.iter().map(|(label, color, _)| Class { label: (*label).into(), color: *color }).collect();
    Figure {
        title: "Status of each frequency".into(),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![Panel {
            y: Axis::log("Error ε"),
            series: kinds.iter().enumerate().map(points).collect(),
            strip: Some(Strip { class: (0..f.len()).map(class).collect(), x: f.clone(), classes }),
            ..Panel::default()
        }],
        ..Figure::default()
    }
}

fn no_data() -> Figure {
    let point = |x: f64, y: f64| Series {
        label: "one point".into(),
        x: vec![x],
        y: vec![y],
        marker: Some(Marker::Disc),
        ..Series::default()
    };
    Figure {
        title: "Panels without data, with one point, and with a constant".into(),
        x: Axis::linear("Frequency (Hz)"),
        panels: vec![
            Panel { y: Axis::log("Error ε"), ..Panel::default() },
            Panel {
                y: Axis::linear("Storage modulus E′ (Pa), in a panel whose label is longer than it is high"),
                series: vec![point(12_500.0, 1e11)],
                ..Panel::default()
            },
            Panel {
                y: Axis::linear("η"),
                series: vec![Series { x: vec![1.2e4, 1.3e4], y: vec![-0.02; 2], ..Series::default() }],
                ..Panel::default()
            },
        ],
        ..Figure::default()
    }
}
