//! What is said of numbers that hold for the band, and how well they are identifiable.

use super::plots::{absent, plot};
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
    let mut html = "<h3>What holds for the whole band</h3><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Values for the band\">\
                    <table class=\"plain\"><thead><tr><th>Unknown</th><th>Value, ± two standard deviations</th><th>Nominal</th><th>Status</th></tr></thead><tbody>"
        .to_owned();
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
    html + "</tbody></table></div><p class=\"note\">Values have the units of the case. A bar holds with all other unknowns free, and with the errors of the model that are given below.</p>\n"
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
        0 => absent(
            "Correlation",
            "for no unknown holds for the whole band: every frequency has values of its own.",
        ),
        1 => absent("Correlation", "for a single number has no correlation."),
        _ => {
            let reading = "1 or −1: only the sum or the difference of the two is identifiable. Near 0: each is by itself.";
            plot("correlation", "Correlation", reading) + &table(found)
        }
    };
    correlation + &profile(found)
}

/// The misfit along the least identifiable combination.
fn profile(found: &Identifiability) -> String {
    const TITLE: &str = "Misfit along the least identifiable combination";
    let Some(least) = found.least.as_ref().filter(|_| !found.profile.is_empty()) else {
        return absent(TITLE, "for there is no such combination, or the search found none.");
    };
    let bar = match least.std {
        Some(std) => format!(
            "A change of 4 is two standard deviations, {}. Where circles leave the dashed curve, the error bar is not the whole truth.",
            percent(2.0 * std)
        ),
        None => "It does not become worse: the measurements do not limit it.".into(),
    };
    let reading = format!(
        "How much worse the fit becomes when the values move along this combination, all else at its best: {}. {bar}",
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
        let by = if part > 0.99 { String::new() } else { format!(" (by {} of that)", significant(part, 2)) };
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
