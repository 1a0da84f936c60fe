//! What is said of a Hann window.

use crate::load::{HannWindow, WindowSource};
use crate::terminal::short;
use serde_json::{Value, json};

/// So many nats against a window that the case has are worth a warning.
const AGAINST_NATS: f64 = -20.0;

/// A sentence, and whether it is a warning.
pub fn window_text(window: &HannWindow) -> (bool, String) {
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

/// The same for programs, and the sentence for the report.
pub(crate) fn window_json(window: Option<&HannWindow>) -> Value {
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
