//! The results of an identification as one HTML page that needs nothing else: verdict, plots, table, inputs.
//!
//! [`html`] takes the files that `frfit identify` writes, from memory or from a folder: both give the same page.
//!
//! | module | content |
//! |---|---|
//! | `results` | the files read and checked |
//! | `verdict` | what they say, in words: can the answer be used, how sure is it, why other lines have no answer |
//! | `status` | how a status looks: its colour and its words |
//! | `stretches` | which status each stretch of the band has |
//! | `thin` | fewer points for curves of many, extremes kept |
//! | `data` | what the plots and the table show, as JSON |
//! | `page` | the page: text is made here, so that it is there without scripts and in print |
//!
//! The scripts and the style sheet are in `web/`, the plotting library in `vendor/`.
//!
//! # Limits
//! A page is smaller than [`LARGEST`] whatever the size of the results: of many points those are drawn that show the extremes, and the page says so.

mod data;
mod escape;
mod number;
mod page;
mod results;
mod status;
mod stretches;
mod thin;
mod verdict;

pub use status::status_color;

use frfit_formats::FormatError;

/// Bytes that no page reaches.
pub const LARGEST: usize = 6_000_000;

/// The name of the page among the results.
pub const NAME: &str = "report.html";

/// The files that a page is made of; the summary says which of the others belong to it.
pub const FILES: [&str; 7] = [
    results::SUMMARY,
    results::IDENTIFIED,
    results::RESPONSE,
    results::CANDIDATES,
    results::REFERENCE,
    results::FREE,
    results::ERROR_MAP,
];

/// The page for results, of which `file` gives the contents by name, `None` where there is no such file.
///
/// # Errors
/// [`FormatError`] with the file's name in it: a file that is missing or not what `frfit identify` of this version writes.
pub fn html(file: &dyn Fn(&str) -> Option<Vec<u8>>) -> Result<String, FormatError> {
    let results = results::Results::read(file)?;
    let verdict = verdict::Verdict::of(&results);
    Ok(page::page(&results, &verdict))
}
