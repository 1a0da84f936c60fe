//! Whatever stands in a case file, it is read or refused: nothing panics.

use super::files::{CASE, folder};
use frfit_workflow::case::parse;
use frfit_workflow::load::{Overrides, Purpose, load};
use proptest::prelude::*;
use std::path::Path;

/// Lines of the good case, pieces of TOML and any other text, in any order.
fn toml_like() -> impl Strategy<Value = String> {
    let lines: Vec<&'static str> = CASE.lines().collect();
    let values =
        ["nan", "-inf", "1e999", "[[]]", "{}", "[1, 2]", "\"1-Z\"", "0", "-1", "9223372036854775808"];
    let keys = ["file", "row", "order", "band_hz", "factor", "matrix", "bounds", "points", "record", "truth"];
    let line = prop_oneof![
        8 => prop::sample::select(lines),
        1 => Just("[[measurement]]"),
        1 => Just("\"\"\""),
    ];
    let field = (prop::sample::select(keys.to_vec()), prop::sample::select(values.to_vec()));
    let piece = prop_oneof![
        6 => line.prop_map(str::to_owned),
        3 => field.prop_map(|(key, value)| format!("{key} = {value}")),
        1 => "\\PC{0,20}",
    ];
    prop::collection::vec(piece, 0..40).prop_map(|pieces| pieces.join("\n"))
}

/// The good case with a few bytes replaced.
fn damaged() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec((0..CASE.len(), any::<u8>()), 1..4).prop_map(|changes| {
        let mut bytes = CASE.as_bytes().to_vec();
        changes.into_iter().for_each(|(at, byte)| bytes[at] = byte);
        bytes
    })
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused_with_one_or_two_lines(text in toml_like()) {
        if let Err(error) = parse(Path::new("case.toml"), text.as_bytes()) {
            let message = error.to_string();
            prop_assert!(message.starts_with("case.toml") && message.lines().count() <= 2, "{message}");
        }
    }

    #[test]
    fn any_damage_is_read_or_refused(bytes in damaged()) {
        let folder = folder("case.toml", Some(&bytes));
        for purpose in [Purpose::Identify, Purpose::Respond] {
            if let Err(error) = load(&folder.path().join("case.toml"), &Overrides::default(), purpose) {
                prop_assert!(error.to_string().lines().count() <= 2, "{error}");
            }
        }
    }
}
