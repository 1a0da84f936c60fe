//! The places of plots and table: what each shows, or why it is not there.

use super::heading;
use super::model_errors::{bars_contain, list};
use crate::data::SENSORS;
use crate::escape::escape;
use crate::results::{Band, Results, Unknown};
use crate::verdict::Verdict;
use frfit::identify::{Status, Trust};
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
        "<figure class=\"plot\" id=\"plot-{id}\"><figcaption>{}<p>{reading}</p></figcaption>\
         <div class=\"tools screen\" role=\"toolbar\" aria-label=\"{title}\"></div><div class=\"drawing\"></div></figure>\n",
        heading(&format!("about-{id}"), title)
    )
}

/// Why a plot is not there.
pub(super) fn absent(title: &str, why: &str) -> String {
    format!("<p class=\"absent\"><b>{title}</b>: not drawn, {why}</p>\n")
}

/// The title of a plot, with the name of one of several unknowns.
fn titled(title: &str, one: &Unknown) -> String {
    if one.prefix.is_empty() { title.to_owned() } else { format!("{title}: {}", escape(&one.name)) }
}

/// Response, its error and the agreement of each sensor.
pub(super) fn fit(results: &Results) -> String {
    let mut html = String::new();
    if results.sensors.len() > 1 {
        html += "<p class=\"screen\"><label for=\"sensor\">Sensor </label><select id=\"sensor\">";
        for (m, sensor) in results.sensors.iter().take(SENSORS).enumerate() {
            let _ = write!(html, "<option value=\"{m}\">{}</option>", escape(&sensor.label));
        }
        html += "</select></p><p class=\"print-only\">Sensor <span id=\"sensor-name\"></span>; the folder figures has the others.</p>";
    }
    html += &plot(
        "accelerance",
        "Frequency response",
        "Accelerance, magnitude and phase, as measured and of both models. The updated model should lie on the measured points. The nominal model shows how far off the model was before.",
    );
    html += &error(&results.band);
    html += &plot(
        "frac",
        "Agreement of each sensor (FRAC)",
        "1: the computed response has the shape of the measured one over the whole band. A sensor that stays low has a fault, or the model is wrong near it.",
    );
    html += &plot(
        "nyquist",
        "Nyquist plot of the accelerance",
        "Each resonance is a loop. The loops of measurement and updated model should be the same.",
    );
    html
}

/// The identified values over frequency, and in the complex plane.
pub(super) fn values(results: &Results) -> String {
    let contained = bars_contain(results);
    let of_one = |(suffix, _, one): (String, usize, &Unknown)| {
        let title = if one.real { "Identified value" } else { "Storage modulus and loss factor" };
        let others = if results.unknowns.len() == 1 { "" } else { ", with all other unknowns free" };
        let bars = match contained.as_ref().filter(|_| results.band.has(&one.column("storage_std"))) {
            Some(contained) => {
                format!("Error bars and bands are two standard deviations{others}. They contain {contained}.")
            }
            None => {
                "There are no error bars: the noise is unknown, or this way of selecting a solution has none."
                    .to_owned()
            }
        };
        let evidence = match results.band.status.iter().any(|status| status.trust() == Trust::EvidenceOnly) {
            true => " Grey crosses are no results: the status there is not trusted.",
            false => "",
        };
        plot(&format!("modulus{suffix}"), &titled(title, one), &format!("{bars}{evidence}"))
    };
    results.curves().map(of_one).collect::<String>() + &plane(results)
}

/// What the error bars consist of.
pub(super) fn contributions(results: &Results) -> String {
    const TITLE: &str = "Contributions to the standard deviation";
    const READING: &str = "One standard deviation over the storage modulus or value. The squares of the three contributions add up to the square of the total. \
         If the noise is the largest, measure longer. If the model is, refine the mesh or check the supports. If known factors are, state how well they are known.";
    if !list(&results.summary.0, "error_bars_contain").iter().any(|part| part != "noise") {
        return String::new();
    }
    let all = results.curves().filter(|(.., one)| results.band.has(&one.column("storage_std_model")));
    all.map(|(suffix, _, one)| plot(&format!("contributions{suffix}"), &titled(TITLE, one), READING))
        .collect()
}

/// All solutions, and the one that was chosen.
pub(super) fn choice(results: &Results) -> String {
    const TITLE: &str = "All solutions and the chosen one";
    let free = || results.curves().filter(|(.., one)| one.is_free() || results.unknowns.len() == 1);
    if free().next().is_some() && results.candidates.verdict.is_empty() {
        return absent(TITLE, "for no solution was found at any frequency.");
    }
    let reading = "Every dot is a value that reproduces the first sensor at one frequency. The line joins the values that were chosen. The button “refused” shows solutions outside the bounds as well.";
    free()
        .map(|(suffix, _, one)| plot(&format!("candidates{suffix}"), &titled(TITLE, one), reading))
        .collect()
}

/// What the method had to do, and how exact it is.
pub(super) fn convergence(results: &Results) -> String {
    let band = &results.band;
    let mut html = "<div class=\"pair\">".to_owned();
    let mut missing = String::new();
    match &results.error_map {
        Some(_) => {
            html += &plot(
                "error-map",
                "Error over the order of the series",
                "log₁₀ of the error after so many terms of the Neumann series. The series converges in columns that become darker upwards. Bright columns are resonances.",
            );
        }
        None => {
            let method = escape(results.summary.word("/identify/method"));
            missing += &absent(
                "Error over the order of the series",
                &format!(
                    "for it needs method = \"series\" and --error-map above 0, and this run used {method}."
                ),
            );
        }
    }
    if band.has("spectral_radius") {
        html += &plot(
            "radius",
            "Spectral radius of the series",
            "Below 1 the Neumann series converges. The nearer to 1, the more terms it needs.",
        );
    } else {
        missing += &absent("Spectral radius of the series", "for this method does not compute it.");
    }
    if band.has("convergence_radius") {
        html += &plot(
            "pole",
            "Distance to the nearest pole",
            "How far the parameter may change, relative to its nominal value, before the response has a pole. The other curve is the change that was found.",
        );
    } else {
        missing += &absent("Distance to the nearest pole", "for this method does not compute it.");
    }
    if band.has("required_order") {
        html += &plot(
            "order",
            "Terms that the series would need",
            "Terms of the Neumann series for an error of 10⁻⁶. In a gap no number of terms is enough; the method that was used needs no series.",
        );
    } else {
        missing += &absent(
            "Terms that the series would need",
            "for only selection = \"joint\" on a reduced model computes it.",
        );
    }
    let (is_there, reduction) = reduction_error(results);
    html += if is_there { &reduction } else { "" };
    html += "</div>\n";
    html + &missing + if is_there { "" } else { &reduction }
}

/// The error of the response, or why it is not there.
fn error(band: &Band) -> String {
    const TITLE: &str = "Error of the response over frequency";
    match band.has("error") {
        true => {
            let reading = "Difference of model and measurement over all sensors, relative to the measured response, with the nominal and the updated value. A small error alone proves little: several values may give the same response.";
            plot("error", TITLE, reading)
        }
        false => absent(TITLE, "for no frequency has an updated response."),
    }
}

/// The error of the reduced model and whether it is known; else why not.
fn reduction_error(results: &Results) -> (bool, String) {
    const TITLE: &str = "Reduction error";
    if !results.band.has("reduction_error") {
        return (false, absent(TITLE, "for the full model was solved at every frequency."));
    }
    let size = results.summary.number("/counts/subspace_size");
    let size =
        size.map_or(String::new(), |size| format!(" The reduced model has {size} degrees of freedom."));
    let reading = format!(
        "Estimated error of the reduced model at the sensors, relative to the measured response.{size}"
    );
    (true, plot("reduction-error", TITLE, &reading))
}

/// Loss against storage; nothing where no value is complex.
fn plane(results: &Results) -> String {
    const PLOTS: [(&str, &str, &str); 2] = [
        (
            "cole-cole",
            "Cole–Cole plot",
            "Loss modulus over storage modulus at trusted frequencies. One material gives one smooth curve.",
        ),
        (
            "wicket",
            "Wicket plot",
            "Loss factor over storage modulus, both logarithmic. Points beside the curve are another solution, another temperature, or an error of the model.",
        ),
    ];
    let complex = || results.curves().filter(|(.., one)| !one.real);
    if complex().next().is_none() {
        return String::new();
    }
    if results.band.count(Status::Ok) == 0 {
        return PLOTS.map(|(_, title, _)| absent(title, "for no frequency is trusted.")).concat();
    }
    let of_one = |(suffix, _, one): (String, usize, &Unknown)| {
        let both =
            PLOTS.map(|(id, title, reading)| plot(&format!("{id}{suffix}"), &titled(title, one), reading));
        format!("<div class=\"pair\">{}</div>\n", both.concat())
    };
    complex().map(of_one).collect()
}

/// The table with its filter.
pub(super) fn table(notes: &[String], verdict: &Verdict) -> String {
    let mut html = "<form id=\"filter\" class=\"screen\"><fieldset><legend>Status</legend>".to_owned();
    for share in &verdict.shares {
        let (name, count) = (share.status.name(), share.count);
        let _ = write!(
            html,
            "<label><input type=\"checkbox\" name=\"status\" value=\"{name}\" checked> <span class=\"tint {name}\"></span>{} ({count})</label>",
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
    html + "<p class=\"note\">Numbers in plots, table and downloads have six digits; identified.csv beside this page has all digits.</p>\n"
}
