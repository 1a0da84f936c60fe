//! What is read: head, verdict, and where everything comes from.

use super::model_errors::{list, number};
use super::together::constants;
use crate::escape::escape;
use crate::number::{hertz, significant, with_bar};
use crate::results::{Results, Unknown};
use crate::status::label;
use crate::verdict::{Level, Verdict};
use frfit::c64;
use frfit::identify::Status;
use frfit::material::loss_factor;
use serde_json::Value;
use std::fmt::Write;

pub(super) fn header(title: &str, results: &Results) -> String {
    let one = |one: &Unknown| {
        let how = match one.varies.as_str() {
            "law" => "a law over the band",
            "smooth" => "a smooth curve over the band",
            "constant" => "one value for the band",
            _ => "a value at every frequency",
        };
        format!("{}: {how}", one.name)
    };
    let how = results.unknowns.iter().map(one).collect::<Vec<_>>().join("; ");
    format!(
        "<header class=\"page\"><div><p class=\"kicker\">Finite element model against measurement</p><h1>{}</h1>\
         <p class=\"sub\">{}, {} sensor{}</p></div>\
         <button type=\"button\" id=\"theme\" class=\"screen\" aria-live=\"polite\">Dark</button></header>\n",
        escape(title),
        escape(&how),
        results.sensors.len(),
        if results.sensors.len() == 1 { "" } else { "s" },
    )
}

pub(super) fn verdict(results: &Results, verdict: &Verdict) -> String {
    let (class, word) = match verdict.level {
        Level::Good => ("good", "Can be used"),
        Level::Care => ("care", "Use with care"),
        Level::Bad => ("bad", "Do not use yet"),
    };
    let mut html = format!(
        "<section id=\"verdict\" aria-labelledby=\"verdict-title\"><h2 id=\"verdict-title\" class=\"{class}\"><span>{word}</span></h2>\
         <p class=\"headline\">{}</p>\n<dl class=\"tiles\">",
        escape(&verdict.headline)
    );
    // Writing to a string does not fail.
    for tile in &verdict.tiles {
        let _ = write!(
            html,
            "<div><dt>{}</dt><dd class=\"value\">{}</dd><dd class=\"detail\">{}</dd></div>",
            escape(&tile.label),
            escape(&tile.value),
            escape(&tile.detail)
        );
    }
    html += "</dl>\n";
    html += &strip(results, verdict);
    html += &findings(results);
    if !verdict.cautions.is_empty() {
        html += "<h3>Before the numbers are used</h3><ul>";
        for caution in &verdict.cautions {
            let _ = write!(html, "<li>{}</li>", escape(caution));
        }
        html += "</ul>\n";
    }
    html += &constants(results);
    for one in results.unknowns.iter().filter(|one| one.is_curve()) {
        html += &three_rows(results, one);
    }
    html + &laws(results) + "</section>\n"
}

/// The statuses over frequency as a strip, and in words.
fn strip(results: &Results, verdict: &Verdict) -> String {
    let band = &results.band;
    let (first, last) = (band.frequency_hz[0], band.frequency_hz[band.len() - 1]);
    let width = |f: f64| if last > first { 1000.0 * (f - first) / (last - first) } else { 1000.0 };
    let mut rects = String::new();
    let mut start = 0;
    let mut drawn = -1.0;
    for row in 1..=band.len() {
        if row < band.len() && band.status[row] == band.status[start] {
            continue;
        }
        // From half-way to the neighbour before to half-way to the one behind.
        let edge = |row: usize| match row {
            0 => first,
            row if row >= band.len() => last,
            row => f64::midpoint(band.frequency_hz[row - 1], band.frequency_hz[row]),
        };
        let (x, end) = (width(edge(start)), width(edge(row)));
        // Narrower than a third of a pixel nothing is seen, and a page has room for some thousand.
        if end - drawn > 0.35 {
            let _ = write!(
                rects,
                "<rect class=\"{}\" x=\"{x:.2}\" width=\"{:.2}\" height=\"20\"/>",
                band.status[start].name(),
                (end - x).max(0.35)
            );
            drawn = end;
        }
        start = row;
    }
    let mut html = format!(
        "<h3>{}</h3><figure class=\"strip\"><svg viewBox=\"0 0 1000 20\" preserveAspectRatio=\"none\" role=\"img\" \
         aria-label=\"Status over frequency; the list below says the same in words\">{rects}</svg>\
         <figcaption><span>{}</span><span>{}</span></figcaption></figure><ul class=\"shares\">",
        if verdict.own {
            "Where the answer can be trusted"
        } else {
            "Where the values explain the measurements"
        },
        hertz(first),
        hertz(last)
    );
    for share in &verdict.shares {
        let _ = write!(
            html,
            "<li><span class=\"dot {}\"></span><b>{} {}</b> – {}</li>",
            share.status.name(),
            share.count,
            share.label,
            escape(&share.words)
        );
    }
    html + "</ul>\n"
}

fn findings(results: &Results) -> String {
    let findings = results.summary.array("/findings");
    let checked = results.summary.0.get("findings").is_some_and(|found| !found.is_null());
    let undecided = undecided(results.summary.undecided());
    if findings.is_empty() && !undecided.is_empty() {
        return undecided;
    }
    if findings.is_empty() {
        let said = match checked {
            true => {
                "The measurements were compared with the model (sign, quantity, units, delay, position of sensors and load): no fault of them was found. Errors of the model are given below."
            }
            false => "The measurements were not looked at for mistakes: frfit check does.",
        };
        return format!("<p>{said}</p>\n");
    }
    let mut html = "<h3>What seems wrong with the data</h3><ul class=\"findings\">".to_owned();
    for finding in findings {
        let number = |key: &str| {
            finding.pointer(&format!("/evidence/{key}")).and_then(Value::as_f64).map(|v| significant(v, 2))
        };
        let evidence = match (number("misfit_before"), number("misfit_after")) {
            (Some(before), Some(after)) => {
                format!(" Misfit of ln(measured/model) {before} before, {after} after.")
            }
            _ => String::new(),
        };
        let _ = write!(
            html,
            "<li><b>{}</b>.{evidence} Change <code>{}</code></li>",
            fault(finding),
            text(finding, "change")
        );
    }
    html += "</ul>\n";
    if let Some(other) = results.summary.array("/other_explanations").first().filter(|_| undecided.is_empty())
    {
        let _ = writeln!(html, "<p>The likeliest other explanation: {}</p>", explanation(other));
    }
    html + &undecided
}

fn text(value: &Value, key: &str) -> String {
    escape(value.get(key).and_then(Value::as_str).unwrap_or(""))
}

/// What is wrong, and with which sensors.
fn fault(value: &Value) -> String {
    let sensors: Vec<String> = list(value, "sensors").iter().filter_map(Value::as_str).map(escape).collect();
    let who = if sensors.is_empty() { String::new() } else { format!("{}: ", sensors.join(", ")) };
    who + &text(value, "what")
}

/// The section that lists the explanations between which the data do not decide; empty without one.
fn undecided(others: &[Value]) -> String {
    if others.is_empty() {
        return String::new();
    }
    let items: Vec<String> = others.iter().map(|other| format!("<li>{}</li>", explanation(other))).collect();
    format!(
        "<h3>What may be wrong with the data</h3>\n\
         <p>Each of these would explain the data. Their likelihoods differ too little to decide.</p>\n\
         <ul class=\"findings\">{}</ul>\n",
        items.concat()
    )
}

/// Faults together, and how likely they are.
fn explanation(other: &Value) -> String {
    let faults: Vec<String> = list(other, "faults").iter().map(fault).collect();
    let digits = |key: &str| number(other, key).map_or_else(String::new, |value| significant(value, 2));
    format!(
        "<b>{}</b>. Misfit of ln(measured/model) {}, {} nats behind the best.",
        faults.join("; and "),
        digits("misfit"),
        digits("nats_behind")
    )
}

/// The lowest, the middle and the highest trusted frequency of an unknown.
fn three_rows(results: &Results, one: &Unknown) -> String {
    let band = &results.band;
    let at = |part: &str, row: usize| band.at(&one.column(part), row);
    let rows: Vec<usize> = band.rows(Status::Ok).filter(|&row| at("storage", row).is_some()).collect();
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return String::new() };
    let mut picked = vec![*first, rows[rows.len() / 2], *last];
    picked.dedup();
    let has_bars = picked.iter().any(|&row| at("storage_std", row).is_some());
    let (title, of) = match one.prefix.as_str() {
        "" => (one.what()[0].to_owned(), String::new()),
        _ => (format!("{}: {}", one.name, one.what()[0]), format!(" of {}", one.name)),
    };
    let mut html = format!(
        "<h3>Lowest, middle and highest trusted frequency{}</h3><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Values at three frequencies{0}\"><table class=\"plain\">\
         <thead><tr><th>Frequency</th><th>{}{}</th>{}<th>Nominal</th></tr></thead><tbody>",
        escape(&of),
        escape(&title),
        if has_bars { ", ± two standard deviations" } else { "" },
        if one.real { "" } else { "<th>Loss factor η</th>" }
    );
    for row in picked {
        let cell = |part: &str, std: &str, unit| {
            at(part, row).map_or("–".into(), |value| with_bar(value, at(std, row), unit))
        };
        let eta = |factor: c64| format!(", η {}", significant(loss_factor(factor), 4));
        let nominal = one.nominal[row].map_or("–".into(), |factor| {
            let eta = if one.real { String::new() } else { eta(factor) };
            format!("{}{eta}", with_bar(factor.re, None, one.unit()))
        });
        let loss = match one.real {
            true => String::new(),
            false => format!("<td>{}</td>", escape(&cell("loss_factor", "loss_factor_std", ""))),
        };
        let _ = write!(
            html,
            "<tr><td>{}</td><td>{}</td>{loss}<td>{}</td></tr>",
            escape(&hertz(band.frequency_hz[row])),
            escape(&cell("storage", "storage_std", one.unit())),
            escape(&nominal)
        );
    }
    html + "</tbody></table></div>\n"
}

/// The law or the smooth curve, where there is one.
fn laws(results: &Results) -> String {
    let summary = &results.summary;
    let laws = summary.array("/laws/laws");
    let mut html = String::new();
    if !laws.is_empty() {
        let best = summary.word("/laws/best");
        html += "<h3>Laws fitted to the whole band</h3><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Fitted laws\"><table class=\"plain\"><thead><tr><th>Law</th><th>Parameters, ± two standard deviations</th>\
                 <th>χ² per degree of freedom</th><th>BIC</th></tr></thead><tbody>";
        for law in laws {
            let name = law.get("law").and_then(Value::as_str).unwrap_or("");
            let parameters: Vec<String> = law
                .get("parameters")
                .and_then(Value::as_object)
                .into_iter()
                .flatten()
                .filter_map(|(name, parameter)| {
                    let number = |key: &str| parameter.get(key).and_then(Value::as_f64);
                    let unit = parameter.get("unit").and_then(Value::as_str).unwrap_or("");
                    let unit = if unit == "1" { "" } else { unit };
                    Some(format!("{name} = {}", with_bar(number("value")?, number("std"), unit)))
                })
                .collect();
            let number =
                |key: &str| law.get(key).and_then(Value::as_f64).map_or("–".into(), |v| significant(v, 4));
            let mark = if name == best { " (best)" } else { "" };
            let _ = write!(
                html,
                "<tr><td>{}{mark}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                escape(name),
                escape(&parameters.join("; ")),
                number("chi_squared_per_degree_of_freedom"),
                number("bic")
            );
        }
        html += "</tbody></table></div>\n";
    }
    if let (Some(parameters), Some(width)) =
        (summary.number("/smooth/parameters"), summary.number("/smooth/width_octaves"))
    {
        let _ = writeln!(
            html,
            "<p>The smooth curve takes {} parameters from the data, one for {} octaves.</p>",
            significant(parameters, 3),
            significant(width, 2)
        );
    }
    html
}

/// Files with checksums, options, work, version.
pub(super) fn provenance(results: &Results, own: bool) -> String {
    let summary = &results.summary;
    let mut html = "<section id=\"provenance\" aria-labelledby=\"provenance-title\"><h2 id=\"provenance-title\">Where this comes from</h2>\
                    <h3>Input files</h3><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Input files\"><table class=\"plain files\">\
                    <thead><tr><th>File</th><th>Bytes</th><th>SHA-256</th></tr></thead><tbody>"
        .to_owned();
    for input in summary.array("/inputs") {
        let text = |key: &str| escape(input.get(key).and_then(Value::as_str).unwrap_or(""));
        let bytes = input.get("bytes").and_then(Value::as_u64).unwrap_or(0);
        let _ = write!(
            html,
            "<tr><td>{}</td><td>{bytes}</td><td><code>{}</code></td></tr>",
            text("file"),
            text("sha256")
        );
    }
    html += "</tbody></table></div>\n<div class=\"columns\">";
    for (title, pointer) in [
        ("Model", "/model"),
        ("Options", "/identify"),
        ("Search", "/search"),
        ("Noise", "/noise"),
        ("Fit", "/fit"),
        ("Work", "/counts"),
        ("Seconds", "/seconds"),
    ] {
        let Some(object) = summary.0.pointer(pointer).and_then(Value::as_object) else { continue };
        let _ = write!(html, "<div><h3>{title}</h3><dl class=\"pairs\">");
        for (key, value) in object {
            let _ =
                write!(html, "<dt>{}</dt><dd>{}</dd>", escape(&key.replace('_', " ")), escape(&shown(value)));
        }
        html += "</dl></div>";
    }
    let statuses = Status::ALL
        .map(|status| format!("{} is <code>{}</code>", label(status, own), status.name()))
        .join(", ");
    let _ = write!(
        html,
        "</div>\n<p>Made by frfit {} from the files beside this page. In them {statuses}. Plots are drawn by plotly.js (MIT licence, Plotly, Inc.), \
         which is in this file; nothing is loaded from elsewhere.</p></section>\n",
        escape(summary.word("/frfit"))
    );
    html
}

/// A value of the summary in a few words.
fn shown(value: &Value) -> String {
    match value {
        Value::Null => "–".into(),
        Value::Bool(true) => "yes".into(),
        Value::Bool(false) => "no".into(),
        Value::Number(number) if !number.is_f64() => number.to_string(),
        Value::Number(number) => significant(number.as_f64().unwrap_or(f64::NAN), 4),
        Value::String(text) => text.clone(),
        Value::Array(values) if values.is_empty() => "–".into(),
        Value::Array(values) => values.iter().map(shown).collect::<Vec<_>>().join(", "),
        Value::Object(object) => object
            .iter()
            .map(|(key, value)| format!("{} {}", key.replace('_', " "), shown(value)))
            .collect::<Vec<_>>()
            .join(", "),
    }
}
