//! The page: one file, its style, its scripts and its data inside.

mod contents;
mod model_errors;
mod plots;
mod provenance;
mod side_by_side;
mod text;
mod together;
mod uncertainty;

use crate::data::data;
use crate::escape::{escape, script_json};
use crate::results::Results;
use crate::status;
use crate::verdict::Verdict;

const STYLE: &str = concat!(include_str!("../../web/page.css"), include_str!("../../web/print.css"));
const PLOTLY: &str = include_str!("../../vendor/plotly-cartesian.min.js");

/// In the order in which they need one another.
const SCRIPTS: [&str; 15] = [
    include_str!("../../web/data.js"),
    include_str!("../../web/theme.js"),
    include_str!("../../web/download.js"),
    include_str!("../../web/ticks.js"),
    include_str!("../../web/stretches.js"),
    include_str!("../../web/plot.js"),
    include_str!("../../web/cursor.js"),
    include_str!("../../web/response.js"),
    include_str!("../../web/factor.js"),
    include_str!("../../web/trust.js"),
    include_str!("../../web/together.js"),
    include_str!("../../web/plane.js"),
    include_str!("../../web/table.js"),
    include_str!("../../web/print.js"),
    include_str!("../../web/main.js"),
];

/// Nothing is loaded from anywhere: what the page needs is in it.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'";

/// The page of some results.
pub(crate) fn page(results: &Results, verdict: &Verdict) -> String {
    let data = data(results, verdict);
    let title = match results.summary.word("/title") {
        "" => "Identification".to_owned(),
        title => title.to_owned(),
    };
    let scripts = SCRIPTS.concat();
    // What decides comes first, how it was computed last and folded away.
    let sections = [
        text::verdict(results, verdict),
        plots::cursor(),
        text::result(results, &plots::values(results)),
        section("fit", "How well the model fits the measurement", &plots::fit(results)),
        side_by_side::side_by_side(results),
        section("uncertainty", "Errors of the model, noise and sensors", &uncertainty::uncertainty(results)),
        folded("choice", "Method: how one solution was chosen", &plots::choice(results)),
        folded("convergence", "Method: convergence and numerical errors", &plots::convergence(results)),
        folded("table", "Table of all frequencies", &plots::table(&data.notes, verdict)),
        folded(
            "provenance",
            "Files, settings and computing time",
            &provenance::provenance(results, verdict.own),
        ),
    ]
    .concat();
    let body = [
        text::header(&title, results),
        "<div class=\"page columns-of-page\">".to_owned(),
        contents::contents(&sections),
        format!("<main>{sections}</main></div>"),
    ]
    .concat();
    let title = escape(&title);
    let statuses = status::style();
    let json = script_json(&data.json);
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>{title} – frfit</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}{statuses}</style>\n</head>\n<body>\n{body}\n\
         <script type=\"application/json\" id=\"data\">{json}</script>\n<script>{PLOTLY}</script>\n\
         <script>\n(() => {{\n\"use strict\";\n{scripts}}})();\n</script>\n</body>\n</html>\n"
    )
}

/// A part of the page; nothing where it has no content.
fn section(id: &str, title: &str, content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    format!(
        "<section id=\"{id}\" aria-labelledby=\"{id}-title\"><h2 id=\"{id}-title\">{title}</h2>\n{content}</section>\n"
    )
}

/// A part that is folded away until it is asked for; nothing where it has no content.
fn folded(id: &str, title: &str, content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    format!(
        "<section id=\"{id}\" aria-labelledby=\"{id}-title\"><details><summary><h2 id=\"{id}-title\">{title}</h2></summary>\n{content}</details></section>\n"
    )
}

/// A heading within a part, which the table of contents lists.
fn heading(id: &str, title: &str) -> String {
    format!("<h3 id=\"{id}\">{title}</h3>")
}
