//! The page: one file, its style, its scripts and its data inside.

mod model_errors;
mod plots;
mod side_by_side;
mod text;
mod together;

use crate::data::data;
use crate::escape::{escape, script_json};
use crate::results::Results;
use crate::status;
use crate::verdict::Verdict;

const STYLE: &str = concat!(include_str!("../../web/page.css"), include_str!("../../web/print.css"));
const PLOTLY: &str = include_str!("../../vendor/plotly-cartesian.min.js");

/// In the order in which they need one another.
const SCRIPTS: [&str; 14] = [
    include_str!("../../web/data.js"),
    include_str!("../../web/theme.js"),
    include_str!("../../web/download.js"),
    include_str!("../../web/ticks.js"),
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
    let body = [
        text::header(&title, results),
        "<main>".to_owned(),
        text::verdict(results, verdict),
        side_by_side::side_by_side(results),
        plots::cursor(),
        plots::sections(results),
        model_errors::model_errors(results),
        plots::table(&data.notes, verdict),
        text::provenance(results, verdict.own),
        "</main>".to_owned(),
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
