//! Tables and fields of a TOML document, each with its place and its path.

use super::document::Document;
use super::entries::Located;
use super::keys::{SECTIONS, Section};
use crate::error::{InputError, Place};
use crate::nearest::nearest;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table with no key but the known ones.
#[derive(Debug)]
pub(super) struct Table<'a> {
    document: &'a Document<'a>,
    pub(super) place: Place,
    fields: &'a DeTable<'a>,
}

/// The value of a key.
#[derive(Debug)]
pub(super) struct Field<'a> {
    document: &'a Document<'a>,
    pub(super) place: Place,
    value: &'a DeValue<'a>,
}

/// Keys that had another name: (old, new). A case with an old one is refused with the new one.
const RENAMED: [(&str, &str); 5] = [
    ("space", "reduction"),
    ("robust", "reject_outliers"),
    ("most_lines", "max_lines"),
    ("leave_out_hz", "exclude_hz"),
    ("truth", "reference"),
];

/// Where a key belongs that only one table has: to the top of the file, or into that table.
fn place_of(key: &str) -> Option<String> {
    let has = |section: &&&Section| section.keys.iter().any(|known| known.name == key);
    match SECTIONS.iter().filter(has).collect::<Vec<_>>()[..] {
        [only] if only.path.is_empty() => Some("to the top of the file, before the first table".into()),
        [only] if only.title.starts_with("`[") => Some(format!("into {}", only.title.trim_matches('`'))),
        _ => None,
    }
}

impl<'a> Table<'a> {
    /// A table at a place, with the keys of some sections.
    ///
    /// # Errors
    /// The first unknown key, with the known one that is nearest.
    pub(super) fn new(
        document: &'a Document<'a>,
        place: Place,
        fields: &'a DeTable<'a>,
        sections: &[&'static Section],
    ) -> Result<Self, InputError> {
        let listed = |section: &&'static Section| SECTIONS.iter().any(|known| std::ptr::eq(*known, *section));
        debug_assert!(sections.iter().all(listed), "keys that the reference does not show");
        let mut known: Vec<&str> = Vec::new();
        for key in sections.iter().flat_map(|section| section.keys) {
            if !known.contains(&key.name) {
                known.push(key.name);
            }
        }
        let is_unknown = |key: &&Spanned<_>| !known.iter().any(|name| *name == key.get_ref());
        if let Some(key) = fields.keys().filter(is_unknown).min_by_key(|key| key.span().start) {
            let here = document.place(key.span(), place.key.clone());
            let listed = known.join(", ");
            let renamed = RENAMED.iter().find(|(old, new)| old == key.get_ref() && known.contains(new));
            let expected = match renamed
                .map(|(_, new)| *new)
                .or_else(|| nearest(key.get_ref(), known.iter().copied()))
            {
                Some(name) if renamed.is_some() => format!("the key {name:?}, which was renamed"),
                Some(name) => format!("a known key, of which {name:?} is nearest"),
                None => match place_of(key.get_ref()) {
                    Some(place) => format!("a known key ({listed}); {} belongs {place}", key.get_ref()),
                    None => format!("a known key ({listed})"),
                },
            };
            return Err(InputError::at(&here, expected, shown(key.get_ref())));
        }
        Ok(Self { document, place, fields })
    }

    /// The field of a key, if it is there.
    pub(super) fn find(&self, key: &str) -> Option<Field<'a>> {
        let (name, value) = self.fields.iter().find(|(name, _)| name.get_ref() == key)?;
        // The key of a value, the header of a table: that is where a reader looks for it.
        let range = if value.get_ref().is_table() { value.span() } else { name.span() };
        let place = self.document.place(range, self.place.below(key).key);
        Some(Field { document: self.document, place, value: value.get_ref() })
    }

    /// The field of the first key of a section that is there.
    pub(super) fn find_any(&self, section: &Section) -> Option<Field<'a>> {
        section.keys.iter().find_map(|key| self.find(key.name))
    }

    /// The field of a key that has to be there.
    pub(super) fn need(&self, key: &str) -> Result<Field<'a>, InputError> {
        self.find(key).ok_or_else(|| InputError::at(&self.place, format!("the key {key:?}"), "none"))
    }
}

impl<'a> Field<'a> {
    /// The error that something else was expected here.
    pub(super) fn refuse(&self, expected: &str) -> InputError {
        InputError::at(&self.place, expected, described(self.value))
    }

    fn located<T>(&self, value: T) -> Located<T> {
        Located { value, place: self.place.clone() }
    }

    /// A text.
    pub(super) fn text(&self) -> Result<Located<String>, InputError> {
        let text = self.value.as_str().ok_or_else(|| self.refuse("a text in quotes"))?;
        Ok(self.located(text.to_owned()))
    }

    /// A text that stands for something.
    pub(super) fn word<T>(&self, read: impl Fn(&str) -> Result<T, String>) -> Result<Located<T>, InputError> {
        let text = self.text()?;
        let value = read(&text.value)
            .map_err(|expected| InputError::at(&self.place, expected, shown(&text.value)))?;
        Ok(self.located(value))
    }

    /// A text, or a list of at least one.
    pub(super) fn texts(&self) -> Result<Vec<Located<String>>, InputError> {
        let one_or_more = || self.refuse("a text in quotes or a list of at least one");
        match self.value {
            DeValue::String(_) => Ok(vec![self.text()?]),
            DeValue::Array(items) if !items.is_empty() => items
                .iter()
                .map(|item| {
                    let place = self.document.place(item.span(), self.place.key.clone());
                    Self { place, value: item.get_ref(), ..*self }.text()
                })
                .collect(),
            _ => Err(one_or_more()),
        }
    }

    /// A finite number.
    pub(super) fn number(&self) -> Result<f64, InputError> {
        number(self.value).ok_or_else(|| self.refuse("a finite number"))
    }

    /// Two finite numbers, in any order.
    pub(super) fn pair(&self) -> Result<Located<[f64; 2]>, InputError> {
        let items = self.value.as_array().map(|items| items.iter().map(|item| number(item.get_ref())));
        match items.map(Iterator::collect::<Option<Vec<_>>>) {
            Some(Some(numbers)) if numbers.len() == 2 => Ok(self.located([numbers[0], numbers[1]])),
            _ => Err(self.refuse("two finite numbers [low, high]")),
        }
    }

    /// Pairs of finite numbers, at least one.
    pub(super) fn pairs(&self, expected: &str) -> Result<Vec<[f64; 2]>, InputError> {
        let items = self.value.as_array().filter(|items| !items.is_empty());
        let items = items.ok_or_else(|| self.refuse(expected))?;
        let pair = |item: &Spanned<DeValue<'_>>| {
            let place = self.document.place(item.span(), self.place.key.clone());
            Field { place, value: item.get_ref(), ..*self }.pair()
        };
        items.iter().map(|item| Ok(pair(item)?.value)).collect()
    }

    /// What a list has, one item at a time.
    pub(super) fn each<T>(
        &self,
        expected: &str,
        read: impl Fn(&Field<'_>) -> Result<T, InputError>,
    ) -> Result<Vec<T>, InputError> {
        let items = self.value.as_array().ok_or_else(|| self.refuse(expected))?;
        let item = |item: &Spanned<DeValue<'_>>| {
            let place = self.document.place(item.span(), self.place.key.clone());
            read(&Field { place, value: item.get_ref(), ..*self })
        };
        items.iter().map(item).collect()
    }

    /// A whole number.
    pub(super) fn whole(&self) -> Result<Located<i64>, InputError> {
        let digits = self.value.as_integer();
        let value = digits.and_then(|n| i64::from_str_radix(n.as_str(), n.radix()).ok());
        Ok(self.located(value.ok_or_else(|| self.refuse("a whole number"))?))
    }

    /// true or false.
    pub(super) fn flag(&self) -> Result<bool, InputError> {
        self.value.as_bool().ok_or_else(|| self.refuse("true or false"))
    }

    /// A number, if it is one.
    pub(super) fn as_number(&self) -> Option<f64> {
        number(self.value)
    }

    /// A part of a whole: a number, or a text in per cent.
    pub(super) fn share(&self) -> Option<f64> {
        let Some(text) = self.value.as_str() else { return self.as_number() };
        let number: f64 = text.trim().strip_suffix('%')?.trim_end().parse().ok()?;
        Some(0.01 * number).filter(|share| share.is_finite())
    }

    /// Whether it is a text.
    pub(super) fn is_text(&self) -> bool {
        self.value.is_str()
    }

    /// Whether it is a list.
    pub(super) fn is_list(&self) -> bool {
        self.value.is_array()
    }

    /// Whether it is a table.
    pub(super) fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// A table, as `[name]` or in braces.
    pub(super) fn table(&self, sections: &[&'static Section]) -> Result<Table<'a>, InputError> {
        let fields = self.value.as_table().ok_or_else(|| self.refuse("a table"))?;
        Table::new(self.document, self.place.clone(), fields, sections)
    }

    /// The keys of a table and their values; `None` if it is no table.
    pub(super) fn entries(&self) -> Option<Vec<(String, Self)>> {
        let fields = self.value.as_table()?;
        let one = |(name, value): (&Spanned<_>, &'a Spanned<DeValue<'a>>)| {
            let name: &std::borrow::Cow<'a, str> = name.get_ref();
            let place = self.document.place(value.span(), self.place.below(name).key);
            (name.to_string(), Self { document: self.document, place, value: value.get_ref() })
        };
        Some(fields.iter().map(one).collect())
    }

    /// Tables, each under its own `[[name]]`; at least one.
    pub(super) fn tables(
        &self,
        name: &str,
        sections: &[&'static Section],
    ) -> Result<Vec<Table<'a>>, InputError> {
        let expected = format!("at least one table [[{name}]]");
        let items = match self.value {
            DeValue::Array(items) => items,
            DeValue::Table(_) => return Err(InputError::at(&self.place, expected, format!("[{name}]"))),
            _ => return Err(self.refuse(&expected)),
        };
        let tables = items.iter().map(|item| {
            let place = self.document.place(item.span(), self.place.key.clone());
            Self { place, value: item.get_ref(), ..*self }.table(sections)
        });
        match tables.collect::<Result<Vec<_>, _>>() {
            Ok(tables) if tables.is_empty() => Err(InputError::at(&self.place, expected, "an empty list")),
            other => other,
        }
    }
}

/// A finite number, whole or not.
fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(number) => number.as_str().parse().ok(),
        DeValue::Integer(n) if n.radix() == 10 => n.as_str().parse().ok(),
        DeValue::Integer(n) => i64::from_str_radix(n.as_str(), n.radix()).ok().map(|n| n as f64),
        _ => None,
    }
    .filter(|number: &f64| number.is_finite())
}

/// A value as an error shows it.
fn described(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text {}", shown(text)),
        DeValue::Integer(number) => shortened(number.to_string()),
        DeValue::Float(number) => shortened(number.to_string()),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(date) => format!("the date {date}"),
        DeValue::Array(items) => {
            let inner: Vec<_> = items.iter().map(|item| described(item.get_ref())).take(4).collect();
            format!("the list [{}{}]", inner.join(", "), if items.len() > 4 { ", ..." } else { "" })
        }
        DeValue::Table(_) => "a table".into(),
    }
}

/// A text in quotes, not too long.
pub(super) fn shown(text: &str) -> String {
    format!("{:?}", shortened(text.to_owned()))
}

fn shortened(text: String) -> String {
    const LONGEST: usize = 60;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}
