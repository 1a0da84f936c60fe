//! How sure the values are: errors of the model, noise, sensors, and what cannot be distinguished.

use super::heading;
use super::model_errors::{model_errors, number, table};
use super::plots::contributions;
use super::together::together;
use crate::escape::escape;
use crate::number::significant;
use crate::results::Results;
use crate::verdict;
use serde_json::Value;
use std::fmt::Write;

pub(super) fn uncertainty(results: &Results) -> String {
    [contributions(results), model_errors(results), noise(results), sensors(results), together(results)]
        .concat()
}

/// Where the noise is known from, and how large the misfit is beside it.
fn noise(results: &Results) -> String {
    let summary = &results.summary;
    let source = summary.word("/noise/source");
    let mut html = heading("noise", "Noise");
    // Writing to a string does not fail.
    let _ = match source {
        "" | "unknown" => {
            write!(html, "<p>The noise is unknown: no file gives it, and this run did not estimate it.")
        }
        _ => write!(html, "<p>The noise is {}.", verdict::noise(results)),
    };
    // An estimate is in units of the response, a known noise in units of what is given.
    if let (true, Some(level)) =
        (["sensors", "scatter", "curve"].contains(&source), summary.number("/noise/level"))
    {
        let of = match summary.word("/noise/deviation").starts_with("size") {
            true => "of the size of the response",
            false => "times what the coherence of the measurements gives",
        };
        let _ = write!(html, " Its standard deviation is {} {of}.", significant(level, 2));
    }
    let chi = summary.number("/fit/chi2_per_freedom");
    let _ = match (summary.word("/fit/verdict"), chi) {
        ("explained" | "nearly explained" | "not explained", Some(chi)) => write!(
            html,
            " The misfit gives χ² per degree of freedom {} (1: as large as the noise), with {} degrees of freedom.",
            significant(chi, 3),
            significant(summary.number("/fit/freedom").unwrap_or(0.0), 6)
        ),
        _ => write!(html, " The fit was not tested against it: {}.", verdict::untested(results)),
    };
    html += "</p>\n";
    for (heading, path) in
        [("Window", "/window/text"), ("Sensors", "/frequency_shifts/text"), ("Records", "/cut_off/text")]
    {
        if let Some(text) = Some(summary.word(path)).filter(|text| !text.is_empty()) {
            let _ = writeln!(html, "<p>{heading}: {}.</p>", escape(text));
        }
    }
    html
}

/// A row for each sensor.
fn sensors(results: &Results) -> String {
    let entries = results.summary.array("/sensors");
    let has_misfit = entries.iter().any(|entry| number(entry, "misfit").is_some());
    let mut heads = vec!["Sensor", "Measured quantity", "FRAC, nominal", "FRAC, updated"];
    heads.extend(has_misfit.then_some("Misfit over noise"));
    heads.push("Used");
    let row = |(sensor, entry): (&crate::results::Sensor, &Value)| {
        let frac = |computed| sensor.frac(computed).map_or("–".into(), |frac| format!("{frac:.4}"));
        let mut row = vec![
            escape(&sensor.label),
            sensor.quantity.name().to_owned(),
            frac(&sensor.nominal),
            frac(&sensor.updated),
        ];
        row.extend(
            has_misfit.then(|| number(entry, "misfit").map_or("–".into(), |misfit| significant(misfit, 2))),
        );
        let flag = |key: &str| entry.get(key).and_then(Value::as_bool) == Some(true);
        row.push(
            match (flag("dead"), flag("contradicts"), flag("left_out")) {
                (true, ..) => "no: shows no signal",
                (_, true, true) => "no: contradicts the others",
                (_, true, false) => "yes, but contradicts the others",
                (_, _, true) => "no",
                _ => "yes",
            }
            .to_owned(),
        );
        row
    };
    let rows: Vec<Vec<String>> = results.sensors.iter().zip(entries).map(row).collect();
    let note = "<p class=\"note\">FRAC is 1 where computed and measured response have the same shape over the band.</p>\n";
    heading("sensors", "Sensors") + &table("Sensors", &heads, &rows) + note
}
