//! The figures of a run, as the paper draws them.

mod accelerance;
mod candidates;
mod error_bars;
mod error_map;
mod identifiability;
mod impacts;
mod laws;
mod measured;
mod modes;
mod modulus;
mod reduction_error;
mod sensitivities;
mod spectral_radius;

pub use laws::law_figures;
pub use modes::modes_figures;
pub use sensitivities::sensitivity_figure;

use crate::load::{Case, IdentifyCase};
use crate::output::File;
use crate::records::Records;
use crate::run::{IdentifyRun, RespondRun};
use frfit::identify::{Line, Selection, Status, Unknown, Variation};
use frfit::signal::Measured;
use frfit_figures::{Class, Color, Dash, Figure, Marker, PngError, Series, Strip};
use frfit_report::status_color;

/// Pixels per SVG unit: 720 units wide become 1080 pixels.
const PIXELS_PER_UNIT: f64 = 1.5;

/// All figures of an identification as `figures/*.svg` and `figures/*.png`; those of one of several unknowns have its name in theirs.
///
/// # Errors
/// [`PngError`] where a figure cannot be rasterised.
pub fn identify_figures(
    case: &Case,
    identify: &IdentifyCase,
    run: &IdentifyRun,
) -> Result<Vec<File>, PngError> {
    let found = &run.found;
    let mut figures = Vec::new();
    for sensor in 0..case.sensors.len() {
        let name = match case.sensors.len() {
            1 => "accelerance".to_owned(),
            _ => format!("accelerance-{}", sensor + 1),
        };
        figures.push((name, accelerance::identified(case, identify, run, sensor)));
    }
    for (j, one) in identify.unknowns.iter().enumerate() {
        let (name, of) = match identify.unknowns.len() {
            1 => ("modulus".to_owned(), String::new()),
            _ => (file_name(&one.name), format!("-{}", file_name(&one.name))),
        };
        // A constant over frequency is a number, not a curve.
        if one.varies != Variation::Constant {
            figures.push((name, modulus::figure(case, identify, run, j)));
            if found.model_errors.is_some() {
                figures.push((format!("error-bars{of}"), error_bars::figure(case, identify, run, j)));
            }
        }
        if identify.options.selection == Selection::Joint && has_solutions(run, one) {
            figures.push((format!("candidates{of}"), candidates::figure(case, identify, run, j)));
        }
    }
    if found.lines.iter().any(|line| line.spectral_radius.is_some()) {
        figures.push(("spectral_radius".to_owned(), spectral_radius::figure(case, run)));
    }
    if found.reduction_error().is_some() {
        figures.push(("reduction-error".to_owned(), reduction_error::figure(case, run)));
    }
    if let Some(map) = &run.error_map {
        figures.push(("error".to_owned(), error_map::figure(case, map)));
    }
    if found.identifiability.correlation.len() > 1 {
        figures.push(("correlation".to_owned(), identifiability::correlation(case, identify, run)));
    }
    if let Some(profile) = &found.identifiability.profile {
        figures.push(("profile".to_owned(), identifiability::profile(case, run, profile)));
    }
    draw(figures)
}

/// Whether an unknown can have several solutions at a frequency: one that varies alone, or one with rivals.
fn has_solutions(run: &IdentifyRun, one: &Unknown) -> bool {
    let free = one.varies == Variation::PerFrequency;
    let found = |line: &Line| !line.roots.is_empty() || (free && !line.rivals.is_empty());
    run.found.lines.iter().any(found)
}

/// A name as a part of a file's name: letters, digits, - and _ stay.
fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || c == '-' || c == '_' { c } else { '_' }).collect()
}

/// The figures of a forward response: accelerance at every sensor.
///
/// # Errors
/// [`PngError`] where a figure cannot be rasterised.
pub fn respond_figures(case: &Case, run: &RespondRun) -> Result<Vec<File>, PngError> {
    draw(vec![("accelerance".to_owned(), accelerance::forward(case, run))])
}

/// The figures of a hammer test, below a folder: contacts, responses, spectra, FRFs.
///
/// # Errors
/// [`PngError`] where a figure cannot be rasterised.
pub fn measured_figures(records: &Records, measured: &Measured, folder: &str) -> Result<Vec<File>, PngError> {
    let mut figures = vec![
        ("force".to_owned(), impacts::force(records, measured)),
        ("spectra".to_owned(), measured::spectra(records, measured)),
    ];
    for sensor in 0..records.responses.len() {
        let numbered = |name: &str| match records.responses.len() {
            1 => name.to_owned(),
            _ => format!("{name}-{}", sensor + 1),
        };
        figures.push((numbered("response"), impacts::response(records, measured, sensor)));
        figures.push((numbered("frf"), measured::frf(records, measured, sensor)));
    }
    draw_into(folder, figures)
}

fn draw(figures: Vec<(String, Figure)>) -> Result<Vec<File>, PngError> {
    draw_into("figures", figures)
}

fn draw_into(folder: &str, figures: Vec<(String, Figure)>) -> Result<Vec<File>, PngError> {
    let mut files = Vec::with_capacity(2 * figures.len());
    for (name, figure) in figures {
        files.push(File::new(format!("{folder}/{name}.png"), figure.png(PIXELS_PER_UNIT)?));
        files.push(File::new(format!("{folder}/{name}.svg"), figure.svg()));
    }
    Ok(files)
}

/// A curve, points, or both.
fn curve(
    label: &str,
    x: &[f64],
    y: Vec<f64>,
    color: Color,
    line: Option<Dash>,
    marker: Option<Marker>,
) -> Series {
    Series { label: label.into(), x: x.to_vec(), y, color, line, marker, ..Series::default() }
}

/// The status of every frequency, as a strip of colours.
fn status_strip(run: &IdentifyRun) -> Strip {
    let place = |status: Status| Status::ALL.iter().position(|&other| other == status).unwrap_or(0);
    let statuses = run.found.lines.iter().map(|line| (line.frequency_hz, place(line.status)));
    let (x, class) = statuses.unzip();
    Strip {
        x,
        class,
        classes: Status::ALL
            .iter()
            .map(|&status| Class { label: status.name().replace('_', " "), color: status_color(status) })
            .collect(),
    }
}

/// Title of the case and what this figure shows.
fn title(case: &Case, what: &str) -> String {
    if case.title.is_empty() { what.to_owned() } else { format!("{}: {what}", case.title) }
}
