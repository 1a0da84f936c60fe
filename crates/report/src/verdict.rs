//! What the results say, in words: can the answer be used, how sure is it, and why other lines have no answer.

use crate::number::{hertz, percent, significant, with_bar};
use crate::results::{Band, Number, Results, Sensor, Unknown};
use crate::status::{label, meaning};
use crate::stretches::points;
use frfit::frequency::bands_hz;
use frfit::identify::{Status, Trust};

/// Above this share of trusted frequencies a band is called usable as a whole.
const MIN_TRUSTED_SHARE: f64 = 0.9;

/// A number of the band agrees with the known one if it is off by up to so many standard deviations.
const MAX_DEVIATIONS: f64 = 2.0;

/// How far the answer as a whole can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Level {
    /// It explains the measurements, and something independent says so.
    Good,
    /// Part of it, or no independent measurement tests it.
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
    /// What a reader has to do or to know before the numbers are used.
    pub(crate) cautions: Vec<String>,
    /// Whether a frequency has values of its own; else it is explained by those that hold for the band, or not.
    pub(crate) own: bool,
    /// ‖x − u‖/‖u‖ of the nominal model over the sensors that count, by frequency.
    pub(crate) nominal_error: Vec<Option<f64>>,
}

impl Verdict {
    pub(crate) fn of(results: &Results) -> Self {
        let nominal_error = nominal_error(results);
        let own = results.unknowns.iter().any(Unknown::is_free);
        let is_confirmed = is_confirmed(results);
        let (level, headline) = level(results, is_confirmed);
        Self {
            level,
            headline,
            tiles: tiles(results, &nominal_error, own),
            shares: shares(&results.band, own),
            cautions: cautions(results, is_confirmed),
            own,
            nominal_error,
        }
    }
}

/// Frequencies that were to be answered, and those that are trusted.
fn trusted(band: &Band) -> (usize, usize) {
    (band.status.iter().filter(|status| status.trust() != Trust::NotAsked).count(), band.count(Status::Ok))
}

fn level(results: &Results, is_confirmed: bool) -> (Level, String) {
    if let Some(why) = unusable(results) {
        return (Level::Bad, why);
    }
    let claim = claim(results);
    let support = match results.summary.word("/fit/verdict") {
        "explained" => ", and the model explains all sensors within the noise.",
        _ => ", and agrees with the values that this case gives as known.",
    };
    match doubt(results, is_confirmed) {
        Some(doubt) => (Level::Care, format!("{claim}{doubt}")),
        None => (Level::Good, format!("{claim}{support}")),
    }
}

/// Whether the case gives the values that were to be found, and every trusted value of every unknown agrees with them.
fn is_confirmed(results: &Results) -> bool {
    let has_ok = results.band.count(Status::Ok) > 0;
    let agrees = |one: &Unknown| {
        let number = |key: &str| one.off.get(key).and_then(serde_json::Value::as_f64);
        match number("deviations") {
            Some(deviations) => one.status == Some(Status::Ok) && deviations <= MAX_DEVIATIONS,
            None => has_ok && number("wrong_and_ok") == Some(0.0),
        }
    };
    results.unknowns.iter().all(agrees)
}

/// The unknowns of a kind, by their names.
fn names(results: &Results, kind: impl Fn(&Unknown) -> bool) -> Vec<&str> {
    results.unknowns.iter().filter(|one| kind(one)).map(|one| one.name.as_str()).collect()
}

fn is_known(one: &Unknown) -> bool {
    !one.is_free() && one.status == Some(Status::Ok)
}

fn is_unknown(one: &Unknown) -> bool {
    !one.is_free() && !is_known(one)
}

/// What was to be identified: `storage modulus of core`, `values of core and skins`.
fn what(results: &Results) -> String {
    match &results.unknowns[..] {
        [only] => format!("{} of {}", only.what()[1], only.name),
        _ => format!("values of {}", listed(&names(results, |_| true))),
    }
}

/// Why no value can be used.
fn unusable(results: &Results) -> Option<String> {
    let what = what(results);
    if results.summary.word("/fit/verdict") == "not explained" {
        return Some(format!("The model cannot explain the measurements, so no {what} can be trusted."));
    }
    let is_free = results.unknowns.iter().any(Unknown::is_free);
    let (_, ok) = trusted(&results.band);
    if results.unknowns.iter().any(is_known) || (is_free && ok > 0) {
        return None;
    }
    let most = Status::ALL.into_iter().max_by_key(|&status| results.band.count(status));
    let why = most.filter(|_| is_free).unwrap_or(Status::NotIdentifiable).meaning();
    Some(match &results.unknowns[..] {
        [only] if only.is_free() => format!("No frequency has a trusted {what}: {why}."),
        _ => format!("No value of {} is trusted: {why}.", listed(&names(results, |_| true))),
    })
}

/// What is known, and of how much of the band.
fn claim(results: &Results) -> String {
    let (asked, ok) = trusted(&results.band);
    let share = percent(ok as f64 / asked.max(1) as f64);
    let part = format!("known at {ok} of {asked} frequencies ({share})");
    match &results.unknowns[..] {
        [only] if only.is_free() => format!("The {} is {part}", what(results)),
        [_] => format!("The {} is known for the whole band", what(results)),
        _ => {
            let groups = [
                (names(results, is_known), "known for the whole band"),
                (names(results, is_unknown), "not"),
                (names(results, Unknown::is_free), part.as_str()),
            ];
            let claim = |(names, how): &(Vec<&str>, &str)| {
                format!("{} {} {how}", listed(names), if names.len() == 1 { "is" } else { "are" })
            };
            let there = groups.iter().filter(|(names, _)| !names.is_empty());
            there.map(claim).collect::<Vec<_>>().join("; ")
        }
    }
}

/// What speaks against some of it, or that no independent measurement supports it.
fn doubt(results: &Results, is_confirmed: bool) -> Option<&'static str> {
    let (asked, ok) = trusted(&results.band);
    let not_identifiable = !results.identifiability.not_identifiable.is_empty();
    let doubts = [
        (
            !results.summary.array("/findings").is_empty(),
            ", but something is wrong with the data: correct it first.",
        ),
        (!results.summary.undecided().is_empty(), ", but something may be wrong with the data: see below."),
        (
            results.summary.word("/identify/selection") == "smallest" && !is_confirmed,
            " by the rule of the smallest correction. Nothing independent confirms it.",
        ),
        (contradicting(results), "; a sensor contradicts the others."),
        (
            not_identifiable || results.unknowns.iter().any(is_unknown),
            ". Not everything is identifiable from the measurements: see below.",
        ),
        (!results.converged(), ", but the search for it did not converge."),
    ];
    if let Some((_, doubt)) = doubts.into_iter().find(|(holds, _)| *holds) {
        return Some(doubt);
    }
    match (results.summary.word("/fit/verdict"), ok as f64 >= MIN_TRUSTED_SHARE * asked as f64) {
        ("explained", true) => None,
        ("explained", false) => Some(
            "; at the other frequencies the value is not identifiable, or the measurements are not explained.",
        ),
        ("nearly explained", _) => {
            Some("; the misfit between model and measurement is a little larger than the noise.")
        }
        (_, true) if is_confirmed => None,
        _ => Some(", but no independent measurement tests the fit."),
    }
}

/// `a`, `a and b`, `a, b and c`.
fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn contradicting(results: &Results) -> bool {
    let says = |sensor: &serde_json::Value| sensor.get("contradicts").and_then(serde_json::Value::as_bool);
    results.summary.array("/sensors").iter().any(|sensor| says(sensor) == Some(true))
}

fn shares(band: &Band, own: bool) -> Vec<Share> {
    let points = points(band);
    let there = Status::ALL.into_iter().filter(|&status| band.count(status) > 0);
    there
        .map(|status| {
            let bands = bands_hz(points.iter().map(|&(f, s)| (f, s == status)));
            let place = if bands.is_empty() { "lines between the others.".into() } else { where_(&bands) };
            Share {
                status,
                count: band.count(status),
                label: label(status, own),
                words: format!("{}: {place}", meaning(status, own)),
            }
        })
        .collect()
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

fn cautions(results: &Results, is_confirmed: bool) -> Vec<String> {
    let summary = &results.summary;
    let mut cautions: Vec<String> = (results.identifiability.not_identifiable.iter())
        .map(|sentence| format!("Not identifiable from these measurements: {sentence}."))
        .collect();
    if !results.converged() {
        cautions
            .push("The search did not converge. Use more frequencies or sensors, or narrower bounds.".into());
    }
    let mut say = |text: String| cautions.push(text);
    for breach in summary.array("/causality_breaches") {
        let unknown = breach.get("unknown").and_then(serde_json::Value::as_str).unwrap_or("modulus");
        let hz = |k: usize| breach.pointer(&format!("/range_hz/{k}")).and_then(serde_json::Value::as_f64);
        let [Some(from), Some(to)] = [hz(0), hz(1)] else { continue };
        say(format!(
            "{unknown} is not the modulus of a causal material at {} to {} Hz: it falls there, or rises faster than its loss factor allows. \
             Something else than the material may have been identified: a joint, a missing part of the model.",
            significant(from, 3),
            significant(to, 3)
        ));
    }
    for sensor in summary.array("/sensors") {
        let label = sensor.get("label").and_then(serde_json::Value::as_str).unwrap_or("");
        let flag = |key| sensor.get(key).and_then(serde_json::Value::as_bool) == Some(true);
        if flag("dead") {
            say(format!("Sensor {label} shows nothing beside the others. It was left out."));
        }
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
                    "The {what} of sensor {label} was unknown, and is not identifiable from the data: it was left out."
                ),
            });
        }
    }
    let contradicted = summary.array("/model_errors/contradicted_assumptions");
    // Where the values are known nothing has to be tested: what the next case needs is said once.
    let is_tested =
        ["explained", "nearly explained", "not explained"].contains(&summary.word("/fit/verdict"));
    let is_by_rule = summary.word("/identify/selection") == "smallest";
    let is_confirmed_alone = is_confirmed && (!is_tested || is_by_rule);
    let doubt = doubt_of_fit(results).filter(|_| contradicted.is_empty() && (is_tested || !is_confirmed));
    cautions.extend(doubt);
    cautions.extend(suspects(results));
    for one in contradicted {
        let text = one.get("text").and_then(serde_json::Value::as_str).unwrap_or("");
        cautions.push(format!("The measurements contradict what the case takes for known: {text}."));
    }
    if is_confirmed_alone {
        cautions.push(confirmation(results, is_by_rule));
    } else if is_by_rule {
        cautions.push("Of several solutions the one with the smallest correction was taken (selection = \"smallest\", the rule of the paper). It can be the wrong one and has no error bars. Run again with selection = \"joint\", which weighs all solutions over the band.".into());
    }
    cautions
}

/// Known parts of the model that the measurement contradicts by more than two standard deviations.
fn suspects(results: &Results) -> Vec<String> {
    let text = |of: &serde_json::Value, key: &str| {
        of.get(key).and_then(serde_json::Value::as_str).unwrap_or("").replace('_', " ")
    };
    let error = |of: &serde_json::Value| {
        let number = |key: &str| of.get(key).and_then(serde_json::Value::as_f64);
        let (error, std) = (number("error")?, number("std")?);
        (error.abs() > 2.0 * std).then_some((error, std))
    };
    let off =
        |(error, std): (f64, f64)| format!("{:+.2} ± {:.2} %", 100.0 * error, 200.0 * std).replace('-', "−");
    let summary = &results.summary;
    // A loss factor is off by a number, not by a share: the table of errors has it.
    let matrices =
        summary.array("/model_errors/matrices").iter().filter(|one| text(one, "part") != "loss factor");
    let matrices = matrices.filter_map(|one| {
        let off = off(error(one)?);
        Some(format!(
            "Check what the model takes for {}: according to the measurement it is off by {off}.",
            text(one, "matrix")
        ))
    });
    let channels = summary.array("/model_errors/calibrations").iter();
    let channels = channels.filter_map(|one| {
        let off = off(error(one)?);
        Some(format!(
            "Check the calibration of {}: according to the model it is off by {off}.",
            text(one, "channel")
        ))
    });
    matrices.chain(channels).collect()
}

/// Only the known values test the answer: what a measurement needs in their place.
fn confirmation(results: &Results, is_by_rule: bool) -> String {
    let needs = match (results.sensors.len(), is_by_rule) {
        (1, true) => "use a second sensor and selection = \"joint\"",
        (1, false) => "use a second sensor",
        (_, true) => "use selection = \"joint\"",
        (_, false) => "give the noise of the FRFs, or use more sensors",
    };
    format!(
        "Only the known values of this case test the answer. For a measurement without known values, {needs}: then the report has a test of the fit and error bars."
    )
}

/// What is to be said where noise is not all that is left, or that is not known.
fn doubt_of_fit(results: &Results) -> Option<String> {
    let summary = &results.summary;
    Some(match summary.word("/fit/verdict") {
        "not explained" => {
            "The difference between model and measurement is larger than the noise. Check sensors and units (frfit check), then mass, thickness, mesh and boundary conditions of the model."
                .into()
        }
        "nearly explained" => {
            match summary.number("/model_errors/response_std").filter(|rest| *rest > 0.0) {
                Some(rest) => format!(
                    "Use the values with their error bars. Beside noise and errors of the model {} of the response remains unexplained; the error bars contain this.",
                    percent(rest)
                ),
                None => {
                    let times = significant(summary.number("/fit/chi2_per_freedom").map_or(1.0, f64::sqrt), 3);
                    format!("Use the values with their error bars. The misfit is {times} times the noise; the error bars are longer by this factor.")
                }
            }
        }
        "explained" => return None,
        // What holds for the band has other frequencies to agree with.
        _ if results.sensors.len() == 1 && results.unknowns.iter().all(Unknown::is_free) => {
            "With one sensor every solution reproduces the measurement, so the good fit is no test. Add a second sensor."
                .into()
        }
        _ => format!("The fit was not tested against the noise: {}.", untested(results)),
    })
}

/// What an error bar says in words.
fn bars(value: f64, std: Option<f64>) -> String {
    match std {
        Some(std) => format!("± {} (two standard deviations)", percent(2.0 * std / value.abs())),
        None => "no error bar".into(),
    }
}

fn tiles(results: &Results, nominal_error: &[Option<f64>], own: bool) -> Vec<Tile> {
    let mut tiles: Vec<Tile> = results.unknowns.iter().flat_map(|one| tiles_of(results, one)).collect();
    tiles.extend(tiles_of_band(results, nominal_error, own));
    tiles.extend(known_answer(results));
    tiles
}

/// The numbers of a constant; of a curve value and loss factor in the middle of the band.
fn tiles_of(results: &Results, one: &Unknown) -> Vec<Tile> {
    if !one.is_curve() {
        return one.numbers.iter().map(|number| tile(one, number)).collect();
    }
    let band = &results.band;
    let of = if one.prefix.is_empty() { String::new() } else { format!("{}: ", one.name) };
    let tile = |(part, label, unit): (&str, &str, &str)| {
        let name = one.column(part);
        let rows: Vec<usize> = band.rows(Status::Ok).filter(|&row| band.at(&name, row).is_some()).collect();
        let (first, middle, last) = (*rows.first()?, *rows.get(rows.len() / 2)?, *rows.last()?);
        let value = |row: usize| Some(with_bar(band.at(&name, row)?, None, unit));
        let end = |row: usize| Some(format!("{} at {}", value(row)?, hertz(band.frequency_hz[row])));
        let std = band.at(&one.column(&format!("{part}_std")), middle);
        Some(Tile {
            label: format!("{of}{label} at {}", hertz(band.frequency_hz[middle])),
            value: value(middle)?,
            detail: match first == last {
                true => bars(band.at(&name, middle)?, std),
                false => format!("{}; {}, {}", bars(band.at(&name, middle)?, std), end(first)?, end(last)?),
            },
        })
    };
    let parts = [("storage", one.what()[0], one.unit()), ("loss_factor", "Loss factor η", "")];
    parts.into_iter().filter(|(part, ..)| !(one.real && *part == "loss_factor")).filter_map(tile).collect()
}

fn tile(one: &Unknown, number: &Number) -> Tile {
    let label =
        if number.name == "value" { one.name.clone() } else { format!("{} {}", one.name, number.name) };
    let label = label.replace('_', " ");
    if !one.is_known(number) {
        let detail = "the measurements do not limit this value".into();
        return Tile { label, value: "not identifiable".into(), detail };
    }
    Tile { label, value: one.shown(number, None), detail: bars(number.value, number.std) }
}

/// Where the measurement was made with known values.
fn known_answer(results: &Results) -> Option<Tile> {
    // What is not identifiable is not compared.
    let compared = || {
        let ok = |one: &&Unknown| one.is_free() || one.status == Some(Status::Ok);
        results.unknowns.iter().filter(ok)
    };
    let number = |one: &Unknown, pointer: &str| one.off.pointer(pointer).and_then(serde_json::Value::as_f64);
    let of_one = |one: &Unknown| {
        if let Some(relative) = number(one, "/relative") {
            let deviations = number(one, "/deviations")
                .map_or(String::new(), |d| format!(" ({d:.1} of its standard deviations)"));
            return Some(format!("{}: off by {}{deviations}", one.name, percent(relative)));
        }
        let (median, most) = (number(one, "/deviation/median_ok")?, number(one, "/deviation/max_ok")?);
        Some(format!(
            "{}: off by {} (median), by {} at most where trusted",
            one.name,
            percent(median),
            percent(most)
        ))
    };
    let each: Vec<String> = compared().filter_map(of_one).collect();
    let most = |pointer: &str| compared().filter_map(|one| number(one, pointer)).reduce(f64::max);
    let value = match most("/deviations") {
        Some(deviations) => format!("off by {} standard deviations at most", significant(deviations, 2)),
        None => {
            let off = most("/relative").into_iter().chain(most("/deviation/max_ok")).reduce(f64::max)?;
            format!("off by {} at most", percent(off))
        }
    };
    let detail = format!("{}. The case gives the known values as its reference.", each.join("; "));
    Some(Tile { label: "Compared with the known values".into(), value, detail })
}

/// How much of the band is trusted, how well the model fits, and whether the sensors agree; `own` as in [`Verdict::own`].
fn tiles_of_band(results: &Results, nominal_error: &[Option<f64>], own: bool) -> Vec<Tile> {
    let (band, summary) = (&results.band, &results.summary);
    let (asked, ok) = trusted(band);
    let mut tiles = Vec::new();
    tiles.push(Tile {
        label: format!("Frequencies that are {}", if own { "trusted" } else { "explained" }),
        value: percent(ok as f64 / asked.max(1) as f64),
        detail: format!(
            "{ok} of {asked}, from {} to {}",
            hertz(band.frequency_hz[0]),
            hertz(band.frequency_hz[band.len() - 1])
        ),
    });
    let median = |values: &mut dyn Iterator<Item = Option<f64>>| {
        let mut values: Vec<f64> = values.flatten().collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    if let Some(after) = median(&mut band.rows(Status::Ok).map(|row| band.at("error", row))) {
        let before = median(&mut band.rows(Status::Ok).map(|row| nominal_error[row]));
        tiles.push(Tile {
            label: "Error of the response, median".into(),
            value: percent(after),
            detail: match before {
                Some(before) => {
                    format!("updated model against measurement; {} with the nominal value", percent(before))
                }
                None => "updated model against measurement".into(),
            },
        });
    }
    let fit = summary.word("/fit/verdict");
    let chi = summary.number("/fit/chi2_per_freedom");
    tiles.push(match (fit, chi) {
        ("explained" | "nearly explained" | "not explained", Some(chi)) => Tile {
            label: "Does the model explain all sensors?".into(),
            value: match fit {
                "explained" => "yes".into(),
                "nearly explained" => "nearly".into(),
                _ if summary.array("/model_errors/contradicted_assumptions").is_empty() => "no".into(),
                _ => "yes, but not with what the case takes for known".into(),
            },
            detail: format!(
                "χ² per degree of freedom {}; noise {}{}",
                significant(chi, 3),
                noise(results),
                noise_size(results)
            ),
        },
        _ => Tile {
            label: "Does the model explain all sensors?".into(),
            value: "not tested".into(),
            detail: format!("{}; noise {}", untested(results), noise(results)),
        },
    });
    tiles
}

/// Why no χ² over the band shows whether noise is all that is left.
pub(crate) fn untested(results: &Results) -> &'static str {
    match results.sensors.len() {
        1 => "there is no second sensor",
        _ if !results.summary.array("/laws/laws").is_empty() => "the table of laws gives the χ² of each law",
        _ => "the noise is estimated from the misfit itself",
    }
}

/// Where the level of the noise is known from.
pub(crate) fn noise(results: &Results) -> &'static str {
    match results.summary.word("/noise/source") {
        "given" => "as given in the files",
        "sensors" => "estimated from how well the sensors agree",
        "scatter" => "estimated from the scatter over frequency",
        "curve" => "estimated from the residual of the smooth curve",
        _ => "unknown",
    }
}

/// The standard deviation of an estimated noise. If nothing else is known of it, a misfit as large as the response counts as noise.
fn noise_size(results: &Results) -> String {
    let is_share = results.summary.word("/noise/deviation").starts_with("size");
    let level = results.summary.number("/noise/level").filter(|_| is_share);
    level.map_or(String::new(), |level| format!(": {} of the response", percent(level)))
}

/// P-40 with the nominal response. Accelerance and receptance differ by one number at a frequency, so that the quotient is the same of either.
fn nominal_error(results: &Results) -> Vec<Option<f64>> {
    let left_out = |sensor: &serde_json::Value| {
        sensor.get("left_out").and_then(serde_json::Value::as_bool) == Some(true)
    };
    let all = results.sensors.iter().zip(results.summary.array("/sensors"));
    let counted: Vec<&Sensor> = all.filter(|(_, entry)| !left_out(entry)).map(|(sensor, _)| sensor).collect();
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
