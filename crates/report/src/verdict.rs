//! What the results say, in words: can the answer be used, how sure is it, and why not elsewhere.

mod several;

use crate::number::{hertz, percent, significant, with_bar};
use crate::results::{Band, Results, Sensor};
use frfit::c64;
use frfit::frequency::bands_hz;
use frfit::identify::Status;

/// Above this share of trusted frequencies a band is called usable as a whole.
const MOST_OF_IT: f64 = 0.9;

/// How far the answer as a whole can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Level {
    /// It explains the measurements, and something independent says so.
    Good,
    /// Part of it, or nothing independent tests it.
    Care,
    /// None of it, or the model cannot explain the measurements.
    Bad,
}

/// One number that everybody wants.
#[derive(Debug)]
pub(crate) struct Tile {
    pub(crate) label: String,
    pub(crate) value: String,
    pub(crate) detail: String,
}

/// A status that some frequencies have.
#[derive(Debug)]
pub(crate) struct Share {
    pub(crate) status: Status,
    pub(crate) count: usize,
    /// The status in a word or two.
    pub(crate) label: &'static str,
    pub(crate) words: String,
}

/// The verdict.
#[derive(Debug)]
pub(crate) struct Verdict {
    pub(crate) level: Level,
    pub(crate) headline: String,
    pub(crate) tiles: Vec<Tile>,
    pub(crate) shares: Vec<Share>,
    /// What a reader has to know before the numbers are used.
    pub(crate) cautions: Vec<String>,
    pub(crate) names: Names,
    /// Whether a frequency has values of its own; else it is explained by those that hold for the band, or not.
    pub(crate) own: bool,
    /// Frequency, value with bar, loss factor with bar, nominal value: at the lowest, the middle and the highest trusted frequency.
    pub(crate) rows: Vec<[String; 4]>,
    /// ‖x − u‖/‖u‖ of the nominal model over the sensors that count, by frequency.
    pub(crate) nominal_error: Vec<Option<f64>>,
}

/// What the factor is called.
#[derive(Debug, Clone)]
pub(crate) struct Names {
    /// `Storage modulus E′`, or what a real factor is.
    pub(crate) storage: String,
    /// The same in running text.
    pub(crate) thing: String,
    /// `Pa` or another unit of stress, or nothing where the factor is relative.
    pub(crate) unit: String,
    pub(crate) real: bool,
}

impl Names {
    fn of(results: &Results) -> Self {
        let summary = &results.summary;
        // "1" is a number relative to the modulus that the matrix was made with; a factor of a mass or a damping has no unit that is known.
        let unit = summary.word("/factor_unit");
        let real = summary.real();
        let (storage, thing, unit) = match (summary.role(), real, unit == "1") {
            ("stiffness", false, false) => ("Storage modulus E′", "storage modulus", unit),
            ("stiffness", false, true) => {
                ("Storage modulus E′ (relative to the matrix)", "relative storage modulus", "")
            }
            ("stiffness", true, false) => ("Modulus E", "modulus", unit),
            (_, false, _) => ("Real part of the factor", "factor", ""),
            (_, true, _) => ("Factor", "factor", ""),
        };
        Self { storage: storage.into(), thing: thing.into(), unit: unit.into(), real }
    }
}

impl Verdict {
    pub(crate) fn of(results: &Results) -> Self {
        if let Some(several) = &results.several {
            return several::verdict(results, several);
        }
        let names = Names::of(results);
        let nominal_error = nominal_error(results);
        let shares = shares(&results.band, true);
        let (level, headline) = level(results, &names);
        Self {
            level,
            headline,
            tiles: tiles(results, &names, &nominal_error),
            shares,
            cautions: cautions(results),
            rows: rows(results, &names),
            names,
            own: true,
            nominal_error,
        }
    }
}

/// Frequencies that were to be answered, and those that are trusted.
fn trusted(band: &Band) -> (usize, usize) {
    (band.len() - band.count(Status::OutOfBand), band.count(Status::Ok))
}

fn level(results: &Results, names: &Names) -> (Level, String) {
    let (asked, ok) = trusted(&results.band);
    let who = results.summary.names();
    let fit = results.summary.word("/fit/verdict");
    let part = percent(ok as f64 / asked.max(1) as f64);
    if fit == "not explained" {
        return (
            Level::Bad,
            format!(
                "Do not use the {} of {who} yet: the model cannot explain the measurements.",
                names.thing
            ),
        );
    }
    if ok == 0 {
        let most = Status::ALL.into_iter().max_by_key(|&status| results.band.count(status));
        let why = most.map_or("", why_not);
        return (Level::Bad, format!("No frequency has a trusted {} of {who}: {why}.", names.thing));
    }
    let doubted = !results.summary.array("/findings").is_empty();
    let told = format!("The {} of {who} is known at {ok} of {asked} frequencies ({part})", names.thing);
    let most = ok as f64 >= MOST_OF_IT * asked as f64;
    if doubted {
        return (
            Level::Care,
            format!("{told}, but something is wrong with the data: see the findings first."),
        );
    }
    if results.summary.word("/identify/selection") == "smallest" {
        return (
            Level::Care,
            format!("{told} by the rule of the smallest correction, which no second look confirms."),
        );
    }
    if contradicting(results) {
        return (Level::Care, format!("{told}; a sensor contradicts the others."));
    }
    match (fit, most) {
        ("explained", true) => (Level::Good, format!("{told} and explains all sensors to the noise.")),
        ("explained", false) => (Level::Care, format!("{told}; elsewhere the measurement does not tell it.")),
        ("nearly explained", _) => {
            (Level::Care, format!("{told}; a little more than the given noise is left."))
        }
        _ => (Level::Care, format!("{told}, but nothing independent tests the fit.")),
    }
}

fn contradicting(results: &Results) -> bool {
    let says = |sensor: &serde_json::Value| sensor.get("contradicts").and_then(serde_json::Value::as_bool);
    results.summary.array("/sensors").iter().any(|sensor| says(sensor) == Some(true))
}

fn shares(band: &Band, own: bool) -> Vec<Share> {
    let there = Status::ALL.into_iter().filter(|&status| band.count(status) > 0);
    there
        .map(|status| {
            let bands = bands_hz(band.frequency_hz.iter().zip(&band.status).map(|(&f, &s)| (f, s == status)));
            Share {
                status,
                count: band.count(status),
                label: label(status, own),
                words: format!("{} {}", meaning(status, own), where_(&bands)),
            }
        })
        .collect()
}

/// A status in words; `own` as in [`Verdict::own`].
fn meaning(status: Status, own: bool) -> &'static str {
    match status {
        Status::Ok if !own => "the values that hold for the band explain all sensors there:",
        Status::Ok => "one answer, and nothing known speaks against it:",
        Status::Ambiguous => {
            "several values explain the measurement; the likeliest is shown, the others are among the candidates:"
        }
        Status::Diverged => {
            "the paper’s series does not converge, as near resonances of lightly damped structures; the value shown is evidence, not a result:"
        }
        Status::NoRoot => "no value within the bounds solves the equations:",
        Status::NotIdentifiable => {
            "the response hardly depends on the parameter, so that noise leaves it unknown; the value shown is evidence, not a result:"
        }
        Status::Unexplained => {
            "the model does not explain the measurement within its errors; the value shown is evidence, not a result:"
        }
        Status::OutOfBand => "left out, as the case says:",
        // The library may have a new one before this page has words for it.
        _ => {
            "a system could not be solved accurately, or a search did not converge; the value shown is evidence, not a result:"
        }
    }
}

/// The same in a few words, where nothing else came out.
fn why_not(status: Status) -> &'static str {
    match status {
        Status::Ok => "nothing speaks against it",
        Status::Ambiguous => "several values explain the measurement",
        Status::Diverged => "the paper’s series does not converge",
        Status::NoRoot => "no value within the bounds solves the equations",
        Status::NotIdentifiable => "noise leaves it unknown",
        Status::Unexplained => "the model does not explain the measurement within its errors",
        Status::OutOfBand => "all of them are left out",
        _ => "a system could not be solved accurately, or a search did not converge",
    }
}

/// A status as a label; `own` as in [`Verdict::own`].
pub(crate) fn label(status: Status, own: bool) -> &'static str {
    match status {
        Status::Ok if !own => "explained",
        Status::Ok => "trusted",
        Status::Ambiguous => "ambiguous",
        Status::Diverged => "diverged",
        Status::NoRoot => "no solution",
        Status::NotIdentifiable => "not identifiable",
        Status::Unexplained => "not explained",
        Status::OutOfBand => "left out",
        _ => "failed",
    }
}

/// The widest bands, and how many more.
fn where_(bands: &[[f64; 2]]) -> String {
    const SHOWN: usize = 4;
    let mut widest: Vec<[f64; 2]> = bands.to_vec();
    widest.sort_by(|a, b| (b[1] - b[0]).total_cmp(&(a[1] - a[0])));
    widest.truncate(SHOWN);
    widest.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let one = |[first, last]: &[f64; 2]| {
        if first == last {
            significant(*first, 5)
        } else {
            format!("{}–{}", significant(*first, 5), significant(*last, 5))
        }
    };
    let shown: Vec<String> = widest.iter().map(one).collect();
    let more = match bands.len().saturating_sub(SHOWN) {
        0 => String::new(),
        1 => " and a narrower band".into(),
        more => format!(" and {more} narrower bands"),
    };
    format!("{} Hz{more}.", shown.join(", "))
}

fn cautions(results: &Results) -> Vec<String> {
    let summary = &results.summary;
    let mut told = Vec::new();
    let mut say = |text: String| told.push(text);
    for sensor in summary.array("/sensors") {
        let label = sensor.get("label").and_then(serde_json::Value::as_str).unwrap_or("");
        let flag = |key| sensor.get(key).and_then(serde_json::Value::as_bool) == Some(true);
        if flag("contradicts") {
            let done = if flag("left_out") {
                "It was left out."
            } else {
                "It was kept, as reject_outliers = false says."
            };
            say(format!("Sensor {label} contradicts all others. {done}"));
        }
        for (key, unit) in [("scale", " times what the file says"), ("delay_s", " s")] {
            let Some(value) = sensor.get(key) else { continue };
            let std = sensor.get(format!("{key}_std")).and_then(serde_json::Value::as_f64);
            let what = if key == "scale" { "scale" } else { "delay" };
            say(match value.as_f64() {
                Some(value) => format!(
                    "The {what} of sensor {label} was unknown and found: {}{unit}.",
                    with_bar(value, std, "")
                ),
                None => format!(
                    "The {what} of sensor {label} was unknown, and the data do not tell it: it was left out."
                ),
            });
        }
    }
    told.extend(doubt_of_fit(results));
    if summary.word("/identify/selection") == "smallest" {
        told.push("Of several solutions the one with the smallest correction was taken (selection = \"smallest\", the rule of the paper). It can be the wrong one, has no error bars, and selection = \"joint\" tells more.".into());
    }
    told
}

/// What is to be said where noise is not all that is left, or nothing tells whether it is.
fn doubt_of_fit(results: &Results) -> Option<String> {
    let summary = &results.summary;
    Some(match summary.word("/fit/verdict") {
        "not explained" => {
            "What is left between model and measurement is no noise. Look at mesh, boundary conditions, sensors and units (frfit check) before any number is used."
                .into()
        }
        "nearly explained" => {
            let times = significant(summary.number("/fit/chi2_per_freedom").map_or(1.0, f64::sqrt), 3);
            format!("The misfit is {times} times the given noise: error bars may be too short by that.")
        }
        "explained" => return None,
        // What holds for the band has other frequencies to agree with.
        _ if results.sensors.len() == 1 && results.several.is_none() => {
            "One sensor alone is reproduced by every solution: a response that matches proves little. A second sensor would test the answer."
                .into()
        }
        _ => format!("Whether noise is all that is left was not tested: {}.", untested(results)),
    })
}

/// What an error bar says in words.
fn bars(value: f64, std: Option<f64>) -> String {
    match std {
        Some(std) => format!("± {} (two standard deviations: 95 of 100)", percent(2.0 * std / value.abs())),
        None => "no error bars".into(),
    }
}

fn tiles(results: &Results, names: &Names, nominal_error: &[Option<f64>]) -> Vec<Tile> {
    let (band, summary) = (&results.band, &results.summary);
    let mut tiles = Vec::new();
    let rows: Vec<usize> = band.rows(Status::Ok).filter(|&row| band.at("storage", row).is_some()).collect();
    let ends = |name: &str, unit: &str| {
        let (&first, &last) = rows.first().zip(rows.last())?;
        let at = |row: usize| band.at(name, row).map(|value| with_bar(value, None, unit));
        Some(format!(
            "{} at {} to {} at {}",
            at(first)?,
            hertz(band.frequency_hz[first]),
            at(last)?,
            hertz(band.frequency_hz[last])
        ))
    };
    if let Some(&middle) = rows.get(rows.len() / 2) {
        let at = hertz(band.frequency_hz[middle]);
        for (name, std, label, unit) in [
            ("storage", "storage_std", names.storage.as_str(), names.unit.as_str()),
            ("loss_factor", "loss_factor_std", "Loss factor η", ""),
        ] {
            let Some(value) = band.at(name, middle).filter(|_| !(names.real && name == "loss_factor")) else {
                continue;
            };
            let std = band.at(std, middle);
            tiles.push(Tile {
                label: format!("{label} at {at}"),
                value: with_bar(value, None, unit),
                detail: format!("{}; {}", bars(value, std), ends(name, unit).unwrap_or_default()),
            });
        }
    }
    tiles.extend(shared_tiles(results, &rows, nominal_error, true));
    if let (Some(median), Some(most)) =
        (summary.number("/reference/deviation/median_ok"), summary.number("/reference/deviation/max_ok"))
    {
        tiles.push(Tile {
            label: "Known answer".into(),
            value: format!("{} off", percent(median)),
            detail: format!(
                "median where trusted, at most {}: this case was made with a known value",
                percent(most)
            ),
        });
    }
    tiles
}

/// How much of the band is trusted, how well the model fits, and whether the sensors agree; `rows` are those with an answer, `own` as in [`Verdict::own`].
fn shared_tiles(results: &Results, rows: &[usize], nominal_error: &[Option<f64>], own: bool) -> Vec<Tile> {
    let (band, summary) = (&results.band, &results.summary);
    let (asked, ok) = trusted(band);
    let mut tiles = Vec::new();
    tiles.push(Tile {
        label: format!("Frequencies that {}", if own { "can be trusted" } else { "are explained" }),
        value: percent(ok as f64 / asked.max(1) as f64),
        detail: format!(
            "{ok} of {asked} between {} and {}",
            hertz(band.frequency_hz[0]),
            hertz(band.frequency_hz[band.len() - 1])
        ),
    });
    let median = |values: &mut dyn Iterator<Item = Option<f64>>| {
        let mut values: Vec<f64> = values.flatten().collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    if let Some(after) = median(&mut rows.iter().map(|&row| band.at("error", row))) {
        let before = median(&mut rows.iter().map(|&row| nominal_error[row]));
        tiles.push(Tile {
            label: "Model against measurement".into(),
            value: format!("{} off", percent(after)),
            detail: match before {
                Some(before) => {
                    format!("of the response, median; {} off with the nominal value", percent(before))
                }
                None => "of the response, median".into(),
            },
        });
    }
    let fit = summary.word("/fit/verdict");
    let chi = summary.number("/fit/chi2_per_freedom");
    tiles.push(match (fit, chi) {
        ("explained" | "nearly explained" | "not explained", Some(chi)) => Tile {
            label: "Do all sensors agree?".into(),
            value: match fit {
                "explained" => "yes".into(),
                "nearly explained" => "nearly".into(),
                _ => "no".into(),
            },
            detail: format!(
                "χ² over degrees of freedom {} ({} are left); noise {}",
                significant(chi, 3),
                significant(summary.number("/fit/freedom").unwrap_or(0.0), 6),
                noise(results)
            ),
        },
        _ => Tile {
            label: "Do all sensors agree?".into(),
            value: "not tested".into(),
            detail: format!("{}; noise {}", untested(results), noise(results)),
        },
    });
    tiles
}

/// Why no χ² over the band tells whether noise is all that is left.
fn untested(results: &Results) -> &'static str {
    match (results.sensors.len(), results.summary.word("/identify/varies")) {
        (1, _) => "one sensor has nothing to agree with",
        (_, "law") => "the table of laws has the χ² of each",
        _ => "nothing tells the noise but the misfit itself",
    }
}

/// What tells the noise.
fn noise(results: &Results) -> &'static str {
    match results.summary.word("/noise/source") {
        "given" => "as the files give it",
        "sensors" => "taken from how well the sensors agree",
        "scatter" => "taken from how the answers scatter",
        "curve" => "taken from what the smooth curve leaves",
        _ => "unknown",
    }
}

fn rows(results: &Results, names: &Names) -> Vec<[String; 4]> {
    let band = &results.band;
    let rows: Vec<usize> = band.rows(Status::Ok).filter(|&row| band.at("storage", row).is_some()).collect();
    let mut picked: Vec<usize> = [0, rows.len() / 2, rows.len().saturating_sub(1)]
        .iter()
        .filter_map(|&k| rows.get(k).copied())
        .collect();
    picked.dedup();
    let one = |row: usize| {
        let cell = |name: &str, std: &str, unit| {
            band.at(name, row).map_or("–".into(), |value| with_bar(value, band.at(std, row), unit))
        };
        let nominal = results.reference.nominal[row].map_or("–".into(), |factor: c64| {
            let eta = if names.real {
                String::new()
            } else {
                format!(", η {}", significant(frfit::material::loss_factor(factor), 4))
            };
            format!("{}{eta}", with_bar(factor.re, None, &names.unit))
        });
        [
            hertz(band.frequency_hz[row]),
            cell("storage", "storage_std", &names.unit),
            cell("loss_factor", "loss_factor_std", ""),
            nominal,
        ]
    };
    picked.into_iter().map(one).collect()
}

/// P-40 with the nominal response. Accelerance and receptance differ by one number at a frequency, so that the quotient is the same of either.
fn nominal_error(results: &Results) -> Vec<Option<f64>> {
    let left_out = |sensor: &serde_json::Value| {
        sensor.get("left_out").and_then(serde_json::Value::as_bool) == Some(true)
    };
    let all = results.sensors.iter().zip(results.summary.array("/sensors"));
    let counted: Vec<&Sensor> = all.filter(|(_, told)| !left_out(told)).map(|(sensor, _)| sensor).collect();
    let at = |row: usize| {
        let mut sums = (0.0, 0.0);
        for sensor in &counted {
            let (x, u) = (sensor.nominal[row]?, sensor.measured[row]?);
            sums = (sums.0 + (x - u).norm_sqr(), sums.1 + u.norm_sqr());
        }
        Some((sums.0 / sums.1).sqrt()).filter(|error| error.is_finite())
    };
    (0..results.band.len()).map(at).collect()
}
