//! The places of plots and table: what each shows, or why it is not there.

use super::together::together;
use crate::data::SENSORS;
use crate::escape::escape;
use crate::results::{Band, Results, Unknown};
use crate::verdict::Verdict;
use frfit::identify::Status;
use std::fmt::Write;

/// The frequency cursor.
pub(super) fn cursor() -> String {
    "<section id=\"cursor\" class=\"screen\" aria-label=\"Frequency cursor\"><label for=\"cursor-range\">Frequency cursor</label>\
     <input type=\"range\" id=\"cursor-range\" min=\"0\" step=\"1\" value=\"0\"><output id=\"cursor-values\" for=\"cursor-range\"></output>\
     <button type=\"button\" id=\"log-frequency\" aria-pressed=\"false\">Log frequency</button></section>\n"
        .to_owned()
}

/// A plot with its heading and how it is read; the scripts fill it.
pub(super) fn plot(id: &str, title: &str, reading: &str) -> String {
    format!(
        "<figure class=\"plot\" id=\"plot-{id}\"><figcaption><h3>{title}</h3><p>{reading}</p></figcaption>\
         <div class=\"tools screen\" role=\"toolbar\" aria-label=\"{title}\"></div><div class=\"drawing\"></div></figure>\n"
    )
}

/// Why a plot is not there.
pub(super) fn absent(title: &str, why: &str) -> String {
    format!("<p class=\"absent\"><b>{title}</b>: not drawn, {why}</p>\n")
}

/// All plots, in the order in which they are read.
pub(super) fn sections(results: &Results) -> String {
    let mut html = String::new();
    for (id, title, content) in [
        ("response", "Response", response(results)),
        ("factor", "Identified values", factor(results)),
        ("choice", "Choice", choice(results)),
        ("together", "How the values are correlated", together(results)),
        ("trust", "Error and convergence", trust(results)),
        ("plane", "In the complex plane", plane(results)),
    ] {
        if !content.is_empty() {
            let _ = write!(
                html,
                "<section id=\"{id}\" aria-labelledby=\"{id}-title\"><h2 id=\"{id}-title\">{title}</h2>\n{content}</section>\n"
            );
        }
    }
    html
}

/// The title of a plot, with the name of one of several unknowns.
fn titled(title: &str, one: &Unknown) -> String {
    if one.prefix.is_empty() { title.to_owned() } else { format!("{title}: {}", escape(&one.name)) }
}

fn response(results: &Results) -> String {
    let mut html = String::new();
    if results.sensors.len() > 1 {
        html += "<p class=\"screen\"><label for=\"sensor\">Sensor </label><select id=\"sensor\">";
        for (m, sensor) in results.sensors.iter().take(SENSORS).enumerate() {
            let _ = write!(html, "<option value=\"{m}\">{}</option>", escape(&sensor.label));
        }
        html += "</select></p><p class=\"print-only\">Sensor <span id=\"sensor-name\"></span>; the others are in figures/.</p>";
    }
    html += &plot(
        "accelerance",
        "Accelerance: measured, nominal, updated",
        "Acceleration per force. The updated model should lie on the measured points; the nominal one shows how far off it was.",
    );
    html + &plot(
        "frac",
        "Agreement of each sensor (FRAC)",
        "1 is a response of the measured shape at every frequency. A sensor that stays low is wrong, or the model is wrong there.",
    )
}

fn factor(results: &Results) -> String {
    let has_errors = results.summary.0.get("model_errors").is_some_and(|found| !found.is_null());
    let of_one = |(suffix, _, one): (String, usize, &Unknown)| {
        let title = if one.real { "Identified value" } else { "Storage modulus and loss factor" };
        let others = if results.unknowns.len() == 1 { "" } else { ", all other unknowns free" };
        let bars = match results.band.has(&one.column("storage_std")) {
            true if has_errors => format!(
                "Bars and bands are two standard deviations{others}. They hold the noise, the errors of the model that were found, and the uncertainty of the given factors."
            ),
            true => format!(
                "Bars and bands are two standard deviations due to noise{others}: 95 of 100 true values lie within, if the model is right. Errors of the model (mesh, supports) are not in them."
            ),
            false => "There are no error bars: the noise is unknown, or the selection has none.".to_owned(),
        };
        let reading = format!("{bars} Grey crosses are evidence only, not answers.");
        let modulus = plot(&format!("modulus{suffix}"), &titled(title, one), &reading);
        match has_errors && results.band.has(&one.column("storage_std_model")) {
            true => {
                modulus
                    + &plot(
                        &format!("contributions{suffix}"),
                        &titled(CONTRIBUTIONS, one),
                        CONTRIBUTIONS_READING,
                    )
            }
            false => modulus,
        }
    };
    results.curves().map(of_one).collect()
}

const CONTRIBUTIONS: &str = "What the error bars consist of";
const CONTRIBUTIONS_READING: &str = "One standard deviation over the storage modulus or value. The squares of the three contributions add up to the square of the whole. \
     Where noise is the largest, measure longer; where the model is, refine the mesh or look at supports; where known factors are, say how well they are known.";

fn choice(results: &Results) -> String {
    const TITLE: &str = "Candidates and chosen path";
    let free = || results.curves().filter(|(.., one)| one.is_free() || results.unknowns.len() == 1);
    if free().next().is_some() && results.candidates.verdict.is_empty() {
        return absent(TITLE, "for no solution was found at any frequency.");
    }
    let reading = "Every dot reproduces the first measurement. The path through them is the one that the other sensors and frequencies agree with. Refused ones are shown by a switch.";
    free()
        .map(|(suffix, _, one)| plot(&format!("candidates{suffix}"), &titled(TITLE, one), reading))
        .collect()
}

fn trust(results: &Results) -> String {
    let band = &results.band;
    let mut html = "<div class=\"pair\">".to_owned();
    let mut missing = String::new();
    match error(band) {
        (true, plot) => html += &plot,
        (false, why) => missing += &why,
    }
    match &results.error_map {
        Some(_) => {
            html += &plot(
                "error-map",
                "Error map over the order of the series",
                "log₁₀ of the error after so many terms of the series. Columns that darken upwards converge; bright ones stand at resonances.",
            );
        }
        None => {
            let method = escape(results.summary.word("/identify/method"));
            missing += &absent(
                "Error map over the order of the series",
                &format!(
                    "for it is made with method = \"series\" and --error-map above 0 only, and this run used {method}."
                ),
            );
        }
    }
    if band.has("spectral_radius") {
        html += &plot(
            "radius",
            "Spectral radius",
            "Below 1 the paper’s series converges to the answer; the nearer to 1, the more terms it needs.",
        );
    } else {
        missing += &absent("Spectral radius", "for no frequency has one.");
    }
    if band.has("convergence_radius") {
        html += &plot(
            "pole",
            "Distance to the nearest pole",
            "How far the parameter may change, relative to its nominal value, before the response has a pole; beside it how far it did change.",
        );
    } else {
        missing += &absent("Distance to the nearest pole", "for no frequency has one.");
    }
    if band.has("required_order") {
        html += &plot(
            "order",
            "Order that the series would need",
            "Terms of the paper’s series for an error of 10⁻⁶. Where there is a gap no order is enough; the default method answers there too.",
        );
    } else {
        missing += &absent(
            "Order that the series would need",
            "for only a joint selection on the band’s subspace asks for it.",
        );
    }
    html += &reduction_error(results);
    html + "</div>\n" + &missing
}

/// The error of the response, or why it is not there.
fn error(band: &Band) -> (bool, String) {
    const TITLE: &str = "Error of the response";
    match band.has("error") {
        true => {
            let reading = "Norm of the misfit over all sensors, relative to the measured response, with the nominal and the updated value. Small is necessary, but proves little: several values may match.";
            (true, plot("error", TITLE, reading))
        }
        false => (false, absent(TITLE, "for no frequency has an updated response.")),
    }
}

fn reduction_error(results: &Results) -> String {
    const TITLE: &str = "Error of the reduced model";
    if !results.band.has("reduction_error") {
        return absent(TITLE, "for the full model answered at every frequency.");
    }
    let size = results.summary.number("/counts/subspace_size");
    let size = size.map_or(String::new(), |size| format!(" It has {size} vectors."));
    let reading = format!(
        "Estimated error of the band’s subspace at the sensors, relative to the measured response.{size}"
    );
    plot("reduction-error", TITLE, &reading)
}

fn plane(results: &Results) -> String {
    const PLOTS: [(&str, &str, &str); 2] = [
        (
            "cole-cole",
            "Cole–Cole plot",
            "Loss modulus over storage modulus at trusted frequencies. One material gives one curve.",
        ),
        (
            "wicket",
            "Wicket plot",
            "Loss factor over storage modulus, both logarithmic. Points beside the curve are wrong in frequency, temperature or branch.",
        ),
    ];
    let nyquist = plot(
        "nyquist",
        "Nyquist plot",
        "Imaginary over real part of the accelerance. Resonances are loops; measured and updated loops should be the same.",
    );
    let why = match (results.curves().any(|(.., one)| !one.real), results.band.count(Status::Ok)) {
        (true, 1..) => {
            let complex = results.curves().filter(|(.., one)| !one.real);
            let of_one = |(suffix, _, one): (String, usize, &Unknown)| {
                let both = PLOTS
                    .map(|(id, title, reading)| plot(&format!("{id}{suffix}"), &titled(title, one), reading));
                format!("<div class=\"pair\">{}</div>\n", both.concat())
            };
            return nyquist + &complex.map(of_one).collect::<String>();
        }
        (true, 0) => "for no frequency is trusted.",
        (false, _) if results.curves().next().is_some() => "for the factor is real (real = true).",
        (false, _) => "for no factor varies over the band.",
    };
    nyquist + &PLOTS.map(|(_, title, _)| absent(title, why)).concat()
}

/// The table with its filter.
pub(super) fn table(notes: &[String], verdict: &Verdict) -> String {
    let mut html =
        "<section id=\"table\" aria-labelledby=\"table-title\"><h2 id=\"table-title\">All frequencies</h2>\
                    <form id=\"filter\" class=\"screen\"><fieldset><legend>Status</legend>"
            .to_owned();
    for share in &verdict.shares {
        let (name, count) = (share.status.name(), share.count);
        let _ = write!(
            html,
            "<label><input type=\"checkbox\" name=\"status\" value=\"{name}\" checked> <span class=\"dot {name}\"></span>{} ({count})</label>",
            share.label
        );
    }
    html += "</fieldset><fieldset><legend>Frequency in Hz</legend><label>from <input type=\"number\" id=\"from\" step=\"any\"></label> \
             <label>to <input type=\"number\" id=\"to\" step=\"any\"></label></fieldset>\
             <button type=\"button\" id=\"table-csv\">Download CSV</button></form>\
             <p id=\"rows-shown\" role=\"status\"></p>\
             <div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table of all frequencies\"><table id=\"rows\"><thead></thead><tbody></tbody></table></div>\
             <p class=\"pages screen\"><button type=\"button\" id=\"previous\">Previous</button><span id=\"page\"></span><button type=\"button\" id=\"next\">Next</button></p>\n";
    for note in notes {
        let _ = write!(html, "<p class=\"note\">{}</p>", escape(note));
    }
    html + "<p class=\"note\">Numbers in plots, table and downloads have six digits; identified.csv beside this page has all.</p></section>\n"
}
