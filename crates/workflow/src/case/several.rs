//! `[[identify]]`: several unknowns, or one that does not vary.

use super::field::{Field, Table};
use super::keys;
use super::sections::{MOST_POWER, band, exclude, factor};
use super::{Located, SeveralEntry, UnknownEntry, UnknownVaries};
use crate::error::InputError;
use frfit::laws::{LawKind, UnknownLawKind};

/// Keys of a single unknown that varies.
const OF_ONE: [&str; 5] = ["method", "order", "selection", "reduction", "check"];

/// Whether `identify` is such: `[[identify]]`, or a single table with `powers` or a constant.
pub(super) fn is_several(field: &Field<'_>) -> bool {
    let has = |key: &str, value: Option<&str>| field.has(key, value);
    field.is_list() || has("powers", None) || has("varies", Some("constant"))
}

/// All unknowns.
pub(super) fn several(field: &Field<'_>) -> Result<SeveralEntry, InputError> {
    // Keys of a single unknown that varies are known, to be refused for what they are.
    let known = [&keys::SEVERAL, &keys::SEVERAL_FIRST, &keys::IDENTIFY];
    let tables = match field.is_list() {
        true => field.tables("identify", &known)?,
        false => vec![field.table(&known)?],
    };
    if let Some(key) = tables.iter().find_map(|table| OF_ONE.into_iter().find_map(|key| table.find(key))) {
        let expected = "no such key with several unknowns, or with one that does not vary: there is one way to find them";
        return Err(InputError::at(&key.place, expected, "one"));
    }
    for table in &tables[1..] {
        if let Some(key) = keys::SEVERAL_FIRST.keys.iter().find_map(|key| table.find(key.name)) {
            return Err(InputError::at(&key.place, "this key in the first [[identify]], for all", "it here"));
        }
    }
    let first = &tables[0];
    let unknowns = tables.iter().map(unknowns).collect::<Result<Vec<_>, _>>()?;
    for (k, one) in unknowns.iter().enumerate() {
        if unknowns[..k].iter().any(|earlier| earlier.name.value == one.name.value) {
            let found = format!("{:?} a second time", one.name.value);
            return Err(InputError::at(&one.name.place, "a name of its own for each unknown", found));
        }
    }
    Ok(SeveralEntry {
        place: first.place.clone(),
        unknowns,
        band_hz: first.find("band_hz").map(|field| band(&field)).transpose()?,
        exclude: first.find("exclude_hz").map_or(Ok(Vec::new()), |field| exclude(&field))?,
        max_lines: first.find("max_lines").map(|most| most.whole()).transpose()?,
        reject_outliers: first.find("reject_outliers").map(|reject| reject.flag()).transpose()?,
    })
}

fn unknowns(table: &Table<'_>) -> Result<UnknownEntry, InputError> {
    let powers = table.find("powers").map(|field| powers(&field)).transpose()?.unwrap_or_default();
    let matrices = match (table.find("matrix"), powers.is_empty()) {
        (Some(matrix), true) => matrix.texts()?,
        (None, false) => Vec::new(),
        (Some(matrix), false) => {
            return Err(InputError::at(&matrix.place, "one of matrix and powers", "both"));
        }
        // a dimension of matrices that are given at its values
        (None, true) if table.find("nominal").is_some() => Vec::new(),
        (None, true) => {
            let expected = "the key matrix (whose factor is unknown) or powers (a dimension)";
            return Err(InputError::at(&table.place, expected, "none"));
        }
    };
    let is_dimension = matrices.is_empty();
    let name = match table.find("name") {
        Some(name) => name.text()?,
        None if is_dimension => {
            return Err(InputError::at(&table.place, "the key name of a dimension", "none"));
        }
        None => {
            let joined = matrices.iter().map(|name| name.value.clone()).collect::<Vec<_>>().join(", ");
            Located { value: joined, place: table.place.clone() }
        }
    };
    let real = table.find("real").map(|real| real.flag()).transpose()?.unwrap_or(is_dimension);
    let varies = varies(table, is_dimension, real)?;
    let nominal = match table.find("nominal") {
        Some(field) if is_dimension => Some(Located { value: field.number()?, place: field.place }),
        Some(field) => {
            let expected = "no nominal value: it is the factor of the matrix";
            return Err(InputError::at(&field.place, expected, "one"));
        }
        None if is_dimension => {
            return Err(InputError::at(
                &table.place,
                "the key nominal, the dimension's value to begin with",
                "none",
            ));
        }
        None => None,
    };
    let (mut storage, mut loss_factor) = (None, None);
    if let Some(field) = table.find("bounds") {
        if field.is_table() {
            let bounds = field.table(&[&keys::SEVERAL_BOUNDS])?;
            let bound = |name| bounds.find(name).map(|f| f.pair()).transpose();
            (storage, loss_factor) = (bound("storage")?, bound("loss_factor")?);
        } else {
            storage = Some(field.pair()?);
        }
    }
    for bound in storage.iter().chain(&loss_factor) {
        let [low, high] = bound.value;
        if !(low < high && high.is_finite()) {
            return Err(InputError::at(
                &bound.place,
                "[low, high] with low < high",
                format!("[{low}, {high}]"),
            ));
        }
    }
    Ok(UnknownEntry {
        place: table.place.clone(),
        name,
        matrices,
        powers,
        varies,
        real,
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

fn varies(table: &Table<'_>, is_dimension: bool, real: bool) -> Result<UnknownVaries, InputError> {
    const EXPECTED: &str = "\"frequency\" (a value of its own at each), \"constant\" or \"law\"";
    enum Word {
        Frequency,
        Constant,
        Law,
    }
    let word = |word: &str| match word {
        "frequency" => Ok(Word::Frequency),
        "constant" => Ok(Word::Constant),
        "law" => Ok(Word::Law),
        _ => Err(EXPECTED.to_owned()),
    };
    let found = table.find("varies").map(|field| field.word(word)).transpose()?;
    let (law, branches) = (table.find("law"), table.find("branches"));
    match found {
        Some(Located { value: Word::Law, place }) => {
            if real {
                return Err(InputError::at(
                    &place,
                    "\"frequency\" or \"constant\" for a real unknown",
                    "\"law\"",
                ));
            }
            let law = law.ok_or_else(|| InputError::at(&place, "the key law beside it", "none"))?;
            let family =
                law.word(|word| word.parse::<LawKind>().map_err(|_| UnknownLawKind::EXPECTED.to_owned()))?;
            let mut family = family.value;
            if let Some(key) = branches {
                let branches = super::sections::branches(&key)?;
                match family {
                    LawKind::Maxwell { .. } => family = LawKind::Maxwell { branches },
                    _ => return Err(InputError::at(&key.place, "law = \"maxwell\" beside it", "none")),
                }
            }
            Ok(UnknownVaries::ByLaw(family))
        }
        other => {
            if let Some(key) = law.or(branches) {
                return Err(InputError::at(&key.place, "varies = \"law\" beside it", "none"));
            }
            Ok(match other {
                Some(Located { value: Word::Constant, .. }) => UnknownVaries::Constant,
                Some(_) => UnknownVaries::PerFrequency,
                None if is_dimension => UnknownVaries::Constant,
                None => UnknownVaries::PerFrequency,
            })
        }
    }
}
