//! The verdict of several unknowns.

use super::{
    Level, MOST_OF_IT, Names, Tile, Verdict, bars, doubt_of_fit, nominal_error, shared_tiles, shares, trusted,
};
use crate::number::{hertz, percent, significant, with_bar};
use crate::results::{Number, Results, Several, Unknown};
use frfit::identify::Status;

/// Values have the units of the case: numbers, laws and dimensions side by side.
const NO_UNIT: &str = "";

pub(super) fn verdict(results: &Results, several: &Several) -> Verdict {
    let nominal_error = nominal_error(results);
    let (level, headline) = level(results, several);
    let mut tiles: Vec<Tile> = several.unknowns.iter().flat_map(|one| tiles_of(results, one)).collect();
    let own = several.unknowns.iter().any(|one| one.varies == "frequency");
    let ok: Vec<usize> = results.band.rows(Status::Ok).collect();
    tiles.extend(shared_tiles(results, &ok, &nominal_error, own));
    tiles.extend(known_answer(several));
    Verdict {
        level,
        headline,
        tiles,
        shares: shares(&results.band, own),
        own,
        cautions: cautions(results, several),
        names: Names { storage: "Value".into(), thing: "value".into(), unit: NO_UNIT.into(), real: false },
        rows: Vec::new(),
        nominal_error,
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

fn is_or_are(names: &[&str]) -> &'static str {
    if names.len() == 1 { "is" } else { "are" }
}

fn level(results: &Results, several: &Several) -> (Level, String) {
    let who = |which: &dyn Fn(&Unknown) -> bool| -> Vec<&str> {
        several.unknowns.iter().filter(|one| which(one)).map(|one| one.name.as_str()).collect()
    };
    let all = listed(&who(&|_| true));
    let fit = results.summary.word("/fit/verdict");
    if fit == "not explained" {
        let told = format!("Do not use the values of {all} yet: the model cannot explain the measurements.");
        return (Level::Bad, told);
    }
    let is_free = |one: &Unknown| one.varies == "frequency";
    let free = who(&is_free);
    let known = who(&|one| !is_free(one) && one.status == Some(Status::Ok));
    let unknown = who(&|one| !is_free(one) && one.status != Some(Status::Ok));
    let (asked, ok) = trusted(&results.band);
    if known.is_empty() && (free.is_empty() || ok == 0) {
        return (Level::Bad, format!("No value of {all} is trusted: the measurements do not tell it."));
    }
    let mut told = Vec::new();
    if !known.is_empty() {
        told.push(format!("{} {} known for the whole band", listed(&known), is_or_are(&known)));
    }
    if !unknown.is_empty() {
        told.push(format!("{} {} not", listed(&unknown), is_or_are(&unknown)));
    }
    if !free.is_empty() {
        let part = percent(ok as f64 / asked.max(1) as f64);
        told.push(format!(
            "{} {} known at {ok} of {asked} frequencies ({part})",
            listed(&free),
            is_or_are(&free)
        ));
    }
    let told = told.join("; ");
    if !unknown.is_empty() || !several.not_told.is_empty() {
        return (Level::Care, format!("{told}. The measurements do not tell everything: see below."));
    }
    if !several.converged {
        return (Level::Care, format!("{told}, but the search for it did not settle."));
    }
    let most = ok as f64 >= MOST_OF_IT * asked as f64;
    match (fit, most) {
        ("explained", true) => (Level::Good, format!("{told}, and all sensors are explained to the noise.")),
        ("explained", false) => {
            (Level::Care, format!("{told}; elsewhere the measurements are not explained."))
        }
        ("nearly explained", _) => {
            (Level::Care, format!("{told}; a little more than the given noise is left."))
        }
        _ => (Level::Care, format!("{told}, but nothing independent tests the fit.")),
    }
}

fn cautions(results: &Results, several: &Several) -> Vec<String> {
    let mut told: Vec<String> = several
        .not_told
        .iter()
        .map(|sentence| format!("Not identifiable from these measurements: {sentence}."))
        .collect();
    if !several.converged {
        told.push("The search did not settle. More frequencies, sensors or narrower bounds may help.".into());
    }
    told.extend(doubt_of_fit(results));
    told
}

/// What a person wants to know of an unknown.
fn tiles_of(results: &Results, one: &Unknown) -> Vec<Tile> {
    if !one.numbers.is_empty() {
        return one.numbers.iter().map(|number| tile(one, number)).collect();
    }
    let band = &results.band;
    let [value, value_std, loss, loss_std] = one.columns();
    let parts = [(value, value_std, ""), (loss, loss_std, " loss factor")];
    let tile = |(value, std, what): (Option<String>, Option<String>, &str)| {
        let value = value?;
        let rows: Vec<usize> = band.rows(Status::Ok).filter(|&row| band.at(&value, row).is_some()).collect();
        let (first, middle, last) = (*rows.first()?, *rows.get(rows.len() / 2)?, *rows.last()?);
        let at = |row: usize| band.at(&value, row);
        let std = std.and_then(|std| band.at(&std, middle));
        let end = |row: usize| {
            Some(format!("{} at {}", with_bar(at(row)?, None, NO_UNIT), hertz(band.frequency_hz[row])))
        };
        Some(Tile {
            label: format!("{}{what} at {}", one.name, hertz(band.frequency_hz[middle])),
            value: with_bar(at(middle)?, None, NO_UNIT),
            detail: format!("{}; {} to {}", bars(at(middle)?, std), end(first)?, end(last)?),
        })
    };
    parts.into_iter().filter_map(tile).collect()
}

fn tile(one: &Unknown, number: &Number) -> Tile {
    let label =
        if number.name == "value" { one.name.clone() } else { format!("{} {}", one.name, number.name) };
    let label = label.replace('_', " ");
    if !one.is_told(number) {
        let detail = "the measurements leave any value of this size possible".into();
        return Tile { label, value: "not identifiable".into(), detail };
    }
    let value = with_bar(number.value, None, NO_UNIT);
    Tile { label, value, detail: bars(number.value, number.std) }
}

/// Where the measurement was made with known values.
fn known_answer(several: &Several) -> Option<Tile> {
    let one = |one: &Unknown| {
        let number = |key: &str| one.off.get(key).and_then(serde_json::Value::as_f64);
        // What is not told is not compared.
        if one.status.is_some_and(|status| status != Status::Ok) {
            return None;
        }
        if let Some(relative) = number("relative") {
            let deviations = number("deviations")
                .map_or(String::new(), |d| format!(" ({d:.1} of its standard deviations)"));
            return Some(format!("{}: {} off{deviations}", one.name, percent(relative)));
        }
        let off = number("deviation_max_ok")?;
        Some(format!("{}: at most {} off where trusted", one.name, percent(off)))
    };
    let told: Vec<String> = several.unknowns.iter().filter_map(one).collect();
    if told.is_empty() {
        return None;
    }
    let known = several.unknowns.iter().filter(|one| one.status.is_none_or(|status| status == Status::Ok));
    let most = |key: &str| known.clone().filter_map(|one| one.off.get(key)?.as_f64()).reduce(f64::max);
    let value = match (
        most("deviations"),
        most("relative").into_iter().chain(most("deviation_max_ok")).reduce(f64::max),
    ) {
        (Some(deviations), _) => format!("within {} deviations", significant(deviations, 2)),
        (None, off) => format!("{} off at most", percent(off?)),
    };
    Some(Tile {
        label: "Known answer".into(),
        value,
        detail: format!("{}. This case was made with known values.", told.join("; ")),
    })
}
