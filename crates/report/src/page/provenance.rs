//! Where the results come from: files with checksums, settings, computing time, version.

use crate::escape::escape;
use crate::number::{hertz, significant};
use crate::results::{ERROR_MAP, FREE, Results};
use crate::status::label;
use crate::verdict::noise;
use frfit::identify::Status;
use serde_json::Value;
use std::fmt::Write;

/// A row of a table: what it is, and its value.
type Row = (String, String);

pub(super) fn provenance(results: &Results, own: bool) -> String {
    let summary = &results.summary;
    let mut html = "<h3>Input files</h3><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Input files\"><table class=\"plain files\">\
                    <thead><tr><th>File</th><th>Bytes</th><th>SHA-256</th></tr></thead><tbody>"
        .to_owned();
    for input in summary.array("/inputs") {
        let text = |key: &str| escape(input.get(key).and_then(Value::as_str).unwrap_or(""));
        let bytes = input.get("bytes").and_then(Value::as_u64).unwrap_or(0);
        // Writing to a string does not fail.
        let _ = write!(
            html,
            "<tr><td>{}</td><td>{bytes}</td><td><code>{}</code></td></tr>",
            text("file"),
            text("sha256")
        );
    }
    html += "</tbody></table></div>\n<div class=\"columns\">";
    for (title, rows) in
        [("Model", model(results)), ("Settings", settings(results)), ("Computation", computation(results))]
    {
        if rows.is_empty() {
            continue;
        }
        let _ = write!(html, "<div><h3>{title}</h3><dl class=\"pairs\">");
        for (what, value) in rows {
            let _ = write!(html, "<dt>{}</dt><dd>{}</dd>", escape(&what), escape(&value));
        }
        html += "</dl></div>";
    }
    let statuses = Status::ALL
        .map(|status| format!("{} is <code>{}</code>", label(status, own), status.name()))
        .join(", ");
    let _ = write!(
        html,
        "</div>\n<h3>Files beside this page</h3><p>{}. In these files {statuses}.</p>\n\
         <p>Made by frfit {}. Plots are drawn by plotly.js (MIT licence, Plotly, Inc.), which is in this file. Nothing is loaded from elsewhere.</p>\n",
        files(results),
        escape(summary.word("/frfit"))
    );
    html
}

/// Links to the files of the run.
fn files(results: &Results) -> String {
    let optional = [(results.free.is_some(), FREE), (results.error_map.is_some(), ERROR_MAP)];
    let mut all = vec![
        ("identified.csv", "all values with their standard deviations"),
        ("response.csv", "the responses"),
        ("candidates.csv", "all solutions"),
        ("reference.csv", "nominal and known values"),
    ];
    all.extend(optional.into_iter().filter(|(is_there, _)| *is_there).map(|(_, name)| match name {
        FREE => (name, "each frequency alone"),
        name => (name, "the error over frequency and order"),
    }));
    all.push(("summary.json", "everything else, for programs"));
    all.into_iter()
        .map(|(name, what)| format!("<a href=\"{name}\" download>{name}</a> ({what})"))
        .collect::<Vec<_>>()
        .join(", ")
}

fn model(results: &Results) -> Vec<Row> {
    let summary = &results.summary;
    let mut rows: Vec<Row> = Vec::new();
    let count =
        |pointer: &str| summary.0.pointer(pointer).and_then(Value::as_u64).map(|count| count.to_string());
    rows.extend(count("/model/dofs").map(|count| ("Degrees of freedom".into(), count)));
    rows.extend(
        count("/model/nonzeros").map(|count| ("Entries of the matrices that are not zero".into(), count)),
    );
    let engine = summary.word("/model/engine");
    if !engine.is_empty() {
        rows.push(("Solver of the matrices".into(), engine.into()));
    }
    for matrix in summary.array("/model/matrices") {
        let text = |key: &str| matrix.get(key).and_then(Value::as_str).unwrap_or("");
        rows.push((format!("Matrix {}", text("name")), text("role").into()));
    }
    let units = ["length", "mass", "time", "force", "modulus"];
    let units: Vec<&str> = units.iter().map(|key| summary.word(&format!("/units/{key}"))).collect();
    if units.iter().all(|unit| !unit.is_empty()) {
        rows.push(("Units".into(), units.join(", ")));
    }
    rows
}

/// Settings in words; those that were not used are left out.
fn settings(results: &Results) -> Vec<Row> {
    let summary = &results.summary;
    let mut rows: Vec<Row> = Vec::new();
    let mut add = |what: String, value: Option<String>| rows.extend(value.map(|value| (what, value)));
    for one in summary.array("/no_answer") {
        let reason = one.get("reason").and_then(Value::as_str).map(str::to_owned);
        let count = one.get("frequencies").and_then(Value::as_u64).unwrap_or(0);
        add(format!("No answer at {count} frequencies"), reason);
    }
    let method = summary.word("/identify/method");
    add(
        "Method".into(),
        Some(match (method, summary.number("/identify/order")) {
            ("series", Some(order)) => format!("Neumann series of {order} terms (series)"),
            ("rational", _) => "poles and residues of the response over the parameter (rational)".into(),
            _ => method.into(),
        }),
    );
    let selection = summary.word("/identify/selection");
    add(
        "Selection of a solution".into(),
        Some(match selection {
            "smallest" => "the smallest correction (smallest)".into(),
            "joint" => "all sensors and frequencies together (joint)".into(),
            _ => selection.into(),
        }),
    );
    add(
        "Frequency band".into(),
        range(summary.0.pointer("/identify/band_hz"))
            .map(|[from, to]| format!("{} to {}", hertz(from), hertz(to))),
    );
    let all = summary.array("/unknowns");
    for (one, json) in results.unknowns.iter().zip(all) {
        for (part, what, unit) in [
            ("storage", if one.real { "value" } else { "storage modulus" }, one.unit()),
            ("loss_factor", "loss factor", ""),
        ] {
            let bounds = range(json.pointer(&format!("/bounds/{part}")))
                .filter(|_| !(one.real && part == "loss_factor"));
            let words =
                bounds.map(|[from, to]| format!("{} to {} {unit}", significant(from, 4), significant(to, 4)));
            add(format!("Bounds of {}, {what}", one.name), words.map(|words| words.trim_end().to_owned()));
        }
    }
    add(
        "Errors of the model".into(),
        summary.0.pointer("/identify/model_error").and_then(|known| match known.as_str() {
            Some("none") => Some("taken as none".into()),
            Some("estimated") => Some("estimated from the band".into()),
            Some(other) => Some(other.into()),
            None => known.is_object().then(|| "given in the case".into()),
        }),
    );
    let yes = |pointer: &str| summary.0.pointer(pointer).and_then(Value::as_bool);
    add(
        "A sensor that contradicts the others".into(),
        yes("/identify/reject_outliers").map(|is_on| if is_on { "is left out" } else { "is kept" }.into()),
    );
    add("Coarser mesh".into(), yes("/identify/coarser_mesh").filter(|is_on| *is_on).map(|_| "used".into()));
    let left_out = summary.number("/identify/left_out").filter(|count| *count > 0.0);
    add("Frequencies left out".into(), left_out.map(|count| count.to_string()));
    add("Noise".into(), Some(noise(results).into()));
    rows
}

fn computation(results: &Results) -> Vec<Row> {
    let summary = &results.summary;
    let mut rows: Vec<Row> = Vec::new();
    for (pointer, what) in [
        ("/counts/factorisations", "Factorisations of the model"),
        ("/counts/solves", "Solutions of linear systems"),
        ("/counts/subspace_size", "Size of the reduced model"),
        ("/counts/reduction_error", "Largest reduction error"),
    ] {
        rows.extend(summary.number(pointer).map(|count| (what.to_owned(), significant(count, 6))));
    }
    if let Some(starts) = summary.number("/search/starts").filter(|starts| *starts > 0.0) {
        let agreeing = summary.number("/search/agreeing").unwrap_or(0.0);
        rows.push((
            "Starts of the search".into(),
            format!("{starts}, of which {agreeing} ended at this result"),
        ));
    }
    let about: Vec<String> = (summary.array("/search/about").iter())
        .filter_map(|factor| Some(significant(factor.as_f64()?, 3)))
        .collect();
    if !about.is_empty() {
        let what = "times the nominal values, where natural frequencies are the measured ones";
        rows.push(("Searched about".into(), format!("{} {what}", about.join(", "))));
    }
    for (key, what) in [
        ("load", "reading"),
        ("check", "check of the data"),
        ("identify", "identification"),
        ("figures", "figures"),
    ] {
        let seconds = summary.number(&format!("/seconds/{key}"));
        rows.extend(
            seconds.map(|seconds| (format!("Time, {what}"), format!("{} s", significant(seconds, 2)))),
        );
    }
    rows
}

/// Two numbers.
fn range(of: Option<&Value>) -> Option<[f64; 2]> {
    Some([of?.get(0)?.as_f64()?, of?.get(1)?.as_f64()?])
}
