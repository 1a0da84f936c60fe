//! The reference of the case file, made of the keys that the reader takes.

use super::keys::{Key, SECTIONS};
use std::fmt::Write;

/// The reference as Markdown: each table, its keys, and an example.
pub fn reference() -> String {
    let mut page = String::from(HEAD);
    for section in SECTIONS.iter() {
        // Writing into a String cannot fail.
        let _ = writeln!(page, "\n## {}\n\n{}\n", section.title, section.about);
        let _ = writeln!(page, "| Key | Value | Default | Description |\n|---|---|---|---|");
        for Key { name, value, otherwise, about } in section.keys {
            let _ = writeln!(page, "| `{name}` | {} | {} | {} |", cell(value), cell(otherwise), cell(about));
        }
        for example in section.examples {
            let _ = write!(page, "\n```toml\n{example}```\n");
        }
    }
    page
}

const HEAD: &str = "# Reference of the case file\n";

/// Text of a table's cell: a stroke would begin the next one.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::super::keys::{NEEDED, Section};
    use super::*;
    use crate::case::parse;
    use std::collections::BTreeSet;
    use std::ops::Range;
    use std::path::Path;
    use toml::de::{DeTable, DeValue};

    /// Tables that a case needs; an example has its own in their place.
    const REST: [(&str, &str); 3] = [
        ("[[matrix]]", "[[matrix]]\nname = \"rest\"\nrole = \"mass\"\nfile = \"M.mtx\"\n"),
        ("[load]", "[load]\nrow = 1\n"),
        ("[[measurement]]", "[[measurement]]\nrow = 1\n"),
    ];

    fn read(example: &str) -> Result<(), String> {
        let rest = REST.iter().filter(|(header, _)| !example.contains(header)).map(|(_, text)| *text);
        let text: String = std::iter::once(example).chain(rest).collect();
        parse(Path::new("case.toml"), text.as_bytes()).map(drop).map_err(|error| error.to_string())
    }

    /// A key of a document: the keys that lead to its table, and where key and value stand.
    struct Written {
        path: String,
        name: String,
        key: Range<usize>,
        value: Range<usize>,
    }

    fn written(example: &str) -> Vec<Written> {
        fn walk(path: &str, table: &DeTable<'_>, all: &mut Vec<Written>) {
            for (key, value) in table {
                let name = key.get_ref().to_string();
                let below = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                match value.get_ref() {
                    DeValue::Table(inner) => walk(&below, inner, all),
                    DeValue::Array(items) => {
                        let tables = items.iter().filter_map(|item| item.get_ref().as_table());
                        tables.for_each(|inner| walk(&below, inner, all));
                    }
                    _ => {}
                }
                all.push(Written { path: path.to_owned(), name, key: key.span(), value: value.span() });
            }
        }
        let mut all = Vec::new();
        walk("", DeTable::parse(example).unwrap().get_ref(), &mut all);
        all
    }

    /// The keys of a section in its examples, each with its example.
    fn shown(section: &'static Section) -> Vec<(&'static str, Written)> {
        let of = |example: &'static str| written(example).into_iter().map(move |key| (example, key));
        let all = section.examples.iter().flat_map(|example| of(example));
        all.filter(|(_, key)| key.path == section.path).collect()
    }

    #[test]
    fn every_key_stands_in_an_example_that_is_read() {
        for section in SECTIONS.iter() {
            for example in section.examples {
                read(example).unwrap_or_else(|error| panic!("{error}\n{example}"));
            }
            let known: BTreeSet<&str> = section.keys.iter().map(|key| key.name).collect();
            let shown: BTreeSet<String> = shown(section).into_iter().map(|(_, key)| key.name).collect();
            let missing: Vec<_> = known.iter().filter(|name| !shown.contains(**name)).collect();
            assert!(missing.is_empty(), "{}: no example has {missing:?}", section.title);
        }
    }

    /// A key that the reader does not look at would pass with any value.
    #[test]
    fn every_key_is_looked_at() {
        for (section, (example, key)) in
            SECTIONS.iter().flat_map(|one| shown(one).into_iter().map(move |k| (one, k)))
        {
            if !section.keys.iter().any(|known| known.name == key.name)
                || section.path.is_empty() && key.name != "title"
            {
                // Tables of the file are tried by their own keys.
                continue;
            }
            let (before, after) = (&example[..key.value.start], &example[key.value.end..]);
            let broken = format!("{before}1979-05-27{after}");
            let place = format!("{}.{}:", key.path, key.name);
            let error = read(&broken).expect_err(&broken);
            assert!(error.contains(place.trim_start_matches('.')), "{error}\n{broken}");
        }
    }

    #[test]
    fn needed_keys_are_needed() {
        for section in SECTIONS.iter().filter(|section| !section.path.is_empty()) {
            for (example, key) in shown(section) {
                if !section.keys.iter().any(|known| known.name == key.name && known.otherwise == NEEDED) {
                    continue;
                }
                let after = &example[key.value.end..];
                let after = after.strip_prefix(", ").unwrap_or(after);
                let without = format!("{}{}", &example[..key.key.start], after);
                let without = without.replace(",  }", " }").replace(", }", " }");
                assert!(read(&without).is_err(), "{}: {} is not needed:\n{without}", section.title, key.name);
            }
        }
    }

    /// Words in quotes are those that the reader itself names when it finds another.
    #[test]
    fn words_are_those_of_the_reader() {
        let quoted = |text: &str| -> BTreeSet<String> {
            text.split('"').skip(1).step_by(2).map(|word| word.replace(":N", "")).collect()
        };
        for section in SECTIONS.iter() {
            for key in section.keys.iter().filter(|key| key.value.contains('"')) {
                let (example, at) = shown(section).into_iter().find(|(_, at)| at.name == key.name).unwrap();
                let broken = format!("{}\"?\"{}", &example[..at.value.start], &example[at.value.end..]);
                let error = read(&broken).expect_err(&broken);
                let expected = error.split("expected ").nth(1).unwrap().split(", found").next().unwrap();
                assert_eq!(quoted(key.value), quoted(expected), "{}: {}", section.title, key.name);
            }
        }
    }

    #[test]
    fn the_page_is_the_reference() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/site/src/case-file.md");
        if std::env::var_os("FRFIT_RENEW").is_some() {
            std::fs::write(&page, reference()).unwrap();
        }
        let committed = std::fs::read_to_string(&page).unwrap().replace("\r\n", "\n");
        assert!(
            committed == reference(),
            "{} is not the reference; CONTRIBUTING.md says how to renew it",
            page.display()
        );
    }
}
