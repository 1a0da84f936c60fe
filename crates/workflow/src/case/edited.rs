//! A case with other values in it, as a plan of many runs has them.

use toml_edit::{DocumentMut, Item, Table, Value};

/// A value in place of that of a case: the path of its key and what would stand there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Edit<'a> {
    /// `identify.bounds.storage`, `measurement.2.file`, `matrix.core.factor.storage`: of a list of tables the number of one from 1, its name, or nothing where there is one.
    pub(crate) key: &'a str,
    /// As TOML, or else a text.
    pub(crate) value: &'a str,
}

/// Why a value cannot be put into a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct EditError {
    /// Which of them.
    pub(crate) edit: usize,
    /// What there should be.
    pub(crate) expected: String,
    /// What there is.
    pub(crate) found: String,
}

/// The text of a case with some values put into it; its lines stay where they are, as far as no key is new. A text that is no TOML stays as it is: who reads it says what is wrong.
pub(crate) fn edited(text: &str, edits: &[Edit<'_>]) -> Result<String, EditError> {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return Ok(text.to_owned()) };
    for (edit, Edit { key, value }) in edits.iter().enumerate() {
        let refuse = |(expected, found): (String, String)| EditError { edit, expected, found };
        let keys: Vec<&str> = key.split('.').collect();
        let value = value.parse().unwrap_or_else(|_| Value::from(*value));
        put(document.as_item_mut(), &keys, value).map_err(refuse)?;
    }
    Ok(document.to_string())
}

/// What was expected, and what was found.
type Refusal = (String, String);

fn put(item: &mut Item, keys: &[&str], value: Value) -> Result<(), Refusal> {
    let Some((key, rest)) = keys.split_first() else {
        // The spaces and comments around it stay.
        let around = item.as_value().map(|old| old.decor().clone());
        let mut value = value.decorated(" ", "");
        if let Some(around) = around {
            *value.decor_mut() = around;
        }
        *item = Item::Value(value);
        return Ok(());
    };
    if item.is_none() {
        *item = Item::Table(Table::new());
    }
    if let Some(tables) = item.as_array_of_tables_mut() {
        let names = tables.iter().map(|table| table.get("name").and_then(Item::as_str));
        let (index, rest) = one_of(&names.collect::<Vec<_>>(), keys)?;
        return match tables.get_mut(index) {
            Some(table) => put_into(table, rest, value),
            None => Ok(()),
        };
    }
    if let Some(values) = item.as_array_mut().filter(|values| values.iter().any(Value::is_inline_table)) {
        let name = |value: &Value| value.as_inline_table()?.get("name")?.as_str().map(str::to_owned);
        let names: Vec<Option<String>> = values.iter().map(name).collect();
        let (index, rest) = one_of(&names.iter().map(Option::as_deref).collect::<Vec<_>>(), keys)?;
        if rest.is_empty() {
            return Err(no_key());
        }
        return values.get_mut(index).map_or(Ok(()), |one| put_below(one, rest, value));
    }
    if let Some(table) = item.as_table_mut() {
        return put_into(table, keys, value);
    }
    if let Some(table) = item.as_inline_table_mut() {
        let inner = table.entry(*key).or_insert(Value::InlineTable(toml_edit::InlineTable::new()));
        return put_below(inner, rest, value);
    }
    Err((format!("a table, for its key {key:?}"), item.type_name().to_owned()))
}

/// Which of several tables, of which some have names, the first key means, and the keys below it. The only table needs
/// no key.
fn one_of<'k, 'a>(names: &[Option<&str>], keys: &'k [&'a str]) -> Result<(usize, &'k [&'a str]), Refusal> {
    let count = names.len();
    let Some((key, rest)) = keys.split_first() else { return Err(no_key()) };
    let found = match key.parse::<usize>() {
        Ok(number) => number.checked_sub(1).filter(|&k| k < count).map(|k| (k, rest)),
        Err(_) => match names.iter().position(|name| *name == Some(*key)) {
            Some(index) => Some((index, rest)),
            None => (count == 1).then_some((0, keys)),
        },
    };
    found.ok_or_else(|| {
        (format!("the name or the number (1 to {count}) of one of several tables"), format!("{key:?}"))
    })
}

fn no_key() -> Refusal {
    ("a key of the table".into(), "none".into())
}

/// Puts a value below another one: all that is below it are values too.
fn put_below(inner: &mut Value, keys: &[&str], value: Value) -> Result<(), Refusal> {
    let mut inside = Item::Value(inner.clone());
    put(&mut inside, keys, value)?;
    if let Ok(changed) = inside.into_value() {
        *inner = changed;
    }
    Ok(())
}

fn put_into(table: &mut Table, keys: &[&str], value: Value) -> Result<(), Refusal> {
    match keys {
        [] => Err(no_key()),
        [key] => {
            table.insert(key, Item::Value(value));
            Ok(())
        }
        [key, rest @ ..] => put(table.entry(key).or_insert(Item::None), rest, value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "title = \"a\" # as it was\n\n[[matrix]]\nname = \"K\"\nfactor = { storage = 1.0, loss_factor = 0.1 }\n\n[[matrix]]\nname = \"M\"\n\n\
                        [[measurement]]\nfile = \"a.csv\"\n\n[identify]\nband_hz = [1.0, 2.0]\n";

    fn with(key: &str, value: &str) -> Result<String, String> {
        edited(CASE, &[Edit { key, value }])
            .map_err(|error| format!("expected {}, found {}", error.expected, error.found))
    }

    #[test]
    fn values_are_replaced_where_they_stand() {
        let changed =
            |key, value, old, new| assert_eq!(with(key, value).unwrap(), CASE.replacen(old, new, 1), "{key}");
        changed("measurement.file", "b.csv", "\"a.csv\"", "\"b.csv\"");
        changed("measurement.1.file", "b.csv", "\"a.csv\"", "\"b.csv\"");
        changed("identify.band_hz", "[1.0, 3.5]", "[1.0, 2.0]", "[1.0, 3.5]");
        changed("matrix.K.factor.storage", "2e9", "storage = 1.0", "storage = 2e9");
        changed("matrix.2.name", "mass", "\"M\"", "\"mass\"");
    }

    #[test]
    fn tables_of_an_inline_list_are_found_as_well() {
        const INLINE: &str = "matrix = [{ name = \"K\", file = \"K.mtx\" }, { name = \"M\", file = \"M.mtx\" }]\n\
                              measurement = [ { file = \"a.csv\", row = 3 } ] # one\n";
        let changed = |key, value, old, new| {
            let found = edited(INLINE, &[Edit { key, value }]).unwrap();
            assert_eq!(found, INLINE.replacen(old, new, 1), "{key}");
        };
        changed("measurement.1.file", "b.csv", "\"a.csv\"", "\"b.csv\"");
        changed("measurement.file", "b.csv", "\"a.csv\"", "\"b.csv\"");
        changed("measurement.row", "4", "row = 3", "row = 4");
        changed("matrix.M.file", "B.mtx", "\"M.mtx\"", "\"B.mtx\"");
        changed("matrix.2.name", "mass", "\"M\"", "\"mass\"");
        for (key, expected, found) in [
            ("measurement.2.file", "the name or the number (1 to 1) of one of several tables", "\"2\""),
            ("matrix.C.file", "the name or the number (1 to 2) of one of several tables", "\"C\""),
            ("matrix.1", "a key of the table", "none"),
        ] {
            let error = edited(INLINE, &[Edit { key, value: "x" }]).unwrap_err();
            assert_eq!((&*error.expected, &*error.found), (expected, found), "{key}");
        }
    }

    #[test]
    fn new_keys_are_added_to_their_tables() {
        let added = with("identify.bounds.storage", "[1.0, 2.0]").unwrap();
        let parsed: toml_edit::DocumentMut = added.parse().unwrap();
        assert_eq!(parsed["identify"]["bounds"]["storage"].as_array().unwrap().len(), 2, "{added}");
        let added = with("matrix.K.factor.more.deep", "7").unwrap();
        assert!(added.contains("deep = 7"), "{added}");
    }

    #[test]
    fn a_path_that_leads_nowhere_is_refused() {
        let refused = with("matrix.C.factor", "1.0").unwrap_err();
        assert_eq!(refused, "expected the name or the number (1 to 2) of one of several tables, found \"C\"");
        let refused = with("title.name", "b").unwrap_err();
        assert_eq!(refused, "expected a table, for its key \"name\", found string");
        assert!(with("measurement", "b").is_ok());
    }
}
