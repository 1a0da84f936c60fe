//! What is said of several unknowns: the numbers that hold for the band, and how they hang together.

use super::plots::{absent, plot, response, trust_of_band, write_sections};
use crate::escape::escape;
use crate::number::{percent, significant, with_bar};
use crate::results::{Number, Results, Several, Unknown};
use crate::verdict::label;
use frfit::material::loss_factor;
use std::fmt::Write;

/// Weights below this part of the largest are left out of a sentence.
const SMALL: f64 = 0.05;

/// How each unknown varies, for the head of the page.
pub(super) fn how(several: &Several) -> String {
    let one = |one: &Unknown| {
        let how = match one.varies.as_str() {
            "frequency" => "a value at every frequency",
            "constant" => "one value for the band",
            _ => "a law over the band",
        };
        format!("{}: {how}", one.name)
    };
    several.unknowns.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// All plots, in the order in which they are read.
pub(super) fn sections(results: &Results, several: &Several) -> String {
    let nyquist = plot(
        "nyquist",
        "Nyquist plot",
        "Imaginary over real part of the accelerance. Resonances are loops; measured and updated loops should be the same.",
    );
    let mut sections = vec![("response", "Response", response(results))];
    let curves: Vec<String> = several
        .unknowns
        .iter()
        .filter(|one| one.is_curve())
        .enumerate()
        .map(|(k, one)| plot(&format!("modulus-{}", k + 1), &escape(&one.name), &reading(results, one)))
        .collect();
    if !curves.is_empty() {
        sections.push(("factor", "Identified values", curves.concat()));
    }
    sections.push(("together", "How the values hang together", together(several)));
    sections.push((
        "trust",
        "Error and reduction error",
        format!("<div class=\"pair\">{}</div>\n", trust_of_band(results)),
    ));
    sections.push(("plane", "In the complex plane", nyquist));
    write_sections(sections)
}

fn reading(results: &Results, one: &Unknown) -> String {
    let std = one.columns()[1].clone().unwrap_or_default();
    let bars = match results.band.has(&std) {
        true => {
            "Bars and bands are two standard deviations of what noise does, all other unknowns free: 95 of 100 true values lie within, if the model is right."
        }
        false => "There are no error bars: nothing tells the noise.",
    };
    format!("{bars} Grey crosses are evidence only, not answers.")
}

/// The numbers that hold for the band.
pub(super) fn constants(several: &Several) -> String {
    let held: Vec<&Unknown> = several.unknowns.iter().filter(|one| !one.numbers.is_empty()).collect();
    if held.is_empty() {
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
    html + "</tbody></table></div><p class=\"note\">Values have the units of the case. A bar holds with all other unknowns free; errors of the model (mesh, supports, \
            what was taken for known) are not in it.</p>\n"
}

fn value(one: &Unknown, number: &Number) -> String {
    if one.is_told(number) { with_bar(number.value, number.std, "") } else { "not identifiable".into() }
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

fn together(several: &Several) -> String {
    let count = several.coordinates.len();
    let mut html = String::new();
    html += &match count {
        0 => absent(
            "Correlation",
            "for nothing holds for the whole band: every frequency has values of its own.",
        ),
        1 => absent("Correlation", "for one number has nothing to hang together with."),
        _ => {
            plot(
                "correlation",
                "Correlation",
                "1 or −1: only the sum or the difference of the two is told. Near 0: each is told by itself.",
            ) + &table(several)
        }
    };
    match &several.worst {
        Some(worst) if !several.profile.is_empty() => {
            let told = match worst.std {
                Some(std) => format!(
                    "A change of 4 is two standard deviations, {}. Where circles leave the dashed curve, the error bar is not the whole truth.",
                    percent(2.0 * std)
                ),
                None => "It does not become worse: nothing tells this direction.".into(),
            };
            let reading = format!(
                "How much worse the fit becomes when the values move along the direction that is told worst, all else at its best: {}. {told}",
                escape(&direction(&worst.weights))
            );
            html += &plot("profile", "Misfit along what is told worst", &reading);
        }
        _ => {
            html += &absent(
                "Misfit along what is told worst",
                "for too little holds for the whole band, or it is not identifiable.",
            )
        }
    }
    html
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
fn table(several: &Several) -> String {
    let heads: String = (1..=several.coordinates.len()).map(|k| format!("<th>{k}</th>")).collect();
    let mut html = format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Correlation in numbers\"><table><thead><tr><th>Number</th>{heads}</tr></thead><tbody>"
    );
    for (k, (name, row)) in several.coordinates.iter().zip(&several.correlation).enumerate() {
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
