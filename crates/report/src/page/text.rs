//! What is read: head, verdict, and the identified values in numbers.

use super::model_errors::{list, number};
use super::together::constants;
use super::{heading, section};
use crate::escape::escape;
use crate::number::{hertz, significant, with_bar};
use crate::results::{Results, Unknown};
use crate::stretches::{Stretch, stretches};
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
        "<header class=\"page\"><div><p class=\"kicker\">Finite element model updated to a measurement</p><h1>{}</h1>\
         <p class=\"sub\">Identified: {}. {} sensor{}.</p></div>\
         <button type=\"button\" id=\"theme\" class=\"screen\" aria-live=\"polite\">Dark</button></header>\n",
        escape(title),
        escape(&how),
        results.sensors.len(),
        if results.sensors.len() == 1 { "" } else { "s" },
    )
}

/// How far the result can be used, and what to do first.
pub(super) fn verdict(results: &Results, verdict: &Verdict) -> String {
    let (class, word) = match verdict.level {
        Level::Good => ("good", "✓ Can be used"),
        Level::Care => ("care", "! Use with care"),
        Level::Bad => ("bad", "✗ Do not use yet"),
    };
    let mut html = format!(
        "<section id=\"verdict\" class=\"{class}\" aria-labelledby=\"verdict-title\"><h2 id=\"verdict-title\">Verdict</h2>\
         <p class=\"headline\"><b class=\"badge\">{word}</b> {}</p>\n{}",
        escape(&verdict.headline),
        first(results, verdict)
    );
    html += &heading("key-figures", "Key figures");
    html += "<dl class=\"tiles\">";
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
    html + &strip(results, verdict) + "</section>\n"
}

/// What to do first: faults of the data, then what is to be known before the numbers are used, and what follows.
fn first(results: &Results, verdict: &Verdict) -> String {
    let mut html = heading("first", "What to do first");
    let mut steps: Vec<String> = results.summary.array("/findings").iter().map(finding).collect();
    if verdict.level == Level::Good {
        steps.push(
            "Use the values in identified.csv, with their standard deviations where there are any. <code>frfit export</code> writes them for Nastran, Abaqus or Ansys."
                .into(),
        );
    }
    steps.extend(verdict.cautions.iter().map(|caution| escape(caution)));
    if !results.summary.array("/modes/measured/modes").is_empty() {
        steps.push(
            "Compare the <a href=\"#modes\">natural frequencies of model and measurement</a>, mode by mode."
                .into(),
        );
    }
    if verdict.level == Level::Care && verdict.own && verdict.shares.len() > 1 {
        steps.push(
            "Use the values of trusted frequencies only. <a href=\"#where\">The list of statuses</a> gives the reasons at the others."
                .into(),
        );
    }
    if !steps.is_empty() {
        let items: String = steps.iter().map(|step| format!("<li>{step}</li>")).collect();
        let _ = writeln!(html, "<ol class=\"steps\">{items}</ol>");
    }
    html + &checked(results)
}

/// The identified values: those of the whole band, then curves, then numbers at three frequencies and laws.
pub(super) fn result(results: &Results, plots: &str) -> String {
    let mut html = constants(results) + plots;
    for one in results.unknowns.iter().filter(|one| one.is_curve()) {
        html += &three_rows(results, one);
    }
    html += &laws(results);
    section("result", "Result: identified values", &html)
}

/// The statuses over frequency as a strip, and in words.
fn strip(results: &Results, verdict: &Verdict) -> String {
    let band = &results.band;
    let (first, last) = (band.frequency_hz[0], band.frequency_hz[band.len() - 1]);
    let place = |f: f64| if last > first { 100.0 * (f - first) / (last - first) } else { 0.0 };
    let piece = |one: &Stretch| {
        let width = if last > first { place(one.to) - place(one.from) } else { 100.0 };
        let name = one.status.name();
        format!("<i class=\"tint {name}\" style=\"left:{:.3}%;width:{width:.3}%\"></i>", place(one.from))
    };
    let pieces: String = stretches(band).iter().map(piece).collect();
    let mut html = heading(
        "where",
        if verdict.own {
            "Where the values can be trusted"
        } else {
            "Where the values explain the measurements"
        },
    );
    let _ = write!(
        html,
        "<figure class=\"strip\"><div role=\"img\" aria-label=\"Status over frequency; the list below gives the same in words\">{pieces}</div>\
         <figcaption><span>{}</span><span>{}</span></figcaption></figure><ul class=\"shares\">",
        hertz(first),
        if last > first { hertz(last) } else { String::new() }
    );
    for share in &verdict.shares {
        let _ = write!(
            html,
            "<li><span class=\"tint {}\"></span><b>{} {}</b>: {}</li>",
            share.status.name(),
            share.count,
            share.label,
            escape(&share.words)
        );
    }
    html + "</ul>\n"
}

/// A fault of the data, and what to change.
fn finding(finding: &Value) -> String {
    let number = |key: &str| {
        finding.pointer(&format!("/evidence/{key}")).and_then(Value::as_f64).map(|v| significant(v, 2))
    };
    let evidence = match (number("misfit_before"), number("misfit_after")) {
        (Some(before), Some(after)) => {
            format!(" This reduces the misfit of ln(measured/model) from {before} to {after}.")
        }
        _ => String::new(),
    };
    format!("<b>{}</b>. Change <code>{}</code>.{evidence}", fault(finding), text(finding, "change"))
}

/// Whether the data were checked for faults, and explanations between which they do not decide.
fn checked(results: &Results) -> String {
    let findings = results.summary.array("/findings");
    let is_checked = results.summary.0.get("findings").is_some_and(|found| !found.is_null());
    let undecided = undecided(results.summary.undecided());
    if !undecided.is_empty() {
        return undecided;
    }
    match (findings.is_empty(), results.summary.array("/other_explanations").first()) {
        (true, _) if is_checked => "<p>The check of the measurements (sign, quantity, units, delay, position of sensors and load) found no fault.</p>\n".into(),
        (true, _) => "<p>The measurements were not checked for faults: run <code>frfit check</code>.</p>\n".into(),
        (false, Some(other)) => format!("<p>The likeliest other explanation: {}</p>\n", explanation(other)),
        (false, None) => String::new(),
    }
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
        "{}\n<p>Each of these faults would explain the data. Their likelihoods differ too little to decide: check each of them at the test rig.</p>\n\
         <ul class=\"findings\">{}</ul>\n",
        heading("may-be-wrong", "What may be wrong with the data"),
        items.concat()
    )
}

/// Faults together, and how likely they are.
fn explanation(other: &Value) -> String {
    let faults: Vec<String> = list(other, "faults").iter().map(fault).collect();
    let digits = |key: &str| number(other, key).map_or_else(String::new, |value| significant(value, 2));
    format!(
        "<b>{}</b>. Misfit of ln(measured/model) {}; log-likelihood {} below the best (in nats).",
        faults.join("; and "),
        digits("misfit"),
        digits("nats_behind")
    )
}

/// What distinguishes the headings of an unknown from those of another one.
fn id_of(results: &Results, one: &Unknown) -> String {
    let place = results.unknowns.iter().position(|other| other.name == one.name);
    place.filter(|_| !one.prefix.is_empty()).map_or(String::new(), |place| format!("-{}", place + 1))
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
        "{}<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Values at three frequencies{1}\"><table class=\"plain\">\
         <thead><tr><th>Frequency</th><th>{2}{3}</th>{4}<th>{5}</th></tr></thead><tbody>",
        heading(
            &format!("three{}", id_of(results, one)),
            &format!("Values{} at three frequencies", escape(&of))
        ),
        escape(&of),
        escape(&title),
        if has_bars { ", ± two standard deviations" } else { "" },
        if one.real { "" } else { "<th>Loss factor η</th>" },
        if one.real { "Nominal value" } else { "Nominal value, η" }
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
        html += &heading("laws", "Material laws fitted to the whole band");
        html += "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Fitted laws\"><table class=\"plain\"><thead><tr><th>Law</th><th>Parameters, ± two standard deviations</th>\
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
            "<p>The smooth curve has {} parameters, one for each {} octaves.</p>",
            significant(parameters, 3),
            significant(width, 2)
        );
    }
    html
}
