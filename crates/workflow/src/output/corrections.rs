//! What is said of what measured values have by the way they were measured.

use crate::load::{Corrections, HannWindow, SensorShifts, WindowSource};
use crate::terminal::short;
use serde_json::{Value, json};

/// So many nats against a window that the case has are worth a warning.
const AGAINST_NATS: f64 = -20.0;

/// Labels and sentences, and whether each is a warning.
pub fn corrections_text(corrections: Option<&Corrections>) -> Vec<(bool, &'static str, String)> {
    let Some(Corrections { hann, shifts, cut_off }) = corrections else { return Vec::new() };
    let window = hann.as_ref().map(window_text).map(|(is_warning, text)| (is_warning, "window", text));
    let shifts = shifts.as_ref().map(|shifts| (true, "sensors", shifts_text(shifts)));
    let cut_off = cut_off.map(|largest| (true, "records", cut_off_text(largest)));
    window.into_iter().chain(shifts).chain(cut_off).collect()
}

fn cut_off_text(largest: f64) -> String {
    format!(
        "the records end before the responses have decayed: that is up to {:.2} % of a value, and in the error bars; record longer, or let \
         the window decay faster",
        100.0 * largest
    )
}

fn shifts_text(shifts: &SensorShifts) -> String {
    format!(
        "natural frequencies differ from sensor to sensor by {:.2} % ({:.0} nats), as of a mass that moves with the sensor, of a \
         temperature that changes, or of two modes side by side; that is in the error bars",
        100.0 * shifts.relative_std,
        shifts.nats
    )
}

/// A sentence, and whether it is a warning.
fn window_text(window: &HannWindow) -> (bool, String) {
    let HannWindow { record_s, nats, source, largest } = window;
    let records = format!("Hann on records of {} s", short(*record_s));
    let leakage = format!("its leakage, up to {:.2} % of a value, is", 100.0 * largest);
    match source {
        WindowSource::Given if *nats < AGAINST_NATS => {
            let against = format!("without one the data are likelier by {:.0} nats", -nats);
            (true, format!("{records}, as the case says; but {against}: see `window` of [[measurement]]"))
        }
        WindowSource::Given => (false, format!("{records}: {leakage} removed")),
        WindowSource::Shown => {
            let shown = format!("{records}, as the data show ({nats:.0} nats)");
            (true, format!("{shown}: {leakage} removed; window = \"none\" keeps it"))
        }
        WindowSource::Undecided => {
            let why = "the data do not show whether there was a Hann window";
            let change = "window = \"none\" or \"hann\" in [[measurement]] makes them shorter";
            (true, format!("{why}: {leakage} in the error bars; {change}"))
        }
    }
}

/// The window, the shifts and what is cut off for programs, with the sentences for the report.
pub(crate) fn corrections_json(corrections: Option<&Corrections>) -> [Value; 3] {
    let shifts = corrections.and_then(|found| found.shifts.as_ref()).map(|shifts| {
        json!({"relative_std": shifts.relative_std, "nats": shifts.nats, "text": shifts_text(shifts)})
    });
    let cut_off = corrections.and_then(|found| found.cut_off);
    let cut_off = cut_off.map(|largest| json!({"largest": largest, "text": cut_off_text(largest)}));
    [window_json(corrections.and_then(|found| found.hann.as_ref())), json!(shifts), json!(cut_off)]
}

fn window_json(window: Option<&HannWindow>) -> Value {
    let of = |window: &HannWindow| {
        json!({
            "kind": "hann",
            "text": window_text(window).1,
            "record_s": window.record_s,
            "nats": window.nats,
            "source": match window.source {
                WindowSource::Given => "given",
                WindowSource::Shown => "shown",
                WindowSource::Undecided => "undecided",
            },
            "largest_leakage": window.largest,
        })
    };
    json!(window.map(of))
}
