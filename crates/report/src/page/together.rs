//! Numbers that hold for the band, and how well they are identifiable.

use super::heading;
use super::model_errors::bars_contain;
use super::plots::plot;
use crate::escape::escape;
use crate::number::{percent, significant};
use crate::results::{Identifiability, Number, Results, Unknown};
use crate::status::label;
use frfit::material::loss_factor;
use std::fmt::Write;

/// Weights below this part of the largest are left out of a sentence.
const SMALL: f64 = 0.05;

/// The numbers that hold for the band.
pub(super) fn constants(results: &Results) -> String {
    // The table of laws has the numbers of a single unknown's.
    let is_law = !results.summary.array("/laws/laws").is_empty();
    let held: Vec<&Unknown> = results.unknowns.iter().filter(|one| !one.numbers.is_empty()).collect();
    if held.is_empty() || is_law {
        return String::new();
    }
    let mut html = heading("constants", "Values for the whole band");
    html += "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Values for the band\">\
                    <table class=\"plain\"><thead><tr><th>Unknown</th><th>Value, ± two standard deviations</th><th>Nominal value</th><th>Status</th></tr></thead><tbody>";
    for one in held {
        for number in &one.numbers {
            let what = if number.name == "value" {
                String::new()
            } else {
                format!(" {}", number.name.replace('_', " "))
            };
            // Writing to a string does not fail.
            let _ = write!(
                html,
                "<tr><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                escape(&one.name),
                escape(&what),
                value(one, number),
                nominal(one, number).map_or("–".into(), |value| significant(value, 5)),
                one.status.map_or("–", |status| label(status, true))
            );
        }
    }
    let contained = bars_contain(results).map_or(String::new(), |parts| format!(", and contain {parts}"));
    html + &format!(
        "</tbody></table></div><p class=\"note\">Values have the units of the case. The standard deviations hold with all other unknowns free{contained}.</p>\n"
    )
}

fn value(one: &Unknown, number: &Number) -> String {
    if one.is_known(number) { one.shown(number, number.std) } else { "not identifiable".into() }
}

/// The nominal value of a constant's number; a law's has none of its own.
fn nominal(one: &Unknown, number: &Number) -> Option<f64> {
    let nominal = one.nominal.first().copied().flatten().filter(|_| one.varies == "constant")?;
    match number.name.as_str() {
        "value" | "storage" => Some(nominal.re),
        "loss_factor" => Some(loss_factor(nominal)),
        _ => None,
    }
}

/// Plots of correlation and misfit, or why they are not there; nothing of a single unknown without numbers that hold for the band.
pub(super) fn together(results: &Results) -> String {
    let found = &results.identifiability;
    let correlation = match found.coordinates.len() {
        0 if results.unknowns.len() == 1 => return String::new(),
        // Every frequency has values of its own, or there is nothing to be correlated with.
        0 | 1 => String::new(),
        _ => {
            let reading = "Near 0 both values are identifiable independently. At 1 or −1 only a combination of the two is identifiable.";
            plot("correlation", "Correlation of the identified values", reading) + &table(found)
        }
    };
    correlation + &profile(found)
}

/// The misfit along the least identifiable combination.
fn profile(found: &Identifiability) -> String {
    const TITLE: &str = "How well the least identifiable combination is known";
    let Some(least) = found.least.as_ref().filter(|_| !found.profile.is_empty()) else {
        return String::new();
    };
    let bar = match least.std {
        Some(std) => format!(
            "Two standard deviations ({}) are where χ² has grown by 4. Where the circles leave the dashed curve, the error bar is only approximate.",
            percent(2.0 * std)
        ),
        None => "The fit does not become worse: the measurements do not limit this combination.".into(),
    };
    let reading = format!(
        "How much χ² grows when the values are moved along this combination ({}) and all other values are fitted again. {bar}",
        escape(&direction(&least.weights))
    );
    plot("profile", TITLE, &reading)
}

/// `component larger, beam storage larger (by 0.05 of that)`.
fn direction(weights: &[(String, f64)]) -> String {
    let largest = weights.iter().map(|(_, weight)| weight.abs()).fold(0.0, f64::max);
    let kept = weights.iter().filter(|(_, weight)| weight.abs() >= SMALL * largest);
    let one = |(name, weight): &(String, f64)| {
        let way = if *weight > 0.0 { "larger" } else { "smaller" };
        let part = weight.abs() / largest;
        let by = if part > 0.99 { String::new() } else { format!(" (by {} of this)", significant(part, 2)) };
        format!("{} {way}{by}", name.replace('_', " "))
    };
    kept.map(one).collect::<Vec<_>>().join(", ")
}

/// The correlation in numbers.
fn table(found: &Identifiability) -> String {
    let heads: String = (1..=found.coordinates.len()).map(|k| format!("<th>{k}</th>")).collect();
    let mut html = format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Correlation in numbers\"><table><thead><tr><th>Number</th>{heads}</tr></thead><tbody>"
    );
    for (k, (name, row)) in found.coordinates.iter().zip(&found.correlation).enumerate() {
        let _ = write!(html, "<tr><td>{} {}</td>", k + 1, escape(&name.replace('_', " ")));
        for value in row {
            // Adding zero takes the sign from a zero.
            let round = |value: f64| (1000.0 * value).round() / 1000.0 + 0.0;
            let shown = value.map_or("–".into(), |value| format!("{:.3}", round(value)).replace('-', "−"));
            let _ = write!(html, "<td>{shown}</td>");
        }
        html += "</tr>";
    }
    html + "</tbody></table></div>\n"
}
