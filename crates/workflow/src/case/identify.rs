//! `[identify]` and `[[identify]]`: what is unknown, and how it is to be found.

use super::entries::{Exclusion, IdentifyEntry, Located, UnknownEntry};
use super::field::{Field, Table};
use super::keys;
use super::sections::{MOST_POWER, band, factor};
use crate::error::{InputError, Place};
use frfit::identify::{UnknownChoice, Variation};
use frfit::laws::{LawKind, MAX_BRANCHES, UnknownLawKind};
use std::str::FromStr;

/// All unknowns; a single table is a list of one.
pub(super) fn identify(field: &Field<'_>) -> Result<IdentifyEntry, InputError> {
    let known = [&keys::UNKNOWN, &keys::FOR_ALL, &keys::SINGLE];
    let tables = match field.is_list() {
        true => field.tables("identify", &known)?,
        false => vec![field.table(&known)?],
    };
    for table in &tables[1..] {
        if let Some(key) = table.find_any(&keys::FOR_ALL) {
            return Err(InputError::at(&key.place, "this key in the first [[identify]], for all", "it here"));
        }
    }
    let unknowns = tables.iter().map(unknown).collect::<Result<Vec<_>, _>>()?;
    for (k, one) in unknowns.iter().enumerate() {
        if unknowns[..k].iter().any(|earlier| earlier.name.value == one.name.value) {
            let found = format!("{:?} a second time", one.name.value);
            return Err(InputError::at(&one.name.place, "a name of its own for each unknown", found));
        }
    }
    let first = &tables[0];
    let start = |word: &str| (word == "bounds").then_some(()).ok_or_else(|| START.to_owned());
    Ok(IdentifyEntry {
        place: first.place.clone(),
        unknowns,
        band_hz: first.find("band_hz").map(|field| band(&field)).transpose()?,
        exclude: match first.find("exclude_hz") {
            Some(field) => Located { value: exclude(&field)?, place: field.place },
            None => Located { value: Vec::new(), place: first.place.clone() },
        },
        max_lines: first.find("max_lines").map(|most| most.whole()).transpose()?,
        reject_outliers: first.find("reject_outliers").map(|reject| reject.flag()).transpose()?,
        check: first.find("check").map(|check| check.flag()).transpose()?.unwrap_or(true),
        method: choice(first, "method")?.map(|method| method.value),
        order: first.find("order").map(|order| order.whole()).transpose()?,
        selection: choice(first, "selection")?,
        reduction: choice(first, "reduction")?.map(|reduction| reduction.value),
        start: first.find("start").map(|field| field.word(start)).transpose()?.map(|start| start.place),
        // Whether there is a single unknown that varies is known when the matrices are.
        of_single: tables.iter().find_map(|table| table.find_any(&keys::SINGLE)).map(|key| key.place),
    })
}

/// The one thing that `start` can say: numbers belong to the matrix.
const START: &str = "\"bounds\" (a nominal value is the factor of the matrix)";

fn choice<T: FromStr<Err = UnknownChoice>>(
    table: &Table<'_>,
    key: &str,
) -> Result<Option<Located<T>>, InputError> {
    let choice = |word: &str| word.parse::<T>().map_err(|unknown| unknown.expected.to_owned());
    table.find(key).map(|field| field.word(choice)).transpose()
}

/// Frequencies, and bands [low, high].
fn exclude(field: &Field<'_>) -> Result<Vec<Exclusion>, InputError> {
    const EXPECTED: &str = "a list of frequencies and bands [low, high] in Hz, as [100.0, [49.0, 51.0]]";
    field.each(EXPECTED, |item| match item.as_number() {
        Some(frequency_hz) if frequency_hz >= 0.0 => Ok(Exclusion::Line(frequency_hz)),
        Some(_) => Err(item.refuse("a frequency in Hz that is not negative")),
        None if item.is_list() => Ok(Exclusion::Band(band(item)?.value)),
        None => Err(item.refuse("a frequency or a band [low, high] in Hz")),
    })
}

fn unknown(table: &Table<'_>) -> Result<UnknownEntry, InputError> {
    let refuse = |place: &Place, expected: &str, found: &str| Err(InputError::at(place, expected, found));
    let (matrix, nominal) = (table.find("matrix"), table.find("nominal"));
    let powers = table.find("powers").map(|field| powers(&field)).transpose()?.unwrap_or_default();
    let matrices = match &matrix {
        Some(matrix) if powers.is_empty() => matrix.texts()?,
        Some(matrix) => return refuse(&matrix.place, "one of matrix and powers", "both"),
        // A dimension of matrices that are given at its values has no powers.
        None if powers.is_empty() && nominal.is_none() => {
            let expected = "the key matrix (whose factor is unknown) or powers (a dimension)";
            return refuse(&table.place, expected, "none");
        }
        None => Vec::new(),
    };
    let is_dimension = matrices.is_empty();
    let nominal = match nominal {
        Some(field) if is_dimension => Some(Located { value: field.number()?, place: field.place }),
        // `nominal = "estimate"` was a key of factors.
        Some(field) if field.is_text() => {
            let place = Place { key: table.place.key.clone(), ..field.place };
            return refuse(&place, "the key \"start\", which was renamed", "\"nominal\"");
        }
        Some(field) => {
            return refuse(&field.place, "no nominal value: it is the factor of the matrix", "one");
        }
        None if is_dimension => {
            return refuse(&table.place, "the key nominal, the dimension's value to begin with", "none");
        }
        None => None,
    };
    let name = match table.find("name") {
        Some(name) => name.text()?,
        None if is_dimension => return refuse(&table.place, "the key name of a dimension", "none"),
        None => {
            let names: Vec<&str> = matrices.iter().map(|name| name.value.as_str()).collect();
            Located { value: names.join(", "), place: table.place.clone() }
        }
    };
    let (mut storage, mut loss_factor) = (None, None);
    match table.find("bounds") {
        Some(field) if field.is_list() => storage = Some(field.pair()?),
        Some(field) if field.is_table() => {
            let bounds = field.table(&[&keys::BOUNDS])?;
            let bound = |name| bounds.find(name).map(|field| field.pair()).transpose();
            (storage, loss_factor) = (bound("storage")?, bound("loss_factor")?);
        }
        Some(field) => return Err(field.refuse("a table, or [low, high] of a real unknown")),
        None => {}
    }
    Ok(UnknownEntry {
        place: table.place.clone(),
        name,
        matrices,
        powers,
        varies: varies(table, is_dimension)?,
        real: table.find("real").map(|real| real.flag()).transpose()?.unwrap_or(is_dimension),
        nominal,
        storage,
        loss_factor,
        reference: table.find("reference").map(|reference| factor(&reference)).transpose()?,
    })
}

/// `powers = { bending = 3, mass = 1 }`.
fn powers(field: &Field<'_>) -> Result<Vec<(Located<String>, i32)>, InputError> {
    const EXPECTED: &str = "a table of matrices and powers, as { bending = 3, mass = 1 }";
    let each = field.entries().ok_or_else(|| field.refuse(EXPECTED))?;
    let mut powers = Vec::new();
    for (name, value) in each {
        let power = value.whole()?.value;
        if power == 0 || !(-MOST_POWER..=MOST_POWER).contains(&power) {
            let expected = format!("a whole number from -{MOST_POWER} to {MOST_POWER} other than 0");
            return Err(value.refuse(&expected));
        }
        powers.push((Located { value: name, place: value.place }, power as i32));
    }
    if powers.is_empty() { Err(field.refuse(EXPECTED)) } else { Ok(powers) }
}

/// What the word of `varies` alone says: `law` all laws.
///
/// # Errors
/// The words that there are.
pub(crate) fn variation(word: &str) -> Result<Variation, String> {
    match word {
        "frequency" => Ok(Variation::PerFrequency),
        "smooth" => Ok(Variation::Smooth),
        "constant" => Ok(Variation::Constant),
        "law" => Ok(Variation::Law(LawKind::ALL.to_vec())),
        _ => Err("\"frequency\" (a value of its own at each), \"smooth\", \"constant\" or \"law\"".into()),
    }
}

/// What `varies`, `law` and `branches` say together.
fn varies(table: &Table<'_>, is_dimension: bool) -> Result<Located<Variation>, InputError> {
    let usual = if is_dimension { Variation::Constant } else { Variation::PerFrequency };
    let varies = match table.find("varies") {
        Some(field) => field.word(variation)?,
        None => Located { value: usual, place: table.place.clone() },
    };
    let beside = |key: &Field<'_>, expected: &str| {
        Err(InputError::at(&key.place, format!("{expected} beside it"), "none"))
    };
    let (law, branches) = (table.find("law"), table.find("branches"));
    if !matches!(varies.value, Variation::Law(_)) {
        return law.or(branches).map_or(Ok(varies), |key| beside(&key, "varies = \"law\""));
    }
    let Some(law) = law else {
        return branches.map_or(Ok(varies), |key| beside(&key, "law = \"maxwell\""));
    };
    let named = law.texts()?;
    let mut kinds: Vec<LawKind> = Vec::with_capacity(named.len());
    for Located { value, place } in &named {
        let kind = value.parse::<LawKind>();
        let kind = kind.map_err(|_| InputError::at(place, UnknownLawKind::EXPECTED, format!("{value:?}")))?;
        if kinds.contains(&kind) {
            return Err(InputError::at(place, "each law once", format!("{value:?} a second time")));
        }
        kinds.push(kind);
    }
    if let Some(key) = branches {
        let count = usize::try_from(key.whole()?.value).ok().filter(|n| (1..=MAX_BRANCHES).contains(n));
        let branches = count.ok_or_else(|| key.refuse(&format!("1 to {MAX_BRANCHES}")))?;
        let of_any = || kinds.iter().position(|kind| matches!(kind, LawKind::Maxwell { .. }));
        match named.iter().position(|named| named.value == "maxwell").or_else(of_any) {
            Some(at) => kinds[at] = LawKind::Maxwell { branches },
            None => return beside(&key, "law = \"maxwell\""),
        }
    }
    Ok(Located { value: Variation::Law(kinds), place: varies.place })
}
