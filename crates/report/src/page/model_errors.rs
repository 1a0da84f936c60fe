//! The errors of the model: whether there are any, of which modes and matrices, and what an error of a known factor would do.

use super::heading;
use crate::escape::escape;
use crate::number::{percent, significant};
use crate::results::Results;
use frfit::identify::LeverageOf;
use serde_json::Value;
use std::fmt::Write;

/// Text and tables; nothing where the summary has no entry for them.
pub(super) fn model_errors(results: &Results) -> String {
    let summary = &results.summary;
    let known = summary.0.pointer("/identify/model_error").unwrap_or(&Value::Null);
    if known.is_null() {
        return String::new();
    }
    let found = summary.0.get("model_errors").filter(|found| !found.is_null());
    let contained =
        bars_contain(results).map_or(String::new(), |parts| format!(" Error bars contain {parts}."));
    let none = |reason: &str| format!("<p>{reason}{contained}</p>\n");
    let body = match found {
        Some(found) if has_errors(found) => sizes(found) + &modes(found) + &others(found),
        // Only the stated accuracies of known factors are in the error bars.
        Some(found) => {
            none("No error of the model was found: a model without errors explains the band as well.")
                + &others(found)
        }
        None if known == "none" => {
            none("The case takes the model as exact (<code>model_error = \"none\"</code>).")
        }
        None if summary.word("/fit/verdict") == "not explained" => {
            none("Neither the noise nor errors of the model of usual size explain the band.")
        }
        None => none(
            "No error of the model was found: a model without errors explains the band as well as one with errors, or there was nothing to compare. \
             An error that acts on all modes like the unknown, for example a wrong thickness, does not show in the measurement.",
        ),
    };
    let is_unused = summary.0.pointer("/identify/coarser_mesh") == Some(&Value::Bool(true))
        && found.and_then(|found| found.get("mesh")).is_none_or(Value::is_null);
    let body = body + if is_unused { UNPAIRED } else { "" };
    format!("{}\n{body}{}", heading("model-errors", "Errors of the model"), leverage(results))
}

/// Whether errors of the model were found, and not only those of factors whose accuracy the case states.
fn has_errors(found: &Value) -> bool {
    ["frequency_std", "shape_std", "loss_factor_std"]
        .iter()
        .any(|size| number(found, size).is_some_and(|std| std > 0.0))
}

/// What the error bars contain, as a part of a sentence; `None` if there are no error bars.
pub(super) fn bars_contain(results: &Results) -> Option<String> {
    let summary = &results.summary.0;
    let are_found = summary.get("model_errors").is_some_and(has_errors);
    let words = |part: &Value| match part.as_str()? {
        "noise" => Some("the noise of the measurement"),
        "model_errors" if are_found => Some("the errors of the model that were found"),
        "model_errors" => Some("errors of the model that are too small to show beside the noise"),
        "known_factors" => Some("the uncertainty of known factors"),
        _ => None,
    };
    let parts: Vec<&str> = list(summary, "error_bars_contain").iter().filter_map(words).collect();
    match &parts[..] {
        [] => None,
        [only] => Some(format!("{only} only")),
        [first @ .., last] => Some(format!("{} and {last}", first.join(", "))),
    }
}

const UNPAIRED: &str = "<p>The coarser mesh was not used: fewer than half of the modes of the band could be paired with its modes.</p>\n";

pub(super) fn list<'v>(of: &'v Value, key: &str) -> &'v [Value] {
    of.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

pub(super) fn number(of: &Value, key: &str) -> Option<f64> {
    of.get(key).and_then(Value::as_f64)
}

/// How large they are, and what they do to the error bars.
fn sizes(found: &Value) -> String {
    let size = |key: &str| number(found, key).map_or("–".into(), percent);
    let mut html = format!(
        "<p>Errors of the model were found. They are corrected for, and they are in every error bar. Their standard deviations: natural frequencies {}, independent of one another; \
         mode shapes at the sensors {}; damping of modes {}.",
        size("frequency_std"),
        size("shape_std"),
        size("loss_factor_std")
    );
    // Writing to a string does not fail.
    if let Some(rest) = number(found, "response_std").filter(|rest| *rest > 0.0) {
        let _ = write!(
            html,
            " In addition to these errors and the noise, {} of the response remains unexplained.",
            percent(rest)
        );
    }
    if let Some(ratio) = number(found, "bars_over_noise") {
        let _ = write!(
            html,
            " The error bars of the storage modulus are {} times as long as with the noise alone (median).",
            significant(ratio, 2)
        );
    }
    if let Some(nats) = number(found, "evidence_nats") {
        let _ = match nats > 0.0 {
            true => write!(
                html,
                " With them the log-likelihood of the band is higher by {} (in nats) than without.",
                significant(nats, 3)
            ),
            false => write!(
                html,
                " A model without errors explains the band as well: these errors are in the error bars because the case gives them."
            ),
        };
    }
    html += "</p>\n";
    if let Some(mesh) = found.get("mesh").filter(|mesh| !mesh.is_null()) {
        let of = |key: &str| number(mesh, key).map_or("–".into(), |value| significant(value, 2));
        let _ = writeln!(
            html,
            "<p>{} modes are paired with those of the coarser mesh. The error of this mesh is {} ± {} times the difference between the two meshes (one standard deviation); {} is expected from the size \
             of the elements.</p>",
            mesh.get("paired").and_then(Value::as_u64).unwrap_or(0),
            of("remainder"),
            of("std"),
            of("expected")
        );
    }
    html
}

/// The modes, each with its error.
fn modes(found: &Value) -> String {
    let all = list(found, "modes");
    if all.is_empty() {
        return String::new();
    }
    let has_coarser = all.iter().any(|mode| mode.get("coarser_mesh_hz").is_some());
    let mut rows = Vec::with_capacity(all.len());
    for mode in all {
        let hz = |key: &str| number(mode, key).map_or("–".into(), |f| significant(f, 5));
        let mut row = vec![hz("frequency_hz")];
        row.extend(has_coarser.then(|| hz("coarser_mesh_hz")));
        row.push(with_std(mode));
        rows.push(row);
    }
    let mut heads = vec!["Natural frequency of the model, Hz"];
    heads.extend(has_coarser.then_some("On the coarser mesh, Hz"));
    heads.push("Error, ± two standard deviations");
    sub("Natural frequencies") + &table("Natural frequencies", &heads, &rows)
}

/// Known matrices and masses at sensors.
fn others(found: &Value) -> String {
    let text = |of: &Value, key: &str| escape(of.get(key).and_then(Value::as_str).unwrap_or(""));
    let rows = list(found, "matrices").iter().map(|one| {
        let part = text(one, "part").replace('_', " ");
        let error = match number(one, "error").zip(number(one, "std")) {
            Some((error, std)) if part == "loss factor" => {
                format!("{} ± {}", significant(error, 2), significant(2.0 * std, 2))
            }
            _ => with_std(one),
        };
        vec![text(one, "matrix"), part, error]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let heads = ["Known matrix", "Part of its factor", "Error, ± two standard deviations"];
    let mut html = if rows.is_empty() {
        String::new()
    } else {
        sub("Known matrices") + &table("Known matrices", &heads, &rows)
    };
    let clear =
        |one: &&Value| number(one, "mass_kg").zip(number(one, "std_kg")).is_some_and(|(m, s)| m > 2.0 * s);
    for one in list(found, "sensor_masses").iter().filter(clear) {
        let of = |key: &str, times: f64| {
            number(one, key).map_or("–".into(), |mass| significant(times * mass, 2))
        };
        let _ = writeln!(
            html,
            "<p>At {} there is a mass of {} ± {} kg that the model does not have.</p>",
            text(one, "sensor"),
            of("mass_kg", 1.0),
            of("std_kg", 2.0)
        );
    }
    let clear =
        |one: &&Value| number(one, "error").zip(number(one, "std")).is_some_and(|(e, s)| e.abs() > 2.0 * s);
    for one in list(found, "calibrations").iter().filter(clear) {
        let _ =
            writeln!(html, "<p>The calibration of {} is off by {}.</p>", text(one, "channel"), with_std(one));
    }
    html
}

/// A relative error in per cent.
fn with_std(of: &Value) -> String {
    match number(of, "error").zip(number(of, "std")) {
        Some((error, std)) => {
            // Adding zero takes the sign from a zero.
            let rounded = (1e4 * error).round() / 100.0 + 0.0;
            format!("{rounded:+.2} ± {:.2} %", 200.0 * std).replace('-', "−")
        }
        None => "–".into(),
    }
}

/// A heading below those that the table of contents lists.
pub(super) fn sub(title: &str) -> String {
    format!("<h4>{title}</h4>")
}

/// A table with the name `title` for readers without eyes.
pub(super) fn table(title: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    let heads: String = heads.iter().map(|head| format!("<th>{head}</th>")).collect();
    let mut html = format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{title}\"><table class=\"plain\"><thead><tr>{heads}</tr></thead><tbody>"
    );
    for row in rows {
        html += "<tr>";
        row.iter().for_each(|cell| {
            let _ = write!(html, "<td>{cell}</td>");
        });
        html += "</tr>";
    }
    html + "</tbody></table></div>\n"
}

/// What 1 % of known factors does to the unknowns, where that is much.
fn leverage(results: &Results) -> String {
    let is_of_mesh = |one: &Value| one.get("mesh").is_some();
    // All known factors have one limit: which of them it is does not matter.
    let of = |one: &Value| if is_of_mesh(one) { LeverageOf::Mesh } else { LeverageOf::Factor(0) };
    let large =
        |one: &&Value| number(one, "percent_by_percent").is_some_and(|change| change > of(one).large());
    let mut all: Vec<&Value> = results.summary.array("/leverage").iter().filter(large).collect();
    let change = |one: &Value| number(one, "percent_by_percent").unwrap_or(0.0);
    all.sort_by(|a, b| change(b).total_cmp(&change(a)));
    if all.is_empty() {
        return String::new();
    }
    let sentence = |one: &&Value| {
        let text = |key: &str| escape(one.get(key).and_then(Value::as_str).unwrap_or(""));
        let (unknown, change) = (text("unknown"), significant(change(one), 2));
        match is_of_mesh(one) {
            true => format!(
                "<li>A mesh whose natural frequencies are 1 % too high at the end of the band changes {unknown} there by {change} %. \
                 A second, coarser mesh (<code>coarser_mesh</code> in the case) shows the error of this mesh.</li>"
            ),
            false => {
                format!("<li>An error of 1 % in {} changes {unknown} by {change} %.</li>", text("matrix"))
            }
        }
    };
    let items: String = all.iter().map(sentence).collect();
    format!(
        "{}<ul>{items}</ul><p class=\"note\">The case can state how well a factor is known, for example <code>storage_std = \"2 %\"</code> beside it. The error bars then contain this.</p>\n",
        heading("leverage", "What errors of known values would do")
    )
}
